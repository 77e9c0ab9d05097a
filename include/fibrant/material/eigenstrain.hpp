// SPDX-License-Identifier: MIT
#pragma once
/// @file A section that is free of stress in another shape than at rest: heat, moisture, shrinkage, growth, curvature and twist
/// set in.

#include <fibrant/material/elastic.hpp>

namespace fibrant::material {

/// Law of the strains less those of a free fibre, which a channel drives. At amplitude a a free fibre is 1 + a `along` times as
/// long and 1 + a `across` times as wide, and bent and twisted by a times what is told: exactly, with no energy. Its strains are
/// those of x = x_0 + xi_1 g_1 + xi_2 g_2 in that shape: E33 = (l^2 - 1)/2, E11 = E22 = (m^2 - 1)/2, b_a = -l m kappa_a, c21 =
/// -c12 = m^2 tau.
///
/// Additive: the stiffness stays that of a unit of old length, right to the first order of a a growth. What drives it does the
/// work -S . d(free strain), booked by trapezia.
template <beam::SectionMaterial Base>
class Eigenstrain {
public:
    struct Parameters {
        typename Base::Parameters base{};
        double along = 0.0;        ///< elongation at amplitude 1 [1], > -1
        double across = 0.0;       ///< widening at amplitude 1 [1], > -1
        double curvature_1 = 0.0;  ///< towards g_1 at amplitude 1 [1 / length]
        double curvature_2 = 0.0;  ///< towards g_2 at amplitude 1 [1 / length]
        double twist = 0.0;        ///< at amplitude 1 [radian / length]
        void validate() const {
            base.validate();
            core::require(std::isfinite(along) && along > -1.0, "Eigenstrain.along", along, "finite and > -1");
            core::require(std::isfinite(across) && across > -1.0, "Eigenstrain.across", across, "finite and > -1");
            core::require_finite("Eigenstrain.curvature_1", curvature_1);
            core::require_finite("Eigenstrain.curvature_2", curvature_2);
            core::require_finite("Eigenstrain.twist", twist);
        }
    };
    struct History {
        [[no_unique_address]] typename Base::History base{};
        SectionStrains stress{};  ///< what has been carried, for the work
        double amplitude = 0.0;
        template <class Self, class See>
        static void visit(Self& h, const See& see) {
            if constexpr (!std::is_empty_v<typename Base::History>) Base::History::visit(h.base, see);
            for (auto& s : h.stress) see(s);
            see(h.amplitude);
        }
        static History between(const History& a, const History& b, double t) {
            History h;
            if constexpr (!std::is_empty_v<typename Base::History>) h.base = Base::History::between(a.base, b.base, t);
            for (std::size_t c = 0; c < h.stress.size(); ++c) h.stress[c] = (1.0 - t) * a.stress[c] + t * b.stress[c];
            h.amplitude = a.amplitude;
            return h;
        }
    };
    using Section = typename Base::Section;
    static constexpr auto entries = Base::entries;
    static constexpr bool has_rate = Base::has_rate;
    using Answer = beam::SectionAnswer<History, entries.size()>;

    explicit Eigenstrain(const Parameters& parameters) : base_(core::validated(parameters).base), p_{parameters} {}
    Section section(const beam::SectionConstants& shape, const scene::ElasticMaterial& elastic, double shear_factor) const {
        return base_.section(shape, elastic, shear_factor);
    }
    History fresh(const Section& section, const PointPlace& place) const { return {base_.fresh(section, place), {}, 0.0}; }
    /// Strains of the free fibre.
    SectionStrains free(const Section& section, double a) const noexcept {
        SectionStrains e{};
        const double l = 1.0 + a * p_.along, m = 1.0 + a * p_.across;
        e[strain::e33] = 0.5 * a * p_.along * (2.0 + a * p_.along);
        e[strain::e11] = e[strain::e22] = 0.5 * a * p_.across * (2.0 + a * p_.across) + section.contraction * e[strain::e33];
        e[strain::b1] = -l * m * a * p_.curvature_1, e[strain::b2] = -l * m * a * p_.curvature_2;
        e[strain::c21] = m * m * a * p_.twist, e[strain::c12] = -e[strain::c21];
        return e;
    }
    Answer response(const Section& section, const SectionStrains& e, const History& accepted, const Drive& drive) const {
        const SectionStrains now = free(section, drive.amplitude), before = free(section, accepted.amplitude);
        SectionStrains x;
        for (std::size_t c = 0; c < e.size(); ++c) x[c] = e[c] - now[c];
        const auto base = base_.response(section, x, accepted.base, drive);
        Answer answer{base.stress, base.tangent,    {base.history, base.stress, drive.amplitude},
                      base.stored, base.dissipated, base.driven};
        for (std::size_t c = 0; c < e.size(); ++c)
            answer.driven -= 0.5 * (base.stress[c] + accepted.stress[c]) * (now[c] - before[c]);
        return answer;
    }
    double utilisation(const Section& section, SectionStrains e, const History& accepted) const requires beam::Breakable<Base> {
        const SectionStrains now = free(section, accepted.amplitude);
        for (std::size_t c = 0; c < e.size(); ++c) e[c] -= now[c];
        return base_.utilisation(section, e, accepted.base);
    }
    void break_now(History& history) const requires beam::Breakable<Base> { base_.break_now(history.base); }

private:
    Base base_;
    Parameters p_;
};
static_assert(beam::SectionMaterial<Eigenstrain<Elastic>>);

}  // namespace fibrant::material
