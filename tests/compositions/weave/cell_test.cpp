// SPDX-License-Identifier: MIT
// Repeating cells of a fabric before anything is solved: what pulls them, and pieces of several side by side.
#include "near.hpp"
#include "small_weave.hpp"

#include <fibrant/compositions/weave/repeated.hpp>

#include <doctest/doctest.h>

#include <numbers>
#include <tuple>

using namespace fibrant;

namespace cell_test {

namespace cloth = fibrant::compositions::weave;

using Model = test::SmallWeave;
using test::small_fabric;

TEST_CASE(
    "cells side by side and end to end are the flat fabric of as many tows, and their contacts stand where those of one do") {
    cloth::FabricParameters cell = small_fabric();
    cell.warp_tows = 3, cell.warp.fibres = 4, cell.weft_elements = 8;  // no two numbers of the families are alike
    cell.overhang = 0.5 * cell.warp_spacing;
    const auto mesh_of = [](const cloth::FabricParameters& fabric) {
        scene::Assembly fibres;
        cloth::add_flat_fibres(fibres, fabric);
        return beam::Mesh<Model::Beam>(fibres, Model::Beam(Model::Beam::Parameters{}));
    };
    const Index repeats = 2;
    const auto one = mesh_of(cell), all = mesh_of(cloth::repeated(cell, repeats));
    simulation::StoredState<Model> stored{.state = one.start_state()};
    const Index warp = cell.fibre(cloth::Family::warp, 1, 2), weft = cell.fibre(cloth::Family::weft, 1, 3);
    contact::Zone zone;
    zone.span.fibre_i = warp, zone.span.fibre_j = weft;
    zone.span.a_i = 3.0, zone.span.b_i = 4.0, zone.span.closest_i = 5.0;
    zone.span.a_j = 2.0, zone.span.b_j = 1.0, zone.span.closest_j = 6.0;
    zone.watched.at[0] = {7.0, 3.0};
    stored.zones.push_back(zone);
    stored.records.emplace_back();
    stored.records[0].fibre_i = static_cast<std::int32_t>(warp), stored.records[0].fibre_j = static_cast<std::int32_t>(weft);
    stored.records[0].u_i = 4.0, stored.records[0].u_j = 5.0;
    const auto answer = cloth::repeated<Model>(stored, cell, one, all, repeats);
    CHECK((answer.state - all.start_state()).cwiseAbs().maxCoeff() < 1e-12 * cell.fibre_length(cloth::Family::warp));

    const auto place = [](const auto& mesh, const Vector& state, Index fibre, double u) {
        return Vec3(state.segment<3>(3 * mesh.node_vector(fibre, static_cast<Index>(2.0 * u))));
    };
    const auto apart = [&](const auto& mesh, const Vector& state, Index i, double u_i, Index j, double u_j) {
        return Vec3(place(mesh, state, j, u_j) - place(mesh, state, i, u_i));
    };
    const auto same = [&](Index i, double u_i, Index j, double u_j, double own_i, double own_j) {
        const Vec3 expected = apart(one, stored.state, warp, own_i, weft, own_j);
        CHECK((apart(all, answer.state, i, u_i, j, u_j) - expected).norm() < 1e-12 * expected.norm());
    };
    REQUIRE(core::count(answer.zones) == repeats * repeats);
    REQUIRE(core::count(answer.records) == repeats * repeats);
    for (std::size_t k = 0; k < answer.zones.size(); ++k) {
        const proximity::ProximityZone& span = answer.zones[k].span;
        same(span.fibre_i, span.a_i, span.fibre_j, span.a_j, 3.0, 2.0),
            same(span.fibre_i, span.b_i, span.fibre_j, span.b_j, 4.0, 1.0);
        same(span.fibre_i, span.closest_i, span.fibre_j, span.closest_j, 5.0, 6.0);
        same(span.fibre_i, answer.zones[k].watched.at[0][0], span.fibre_j, answer.zones[k].watched.at[0][1], 7.0, 3.0);
        const auto& record = answer.records[k];
        same(record.fibre_i, record.u_i, record.fibre_j, record.u_j, 4.0, 5.0);
        const auto tied = [](const auto& a) { return std::tie(a.fibre_i, a.fibre_j, a.u_i, a.u_j); };
        if (k > 0) CHECK(tied(answer.records[k - 1]) < tied(record));  // four images, and no two the same
    }
}

TEST_CASE("a cell that settles is pulled by the tension of all its fibres, way by way") {
    cloth::FabricParameters cell = small_fabric();
    cell.warp_tows = 3, cell.warp.fibres = 4, cell.weft.fibre_radius = 0.03;
    cell.overhang = 0.5 * cell.warp_spacing;
    const double strain = 2e-3, spacing = cell.warp_spacing, modulus = cell.warp.material.young_modulus;
    const scene::Assembly pulled = cloth::periodic_fabric(cell, cloth::CellDrive::tension, strain),
                          stretched = cloth::periodic_fabric(cell, cloth::CellDrive::strain, strain);
    const auto force = [&](double fibres, double radius) {
        return strain * fibres * modulus * std::numbers::pi * radius * radius;
    };
    // Work of a displacement gradient is force times length: a warp tow is as long as its two wefts are apart, twice.
    CHECK(pulled.cells()[0].component(0, 0).value == test::near(force(3 * 4, 0.04) * 2.0 * spacing, 1e-12));
    CHECK(pulled.cells()[0].component(1, 1).value == test::near(force(2 * 5, 0.03) * 3.0 * spacing, 1e-12));
    CHECK(stretched.cells()[0].component(0, 0).channel == "strain_x");
    CHECK(stretched.cells()[0].component(1, 1).channel == "strain_y");
    for (const scene::PeriodicPair& pair : pulled.pairs()) {  // ends of one fibre, a period apart
        const scene::FibreSpecification& fibre = pulled.fibres()[core::at(pair.last.fibre)];
        CHECK((fibre.to - fibre.from - pair.period).norm() < 1e-12 * spacing);
    }
}

}  // namespace cell_test
