// SPDX-License-Identifier: MIT
// Small loads on a straight rod: the stiffnesses of a rod in bending with shear, stretching and twist.
#include <near.hpp>

#include <beam/round_rod.hpp>

using namespace fibrant;

namespace verification_small_loads_test {

using namespace fibrant::test;

using Full = beam::DirectorBeam<3, beam::DirectorBeamOptions{beam::ElasticLaw::full}>;
using Two = beam::DirectorBeam<2>;

constexpr double small = 1e-6;  // of P L^2/EI: what is quadratic in the load stays below 1e-11

template <class Beam = beam::DirectorBeam<3>>
double deflection(const RoundRod& rod, int elements) {
    const int n = elements * Beam::reach;
    Rod<Beam> mesh = rod.mesh<Beam>(n);
    mesh.place(0, straight(0.0), false);
    const double force = small * rod.EI() / (rod.length * rod.length);
    mesh.force(n, 0) = Vec3(force, 0, 0);
    REQUIRE(mesh.solve(1e-12).converged);
    return mesh.position(n)[0] / force;
}
double timoshenko(const RoundRod& rod) { return std::pow(rod.length, 3) / (3.0 * rod.EI()) + rod.length / rod.GA(); }

TEST_CASE("a fibre bends with EI and shears with GA, whatever its Poisson ratio") {
    std::printf("deflection over Timoshenko's, less 1; 4 elements of 3 nodes\n");
    for (const double poisson : {0.0, 0.2, 0.3, 0.45}) {
        for (const double slenderness : {20.0, 100.0, 1000.0}) {
            RoundRod rod;
            rod.poisson = poisson;
            rod.length = slenderness * rod.radius;
            const double error = deflection(rod, 4) / timoshenko(rod) - 1.0;
            std::printf("nu = %g, L/r = %g: %.1e\n", poisson, slenderness, error);
            CHECK(std::abs(error) < 1e-5);
        }
    }
}

TEST_CASE("the full law bends too stiffly by the factor of a section that cannot widen") {
    RoundRod rod;
    const double factor = (1.0 - rod.poisson) / ((1.0 + rod.poisson) * (1.0 - 2.0 * rod.poisson));
    const double bending = std::pow(rod.length, 3) / (3.0 * rod.EI()), shear = rod.length / rod.GA();
    const double ratio = deflection<Full>(rod, 4) / (bending / factor + shear);
    std::printf("full law, nu = 0.3: stiffness / EI = %.6f, expected %.6f\n", factor / ratio, factor);
    CHECK(std::abs(ratio - 1.0) < 1e-5);
}

TEST_CASE("two nodes an element converge to the same deflection with the square of the mesh") {
    const RoundRod rod;
    // Shear at one point makes the element bend as two rigid halves: short of 1/(4 n^2) of the deflection.
    for (const int n : {4, 16, 64}) {
        CHECK(deflection<Two>(rod, n) / timoshenko(rod) == test::near(1.0 - 0.25 / (n * n), 1e-4 / n));
    }
}

TEST_CASE("a fibre stretches with EA and Poisson's contraction is free") {
    const RoundRod rod;
    for (const bool rigid : {false, true}) {
        Rod<> mesh = rod.mesh(16);
        mesh.place(0, straight(0.0), rigid);
        const double strain = 1e-7;
        mesh.force(16, 0) = Vec3(0, 0, strain * rod.EA());
        REQUIRE(mesh.solve(1e-12).converged);
        const double extension = mesh.position(16)[2] - rod.length;
        // 1.5 strain is the law's; a clamp that holds the contraction takes 0.67 r/L.
        const double error = extension / (strain * rod.length) - 1.0;
        std::printf("stretching, %s clamp: %.1e\n", rigid ? "whole" : "rotation", error);
        CHECK(std::abs(error) < (rigid ? 0.7 * rod.radius / rod.length : 1e-6));
        // Two Gauss points an element do not see a contraction of (xi^2 - 1/3), which is 0 at both: what a clamp holds goes on so
        // from node to node, twice as much at the ends of elements as in their middles and the other way round, and of it a
        // quarter is left at the last one.
        CHECK(mesh.director(16, 1)[0] - 1.0 == test::near(-rod.poisson * strain, rigid ? 0.3 : 1e-5));
    }
}

TEST_CASE("a fibre twists with GJ") {
    const RoundRod rod;
    Rod<> mesh = rod.mesh(16);
    mesh.place(0, straight(0.0), false);
    const double angle = 1e-4;
    mesh.body_moment(16) = Vec3(0, 0, angle * rod.GJ() / rod.length);
    REQUIRE(mesh.solve(1e-12).converged);
    const Vec3 g1 = mesh.director(16, 1);
    CHECK(std::atan2(g1[1], g1[0]) == test::near(angle, 1e-6));
}

}  // namespace verification_small_loads_test
