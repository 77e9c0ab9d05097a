// SPDX-License-Identifier: MIT
#pragma once
/// @file Larger pieces of a fabric out of the state of its repeating cell: a cell of several, or a finite sample with the same
/// inside.

#include <fibrant/compositions/weave/periodic.hpp>
#include <fibrant/compositions/weave/tow_geometry.hpp>
#include <fibrant/simulation/stored_state.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

namespace fibrant::compositions::weave {

/// The fabric of `repeats` cells each way. Ends lie half way between crossings, as in the cell.
/// @param repeats  >= 1
inline FabricParameters repeated(const FabricParameters& cell, Index repeats) {
    core::require_at_least("repeated.repeats", repeats, 1);
    FabricParameters fabric = cell;
    fabric.warp_tows *= repeats, fabric.weft_tows *= repeats, fabric.elements *= repeats, fabric.weft_elements *= repeats;
    return fabric;
}

/// The state of the cell, `repeats` times side by side and end to end, with the middle of all where that of the cell was;
/// contacts remember what they did in the cell.
template <simulation::Model M>
simulation::StoredState<M> repeated(const simulation::StoredState<M>& stored, const FabricParameters& cell,
                                    const beam::Mesh<typename M::Beam>& cell_mesh, const beam::Mesh<typename M::Beam>& mesh,
                                    Index repeats) {
    const FabricParameters fabric = repeated(cell, repeats);
    const auto last_node = [&](Index fibre) { return cell.nodes_per_fibre(cell.place(fibre).family) - 1; };
    const auto along = [&](Index fibre) { return core::at(axis_of(cell.place(fibre).family)); };
    const auto image = [&](Index fibre, const std::array<Index, 2>& at) {
        const FibrePlace place = cell.place(fibre);
        const Index aside = at[core::at(1 - axis_of(place.family))];
        return fabric.fibre(place.family, aside * cell.tows(place.family) + place.tow, place.fibre);
    };
    std::array<Vec3, 2> period{Vec3::Zero(), Vec3::Zero()};
    for (Index f = 0; f < cell.fibres(); ++f)
        period[along(f)] += (stored.state.template segment<3>(3 * cell_mesh.node_vector(f, last_node(f))) -
                             stored.state.template segment<3>(3 * cell_mesh.node_vector(f, 0))) /
                            static_cast<double>(cell.tows(cell.place(f).family) * cell.tow(cell.place(f).family).fibres);
    const Vec3 middle = 0.5 * static_cast<double>(repeats - 1) * (period[0] + period[1]);
    simulation::StoredState<M> answer;
    answer.state = mesh.start_state();
    for (Index x = 0; x < repeats; ++x)
        for (Index y = 0; y < repeats; ++y) {
            const std::array<Index, 2> at{x, y};
            const Vec3 shift = static_cast<double>(x) * period[0] + static_cast<double>(y) * period[1] - middle;
            for (Index f = 0; f < cell.fibres(); ++f) {
                const Index last = last_node(f), first = at[along(f)] * last;
                for (Index node = 0; node <= last; ++node)
                    for (Index k = 0; k < M::Beam::vectors_per_node; ++k)
                        answer.state.template segment<3>(3 * mesh.node_vector(image(f, at), first + node, k)) =
                            stored.state.template segment<3>(3 * cell_mesh.node_vector(f, node, k)) +
                            (k == 0 ? shift : Vec3(Vec3::Zero()));
            }
            const auto on = [&](Index fibre, double place) {
                return place + static_cast<double>(at[along(fibre)] * cell.elements_of(cell.place(fibre).family));
            };
            for (auto record : stored.records) {
                record.u_i = on(record.fibre_i, record.u_i), record.u_j = on(record.fibre_j, record.u_j);
                record.fibre_i = static_cast<std::int32_t>(image(record.fibre_i, at)),
                record.fibre_j = static_cast<std::int32_t>(image(record.fibre_j, at));
                answer.records.push_back(record);
            }
            for (contact::Zone zone : stored.zones) {
                proximity::ProximityZone& span = zone.span;
                for (double* place : {&span.a_i, &span.b_i, &span.closest_i}) *place = on(span.fibre_i, *place);
                for (double* place : {&span.a_j, &span.b_j, &span.closest_j}) *place = on(span.fibre_j, *place);
                for (auto& [u_i, u_j] : zone.watched.at) u_i = on(span.fibre_i, u_i), u_j = on(span.fibre_j, u_j);
                span.fibre_i = image(span.fibre_i, at), span.fibre_j = image(span.fibre_j, at);
                answer.zones.push_back(zone);
            }
        }
    std::stable_sort(answer.records.begin(), answer.records.end());
    std::stable_sort(answer.zones.begin(), answer.zones.end(), [](const contact::Zone& a, const contact::Zone& b) {
        return std::tie(a.span.fibre_i, a.span.fibre_j, a.span.a_i, a.span.a_j) <
               std::tie(b.span.fibre_i, b.span.fibre_j, b.span.a_i, b.span.a_j);
    });
    return answer;
}

}  // namespace fibrant::compositions::weave
