// SPDX-License-Identifier: MIT
#pragma once
/// @file A loading programme as plain data, whatever the model: stages of ramps, cycles, friction that changes, and rest.

#include <fibrant/law/shaped_friction.hpp>
#include <fibrant/simulation/simulator.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace fibrant::simulation {

/// One stage: its ramps, as often to and fro as it says, or a rest until nothing moves any more.
struct ProgrammeStage {
    std::string name = "loading";
    Index increments = 10;             ///< of each ramp, >= 1
    std::vector<Ramp> ramps{};         ///< channels that it moves, and where to
    Index cycles = 0;                  ///< times to and back again; 0: to, and no further, >= 0
    double back = 0.0;                 ///< amplitude at the end of each cycle
    std::optional<double> friction{};  ///< coefficient from here on [1], >= 0
    bool rest = false;                 ///< goes on until forces balance, after its ramps
    double damping = 0.0;    ///< over that of the programme [1], >= 0; falls in a stage that rests, is carried along in others
    double looseness = 5.0;  ///< on the tolerances of passes, >= 1
};

/// A programme and what its stages share.
struct LoadProgramme {
    std::vector<ProgrammeStage> stages{};   ///< one after the other, at least one
    double damping = 0.0;                   ///< unit of the stages' damping [force / length], >= 0
    double rest_motion = core::unset;       ///< of an increment at rest [length], > 0, unless
    double rest_share = 1e-4;               ///< damping holds no more than this part of the forces [1], in (0, 0.01]
    double rest_penetration = core::unset;  ///< allowed at rest [length], > 0
    double calm = std::numeric_limits<double>::infinity();  ///< greatest displacement of an increment after which damping falls
                                                            ///< [length], > 0
    double reversible_displacement = core::unset;           ///< of friction [length], > 0 where a stage changes it
    law::FrictionShape friction_shape{};                    ///< what it is over Coulomb's, of a model whose law has a shape
    double largest_displacement = std::numeric_limits<double>::infinity();  ///< of an increment [length], > 0
    Index halvings = 0;                                                     ///< of all increments of ramps, >= 0

    void validate() const {
        core::require_not_negative("LoadProgramme.damping", damping);
        core::require(rest_share > 0.0 && rest_share <= 0.01, "LoadProgramme.rest_share", rest_share, "> 0 and <= 0.01");
        core::require(largest_displacement > 0.0, "LoadProgramme.largest_displacement", largest_displacement, "> 0");
        core::require_at_least("LoadProgramme.halvings", halvings, 0);
        friction_shape.validate();
        if (stages.empty()) core::refuse("LoadProgramme.stages", "none", "at least one");
        for (const ProgrammeStage& stage : stages) {
            core::require_at_least("ProgrammeStage.increments", stage.increments, 1);
            core::require_at_least("ProgrammeStage.cycles", stage.cycles, 0);
            core::require_finite("ProgrammeStage.back", stage.back);
            core::require_not_negative("ProgrammeStage.damping", stage.damping);
            if (stage.friction) {
                core::require_not_negative("ProgrammeStage.friction", *stage.friction);
                core::require_positive("LoadProgramme.reversible_displacement", reversible_displacement);
            }
            if (stage.rest) {
                core::require_positive("LoadProgramme.rest_motion", rest_motion);
                core::require_positive("LoadProgramme.rest_penetration", rest_penetration);
            }
        }
    }
};

/// The loading of a model that a programme stands for.
/// @throws std::invalid_argument naming the field that is wrong
template <Model M>
Loading<M> loading_of(const LoadProgramme& programme) {
    programme.validate();
    Loading<M> loading;
    for (const ProgrammeStage& given : programme.stages) {
        Stage<M> stage;
        stage.name = given.name;
        stage.increments = given.increments << programme.halvings;
        stage.most_increments = std::max<Index>(200, 40 * stage.increments);
        stage.damping = given.damping * programme.damping;
        stage.damping_carried = !given.rest;
        stage.largest_displacement = programme.largest_displacement;
        stage.looseness = given.looseness;
        if (given.friction)
            if constexpr (core::Active<typename M::Friction>)
                stage.friction.emplace(law::friction_parameters<typename M::Friction>(
                    *given.friction, programme.reversible_displacement, programme.friction_shape));
        if (given.rest) {
            stage.until = until_settled(programme.rest_motion, programme.rest_penetration, programme.rest_share);
            stage.damping_decay = stage.damping > 0.0 ? 0.5 : 1.0;
            stage.damping_share = programme.rest_share, stage.damping_calm = programme.calm;
            stage.exact_end = true;
        }
        for (Index cycle = 0; cycle < std::max<Index>(1, given.cycles); ++cycle)
            for (const bool forth : {true, false}) {
                if (!forth && given.cycles == 0) continue;
                stage.ramps = given.ramps;
                if (!forth)
                    for (Ramp& ramp : stage.ramps) ramp.to = given.back;
                loading.stages.push_back(stage);
                stage.friction.reset();
            }
    }
    return loading;
}

}  // namespace fibrant::simulation
