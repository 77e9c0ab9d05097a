// SPDX-License-Identifier: MIT
#pragma once
/// @file Small scenes as plain data, so that they can be moved, mirrored, scaled, renamed and drawn at random; and measures of
/// what came of them that share no code with contact.

#include <support/models.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::test {

using StableModel = EveryDirector;

/// How an end is held.
enum class Held { free, pinned, clamped };

struct SmallFibre {
    Vec3 from, to;
    Vec3 move_from = Vec3::Zero(), move_to = Vec3::Zero();  ///< of the ends over the loading [length]
    double radius = 0.0201, young = 7300.0;
    Index elements = 8;
    Held held_from = Held::clamped, held_to = Held::clamped;
    Vec3 director = Vec3::Zero();
    Vec3 push = Vec3::Zero();  ///< dead force on the middle [force]
};

struct SmallScene {
    std::vector<SmallFibre> fibres;
    double friction = 0.15;
    double allowed = 1e-2;  ///< penetration [radius of the thinnest fibre]
    double penalty = 0.0;   ///< stiffness that stays as it is, over that of a section; 0: adapted to the penetration
    double spacing = 2.0;   ///< points an element
    double damping = 0.0;   ///< [force / length]
    Index increments = 4;
    bool tight = false;              ///< tolerances that leave rounding only
    std::vector<double> cycle{1.0};  ///< amplitudes that the loading goes to, `increments` each

    double radius() const {
        double least = std::numeric_limits<double>::infinity();
        for (const SmallFibre& fibre : fibres) least = std::min(least, fibre.radius);
        return least;
    }
};

/// The scene turned (or mirrored) by Q, then moved.
inline SmallScene moved(SmallScene scene, const Mat3& Q, const Vec3& shift) {
    for (SmallFibre& f : scene.fibres) {
        f.from = Q * f.from + shift, f.to = Q * f.to + shift;
        f.move_from = (Q * f.move_from).eval(), f.move_to = (Q * f.move_to).eval();
        f.director = (Q * f.director).eval(), f.push = (Q * f.push).eval();
    }
    return scene;
}
/// In other units.
inline SmallScene scaled(SmallScene scene, double length, double force) {
    for (SmallFibre& f : scene.fibres) {
        f.from *= length, f.to *= length, f.move_from *= length, f.move_to *= length;
        f.radius *= length, f.young *= force / (length * length), f.push *= force;
    }
    scene.damping *= force / length;
    return scene;
}
inline SmallScene permuted(SmallScene scene, const std::vector<std::size_t>& order) {
    const std::vector<SmallFibre> before = scene.fibres;
    for (std::size_t k = 0; k < order.size(); ++k) scene.fibres[k] = before[order[k]];
    return scene;
}
inline SmallScene reversed(SmallScene scene) {
    for (SmallFibre& f : scene.fibres)
        std::swap(f.from, f.to), std::swap(f.move_from, f.move_to), std::swap(f.held_from, f.held_to);
    return scene;
}

struct SmallResult {
    simulation::Report report;
    std::vector<std::vector<Vec3>> centreline;                  ///< of each fibre, at eighths of its elements [length]
    std::vector<std::vector<std::pair<Vec3, Vec3>>> directors;  ///< at the same places
    std::vector<Vec3> support;                                  ///< what holds each fibre at its two ends [force]
    double reactions = 0.0;                                     ///< sum of the sizes of all reactions at ends [force]
    Vector state;
    observe::Snapshot snapshot;
    bool finite() const { return state.allFinite(); }
};

inline scene::Assembly assembly_of(const SmallScene& small) {
    scene::Assembly assembly;
    for (const SmallFibre& f : small.fibres) {
        scene::FibreSpecification specification{
            .from = f.from, .to = f.to, .section = scene::circular(f.radius), .material = {f.young, 0.3}, .elements = f.elements};
        specification.director = f.director;
        const Index fibre = assembly.add(specification);
        for (const bool last : {false, true}) {
            const Held held = last ? f.held_to : f.held_from;
            const Vec3& move = last ? f.move_to : f.move_from;
            const scene::Station at = last ? scene::last_end(fibre) : scene::first_end(fibre);
            if (held == Held::clamped) assembly.clamp(at, move);
            if (held == Held::pinned) assembly.prescribe(at, move);
        }
        if (f.held_from == Held::pinned && f.held_to != Held::clamped) assembly.hold_axial_rotation(scene::first_end(fibre));
        if (!f.push.isZero(0.0)) assembly.apply(scene::DeadForce{{fibre, 0.5}, scene::NodeVector::position, f.push, "motion"});
    }
    return assembly;
}

/// With multipliers `allowed` is what they leave.
template <simulation::Model M>
simulation::ModelParameters<M> parameters_of(const SmallScene& small) {
    simulation::ModelParameters<M> parameters = direct_parameters<M>();
    const double r = small.radius();
    const typename StableModel::Normal::Parameters penalty{.regularisation_depth = 0.1 * small.allowed * r};
    if constexpr (law::Augmenting<typename M::Normal>)
        parameters.normal = {.law = penalty, .largest_penetration = small.allowed * r},
        parameters.iteration.multiplier_limit = 1000;
    else
        parameters.normal = penalty;
    contact::StiffnessAdaptation& stiffness = parameters.contact.stiffness;
    stiffness.allowed_penetration = small.allowed * r;
    if (small.penalty > 0.0) stiffness.initial_fraction = stiffness.floor_fraction = stiffness.cap_fraction = small.penalty;
    parameters.contact.spacing.points_per_element = small.spacing;
    parameters.friction = {.friction_coefficient = small.friction, .reversible_displacement = 0.02 * r};
    if (small.tight) {
        parameters.iteration.step_tolerance = 1e-10, parameters.iteration.residual_tolerance = 1e-11;
        parameters.iteration.normal_tolerance = parameters.iteration.normal_step_tolerance = 1e-8,
        parameters.iteration.contact_tolerance = 1e-7;
        parameters.iteration.inexact = 0.01, parameters.iteration.linear_tolerance = 1e-10;
        parameters.iteration.newton_limit = 40, parameters.iteration.normal_limit = parameters.iteration.contact_limit = 30;
    }
    return parameters;
}

template <simulation::Model M = StableModel>
SmallResult run(const SmallScene& small) {
    simulation::Simulator<M> simulator(assembly_of(small), parameters_of<M>(small));
    simulation::Loading<M> loading;
    for (const double amplitude : small.cycle) {
        simulation::Stage<M> stage;
        stage.ramps = {{"motion", amplitude, false}};
        stage.increments = small.increments;
        stage.damping = small.damping;
        stage.most_increments = std::max<Index>(100, 4 * small.increments);
        loading.stages.push_back(stage);
    }
    SmallResult result;
    result.report = simulator.run(loading);
    result.state = simulator.state();
    result.snapshot = simulator.snapshot();
    for (Index f = 0; f < core::count(small.fibres); ++f) {
        std::vector<Vec3> line;
        std::vector<std::pair<Vec3, Vec3>> directors;
        for (Index k = 0; k <= 8 * simulator.mesh().fibre(f).elements; ++k) {
            line.push_back(simulator.mesh().position(simulator.state(), f, 0.125 * static_cast<double>(k)));
            directors.push_back(simulator.mesh().directors(simulator.state(), f, 0.125 * static_cast<double>(k)));
        }
        result.centreline.push_back(line), result.directors.push_back(directors);
        result.reactions += simulator.reaction(scene::first_end(f)).norm() + simulator.reaction(scene::last_end(f)).norm();
        result.support.push_back(simulator.reaction(scene::first_end(f)) + simulator.reaction(scene::last_end(f)));
    }
    return result;
}

/// Closest points of two segments, a + s (b - a) and c + t (d - c).
struct ClosestPoints {
    double distance = 1e300, s = 0.0, t = 0.0;
};

/// By the closed form for lines, and the four ends.
inline ClosestPoints closest_points(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    ClosestPoints best;
    const Vec3 u = b - a, v = d - c, w = a - c, n = u.cross(v);
    const auto see = [&](double s, double t) {
        const double distance = (w + s * u - t * v).norm();
        if (distance < best.distance) best = {distance, s, t};
    };
    const auto on = [](const Vec3& from, const Vec3& along, const Vec3& x) {
        return std::clamp((x - from).dot(along) / std::max(along.squaredNorm(), 1e-300), 0.0, 1.0);
    };
    see(0.0, on(c, v, a)), see(1.0, on(c, v, b)), see(on(a, u, c), 0.0), see(on(a, u, d), 1.0);
    if (n.squaredNorm() > 1e-20 * u.squaredNorm() * v.squaredNorm()) {
        const double s = v.cross(w).dot(n) / n.squaredNorm(), t = u.cross(w).dot(n) / n.squaredNorm();
        if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) see(s, t);
    }
    return best;
}

/// Greatest depth of two fibres in each other, over the smaller radius, < 0 if all are apart; by brute force.
inline double deepest(const std::vector<std::vector<Vec3>>& lines, const std::vector<double>& radius) {
    double deepest = -1e300;
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (std::size_t j = i + 1; j < lines.size(); ++j) {
            double least = 1e300;
            for (std::size_t a = 1; a < lines[i].size(); ++a)
                for (std::size_t b = 1; b < lines[j].size(); ++b)
                    least = std::min(least, closest_points(lines[i][a - 1], lines[i][a], lines[j][b - 1], lines[j][b]).distance);
            deepest = std::max(deepest, (radius[i] + radius[j] - least) / std::min(radius[i], radius[j]));
        }
    return deepest;
}
inline double deepest(const SmallScene& scene, const SmallResult& result) {
    std::vector<double> radius;
    for (const SmallFibre& f : scene.fibres) radius.push_back(f.radius);
    return deepest(result.centreline, radius);
}

/// A fibre pressed down across another one and dragged along it, a third one lying beside the lower one.
inline SmallScene dragged_three() {
    const double r = 0.0201;
    SmallScene scene;
    SmallFibre lower{Vec3(0, -0.5, 0), Vec3(0, 0.5, 0)}, beside{Vec3(2.05 * r, -0.45, 0.0), Vec3(2.3 * r, 0.45, 0.3 * r)},
        upper{Vec3(-0.5, 0.05, 2.02 * r), Vec3(0.5, -0.02, 2.02 * r)};
    upper.move_from = upper.move_to = Vec3(-0.4, 0.1, -1.5) * r;
    lower.director = Vec3::UnitX(), beside.director = Vec3::UnitZ(), upper.director = Vec3::UnitZ();
    scene.fibres = {lower, upper, beside};
    return scene;
}

}  // namespace fibrant::test
