// SPDX-License-Identifier: MIT
#pragma once
/// @file Sweeps forth and back over the chains of a system, each solved for what those before it leave over, and a correction of
/// all between.

#include <fibrant/solver/chain_couplings.hpp>
#include <fibrant/solver/chain_factors.hpp>

#include <type_traits>
#include <vector>

namespace fibrant::solver {

/// M^-1 = S^-T (B + L Q L^T) S^-1, S = B + L: B the bands of the chains as ChainFactors has them, L their ChainCouplings, Q a
/// correction that is given, symmetric and positive semidefinite as a coarse space is.
///
/// This is a cycle of two levels: the sweep forth, S y = r, leaves r - (S + L^T) y = -L^T y over, which Q answers by the motion
/// c; the sweep back from y + c is S^T (z - y) = -L^T y - L c. No product with the matrix is needed, and M is positive definite
/// whatever L leaves out. Without Q, M = (B + L) B^-1 (B + L)^T is symmetric Gauss-Seidel (Saad, Iterative Methods for Sparse
/// Linear Systems, 10.2). Chains of a class are solved at once. Where classes would leave most lanes of the packs empty M^-1 =
/// B^-1 + Q.
class ChainSweeps {
public:
    void analyse(const scene::DofLayout& layout) {
        class_of_.clear();
        factors_.analyse(layout);
    }

    /// @param see     see(chain, band) is called for each chain with its band, from several threads at once
    /// @param always  sweeps where classes leave most lanes empty, too
    template <assembly::LinearSystem System, class See>
    SolveStatus prepare(const System& system, const See& see, bool always = false) {
        couplings_.find(system);
        const std::vector<int> before = std::move(class_of_);
        class_of_.clear();
        if (always ? !couplings_.empty() : pays()) class_of_ = couplings_.class_of();
        if (class_of_ != before) factors_.analyse(system.layout(), class_of_, class_of_.empty() ? 1 : couplings_.classes());
        return factors_.prepare(system, see);
    }

    /// z = M^-1 r, of an r that is zero outside the free directions of held vectors.
    /// @param correct  correct(left, motion): motion += Q left, zero outside the free directions as well
    /// @param product  (B + L + L^T) z = r + L (z - y - c) if it is wanted, to rounding of float
    /// @return whether there is a product: not without sweeps
    template <class Correct>
    bool apply(const scene::DofLayout& layout, const Vector& r, Vector& z, const Correct& correct, Vector* product = nullptr) {
        if (class_of_.empty()) {
            factors_.apply(layout, r, z);
            correct(r, z);
            return false;
        }
        const int classes = couplings_.classes();
        const double force = ChainFactors::unit_force(layout), motion = ChainFactors::unit_motion(layout);
        values_.resize(core::at(factors_.packs()));
        for (int k = 0; k < classes; ++k)
            factors_.for_class(layout, k, [&](Index pack, const auto& chains, const auto& factor) {
                auto y = ChainFactors::to_lanes(layout, chains, factor, r, force);
                for (std::size_t lane = 0; lane < chains.size(); ++lane) couplings_.subtract_earlier(chains[lane], line(y, lane));
                factors_.solve(pack, factor, y);
                for (std::size_t lane = 0; lane < chains.size(); ++lane) couplings_.keep(chains[lane], line(y, lane));
                values_[core::at(pack)].assign(y.front().data(), y.front().data() + y.front().size() * core::count(y));
            });
        left_.setZero(r.size()), motion_.setZero(r.size());
        const auto of = [&](Vector& all, Index chain, double unit) {
            return ChainCouplings::Line<double>{all.data() + 3 * layout.chains[core::at(chain)].first_vector, 1, unit};
        };
        const Index count = core::count(layout.chains);
        core::parallel_for(
            count, [&](Index chain) { couplings_.subtract_later(chain, of(left_, chain, force)); }, grain(layout, count));
        correct(std::as_const(left_), motion_);
        core::parallel_for(
            count, [&](Index chain) { couplings_.keep_for_later(chain, of(motion_, chain, motion)); }, grain(layout, count));
        // z = y - B^-1 (L^T z + L c)
        for (int k = classes - 1; k >= 0; --k)
            factors_.for_class(layout, k, [&](Index pack, const auto& chains, const auto& factor) {
                using Kept = typename std::remove_cvref_t<decltype(factor)>::Kept;
                std::vector<Kept> values(ChainFactors::unknowns(factor.shape()), Kept::Zero());
                bool coupled = false;
                for (std::size_t lane = 0; lane < chains.size(); ++lane)
                    if (couplings_.couples(chains[lane])) couplings_.subtract(chains[lane], line(values, lane)), coupled = true;
                if (coupled) factors_.solve(pack, factor, values);
                if (product != nullptr) {  // y + c - z
                    auto opposite = ChainFactors::to_lanes(layout, chains, factor, motion_, motion);
                    for (std::size_t i = 0; i < opposite.size(); ++i) opposite[i] -= values[i];
                    for (std::size_t lane = 0; lane < chains.size(); ++lane)
                        couplings_.keep_for_later(chains[lane], line(opposite, lane));
                }
                const std::vector<float>& y = values_[core::at(pack)];
                for (std::size_t i = 0; i < y.size(); ++i) values.front().data()[i] += y[i];
                ChainFactors::from_lanes(layout, chains, values, z);
                for (std::size_t lane = 0; lane < chains.size(); ++lane)
                    couplings_.keep_for_earlier(chains[lane], line(values, lane));
            });
        if (product == nullptr) return false;
        *product = r;
        core::parallel_for(
            count, [&](Index chain) { couplings_.subtract_earlier(chain, of(*product, chain, force)); }, grain(layout, count));
        return true;
    }
    /// z = B^-1 r
    void apply_factors(const scene::DofLayout& layout, const Vector& r, Vector& z) const { factors_.apply(layout, r, z); }

    /// Whether chains are swept, not only solved each by itself.
    bool sweeps() const noexcept { return !class_of_.empty(); }

private:
    /// A chain's values among those of its pack.
    template <class Kept>
    static ChainCouplings::Line<float> line(std::vector<Kept>& values, std::size_t lane) {
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
    Vector left_, motion_;                    // -L^T y, c
};

}  // namespace fibrant::solver
