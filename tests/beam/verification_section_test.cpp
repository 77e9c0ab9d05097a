// SPDX-License-Identifier: MIT
// Uniform states of a fibre whose section strains. Reference: the algebra of the St Venant-Kirchhoff law.
#include <near.hpp>

#include <beam/round_rod.hpp>

using namespace fibrant;

namespace verification_section_test {

using namespace fibrant::test;

struct Stretches {
    double along_1 = 0, along_2 = 0, axis = 0;
};

/// @param force       axial dead force on the ends
/// @param line_load   inward dead force a unit of rest length on the material lines xi_1 = r and xi_1 = -r
/// @param length_held whether the ends keep their distance
template <class Beam = beam::DirectorBeam<3>>
Stretches uniform_state(const RoundRod& rod, double force, double line_load, bool length_held) {
    const int n = 8;
    Rod<Beam> mesh = rod.mesh<Beam>(n);
    mesh.place(0, straight(0.0), false);
    if (length_held) mesh.hold(n, 0, Mat3::Identity(), straight(rod.length).position);
    mesh.force(n, 0) += Vec3(0, 0, force);
    // Both line loads work on 2 r g_1; a node's share is the integral of its shape function.
    const double element = rod.length * Beam::reach / n;
    const double share[3] = {Beam::nodes == 2 ? 0.5 : 1.0 / 6, Beam::nodes == 2 ? 0.5 : 4.0 / 6, 1.0 / 6};
    for (int e = 0; e < mesh.elements(); ++e) {
        for (int I = 0; I < Beam::nodes; ++I) {
            mesh.force(Beam::reach * e + I, 1) += Vec3(-2.0 * rod.radius * line_load * element * share[I], 0, 0);
        }
    }
    REQUIRE(mesh.solve(1e-12).converged);
    const int k = n / 2;
    const double axis = (mesh.position(k + 1) - mesh.position(k)).norm() / (rod.length / n);
    for (int node = 0; node <= n; ++node) {  // the state is uniform
        CHECK(mesh.director(node, 1).norm() == test::near(mesh.director(k, 1).norm(), 1e-11));
        CHECK(mesh.director(node, 2).norm() == test::near(mesh.director(k, 2).norm(), 1e-11));
    }
    return {mesh.director(k, 1).norm(), mesh.director(k, 2).norm(), axis};
}

RoundRod short_fibre() {
    RoundRod rod;
    rod.length = 16.0 * rod.radius;
    return rod;
}
/// The printed digits of the reference.
void check(const Stretches& s, const Stretches& expected) {
    CHECK(s.along_1 == test::near(expected.along_1, 1e-12));
    CHECK(s.along_2 == test::near(expected.along_2, 1e-12));
    CHECK(s.axis == test::near(expected.axis, 1e-12));
}

TEST_CASE_TEMPLATE("a pulled or pressed fibre strains as the law says", Beam, beam::DirectorBeam<2>, beam::DirectorBeam<3>) {
    const RoundRod rod = short_fibre();
    check(uniform_state<Beam>(rod, 0.0926541439023073, 0, false), {0.99702484739954, 0.99702484739954, 1.0098538733697});
    check(uniform_state<Beam>(rod, 0.46327071951153653, 0, false), {0.98556479203671, 0.98556479203671, 1.0466805318046});
    check(uniform_state<Beam>(rod, -0.0926541439023073, 0, false), {1.0030261959703, 1.0030261959703, 0.98984586375429});
}

TEST_CASE_TEMPLATE("a pinched fibre flattens as the law says", Beam, beam::DirectorBeam<2>, beam::DirectorBeam<3>) {
    const RoundRod rod = short_fibre();
    check(uniform_state<Beam>(rod, 0, 2.9346, false), {0.9870158154767, 1.0038625075177, 1.0038625075177});
    check(uniform_state<Beam>(rod, 0, 2.9346, true), {0.98820568155133, 1.0050123377245, 1.0});
}

TEST_CASE("a pinch at small load strains the section by -2 q/(pi r E*)") {
    const RoundRod rod = short_fibre();
    const double line_load = 1e-6 * rod.young * rod.radius;
    const double plain = rod.young / (1.0 - rod.poisson * rod.poisson);
    const Stretches s = uniform_state(rod, 0, line_load, true);
    const double e11 = 0.5 * (s.along_1 * s.along_1 - 1.0);
    // 1e-6 of strain: the law is linear to as much, and 16 digits leave 1e-10.
    CHECK(e11 == test::near(-2.0 * line_load / (std::numbers::pi * rod.radius * plain), 1e-5));
}

}  // namespace verification_section_test
