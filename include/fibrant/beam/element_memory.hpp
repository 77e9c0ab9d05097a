// SPDX-License-Identifier: MIT
#pragma once
/// @file What an element keeps of a law with memory, and what a mesh asks of beams that have one.

#include <fibrant/beam/beam_element.hpp>
#include <fibrant/beam/section_material.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::beam {

/// Energies of an element by its law in a state [force * length].
struct LawFigures {
    double stored = 0.0, dissipated = 0.0;  ///< the second since the accepted state, >= 0
    double driven = 0.0;                    ///< work since the accepted state of what drives the law
};

/// The law of an element and what its points remember of the last accepted state. An iteration reads this and writes nothing: a
/// law is a function of it and of the strains, so that what is not accepted needs no undoing, and there is one copy.
template <SectionMaterial M, int Points>
struct ElementMemory {
    typename M::Section section{};
    Index law = 0;
    Drive drive{};
    std::array<typename M::History, static_cast<std::size_t>(Points)> accepted{};
};

/// A beam whose elements remember.
template <class B>
concept Remembering = BeamElement<B> &&
    requires(const B beam, typename B::Rest& rest, const ElementVector<B>& y, const Drive& drive) {
    B::drive(rest, drive);
    beam.accept(rest, y);
    { beam.figures(rest, y) } -> std::same_as<LawFigures>;
};

/// Parameters of a beam with laws: those of the beam, and of each law that ElasticMaterial::law may ask for.
template <class B, SectionMaterial M>
struct LawParameters : B::Parameters {
    std::vector<typename M::Parameters> laws{};  ///< none: one without parameters, where the law allows it

    void validate() const {
        B::Parameters::validate();
        for (std::size_t k = 0; k < laws.size(); ++k)
            core::with_place([&] { return "law " + std::to_string(k); }, [&] { laws[k].validate(); });
    }
};

/// What all beams with laws have in common. `Self` gives `answers(rest, y)`, one answer a point, and `weight(rest, p)`, the rest
/// arc length that a point stands for [length].
template <class Self, SectionMaterial M>
class Lawful {
public:
    using Material = M;

    template <class Rest>
    static void drive(Rest& rest, const Drive& drive) noexcept {
        rest.memory.drive = drive;
    }
    /// Fresh memory of the points of an element, by who they are.
    template <class Rest>
    void place(Rest& rest, std::int64_t fibre, std::int64_t element) const {
        auto& memory = rest.memory;
        const std::int64_t points = static_cast<std::int64_t>(memory.accepted.size());
        for (std::size_t p = 0; p < memory.accepted.size(); ++p)
            memory.accepted[p] =
                of(rest).fresh(memory.section, {fibre, element * points + static_cast<std::int64_t>(p), Self::weight(rest, p)});
    }
    /// The state becomes what the next increment starts from.
    template <class Rest, class Y>
    void accept(Rest& rest, const Y& y) const {
        const auto answers = self().answers(rest, y);
        for (std::size_t p = 0; p < answers.size(); ++p) rest.memory.accepted[p] = answers[p].history;
    }
    template <class Rest, class Y>
    LawFigures figures(const Rest& rest, const Y& y) const {
        LawFigures sum;
        const auto answers = self().answers(rest, y);
        for (std::size_t p = 0; p < answers.size(); ++p) {
            const double w = Self::weight(rest, p);
            sum.stored += w * answers[p].stored, sum.dissipated += w * answers[p].dissipated, sum.driven += w * answers[p].driven;
        }
        return sum;
    }
    /// Calls see(number) with all that the points remember, in a fixed order.
    template <class Rest, class See>
    static void visit(Rest& rest, const See& see) {
        if constexpr (!std::is_empty_v<typename M::History>)
            for (auto& memory : rest.memory.accepted) M::History::visit(memory, see);
    }
    /// Memory of an element that is part of another one: what lies between the points of that, and never beyond them.
    /// @param xi  of each point of `part` in `whole`, in [-1, 1]
    template <class Rest, std::size_t Points>
    static void take_part(Rest& part, const Rest& whole, const std::array<double, Points>& xi,
                          const std::array<double, Points>& points) {
        if constexpr (!std::is_empty_v<typename M::History>)
            for (std::size_t p = 0; p < Points; ++p) {
                std::size_t k = 0;
                while (k + 2 < Points && xi[p] > points[k + 1]) ++k;
                const std::size_t next = std::min(k + 1, Points - 1);
                const double t = next == k ? 0.0 : std::clamp((xi[p] - points[k]) / (points[next] - points[k]), 0.0, 1.0);
                part.memory.accepted[p] = M::History::between(whole.memory.accepted[k], whole.memory.accepted[next], t);
            }
    }
    /// Point that is nearest to breaking, and how near: 1 breaks.
    template <class Rest, class Y>
    std::pair<double, std::size_t> weakest(const Rest& rest, const Y& y) const requires Breakable<M> {
        std::pair<double, std::size_t> most{0.0, 0};
        const auto strains = self().law_strains(rest, y);
        for (std::size_t p = 0; p < strains.size(); ++p) {
            const double use = of(rest).utilisation(rest.memory.section, strains[p], rest.memory.accepted[p]);
            if (use > most.first) most = {use, p};
        }
        return most;
    }
    template <class Rest>
    void break_point(Rest& rest, std::size_t p) const requires Breakable<M> {
        of(rest).break_now(rest.memory.accepted[p]);
    }

protected:
    Lawful() = default;
    explicit Lawful(const std::vector<typename M::Parameters>& laws) {
        if constexpr (std::constructible_from<M>) {
            if (laws.empty()) laws_.emplace_back();
        } else if constexpr (std::same_as<typename M::Parameters, core::NoParameters>) {
            if (laws.empty()) laws_.emplace_back(core::NoParameters{});
        }
        for (const typename M::Parameters& law : laws) laws_.emplace_back(law);
        core::require_at_least("beam.laws", static_cast<std::ptrdiff_t>(laws_.size()), 1);
    }
    /// Fills the memory of an element.
    template <class Rest>
    void begin(Rest& rest, const SectionConstants& shape, const scene::ElasticMaterial& material, double shear_factor) const {
        if (material.law >= core::count(laws_))
            core::refuse("ElasticMaterial.law", std::to_string(material.law),
                         "less than the number of beam.laws, " + std::to_string(laws_.size()));
        rest.memory.law = material.law;
        rest.memory.section = of(rest).section(shape, material, shear_factor);
        place(rest, 0, 0);
    }
    template <class Rest>
    const M& of(const Rest& rest) const noexcept {
        return laws_[core::at(rest.memory.law)];
    }
    template <class Rest>
    auto answer(const Rest& rest, std::size_t p, const SectionStrains& e) const {
        return of(rest).response(rest.memory.section, e, rest.memory.accepted[p], rest.memory.drive);
    }

private:
    const Self& self() const noexcept { return static_cast<const Self&>(*this); }
    std::vector<M> laws_;
};

/// The tangent of a law, whole: for beams that need few of its numbers.
template <SectionMaterial M>
Eigen::Matrix<double, 12, 12> full_tangent(const std::array<double, M::entries.size()>& numbers) {
    Eigen::Matrix<double, 12, 12> C = Eigen::Matrix<double, 12, 12>::Zero();
    for (std::size_t k = 0; k < numbers.size(); ++k)
        C(M::entries[k].row, M::entries[k].column) = C(M::entries[k].column, M::entries[k].row) = numbers[k];
    return C;
}

}  // namespace fibrant::beam
