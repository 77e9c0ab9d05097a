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
        const auto first = [&](Index chain) { return 3 * layout.chains[core::at(chain)].first_vector; };
        const int classes = couplings_.classes();
        values_.resize(core::at(factors_.packs()));
        for (int k = 0; k < classes; ++k)
            factors_.for_class(layout, k, [&](Index pack, const std::vector<Index>& chains, const auto& factor) {
                constexpr std::size_t stride = core::at(std::remove_cvref_t<decltype(factor)>::lanes);
                std::vector<typename std::remove_cvref_t<decltype(factor)>::Kept> y(unknowns(factor));
                for (std::size_t lane = 0; lane < stride; ++lane) {
                    const double* from = r.data() + first(chains[lane < chains.size() ? lane : 0]);
                    for (std::size_t i = 0; i < y.size(); ++i) y[i][static_cast<Index>(lane)] = static_cast<float>(from[i]);
                }
                const auto line = [&](std::size_t lane) { return ChainCouplings::Line{y.front().data() + lane, stride}; };
                for (std::size_t lane = 0; lane < chains.size(); ++lane) couplings_.subtract_earlier(chains[lane], line(lane));
                factor.solve(y.data());
                for (std::size_t lane = 0; lane < chains.size(); ++lane) couplings_.keep_for_later(chains[lane], line(lane));
                std::vector<float>& kept = values_[core::at(pack)];
                kept.assign(y.front().data(), y.front().data() + stride * y.size());
            });
        // B^-1 (B y - L^T z) = y - B^-1 L^T z
        for (int k = classes - 1; k >= 0; --k)
            factors_.for_class(layout, k, [&](Index pack, const std::vector<Index>& chains, const auto& factor) {
                constexpr std::size_t stride = core::at(std::remove_cvref_t<decltype(factor)>::lanes);
                std::vector<typename std::remove_cvref_t<decltype(factor)>::Kept> change(unknowns(factor), std::remove_cvref_t<decltype(factor)>::Kept::Zero());
                const auto line = [&](std::size_t lane) { return ChainCouplings::Line{change.front().data() + lane, stride}; };
                bool later = false;
                for (std::size_t lane = 0; lane < chains.size(); ++lane)
                    if (couplings_.has_later(chains[lane])) couplings_.subtract_later(chains[lane], line(lane)), later = true;
                if (later) factor.solve(change.data());
                const float* y = values_[core::at(pack)].data();
                for (std::size_t i = 0; i < stride * change.size(); ++i) change.front().data()[i] += y[i];
                for (std::size_t lane = 0; lane < chains.size(); ++lane) {
                    double* to = z.data() + first(chains[lane]);
                    for (std::size_t i = 0; i < change.size(); ++i) to[i] = static_cast<double>(change[i][static_cast<Index>(lane)]);
                    couplings_.keep_for_earlier(chains[lane], line(lane));
                }
            });
    }
    /// z = B^-1 r
    void apply_factors(const scene::DofLayout& layout, const Vector& r, Vector& z) const { factors_.apply(layout, r, z); }

    /// Whether chains are swept, not only solved each by itself.
    bool sweeps() const noexcept { return !class_of_.empty(); }

private:
    template <class Factor>
    static std::size_t unknowns(const Factor& factor) {
        return core::at(static_cast<Index>(factor.shape().nodes) * factor.shape().block);
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
