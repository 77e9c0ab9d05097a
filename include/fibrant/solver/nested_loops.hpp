// SPDX-License-Identifier: MIT
#pragma once
/// @file The three nested loops of an increment: contact elements, normal directions, Newton (Durville, section 15.3.2).

#include <fibrant/solver/newton.hpp>

#include <algorithm>
#include <limits>
#include <string>

namespace fibrant::solver {

/// Outcome of one attempt at an increment.
struct AttemptReport {
    bool converged = false;
    std::string reason;  ///< why not
    IterationCounts counts;
    double residual = 0.0;      ///< over loads, reactions and contact forces [1]
    double force_scale = 0.0;   ///< norm of those [force]
    double step = 0.0;          ///< last Newton step [length]
    double displacement = 0.0;  ///< greatest of the increment [length]
};

/// Solves increments; loops inside are solved to a part of the last change of the loop outside.
template <class Equilibrium, class Contacts, class Linear>
class NestedLoops {
public:
    NestedLoops(Equilibrium& equilibrium, Contacts& contacts, Linear& linear, const IterationParameters& parameters,
                double radius, bool contact_possible, core::StageClock& clock)
        : equilibrium_{&equilibrium}, contacts_{&contacts}, linear_{&linear}, parameters_{core::validated(parameters)},
          radius_{radius}, contact_possible_{contact_possible}, clock_{&clock} {}

    /// @param state     in: last accepted state; out: the converged one
    /// @param accepted  last accepted state
    /// @param expected  displacement that the search should reach over [length]
    /// @param forced    keep forced orders
    AttemptReport solve(Vector& state, const Vector& accepted, double expected, bool forced) {
        AttemptReport report;
        Newton<Equilibrium, Contacts, Linear> newton(*equilibrium_, *contacts_, *linear_, parameters_, radius_, *clock_);
        const double finest = parameters_.step_tolerance * radius_;
        const double reach = std::clamp(2.0 * expected, parameters_.margin * radius_, parameters_.largest_margin * radius_);
        const double bound = contact_possible_ ? std::max(reach, 0.5 * radius_) : std::numeric_limits<double>::infinity();
        double outer_change = std::numeric_limits<double>::infinity();  // displacement in the last contact pass
        Index passes = 0, searches = 0;
        while (true) {
            if (passes >= parameters_.contact_limit || searches >= 60) {
                report.reason = "contact passes do not settle: last displacement " + core::text(outer_change / radius_) + " radii";
                return report;
            }
            ++searches, ++report.counts.contact_passes;
            clock_->time(core::Part::search, [&] { contacts_->detect(state, accepted, bound_reach(bound), forced); });
            clock_->time(core::Part::preparation, [&] {
                contacts_->evaluate(state);
                equilibrium_->linearise(state, false, 0.0);
                linear_->analyse(equilibrium_->system());
            });
            const Vector before_pass = state;
            double inner_change = outer_change;  // displacement in the last normal pass
            bool moved = false;
            for (Index normal_pass = 0; normal_pass < parameters_.normal_limit; ++normal_pass) {
                double turn = 0.0;
                if (normal_pass > 0) {
                    turn = clock_->time(core::Part::contact, [&] { return contacts_->refresh(state, accepted); });
                    if (turn < parameters_.normal_tolerance && inner_change < parameters_.normal_step_tolerance * radius_) break;
                }
                ++report.counts.normal_passes;
                const Vector before = state;
                const double loose = std::isfinite(inner_change) ? parameters_.inexact * inner_change : 0.02 * radius_;
                const double tolerance = std::clamp(loose, finest, 0.02 * radius_);
                const NewtonReport inner = newton.solve(state, tolerance, before_pass, bound, report.counts);
                report.residual = inner.residual.relative(), report.force_scale = inner.residual.scale, report.step = inner.step;
                inner_change = equilibrium_->greatest(state - before);
                if (inner.status == NewtonStatus::moved) {
                    moved = true;
                    break;
                }
                if (inner.status != NewtonStatus::converged) {
                    report.reason = reason(inner);
                    return report;
                }
                if (!contact_possible_ && tolerance <= finest * 1.0001) break;
                if (!contact_possible_) inner_change = 0.0;
            }
            outer_change = equilibrium_->greatest(state - before_pass);
            if (!moved) {
                ++passes;
                if (!contact_possible_ || outer_change < parameters_.contact_tolerance * radius_) break;
            }
        }
        report.displacement = equilibrium_->greatest(state - accepted);
        report.converged = true;
        return report;
    }

private:
    double bound_reach(double bound) const noexcept { return std::isfinite(bound) ? bound : parameters_.margin * radius_; }

    static std::string reason(const NewtonReport& inner) {
        const std::string figures = " after " + std::to_string(inner.iterations) + " iterations, residual " +
                                    core::text(inner.residual.relative()) + ", step " + core::text(inner.step);
        switch (inner.status) {
            case NewtonStatus::diverged: return "Newton diverged" + figures;
            case NewtonStatus::unsolvable: return "the tangent is not positive definite" + figures;
            default: return "Newton did not converge" + figures;
        }
    }

    Equilibrium* equilibrium_;
    Contacts* contacts_;
    Linear* linear_;
    IterationParameters parameters_;
    double radius_;
    bool contact_possible_;
    core::StageClock* clock_;
};

}  // namespace fibrant::solver
