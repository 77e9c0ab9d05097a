// SPDX-License-Identifier: MIT
// Stability of straight rods. References: closed forms of the rod models, elliptic integrals, and the boundary-value
// problem of the Reissner rod. A load is critical where the tangent loses a positive pivot.
#include <beam/round_rod.hpp>

using namespace fibrant;

namespace verification_buckling_test {

using namespace fibrant::test;

/// Where `unstable(value)` turns from false to true between low and high, to the relative width 1e-9.
template <class Unstable>
double bisected(double low, double high, const Unstable& unstable) {
    CHECK(!unstable(low));
    CHECK(unstable(high));
    while (high - low > 1e-9 * high) {
        const double middle = 0.5 * (low + high);
        (unstable(middle) ? high : low) = middle;
    }
    return 0.5 * (low + high);
}

enum class Ends { clamped_free, pinned_pinned, clamped_clamped };

const Mat3 across = Vec3(1, 1, 0).asDiagonal();  ///< holds what is perpendicular to the axis

/// Least axial dead force that a straight rod does not bear.
double euler_load(const RoundRod& rod, Ends ends, int n) {
    const double scale = std::numbers::pi * std::numbers::pi * rod.EI() / (rod.length * rod.length);
    const double factor = ends == Ends::clamped_free ? 0.25 : ends == Ends::pinned_pinned ? 1.0 : 4.0;
    return bisected(0.8 * factor * scale, 1.1 * factor * scale, [&](double load) {
        Rod<> mesh = rod.mesh(n);
        if (ends == Ends::pinned_pinned) {
            mesh.hold(0, 0, Mat3::Identity(), Vec3::Zero());
            mesh.hold(0, 1, Mat3(Vec3(0, 1, 0).asDiagonal()), Vec3::Zero());  // no spin
            mesh.hold(0, 2, Mat3(Vec3(1, 0, 0).asDiagonal()), Vec3::Zero());
            mesh.hold(n, 0, across, Vec3::Zero());
        } else {
            mesh.place(0, straight(0.0), false);
        }
        if (ends == Ends::clamped_clamped) {
            mesh.place(n, straight(rod.length), false);
            mesh.hold(n, 0, across, Vec3::Zero());
        }
        mesh.force(n, 0) = Vec3(0, 0, -load);
        REQUIRE(mesh.solve().converged);
        return mesh.negative_pivots() > 0;
    });
}

struct Tip {
    double x = 0, z = 0, angle = 0;
};
/// Beyond the Euler load: pushed aside while the axial force grows, then left alone.
Tip post_buckling(const RoundRod& rod, double load_over_critical, int n) {
    const double EI = rod.EI() / (rod.length * rod.length);
    const double critical = 0.25 * std::numbers::pi * std::numbers::pi * EI;
    Rod<> mesh = rod.mesh(n);
    mesh.place(0, straight(0.0), false);
    REQUIRE(mesh.follow(8, [&](double t) { mesh.force(n, 0) = Vec3(EI * t, 0, -t * load_over_critical * critical); }).converged);
    REQUIRE(
        mesh.follow(4, [&](double t) { mesh.force(n, 0) = Vec3(EI * (1 - t), 0, -load_over_critical * critical); }).converged);
    CHECK(mesh.negative_pivots() <= 1);  // none, but any plane through the axis is as good: one pivot is about zero
    const Vec3 x = mesh.position(n) / rod.length, g1 = mesh.director(n, 1);
    return {x[0], x[2], std::atan2(-g1[2], g1[0])};
}

struct Column {
    double shortening = 0, thrust = 0, clamp_moment = 0, energy = 0;
};
/// Clamped column whose middle has buckled aside by w; found by the thrust that needs no force in the middle.
Column pressed_column(RoundRod rod, double w, int n) {
    rod.length *= 0.5;  // one half, up to the plane of symmetry
    Rod<> mesh = rod.mesh(n);
    mesh.place(0, straight(0.0), false);
    mesh.place(n, straight(rod.length), false);
    const double euler = std::numbers::pi * std::numbers::pi * rod.EI() / (rod.length * rod.length);
    const auto side_force = [&](double thrust, double part) {
        mesh.hold(n, 0, across, Vec3(part * w, 0, 0));
        mesh.force(n, 0) = Vec3(0, 0, -thrust);
        return mesh.solve();
    };
    for (int step = 1; step <= 4; ++step) REQUIRE(side_force(0.0, 0.25 * step).converged);
    double before = 0.9 * euler, thrust = euler;
    REQUIRE(side_force(before, 1.0).converged);
    double force_before = mesh.reaction_force(n)[0];
    for (int secant = 0; secant < 20 && std::abs(thrust - before) > 1e-12 * euler; ++secant) {
        REQUIRE(side_force(thrust, 1.0).converged);
        const double force = mesh.reaction_force(n)[0];
        const double next = thrust - force * (thrust - before) / (force - force_before);
        before = thrust, force_before = force, thrust = next;
    }
    return {2.0 * (rod.length - mesh.position(n)[2]), before, mesh.reaction_moment(0).norm(), 2.0 * mesh.energy()};
}

/// End rotation times GJ/EI at which a clamped rod, turned at one end that slides under the tension T, buckles.
///
/// @param tension  T L^2/EI
double twist_buckling(const RoundRod& rod, double tension, double guess, int n) {
    return bisected(0.9 * guess, 1.1 * guess, [&](double scaled) {
        const double angle = scaled * rod.EI() / rod.GJ(), EI = rod.EI() / (rod.length * rod.length);
        Rod<> mesh = rod.mesh(n);
        for (int k = 0; k <= n; ++k) {  // start from the uniform twist
            const double t = angle * k / n;
            mesh.value().segment<6>(9 * k + 3) << std::cos(t), std::sin(t), 0, -std::sin(t), std::cos(t), 0;
        }
        mesh.place(0, straight(0.0), false);
        Frame end = straight(rod.length);
        end.director_1 = Vec3(std::cos(angle), std::sin(angle), 0);
        end.director_2 = Vec3(-std::sin(angle), std::cos(angle), 0);
        mesh.place(n, end, false);
        mesh.hold(n, 0, across, Vec3::Zero());
        mesh.force(n, 0) = Vec3(0, 0, tension * EI);
        REQUIRE(mesh.solve().converged);
        return mesh.negative_pivots() > 0;
    });
}

/// Dead force along the height, at the free end of a deep cantilever, that tips it over. Pre-buckling bending included.
double lateral_torsional(double width, double height, double length, double young, double poisson, double guess, int n) {
    // The section stays plane, as in the reference: torsion_factor 1.
    const beam::SectionConstants section{width * height, width * std::pow(height, 3) / 12.0, height * std::pow(width, 3) / 12.0,
                                         1.0};
    return bisected(0.8 * guess, 1.2 * guess, [&](double load) {
        Rod<> mesh(beam::DirectorBeam<3>{}, section, {young, poisson}, n, length, straight);
        mesh.place(0, straight(0.0), false);
        REQUIRE(mesh.follow(1, [&](double t) { mesh.force(n, 0) = Vec3(t * load, 0, 0); }).converged);
        return mesh.negative_pivots() > 0;
    });
}

TEST_CASE("a straight fibre buckles at the Euler load of the director rod") {
    struct Case {
        const char* name;
        Ends ends;
        double slenderness, expected;  ///< results.director.P_cr of buckling.json
    };
    const Case cases[] = {
        {"clamped-free, L/r = 20", Ends::clamped_free, 20, 0.014222583793504},
        {"clamped-free, L/r = 100", Ends::clamped_free, 100, 0.00057143159194155},
        {"pinned-pinned, L/r = 20", Ends::pinned_pinned, 20, 0.056112154138694},
        {"pinned-pinned, L/r = 100", Ends::pinned_pinned, 100, 0.0022844581551219},
        {"clamped-clamped, L/r = 20", Ends::clamped_clamped, 20, 0.21267932798672},
        {"clamped-clamped, L/r = 100", Ends::clamped_clamped, 100, 0.0091175880505685},
    };
    std::printf("relative error of the critical load, n = 8 16 32 64\n");
    for (const Case& c : cases) {
        RoundRod rod;
        rod.length = c.slenderness * rod.radius;
        CAPTURE(c.name);
        std::vector<double> row;
        for (const int n : {8, 16, 32, 64}) row.push_back(off(euler_load(rod, c.ends, n), c.expected));
        print_row(c.name, row);
        // The error goes with (wave number x element)^4; the load with the square of the wave number.
        const double waves = c.ends == Ends::clamped_free ? 0.25 : c.ends == Ends::pinned_pinned ? 1.0 : 4.0;
        CHECK(row[0] < 1.2e-3 * waves * waves);
        CHECK(row[3] < 3e-7 * waves * waves);
        CHECK(order(row[0], row[1]) > 3.7);
    }
}

TEST_CASE("a fibre pressed beyond its Euler load takes the shape of the elastica") {
    RoundRod rod;
    rod.length = 1000.0 * rod.radius;  // inextensible to (r/L)^2 = 1e-6
    struct Case {
        double load;
        Tip expected;
    };
    const Case cases[] = {{1.05, {0.37997960564707, 0.90533562666086, 0.62156798840091}},
                          {1.2, {0.64878361363059, 0.67391200411932, 1.1844002470913}},
                          {1.5, {0.78857580569254, 0.36358822492179, 1.7221418023209}},
                          {2.0, {0.79696141551995, 0.07086181640171, 2.1738542409403}},
                          {3.0, {0.70738932296554, -0.20412350725641, 2.59064724127}}};
    std::printf("distance of the tip over L, n = 16 32 64; angle, n = 64\n");
    for (const Case& c : cases) {
        CAPTURE(c.load);
        std::vector<double> row;
        Tip tip;
        for (const int n : {16, 32, 64}) {
            tip = post_buckling(rod, c.load, n);
            row.push_back(std::hypot(tip.x - c.expected.x, tip.z - c.expected.z));
        }
        row.push_back(std::abs(tip.angle - c.expected.angle));
        char name[64];
        std::snprintf(name, sizeof name, "load over critical %g", c.load);
        print_row(name, row);
        // Close to the critical load the shape magnifies the distance of the models, a few (r/L)^2, about ten times.
        CHECK(row[2] < 3e-5);
        CHECK(row[3] < 5e-5);
    }
}

TEST_CASE("a clamped column pressed beyond buckling bears what the reference says") {
    struct Case {
        double w_over_length;
        Column expected;
    };
    const Case cases[] = {{0.02, {0.0049620244126689, 0.0022863765895598, 9.1912338900303e-05, 1.0208779130228e-05}},
                          {0.1, {0.10177219073636, 0.0023142991053129, 0.0004651741201679, 0.00023289871796458}},
                          {0.2, {0.42585985830269, 0.0024136422492144, 0.0009702841841842, 0.00099877883424615}}};
    RoundRod rod;
    rod.length = 4.02;
    std::printf("shortening, thrust, clamp moment, energy: relative distance from the Reissner rod, L/r = 200\n");
    for (const Case& c : cases) {
        const Column column = pressed_column(rod, c.w_over_length * rod.length, 64);
        const std::vector<double> row{off(column.shortening, c.expected.shortening), off(column.thrust, c.expected.thrust),
                                      off(column.clamp_moment, c.expected.clamp_moment), off(column.energy, c.expected.energy)};
        char name[64];
        std::snprintf(name, sizeof name, "w/L = %g", c.w_over_length);
        print_row(name, row);
        // The axial strain at buckling, pi^2 (r/L)^2 = 2.5e-4, times 1.5 for the law, and as much again from bending.
        for (const double value : row) CHECK(value < 6e-4);
    }
}

TEST_CASE("a fibre that is twisted between clamps buckles at Greenhill's moment") {
    RoundRod rod;
    rod.length = 1000.0 * rod.radius;
    const double cases[][2] = {{0, 8.9868189158181}, {1, 9.1347300889362}, {10, 10.428856439277}, {100, 20.983500828141}};
    std::printf("relative error of the critical rotation, n = 64 128\n");
    for (const auto& c : cases) {
        std::vector<double> row;
        for (const int n : {64, 128}) row.push_back(off(twist_buckling(rod, c[0], c[1], n), c[1]));
        char name[64];
        std::snprintf(name, sizeof name, "T L^2/EI = %g", c[0]);
        print_row(name, row);
        // A twist of 12 to 27 rad needs elements that turn by much less than 90 degrees: mesh errors at order 4, and
        // (r tau)^2 = 1e-4 to 7e-4 between the models at most.
        CHECK(row[0] < 1e-2);
        CHECK(row[1] < 5e-4);
    }
}

TEST_CASE("a deep cantilever tips over at the load that includes its bending") {
    std::printf("relative distance of the critical load from the Reissner rod, n = 16 32\n");
    const double slender[2] = {off(lateral_torsional(1.0, 8.0, 100.0, 1e4, 0.3, 19.393114326, 16), 19.393114326),
                               off(lateral_torsional(1.0, 8.0, 100.0, 1e4, 0.3, 19.393114326, 32), 19.393114326)};
    const double thick[2] = {off(lateral_torsional(0.5, 8.0, 60.0, 1e4, 0.3, 13.027009858, 16), 13.027009858),
                             off(lateral_torsional(0.5, 8.0, 60.0, 1e4, 0.3, 13.027009858, 32), 13.027009858)};
    print_row("1 x 8 x 100", {slender[0], slender[1]});
    print_row("0.5 x 8 x 60", {thick[0], thick[1]});
    // (height/L)^2 is 6e-3 and 2e-2: a small part of it is what the section strains.
    CHECK(slender[1] < 1e-3);
    CHECK(thick[1] < 1e-3);
}

}  // namespace verification_buckling_test
