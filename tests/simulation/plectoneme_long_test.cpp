// SPDX-License-Identifier: MIT
// A twisted rod whose ends approach by half of its length winds up on itself: a plectoneme.
#include <near.hpp>
#include <simulation/twisted_rod.hpp>

#include <fibrant/simulation/audit.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

using namespace fibrant;

namespace plectoneme_long_test {

const double pi = std::numbers::pi;

/// Turns of a section about the axis from node to node, beside what carries it along without twist.
double twist(const observe::FibreSnapshot& fibre) {
    double sum = 0.0;
    const std::size_t nodes = fibre.position.size();
    const auto tangent = [&](std::size_t k) {
        const Vec3 cross = fibre.director_1[k].cross(fibre.director_2[k]);
        return Vec3(cross.normalized());
    };
    for (std::size_t k = 0; k + 1 < nodes; ++k) {
        const Vec3 t = tangent(k + 1);
        const Vec3 carried = Eigen::Quaterniond::FromTwoVectors(tangent(k), t) * fibre.director_1[k];
        sum += std::atan2(carried.cross(fibre.director_1[k + 1]).dot(t), carried.dot(fibre.director_1[k + 1]));
    }
    return sum / (2.0 * pi);
}

/// Writhe of a polygon whose ends go on straight for ever: Gauss' integral over pairs of sides in closed form (Klenin and
/// Langowski 2000, method 1a).
double writhe(std::vector<Vec3> points) {
    const Vec3 first = points.front() - points[1], last = points.back() - points[points.size() - 2];
    const double far = 1e6;
    points.insert(points.begin(), Vec3(points.front() + far * first));
    points.push_back(points.back() + far * last);
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        for (std::size_t j = i + 2; j + 1 < points.size(); ++j) {
            const Vec3 a = points[j] - points[i], b = points[j + 1] - points[i], c = points[j + 1] - points[i + 1],
                       d = points[j] - points[i + 1];
            Vec3 n[4] = {a.cross(b), b.cross(c), c.cross(d), d.cross(a)};
            double area = 0.0;
            for (Vec3& normal : n) normal /= std::max(normal.norm(), 1e-300);
            for (int k = 0; k < 4; ++k) area += std::asin(std::clamp(n[k].dot(n[(k + 1) % 4]), -1.0, 1.0));
            const double side = (points[j + 1] - points[j]).cross(points[i + 1] - points[i]).dot(a);
            sum += side > 0.0 ? area : -area;
        }
    return sum / (2.0 * pi);
}

/// Winds up a rod of four turns and checks what it comes to. @returns the force of its ends [force]
template <simulation::Model M>
double wind_up(Index increments, double friction) {
    test::Twisted rod;
    rod.slack = 0.5, rod.elements = 80, rod.increments = increments, rod.damping = 1e-4;
    auto parameters = rod.parameters<M>();
    parameters.contact.detection.self_contact = true;
    if constexpr (core::Active<typename M::Friction>)
        parameters.friction = {.friction_coefficient = friction, .reversible_displacement = 0.02 * rod.radius};
    simulation::Simulator<M> simulator(rod.assembly(), parameters);
    simulation::Loading<M> loading = rod.loading<M>();
    loading.smallest_fraction = 1e-7, loading.most_rejected = 1000;  // leaps are followed by small steps and hard damping
    const simulation::Report report = simulator.run(loading);
    REQUIRE_MESSAGE(report.converged, report.reason);
    const simulation::Audit audit = simulation::audit(simulator);
    const observe::FibreSnapshot fibre = simulator.snapshot().fibres[0];
    const double twisted = twist(fibre), writhed = writhe(fibre.position);
    const double most = *std::max_element(fibre.curvature.begin(), fibre.curvature.end()) * rod.radius;
    const double force = simulator.reaction(scene::last_end(0)).x();
    std::printf(
        "plectoneme, friction %.1f, %td increments (%td accepted, %td Newton): %td contacts press, force %.6f, %.4f turns "
        "twist and %.4f writhe, r kappa %.3f, gap %.2e r, energy missing %.1e of %.1e\n",
        friction, increments, report.increments.back().number, report.counts.newton, report.contact.active, force, twisted,
        writhed, most, audit.least_gap.gap_over_radius, report.energy.error(), report.energy.elastic);
    CHECK(audit.clean());
    CHECK(report.contact.active > 20);  // strands lie on each other, and do not but cross once
    CHECK(most < 0.5);
    // Linking number = twist + writhe (Calugareanu, White, Fuller): a passage through itself would take away two. Chords of
    // 1.25 radii along arcs of some 8 radii.
    CHECK(twisted + writhed == test::near(4.0, 5e-3));
    CHECK(writhed > 2.0);
    return force;
}

TEST_CASE("a rod of four turns whose ends approach by half of its length winds up on itself in any number of increments") {
    const double smooth = wind_up<test::Smooth>(60, 0.0), rough = wind_up<test::Rough>(60, 0.1),
                 rougher = wind_up<test::Rough>(60, 0.5);
    CHECK(rough < smooth);  // friction bears a part of what the ends did
    CHECK(rougher < rough);
    // Ways over leaps differ, and strands come to lie on each other a little otherwise.
    for (const Index increments : {5, 10, 30, 100}) {
        CAPTURE(increments);
        CHECK(wind_up<test::Smooth>(increments, 0.0) == test::near(smooth, 1.5e-2));
        CHECK(wind_up<test::Rough>(increments, 0.1) == test::near(rough, 1.5e-2));
    }
}

}  // namespace plectoneme_long_test
