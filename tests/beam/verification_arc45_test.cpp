// SPDX-License-Identifier: MIT
// Bathe and Bolourchi's 45-degree bend. Reference: the Reissner rod by a boundary-value solver. The director rod
// differs from it by 0.8 (side/R)^2, 8e-5 for the thick section and 8e-7 for the slender one.
#include <beam/round_rod.hpp>

using namespace fibrant;

namespace verification_arc45_test {

using namespace fibrant::test;

struct Arc {
    double side = 1.0, force = 300.0, shear_factor = 1.0, torsion_constant = 1.0 / 6.0;
    double radius = 100.0, angle = std::numbers::pi / 4.0, young = 1e7, poisson = 0.0;
};
struct Bent {
    Vec3 tip = Vec3::Zero(), tangent = Vec3::Zero(), normal = Vec3::Zero(), mid = Vec3::Zero(), moment = Vec3::Zero();
    double energy = 0;
    RodSolution solution;
};

/// In the plane x-y from the origin along +x towards +y; d_1 to the centre, d_2 = z; dead force along +z.
Bent bend(const Arc& arc, int intervals, int steps = 1) {
    const double inertia = std::pow(arc.side, 4) / 12.0;
    const beam::SectionConstants section{arc.side * arc.side, inertia, inertia, arc.torsion_constant / (2.0 * inertia)};
    const auto shape = [&](double s) -> Frame {
        const double t = s / arc.radius;
        return {arc.radius * Vec3(std::sin(t), 1.0 - std::cos(t), 0), Vec3(-std::sin(t), std::cos(t), 0), Vec3::UnitZ()};
    };
    Rod<> mesh(beam::DirectorBeam<3>{{.shear_factor = arc.shear_factor}}, section, {arc.young, arc.poisson}, intervals,
               arc.radius * arc.angle, shape);
    mesh.place(0, shape(0.0), false);
    Bent b;
    b.solution = mesh.follow(steps, [&](double t) { mesh.force(intervals, 0) = Vec3(0, 0, t * arc.force); });
    b.tip = mesh.position(intervals);
    b.tangent = mesh.normal(intervals);
    b.normal = mesh.director(intervals, 1).normalized();
    b.mid = mesh.position(intervals / 2);
    b.moment = -mesh.reaction_moment(0);
    b.energy = mesh.energy();
    return b;
}

struct Case {
    const char* name;
    Arc arc;
    Bent expected;
};
const std::vector<Case>& cases() {
    static const std::vector<Case> all = {
        {"300",
         {.force = 300},
         {{58.779122489683, 22.244780945368, 40.191891670151},
          {0.45123622293776, 0.53935267495064, 0.71097437586206},
          {-0.61804660923558, 0.76357673283404, -0.18699989809331},
          {35.50540090841, 6.2289651033822, 13.318300816211},
          {6673.4342836103, -17633.736746905, 0.0},
          5055.0364800355,
          {}}},
        {"450",
         {.force = 450},
         {{52.238558011155, 18.508178925369, 48.502927344141},
          {0.32473572326118, 0.45476395316686, 0.82929877422922},
          {-0.56780390764073, 0.79496826669418, -0.21359816810348},
          {33.754406637642, 5.4239686791025, 16.758989927203},
          {8328.6805164163, -23507.35110502, 0.0},
          8113.8187368958,
          {}}},
        {"600",
         {.force = 600},
         {{47.150438573629, 15.684800534039, 53.474858791825},
          {0.23504238380996, 0.39314529280039, 0.88892736292783},
          {-0.52759226242681, 0.81969855549642, -0.223026192956},
          {32.22919101152, 4.7731600445013, 19.126456058852},
          {9410.8803204233, -28290.263144177, 0.0},
          10695.374391691,
          {}}},
        {"600, engineering section",
         {.force = 600, .shear_factor = 5.0 / 6.0, .torsion_constant = 0.140577014955},
         {{46.891586390963, 15.557676239373, 53.607986317182},
          {0.22276709712989, 0.38665402104472, 0.89491535267101},
          {-0.56379140505717, 0.79999427349813, -0.20530078897526},
          {32.223793357694, 4.7734895525812, 19.120898555106},
          {9334.6057436235, -28134.951834578, 0.0},
          10638.201518257,
          {}}},
        {"600, slender",
         {.side = 0.1, .force = 0.06, .torsion_constant = 1.66666666667e-05},
         {{47.151285842085, 15.685075385944, 53.468661045426},
          {0.23502816064234, 0.39313480530563, 0.88893576177493},
          {-0.52758659929302, 0.81970225561443, -0.22302599038464},
          {32.229828983628, 4.7732268978773, 19.122777368994},
          {0.94110452315664, -2.8290771505251, 0.0},
          1.0693715752899,
          {}}},
    };
    return all;
}

TEST_CASE("the 45-degree bend converges with the fourth order, in one load step") {
    std::printf("distance of the tip from the own limit over R, n = 8 16 32 64; from the Reissner rod, n = 64; iterations\n");
    for (const Case& c : cases()) {
        CAPTURE(c.name);
        const Bent limit = bend(c.arc, 256);
        std::vector<double> row;
        Bent finest;
        for (const int n : {8, 16, 32, 64}) {
            finest = bend(c.arc, n);
            REQUIRE(finest.solution.converged);
            CHECK(finest.solution.iterations <= 12);
            row.push_back((finest.tip - limit.tip).norm() / c.arc.radius);
        }
        CHECK(row[0] < 2.5e-4);
        CHECK(row[1] < 1e-5);
        CHECK(row[2] < 6e-7);
        CHECK(order(row[2], row[3]) > 3.7);
        row.push_back((finest.tip - c.expected.tip).norm() / c.arc.radius);
        row.push_back(finest.solution.iterations);
        print_row(c.name, row);
        // 1.3 times the known distance of the two models in the tip; moments and energy are off by the same order.
        const double models = std::pow(c.arc.side / c.arc.radius, 2);
        CHECK(row[4] < 1.1 * models + 1e-7);
        CHECK((finest.mid - c.expected.mid).norm() < (1.1 * models + 1e-7) * c.arc.radius);
        CHECK((finest.tangent - c.expected.tangent).norm() < 2.0 * models + 1e-6);
        CHECK((finest.normal - c.expected.normal).norm() < 2.0 * models + 1e-6);
        CHECK((finest.moment - c.expected.moment).norm() < (2.0 * models + 1e-6) * c.expected.moment.norm());
        CHECK(off(finest.energy, c.expected.energy) < 2.0 * models + 1e-6);
    }
}

}  // namespace verification_arc45_test
