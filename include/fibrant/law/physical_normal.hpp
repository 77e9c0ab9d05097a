// SPDX-License-Identifier: MIT
#pragma once
/// @file Normal laws that are properties of fibres: a power of the penetration, and one that hardens towards a limit.

#include <fibrant/law/normal_law.hpp>

#include <algorithm>
#include <cmath>

namespace fibrant::law {

/// R = K l p^m of a line of contact, K_x p^m_x of a crossing. Hertz's crossing of round elastic fibres has m_x = 3/2; soft
/// bundles about 2.4. For beams whose sections keep their shape: those that flatten by themselves would be soft twice.
class PowerNormal {
public:
    using Sees = Approach;
    struct Parameters {
        double line_stiffness = core::unset;      ///< K [force / length^(1 + m)], > 0
        double line_exponent = 1.5;               ///< m [1], >= 1
        double crossing_stiffness = core::unset;  ///< K_x [force / length^m_x], > 0
        double crossing_exponent = 1.5;           ///< m_x [1], >= 1
        void validate() const {
            core::require_positive("PowerNormal.line_stiffness", line_stiffness);
            core::require_positive("PowerNormal.crossing_stiffness", crossing_stiffness);
            for (const double exponent : {line_exponent, crossing_exponent})
                core::require(std::isfinite(exponent) && exponent >= 1.0, "PowerNormal: exponent", exponent, "finite and >= 1");
        }
    };
    explicit PowerNormal(const Parameters& parameters) : p_{core::validated(parameters)} {}
    NormalResponse response(const Approach& a, double = 0.0) const noexcept {
        if (a.gap >= 0.0) return {0.0, 0.0};
        const auto [K, m] = of(a);
        const double slope = K * m * std::pow(-a.gap, m - 1.0);
        return {-slope * a.gap / m, -slope};
    }
    double energy(const Approach& a, double = 0.0) const noexcept {
        if (a.gap >= 0.0) return 0.0;
        const auto [K, m] = of(a);
        return K * std::pow(-a.gap, m + 1.0) / (m + 1.0);
    }

private:
    struct Law {
        double stiffness, exponent;
    };
    Law of(const Approach& a) const noexcept {
        return a.length > 0.0 ? Law{p_.line_stiffness * a.length, p_.line_exponent}
                              : Law{p_.crossing_stiffness, p_.crossing_exponent};
    }
    Parameters p_;
};

/// Bundles of fibres that are pressed harden as they fill: R = R_0 [(1 - p/(e D))^-q - 1], e D what is left of the sum D of both
/// radii at most (after van Wyk 1946). Beyond `last_part` of e D it goes on straight, so that an iteration may try what it likes.
class HardeningNormal {
public:
    using Sees = Approach;
    struct Parameters {
        double line_force = core::unset;      ///< R_0 of a line of contact [force / length], > 0
        double crossing_force = core::unset;  ///< R_0 of a crossing [force], > 0
        double share = core::unset;           ///< e [1], in (0, 1]
        double exponent = 3.0;                ///< q [1], > 1
        void validate() const {
            core::require_positive("HardeningNormal.line_force", line_force);
            core::require_positive("HardeningNormal.crossing_force", crossing_force);
            core::require(share > 0.0 && share <= 1.0, "HardeningNormal.share", share, "in (0, 1]");
            core::require(std::isfinite(exponent) && exponent > 1.0, "HardeningNormal.exponent", exponent, "finite and > 1");
        }
    };
    static constexpr double last_part = 0.95;  ///< [1]
    explicit HardeningNormal(const Parameters& parameters) : p_{core::validated(parameters)} {}
    NormalResponse response(const Approach& a, double = 0.0) const noexcept {
        if (a.gap >= 0.0) return {0.0, 0.0};
        const double R = force(a), limit = p_.share * a.reach, x = std::min(last_part, -a.gap / limit),
                     beyond = -a.gap - x * limit;
        const double slope = R * p_.exponent / limit * std::pow(1.0 - x, -p_.exponent - 1.0);
        return {R * (std::pow(1.0 - x, -p_.exponent) - 1.0) + slope * beyond, -slope};
    }
    double energy(const Approach& a, double = 0.0) const noexcept {
        if (a.gap >= 0.0) return 0.0;
        const double R = force(a), q = p_.exponent, limit = p_.share * a.reach, x = std::min(last_part, -a.gap / limit),
                     beyond = -a.gap - x * limit;
        const double slope = R * q / limit * std::pow(1.0 - x, -q - 1.0);
        return R * (limit / (q - 1.0) * (std::pow(1.0 - x, 1.0 - q) - 1.0) - x * limit) +
               (R * (std::pow(1.0 - x, -q) - 1.0) + 0.5 * slope * beyond) * beyond;
    }

private:
    double force(const Approach& a) const noexcept { return a.length > 0.0 ? p_.line_force * a.length : p_.crossing_force; }
    Parameters p_;
};

static_assert(SeeingNormal<PowerNormal> && SeeingNormal<HardeningNormal>);

}  // namespace fibrant::law
