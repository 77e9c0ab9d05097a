// SPDX-License-Identifier: MIT
#pragma once
/// @file Symmetric Gauss-Seidel over the chains of a system: each is solved for what the chains before it leave over.

#include <fibrant/solver/chain_couplings.hpp>
#include <fibrant/solver/chain_factors.hpp>

#include <type_traits>
#include <vector>

namespace fibrant::solver {

/// M^-1 = (B + L)^-T B (B + L)^-1: B the bands of the chains as ChainFactors has them, L their ChainCouplings.
///
/// Two solutions of every chain in the place of one, but for those of the last class, and half as many iterations where modes that
/// several chains share are what converges last: M = A + L B^-1 L^T, up to what L leaves out, is four times closer to A than B there
/// (as symmetric Gauss-Seidel is to Jacobi; Saad, Iterative Methods for Sparse Linear Systems, 10.2).
/// Chains of a class are solved at once. Where classes would leave most lanes of the packs empty M is B.
class ChainSweeps {
public:
    void analyse(const scene::DofLayout& layout) {
        class_of_.clear();
        factors_.analyse(layout);
    }

    /// @param see  see(chain, band) is called for each chain with its band, from several threads at once
    template <assembly::LinearSystem System, class See>
    SolveStatus prepare(const System& system, const See& see) {
        couplings_.find(system);
        const std::vector<int> before = std::move(class_of_);
        class_of_.clear();
        if (pays()) class_of_ = couplings_.class_of();
        if (class_of_ != before) factors_.analyse(system.layout(), class_of_, class_of_.empty() ? 1 : couplings_.classes());
        return factors_.prepare(system, see);
    }

    /// z = M^-1 r, of an r that is zero outside the free directions of held vectors.
    void apply(const scene::DofLayout& layout, const Vector& r, Vector& z) {
        if (class_of_.empty()) return factors_.apply(layout, r, z);
        const int classes = couplings_.classes();
        values_.resize(core::at(factors_.packs()));
        for (int k = 0; k < classes; ++k)
            factors_.for_class(layout, k, [&](Index pack, const auto& chains, const auto& factor) {
                auto y = ChainFactors::to_lanes(layout, chains, factor, r);
                for (std::size_t lane = 0; lane < chains.size(); ++lane) couplings_.subtract_earlier(chains[lane], line(y, lane));
                factor.solve(y.data());
                for (std::size_t lane = 0; lane < chains.size(); ++lane) couplings_.keep_for_later(chains[lane], line(y, lane));
                values_[core::at(pack)].assign(y.front().data(), y.front().data() + y.front().size() * core::count(y));
            });
        // B^-1 (B y - L^T z) = y - B^-1 L^T z
        for (int k = classes - 1; k >= 0; --k)
            factors_.for_class(layout, k, [&](Index pack, const auto& chains, const auto& factor) {
                using Kept = typename std::remove_cvref_t<decltype(factor)>::Kept;
                std::vector<Kept> values(ChainFactors::unknowns(factor.shape()), Kept::Zero());
                bool later = false;
                for (std::size_t lane = 0; lane < chains.size(); ++lane)
                    if (couplings_.has_later(chains[lane])) couplings_.subtract_later(chains[lane], line(values, lane)), later = true;
                if (later) factor.solve(values.data());
                const std::vector<float>& y = values_[core::at(pack)];
                for (std::size_t i = 0; i < y.size(); ++i) values.front().data()[i] += y[i];
                ChainFactors::from_lanes(layout, chains, values, z);
                for (std::size_t lane = 0; lane < chains.size(); ++lane) couplings_.keep_for_earlier(chains[lane], line(values, lane));
            });
    }
    /// z = B^-1 r
    void apply_factors(const scene::DofLayout& layout, const Vector& r, Vector& z) const { factors_.apply(layout, r, z); }

    /// Whether chains are swept, not only solved each by itself.
    bool sweeps() const noexcept { return !class_of_.empty(); }

private:
    /// A chain's values among those of its pack.
    template <class Kept>
    static ChainCouplings::Line line(std::vector<Kept>& values, std::size_t lane) {
        return {values.front().data() + lane, core::at(Index{Kept::SizeAtCompileTime})};
    }
    /// Not more than twice the packs of chains that are sorted by nothing.
    bool pays() const {
        if (couplings_.empty()) return false;
        std::vector<Index> members(core::at(couplings_.classes()), 0);
        for (const int own : couplings_.class_of()) ++members[core::at(own)];
        const auto packs = [](Index chains) { return (chains + Index{ChainFactors::lanes} - 1) / Index{ChainFactors::lanes}; };
        Index sum = 0;
        for (const Index chains : members) sum += packs(chains);
        return sum <= 2 * packs(core::count(couplings_.class_of()));
    }

    ChainFactors factors_;
    ChainCouplings couplings_;
    std::vector<int> class_of_;               // empty: no sweeps
    std::vector<std::vector<float>> values_;  // y of each pack
};

}  // namespace fibrant::solver
