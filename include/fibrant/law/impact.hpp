// SPDX-License-Identifier: MIT
#pragma once
/// @file Normal laws that push as bodies do that meet in motion, and that pull.

#include <fibrant/law/normal_law.hpp>
#include <fibrant/law/physical_normal.hpp>

#include <algorithm>
#include <cmath>

namespace fibrant::law {

/// A law in motion. Over a step from p_0 to p_1 deep it pushes by (1 - t) (W_1 - W_0)/(p_1 - p_0) + t R_1: its mean, which takes
/// from the motion what it stores (Simo and Tarnow 1992; Laursen and Chawla 1997), and that of the end, such that it acts when
/// the scheme has its forces, t = 2 share - 1. An impact is then of second order, where R_1 alone is of first. Damping (Hunt and
/// Crossley 1975) makes that (1 + d p') times as much and never a pull, with no jump at touch: bodies that meet at v_0 part at e
/// v_0 with ln((1 + y)/(1 - e y)) = y (1 + e), y = d v_0, whatever the power of the law.
template <SeeingNormal Law>
class Impact {
public:
    using Sees = Approach;
    struct Parameters {
        typename Law::Parameters law{};
        double damping = 0.0;  ///< d [time / length], >= 0
        void validate() const {
            law.validate();
            core::require_not_negative("Impact.damping", damping);
        }
    };
    explicit Impact(const Parameters& parameters) : law_{core::validated(parameters).law}, damping_{parameters.damping} {}
    /// From now on increments are of this duration [time], 0: none, and contact acts at this part of them, in [1/2, 1].
    void last(double duration, double share) noexcept { duration_ = duration, end_ = 2.0 * share - 1.0; }
    void rest(bool still) noexcept { still_ = still; }
    double acts() const noexcept { return 0.5 + 0.5 * end_; }

    NormalResponse response(const Approach& a, double = 0.0) const noexcept {
        const NormalResponse now = law_.response(a, 0.0);
        if (still_ || !(duration_ > 0.0)) return now;
        const NormalResponse undamped = of_step(a, now);
        if (!(undamped.reaction > 0.0)) return undamped;
        const double factor = 1.0 + damping_ * rate(a);
        if (factor <= 0.0) return {0.0, 0.0};
        return {factor * undamped.reaction, factor * undamped.slope - damping_ / duration_ * undamped.reaction};
    }
    double energy(const Approach& a, double = 0.0) const noexcept { return law_.energy(a, 0.0); }
    double push(const Approach& a) const noexcept requires PullingNormal<Law> { return law_.push(a); }
    double dissipated(const Approach& a) const noexcept {
        if (still_ || !(duration_ > 0.0) || damping_ == 0.0) return 0.0;
        const double undamped = of_step(a, law_.response(a, 0.0)).reaction;
        return std::max(0.0, undamped) * std::max(-1.0, damping_ * rate(a)) * (a.before - a.gap);
    }

private:
    double rate(const Approach& a) const noexcept { return (a.before - a.gap) / duration_; }
    NormalResponse of_step(const Approach& a, const NormalResponse& now) const noexcept {
        Approach start = a;
        start.gap = a.before;
        const double by = a.gap - a.before, first = law_.response(start, 0.0).reaction;
        if (end_ >= 1.0 || (now.reaction == 0.0 && first == 0.0)) return now;
        // Nearer than that the difference of energies has fewer digits than the mean of both reactions.
        constexpr double near = 1e-4;
        NormalResponse mean{0.5 * (now.reaction + first), 0.5 * now.slope};
        if (std::abs(by) > near * std::max(std::abs(a.gap), std::abs(a.before))) {
            mean.reaction = (law_.energy(start, 0.0) - law_.energy(a, 0.0)) / by;
            mean.slope = (now.reaction - mean.reaction) / by;
        }
        return {(1.0 - end_) * mean.reaction + end_ * now.reaction, (1.0 - end_) * mean.slope + end_ * now.slope};
    }
    Law law_;
    double damping_, duration_ = 0.0, end_ = 1.0;
    bool still_ = false;
};

/// A law that also pulls: by a force F where the pair touches, and by F (1 - gap/d) up to a gap of d. It has an energy, and what
/// it gives on the way in it takes on the way out. Where what holds a fibre is softer than F/d it leaps in and out. What pushes
/// bounds friction, which is mu (R_N + F) of Derjaguin (1934) with Coulomb's law, at no load as well.
template <SeeingNormal Law>
class Adhesive {
public:
    using Sees = Approach;
    struct Parameters {
        typename Law::Parameters law{};
        double line_pull = core::unset;      ///< F of a line of contact [force / length], >= 0
        double crossing_pull = core::unset;  ///< F of a crossing, or an end [force], >= 0
        double range = core::unset;          ///< d [length], > 0
        void validate() const {
            law.validate();
            core::require_not_negative("Adhesive.line_pull", line_pull);
            core::require_not_negative("Adhesive.crossing_pull", crossing_pull);
            core::require_positive("Adhesive.range", range);
        }
    };
    explicit Adhesive(const Parameters& parameters) : law_{core::validated(parameters).law}, p_{parameters} {}
    NormalResponse response(const Approach& a, double = 0.0) const noexcept {
        NormalResponse answer = law_.response(a, 0.0);
        if (a.gap >= p_.range) return answer;
        const double pull = pull_of(a);
        answer.reaction -= pull * std::min(1.0, 1.0 - a.gap / p_.range);
        if (a.gap > 0.0) answer.slope += pull / p_.range;
        return answer;
    }
    /// Nothing beyond the range.
    double energy(const Approach& a, double = 0.0) const noexcept {
        const double away = std::clamp(a.gap, 0.0, p_.range) - p_.range;
        return law_.energy(a, 0.0) - pull_of(a) * (0.5 * away * away / p_.range + std::max(0.0, -a.gap));
    }
    double push(const Approach& a) const noexcept { return law_.response(a, 0.0).reaction; }

private:
    double pull_of(const Approach& a) const noexcept { return a.length > 0.0 ? p_.line_pull * a.length : p_.crossing_pull; }
    Law law_;
    Parameters p_;
};

static_assert(SteppedNormal<Impact<PowerNormal>> && !SteppedNormal<PowerNormal>);
static_assert(PullingNormal<Adhesive<PowerNormal>> && !PullingNormal<PowerNormal>);

}  // namespace fibrant::law
