// SPDX-License-Identifier: MIT
#pragma once
/// @file A loading as data: stages with ramps, laws that change, conditions that end them.

#include <fibrant/simulation/model.hpp>
#include <fibrant/simulation/report.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace fibrant::simulation {

/// Takes the amplitude of a channel to a value over a stage.
struct Ramp {
    std::string channel{};   ///< that it moves
    double to = 1.0;         ///< amplitude at the end of the stage
    bool geometric = false;  ///< by equal factors instead of equal steps; both ends must be > 0
    bool at_once = false;    ///< from the first increment of the stage on, as a weight that nothing holds any more
};

/// In the place of a limit, where a law has none: it stays empty, and what sets it is refused.
template <class Normal>
struct NoGapLimit {
    template <class Limit>
    constexpr NoGapLimit& operator=(Limit) {
        static_assert(law::GapLimiting<Normal>, "Stage::gap_limit is of a normal law that limits gaps, such as law::LimitedGap");
        return *this;
    }
    constexpr explicit operator bool() const noexcept { return false; }
    constexpr double operator*() const noexcept { return std::numeric_limits<double>::infinity(); }
    constexpr double value_or(double otherwise) const noexcept { return otherwise; }
    constexpr void reset() const noexcept {}
};
/// The gap limit of a stage: a number, or nothing at all where the normal law has none.
template <class Normal>
using GapLimitOf = std::conditional_t<law::GapLimiting<Normal>, std::optional<double>, NoGapLimit<Normal>>;

/// Bound of `Stage::largest_fraction`: no radius is a thousand times another one's in a fabric [1].
inline constexpr double most_fraction = 1e3;
/// Bound of `Stage::looseness` and `looseness_on_the_way`: beyond it no pass would ask for anything [1].
inline constexpr double most_looseness = 1e4;

/// Part of a loading. Laws that are set replace the model's from this stage on.
template <Model M>
struct Stage {
    std::string name = "loading";  ///< in tables and messages
    Index increments = 10;         ///< that its ramps take when none is cut, >= 1
    /// Of its ramps, for laws with a rate and for inertia, >= 0; what follows them takes no time, with inertia steps of it
    /// [time].
    double duration = 0.0;
    std::vector<Ramp> ramps{};  ///< channels that it moves; none, and no stages: all to 1
    GapLimitOf<typename M::Normal>
        gap_limit{};  ///< of a law that limits the gap [length], as std::optional; scaled down when cut
    bool gap_limit_when_cut =
        false;  ///< limited in increments that were cut alone: what Newton's method cannot solve at once is softer then
    /// That increments may grow to over what they are, their gap limit and allowed penetration with them and damping against
    /// them, where fibres are far deeper in each other than they are shown and are parted with ease [1], in [1, 1000].
    double largest_fraction = 1.0;
    std::optional<double> allowed_penetration{};  ///< that the penalty adapts to in this stage, for the model's [length]
    bool forced_orders = false;                   ///< keep the scene's forced orders
    /// Spring from every centre to its last accepted place [force / length]: keeps what is slack from leaping.
    double damping = 0.0;
    bool damping_goes_on = false;  ///< starts from what the stage before it ended with, if that is less
    /// The place moves on with the mean motion of the fibre's group in the last increment: what is driven steadily is not held
    /// back. An increment of which no last one tells is solved twice.
    bool damping_carried = false;
    /// Factor on the damping after each increment without a cut, in (0, 1]; a cut raises it again.
    double damping_decay = 1.0;
    /// Where damping decays, an `until` holds only once the damping's force is at most this part of the scale of forces, which
    /// a residual is measured by too, >= 0. 0: once there is no damping at all.
    double damping_share = 0.0;
    /// Where forces balance to less than half of that share and `until` still does not hold, damping rises instead of falling:
    /// what moves is slack, and the less it is held the further it leaps into others, so that contacts never come to the
    /// penetration that is allowed.
    bool damping_waits = false;
    /// Displacement up to which an increment is good enough for damping to fall where it waits, and for the stage to end, be its
    /// forces balanced badly [length], >= 0. See `rough`.
    double damping_still = 0.0;
    /// Greatest displacement of an increment that damping is steered to: it changes by the factor that the last one moved over
    /// this, in [1/4, 2], in the place of falling by `damping_decay`, unless it waits [length], >= 0. 0: it is not.
    double damping_pace = 0.0;
    /// Greatest displacement of an increment after which damping is lowered [length], > 0.
    double damping_calm = std::numeric_limits<double>::infinity();
    /// Displacement beyond which an attempt at an increment is given up and cut [length], > 0.
    double largest_displacement = std::numeric_limits<double>::infinity();
    /// The stage ends only once no two fibres are deeper in each other than this anywhere, as `observe::least_gap` measures it
    /// [length], > 0. Pairs that are get contact points there and become stiffer; where that has no success the run stops and
    /// says so.
    std::optional<double> deepest{};
    double patience = 1.0;  ///< on the limit of Newton's iterations: what hardly resists bending converges slowly [1], in [1, 10]
    double looseness = 1.0;  ///< on the tolerances of contact and normal passes, in [1, 1e4]
    /// The same, where it is more, from an increment that moved further than `damping_still`, or `damping_calm` where that is 0,
    /// until `until` holds, but not in the second half of `most_increments`: what goes on to another equilibrium in a stage that
    /// is to end at rest is on its way again, and takes many increments that nobody asks for, in [1, 1e4].
    double looseness_on_the_way = 1.0;
    /// Where `until` is true of a loose increment, the stage goes on at looseness 1, and ends once it is true of such a one: what
    /// it ends with is an answer, within the tolerances that are stated.
    bool exact_end = false;
    /// What a failed attempt asked for, that all crossings are followed, holds up to the next increment without a cut, not to the
    /// end of the stage: of many fibres that are hardly held linear systems take several times as many iterations for it.
    bool follows_briefly = false;
    std::optional<typename M::Normal> normal{};      ///< law from this stage on, for the model's
    std::optional<typename M::Friction> friction{};  ///< likewise
    /// Once the ramps are over: goes on, all else constant, until this is true. None: ends with the ramps.
    std::function<bool(const IncrementReport&)> until{};
    /// Increments after which a stage whose ramps are over ends, be its `until` true or not, >= 1: what creeps for ever may do so
    /// no longer.
    Index enough_increments = std::numeric_limits<Index>::max();
    Index most_increments = 100;  ///< of the whole stage, beyond which the run stops unconverged
    /// Increments that part nothing (`stalled`) after which the stage ends, if nothing is deeper than `goes_on_below`; after
    /// twice as many the run stops, and names what is deepest, >= 1.
    Index stalled_increments = std::numeric_limits<Index>::max() / 2;
    double goes_on_below = 0.0;  ///< what follows parts in another way what is less deep [length], >= 0
    bool if_needed = false;      ///< left out where its `until` is true of the increment before it

    /// Forces of an increment balance by far worse than damping holds, and not as well as is stated: what it holds says little of
    /// how far the balance is.
    bool unbalanced(const IncrementReport& increment) const noexcept {
        const double far = 10.0;  // by trial on 608 fibres
        return increment.use.residual > 1.0 && increment.residual > far * std::max(increment.damping, damping_share);
    }
    /// Such an increment, where damping waits, neither lowers it nor ends the stage, unless hardly anything moves: a few slack
    /// fibres that dangle balance badly for ever.
    bool rough(const IncrementReport& increment) const noexcept {
        return damping_waits && increment.displacement > damping_still && unbalanced(increment);
    }
    /// Damping still holds too much after an increment, for a stage that ends by its `until`.
    bool held(const IncrementReport& increment) const noexcept {
        return until && damping_decay < 1.0 && (increment.damping > damping_share || rough(increment));
    }
};

/// What a simulator runs. With no stages, one that takes all channels to 1 in `increments`.
template <Model M>
struct Loading {
    Index increments = 10;                    ///< of a loading without stages, >= 1
    std::vector<Stage<M>> stages{};           ///< one after the other; none: all channels go to 1 together
    std::vector<double> damping_of_fibres{};  ///< of each fibre over that of the stages, >= 1; empty: of all the same
    double smallest_fraction = 1.0 / 256.0;   ///< of an increment, below which the run stops
    double growth = 1.5;                      ///< of the fraction after two increments without a cut
    Index most_rejected = 200;                ///< attempts in a whole run
    bool calmed = false;              ///< stages without damping follow leaps by springs that they take away again (`Calming`)
    std::string checkpoint{};         ///< file written after accepted increments; empty: none
    double checkpoint_seconds = 0.0;  ///< at least between two of them, but for the end of a stage or of the run, >= 0
    bool resume = false;              ///< start from that file, if it exists
    bool resume_before_end =
        false;  ///< a run that has ended resumes before its end: what is asked of contacts needs an increment
    /// The last stage is held to `Stage::deepest`, where it names none to `stated_depth`, unless penalties stay what they are.
    bool audited = true;
    /// Of a run that is audited, increments of stages that are not loose are held to `stated_depth` as well, by the true gap.
    /// False: the end alone, and increments are as deep between contact points as these do not see.
    bool every_increment = true;
    double deepest_over_radius = core::unset;  ///< of the thinnest fibre: in the place of both [1], > 0
    /// What the run is of, "name = value" line by line: kept in the file. A run does not resume from a file in which one of these
    /// names has another value.
    std::string scene{};
    bool other_scene = false;      ///< it does, all the same
    std::function<bool()> stop{};  ///< asked after each accepted increment: true ends the run there, with a checkpoint

    void validate() const {
        core::require_at_least("Loading.increments", increments, 1);
        core::require_between("Loading.smallest_fraction", smallest_fraction, 1e-9, 1.0);
        core::require_not_negative("Loading.checkpoint_seconds", checkpoint_seconds);
        core::require(growth > 1.0, "Loading.growth", growth, "> 1");
        core::require_finite("Loading.growth", growth);
        core::require_at_least("Loading.most_rejected", most_rejected, 0);
        for (const double over : damping_of_fibres)
            core::require(over >= 1.0 && over < 1e12, "Loading.damping_of_fibres", over, ">= 1 and < 1e12");
        const std::string timed = law::FrictionWithRate<typename M::Friction> ? "the law of friction has a rate"
                                  : MovesInTime<M>                            ? "fibres have inertia"
                                  : law::SteppedNormal<typename M::Normal>    ? "the normal law has a rate"
                                                                              : "";
        if (!timed.empty() && stages.empty())
            core::refuse("Loading.stages", "none", "at least one that has a duration: " + timed);
        for (const Stage<M>& stage : stages) {
            if (!timed.empty())
                core::require(stage.duration > 0.0, "Stage.duration of stage " + stage.name, stage.duration, "> 0: " + timed);
            core::require_at_least("Stage.increments", stage.increments, 1);
            core::require_at_least("Stage.most_increments", stage.most_increments, stage.increments);
            core::require_at_least("Stage.enough_increments", stage.enough_increments, 1);
            core::require_at_least("Stage.stalled_increments", stage.stalled_increments, 1);
            core::require_not_negative("Stage.goes_on_below", stage.goes_on_below);
            if (stage.if_needed && !stage.until)
                core::refuse("Stage.if_needed of stage " + stage.name, "true",
                             "false without `until`, which says what is needed");
            core::require_not_negative("Stage.damping", stage.damping);
            core::require_not_negative("Stage.duration", stage.duration);
            core::require(stage.damping_decay > 0.0 && stage.damping_decay <= 1.0, "Stage.damping_decay", stage.damping_decay,
                          "in (0, 1]");
            core::require(stage.damping_calm > 0.0, "Stage.damping_calm", stage.damping_calm, "> 0");
            core::require_not_negative("Stage.damping_share", stage.damping_share);
            core::require_not_negative("Stage.damping_still", stage.damping_still);
            core::require_not_negative("Stage.damping_pace", stage.damping_pace);
            core::require(stage.largest_displacement > 0.0, "Stage.largest_displacement", stage.largest_displacement, "> 0");
            core::require_between("Stage.looseness", stage.looseness, 1.0, most_looseness);
            core::require_between("Stage.looseness_on_the_way", stage.looseness_on_the_way, 1.0, most_looseness);
            core::require_between("Stage.patience", stage.patience, 1.0, 10.0);
            if (stage.allowed_penetration) core::require_positive("Stage.allowed_penetration", *stage.allowed_penetration);
            if (stage.deepest) core::require_positive("Stage.deepest", *stage.deepest);
            if (stage.gap_limit) core::require_positive("Stage.gap_limit", *stage.gap_limit);
            core::require_between("Stage.largest_fraction", stage.largest_fraction, 1.0, most_fraction);
            for (const Ramp& ramp : stage.ramps) core::require_finite("Ramp.to", ramp.to);
        }
    }
};

/// Ends a stage once no gap is limited any more and nothing penetrates by more than `penetration` [length].
inline std::function<bool(const IncrementReport&)> until_separated(double penetration) {
    return [penetration](const IncrementReport& increment) {
        return increment.contact.shifted == 0 && increment.contact.greatest_penetration <= penetration;
    };
}

/// Ends a stage once nothing penetrates by more than `penetration` [length] and forces balance: the last increment moved
/// nothing by more than `displacement` [length], or damping held no more than `share` of the forces [1]. The first alone may
/// never come true: what hardly anything holds goes the further the less it is damped.
inline std::function<bool(const IncrementReport&)> until_settled(double displacement, double penetration, double share = 0.0) {
    return [displacement, penetration, share](const IncrementReport& increment) {
        const bool balanced = increment.damping > 0.0 && increment.damping <= share;
        return increment.contact.shifted == 0 && (balanced || increment.displacement <= displacement) &&
               increment.contact.greatest_penetration <= penetration;
    };
}

/// Part of a loading that is done, in [0, 1]: stages count by their increments, but one that goes on until it is at rest, which
/// nothing foretells, as the mean of the others.
/// @param stage  that is under way, in [0, stages.size())
/// @param part   of it that is done, in [0, 1]
template <Model M>
double part_done(const std::vector<Stage<M>>& stages, Index stage, double part) {
    double foretold = 0.0;
    Index ramps = 0;
    for (const Stage<M>& each : stages)
        if (!each.until) foretold += static_cast<double>(each.increments), ++ramps;
    const double mean = ramps > 0 ? foretold / static_cast<double>(ramps) : 1.0;
    double done = 0.0, whole = 0.0;
    for (Index k = 0; k < core::count(stages); ++k) {
        const double size = stages[core::at(k)].if_needed ? 0.0
                            : stages[core::at(k)].until   ? mean
                                                          : static_cast<double>(stages[core::at(k)].increments);
        if (k == stage) done = whole + part * size;
        whole += size;
    }
    return done / whole;
}

}  // namespace fibrant::simulation
