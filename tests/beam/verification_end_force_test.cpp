// SPDX-License-Identifier: MIT
// Cantilever under a dead end force. Reference: the boundary-value problem of the same director rod (and of the
// inextensible one, by elliptic integrals), solved to 1e-12 without finite elements.
#include <near.hpp>

#include <beam/round_rod.hpp>

using namespace fibrant;

namespace verification_end_force_test {

using namespace fibrant::test;

struct Tip {
    double x = 0, z = 0, rotation = 0, mid_x = 0, mid_z = 0, energy = 0;
    RodSolution solution;

    double distance(const Tip& other) const { return std::hypot(x - other.x, z - other.z); }
};

/// @param load  P L^2/EI
template <class Beam = beam::DirectorBeam<3>>
Tip cantilever(const RoundRod& rod, double load, int intervals, bool rigid_clamp = false, int steps = 1,
               bool independent_stresses = true) {
    Rod<Beam> mesh = rod.mesh<Beam>(intervals);
    mesh.place(0, straight(0.0), rigid_clamp);
    const double force = load * rod.EI() / (rod.length * rod.length);
    const RodSolution solution = mesh.follow(
        steps, [&](double t) { mesh.force(intervals, 0) = Vec3(t * force, 0, 0); }, 1e-9, independent_stresses);
    const Vec3 tip = mesh.position(intervals), mid = mesh.position(intervals / 2), g1 = mesh.director(intervals, 1);
    return {tip[0], tip[2], std::atan2(-g1[2], g1[0]), mid[0], mid[2], mesh.energy(), solution};
}

struct Case {
    double slenderness, load;
    Tip expected;  ///< results.director of end_force.json
};
const Case cases[] = {
    {100, 1, {0.60658579957974, 1.8965346878742, 0.46135378262014, 0.19343487787524, 0.98099759528254, 6.6797532195722e-05, {}}},
    {20, 5, {0.28925364095094, 0.24482533314087, 1.2148710567894, 0.10639716805479, 0.16123955912313, 0.0026328940589275, {}}},
    {100, 5, {1.4351777145384, 1.2306021733469, 1.2153463068668, 0.52468948764057, 0.81076200115462, 0.00052100158209165, {}}},
    {1000, 5, {14.347255281111, 12.308643485742, 1.2153678987569, 5.2439371016334, 8.1094698002784, 5.207754794948e-05, {}}},
    {100, 10, {1.6301053896191, 0.89405594775055, 1.4302262673303, 0.64808410964012, 0.68848032198453, 0.00083668507395811, {}}},
};
/// P L^2/EI = 5: tip over length of the elastica, and how far from it the director rod is, in (r/L)^2 (from L/r =
/// 1000).
Tip slender_tip(const RoundRod& rod) {
    const double elastica_x = 1.4347209624599 / 2.01, elastica_z = 1.2308669949439 / 2.01;
    const double away_x = (14.347255281111 / 20.1 - elastica_x) * 1e6, away_z = (12.308643485742 / 20.1 - elastica_z) * 1e6;
    const double ratio = rod.radius / rod.length;
    return {
        (elastica_x + away_x * ratio * ratio) * rod.length, (elastica_z + away_z * ratio * ratio) * rod.length, 0, 0, 0, 0, {}};
}

TEST_CASE("a cantilever converges to the director rod with the fourth order of the mesh") {
    std::printf("distance of the tip over L, n = 8 16 32 64 128\n");
    for (const Case& c : cases) {
        CAPTURE(c.slenderness);
        CAPTURE(c.load);
        RoundRod rod;
        rod.length = c.slenderness * rod.radius;
        std::vector<double> error;
        for (const int n : {8, 16, 32, 64, 128}) {
            const Tip tip = cantilever(rod, c.load, n);
            REQUIRE(tip.solution.converged);
            error.push_back(tip.distance(c.expected) / rod.length);
        }
        char name[64];
        std::snprintf(name, sizeof name, "P L^2/EI = %g, L/r = %g", c.load, c.slenderness);
        print_row(name, error);
        // Twice the errors met at load 10, where the rod turns most; order 4 gives 16 a halving.
        CHECK(error[0] < 2e-3);
        CHECK(error[1] < 6e-5);
        CHECK(error[2] < 4e-6);
        CHECK(error[3] < 3e-7);
        CHECK(order(error[2], error[3]) > 3.5);
        const Tip fine = cantilever(rod, c.load, 128);
        CHECK(off(fine.rotation, c.expected.rotation) < 2e-8);
        CHECK(off(fine.mid_x, c.expected.mid_x) < 1e-6);
        CHECK(off(fine.mid_z, c.expected.mid_z) < 1e-7);
        CHECK(off(fine.energy, c.expected.energy) < 1e-7);
    }
}

TEST_CASE("a fibre ten thousand radii long bends accurately, in one load step") {
    RoundRod rod;
    rod.length = 1e4 * rod.radius;
    const Tip expected = slender_tip(rod);
    const double bound[] = {3e-4, 2e-5, 1e-6};
    std::printf("P L^2/EI = 5, L/r = 1e4, n = 8 16 32 64\n");
    for (const bool rigid : {false, true}) {
        std::vector<double> error;
        std::vector<double> iterations;
        for (const int n : {8, 16, 32, 64}) {
            const Tip tip = cantilever(rod, 5.0, n, rigid);
            REQUIRE(tip.solution.converged);
            CHECK(tip.solution.rejected == 0);
            CHECK(tip.solution.iterations <= 12);
            error.push_back(tip.distance(expected) / rod.length);
            iterations.push_back(tip.solution.iterations);
        }
        print_row(rigid ? "clamp holds the whole section" : "clamp holds position and rotation", error);
        print_row("Newton iterations", iterations);
        for (std::size_t k = 0; k < 3; ++k) CHECK(error[k] <= bound[k]);
    }
}

TEST_CASE("sampling section strains at the nodes raises the order from two to four") {
    using Gauss = beam::DirectorBeam<3, beam::DirectorBeamOptions{beam::ElasticLaw::split, beam::SectionSampling::gauss}>;
    using GaussTwo = beam::DirectorBeam<2, beam::DirectorBeamOptions{beam::ElasticLaw::split, beam::SectionSampling::gauss}>;
    RoundRod rod;
    rod.length = 1e4 * rod.radius;
    const Tip expected = slender_tip(rod);
    const auto errors = [&]<class Beam>(const Beam&) {
        std::vector<double> error;
        for (const int n : {8, 16, 32, 64}) {
            const Tip tip = cantilever<Beam>(rod, 5.0, n);
            REQUIRE(tip.solution.converged);
            error.push_back(tip.distance(expected) / rod.length);
        }
        return error;
    };
    const std::vector<double> two = errors(beam::DirectorBeam<2>{}), two_gauss = errors(GaussTwo{});
    const std::vector<double> three = errors(beam::DirectorBeam<3>{}), three_gauss = errors(Gauss{});
    std::printf("P L^2/EI = 5, L/r = 1e4, n = 8 16 32 64\n");
    print_row("2 nodes, section strains at the Gauss point", two_gauss);
    print_row("2 nodes, at the nodes", two);
    print_row("3 nodes, at the Gauss points", three_gauss);
    print_row("3 nodes, at the nodes", three);
    CHECK(order(two_gauss[2], two_gauss[3]) == test::near(2.0, 0.05));
    CHECK(order(two[2], two[3]) == test::near(2.0, 0.05));
    CHECK(order(three_gauss[2], three_gauss[3]) == test::near(2.1, 0.1));
    CHECK(order(three[2], three[3]) == test::near(4.0, 0.05));
}

TEST_CASE("with independent stresses Newton does not care how slender a fibre is") {
    std::printf("Newton iterations for P L^2/EI = 5, 16 elements, L/r = 20 100 1000 10000\n");
    std::vector<double> independent, plain;
    for (const double slenderness : {20.0, 100.0, 1000.0, 1e4}) {
        RoundRod rod;
        rod.length = slenderness * rod.radius;
        const Tip one = cantilever(rod, 5.0, 32), two = cantilever(rod, 5.0, 32, false, 1, false);
        REQUIRE(one.solution.converged);
        independent.push_back(one.solution.iterations);
        plain.push_back(two.solution.converged ? two.solution.iterations : -1);
        CHECK(one.solution.iterations <= 9);
        if (two.solution.converged) CHECK(one.distance(two) < 1e-8 * rod.length);  // the same solution
    }
    print_row("independent stresses, one step", independent);
    print_row("displacements alone, one step (may be cut)", plain);
}

}  // namespace verification_end_force_test
