// SPDX-License-Identifier: MIT
#pragma once
/// @file The three nested loops of an increment: contact elements, normal directions, Newton (Durville, section 15.3.2).

#include <fibrant/contact/allowed_depth.hpp>
#include <fibrant/solver/attempt_report.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace fibrant::solver {

/// Numbers of the nested loops that no scene has had to change. Where no source is named, they were chosen by trial on the scenes
/// of the examples and the tests of stability.
namespace nested_numbers {
inline constexpr double ahead = 1.1;  ///< of what is driven: else a search that reaches just so far is soon repeated [1]
inline constexpr double both = 2.0;   ///< two fibres may each move by what is expected [1]
inline constexpr double kept = 0.25;  ///< part of a search's reach that is moved before the next one [1]
inline constexpr Index most_moves = 6, most_moves_bounded = 2;  ///< searches after such motions; where displacements are bounded
inline constexpr Index first_searches = 2;                      ///< of an increment, which no small motion makes up for
inline constexpr Index standing_passes = 2, most_swings = 2;    ///< last passes, in which points may stand; what shows a swing
inline constexpr double coarsest_step = 0.02;                   ///< of an iteration within a pass [radius]
inline constexpr double coarsest_by_looseness = 2e-5, coarsest_of_all = 0.05;  ///< the same, of a path looser than 1000
/// The same over what is expected to move, of a path: of one that creeps a coarser iteration leaves more than it moves [1].
inline constexpr double of_expected = 0.5;
/// What one renewal of multipliers leaves of what contacts miss, where it counts as one that brings nothing: slower than that,
/// a decade takes more than twenty.
inline constexpr double hardly_less = 0.9;
inline constexpr double finer = 0.1;  ///< part of a tolerance that a loop inside need not go below [1]
// Extrapolation of passes that follow one mode, as a geometric series (Aitken 1926).
inline constexpr double least_ratio = 0.4;  ///< of two travels, from which it pays [1]
inline constexpr double largest_ratio =
    0.8;  ///< above it the sum of the series is too uncertain: it is taken as that of this ratio [1]
inline constexpr double largest_series = 4.0;   ///< = 0.8 / (1 - 0.8)
inline constexpr double longest_leap = 0.25;    ///< of an extrapolation [radius]
inline constexpr double least_swing = 0.5;      ///< ratio of two contact passes' travels, against each other, that is one
inline constexpr double swing_likeness = 0.25;  ///< square of the cosine that two such travels have at least
}  // namespace nested_numbers

/// Multiple of the last travel from its end to that of a geometric series of travels (Aitken 1926).
inline double end_of_series(double ratio) noexcept { return ratio / (1.0 - ratio); }
/// The same of two travels that swing to and fro, < 0; 0 if they do not.
/// @param last  the one before, of the same size
template <class Equilibrium>
double swing_end(const Equilibrium& equilibrium, const Vector& travel, const Vector& last) {
    namespace with = nested_numbers;
    const double along = equilibrium.product(travel, last), before = equilibrium.product(last, last);
    const bool swings = along < -with::least_swing * before &&
                        along * along >= with::swing_likeness * before * equilibrium.product(travel, travel);
    return swings ? end_of_series(along / before) : 0.0;
}

/// Solves increments; loops inside are solved to a part of the last change of the loop outside.
template <class Equilibrium, class Contacts, class Linear, class Passage>
class NestedLoops {
public:
    NestedLoops(Equilibrium& equilibrium, Contacts& contacts, Linear& linear, const Passage& passage,
                const IterationParameters& parameters, double radius, bool contact_possible, core::StageClock& clock)
        : equilibrium_{&equilibrium},
          contacts_{&contacts},
          linear_{&linear},
          passage_{&passage},
          parameters_{core::validated(parameters)},
          radius_{radius},
          contact_possible_{contact_possible},
          clock_{&clock} {}

    /// @param state     in: last accepted state; out: the converged one
    /// @param accepted  last accepted state
    /// @param expected  displacement that the search should reach over [length]
    /// @param forced    keep forced orders
    /// @param looseness multiplies the tolerances of normal and contact passes, >= 1: for paths that are only a means. At 1
    /// nothing is accepted
    ///                  beyond what is stated: a residual that passes left is solved for, and zones that are too deep become
    ///                  stiffer
    /// @param furthest  displacement beyond which the attempt is given up [length]
    AttemptReport solve(Vector& state, const Vector& accepted, double expected, bool forced, double looseness = 1.0,
                        double furthest = std::numeric_limits<double>::infinity()) {
        namespace with = nested_numbers;
        AttemptReport report;
        Newton<Equilibrium, Contacts, Linear> newton(*equilibrium_, *contacts_, *linear_, parameters_, radius_, *clock_);
        const bool strict = looseness <= 1.0;
        double coarsest =
            std::clamp(with::coarsest_by_looseness * looseness, with::coarsest_step, with::coarsest_of_all) * radius_;
        if (!strict && expected > 0.0) coarsest = std::min(coarsest, with::of_expected * expected);
        // What is driven goes on as it did: a search that reaches just so far would have to be repeated every other time.
        if (const double least = driven(state); least > 0.0) expected = with::ahead * std::max(expected, least);
        const double reach =
            std::clamp(with::both * expected, parameters_.margin * radius_, parameters_.largest_margin * radius_);
        contacts_->parameters().detection.wanted = with::both * expected;
        const double bound = contact_possible_ ? std::max(reach, radius_) : std::numeric_limits<double>::infinity();
        double change = std::numeric_limits<double>::infinity();  // displacement in the last contact pass
        Vector searched, travel, last_travel;  // state of the last search, displacements of the last pass and of the one before
        Vector made;                           // state that contact points were made in
        double missed = std::numeric_limits<double>::infinity();  // by contacts, at the last renewal of their multipliers
        turn_ = 0.0, closing_ = false;
        bool stands = false;  // points are those of an earlier pass
        const auto restless = [&] {
            return change >= looseness * parameters_.contact_tolerance * radius_ || (stands && stood(state, made) > 1.0);
        };
        Index passes = 0, searches = 0, moves = 0, renewals = 0, stiffenings = 0;
        // Further than so many searches reach: what hardly anything holds goes on for ever, and where displacements have a bound,
        // more damping or a smaller increment costs less than to follow it.
        const Index most_moves = std::isfinite(furthest) ? with::most_moves_bounded : with::most_moves;
        while (true) {
            if (passes >= parameters_.contact_limit || moves > most_moves) {
                report.reason = "contact passes do not settle: last displacement " + core::text(change / radius_) + " radii";
                report.unsettled = travel, report.astray = true;
                return report;
            }
            ++report.counts.contact_passes;
            // Zones are kept while nothing could have come into or out of reach unseen. Beside the time, this keeps
            // contact elements from jumping in and out at the ends of zones, which may go on for ever.
            const bool search = searches < with::first_searches || !contact_possible_ ||
                                equilibrium_->greatest(state - searched) > with::kept * bound;
            if (search) searched = state, ++searches;
            // Points that are made anew may carry fibres to and fro for ever, however small the increment: in the last passes
            // they stand as they were made close by.
            stands = !search && passes >= std::max(parameters_.contact_limit - with::standing_passes, with::most_swings) &&
                     stood(state, made) < 1.0;
            if (!stands) made = state;
            clock_->time(search ? core::Part::search : core::Part::contact, [&] {
                const double far = std::isfinite(bound) ? bound : parameters_.margin * radius_;
                if (search)
                    contacts_->detect(state, accepted, far, forced), equilibrium_->detect(state, accepted, far);
                else if (stands)
                    equilibrium_->refresh(state, accepted, contacts_->refresh(state, accepted)), last_travel.resize(0);
                else
                    contacts_->regenerate(state, accepted);
            });
            clock_->time(core::Part::preparation, [&] {
                contacts_->evaluate(state);
                contacts_->hold_reactions();
                equilibrium_->evaluate(state);
                equilibrium_->outline(state);
                linear_->analyse(assembly::seen(equilibrium_->system()));
            });
            const Vector before_pass = state;
            const bool moved = !normal_passes(newton, state, accepted, searched, bound, looseness, coarsest, report);
            if (!report.reason.empty()) {
                report.unsettled = newton.last_step();
                return report;
            }
            report.displacement = equilibrium_->greatest(state - accepted);
            if (report.displacement > furthest) {
                report.reason = "fibres moved by " + core::text(report.displacement / radius_) + " radii in an increment";
                report.unsettled = state - accepted, report.allowed = furthest;
                return report;
            }
            travel = state - before_pass;
            change = equilibrium_->greatest(travel);
            if (moved) {
                ++moves;
                step_back(state, searched, forced);
                continue;
            }
            if (!contact_possible_) break;
            // Passes before were of another stiffness, and do not count.
            const auto stiffer = [&] {
                return strict && stiffenings < most_stiffenings &&
                       contact::stiffen_deep_zones(*contacts_, contacts_->parameters().stiffness) && ++stiffenings > 0;
            };
            if (stiffer()) {
                last_travel.resize(0);
                continue;
            }
            if (restless()) {
                ++passes;
                settle_swing(state, travel, last_travel);
                continue;
            }
            // What carries may turn without moving anything: normals are brought to rest by themselves, once.
            if (strict && !closing_ && turn_ > parameters_.normal_tolerance) {
                closing_ = true, ++passes;
                continue;
            }
            if (!multipliers_change()) {
                if (!strict || report.residual <= parameters_.residual_tolerance) break;
                // Inner loops are solved to a part of what the outer ones move: what is accepted is solved to what is stated.
                const NewtonReport last =
                    newton.solve(state, parameters_.step_tolerance * radius_, searched, bound, report.counts);
                if (last.status == NewtonStatus::converged) equilibrium_->close_ties(state);
                report.residual = last.residual.relative(), report.force_scale = last.residual.scale, report.step = last.step;
                if (last.status == NewtonStatus::moved) {
                    ++moves;
                    continue;
                }
                if (last.status != NewtonStatus::converged) {
                    report.reason = reason(last, newton.last_step()), report.unsettled = newton.last_step(), report.astray = true;
                    return report;
                }
                report.displacement = equilibrium_->greatest(state - accepted);
                change = equilibrium_->greatest(state - before_pass);
                if (stiffer()) continue;
                if (restless()) {
                    ++passes;
                    continue;
                }
                if (!multipliers_change()) break;
            }
            // Those that get nearer go on: what is asked for may be many decades below what the penalty leaves.
            if constexpr (with_multipliers) {
                const double misses = contacts_->misfit();
                if (misses > with::hardly_less * std::exchange(missed, misses)) ++renewals;
                if (renewals > parameters_.multiplier_limit) {
                    report.reason = "multipliers do not settle: a contact misses its surface by " + core::text(misses / radius_) +
                                    " radii, and may by " + core::text(contacts_->normal_law().largest_penetration() / radius_);
                    return report;
                }
            }
        }
        contact::DepthOverAllowed depth;
        if (contact_possible_) depth = contact::depth_over_allowed(*contacts_, contacts_->parameters().stiffness);
        // Of points that stand it is how far they were made from here that is stated.
        const double over = change / (parameters_.contact_tolerance * radius_),
                     travelled = std::max(over, stands ? stood(state, made) : 0.0);
        report.use = {report.residual / parameters_.residual_tolerance, turn_ / parameters_.normal_tolerance,
                      contact_possible_ ? travelled : 0.0, depth.value};
        if (strict && report.use.turn > 1.0) {
            report.reason = "normals do not settle: the last pass turned them by " + core::text(turn_) + " radians";
            report.unsettled = travel, report.astray = true;
            return report;
        }
        if (strict && report.use.penetration > 1.0 && contacts_->parameters().stiffness.adapts()) {
            report.reason = contact::text(depth);
            return report;
        }
        report.converged = true;
        return report;
    }

private:
    static constexpr bool with_multipliers = requires(const Contacts contacts) { contacts.normal_law().largest_penetration(); };
    /// Of zones, within an increment: each a factor StiffnessAdaptation.largest_change, so that ten are five decades by default.
    static constexpr Index most_stiffenings = 10;

    /// How far from here contact points were made, over how far those that stand may be [1].
    double stood(const Vector& state, const Vector& made) const {
        return equilibrium_->greatest(state - made) / (parameters_.standing_points * radius_);
    }

    /// Greatest displacement of what is driven [length].
    double driven(const Vector& state) const {
        Vector step;
        equilibrium_->prescribed_step(state, step);
        return equilibrium_->greatest(step);
    }
    /// What is driven moves by more than a search reaches where nothing is in its way. What it passed through on the way from the
    /// last search is met where they touch, and the next search sees it.
    void step_back(Vector& state, const Vector& searched, bool forced) {
        if constexpr (core::Active<Passage>) {
            if (!contact_possible_) return;
            const auto passed =
                clock_->time(core::Part::search, [&] { return passage_->first(searched, state, *contacts_, forced, false); });
            if (!passed) return;
            state = searched + passed->touch * (state - searched);
            equilibrium_->reset_stresses(state);
        }
    }

    /// Contact passes that swing to and fro about their end begin the next one there: elements along a line of contact, as
    /// between the strands of a plectoneme, stand elsewhere after each of them, and carry the fibres back.
    void settle_swing(Vector& state, const Vector& travel, Vector& last) const {
        const double factor = last.size() > 0 ? swing_end(*equilibrium_, travel, last) : 0.0;
        if (factor == 0.0) {
            last = travel;
            return;
        }
        state += factor * travel;
        equilibrium_->reset_stresses(state);
        last.resize(0);
    }

    /// Contacts of a law with multipliers carry them on at the next pass, and are not yet where they should be.
    bool multipliers_change() const {
        if constexpr (with_multipliers) return contacts_->misfit() > contacts_->normal_law().largest_penetration();
        return false;
    }

    /// Normal passes on one set of contact elements. @param coarsest  of the iteration in the first one [length]
    /// @returns false if the search has to be repeated first.
    bool normal_passes(Newton<Equilibrium, Contacts, Linear>& newton, Vector& state, const Vector& accepted,
                       const Vector& searched, double bound, double looseness, double coarsest, AttemptReport& report) {
        namespace with = nested_numbers;
        const double finest = parameters_.step_tolerance * radius_;
        const double enough = looseness * parameters_.normal_step_tolerance * radius_;
        double first = 0.0, change = std::numeric_limits<double>::infinity();
        Vector travel, last_travel;  // displacement of this pass and of the one before
        for (Index pass = 0; pass < parameters_.normal_limit; ++pass) {
            if (pass == 0) {
                equilibrium_->learned().forget();
            } else {
                equilibrium_->learned().remember(*contacts_);
                const double turn = turn_ = clock_->time(core::Part::contact, [&] {
                    return equilibrium_->refresh(state, accepted, contacts_->refresh(state, accepted));
                });
                // The contact elements will move on all the same: no need to be finer than a part of what this pass moved.
                const bool settled = turn < looseness * parameters_.normal_tolerance && change < enough;
                const bool hardly_moved = change < std::max(with::finer * parameters_.inexact * first, with::finer * enough);
                if (settled || (hardly_moved && !(closing_ && turn > parameters_.normal_tolerance))) break;
                // Fibres that roll over each other creep in equal steps: go several of them at once.
                const double factor = extrapolation(travel, last_travel, change);
                if (factor != 0.0) {
                    state += factor * travel;
                    last_travel.resize(0), travel.resize(0);
                    contacts_->refresh(state, accepted);
                    equilibrium_->refresh(state, accepted, 0.0);
                }
            }
            ++report.counts.normal_passes;
            const Vector before = state;
            const double loose = std::isfinite(change) ? parameters_.inexact * change : coarsest;
            const double tolerance = contact_possible_ ? std::clamp(loose, finest, std::max(finest, coarsest)) : finest;
            const NewtonReport inner = newton.solve(state, tolerance, searched, bound, report.counts);
            if (inner.status == NewtonStatus::converged) equilibrium_->close_ties(state);
            report.residual = inner.residual.relative(), report.force_scale = inner.residual.scale, report.step = inner.step;
            last_travel.swap(travel);
            travel = state - before;
            change = equilibrium_->greatest(travel);
            if (pass == 0) first = change;
            if (pass == 0) travel.resize(0);  // it holds the increment itself
            if (inner.status == NewtonStatus::moved) return false;
            if (inner.status != NewtonStatus::converged) {
                report.reason = reason(inner, newton.last_step()), report.astray = true;
                return true;
            }
            if (!contact_possible_) break;
        }
        return true;
    }

    /// Multiple of the last travel after which a geometric series of passes would end, bounded; 0 if there is none. One that
    /// grows or swings to and fro has its end behind it (Aitken 1926): a loop that can turn freely about its ends is pushed by
    /// each normal that turns with it.
    double extrapolation(const Vector& travel, const Vector& last_travel, double change) const {
        namespace with = nested_numbers;
        if (travel.size() == 0 || last_travel.size() == 0) return 0.0;
        const double along = equilibrium_->product(travel, last_travel), last = equilibrium_->product(last_travel, last_travel);
        const double ratio = along / last;
        if ((ratio > growing || ratio < -swinging) &&
            along * along > same_way * same_way * last * equilibrium_->product(travel, travel))
            return std::max(end_of_series(ratio), -with::longest_leap * radius_ / change);
        if (!(ratio > with::least_ratio)) return 0.0;
        const double series = ratio < with::largest_ratio ? end_of_series(ratio) : with::largest_series;
        return std::min(series, with::longest_leap * radius_ / change);
    }
    static constexpr double same_way = 0.9;  ///< cosine of two travels that follow one mode
    static constexpr double growing = 1.3,
                            swinging = 0.7;  ///< ratios of two travels from which a series does not end by itself, or hardly

    std::string reason(const NewtonReport& inner, const Vector& step) const {
        const std::string iterations = std::to_string(inner.iterations) + " iterations";
        std::string text =
            " after " + iterations + ", residual " + core::text(inner.residual.relative()) + ", step " + core::text(inner.step);
        const bool unsolvable = inner.status == NewtonStatus::unsolvable;
        // What gives way shows in a step of such a tangent.
        if (unsolvable || inner.indefinite > 0) {
            if (!unsolvable)
                text += "; the tangent was not positive definite in " + std::to_string(inner.indefinite) + " of " + iterations;
            if (const auto most = equilibrium_->moves_most(step); most.chain >= 0)
                text += ", fibre " + std::to_string(most.chain) + " moves most, at " +
                        core::text(std::round(1e4 * most.along) / 1e4) + " of its length";
        }
        if (unsolvable) return "the tangent is not positive definite" + text;
        return (inner.status == NewtonStatus::diverged ? "Newton diverged" : "Newton did not converge") + text;
    }

    Equilibrium* equilibrium_;
    Contacts* contacts_;
    Linear* linear_;
    const Passage* passage_;
    IterationParameters parameters_;
    double radius_;
    double turn_ = 0.0;     // of normals, in the last normal pass
    bool closing_ = false;  // contact passes have settled before normals had
    bool contact_possible_;
    core::StageClock* clock_;
};

}  // namespace fibrant::solver
