// SPDX-License-Identifier: MIT
#pragma once
/// @file Sparse Cholesky factor of a symmetric matrix of small blocks, multifrontal: all work is on dense matrices.

#include <fibrant/core/eigen_threads.hpp>
#include <fibrant/core/large_array.hpp>
#include <fibrant/core/parallel.hpp>
#include <fibrant/solver/compressed_panel.hpp>
#include <fibrant/solver/supernodes.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::solver {

/// A = L L^T of a symmetric matrix whose rows and columns come in blocks: nodes, or stations of a coarse space.
///
/// The factor is positive definite always: pivots that are too small are replaced (DenseElimination).
///
/// @tparam Real  float or double, of fronts and factor
template <class Real>
class BlockCholesky {
public:
    using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
    using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

    using Pivots = solver::Pivots;

    explicit BlockCholesky(SmallPivot small = SmallPivot::infinite) : dense_{small} {}

    /// Orders the blocks and finds the pattern of the factor.
    ///
    /// @param sizes  of the blocks, each a multiple of 3: unknowns come in vectors
    /// @param pairs  blocks that may be non-zero off the diagonal, in either order, repetitions allowed
    /// @param places where the blocks stand in space, if they do
    void analyse(const std::vector<int>& sizes, const std::vector<Supernodes::Pair>& pairs, std::span<const Vec3> places = {}) {
        const int n = static_cast<int>(sizes.size());
        supernodes_.analyse(n, pairs, places);
        offset_.assign(core::at(n) + 1, 0);
        for (int v = 0; v < n; ++v) offset_[core::at(supernodes_.place(v)) + 1] = sizes[core::at(v)];
        for (int k = 0; k < n; ++k) offset_[core::at(k) + 1] += offset_[core::at(k)];
        uniform_ = std::adjacent_find(sizes.begin(), sizes.end(), std::not_equal_to<>()) == sizes.end();
        input_.assign(1, 0);
        for (int v = 0; v < n; ++v) input_.push_back(input_.back() + sizes[core::at(v)]);
        entry_.assign(1, 0);
        for (int k = 0; k < n; ++k) {
            const Index own = size(k);
            entry_.push_back(entry_.back() + own * own);
            for (const int row : supernodes_.later(k)) entry_.back() += own * size(row);
        }
        clear();
        const auto& list = supernodes_.list();
        rows_.assign(list.size(), 0);
        children_.assign(list.size(), {});
        for (std::size_t s = 0; s < list.size(); ++s) {
            for (const int row : list[s].rows) rows_[s] += size(row);
            if (list[s].parent >= 0) children_[core::at(list[s].parent)].push_back(static_cast<int>(s));
        }
        compressed_.assign(list.size(), {});
        lay_out(false);
        fill_ = panel_first_.back();
        stack_updates();
    }

    Index unknowns() const noexcept { return offset_.empty() ? 0 : offset_.back(); }
    /// Entries of the exact factor, zeros in its dense panels included.
    Index fill() const noexcept { return fill_; }
    /// Entries that are kept of the last factor, which may be compressed.
    Index entries() const {
        Index sum = panel_first_.empty() ? 0 : panel_first_.back();
        for (const CompressedPanel<Real>& panel : compressed_) sum += panel.entries();
        return sum;
    }

    /// Sets the matrix to zero.
    ///
    /// @param lanes  sums that may be added to at the same time, until they are joined; > 0
    void clear(Index lanes = 1) {
        value_.assign(core::at(entry_.back()), 0.0);
        lane_.resize(core::at(lanes - 1));
        for (std::vector<double>& values : lane_) values.assign(value_.size(), 0.0);
    }
    /// The matrix is the sum of all lanes, in their order.
    void join_lanes() {
        constexpr Index block = 4096;
        const Index all = core::count(value_);
        if (!lane_.empty())
            core::parallel_for((all + block - 1) / block, [&](Index b) {
                for (Index k = b * block; k < std::min(all, (b + 1) * block); ++k)
                    for (const std::vector<double>& values : lane_) value_[core::at(k)] += values[core::at(k)];
            });
        lane_.clear();
    }

    /// Adds `block` at (i, j) and, off the diagonal, its transpose at (j, i). For different lanes from several threads at once.
    /// @return whether the pattern has the block
    template <class Derived>
    bool add(int i, int j, const Eigen::MatrixBase<Derived>& block, Index lane = 0) {
        std::vector<double>& values = lane == 0 ? value_ : lane_[core::at(lane - 1)];
        const int row = supernodes_.place(i), column = supernodes_.place(j);
        if (row < column) {
            double* entry = find(values, column, row);
            if (entry != nullptr) Eigen::Map<Matrix>(entry, size(column), size(row)) += block.transpose();
            return entry != nullptr;
        }
        double* entry = find(values, row, column);
        if (entry != nullptr) Eigen::Map<Matrix>(entry, size(row), size(column)) += block;
        return entry != nullptr;
    }

    /// Where the block (i, j) is kept; null if the pattern lacks it. Column-major; transposed if i is eliminated before j.
    struct Entry {
        double* value;
        Index rows;
        bool transposed;
        /// Adds a 3 x 3 block between vector a of block i and vector b of block j.
        void add(Index a, Index b, const Mat3& block) const {
            if (transposed) {
                for (Index c = 0; c < 3; ++c)
                    for (Index d = 0; d < 3; ++d) value[(3 * b + c) + rows * (3 * a + d)] += block(d, c);
            } else {
                for (Index c = 0; c < 3; ++c)
                    for (Index d = 0; d < 3; ++d) value[(3 * a + d) + rows * (3 * b + c)] += block(d, c);
            }
        }
    };
    Entry entry(int i, int j) {
        const int row = supernodes_.place(i), column = supernodes_.place(j);
        return {find(value_, std::max(row, column), std::min(row, column)), size(std::max(row, column)), row < column};
    }

    /// Factor of the present matrix.
    ///
    /// @param left_out  0: all of it; > 0: wide panels are compressed, entries up to this, over the root of the diagonal of their
    /// row,
    ///                  left out (CompressedPanel). Only where `analyse` knew the places of the blocks, and where no pivot turns
    ///                  negative so
    Pivots factor(Real left_out = 0) {
        left_out_ = supernodes_.sorted() ? left_out : 0;
        Pivots pivots = eliminate();
        if (left_out_ > 0 && (!pivots.finite || pivots.negative > 0)) {
            left_out_ = 0;
            pivots = eliminate();
        }
        return pivots;
    }
    /// What the last factor leaves out.
    Real left_out() const noexcept { return left_out_; }

    /// x <- A^-1 x
    void solve(Vector& x) {
        work_.resize(unknowns());
        double largest = 0.0;
        for (int v = 0; v < supernodes_.vertices(); ++v) {
            auto own = x.segment(input_[core::at(v)], size(supernodes_.place(v)));
            own = own.cwiseProduct(scale_of(supernodes_.place(v))).eval();
            largest = std::max(largest, own.cwiseAbs().maxCoeff());
        }
        const double unit = largest > 0.0 && std::isfinite(largest) ? std::exp2(std::ilogb(largest)) : 1.0;
        for (int v = 0; v < supernodes_.vertices(); ++v) {
            work_.segment(offset_[core::at(supernodes_.place(v))], size(supernodes_.place(v))) =
                (x.segment(input_[core::at(v)], size(supernodes_.place(v))) / unit).template cast<Real>();
        }
        const auto& list = supernodes_.list();
        for (std::size_t s = 0; s < list.size(); ++s) {
            const Index m = columns(static_cast<int>(s));
            auto own = work_.segment(offset_[core::at(list[s].first)], m);
            if (!compressed_[s].empty()) {
                compressed_[s].forward(own, gathered_);
            } else {
                const auto panel = panel_of(s);
                panel.topRows(m).template triangularView<Eigen::Lower>().solveInPlace(own);
                if (rows_[s] == 0) continue;
                gathered_.noalias() = panel.bottomRows(rows_[s]) * own;
            }
            Index row = 0;
            for (const int k : list[s].rows)
                work_.segment(offset_[core::at(k)], size(k)) -= gathered_.segment(row, size(k)), row += size(k);
        }
        for (std::size_t s = list.size(); s-- > 0;) {
            const Index m = columns(static_cast<int>(s));
            auto own = work_.segment(offset_[core::at(list[s].first)], m);
            gathered_.resize(rows_[s]);
            Index row = 0;
            for (const int k : list[s].rows)
                gathered_.segment(row, size(k)) = work_.segment(offset_[core::at(k)], size(k)), row += size(k);
            if (!compressed_[s].empty()) {
                compressed_[s].backward(own, gathered_);
                continue;
            }
            const auto panel = panel_of(s);
            if (rows_[s] > 0) own.noalias() -= panel.bottomRows(rows_[s]).transpose() * gathered_;
            panel.topRows(m).template triangularView<Eigen::Lower>().transpose().solveInPlace(own);
        }
        for (int v = 0; v < supernodes_.vertices(); ++v) {
            x.segment(input_[core::at(v)], size(supernodes_.place(v))) =
                unit * scale_of(supernodes_.place(v))
                           .cwiseProduct(work_.segment(offset_[core::at(supernodes_.place(v))], size(supernodes_.place(v)))
                                             .template cast<double>());
        }
    }

private:
    using Panel = Eigen::Map<RealMatrix>;

    Pivots eliminate() {
        const core::EigenOnOneThread threads;
        Pivots pivots;
        const auto& list = supernodes_.list();
        if (compressing_ != (left_out_ > 0)) lay_out(left_out_ > 0);
        find_scale();
        // What fronts leave to their parents lies on two stacks that levels of the tree take by turns: children lie on top of one
        // when their parent puts its own part on the other. They are kept: pages that are new to a process are slow.
        for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) stack_[k].resize(stack_size_[k]);
        panels_.resize(panel_first_.back());
        wide_.resize(wide_size_);
        const auto update_of = [&](std::size_t s) {
            return Eigen::Map<RealMatrix>(stack_[core::at(update_[s].stack)].data() + update_[s].first, rows_[s], rows_[s]);
        };
        std::vector<int> local(core::at(supernodes_.vertices()), -1);  // first row of a block in the front
        for (std::size_t s = 0; s < list.size(); ++s) {
            const Index m = columns(static_cast<int>(s)), n = m + rows_[s];
            int row = 0;
            for (int k = list[s].first; k < list[s].last; ++k) local[core::at(k)] = row, row += size(k);
            for (const int k : list[s].rows) local[core::at(k)] = row, row += size(k);
            Panel panel = panel_of(s);
            panel.setZero();
            auto update = update_of(s);
            for (Index k = 0; k < n - m; ++k) update.col(k).tail(n - m - k).setZero();  // the upper part is not used
            for (int k = list[s].first; k < list[s].last; ++k) {
                const double* entry = value_.data() + entry_[core::at(k)];
                const auto take = [&](int other) {
                    panel.block(local[core::at(other)], local[core::at(k)], size(other), size(k)) +=
                        (scale_of(other).asDiagonal() * Eigen::Map<const Matrix>(entry, size(other), size(k)) *
                         scale_of(k).asDiagonal())
                            .template cast<Real>();
                    entry += size(other) * size(k);
                };
                take(k);
                for (const int other : supernodes_.later(k)) take(other);
            }
            for (const int c : children_[s]) extend(c, update_of(core::at(c)), local, panel, update);
            const RealVector scale = pivot_scale(list[s].first, list[s].last);
            if (!compressed_[s].empty()) {
                compressed_[s].eliminate(panel, update, scale, row_scale(list[s]), left_out_, dense_, pivots);
                continue;
            }
            dense_.eliminate(panel, 0, m, scale, pivots);
            if (n > m) dense_.subtract_square(panel.bottomRows(n - m), update);
        }
        return pivots;
    }

    /// Columns of a supernode, the diagonal part on top. Those that are compressed have one place to be eliminated in.
    Panel panel_of(std::size_t s) {
        const Index m = columns(static_cast<int>(s));
        return {compressed_[s].empty() ? panels_.data() + panel_first_[s] : wide_.data(), m + rows_[s], m};
    }
    /// Which panels are compressed, and where the others lie.
    void lay_out(bool compressing) {
        constexpr Index least_columns = 256, least_rows = 768, piece = 256;
        const auto& list = supernodes_.list();
        compressing_ = compressing;
        panel_first_.assign(1, 0);
        wide_size_ = 0;
        for (std::size_t s = 0; s < list.size(); ++s) {
            const Index m = columns(static_cast<int>(s)), n = m + rows_[s];
            const bool wide = compressing && m >= least_columns && n >= least_rows;
            compressed_[s].clear();
            panel_first_.push_back(panel_first_.back() + (wide ? 0 : m * n));
            if (!wide) continue;
            wide_size_ = std::max(wide_size_, m * n);
            std::vector<typename CompressedPanel<Real>::Piece> pieces;
            Index row = 0, own = 0;
            const auto take = [&](int k) {
                if (row == 0 || row == m || pieces.back().size + size(k) > piece) pieces.push_back({row, 0});
                pieces.back().size += size(k);
                row += size(k);
                if (row == m) own = core::count(pieces);
            };
            for (int k = list[s].first; k < list[s].last; ++k) take(k);
            for (const int k : list[s].rows) take(k);
            compressed_[s].set(std::move(pieces), own);
        }
    }
    int size(int place) const noexcept { return static_cast<int>(offset_[core::at(place) + 1] - offset_[core::at(place)]); }
    Index columns(int s) const noexcept {
        const auto& supernode = supernodes_.list()[core::at(s)];
        return offset_[core::at(supernode.last)] - offset_[core::at(supernode.first)];
    }
    double* find(std::vector<double>& values, int row, int column) const {
        double* entry = values.data() + entry_[core::at(column)];
        if (row == column) return entry;
        const std::span<const int> later = supernodes_.later(column);
        const auto found = std::lower_bound(later.begin(), later.end(), row);
        if (found == later.end() || *found != row) return nullptr;
        Index rows = (found - later.begin() + 1) * size(column);
        if (!uniform_) {
            rows = size(column);
            for (auto it = later.begin(); it != found; ++it) rows += size(*it);
        }
        return entry + rows * size(column);
    }

    /// Finds room for what each front leaves to its parent. Children come right before their parents in the list.
    void stack_updates() {
        const auto& list = supernodes_.list();
        update_.assign(list.size(), {});
        for (std::size_t s = list.size(); s-- > 0;)
            if (list[s].parent >= 0) update_[s].stack = 1 - update_[core::at(list[s].parent)].stack;
        std::array<Index, 2> top{};
        stack_size_ = {};
        for (std::size_t s = 0; s < list.size(); ++s) {
            Update& own = update_[s];
            const std::size_t k = core::at(own.stack);
            own.first = top[k];
            top[k] += rows_[s] * rows_[s];
            stack_size_[k] = std::max(stack_size_[k], top[k]);
            if (!children_[s].empty()) top[1 - k] = update_[core::at(children_[s].front())].first;
        }
    }

    /// A is factored as S A S, S of powers of two, an entry for each vector, that make its diagonal numbers of order one: floats
    /// would not hold it in all units, and no bit depends on them.
    void find_scale() {
        scale_.resize(unknowns());
        for (int k = 0; k < supernodes_.vertices(); ++k)
            for (int i = 0; i < size(k); i += 3) {
                double largest = 0.0;
                for (int j = i; j < i + 3; ++j)
                    largest = std::max(largest, std::abs(value_[core::at(entry_[core::at(k)] + j * (size(k) + 1))]));
                const double root = largest > 0.0 && std::isfinite(largest) ? std::exp2(-(std::ilogb(largest) / 2)) : 1.0;
                scale_.segment<3>(offset_[core::at(k)] + i).setConstant(root);
            }
    }
    auto scale_of(int place) const { return scale_.segment(offset_[core::at(place)], size(place)); }

    /// What pivots of the places [first, last) are compared with: the diagonal, and of a vector that is nearly nothing in one
    /// direction the others'.
    RealVector pivot_scale(int first, int last) const {
        RealVector scale(offset_[core::at(last)] - offset_[core::at(first)]);
        Index row = 0;
        for (int k = first; k < last; ++k)
            for (int i = 0; i < size(k); ++i)
                scale[row] = static_cast<Real>(std::pow(scale_[offset_[core::at(k)] + i], 2) *
                                               value_[core::at(entry_[core::at(k)] + i * (size(k) + 1))]),
                ++row;
        for (Index k = 0; k < scale.size(); k += 3) {
            const Real largest = scale.template segment<3>(k).maxCoeff();
            for (Index i = k; i < k + 3; ++i) {
                if (scale[i] >= 0) scale[i] = std::max(scale[i], Real(1e-3) * largest);
            }
        }
        return scale;
    }
    /// Roots of the diagonal of all rows of a front.
    RealVector row_scale(const Supernodes::Supernode& supernode) const {
        RealVector scale(offset_[core::at(supernode.last)] - offset_[core::at(supernode.first)] +
                         rows_[core::at(&supernode - supernodes_.list().data())]);
        Index row = 0;
        const auto take = [&](int first, int last) {
            const RealVector own = pivot_scale(first, last).cwiseAbs().cwiseMax(Real(1e-30)).cwiseSqrt();
            scale.segment(row, own.size()) = own;
            row += own.size();
        };
        take(supernode.first, supernode.last);
        for (const int k : supernode.rows) take(k, k + 1);
        return scale;
    }

    /// Adds the update matrix of a child to the panel and the update matrix of its parent.
    void extend(int child, const Eigen::Map<RealMatrix>& from, const std::vector<int>& local, Panel& panel,
                Eigen::Map<RealMatrix>& update) const {
        struct Run {
            Index from, to, length;
        };
        std::vector<Run> runs;  // rows of the child that stay together in the parent
        Index row = 0;
        for (const int k : supernodes_.list()[core::at(child)].rows) {
            const Index to = local[core::at(k)];
            if (!runs.empty() && runs.back().to + runs.back().length == to) {
                runs.back().length += size(k);
            } else {
                runs.push_back({row, to, size(k)});
            }
            row += size(k);
        }
        const Index m = panel.cols();
        for (std::size_t r = 0; r < runs.size(); ++r)
            for (Index c = 0; c < runs[r].length; ++c) {
                const Index source = runs[r].from + c, column = runs[r].to + c;
                for (std::size_t q = r; q < runs.size(); ++q) {
                    const Index skip = q == r ? c : 0, to = runs[q].to + skip, length = runs[q].length - skip;
                    if (column < m) {
                        panel.col(column).segment(to, length) += from.col(source).segment(runs[q].from + skip, length);
                    } else {
                        update.col(column - m).segment(to - m, length) += from.col(source).segment(runs[q].from + skip, length);
                    }
                }
            }
    }

    DenseElimination<Real> dense_;
    Supernodes supernodes_;
    std::vector<Index> offset_;  // first unknown of each place
    std::vector<Index> input_;   // first unknown of each block as it was given
    std::vector<Index> entry_;   // of each place: its diagonal block in `value_`, then those below it
    std::vector<double> value_;
    std::vector<std::vector<double>> lane_;  // further sums
    std::vector<Index> rows_;                // below the columns of each supernode
    std::vector<std::vector<int>> children_;
    struct Update {
        int stack = 0;
        Index first = 0;
    };
    std::vector<Update> update_;  // of each supernode: the place of what it leaves to its parent
    std::array<Index, 2> stack_size_{};
    std::vector<Index> panel_first_;  // of each supernode, in `panels_`
    core::LargeArray<Real> panels_, wide_;
    std::vector<CompressedPanel<Real>> compressed_;  // of each supernode; empty if its panel is dense
    Index fill_ = 0, wide_size_ = 0;
    Real left_out_ = 0;
    bool compressing_ = false;
    std::array<core::LargeArray<Real>, 2> stack_;
    RealVector work_, gathered_;
    Vector scale_;         // S
    bool uniform_ = true;  // all blocks have the same size
};

}  // namespace fibrant::solver
