// SPDX-License-Identifier: MIT
#pragma once
/// @file The brittle fibre: each point has a strength drawn from Weibull's distribution, and breaks once.

#include <fibrant/material/elastic.hpp>

#include <cstdint>
#include <numbers>

namespace fibrant::material {

/// Where flaws are: what the stress of bending is weighed by.
enum class Flaws : std::uint8_t { surface, volume };

namespace detail {
/// Uniform in (0, 1) from a counter (splitmix64, Steele, Lea, Flood 2014): neither threads nor order matter.
inline double uniform(std::uint64_t seed, std::uint64_t a, std::uint64_t b) noexcept {
    const auto mix = [](std::uint64_t x) {
        x += 0x9e3779b97f4a7c15ull;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
        return x ^ (x >> 31);
    };
    return (static_cast<double>(mix(mix(mix(seed) ^ a) ^ b) >> 11) + 0.5) * 0x1p-53;
}
}  // namespace detail

/// Elastic fibre of a strength that varies along it. A length l survives the stress s with the probability exp(-(l/L0) (s/s0)^m)
/// (Weibull 1951): each point draws s0 ((L0/l) X)^(1/m) for the length l that it stands for, X exponential, so that the weakest
/// of a fibre's points has exactly the distribution of its length, however it is cut.
///
/// A bent fibre is weighed over its flaws: sigma_eff = [mean of (sigma_t + sigma_b cos)_+^m]^(1/m) over perimeter or area. Where
/// that reaches the strength at the end of an increment the point breaks (Simulator: the most loaded one, then equilibrium
/// again), and all its stresses are multiplied by `left_over`: not by 0, for the nodes beyond it must be held by something.
class Brittle {
public:
    struct Parameters {
        double strength = core::unset;          ///< s0 [force / length^2], > 0
        double modulus = core::unset;           ///< Weibull's m [1], > 0
        double reference_length = core::unset;  ///< L0 [length], > 0
        Flaws flaws = Flaws::surface;           ///< where a fibre has its flaws, which decides how strength falls with size
        std::uint64_t seed = 1;                 ///< of the lots
        void validate() const {
            core::require_positive("Brittle.strength", strength);
            core::require_positive("Brittle.modulus", modulus);
            core::require_positive("Brittle.reference_length", reference_length);
        }
    };
    static constexpr double left_over = 1e-6;  ///< of the stiffness, where a fibre is broken [1]
    struct History {
        double strength = 0.0;  ///< [force / length^2]
        double broken = 0.0;    ///< 0 or 1
        template <class Self, class See>
        static void visit(Self& h, const See& see) {
            see(h.strength), see(h.broken);
        }
        /// The nearer one: parts of an element share its lot.
        static History between(const History& a, const History& b, double t) { return t < 0.5 ? a : b; }
    };
    struct Section : ElasticSection {
        double young = 0, radius_1 = 0, radius_2 = 0;
    };
    static constexpr auto entries = elastic_entries;
    static constexpr bool has_rate = false;
    using Answer = beam::SectionAnswer<History, entries.size()>;

    explicit Brittle(const Parameters& parameters) : p_{core::validated(parameters)} {}
    /// Throws std::invalid_argument for a section with a hole.
    Section section(const beam::SectionConstants& shape, const scene::ElasticMaterial& elastic, double shear_factor) const {
        core::require(shape.bore == 0.0, "Brittle: CrossSection.bore", shape.bore, "0: its points are those of a full section");
        return {ElasticSection(shape, elastic, shear_factor), elastic.young_modulus,
                2.0 * std::sqrt(shape.second_moment_1 / shape.area), 2.0 * std::sqrt(shape.second_moment_2 / shape.area)};
    }
    History fresh(const Section&, const PointPlace& place) const {
        const double lot =
            -std::log(detail::uniform(p_.seed, static_cast<std::uint64_t>(place.fibre), static_cast<std::uint64_t>(place.point)));
        return {p_.strength * std::pow(p_.reference_length / place.length * lot, 1.0 / p_.modulus), 0.0};
    }
    Answer response(const Section& section, const SectionStrains& e, const History& accepted, const Drive&) const noexcept {
        const double d = accepted.broken != 0.0 ? left_over : 1.0;
        Answer answer;
        answer.history = accepted;
        answer.stress = section.stress(e);
        answer.tangent = section.tangent(d);
        for (std::size_t c = 0; c < e.size(); ++c) answer.stress[c] *= d, answer.stored += 0.5 * e[c] * answer.stress[c];
        return answer;
    }
    /// sigma_eff [force / length^2].
    double acting_stress(const Section& section, const SectionStrains& e) const noexcept {
        const double along = section.young * e[strain::e33];
        const double bent = section.young * std::hypot(section.radius_1 * e[strain::b1], section.radius_2 * e[strain::b2]);
        const double most = along + bent;
        if (most <= 0.0) return 0.0;
        constexpr int angles = 64, rings = 16;  // 1e-6 of the mean at m = 20
        double sum = 0.0, weight = 0.0;
        for (int j = 0; j < angles; ++j) {
            const double c = std::cos(2.0 * std::numbers::pi * (j + 0.5) / angles);
            if (p_.flaws == Flaws::surface) {
                sum += std::pow(std::max(0.0, along + bent * c) / most, p_.modulus), weight += 1.0;
                continue;
            }
            for (int k = 0; k < rings; ++k) {
                const double rho = (k + 0.5) / rings;
                sum += rho * std::pow(std::max(0.0, along + bent * rho * c) / most, p_.modulus), weight += rho;
            }
        }
        return most * std::pow(sum / weight, 1.0 / p_.modulus);
    }
    double utilisation(const Section& section, const SectionStrains& e, const History& accepted) const noexcept {
        return accepted.broken != 0.0 ? 0.0 : acting_stress(section, e) / accepted.strength;
    }
    void break_now(History& history) const noexcept { history.broken = 1.0; }

private:
    Parameters p_;
};
static_assert(beam::SectionMaterial<Brittle> && beam::Breakable<Brittle>);

}  // namespace fibrant::material
