// SPDX-License-Identifier: MIT
#pragma once
/// @file A state on a finer mesh: how much of a result is the mesh's, from one and the same settled state.

#include <fibrant/scene/image_vectors.hpp>
#include <fibrant/simulation/section_laws.hpp>
#include <fibrant/simulation/stored_state.hpp>

namespace fibrant::simulation {

/// A beam whose nodal vectors are its position and its directors, each interpolated by itself: parts of an element hold them
/// exactly.
template <class B>
concept InterpolatedDirectors =
    !beam::TurningSections<B> && B::vectors_per_node == 3 && B::kinds[0] == scene::VectorKind::position &&
    B::kinds[1] == scene::VectorKind::direction && B::kinds[2] == scene::VectorKind::direction;

/// The state of a mesh on another one of the same fibres, whose elements are parts of its own: no particle moves, and contacts
/// remember what they did where they were. Fibres that are straight at rest keep their strains as well; of curved ones the finer
/// mesh knows the rest shape better.
/// @param mesh   that `stored` belongs to
/// @param finer  each fibre with `parts` times the elements
/// @throws std::invalid_argument if it has not, naming the fibre
template <Model M>
    requires InterpolatedDirectors<typename M::Beam> StoredState<M> refined(const StoredState<M>& stored,
                                                                            const beam::Mesh<typename M::Beam>& mesh,
                                                                            const beam::Mesh<typename M::Beam>& finer,
                                                                            Index parts) {
        using B = typename M::Beam;
        using Mesh = beam::Mesh<B>;
        core::require_at_least("refined.parts", parts, 1);
        if (finer.fibre_count() != mesh.fibre_count())
            core::refuse("refined.finer.fibres", std::to_string(finer.fibre_count()),
                         "as many as before, " + std::to_string(mesh.fibre_count()));
        const double times = static_cast<double>(parts);
        StoredState<M> answer = stored;
        answer.state = finer.rest_state();
        for (Index f = 0; f < mesh.fibre_count(); ++f) {
            if (finer.fibre(f).elements != parts * mesh.fibre(f).elements)
                core::refuse("refined.finer.fibre(" + std::to_string(f) + ").elements", std::to_string(finer.fibre(f).elements),
                             std::to_string(parts) + " times those before, " + std::to_string(mesh.fibre(f).elements));
            for (Index node = 0; node < finer.node_count(f); ++node) {
                const auto [e, xi] = mesh.locate(f, static_cast<double>(node) / (static_cast<double>(B::nodes - 1) * times));
                const Index first = mesh.first_unknown(f, e);
                const auto put = [&](Index k, const beam::ElementWeights<B>& weights) {
                    answer.state.template segment<3>(3 * finer.node_vector(f, node, k)) =
                        Mesh::point(stored.state, first, weights);
                };
                put(0, B::centreline_weights(xi));
                put(1, beam::director_weights<B>(xi, 1));
                put(2, beam::director_weights<B>(xi, 2));
            }
        }
        scene::copy_to_images(finer.layout(), answer.state);
        if constexpr (beam::Remembering<B>) answer.laws = SectionLaws<B>::refined(mesh, stored.laws, finer, parts);
        for (auto& record : answer.records) record.u_i *= times, record.u_j *= times;
        for (contact::Zone& zone : answer.zones) {
            proximity::ProximityZone& span = zone.span;
            for (double* place : {&span.a_i, &span.b_i, &span.closest_i, &span.a_j, &span.b_j, &span.closest_j}) *place *= times;
            zone.reference /= times;  // of a section over an element's length
        }
        return answer;
    }

}  // namespace fibrant::simulation
