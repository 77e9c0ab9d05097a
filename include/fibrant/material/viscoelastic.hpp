// SPDX-License-Identifier: MIT
#pragma once
/// @file The viscoelastic section: a Prony series, exact for strains that change at a constant rate.

#include <fibrant/material/elastic.hpp>

namespace fibrant::material {

namespace detail {
/// z + log(1 - x) taken from 0: -log(1 - x) - x - x^2/2 for x = 1 - exp(-z), z^3/3 and more, to all digits. @param z  >= 0
inline double third_order_rest(double z, double x) noexcept {
    if (x > 0.1) return z - x - 0.5 * x * x;
    double power = x * x * x, sum = 0.0;
    for (int k = 3; k < 20; ++k, power *= x) sum += power / k;  // x^20/20 is below rounding of x^3/3
    return sum;
}
}  // namespace detail

/// S = C [(1 - sum g_i) eps + sum g_i v_i], v_i' = eps' - v_i/tau_i, v_i the elastic strain of branch i (generalised Maxwell
/// model; the exact step for a constant rate is that of Taylor, Pister, Goudreau 1970). C is that of Elastic: isotropic or
/// transversely isotropic.
///
/// An increment of no duration is instantaneous, one of a very long one relaxed; its length is limited by how straight the path
/// is, not by a time constant. Stored and dissipated are the work of the straight path, to rounding.
template <int Branches>
class Viscoelastic {
    static_assert(Branches >= 1);
    static constexpr std::size_t count = static_cast<std::size_t>(Branches);

public:
    struct Parameters {
        std::array<double, count> share = filled();  ///< g_i of the instantaneous modulus [1], > 0, less than 1 in all
        std::array<double, count> time = filled();   ///< tau_i [time], > 0
        void validate() const {
            double sum = 0.0;
            for (std::size_t i = 0; i < count; ++i) {
                core::require_positive("Viscoelastic.share", share[i]);
                core::require_positive("Viscoelastic.time", time[i]);
                sum += share[i];
            }
            core::require(sum < 1.0, "Viscoelastic.share: sum", sum, "< 1: what is left is the modulus after a long time");
        }
        static std::array<double, count> filled() {
            std::array<double, count> a;
            a.fill(core::unset);
            return a;
        }
    };
    struct History {
        SectionStrains strain{};
        std::array<SectionStrains, count> branch{};
        template <class Self, class See>
        static void visit(Self& h, const See& see) {
            for (auto& e : h.strain) see(e);
            for (auto& v : h.branch)
                for (auto& e : v) see(e);
        }
        static History between(const History& a, const History& b, double t) {
            const auto mean = [t](const SectionStrains& x, const SectionStrains& y) {
                SectionStrains z;
                for (std::size_t c = 0; c < z.size(); ++c) z[c] = (1.0 - t) * x[c] + t * y[c];
                return z;
            };
            History h;
            h.strain = mean(a.strain, b.strain);
            for (std::size_t i = 0; i < count; ++i) h.branch[i] = mean(a.branch[i], b.branch[i]);
            return h;
        }
    };
    using Section = ElasticSection;
    static constexpr auto entries = elastic_entries;
    static constexpr bool has_rate = true;
    using Answer = beam::SectionAnswer<History, entries.size()>;

    explicit Viscoelastic(const Parameters& parameters) : p_{core::validated(parameters)} {}
    Section section(const beam::SectionConstants& shape, const scene::ElasticMaterial& elastic, double shear_factor) const {
        return {shape, elastic, shear_factor};
    }
    History fresh(const Section&, const PointPlace&) const noexcept { return {}; }
    Answer response(const Section& section, const SectionStrains& e, const History& accepted, const Drive& drive) const noexcept {
        Answer answer;
        SectionStrains change, all;  // all: what C multiplies
        double left = 1.0;
        for (const double g : p_.share) left -= g;
        for (std::size_t c = 0; c < e.size(); ++c) change[c] = e[c] - accepted.strain[c], all[c] = left * e[c];
        answer.stored = 0.5 * left * section.product(e, e);
        answer.history.strain = e;
        double modulus = left;
        for (std::size_t i = 0; i < count; ++i) {
            const double g = p_.share[i], z = drive.duration / p_.time[i], gone = -std::expm1(-z), phi = z > 0.0 ? gone / z : 1.0;
            const SectionStrains& old = accepted.branch[i];
            SectionStrains& v = answer.history.branch[i];
            for (std::size_t c = 0; c < e.size(); ++c) v[c] = (1.0 - gone) * old[c] + phi * change[c], all[c] += g * v[c];
            answer.stored += 0.5 * g * section.product(v, v);
            modulus += g * phi;
            if (!(z > 0.0)) continue;
            // The integral of v . C v over the increment, v(s) = old exp(-s) + (change / z)(1 - exp(-s)).
            const double rest = std::isfinite(z) ? detail::third_order_rest(z, gone) / z / z : 0.0;
            answer.dissipated += g * (0.5 * gone * (2.0 - gone) * section.product(old, old) +
                                      gone * phi * section.product(old, change) + rest * section.product(change, change));
        }
        answer.stress = section.stress(all);
        answer.tangent = section.tangent(modulus);
        return answer;
    }

private:
    Parameters p_;
};
static_assert(beam::SectionMaterial<Viscoelastic<2>>);

}  // namespace fibrant::material
