// SPDX-License-Identifier: MIT
#pragma once
/// @file Where a run stands in its loading.

#include <fibrant/connection/channels.hpp>
#include <fibrant/simulation/calming.hpp>
#include <fibrant/simulation/loading.hpp>
#include <fibrant/simulation/stall.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::simulation {

/// Where a run stands between two increments.
struct Position {
    Index stage = 0, in_stage = 0, accepted = 0, easy = 0;
    double progress = 0.0, fraction = 1.0, displacement = 0.0;
    double damping = 1.0;        ///< over that of the stage
    double damping_floor = 0.0;  ///< that it does not fall below: what has failed is not tried again at once
    bool stage_over = false;
    Calming calming{};
    Index mends = 0;  ///< of pairs that are too deep unseen, since that last became better
    double mended = std::numeric_limits<double>::infinity();  ///< how deep they are then [length]
    bool following = false;                                   ///< places of crossings are followed
    bool exact = false;                                       ///< the next increment is solved to what is stated
    bool on_its_way = false;                                  ///< has moved far in the stage, and not been at rest since
    std::pair<Index, double> tried{-1, 0.0};  ///< accepted increments and fraction at which another following was tried last
    std::vector<double> from;                 ///< amplitudes at the start of the stage
    std::vector<double> holding;              ///< damping of each fibre over that of all, >= 1
    static constexpr Index most_mends = 12;   ///< without a success
    Index within = 0;                         ///< increments in a row of which damping held no more than its share
    /// Of those, what it takes to settle where damping waits and increments are solved loosely: slack fibres, which move on now
    /// and then, were still in one of them by trial on 608 fibres.
    static constexpr Index lasting = 3;

    /// Progress that the next increment of a stage is to reach.
    template <Model M>
    double next(const Stage<M>& present) const {
        if (calming.resting) return progress;
        if (present.ramps.empty() && !present.until && present.duration == 0.0) return 1.0;
        const double ahead = std::min(1.0, progress + fraction / static_cast<double>(present.increments));
        return ahead > 1.0 - 1e-9 ? 1.0 : ahead;
    }

    /// Duration of an increment of a stage.
    template <Model M>
    double step(const Stage<M>& present) const noexcept {
        return present.duration * fraction / static_cast<double>(present.increments);
    }

    /// Tells which increment has been accepted, and how far its stage has come.
    template <Model M>
    void tell(const Stage<M>& present, IncrementReport& increment) const {
        increment.number = accepted, increment.stage = present.name, increment.stage_progress = progress;
    }

    /// An attempt has failed: the other way of finding places is tried before anything else is, once at a size of increment.
    /// Where that fails too the first one is taken up again. What would be the same attempt once more is none.
    /// @param state   last accepted one
    /// @param anew    the next attempt differs in any case
    /// @returns whether the same increment is to be tried
    template <class Mesh, class Contacts>
    bool try_other_places(const Mesh& mesh, const Vector& state, Contacts& contacts, bool anew) {
        if (contacts.parameters().places != contact::Places::as_needed) return false;
        const std::pair<Index, double> now{accepted, fraction};
        const bool again = tried != now;
        if (again && !anew && !contacts.places().matters(mesh, state, contacts.zones())) return false;
        tried = now;
        contacts.places().follow(following = !following);
        return again;
    }

    /// Over an increment as the stage says it, >= 1: gaps are limited to as much more, contact is as much softer, and damping
    /// holds as much less.
    double stride() const noexcept { return std::max(1.0, fraction); }

    /// Begins the next stage. @param amplitudes  now
    template <Model M>
    void next_stage(const std::vector<Stage<M>>& stages, const std::vector<double>& amplitudes) {
        const double left = damping * stages[core::at(stage)].damping;
        ++stage;
        in_stage = 0, easy = 0, progress = 0.0, fraction = 1.0;
        mends = 0, mended = std::numeric_limits<double>::infinity();
        damping = 1.0;
        if (stage >= core::count(stages) || !stages[core::at(stage)].damping_goes_on) damping_floor = 0.0;
        if (stage < core::count(stages)) {
            const Stage<M>& next = stages[core::at(stage)];
            if (next.damping_goes_on && next.damping > 0.0) damping = std::min(left / next.damping, 1.0);
        }
        stage_over = exact = on_its_way = false;
        // What an attempt that failed asked for is asked for again where it is needed: systems with all crossings followed take
        // several times as many iterations where fibres are hardly held.
        following = false, tried = {-1, 0.0};
        from = amplitudes;
    }

    template <Model M>
    bool limits_gap(const Stage<M>& present) const noexcept {
        return present.gap_limit && (fraction < 1.0 || !present.gap_limit_when_cut);
    }

    /// What was mended without success is solved to what is stated: a state that only nearly balances does not show what a mend
    /// does. What is on its way is solved as loosely as a path is.
    template <Model M>
    double looseness(const Stage<M>& present) const noexcept {
        if (mends > 1 || exact) return 1.0;
        return on_its_way ? std::max(present.looseness, present.looseness_on_the_way) : present.looseness;
    }

    /// Increments are the passes of one iteration: they are solved loosely, loads stand, and no order parts fibres by a step in
    /// each of them.
    template <Model M>
    bool iterates(const Stage<M>& present) const noexcept {
        return looseness(present) > 1.0 && progress >= 1.0 && !present.forced_orders;
    }

    /// Whether a stage ends with an increment of which its `until` holds: one that is asked for an exact end with one that is
    /// within what is stated. Till then it goes on at looseness 1, but after an increment that had to be cut, or that moved so
    /// far that it is on its way again. To be asked once an increment.
    template <Model M>
    bool ends(const Stage<M>& present, bool settled, const IncrementReport& increment) noexcept {
        within = increment.damping <= present.damping_share ? within + 1 : 0;
        const bool balanced = increment.residual <= present.damping_share;  // what damping holds tells all of the balance
        settled = settled && (!present.damping_waits || looseness(present) <= 1.0 || balanced || within >= lasting);
        const bool stated = !present.exact_end || looseness(present) <= 1.0 || increment.use.greatest() <= 1.0;
        const double near = present.damping_still > 0.0 ? present.damping_still : present.damping_calm;
        const bool early = 2 * in_stage < present.most_increments, far = early && increment.displacement > near;
        const bool loosely = far && present.looseness_on_the_way > 1.0;
        exact = present.exact_end && ((settled && !stated) || (exact && increment.cuts == 0 && !loosely));
        on_its_way = far || (early && on_its_way && !settled);
        if (present.follows_briefly && increment.cuts == 0) following = false;
        return settled && stated;
    }

    /// Twice as many increments of a stage have parted nothing as it takes to end it: the run gives up.
    template <Model M>
    bool stands_still(const Stage<M>& present, const Report& report) const {
        const Index twice = 2 * present.stalled_increments;
        return in_stage > twice && stalled(report.increments, in_stage, twice);
    }
    /// A stage is given up, unended.
    template <Model M>
    bool gives_up(const Stage<M>& present, const Report& report) const {
        return in_stage >= present.most_increments || mends > most_mends || stands_still(present, report);
    }
    /// A stage ends unsettled: what follows goes on from where it is. @param report  all but the last increment
    template <Model M>
    bool enough(const Stage<M>& present, const Report& report) const {
        const Index before = in_stage - 1;
        const auto parts_nothing = [&] {
            return before > present.stalled_increments &&
                   report.increments.back().contact.greatest_penetration <= present.goes_on_below &&
                   stalled(report.increments, before, present.stalled_increments);
        };
        return progress >= 1.0 && (in_stage >= present.enough_increments || parts_nothing());
    }
    template <Model M>
    bool needless(const Stage<M>& present, const Report& report) const {
        return present.if_needed && in_stage == 0 && !report.increments.empty() && present.until(report.increments.back());
    }

    /// Why a stage is given up, before what else is known.
    template <Model M>
    std::string not_ended(const Stage<M>& present, const Report& report) const {
        const std::string still = stands_still(present, report) ? ", the last " + std::to_string(2 * present.stalled_increments) +
                                                                      " of which parted nothing"
                                                                : "";
        return "stage " + present.name + " did not reach its end in " + std::to_string(in_stage) + " increments" + still;
    }

    /// Damping of each fibre over that of all. @param own  what each has by itself; empty: 1
    std::vector<double> held_by_fibre(const std::vector<double>& own) const {
        std::vector<double> all = holding;
        for (std::size_t f = 0; f < own.size(); ++f) all[f] *= own[f];
        return all;
    }

    /// Damping of the fibre that is held hardest, over that of the stage.
    double hardest() const { return damping * (holding.empty() ? 1.0 : *std::max_element(holding.begin(), holding.end())); }

    /// All that a run can come to: of another one, numbers lead out of the loading.
    bool sound(Index stages) const {
        const auto finite = [](double value) { return std::isfinite(value) && value >= 0.0; };
        return stage >= 0 && stage <= stages && in_stage >= 0 && accepted >= 0 && finite(progress) && fraction > 0.0 &&
               fraction <= most_fraction && finite(displacement) && finite(damping) && finite(damping_floor) && calming.sound() &&
               mends >= 0 && within >= 0 && mended >= 0.0 && std::all_of(holding.begin(), holding.end(), finite);
    }

    template <class Body>
    void each(const Body& body) {
        each_of(*this, body);
    }
    template <class Body>
    void each(const Body& body) const {
        each_of(*this, body);
    }

private:
    template <class Self, class Body>
    static void each_of(Self& self, const Body& body) {
        body(self.stage), body(self.in_stage), body(self.accepted), body(self.easy);
        body(self.progress), body(self.fraction), body(self.displacement), body(self.mends), body(self.mended);
        Calming::each_of(self.calming, body);
        body(self.damping), body(self.damping_floor), body(self.stage_over), body(self.following), body(self.exact),
            body(self.on_its_way), body(self.within), body(self.tried.first), body(self.tried.second);
        for (auto& amplitude : self.from) body(amplitude);
        for (auto& factor : self.holding) body(factor);
    }
};

/// Of a loading without stages, in increments that take the place of one: the least fraction of increments bounds cuts before
/// that.
inline constexpr Index cuts_to_expect = 20;

/// The stages of a loading; with none, one that takes all channels to 1.
template <Model M>
std::vector<Stage<M>> stages_of(const Loading<M>& loading, const connection::Channels& channels) {
    std::vector<Stage<M>> stages = loading.stages;
    if (!stages.empty()) return stages;
    stages.emplace_back();
    stages.back().increments = loading.increments;
    stages.back().most_increments = std::max(cuts_to_expect * loading.increments, stages.back().most_increments);
    for (const std::string& name : channels.names()) stages.back().ramps.push_back({name, 1.0, false});
    return stages;
}

/// Amplitudes at a progress of a stage, in [0, 1]; `amplitudes` are those now.
template <Model M>
std::vector<double> amplitudes_at(const Stage<M>& stage, double progress, const Position& position,
                                  const connection::Channels& channels, std::vector<double> amplitudes) {
    for (const Ramp& ramp : stage.ramps) {
        const std::size_t c = core::at(channels.find(ramp.channel));
        const double from = position.from[c];
        amplitudes[c] = ramp.at_once     ? ramp.to
                        : ramp.geometric ? from * std::pow(ramp.to / from, progress)
                                         : from + progress * (ramp.to - from);
    }
    return amplitudes;
}

/// a - b, entry by entry; both have the same size.
inline std::vector<double> difference(std::vector<double> a, const std::vector<double>& b) {
    for (std::size_t k = 0; k < a.size(); ++k) a[k] -= b[k];
    return a;
}

/// Throws std::invalid_argument unless the ramps of all stages are of channels, and geometric ones between numbers > 0.
template <Model M>
void check_ramps(const std::vector<Stage<M>>& stages, const connection::Channels& channels,
                 const std::vector<double>& amplitudes) {
    std::vector<double> reached = amplitudes;
    for (const Stage<M>& stage : stages) {
        const std::vector<double> from = reached;
        for (const Ramp& ramp : stage.ramps) {
            const std::size_t c = core::at(channels.find(ramp.channel));
            if (ramp.geometric && !(from[c] > 0.0 && ramp.to > 0.0))
                core::refuse("Ramp.to", core::text(ramp.to), "> 0, from an amplitude > 0, for a geometric ramp");
            reached[c] = ramp.to;
        }
    }
}

}  // namespace fibrant::simulation
