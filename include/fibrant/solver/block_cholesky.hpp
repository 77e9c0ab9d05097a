// SPDX-License-Identifier: MIT
#pragma once
/// @file Sparse Cholesky factor of a symmetric matrix of small blocks, multifrontal: all work is on dense matrices.

#include <fibrant/core/parallel.hpp>
#include <fibrant/solver/supernodes.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::solver {

/// What a pivot that is too small, or negative, is replaced by.
enum class SmallPivot : std::uint8_t {
    infinite,  ///< so much that its unknown stays zero: a singular matrix is solved for the other unknowns
    magnitude, ///< its magnitude, at least `least_pivot`: nearly an inverse, for use as a preconditioner
};

/// A = L L^T of a symmetric matrix whose rows and columns come in blocks: nodes, or stations of a coarse space.
///
/// A pivot that is not positive, or that cancellation has left less than `least_pivot` of, is replaced, so that the factor
/// is positive definite always; SmallPivot says by what.
///
/// @tparam Real  float or double, of fronts and factor
template <class Real>
class BlockCholesky {
public:
    using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
    using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

    static constexpr double least_pivot = sizeof(Real) == 4 ? 1e-6 : 1e-12;  ///< over the diagonal entry [1]

    explicit BlockCholesky(SmallPivot small = SmallPivot::infinite) : small_{small} {}

    struct Pivots {
        Index dropped = 0;   ///< replaced
        Index negative = 0;  ///< of these, negative beyond rounding: the matrix is indefinite
        bool finite = true;
    };

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
        panel_.resize(list.size());
        stack_updates();
    }

    Index unknowns() const noexcept { return offset_.empty() ? 0 : offset_.back(); }
    /// Entries of the factor, zeros in its dense panels included.
    Index fill() const {
        Index sum = 0;
        for (std::size_t s = 0; s < panel_.size(); ++s) sum += columns(static_cast<int>(s)) * (columns(static_cast<int>(s)) + rows_[s]);
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
    Pivots factor() {
        Pivots pivots;
        const auto& list = supernodes_.list();
        // What fronts leave to their parents lies on two stacks that levels of the tree take by turns: children lie on top of one
        // when their parent puts its own part on the other. One allocation, where each would get its pages cleared.
        std::array<std::unique_ptr<Real[]>, 2> stack;
        for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) stack[k] = std::make_unique_for_overwrite<Real[]>(core::at(stack_size_[k]));
        const auto update_of = [&](std::size_t s) {
            return Eigen::Map<RealMatrix>(stack[core::at(update_[s].stack)].get() + update_[s].first, rows_[s], rows_[s]);
        };
        std::vector<int> local(core::at(supernodes_.vertices()), -1);  // first row of a block in the front
        for (std::size_t s = 0; s < list.size(); ++s) {
            const Index m = columns(static_cast<int>(s)), n = m + rows_[s];
            int row = 0;
            for (int k = list[s].first; k < list[s].last; ++k) local[core::at(k)] = row, row += size(k);
            for (const int k : list[s].rows) local[core::at(k)] = row, row += size(k);
            RealMatrix& panel = panel_[s];
            panel.setZero(n, m);
            auto update = update_of(s);
            for (Index k = 0; k < n - m; ++k) update.col(k).tail(n - m - k).setZero();  // the upper part is not used
            for (int k = list[s].first; k < list[s].last; ++k) {
                const double* entry = value_.data() + entry_[core::at(k)];
                const auto take = [&](int other) {
                    panel.block(local[core::at(other)], local[core::at(k)], size(other), size(k)) +=
                        Eigen::Map<const Matrix>(entry, size(other), size(k)).template cast<Real>();
                    entry += size(other) * size(k);
                };
                take(k);
                for (const int other : supernodes_.later(k)) take(other);
            }
            for (const int c : children_[s]) extend(c, update_of(core::at(c)), local, panel, update);
            eliminate(panel, pivot_scale(list[s]), pivots);
            if (n > m) {
                update.template selfadjointView<Eigen::Lower>().rankUpdate(panel.bottomRows(n - m), Real(-1));
            }
        }
        return pivots;
    }

    /// x <- A^-1 x
    void solve(Vector& x) {
        work_.resize(unknowns());
        for (int v = 0; v < supernodes_.vertices(); ++v) {
            work_.segment(offset_[core::at(supernodes_.place(v))], size(supernodes_.place(v))) =
                x.segment(input_[core::at(v)], size(supernodes_.place(v))).template cast<Real>();
        }
        const auto& list = supernodes_.list();
        for (std::size_t s = 0; s < list.size(); ++s) {
            const Index m = columns(static_cast<int>(s));
            auto own = work_.segment(offset_[core::at(list[s].first)], m);
            panel_[s].topRows(m).template triangularView<Eigen::Lower>().solveInPlace(own);
            if (rows_[s] == 0) continue;
            gathered_.noalias() = panel_[s].bottomRows(rows_[s]) * own;
            Index row = 0;
            for (const int k : list[s].rows) work_.segment(offset_[core::at(k)], size(k)) -= gathered_.segment(row, size(k)), row += size(k);
        }
        for (std::size_t s = list.size(); s-- > 0;) {
            const Index m = columns(static_cast<int>(s));
            auto own = work_.segment(offset_[core::at(list[s].first)], m);
            gathered_.resize(rows_[s]);
            Index row = 0;
            for (const int k : list[s].rows) gathered_.segment(row, size(k)) = work_.segment(offset_[core::at(k)], size(k)), row += size(k);
            if (rows_[s] > 0) own.noalias() -= panel_[s].bottomRows(rows_[s]).transpose() * gathered_;
            panel_[s].topRows(m).template triangularView<Eigen::Lower>().transpose().solveInPlace(own);
        }
        for (int v = 0; v < supernodes_.vertices(); ++v) {
            x.segment(input_[core::at(v)], size(supernodes_.place(v))) =
                work_.segment(offset_[core::at(supernodes_.place(v))], size(supernodes_.place(v))).template cast<double>();
        }
    }

private:
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

    /// What pivots are compared with: the diagonal, and of a vector that is nearly nothing in one direction the others'.
    RealVector pivot_scale(const Supernodes::Supernode& supernode) const {
        RealVector scale(offset_[core::at(supernode.last)] - offset_[core::at(supernode.first)]);
        Index row = 0;
        for (int k = supernode.first; k < supernode.last; ++k)
            for (int i = 0; i < size(k); ++i) scale[row++] = static_cast<Real>(value_[core::at(entry_[core::at(k)] + i * (size(k) + 1))]);
        for (Index k = 0; k < scale.size(); k += 3) {
            const Real largest = scale.template segment<3>(k).maxCoeff();
            for (Index i = k; i < k + 3; ++i) {
                if (scale[i] >= 0) scale[i] = std::max(scale[i], Real(1e-3) * largest);
            }
        }
        return scale;
    }

    /// Adds the update matrix of a child to the panel and the update matrix of its parent.
    void extend(int child, const Eigen::Map<RealMatrix>& from, const std::vector<int>& local, RealMatrix& panel, Eigen::Map<RealMatrix>& update) const {
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

    /// Cholesky of the columns of a front, the upper part of `panel`, and what it makes of the rows below: wide steps, so that
    /// large fronts are not read and written once every few columns, made of narrow ones.
    void eliminate(RealMatrix& panel, const RealVector& scale, Pivots& pivots) const {
        constexpr Index wide = 240, narrow = 48;
        const Index m = panel.cols(), n = panel.rows();
        for (Index first = 0; first < m; first += wide) {
            const Index last = std::min(first + wide, m);
            for (Index k = first; k < last; k += narrow) {
                const Index width = std::min(narrow, last - k), next = k + width;
                eliminate_diagonal(panel, k, width, scale, pivots);
                if (next == n) continue;
                auto below = panel.block(next, k, n - next, width);
                panel.block(k, k, width, width).template triangularView<Eigen::Lower>().transpose().template solveInPlace<Eigen::OnTheRight>(below);
                if (next < last)
                    panel.block(next, next, n - next, last - next).noalias() -= below * below.topRows(last - next).transpose();
            }
            for (Index column = last; column < m; column += wide) {  // the lower part alone
                const Index width = std::min(wide, m - column);
                panel.block(column, column, n - column, width).noalias() -=
                    panel.block(column, first, n - column, last - first) * panel.block(column, first, width, last - first).transpose();
            }
        }
    }
    void eliminate_diagonal(RealMatrix& panel, Index first, Index width, const RealVector& scale, Pivots& pivots) const {
        auto diagonal = panel.block(first, first, width, width);
        for (Index j = 0; j < width; ++j) {
            const Real original = scale[first + j];
            Real pivot = diagonal(j, j) - diagonal.row(j).head(j).squaredNorm();
            if (!std::isfinite(pivot)) pivots.finite = false;
            if (!(pivot > static_cast<Real>(least_pivot) * original)) {
                ++pivots.dropped;
                if (pivot < -static_cast<Real>(100 * least_pivot) * std::abs(original) || original < 0) ++pivots.negative;
                pivot = small_ == SmallPivot::infinite
                            ? static_cast<Real>(1e16) * std::max(std::abs(original), Real(1e-10))
                            : std::max({std::abs(pivot), static_cast<Real>(least_pivot) * std::abs(original), Real(1e-30)});
            }
            const Real root = std::sqrt(pivot);
            diagonal(j, j) = root;
            const Index below = width - j - 1;
            if (below > 0) {
                diagonal.col(j).tail(below).noalias() -= diagonal.bottomLeftCorner(below, j) * diagonal.row(j).head(j).transpose();
                diagonal.col(j).tail(below) /= root;
            }
        }
    }

    SmallPivot small_;
    Supernodes supernodes_;
    std::vector<Index> offset_;  // first unknown of each place
    std::vector<Index> input_;   // first unknown of each block as it was given
    std::vector<Index> entry_;   // of each place: its diagonal block in `value_`, then those below it
    std::vector<double> value_;
    std::vector<std::vector<double>> lane_;  // further sums
    std::vector<Index> rows_;    // below the columns of each supernode
    std::vector<std::vector<int>> children_;
    struct Update {
        int stack = 0;
        Index first = 0;
    };
    std::vector<Update> update_;  // of each supernode: the place of what it leaves to its parent
    std::array<Index, 2> stack_size_{};
    std::vector<RealMatrix> panel_;
    RealVector work_, gathered_;
    bool uniform_ = true;  // all blocks have the same size
};

}  // namespace fibrant::solver
