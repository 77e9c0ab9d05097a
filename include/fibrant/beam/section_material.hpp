// SPDX-License-Identifier: MIT
#pragma once
/// @file Contract of the laws of a section that may remember: from strains at a point to their conjugates.

#include <fibrant/beam/section_law.hpp>
#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>

#include <array>
#include <concepts>
#include <cstdint>
#include <type_traits>

namespace fibrant::beam {

/// Strains at a point of a fibre as a law sees them, by the indices of `strain`: those of the section are what is left of it once
/// it has contracted as nu says, X_11 = E_11 + nu E_33, X_22 = E_22 + nu E_33, 2 E_12. A section that is free has none of them,
/// and a beam whose sections keep their shape says so by 0.
using SectionStrains = std::array<double, 12>;

/// What an increment gives a law.
struct Drive {
    double duration = 0.0;   ///< of the increment; 0: quasi-static, nothing has time to flow [time]
    double amplitude = 0.0;  ///< at its end, of the channel that drives the law of this fibre [1]
    double share = 1.0;      ///< of a motion: part of the stress at the end in what acts; the rest is that at the start [1]
};

/// Who a point is, for laws that draw lots.
struct PointPlace {
    std::int64_t fibre = 0, point = 0;
    double length = 0.0;  ///< of the fibre at rest that it stands for [length]
};

/// What one increment leaves to the next. Empty: nothing is stored, written or copied.
template <class H>
concept Memory = std::default_initializable<H> && std::copyable<H> &&(std::is_empty_v<H> || requires(H & h, const H& c) {
    H::visit(h, [](double&) {});                   // numbers in a fixed order: files, checkpoints
    { H::between(c, c, 0.5) } -> std::same_as<H>;  // at a place between two, 0 to 1: finer meshes
});
/// The memory of laws that have none.
struct NoMemory {};

/// Place of a number in a tangent, row <= column.
struct Entry {
    int row, column;
};
namespace detail {
/// The diagonal, and then those.
template <std::size_t N>
constexpr std::array<Entry, 12 + N> with_diagonal(const std::array<Entry, N>& others) {
    std::array<Entry, 12 + N> all{};
    for (int c = 0; c < 12; ++c) all[static_cast<std::size_t>(c)] = {c, c};
    for (std::size_t k = 0; k < N; ++k) all[12 + k] = others[k];
    return all;
}
/// Number of an entry, or -1.
template <std::size_t N>
constexpr int entry_of(const std::array<Entry, N>& entries, int row, int column) {
    for (std::size_t k = 0; k < N; ++k)
        if (entries[k].row == row && entries[k].column == column) return static_cast<int>(k);
    return -1;
}
/// Of (c12, c21) and (X_11, X_22): all that an elastic section couples.
inline constexpr auto elastic_entries =
    with_diagonal(std::array<Entry, 2>{{{strain::e11, strain::e22}, {strain::c12, strain::c21}}});
}  // namespace detail

/// Beyond a bound by less than this part of it a point has not begun to flow: what was accepted at its bound starts the next
/// increment there, with the tangent that unloading has. A rounding error, and far below what a strain is known to.
inline constexpr double at_bound = 1e-9;

/// What a law answers at a point, a unit of rest length.
template <class H, std::size_t Entries>
struct SectionAnswer {
    SectionStrains stress{};                ///< conjugates of the strains
    std::array<double, Entries> tangent{};  ///< d stress / d strain, by the law's entries; the rest is 0
    [[no_unique_address]] H history{};      ///< to be kept when the increment is accepted
    double stored = 0.0;                    ///< [force]
    double dissipated = 0.0;                ///< since the accepted state, >= 0 [force]
    double driven = 0.0;                    ///< work done since the accepted state by what drives the law [force]
};

/// A law of a section as a policy: elastic, plastic, viscous, broken.
///
/// Owed beyond the syntax, and checked by tests/material/section_material_contract.hpp: `tangent` is the derivative of `stress`
/// and symmetric; without a rate stored + dissipated is a potential of the stress; nothing negative is dissipated; fresh memory
/// at rest is free of stress. `Section` holds the constants of a fibre, made once, and in `contraction` the nu that makes X_11 of
/// E_11. The first twelve `entries` are the diagonal.
template <class M>
concept SectionMaterial = core::Policy<M> && core::Active<M> && Memory<typename M::History> && requires {
    typename M::Section;
    requires M::entries[11].row == 11 && M::entries[11].column == 11;
    { M::has_rate } -> std::convertible_to<bool>;  // needs increments that have a duration
} && requires(const M material, const SectionConstants& shape, const scene::ElasticMaterial& elastic,
              const typename M::Section& section) {
    { material.section(shape, elastic, 1.0) } -> std::same_as<typename M::Section>;  // and the shear factor
    { section.contraction } -> std::convertible_to<double>;
} && requires(typename M::Section& section) {
    section.keep_shape();  // of a beam whose sections do
} && requires(const M material, const PointPlace& place, const typename M::Section& section, const SectionStrains& strain,
              const typename M::History& accepted, const Drive& drive) {
    { material.fresh(section, place) } -> std::same_as<typename M::History>;
    {
        material.response(section, strain, accepted, drive)
        } -> std::same_as<SectionAnswer<typename M::History, M::entries.size()>>;
};

/// A law whose points break when the strength that they have drawn is reached: at the end of an increment, one after the other.
template <class M>
concept Breakable = SectionMaterial<M> &&
    requires(const M material, const typename M::Section& section, const SectionStrains& strain,
             const typename M::History& accepted, typename M::History& history) {
    { material.utilisation(section, strain, accepted) } -> std::same_as<double>;  // breaks at 1; 0 once broken
    material.break_now(history);
};

/// The law that a beam has by itself: elastic, isotropic, without memory, and without a byte or an instruction.
struct Isotropic : core::Inactive {
    using Parameters = core::NoParameters;
    explicit Isotropic(const Parameters& = {}) {}
};

}  // namespace fibrant::beam
