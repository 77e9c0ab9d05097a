// SPDX-License-Identifier: MIT
// Points of a mesh by the vectors that they depend on are those by all vectors of an element.
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/beam/kirchhoff_cable.hpp>
#include <fibrant/beam/mesh.hpp>
#include <fibrant/beam/on_centreline.hpp>
#include <fibrant/beam/rigid_section_rod.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

using namespace fibrant;

namespace mesh_points_test {

template <class B>
constexpr int centre_vector = beam::detail::only_vector<B>([](double xi) { return B::centreline_weights(xi); });
template <class B, int Which>
constexpr int director_vector = beam::detail::only_vector<B>([](double xi) { return beam::director_weights<B>(xi, Which); });

// A position depends on the positions of nodes, but on their tangents as well along a cubic; a director on nothing but itself.
static_assert(centre_vector<beam::DirectorBeam<2>> == 0 && centre_vector<beam::DirectorBeam<3>> == 0 &&
              centre_vector<beam::RigidSectionRod> == 0);
static_assert(centre_vector<beam::KirchhoffCable> == -1);
static_assert(director_vector<beam::DirectorBeam<3>, 1> == 1 && director_vector<beam::DirectorBeam<3>, 2> == 2);
static_assert(director_vector<beam::OnCentreline<beam::DirectorBeam<3>>, 1> == 1);

/// What a compiler cannot look into.
struct Opaque {
    static constexpr int nodes = 2, vectors_per_node = 1;
    static constexpr int dofs_per_node = 3;
    static std::array<double, 2> weights(double xi) { return {1.0 - xi, 0.0}; }  // not constexpr
};
static_assert(beam::detail::only_vector<Opaque>([](double xi) { return Opaque::weights(xi); }) == -1);

TEST_CASE_TEMPLATE("a point, a tangent and a director are the same by one vector of each node and by all", B,
                   beam::DirectorBeam<2>, beam::DirectorBeam<3>, beam::RigidSectionRod, beam::KirchhoffCable) {
    scene::Assembly assembly;
    assembly.add(
        {.from = {0, 0, 0}, .to = {1, 0.2, -0.1}, .section = scene::circular(0.02), .material = {7300.0, 0.3}, .elements = 5});
    const beam::Mesh<B> mesh(assembly, B());
    Vector state = mesh.start_state();
    for (Index k = 0; k < state.size(); ++k) state[k] += 0.1 * std::sin(1.7 * static_cast<double>(k));
    double difference = 0.0, least = 1.0;
    for (const double xi : {-1.0, -0.4, 0.0, 0.33, 1.0})
        for (Index e = 0; e < 5; ++e) {
            const Index first = mesh.first_unknown(0, e);
            const auto compare = [&](const Vec3& a, const Vec3& b) {
                difference = std::max(difference, (a - b).norm()), least = std::min(least, b.norm());
            };
            compare(mesh.centre(state, first, B::centreline_weights(xi)), mesh.point(state, first, B::centreline_weights(xi)));
            compare(mesh.centre(state, first, B::centreline_derivative_weights(xi)),
                    mesh.point(state, first, B::centreline_derivative_weights(xi)));
            if constexpr (beam::DeformableSections<B>) {
                compare(mesh.template director<1>(state, first, beam::director_weights<B>(xi, 1)),
                        mesh.point(state, first, beam::director_weights<B>(xi, 1)));
                compare(mesh.template director<2>(state, first, beam::director_weights<B>(xi, 2)),
                        mesh.point(state, first, beam::director_weights<B>(xi, 2)));
            }
        }
    CHECK(difference < 1e-15);  // rounding of another order of the same terms
    CHECK(least > 1e-3);        // none of them is nothing
}

TEST_CASE("a beam whose sections are circles at rest has the forces of one whose may be ovals, and refuses these") {
    using Round = beam::RoundDirectorBeam<3>;
    static_assert(beam::DeformableSections<Round> && !beam::OvalSections<Round> && beam::OvalSections<beam::DirectorBeam<3>>);
    const auto assembly = [](const scene::CrossSection& section) {
        scene::Assembly one;
        one.add(
            {.from = {0, 0, 0}, .to = {1, 0, 0}, .section = section, .material = {7300.0, 0.3}, .elements = 2, .name = "warp"});
        return one;
    };
    const scene::Assembly circles = assembly(scene::circular(0.02));
    const Round beam{Round::Parameters{}};
    const beam::Mesh<Round> mesh(circles, beam);
    Vector bent = mesh.rest_state();
    for (Index k = 0; k < bent.size(); ++k) bent[k] += 1e-3 * std::sin(static_cast<double>(k));
    const beam::DirectorBeam<3> any{beam::DirectorBeam<3>::Parameters{}};
    const beam::Mesh<beam::DirectorBeam<3>> other(circles, any);
    CHECK(beam.internal_force(mesh.rest(0, 1), mesh.element(bent, 0, 1)) ==
          any.internal_force(other.rest(0, 1), other.element(bent, 0, 1)));
    CHECK_THROWS_WITH_AS(beam::Mesh<Round>(assembly(scene::elliptical(0.03, 0.02)), beam),
                         "section.semi_axis_2 = 0.02, but it must be semi_axis_1 = 0.03, for a beam that is "
                         "round_at_rest (fibre 0 'warp')",
                         std::invalid_argument);
}

}  // namespace mesh_points_test
