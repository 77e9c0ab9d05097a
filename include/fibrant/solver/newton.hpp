// SPDX-License-Identifier: MIT
#pragma once
/// @file Inner loop: Newton's method for finite strain, contact status and stick or slip, solved inexactly.

#include <fibrant/assembly/equilibrium.hpp>
#include <fibrant/assembly/system_view.hpp>
#include <fibrant/core/stage_clock.hpp>
#include <fibrant/solver/linear_solver.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fibrant::solver {

/// Limits and tolerances of the nested loops. Lengths are in multiples of the smallest radius of the scene.
struct IterationParameters {
    double step_tolerance = 1e-4;         ///< of the last Newton step [radius], > 0
    double residual_tolerance = 1e-4;     ///< of the last residual, over loads and reactions [1], > 0
    double normal_tolerance = 1e-3;       ///< turn of normals in a normal pass [radian], > 0
    double normal_step_tolerance = 1e-3;  ///< displacement in a normal pass [radius], > 0
    double contact_tolerance = 1e-2;      ///< displacement in a contact pass [radius], > 0
    /// Where contact passes go to and fro, contact points stand as they were made no further from the end than this [radius], >
    /// 0. A crossing whose point stands aside by d is nearer by up to d^2 / (4 r) than it says.
    double standing_points = 0.25;
    double inexact = 0.3;  ///< inner tolerance over the last change of the loop outside [1], in [0, 1]
    /// Slope of the energy at the end of a Newton step over that at its start, beyond which the step is cut [1], > 0. Once
    /// Newton's method has failed `most_astray` times at an increment it is `watched_overshoot` at most.
    double overshoot = std::numeric_limits<double>::infinity();
    double largest_approach = 0.5;   ///< relative motion of a contact in one Newton step [mean radius of its two fibres], > 0
    Index newton_limit = 15;         ///< iterations of one inner loop
    Index normal_limit = 6;          ///< normal passes of one set of contact elements
    Index contact_limit = 8;         ///< contact passes of an increment
    Index multiplier_limit = 20;     ///< contact passes that change nothing but multipliers, and hardly what contacts miss
    double margin = 0.2;             ///< least reach of the search beyond touching [radius], > 0
    double largest_margin = 2.0;     ///< greatest reach of the search beyond touching [radius]
    bool mixed = true;               ///< independent point stresses (falls back to the plain form)
    double linear_tolerance = 1e-4;  ///< of the last linear solves [1], in (0, 1e-2]
    static constexpr double watched_overshoot = 0.5;  ///< by trial on mats, bundles and plectonemes
    static constexpr Index most_astray = 1;           ///< what never fails is not slowed by a watch

    /// Those of an attempt at an increment. Pairs that stick between two ways to slip send Newton's method to and fro: what has
    /// failed is tried again with steps that are watched.
    /// @param patience  factor on the limit of iterations
    /// @param astray    attempts at the increment in which it, or contact passes, did not settle
    IterationParameters of_attempt(double patience, Index astray) const {
        IterationParameters own = *this;
        own.newton_limit = static_cast<Index>(patience * static_cast<double>(newton_limit));
        if (astray >= most_astray) own.overshoot = std::min(overshoot, watched_overshoot);
        return own;
    }
    void validate() const {
        core::require_positive("IterationParameters.step_tolerance", step_tolerance);
        core::require_positive("IterationParameters.residual_tolerance", residual_tolerance);
        core::require_positive("IterationParameters.normal_tolerance", normal_tolerance);
        core::require_positive("IterationParameters.normal_step_tolerance", normal_step_tolerance);
        core::require_positive("IterationParameters.contact_tolerance", contact_tolerance);
        core::require_positive("IterationParameters.standing_points", standing_points);
        core::require_between("IterationParameters.inexact", inexact, 0.0, 1.0);
        core::require(overshoot > 0.0, "IterationParameters.overshoot", overshoot, "> 0");
        core::require_positive("IterationParameters.largest_approach", largest_approach);
        core::require_at_least("IterationParameters.newton_limit", newton_limit, 1);
        core::require_at_least("IterationParameters.normal_limit", normal_limit, 1);
        core::require_at_least("IterationParameters.contact_limit", contact_limit, 1);
        core::require_at_least("IterationParameters.multiplier_limit", multiplier_limit, 1);
        core::require_positive("IterationParameters.margin", margin);
        core::require(largest_margin >= margin, "IterationParameters.largest_margin", largest_margin, ">= margin");
        core::require(linear_tolerance > 0.0 && linear_tolerance <= 1e-2, "IterationParameters.linear_tolerance",
                      linear_tolerance, "> 0 and <= 0.01");
    }
};

/// Iterations of each loop, and what the linear solver met.
struct IterationCounts {
    Index contact_passes = 0, normal_passes = 0, newton = 0, linear_solves = 0, linear_iterations = 0;
    Index indefinite = 0;  ///< tangents that were not positive definite
    IterationCounts& operator+=(const IterationCounts& other) noexcept {
        contact_passes += other.contact_passes, normal_passes += other.normal_passes, newton += other.newton;
        linear_solves += other.linear_solves, linear_iterations += other.linear_iterations;
        indefinite += other.indefinite;
        return *this;
    }
};

/// How Newton's method ended.
enum class NewtonStatus : std::uint8_t {
    converged,
    moved,       ///< so far that the search has to be repeated
    too_many,    ///< iterations
    diverged,    ///< the residual keeps growing, or is not finite
    unsolvable,  ///< the tangent stayed indefinite
};

/// What Newton's method did on one set of contact elements.
struct NewtonReport {
    NewtonStatus status = NewtonStatus::too_many;
    Index iterations = 0;
    Index indefinite = 0;  ///< of these, whose tangent was not positive definite as it stood
    double step = 0.0;     ///< last one [length]
    assembly::ResidualFigures residual;
};

/// Numbers of Newton's method that no scene has had to change. Where no source is named, they were chosen by trial on the scenes
/// of the examples and the tests of stability.
namespace newton_numbers {
/// Forcing terms of inexact Newton: eta = 0.9 (r / r_before)^2, at most 1e-2 (Eisenstat and Walker 1996, choice 2; their bound is
/// 0.9, but contact changes less along steps that are better solved), or half of the step in radii that an iteration may end
/// with: by trial on 608 fibres, those that end with 0.05 radii take the same steps at 5e-2 as at 1e-3.
inline constexpr double forcing_factor = 0.9, loosest_forcing = 1e-2, forcing_by_step = 0.5, loosest_of_all = 5e-2;
inline constexpr double enough_of_residual = 0.1;  ///< what the residual may have left, times this, is as good as nothing [1]
inline constexpr double undriven = 1e-6;           ///< square of what is prescribed over that of a step: it has one energy [1]
inline constexpr double inversion_cut = 0.25;      ///< of a step at whose end a cell is turned inside out [1]
inline constexpr int most_inversion_cuts = 6;
inline constexpr double reach_used = 0.5;  ///< part of a search's reach after which it is repeated: both fibres may move
inline constexpr Index settling = 3;       ///< iterations in which residuals may rise: the mixed form starts with large ones
inline constexpr Index growing_mixed = 2,
                       growing_plain = 3;  ///< rises beyond the worst of those: fall back to the plain form, give up
/// Search along a step (regula falsi on the slope of the energy, kept away from its ends).
inline constexpr int most_shortenings = 4;
inline constexpr double least_shortening = 0.1, most_shortening = 0.8;
inline constexpr double hard_cut = 0.3;  ///< part of a step, below which slack fibres are held to their neighbours
}  // namespace newton_numbers

/// Newton's method on an equilibrium whose contact elements and normals stand.
template <class Equilibrium, class Contacts, class Linear>
class Newton {
public:
    Newton(Equilibrium& equilibrium, Contacts& contacts, Linear& linear, const IterationParameters& parameters, double radius,
           core::StageClock& clock)
        : equilibrium_{&equilibrium},
          contacts_{&contacts},
          linear_{&linear},
          parameters_{parameters},
          radius_{radius},
          clock_{&clock} {
        if constexpr (ReadsWholeBands<Linear>) equilibrium.fill_bands();
    }

    /// @param state      iterated in place
    /// @param tolerance  of the step [length]
    /// @param anchor     state at the last search
    /// @param reach      of that search: beyond half of it `moved` is returned [length]; infinity: no bound
    NewtonReport solve(Vector& state, double tolerance, const Vector& anchor, double reach, IterationCounts& counts) {
        NewtonReport report;
        Equilibrium& equilibrium = *equilibrium_;
        namespace with = newton_numbers;
        const double loosest =
            std::clamp(with::forcing_by_step * tolerance / radius_, with::loosest_forcing, with::loosest_of_all);
        double eta = loosest, worst = 0.0;
        bool mixed = parameters_.mixed;
        Index growing = 0;
        const Forgotten learned{equilibrium.learned()};
        if constexpr (iterated) equilibrium.reset_stresses(state);
        report.residual = evaluate(state);
        equilibrium.learned().carry(*contacts_);
        // One step is all that is left where forces balance well enough as it begins: it is to go far.
        if (report.residual.relative() <= residual_tolerance(tolerance)) eta = with::loosest_forcing;
        for (Index iteration = 0; iteration < parameters_.newton_limit; ++iteration) {
            equilibrium.prescribed_step(state, prescribed_);
            if (!direction(state, eta, report.residual.scale, counts)) {
                report.status = NewtonStatus::unsolvable;
                return report;
            }
            // A prescribed motion has a residual that is not that of one energy.
            const bool watched = std::isfinite(parameters_.overshoot) && equilibrium.product(prescribed_, prescribed_) <=
                                                                             with::undriven * equilibrium.product(step_, step_);
            if (watched)
                equilibrium.learned().begin_step(*contacts_);
            else if (iteration == 0)
                equilibrium.learned().clear();  // what was carried is for one step
            const double slope = watched ? residual_.dot(step_) : 0.0;
            step_ += prescribed_;
            equilibrium.close_chains(step_, state);
            double scale = bounded(step_);
            step_ *= scale;
            const assembly::ResidualFigures before = report.residual;
            before_ = state;
            state += step_;
            report.residual = arrive(state, mixed);
            // Where a cell of a solid is turned inside out there are no forces.
            for (int cut = 0; cut < with::most_inversion_cuts && !std::isfinite(report.residual.residual) && step_.allFinite();
                 ++cut) {
                step_ *= with::inversion_cut, scale *= with::inversion_cut;
                state = before_ + step_;
                report.residual = arrive(state, mixed);
            }
            if (watched) {
                scale *= shorten(scale * slope, state, report.residual, mixed);
                scale < with::hard_cut ? equilibrium.learned().hold_near(radius_) : equilibrium.learned().let_go();
            }
            if (mixed && !iterated) clock_->time(core::Part::assembly, [&] { equilibrium.predict_stresses(before_, step_); });
            ++report.iterations, ++counts.newton, report.indefinite += shifted_ > 0 ? 1 : 0;
            report.step = equilibrium.greatest(step_);
            if (!std::isfinite(report.residual.residual) || !std::isfinite(report.step)) {
                report.status = NewtonStatus::diverged;
                return report;
            }
            if (!mixed && !iterated) equilibrium.reset_stresses(state);
            const double ratio = before.residual > 0.0 ? report.residual.residual / before.residual : 0.0;
            // A tenth of what the residual may have left is as good as nothing.
            const double enough = with::enough_of_residual * residual_tolerance(tolerance) /
                                  std::max(report.residual.relative(), residual_tolerance(tolerance));
            eta = std::clamp(with::forcing_factor * ratio * ratio,
                             std::min(std::max(parameters_.linear_tolerance, enough), loosest), loosest);
            if (scale == 1.0 && report.step <= tolerance && report.residual.relative() <= residual_tolerance(tolerance)) {
                report.status = NewtonStatus::converged;
                return report;
            }
            if (std::isfinite(reach) && equilibrium.greatest(state - anchor) > with::reach_used * reach) {
                report.status = NewtonStatus::moved;
                return report;
            }
            // The mixed iteration may start with a large residual, so only a lasting growth counts.
            if (iteration >= with::settling && report.residual.residual > worst) ++growing;
            worst = iteration < with::settling ? std::max(worst, report.residual.residual) : worst;
            if (growing >= with::growing_mixed && mixed) {
                mixed = false, growing = 0, equilibrium.reset_stresses(state);
                if constexpr (iterated) report.residual = evaluate(state);
            }
            if (growing >= with::growing_plain && !watched) {  // else the energy falls
                report.status = NewtonStatus::diverged;
                return report;
            }
        }
        return report;
    }

    /// Of the last iteration.
    const Vector& last_step() const noexcept { return step_; }

private:
    /// Its forces are those of strains that the step predicts.
    static constexpr bool iterated = requires { requires Equilibrium::iterated_strains; };
    struct Forgotten {  // when the contacts change, at the latest
        contact::LearnedContacts& all;
        ~Forgotten() { all.clear(); }
    };

    double residual_tolerance(double tolerance) const {
        return parameters_.residual_tolerance * std::max(1.0, tolerance / (parameters_.step_tolerance * radius_));
    }

    assembly::ResidualFigures evaluate(const Vector& state) {
        return clock_->time(core::Part::contact, [&] { contacts_->evaluate(state), equilibrium_->evaluate(state); }),
               clock_->time(core::Part::assembly, [&] { return equilibrium_->residual(state, residual_); });
    }

    /// After step_ from before_. Forces of laws that bend over are those of the strains of the iteration, which come first.
    assembly::ResidualFigures arrive(const Vector& state, [[maybe_unused]] bool mixed) {
        if constexpr (iterated)
            clock_->time(core::Part::assembly,
                         [&] { mixed ? equilibrium_->predict_stresses(before_, step_) : equilibrium_->reset_stresses(state); });
        return evaluate(state);
    }

    /// Shortens a step beyond whose end the energy rises steeply: contacts that close or let go within it, one after the other,
    /// would send Newton's method to and fro for ever. With normals and bounds of friction that stand the energy is convex, and
    /// the place where it rises is found between. What contacts were beyond it goes into the next tangent.
    /// @param slope  of the energy along the step, at its start [force * length]
    /// @returns the part of the step that is left
    double shorten(double slope, Vector& state, assembly::ResidualFigures& figures, bool mixed) {
        namespace with = newton_numbers;
        double part = 1.0;
        for (int trial = 0; trial < with::most_shortenings && slope < 0.0 && std::isfinite(figures.residual); ++trial) {
            const double end = residual_.dot(step_);
            if (end <= -parameters_.overshoot * slope) break;
            equilibrium_->learned().learn(*contacts_, step_);
            const double factor = std::clamp(slope / (slope - end), with::least_shortening, with::most_shortening);
            step_ *= factor, part *= factor, slope *= factor;
            state = before_ + step_;
            figures = arrive(state, mixed);
        }
        return part;
    }

    /// Free part of the step. An indefinite tangent is met first by leaving compression out of its geometric part, then by
    /// a shift that grows. What the last tangent asked for, or one step less, is where the next one begins: slack fibres ask for
    /// the same again and again.
    /// @param eta    of the linear solution
    /// @param scale  of forces: what a prescribed motion does at first, to the elements at its ends alone, is far more than they
    /// are, and
    ///               no measure of what the solution may leave over
    bool direction(const Vector& state, double eta, double scale, IterationCounts& counts) {
        Equilibrium& equilibrium = *equilibrium_;
        double tolerance = eta;
        for (int attempt = std::max(0, shifted_ - 1); attempt < most_shifts; ++attempt) {
            const double shift = attempt > 1 ? std::ldexp(least_shift * stiffness_, 2 * (attempt - 2)) : 0.0;
            clock_->time(core::Part::assembly, [&] {
                equilibrium.linearise(state, attempt > 0, shift);
                if (contacts_->places().rehosted()) linear_->analyse(assembly::seen(equilibrium.system()));
                right_ = -residual_;
                equilibrium.add_learned(right_);
                if (!prescribed_.isZero(0.0)) {
                    product_.resize(state.size());
                    equilibrium.system().apply_unheld(prescribed_, product_);
                    right_ -= product_;
                    scene::project_free(equilibrium.system().layout(), right_);
                    const double size = equilibrium.norm(right_);
                    if (scale > 0.0 && size > scale) tolerance = std::max(eta * scale / size, 1e-3 * eta);
                }
            });
            const SolveStatus prepared =
                clock_->time(core::Part::preparation, [&] { return linear_->prepare(assembly::seen(equilibrium.system())); });
            SolveReport report;
            report.status = prepared;
            if (prepared == SolveStatus::converged) {
                report = clock_->time(core::Part::solution, [&] {
                    return linear_->solve(assembly::seen(equilibrium.system()), right_, tolerance, step_);
                });
                ++counts.linear_solves, counts.linear_iterations += report.iterations;
            }
            shifted_ = attempt;
            if (report.status == SolveStatus::converged) return true;
            // A step that is not exact is still a step, as long as it is a good part of one.
            if (report.status == SolveStatus::iteration_limit && report.residual < useful_residual) return true;
            if (report.status == SolveStatus::not_finite) return false;
            ++counts.indefinite;
            if (attempt == 1) stiffness_ = stiffness_scale();
        }
        return false;
    }

    /// Mean diagonal stiffness of positions, as the unit of a shift.
    double stiffness_scale() const {
        const auto& system = equilibrium_->system();
        double sum = 0.0;
        Index nodes = 0;
        for (Index f = 0; f < equilibrium_->mesh().fibre_count(); ++f)
            for (Index a = 0; a < equilibrium_->mesh().node_count(f); ++a, ++nodes) {
                const auto& row = system.row(f, a);
                const Index column = row.cols() - row.rows();
                sum += std::abs(row(0, column)) + std::abs(row(1, column + 1)) + std::abs(row(2, column + 2));
            }
        return nodes > 0 ? sum / (3.0 * static_cast<double>(nodes)) : 0.0;
    }

    /// Factor that keeps the relative motion of every contact within its bound: beyond it fibres could change sides.
    double bounded(const Vector& step) const {
        const auto& elements = contacts_->elements();
        const double most = core::largest(core::count(elements), 0.0, [&](Index k) {
            const auto& element = elements[core::at(k)];
            if (contacts_->forced(element)) return 0.0;  // a forced side is prescribed
            const auto& mesh = equilibrium_->mesh();
            const double radius =
                0.5 * (mesh.fibre(element.fibre_i).section.radius() + mesh.fibre(element.fibre_j).section.radius());
            return std::abs(element.normal.dot(element.motion(step))) * (radius_ / radius);
        });
        const double bound = parameters_.largest_approach * radius_;
        double part = most > bound ? bound / most : 1.0;
        if constexpr (requires { contacts_->tools(); })
            part = std::min(part, parameters_.largest_approach /
                                      std::max(parameters_.largest_approach, contacts_->tools().greatest_approach(step)));
        return equilibrium_->largest_part(step, bound, part);
    }

    Equilibrium* equilibrium_;
    Contacts* contacts_;
    Linear* linear_;
    IterationParameters parameters_;
    double radius_;
    core::StageClock* clock_;
    static constexpr int most_shifts = 10;       // the last one is beyond the mean stiffness
    static constexpr double least_shift = 1e-4;  // over the mean stiffness; each one is four times the last
    int shifted_ = 0;                            // what the last tangent asked for: 0 nothing, 1 no compression, more a shift
    double stiffness_ = 0.0;                     // mean, when a shift was last begun with
    Vector residual_, right_, product_, step_, prescribed_, before_;
};

}  // namespace fibrant::solver
