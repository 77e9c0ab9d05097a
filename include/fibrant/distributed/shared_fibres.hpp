// SPDX-License-Identifier: MIT
#pragma once
/// @file Fibres that are bonded to solids, preconditioned by all ranks together.

#include <fibrant/distributed/subdomain_levels.hpp>

#include <fibrant/assembly/system_view.hpp>
#include <fibrant/solver/solid_pcg.hpp>

namespace fibrant::distributed {

/// The two levels of a SubdomainLevels, balanced, of vectors that all ranks know: each applies them to its own parts and gets
/// what the others have done. Everything else is done by every rank.
template <Exchange E = OneRank>
class SharedFibres {
public:
    static constexpr bool reads_whole_bands = true;
    using Parameters = typename SubdomainLevels<E>::Parameters;
    explicit SharedFibres(const Parameters& parameters) : levels_{parameters} {}

    /// @throws std::invalid_argument for closed chains and images of periodic cells, which are not shared among ranks yet
    void analyse(const assembly::SystemView& system) { levels_.analyse(system); }
    solver::SolveStatus prepare(const assembly::SystemView& system) { return levels_.prepare(system); }
    /// z = M^-1 r; all ranks know r, and get all of z.
    /// @throws std::runtime_error if they know another one each
    void precondition(const assembly::SystemView& system, const Vector& r, Vector& z) {
        levels_.require_alike(r);
        if (z.size() != r.size()) z.setZero(r.size());
        levels_.balance(system.layout(), r, z);
        levels_.share(z);
    }

    const RankUse& use() const noexcept { return levels_.use(); }
    const Subdomains& cut() const noexcept { return levels_.cut(); }

private:
    SubdomainLevels<E> levels_;
};

/// Fibres bonded to solids: the fibres' preconditioner is shared, the solids' factors and products with the matrix are each
/// rank's.
template <Exchange E = OneRank>
using SharedSolidPcg = solver::SolidPcgWith<SharedFibres<E>>;

}  // namespace fibrant::distributed
