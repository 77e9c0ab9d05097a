// SPDX-License-Identifier: MIT
#pragma once
/// @file Factors of all chains of a system: the preconditioner that is exact while nothing touches.

#include <fibrant/solver/block_band_cholesky.hpp>
#include <fibrant/solver/chain_closing.hpp>
#include <fibrant/solver/linear_solver.hpp>

#include <algorithm>
#include <map>
#include <span>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace fibrant::solver {

/// B^-1 of the block diagonal B that has the band of each chain, its contact elements included, as a block.
///
/// Factors and values in lanes are measured by the units of the layout: floats would not hold forces in all units.
class ChainFactors {
public:
    static constexpr double least_pivot = 1e-12;  ///< over the diagonal entry: below it a chain counts as not held
    static constexpr double least_shift = 1e-6;   ///< of a chain that nothing holds, times its node blocks
    static constexpr std::size_t lanes = 8;       ///< chains of equal shape that are solved together

    /// Sorts the chains into packs of equal shape, and of one class each.
    /// @param class_of  of each chain, from 0 to classes - 1; none: all are of one class
    void analyse(const scene::DofLayout& layout, std::span<const int> class_of = {}, int classes = 1) {
        std::map<std::tuple<int, int, int, int, bool>, std::vector<Index>> kinds;
        for (Index c = 0; c < core::count(layout.chains); ++c) {
            const BandShape shape = shape_of(layout.chains[core::at(c)]);
            kinds[{class_of.empty() ? 0 : class_of[core::at(c)], shape.nodes, shape.block, shape.reach,
                   layout.chains[core::at(c)].closed}]
                .push_back(c);
        }
        std::vector<Pack> before = std::move(packs_);
        packs_.clear();
        first_pack_.assign(1, 0);
        for (const auto& [kind, chains] : kinds) {
            while (core::count(first_pack_) <= std::get<0>(kind)) first_pack_.push_back(core::count(packs_));
            std::size_t first = 0;
            while (first < chains.size()) {
                const std::size_t left = chains.size() - first;
                const std::size_t take = left >= lanes ? lanes : left > 2 ? left : 1;  // two lanes of eight are no gain
                packs_.push_back({std::vector<Index>(chains.begin() + static_cast<std::ptrdiff_t>(first),
                                                     chains.begin() + static_cast<std::ptrdiff_t>(first + take)),
                                  take_or_make(before, shape_of(layout.chains[core::at(chains[first])]), take > 1),
                                  {},
                                  {}});
                first += take;
            }
        }
        while (core::count(first_pack_) <= classes) first_pack_.push_back(core::count(packs_));
    }

    /// Factors of the present values. A chain whose band is not positive definite is shifted until it is: `apply` is
    /// positive definite whatever the status, unless it is not_finite.
    ///
    /// @param see  see(chain, band) is called for each chain with its band, from several threads at once
    template <assembly::LinearSystem System, class See>
    SolveStatus prepare(const System& system, const See& see) {
        std::vector<SolveStatus> status(packs_.size(), SolveStatus::converged);
        core::parallel_for(
            core::count(packs_),
            [&](Index p) {
                Pack& pack = packs_[core::at(p)];
                status[core::at(p)] = std::visit(
                    [&](auto& band) { return prepare(system, pack.chains, band, see, pack.closing(band)); }, pack.factor);
            },
            grain(system.layout(), core::count(packs_)));
        SolveStatus worst = SolveStatus::converged;
        for (const SolveStatus s : status) {
            if (s == SolveStatus::not_finite) return s;
            if (s == SolveStatus::indefinite) worst = s;
        }
        return worst;
    }
    template <assembly::LinearSystem System>
    SolveStatus prepare(const System& system) {
        return prepare(system, [](Index, const Matrix&) {});
    }

    /// Calls body(pack, chains, factor) for the packs of one class, from several threads at once: their number, from 0 to packs()
    /// - 1, the chains of the first lanes, and their BlockBandCholesky.
    template <class Body>
    void for_class(const scene::DofLayout& layout, int of, const Body& body) const {
        const Index first = first_pack_[core::at(of)], last = first_pack_[core::at(of + 1)];
        core::parallel_for(
            last - first,
            [&](Index p) {
                const Pack& pack = packs_[core::at(first + p)];
                std::visit([&](const auto& band) { body(first + p, pack.chains, band); }, pack.factor);
            },
            grain(layout, last - first));
    }
    Index packs() const noexcept { return core::count(packs_); }
    /// values <- B^-1 values of the chains of a pack, by its factor.
    template <int Block, int Lanes, class Kept>
    void solve(Index pack, const BlockBandCholesky<Block, Lanes>& factor, std::vector<Kept>& values) const {
        const auto& closing = packs_[core::at(pack)].closing(factor);
        if (closing.empty())
            factor.solve(values.data());
        else
            closing.apply(values, [&](std::vector<Kept>& rest) { factor.solve(rest.data()); });
    }

    /// What forces and displacements are in lanes: over the layout's units, powers of two.
    static double unit_force(const scene::DofLayout& layout) noexcept { return layout.unit_stiffness * layout.unit_length; }
    static double unit_motion(const scene::DofLayout& layout) noexcept { return layout.unit_length; }

    /// Values of the chains of a pack, a chain a lane; lanes beyond the chains repeat the first.
    /// @param unit  that they are measured by
    template <int Block, int Lanes>
    static auto to_lanes(const scene::DofLayout& layout, const std::vector<Index>& chains,
                         const BlockBandCholesky<Block, Lanes>& factor, const Vector& r, double unit) {
        const double over = 1.0 / unit;
        std::vector<typename BlockBandCholesky<Block, Lanes>::Kept> values(unknowns(factor.shape()));
        std::array<Index, core::at(Lanes)> start{};
        for (std::size_t lane = 0; lane < start.size(); ++lane) {
            start[lane] = 3 * layout.chains[core::at(chains[lane < chains.size() ? lane : 0])].first_vector;
        }
        for (Index k = 0; k < core::count(values); ++k)
            for (int lane = 0; lane < Lanes; ++lane)
                values[core::at(k)][lane] = static_cast<float>(over * r[start[core::at(lane)] + k]);
        return values;
    }
    /// Displacements back to where the chains have them.
    template <class Kept>
    static void from_lanes(const scene::DofLayout& layout, const std::vector<Index>& chains, const std::vector<Kept>& values,
                           Vector& z) {
        const double unit = unit_motion(layout);
        for (std::size_t lane = 0; lane < chains.size(); ++lane) {
            double* to = z.data() + 3 * layout.chains[core::at(chains[lane])].first_vector;
            for (std::size_t k = 0; k < values.size(); ++k)
                to[k] = unit * static_cast<double>(values[k][static_cast<Index>(lane)]);
        }
    }
    /// z = B^-1 r
    void apply(const scene::DofLayout& layout, const Vector& r, Vector& z) const {
        core::parallel_for(
            core::count(packs_),
            [&](Index p) {
                const Pack& pack = packs_[core::at(p)];
                std::visit(
                    [&](const auto& band) {
                        auto values = to_lanes(layout, pack.chains, band, r, unit_force(layout));
                        solve(p, band, values);
                        from_lanes(layout, pack.chains, values, z);
                    },
                    pack.factor);
            },
            grain(layout, core::count(packs_)));
    }

    static std::size_t unknowns(const BandShape& shape) { return core::at(static_cast<Index>(shape.nodes) * shape.block); }

    /// Bytes of the factors.
    std::size_t bytes() const {
        std::size_t sum = 0;
        for (const Pack& pack : packs_) sum += std::visit([](const auto& band) { return band.bytes(); }, pack.factor);
        return sum;
    }

private:
    template <int Block>
    using One = BlockBandCholesky<Block, 1>;
    template <int Block>
    using Several = BlockBandCholesky<Block, static_cast<int>(lanes)>;
    // Director beam 9, Hermite cable 6, bar or node of a solid 3; 0 serves all others.
    using Factor = std::variant<One<0>, One<3>, One<6>, One<9>, Several<0>, Several<3>, Several<6>, Several<9>>;
    struct Pack {
        std::vector<Index> chains;  // fewer than the lanes: the others repeat the first
        Factor factor;
        ChainClosing<Eigen::Array<float, 1, 1>> closing_one;  // of closed chains
        ChainClosing<Eigen::Array<float, static_cast<int>(lanes), 1>> closing_several;
        template <int Block, int Lanes>
        auto& closing(const BlockBandCholesky<Block, Lanes>&) noexcept {
            if constexpr (Lanes == 1)
                return closing_one;
            else
                return closing_several;
        }
        template <int Block, int Lanes>
        const auto& closing(const BlockBandCholesky<Block, Lanes>&) const noexcept {
            if constexpr (Lanes == 1)
                return closing_one;
            else
                return closing_several;
        }
    };

    static BandShape shape_of(const scene::Chain& chain) {
        return {static_cast<int>(chain.nodes), static_cast<int>(3 * chain.vectors_per_node), static_cast<int>(chain.reach)};
    }
    static Factor make(const BandShape& shape, bool several) {
        switch (shape.block) {
            case 3:
                return several ? Factor(Several<3>(shape)) : Factor(One<3>(shape));
            case 6:
                return several ? Factor(Several<6>(shape)) : Factor(One<6>(shape));
            case 9:
                return several ? Factor(Several<9>(shape)) : Factor(One<9>(shape));
            default:
                return several ? Factor(Several<0>(shape)) : Factor(One<0>(shape));
        }
    }

    /// A factor of one of the packs of before, whose memory serves again, or a new one.
    static Factor take_or_make(std::vector<Pack>& before, const BandShape& shape, bool several) {
        for (; !before.empty(); before.pop_back()) {
            const bool same = std::visit([&](const auto& band) { return band.shape() == shape && (band.lanes > 1) == several; },
                                         before.back().factor);
            if (!same) continue;
            Factor factor = std::move(before.back().factor);
            before.pop_back();
            return factor;
        }
        return make(shape, several);
    }

    template <class System, int Block, int Lanes, class See, class Closing>
    static SolveStatus prepare(const System& system, const std::vector<Index>& chains, BlockBandCholesky<Block, Lanes>& factor,
                               const See& see, Closing& closing) {
        std::array<Matrix, core::at(Lanes)> bands;
        closing.clear();
        for (std::size_t lane = 0; lane < bands.size(); ++lane) {
            if (lane >= chains.size()) {
                bands[lane] = bands[0];
                continue;
            }
            system.chain_band(chains[lane], bands[lane]);
            if (!bands[lane].allFinite()) return SolveStatus::not_finite;
            see(chains[lane], std::as_const(bands[lane]));
            bands[lane] /= system.layout().unit_stiffness;
            if constexpr (requires(Matrix corner) { system.chain_corner(chains[lane], corner); }) {
                const scene::Chain& chain = system.layout().chains[core::at(chains[lane])];
                if (!chain.closed) continue;
                Matrix corner;
                system.chain_corner(chains[lane], corner);
                corner /= system.layout().unit_stiffness;
                closing.take(lane, bands[lane], corner, factor.shape().block, chain.nodes - 1);
            }
        }
        SolveStatus status = SolveStatus::converged;
        std::array<Matrix, core::at(Lanes)> shifted;
        for (int attempt = 0;; ++attempt) {
            const auto accepted =
                factor.factor(std::span<const Matrix, core::at(Lanes)>(attempt == 0 ? bands : shifted), least_pivot);
            if (std::find(accepted.begin(), accepted.end(), false) == accepted.end())
                return closing.finish([&](auto& values) { factor.solve(values.data()); }) ? status : SolveStatus::indefinite;
            if (attempt == 0) shifted = bands;
            if (attempt > 0) status = SolveStatus::indefinite;  // the least shift cures what merely floats
            for (std::size_t lane = 0; lane < bands.size(); ++lane) {
                if (!accepted[lane])
                    shift(system.layout(), chains[lane < chains.size() ? lane : 0], bands[lane], attempt, shifted[lane]);
            }
        }
    }

    /// Band that a refused one is replaced by: ever closer to a positive diagonal, which is reached in the end.
    static void shift(const scene::DofLayout& layout, Index chain, const Matrix& band, int attempt, Matrix& shifted) {
        const scene::Chain& of = layout.chains[core::at(chain)];
        const Index m = 3 * of.vectors_per_node;
        const auto square = [&](Index k) { return std::pow(layout.length[core::at(of.first_vector + k / 3)], 2); };
        shifted = band;
        if (attempt == 0) {
            shifted.leftCols(m) *= 1.0 + least_shift;
            return;
        }
        double largest = 0.0;
        for (Index k = 0; k < band.rows(); ++k) largest = std::max(largest, std::abs(band(k, k % m)) / square(k));
        if (largest == 0.0) largest = 1.0;
        const double share = std::pow(10.0, attempt - 5);  // 1e-4, 1e-3, ... 100 times the magnitude of the diagonal
        if (attempt > 7) shifted.setZero();
        for (Index k = 0; k < band.rows(); ++k) {
            shifted(k, k % m) += share * std::max(std::abs(band(k, k % m)), 1e-9 * largest * square(k));
        }
    }

    std::vector<Pack> packs_;        // class by class
    std::vector<Index> first_pack_;  // of each class, and their number
};

}  // namespace fibrant::solver
