// SPDX-License-Identifier: MIT
#pragma once
/// @file A dense mat: fibres that lie in each other are parted, and pressed from one volume fraction to the next, at each of
/// which they come to rest.

#include <fibrant/compositions/mat/compaction.hpp>
#include <fibrant/simulation/settling.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fibrant::compositions::mat {

/// How a mat is parted and pressed. It starts dense: fibres with few contacts are held by nothing but springs, which then are
/// what plates feel.
struct LevelParameters {
    double ratio = 1.17;                ///< of the volume fractions of two levels [1], > 1
    double last = core::unset;          ///< volume fraction that no level exceeds [1]
    double step = 0.4;                  ///< of the plate in an increment [radius], > 0
    double gap_limit = 0.3;             ///< by which fibres that lie in each other part in an increment [radius], > 0
    double friction_coefficient = 0.2;  ///< of fibres on each other, once they are parted [1], >= 0
    double allowed_penetration = 0.05;  ///< [radius], > 0
    /// Least stiffness of a contact, of that of a section: one that carries nothing while a mat rests is softened down to it, and
    /// takes several increments to become as stiff as the next press needs [1], > 0.
    double softest = 1e-2;
    double rest_share = 5e-4;    ///< at rest, springs hold no more than this of the forces [1], > 0;
    Index rest_increments = 20;  ///< or so many increments have gone by: a mat with friction creeps for long, >= 1
    /// Springs from every centre to its last place while fibres are pressed, over `bending_stiffness` [1], > 0. They go along
    /// with the mean motion, and are let go at each level.
    double damping = 1e-3;
    double looseness = 20.0;  ///< on the tolerances of contact and normal passes while a mat is pressed [1], in [1, 1000]
    void validate(const MatParameters& mat) const {
        core::require(ratio > 1.0, "LevelParameters.ratio", ratio, "> 1");
        const double first = mat.volume_fraction(mat.height);
        core::require(last >= first * ratio && last < 0.9, "LevelParameters.last", last,
                      "< 0.9 and at least that of the first level, " + core::text(first * ratio));
        core::require_positive("LevelParameters.step", step);
        core::require_positive("LevelParameters.gap_limit", gap_limit);
        core::require_not_negative("LevelParameters.friction_coefficient", friction_coefficient);
        core::require_positive("LevelParameters.allowed_penetration", allowed_penetration);
        core::require_positive("LevelParameters.softest", softest);
        core::require(rest_share > 0.0 && rest_share <= 0.01, "LevelParameters.rest_share", rest_share, "> 0 and <= 0.01");
        core::require_at_least("LevelParameters.rest_increments", rest_increments, 1);
        core::require_positive("LevelParameters.damping", damping);
        core::require_between("LevelParameters.looseness", looseness, 1.0, 1000.0);
    }
};

/// Parameters of a model whose normal law is a limited, regularised penalty.
template <simulation::Model M>
simulation::ModelParameters<M> model_parameters(const MatParameters& parameters, const LevelParameters& levels) {
    parameters.validate(), levels.validate(parameters);
    const double r = parameters.radius;
    simulation::ModelParameters<M> model;
    model.normal.law.regularisation_depth = 0.25 * levels.allowed_penetration * r, model.normal.limit = levels.gap_limit * r;
    // While fibres part, friction would remember a path that is none.
    if constexpr (core::Active<typename M::Friction>)
        model.friction = {.friction_coefficient = 0.0, .reversible_displacement = reversible_over_radius * r};
    model.contact.stiffness.allowed_penetration = levels.allowed_penetration * r;
    // Between contacts a few radii apart a fibre is as stiff as its contacts: softer ones let fibres into each other for many
    // increments.
    model.contact.stiffness.initial_fraction = 0.03, model.contact.stiffness.floor_fraction = levels.softest;
    model.iteration.newton_limit = 30, model.iteration.overshoot = 0.5;
    return model;
}

/// The stages that settle any assembly, then "press" and "level" as often as there are levels. What is measured is the last
/// increment of a level.
/// @param mat  `boxed_mat` of these parameters
template <simulation::Model M>
simulation::Loading<M> pressing_by_levels(const MatParameters& parameters, const LevelParameters& levels,
                                          const scene::Assembly& mat) {
    parameters.validate(), levels.validate(parameters);
    const double r = parameters.radius;
    simulation::SettleParameters settle{.friction_coefficient = levels.friction_coefficient,
                                        .allowed_penetration_over_radius = levels.allowed_penetration,
                                        .gap_limit_over_radius = levels.gap_limit,
                                        .rest_increments = levels.rest_increments,
                                        .rest_share = levels.rest_share};
    simulation::Loading<M> loading = simulation::settling<M>(mat, settle);
    // Increments that are cut are no rest yet: few are enough only once one was whole.
    constexpr Index whole = 20;
    loading.stages.back().enough_increments = levels.rest_increments;
    loading.stages.back().most_increments = std::max(whole, levels.rest_increments);
    if constexpr (core::Active<typename M::Friction>)
        for (simulation::Stage<M>& stage : loading.stages)
            if (stage.friction)
                stage.friction.emplace(typename M::Friction::Parameters{levels.friction_coefficient, reversible_over_radius * r});
    simulation::Stage<M> level;
    level.name = "level", level.increments = 1, level.looseness = levels.looseness;
    level.largest_displacement = 2.0 * r, level.damping_goes_on = true;
    level.damping_decay = 0.5, level.damping_share = 1.0, level.damping_calm = 1.5 * r;
    level.until = [share = levels.rest_share,
                   depth = 6.0 * levels.allowed_penetration * r](const simulation::IncrementReport& increment) {
        return increment.damping <= share && increment.contact.greatest_penetration < depth;
    };
    level.enough_increments = levels.rest_increments, level.most_increments = std::max<Index>(200, levels.rest_increments);
    simulation::Stage<M> press;
    press.name = "press", press.damping = levels.damping * bending_stiffness(parameters), press.damping_carried = true,
    press.looseness = levels.looseness;
    press.largest_displacement = 2.0 * r;
    level.damping = press.damping;
    // Springs that cuts make harder are let go again at each level: attempts that fail do little harm.
    loading.most_rejected = 2000;
    double height = parameters.height;
    for (double fraction = levels.ratio * parameters.volume_fraction(height); fraction < 1.0001 * levels.last;
         fraction *= levels.ratio) {
        const double to = parameters.volume_fraction(1.0) / fraction;
        press.ramps = {{mat::press_channel, parameters.height - to}};
        press.increments = std::max<Index>(1, static_cast<Index>(std::ceil((height - to) / (levels.step * r)))),
        press.most_increments = 400 + 40 * press.increments;
        loading.stages.push_back(press), loading.stages.push_back(level);
        height = to;
    }
    return loading;
}

/// The last increment of a level.
struct LevelState {
    MatState mat{};
    double springs = 0.0;  ///< that they hold of the forces [1]
    /// Both plates feel the same, within a twentieth, and springs hold no more than a hundredth of the forces: they are a figure
    /// of the mat.
    bool at_rest() const noexcept {
        return springs <= 0.01 && std::abs(mat.pressure - mat.lower_pressure) <= 0.05 * mat.pressure;
    }
};

/// Keeps the state of each level: an observer.
template <simulation::Model M>
class LevelRecord {
public:
    LevelRecord(const simulation::Simulator<M>& simulator, const MatParameters& parameters)
        : simulator_{&simulator}, parameters_{&parameters} {}
    void reported(const simulation::IncrementReport& increment) {
        if (increment.stage != "level") {
            open_ = false;
            return;
        }
        if (!open_) levels_.emplace_back();
        open_ = true, levels_.back() = {measure(*simulator_, *parameters_), increment.damping};
    }
    const std::vector<LevelState>& levels() const noexcept { return levels_; }

private:
    const simulation::Simulator<M>* simulator_;
    const MatParameters* parameters_;
    std::vector<LevelState> levels_;
    bool open_ = false;
};

}  // namespace fibrant::compositions::mat
