// SPDX-License-Identifier: MIT
// Fibres that lie in each other where a scene begins are parted by one call, or two of them are named; a plain run says so.
#include "scenes.hpp"

#include <fibrant/simulation/part_overlaps.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

using namespace fibrant;

namespace part_overlaps_test {

using Model = test::Smooth;
using Beam = Model::Beam;

constexpr double r = 0.05, length = 40.0 * r, allowed = 1e-2;  // of the thinnest radius

scene::FibreSpecification straight(const Vec3& from, const Vec3& to, double radius = r) {
    return {.from = from,
            .to = to,
            .section = scene::circular(radius),
            .material = {1e4, 0.3},
            .elements = 12,
            .director = Vec3(0.1, 0.7, 0.4)};
}
scene::FibreSpecification curved(const scene::Curve& curve, double radius = r, Index elements = 24) {
    scene::FibreSpecification fibre = straight(Vec3::Zero(), Vec3::UnitX(), radius);
    fibre.curve = curve, fibre.elements = elements;
    return fibre;
}
void clamp_ends(scene::Assembly& assembly, Index fibre) {
    assembly.clamp(scene::first_end(fibre)), assembly.clamp(scene::last_end(fibre));
}
/// Fibres whose ends are clamped, if asked for.
scene::Assembly scene_of(const std::vector<scene::FibreSpecification>& fibres, bool held) {
    scene::Assembly assembly;
    for (const scene::FibreSpecification& fibre : fibres) {
        const Index f = assembly.add(fibre);
        if (held) clamp_ends(assembly, f);
    }
    return assembly;
}
simulation::ModelParameters<Model> parameters(double thinnest, bool self = false) {
    simulation::ModelParameters<Model> parameters = test::model_parameters<Model>(thinnest);
    parameters.contact.stiffness.allowed_penetration = allowed * thinnest;
    parameters.contact.detection.self_contact = self;
    return parameters;
}
/// Least distance of the axes of fibres 0 and 1, by brute force on points.
double least_distance(const scene::Assembly& assembly, const Vector& state) {
    const beam::Mesh<Beam> mesh(assembly, Beam());
    double least = 1e300;
    const int n = 240;
    for (int a = 0; a <= n; ++a)
        for (int b = 0; b <= n; ++b)
            least = std::min(least, (mesh.position(state, 0, static_cast<double>(mesh.fibre(0).elements) * a / n) -
                                     mesh.position(state, 1, static_cast<double>(mesh.fibre(1).elements) * b / n))
                                        .norm());
    return least;
}
/// Parts the scene, and runs it from there without any limit of a gap.
simulation::Parting part(scene::Assembly assembly, double thinnest, bool self = false) {
    const simulation::Parting parting = simulation::part_overlaps<Model>(assembly, parameters(thinnest, self));
    CHECK(parting.parted);
    CHECK(parting.reason == "");
    CHECK(parting.after.depth <= allowed * thinnest);
    assembly.begin_at(parting.start);
    simulation::Simulator<Model> simulator(assembly, parameters(thinnest, self));
    simulation::Loading<Model> loading;
    loading.stages.resize(1);
    // A fibre that nothing holds needs some damping.
    loading.stages[0].increments = 2,
    loading.stages[0].damping = assembly.holds().size() < 6 * assembly.fibres().size() ? 1e-3 : 0.0;
    const simulation::Report report = simulator.run(loading);
    INFO(report.reason);
    CHECK(report.converged);
    return parting;
}

TEST_CASE("fibres side by side, on one line, across each other or end in end part, and the run goes on from there") {
    const Vec3 along(length, 0, 0), across(0, length, 0), aside(0, 1.4 * r, 0);
    for (const bool held : {false, true}) {
        CAPTURE(held);
        struct Case {
            std::string what;
            scene::FibreSpecification second;
        };
        for (const Case& one : std::vector<Case>{{"side by side", straight(aside, along + aside)},
                                                 {"on one line", straight(Vec3::Zero(), along)},
                                                 {"against each other on one line", straight(along, Vec3::Zero())},
                                                 {"axes that meet", straight(0.5 * (along - across), 0.5 * (along + across))},
                                                 {"at eleven degrees", straight(-0.1 * across, along + 0.1 * across)},
                                                 {"end in end", straight(0.99 * along, 1.99 * along)}}) {
            CAPTURE(one.what);
            const scene::Assembly assembly = scene_of({straight(Vec3::Zero(), along), one.second}, held);
            const simulation::Parting parting = part(assembly, r);
            // Sections may give way by a twentieth of a radius.
            CHECK(least_distance(assembly, parting.start) > (2.0 - 0.05) * r);
            CHECK(parting.before.depth > 0.5 * r);
            CHECK(parting.increments < 120);
        }
    }
}

TEST_CASE("a thin fibre leaves a thick one by one side, all along, however it winds inside") {
    const double thin = 0.3 * r;
    for (const double off : {0.0, 0.02 * r, 0.2 * r}) {
        CAPTURE(off);
        scene::Assembly assembly;
        assembly.add(straight(Vec3::Zero(), Vec3(length, 0, 0)));
        clamp_ends(assembly, 0);
        assembly.add(
            curved([=](double t) { return Vec3(length * t, 0.3 * r * std::sin(6.0 * std::numbers::pi * t), off); }, thin));
        const simulation::Parting parting = part(assembly, thin);
        CHECK(least_distance(assembly, parting.start) > (1.3 - 2.0 * 0.3 * allowed) * r);
        const beam::Mesh<Beam> mesh(assembly, Beam());
        Vec3 side = Vec3::Zero();
        double worst = 1.0;
        for (const bool sum : {true, false})
            for (int n = 0; n <= 48; ++n) {
                Vec3 from = mesh.position(parting.start, 1, 0.5 * n);
                from.x() = 0.0;
                if (sum)
                    side += from.normalized();
                else
                    worst = std::min(worst, from.normalized().dot(side.normalized()));
            }
        CHECK(worst > 0.3);  // nowhere on the other side
    }
}

TEST_CASE("a curve parts from itself where it lies in itself") {
    const double R = 8.0 * r;
    const scene::Curve loop = [=](double t) {  // a turn and a sixth, of which the ends are 1.4 radii above each other
        const double angle = 2.0 * std::numbers::pi * (7.0 / 6.0) * t;
        return Vec3(R * std::cos(angle), R * std::sin(angle), 1.4 * r * (7.0 / 6.0) * t);
    };
    scene::Assembly assembly;
    assembly.add(curved(loop, r, 40));
    assembly.clamp(scene::first_end(0));
    const simulation::Parting parting = part(assembly, r, true);
    CHECK(parting.before.fibre_i == 0);
    CHECK(parting.before.fibre_j == 0);
    CHECK(parting.before.depth > 0.3 * r);
}

TEST_CASE("orders that are given decide, against the places where fibres lie") {
    scene::Assembly assembly;
    const Index lower = assembly.add_group("lower"), upper = assembly.add_group("upper");
    scene::FibreSpecification first = straight(Vec3::Zero(), Vec3(length, 0, 0));
    scene::FibreSpecification second =
        straight(Vec3(0.5 * length, -0.5 * length, 0.3 * r), Vec3(0.5 * length, 0.5 * length, 0.3 * r));
    first.group = upper, second.group = lower;
    clamp_ends(assembly, assembly.add(first)), clamp_ends(assembly, assembly.add(second));
    assembly.force_order({upper, lower, Vec3::UnitZ()});
    const simulation::Parting parting = part(assembly, r);
    const beam::Mesh<Beam> mesh(assembly, Beam());
    CHECK(mesh.position(parting.start, 0, 6.0).z() - mesh.position(parting.start, 1, 6.0).z() > (2.0 - 2.0 * allowed) * r);
}

TEST_CASE("by which side fibres on one line part turns with the scene, and does not hang on their numbers") {
    const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
    const auto scene_at = [&](const Mat3& Q, bool swapped) {
        scene::FibreSpecification thick = straight(Vec3::Zero(), Q * Vec3(length, 0, 0)),
                                  thin = straight(Vec3::Zero(), Q * Vec3(length, 0, 0), 0.5 * r);
        thick.director = Q * Vec3(0, 1, 0.2), thin.director = Q * Vec3(0, 1, 0.2);
        return swapped ? scene_of({thin, thick}, false) : scene_of({thick, thin}, false);
    };
    const scene::Assembly plain = scene_at(Mat3::Identity(), false);
    const beam::Mesh<Beam> mesh(plain, Beam());
    const auto middle = [&](const Mat3& Q, bool swapped, Index fibre) {
        const Vector start = simulation::part_overlaps<Model>(scene_at(Q, swapped), parameters(0.5 * r)).start;
        return Vec3(Q.transpose() * mesh.position(start, swapped ? 1 - fibre : fibre, 6.0));
    };
    for (const Index fibre : {Index{0}, Index{1}}) {
        const Vec3 reference = middle(Mat3::Identity(), false, fibre);
        // Newton's tolerance is 1e-4 of a radius an increment, and its direction is that of rounding.
        CHECK((middle(turn, false, fibre) - reference).norm() < 1e-2 * r);
        CHECK((middle(Mat3::Identity(), true, fibre) - reference).norm() < 1e-2 * r);
    }
}

TEST_CASE("what cannot part is refused with both fibres, the depth and the place") {
    scene::FibreSpecification core = straight(Vec3::Zero(), Vec3(length, 0, 0));
    core.name = "core";
    const scene::Assembly assembly = scene_of({core, straight(Vec3(0, 1.4 * r, 0), Vec3(length, 1.4 * r, 0))}, true);
    simulation::PartingParameters held;
    held.loosen_holds = false;
    const simulation::Parting parting = simulation::part_overlaps<Model>(assembly, parameters(r), held);
    CHECK(!parting.parted);
    INFO(parting.reason);
    CHECK(parting.reason.find("fibre 0 'core' and fibre 1 are 0.0") != std::string::npos);
    CHECK(parting.reason.find(" radii of the thinner one, at (") != std::string::npos);
    CHECK(parting.reason.find("allowed are 0.0005") != std::string::npos);
}

TEST_CASE("a plain run does not begin where the axis of a fibre is in another one, and says which and how deep") {
    for (const double apart : {0.0, 0.9, 1.4}) {
        CAPTURE(apart);
        const scene::Assembly assembly = scene_of(
            {straight(Vec3::Zero(), Vec3(length, 0, 0)), straight(Vec3(0, apart * r, 0), Vec3(length, apart * r, 0))}, false);
        simulation::Simulator<Model> simulator(assembly, parameters(r));
        simulation::Loading<Model> loading;
        loading.stages.resize(1);
        loading.stages[0].increments = 2, loading.stages[0].damping = 1e-3;
        const simulation::Report report = simulator.run(loading);
        INFO(report.reason);
        CHECK(report.converged == (apart > 1.0));
        if (report.converged) continue;
        CHECK(report.counts.newton == 0);
        CHECK(report.reason.starts_with("where the scene begins, fibre 0 and fibre 1 are 0."));
        CHECK(report.reason.find("simulation::part_overlaps") != std::string::npos);
    }
}

}  // namespace part_overlaps_test
