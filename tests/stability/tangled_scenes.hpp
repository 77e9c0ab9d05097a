// SPDX-License-Identifier: MIT
#pragma once
/// @file Random scenes of hooks, rings and flat fibres that are driven far in few increments, and a look at every accepted one
/// that shares no code with contact.

#include <stability/passage_scenes.hpp>

#include <numbers>

namespace fibrant::test {

/// What a tangled scene is made of.
enum class Tangle { hooks, hooked_straight, linked_rings, ring_and_straight, flat };

struct TangledScene {
    Tangle kind = Tangle::hooks;
    scene::Assembly assembly{};
    std::vector<double> half_width{};  ///< the lesser one of each fibre [length]
    std::vector<bool> closed{};
    double friction = 0.0;
    Index increments = 1;
};

/// Half rings that hang in each other at 20 to 90 degrees, or in a straight fibre, pulled apart by 0.1 to 1.5 of their radius;
/// closed rings through each other or around a straight fibre, dragged by one place each; flat straight fibres driven through
/// where others are. In one to twenty increments.
inline TangledScene tangled_scene(std::uint64_t seed) {
    Uniform uniform(seed);
    TangledScene scene;
    scene.kind = static_cast<Tangle>(seed % 5);
    scene.friction = uniform(0.0, 1.0) < 0.4 ? 0.0 : uniform(0.05, 0.5);
    scene.increments = static_cast<Index>(std::pow(20.0, uniform(0.0, 1.0)));
    const double pi = std::numbers::pi, r = 0.05, r_2 = r * std::pow(2.0, uniform(-1.0, 1.0));
    const auto add = [&](scene::FibreSpecification fibre, const scene::CrossSection& section) {
        fibre.section = section, fibre.material = {1e4, 0.3};
        scene.half_width.push_back(std::min(section.semi_axis_1, section.semi_axis_2)), scene.closed.push_back(fibre.closed);
        return scene.assembly.add(fibre);
    };
    const auto hold_ends = [&](Index fibre, const Vec3& way) {
        scene.assembly.clamp(scene::first_end(fibre), way), scene.assembly.clamp(scene::last_end(fibre), way);
    };
    const double R = r * uniform(12.0, 30.0), R_2 = r * uniform(12.0, 30.0), angle = uniform(20.0, 90.0) * pi / 180.0,
                 gap = uniform(0.0, 1.0) * r;
    const auto elements = [&] { return 16 + static_cast<Index>(uniform(0.0, 24.999)); };
    const Vec3 along(std::cos(angle), std::sin(angle), 0.0);
    const double pull = uniform(0.1, 1.5) * std::min(R, R_2);
    const auto straight = [](const Vec3& from, const Vec3& to, Index count) {
        return scene::FibreSpecification{.from = from, .to = to, .elements = count};
    };
    if (scene.kind == Tangle::hooks || scene.kind == Tangle::hooked_straight) {
        scene::FibreSpecification ring;
        ring.elements = elements();
        ring.curve = [=](double t) {
            return Vec3(-R * std::cos(pi * t), 0.0, R - R * std::sin(pi * t));
        };  // its lowest point is the origin
        hold_ends(add(ring, scene::circular(r)), 0.5 * pull * Vec3::UnitZ());
        const double top = r + r_2 + gap;  // the other one passes above that point
        if (scene.kind == Tangle::hooks) {
            ring.elements = elements();
            ring.curve = [=](double t) {
                return Vec3(R_2 * std::cos(pi * t) * along + (top - R_2 + R_2 * std::sin(pi * t)) * Vec3::UnitZ());
            };
            hold_ends(add(ring, scene::circular(r_2)), -0.5 * pull * Vec3::UnitZ());
        } else {
            const double half = r * uniform(20.0, 60.0);
            const Vec3 across(-along.y(), along.x(), 0.0), middle(0.0, 0.0, top);
            hold_ends(add(straight(middle - half * across, middle + half * across, elements()), scene::circular(r_2)),
                      -0.5 * pull * Vec3::UnitZ());
        }
    } else if (scene.kind == Tangle::linked_rings || scene.kind == Tangle::ring_and_straight) {
        scene::FibreSpecification ring;
        ring.closed = true, ring.elements = 2 * elements();
        ring.curve = [=](double t) {
            return Vec3(R * std::sin(2.0 * pi * t), 0.0, R + R * std::cos(2.0 * pi * t));
        };  // held at its top
        const Index upper = add(ring, scene::circular(r));
        scene.assembly.clamp({upper, 0.0}, 0.5 * pull * Vec3::UnitZ());
        const double top = r + r_2 + gap;
        if (scene.kind == Tangle::linked_rings) {
            ring.elements = 2 * elements();
            ring.curve = [=](double t) {
                return Vec3(R_2 * std::sin(2.0 * pi * t) * along + (top - R_2 - R_2 * std::cos(2.0 * pi * t)) * Vec3::UnitZ());
            };
            scene.assembly.clamp({add(ring, scene::circular(r_2)), 0.0}, -0.5 * pull * Vec3::UnitZ());
        } else {
            const double half = r * uniform(20.0, 60.0);
            const Vec3 across(-along.y(), along.x(), 0.0), middle(0.0, 0.0, top);
            hold_ends(add(straight(middle - half * across, middle + half * across, elements()), scene::circular(r_2)),
                      -0.5 * pull * Vec3::UnitZ());
        }
    } else {
        const int wanted = 2 + static_cast<int>(uniform(0.0, 1.999));
        for (int k = 0; k < wanted; ++k) {
            const double thin = r * uniform(0.4, 1.0), wide = thin * uniform(1.0, 4.0), half = r * uniform(20.0, 50.0),
                         turn = uniform(0.0, pi);
            const Vec3 axis(std::cos(turn), std::sin(turn), 0.0),
                middle(uniform(-5.0, 5.0) * r, uniform(-5.0, 5.0) * r, 6.0 * k * r);
            scene::FibreSpecification fibre =
                straight(middle - half * axis, middle + half * axis, 8 + static_cast<Index>(uniform(0.0, 8.999)));
            fibre.director = uniform(0.0, 1.0) < 0.5 ? Vec3(Vec3::UnitZ()) : Vec3(axis.cross(Vec3::UnitZ()));
            hold_ends(add(fibre, scene::elliptical(thin, wide)),
                      Vec3(uniform(-4.0, 4.0) * r, uniform(-4.0, 4.0) * r, (k == 0 ? 1.0 : -1.0) * uniform(2.0, 20.0) * r));
        }
    }
    return scene;
}

/// How tangled scenes came out.
struct TangledCount {
    std::uint64_t scenes = 0, converged = 0, passages = 0;
    double closest = 1e300;  ///< on the way of any accepted increment [touching distance of the lesser half widths]
};

/// Runs tangled scenes of seeds first, first + 1, ...: no accepted increment takes a fibre through another one, and what stops
/// says why.
inline TangledCount check_tangles(std::uint64_t first, std::uint64_t count, bool told = false) {
    TangledCount sum;
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        CAPTURE(seed);
        const TangledScene scene = tangled_scene(seed);
        SmallScene plain;
        plain.friction = scene.friction;
        simulation::ModelParameters<StableModel> parameters = parameters_of<StableModel>(plain);
        const double r = *std::min_element(scene.half_width.begin(), scene.half_width.end());
        parameters.normal.regularisation_depth = 1e-3 * r, parameters.contact.stiffness.allowed_penetration = 1e-2 * r;
        parameters.friction.reversible_displacement = 0.02 * r;
        simulation::Simulator<StableModel> simulator(scene.assembly, parameters);
        simulation::Loading<StableModel> loading;
        loading.increments = scene.increments, loading.most_rejected = 30;
        Ways<StableModel> ways{&simulator};
        ways.see();
        const simulation::Report report = simulator.run(loading, ways);
        if (!report.converged) CHECK_FALSE(report.reason.empty());
        ++sum.scenes, sum.converged += report.converged;
        double least = 1e300;
        for (std::size_t n = 1; n < ways.lines.size(); ++n)
            for (std::size_t i = 0; i < scene.half_width.size(); ++i)
                for (std::size_t j = i + 1; j < scene.half_width.size(); ++j)
                    least = std::min(least, closest_on_the_way(ways.lines[n - 1][i], ways.lines[n][i], ways.lines[n - 1][j],
                                                               ways.lines[n][j], scene.half_width[i] + scene.half_width[j]));
        if (told)
            std::printf("seed %llu kind %d mu %.2f inc %td: %s closest %.3f accepted %zu rejected %td newton %td %s\n",
                        static_cast<unsigned long long>(seed), static_cast<int>(scene.kind), scene.friction, scene.increments,
                        report.converged ? "ok " : "BAD", least, report.increments.size(), report.rejected_increments,
                        report.counts.newton, report.reason.substr(0, 230).c_str()),
                std::fflush(stdout);
        sum.passages += least < 0.4, sum.closest = std::min(sum.closest, least);
        CHECK(least > 0.4);
    }
    return sum;
}

}  // namespace fibrant::test
