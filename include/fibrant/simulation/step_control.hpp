// SPDX-License-Identifier: MIT
#pragma once
/// @file How increments are cut and grown, and damping with them.

#include <fibrant/simulation/position.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <vector>

namespace fibrant::simulation {

/// What a model may name as `Steps`: three decisions, each of which changes where a run stands.
template <class S, class M>
concept StepControl = std::default_initializable<S> &&
    requires(const S& steps, Position& position, const Stage<M>& stage, const std::vector<double>& moved,
             const IncrementReport& increment, double value, Index attempts) {
    steps.give_way(position, stage, moved, value, attempts);  // an attempt has failed
    steps.grow(position, stage, increment, value, value);     // an increment is accepted: the next one
    steps.adapt_damping(position, stage, increment, value);   // the same: what it is damped by
};

/// Steps that are halved, and damping that is doubled, until an increment converges; both come back after increments that were
/// easy. The numbers are by trial on fabrics, mats and bundles, where nothing else is said.
struct HalvedSteps {
    static constexpr double half = 0.5;      ///< of an increment that has failed: a bisection of the way to go
    static constexpr double harder = 4.0;    ///< factor on damping of all, or of few fibres, after an attempt that has failed
    static constexpr double firmer = 2.0;    ///< the same after an increment that was hard
    static constexpr double quicker = 0.25;  ///< least factor of an increment where damping is steered to a pace: two halvings
    static constexpr double least_damping = 1e-3;   ///< over that of the stage: below, none; its inverse is the most
    static constexpr double vanishing = 1e-6;       ///< the same where damping waits, or is steered: it ends by its share
    static constexpr double few = 0.1;              ///< of the fibres, which alone are held harder
    static constexpr double nearly = 1.5;           ///< of what damping may hold, by which it does not fall any more
    static constexpr double far = 0.25;             ///< of the greatest motion: what counts as restless
    static constexpr double most_holding = 4096.0;  ///< of a fibre over that of all: six times `harder`
    static constexpr Index patience = 5;  ///< failed attempts of which the last makes the increment smaller, whoever was restless
    static constexpr Index easy_ones = 2;                         ///< increments without a cut before the next one is longer
    static constexpr double with_ease = 0.6, with_effort = 0.75;  ///< iterations over how many there may be
    static constexpr double part_of_overlap = 0.25;  ///< of the deepest one, by which a stage that parts fibres goes at most
    static constexpr double floor_decay = 0.8;       ///< an increment, of the damping below which attempts have failed

    /// After an attempt that has failed. What stops increments is often one fibre, or two at the edge of a bundle: those that
    /// moved most in the last iteration or pass, if they are few, are held four times as hard, and the increment stays as it is.
    /// Else it is made smaller, and damping of all rises.
    /// @param moved     of each fibre, in what did not settle [length]; empty: not known
    /// @param allowed   that it may be without harm [length]
    /// @param attempts  at this increment that have failed, >= 1
    template <Model M>
    void give_way(Position& position, const Stage<M>& stage, const std::vector<double>& moved, double allowed,
                  Index attempts) const {
        position.easy = 0;
        double &fraction = position.fraction, &damping = position.damping;
        if (fraction > 1.0) {
            fraction = std::max(1.0, half * fraction);
            return;
        }
        if (attempts % patience != 0 && damping * stage.damping > 0.0 && hold_restless(position, moved, allowed)) return;
        // Once its ramps are over, only more damping makes an increment easier.
        const bool damped = stage.damping > 0.0 && damping < 1.0 / least_damping;
        if (position.progress < 1.0 || !damped) fraction *= half;
        position.damping_floor = firmer * damping;
        damping = std::clamp(harder * damping, least_damping, 1.0 / least_damping);
    }

    /// After an accepted increment: what was cut grows again, and one that parts what is deep goes further.
    /// @param growth  factor after two increments without a cut
    /// @param effort  as of `adapt_damping`
    template <Model M>
    void grow(Position& position, const Stage<M>& stage, const IncrementReport& increment, double growth, double effort) const {
        double most = 1.0;
        if (stage.gap_limit && stage.largest_fraction > 1.0)
            most = std::clamp(part_of_overlap * increment.contact.greatest_penetration / *stage.gap_limit, 1.0,
                              stage.largest_fraction);
        double& fraction = position.fraction;
        fraction = std::min(fraction, most);
        if (increment.cuts > 0 || ++position.easy < easy_ones || fraction >= most || (fraction >= 1.0 && effort > with_ease))
            return;
        fraction = std::min(fraction < 1.0 ? 1.0 : most, growth * fraction), position.easy = 0;
    }

    /// Damping is the inverse of a time step: what was solved with ease goes on faster, and what was hard more slowly.
    /// @param effort  iterations of a normal pass of the last attempt over how many it may take [1]
    template <Model M>
    void adapt_damping(Position& position, const Stage<M>& stage, const IncrementReport& increment, double effort) const {
        double& damping = position.damping;
        const double before = damping;
        // What holds little enough falls no further: without any, a slack fibre is sought all over the place, and the last stage
        // takes what it takes.
        const bool waits = stage.damping_waits && position.progress >= 1.0,
                   enough = waits && damping > 0.0 && increment.damping <= nearly * stage.damping_share;
        const auto settling = [&] { return stage.until && stage.until(increment); };  // and to be so once more
        if (waits && !position.stage_over && !stage.unbalanced(increment) && increment.damping < half * stage.damping_share &&
            !settling())
            damping = damping > 0.0 ? std::min(firmer * damping, 1.0 / least_damping) : least_damping;
        else if (!waits && stage.damping_pace > 0.0 && increment.cuts == 0 && effort <= with_effort)
            damping = changed(position, std::clamp(increment.displacement / stage.damping_pace, quicker, firmer));
        else if (!enough && !(waits && stage.rough(increment)) && increment.cuts == 0 &&
                 increment.displacement <= stage.damping_calm && effort <= with_ease)
            damping = changed(position, damping > 1.0 ? half : std::pow(stage.damping_decay, position.fraction));
        else if (stage.damping_decay < 1.0 && effort > with_effort)
            damping = changed(position, firmer);
        // What is steered to a pace moves with a thousandth as far as before: without any it would leap, and springs that it
        // takes then would vanish again by turns.
        if (damping < (waits || stage.damping_pace > 0.0 ? vanishing : least_damping)) damping = 0.0;
        position.damping_floor *= floor_decay;
        // What holds a single fibre is halved after each increment without a cut, be it by its own factor or by that of all.
        const double share = half * (before > 0.0 ? before / std::max(damping, half * before) : 1.0);
        if (increment.cuts == 0)
            for (double& factor : position.holding) factor = std::max(1.0, share * factor);
    }

private:
    /// Damping by a factor, below the most there is, or not below its floor unless it is there already.
    static double changed(const Position& position, double factor) {
        const double next = factor * position.damping;
        return factor > 1.0 ? std::min(next, 1.0 / least_damping)
                            : std::max(next, std::min(position.damping, position.damping_floor));
    }

    /// @returns false where too many moved, or one that did is held as hard as may be
    static bool hold_restless(Position& position, const std::vector<double>& moved, double allowed) {
        const double most = moved.empty() ? 0.0 : *std::max_element(moved.begin(), moved.end());
        std::vector<std::size_t> restless;
        for (std::size_t f = 0; f < moved.size(); ++f)
            if (moved[f] > std::max(far * most, allowed)) restless.push_back(f);
        if (restless.empty() || static_cast<double>(restless.size()) > few * static_cast<double>(moved.size())) return false;
        for (const std::size_t f : restless)
            if (position.holding[f] >= most_holding) return false;
        for (const std::size_t f : restless) position.holding[f] *= harder;
        return true;
    }
};

namespace detail {
template <Model M>
struct StepsOf {
    using Type = HalvedSteps;
};
template <Model M>
    requires HasSteps<M>
struct StepsOf<M> {
    using Type = typename M::Steps;
};
}  // namespace detail

}  // namespace fibrant::simulation
