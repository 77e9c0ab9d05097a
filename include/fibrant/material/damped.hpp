// SPDX-License-Identifier: MIT
#pragma once
/// @file Internal damping of a section: strains resist their rate, and a rigid motion none.

#include <fibrant/material/elastic.hpp>

#include <concepts>

namespace fibrant::material {

/// A law, and beside it S = beta C d eps/dt, C that of Elastic, with a time beta for each group of strains (Kelvin and Voigt). A
/// mode of the angular frequency omega is damped by the ratio beta omega/2. Strains do not change in a rigid motion of any size,
/// so nothing resists it, under stress as well. What acts over an increment is the stress of a constant rate, and what is
/// dissipated its work: where a motion takes a mean of both ends, the end has what makes that mean. An increment without a
/// duration has none.
template <beam::SectionMaterial Base>
    requires std::derived_from<typename Base::Section, ElasticSection>
class Damped {
public:
    struct Parameters {
        typename Base::Parameters base{};
        double stretch = 0.0;  ///< beta of elongation [time], >= 0
        double bending = 0.0;  ///< [time], >= 0
        double turning = 0.0;  ///< of torsion, shear and gradients of the section [time], >= 0
        double section = 0.0;  ///< of what the section does in its plane [time], >= 0
        void validate() const {
            base.validate();
            core::require_not_negative("Damped.stretch", stretch);
            core::require_not_negative("Damped.bending", bending);
            core::require_not_negative("Damped.turning", turning);
            core::require_not_negative("Damped.section", section);
        }
    };
    struct History {
        [[no_unique_address]] typename Base::History base{};
        SectionStrains strain{};
        SectionStrains flow{};  ///< of the damping, at the end
        template <class Self, class See>
        static void visit(Self& h, const See& see) {
            if constexpr (!std::is_empty_v<typename Base::History>) Base::History::visit(h.base, see);
            for (auto& e : h.strain) see(e);
            for (auto& s : h.flow) see(s);
        }
        static History between(const History& a, const History& b, double t) {
            History h;
            if constexpr (!std::is_empty_v<typename Base::History>) h.base = Base::History::between(a.base, b.base, t);
            for (std::size_t c = 0; c < h.strain.size(); ++c)
                h.strain[c] = (1.0 - t) * a.strain[c] + t * b.strain[c], h.flow[c] = (1.0 - t) * a.flow[c] + t * b.flow[c];
            return h;
        }
    };
    using Section = typename Base::Section;
    static constexpr auto entries = Base::entries;
    static constexpr bool has_rate = true;
    using Answer = beam::SectionAnswer<History, entries.size()>;

    explicit Damped(const Parameters& parameters) : base_(core::validated(parameters).base) {
        by_.fill(parameters.turning);
        by_[strain::e11] = by_[strain::e22] = by_[strain::e12] = parameters.section;
        by_[strain::e33] = parameters.stretch, by_[strain::b1] = by_[strain::b2] = parameters.bending;
    }
    Section section(const beam::SectionConstants& shape, const scene::ElasticMaterial& elastic, double shear_factor) const {
        return base_.section(shape, elastic, shear_factor);
    }
    History fresh(const Section& section, const PointPlace& place) const { return {base_.fresh(section, place), {}, {}}; }
    Answer response(const Section& section, const SectionStrains& e, const History& accepted, const Drive& drive) const {
        const auto base = base_.response(section, e, accepted.base, drive);
        Answer answer{base.stress, base.tangent, {base.history, e, {}}, base.stored, base.dissipated, base.driven};
        if (!(drive.duration > 0.0)) return answer;
        SectionStrains rate;  // times beta: groups are not coupled by C, so that it stays symmetric
        for (std::size_t c = 0; c < e.size(); ++c) rate[c] = by_[c] / drive.duration * (e[c] - accepted.strain[c]);
        const double s = drive.share;
        const SectionStrains more = section.stress(rate);
        const auto C = section.tangent();
        for (std::size_t c = 0; c < e.size(); ++c) {
            answer.history.flow[c] = (more[c] - (1.0 - s) * accepted.flow[c]) / s;
            answer.stress[c] += answer.history.flow[c];
            answer.tangent[c] += by_[c] / (s * drive.duration) * C[c];
            answer.dissipated += more[c] * (e[c] - accepted.strain[c]);
        }
        answer.tangent[lateral] += by_[strain::e11] / (s * drive.duration) * C[12];
        answer.tangent[twist] += by_[strain::c12] / (s * drive.duration) * C[13];
        return answer;
    }
    double utilisation(const Section& section, const SectionStrains& e,
                       const History& accepted) const requires beam::Breakable<Base> {
        return base_.utilisation(section, e, accepted.base);
    }
    void break_now(History& history) const requires beam::Breakable<Base> { base_.break_now(history.base); }

private:
    static constexpr int at_lateral = beam::detail::entry_of(entries, strain::e11, strain::e22);
    static constexpr int at_twist = beam::detail::entry_of(entries, strain::c12, strain::c21);
    static_assert(at_lateral >= 0 && at_twist >= 0, "a law that couples less than the elastic section cannot be damped by it");
    static constexpr std::size_t lateral = static_cast<std::size_t>(at_lateral), twist = static_cast<std::size_t>(at_twist);
    Base base_;
    SectionStrains by_{};  ///< beta of each strain [time]
};
static_assert(beam::SectionMaterial<Damped<Elastic>>);

}  // namespace fibrant::material
