// SPDX-License-Identifier: MIT
#pragma once
/// @file Cholesky factors of the block bands of several equally long chains, one chain a SIMD lane.

#include <fibrant/core/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace fibrant::solver {

/// Size of a block band.
struct BandShape {
    int nodes = 0;
    int block = 0;  ///< m, size of a node's block
    int reach = 0;  ///< blocks below the diagonal
    friend bool operator==(const BandShape&, const BandShape&) = default;
};

/// B = L L^T of `Lanes` symmetric block bands at once, computed in double and kept in float.
///
/// Kept are the inverses of the diagonal blocks G_a = L(a, a)^-1 and W(a, d) = G_a L(a, a - d): B = D (I + W)(I + W)^T
/// D^T with D^-1 = diag(G). What is rounded to float is the factor, not the matrix, so B^-1 is positive definite
/// always, and its relative error grows with the square root of the condition number only.
///
/// @tparam Block  m if known when compiled, 0 otherwise
/// @tparam Lanes  bands that are treated together
template <int Block, int Lanes>
class BlockBandCholesky {
public:
    using Wide = Eigen::Array<double, Lanes, 1>;
    using Kept = Eigen::Array<float, Lanes, 1>;

    static constexpr int lanes = Lanes;

    explicit BlockBandCholesky(const BandShape& shape = {}) : shape_{shape}, before_(core::at(shape.nodes)) {}

    const BandShape& shape() const noexcept { return shape_; }
    /// Bytes of the factor.
    std::size_t bytes() const noexcept { return factor_.size() * sizeof(Kept); }

    /// Factors bands as LinearSystem::chain_band gives them.
    ///
    /// @param bands  of each lane, all of this shape
    /// @param low    a pivot below `low` times the diagonal entry it began as is refused [1]
    /// @return of each lane whether all pivots were accepted; the factor of a refused lane is of no use
    std::array<bool, core::at(Lanes)> factor(std::span<const Matrix, core::at(Lanes)> bands, double low) {
        const int m = block(), reach = shape_.reach, mm = m * m;
        std::array<bool, core::at(Lanes)> accepted;
        accepted.fill(true);
        outline(bands);
        Kept* kept = factor_.data();
        // The last reach + 1 rows of L, and G of their diagonals: row a is kept at slot a % (reach + 1).
        std::vector<Wide> rows(core::at((reach + 1) * (reach + 1) * mm)), inverses(core::at((reach + 1) * mm));
        const auto lower = [&](int a, int d) { return rows.data() + ((a % (reach + 1)) * (reach + 1) + d) * mm; };
        const auto inverse = [&](int a) { return inverses.data() + (a % (reach + 1)) * mm; };
        std::vector<Wide> product(core::at(mm));
        for (int a = 0; a < shape_.nodes; ++a) {
            const int before = before_[core::at(a)];
            for (int d = before; d >= 0; --d) gather(bands, a, d, lower(a, d));
            for (int d = before; d > 0; --d) {
                for (int e = std::min(before, d + before_[core::at(a - d)]); e > d; --e)
                    subtract_outer(m, lower(a, e), lower(a - d, e - d), lower(a, d));
                multiply_transposed_lower(m, lower(a, d), inverse(a - d), product.data());
                std::copy(product.begin(), product.end(), lower(a, d));
                subtract_outer_lower(m, lower(a, d), lower(a, 0));
            }
            invert_cholesky(m, bands, a, low, lower(a, 0), inverse(a), accepted);
            for (int i = 0; i < m; ++i)
                for (int j = 0; j <= i; ++j) *kept++ = inverse(a)[i * m + j].template cast<float>();
            for (int d = 1; d <= before; ++d, kept += mm) {
                for (int i = 0; i < m; ++i)
                    for (int j = 0; j < m; ++j) {
                        Wide sum = Wide::Zero();
                        for (int k = 0; k <= i; ++k) sum += inverse(a)[i * m + k] * lower(a, d)[k * m + j];
                        kept[i * m + j] = sum.template cast<float>();
                    }
            }
        }
        return accepted;
    }

    /// x <- B^-1 x, nodes m entries.
    void solve(Kept* x) const noexcept {
        const int m = block(), mm = m * m, triangle = m * (m + 1) / 2;
        const Kept* g = factor_.data();
        for (int a = 0; a < shape_.nodes; ++a) {
            Kept* y = x + static_cast<std::ptrdiff_t>(a) * m;
            for (int i = m - 1; i >= 0; --i) {
                Kept sum = Kept::Zero();
                for (int j = 0; j <= i; ++j) sum += g[i * (i + 1) / 2 + j] * y[j];
                y[i] = sum;
            }
            for (int d = 1; d <= before_[core::at(a)]; ++d) {
                const Kept* w = g + triangle + (d - 1) * mm;
                const Kept* above = y - d * m;
                for (int i = 0; i < m; ++i) {
                    Kept sum = Kept::Zero();
                    for (int j = 0; j < m; ++j) sum += w[i * m + j] * above[j];
                    y[i] -= sum;
                }
            }
            g += triangle + before_[core::at(a)] * mm;
        }
        for (int a = shape_.nodes - 1; a >= 0; --a) {
            g -= triangle + before_[core::at(a)] * mm;
            Kept* y = x + static_cast<std::ptrdiff_t>(a) * m;
            for (int d = 1; d <= before_[core::at(a)]; ++d) {
                const Kept* w = g + triangle + (d - 1) * mm;
                Kept* above = y - d * m;
                for (int j = 0; j < m; ++j) {
                    Kept sum = Kept::Zero();
                    for (int i = 0; i < m; ++i) sum += w[i * m + j] * y[i];
                    above[j] -= sum;
                }
            }
            for (int j = 0; j < m; ++j) {
                Kept sum = Kept::Zero();
                for (int i = j; i < m; ++i) sum += g[i * (i + 1) / 2 + j] * y[i];
                y[j] = sum;
            }
        }
    }

private:
    int block() const noexcept { return Block > 0 ? Block : shape_.block; }

    /// Blocks left of each diagonal block from the first that is not zero on: a factor has no others. A node in the middle of an
    /// element couples with that element's nodes alone, which makes four blocks of five.
    void outline(std::span<const Matrix, core::at(Lanes)> bands) {
        const int m = block();
        std::size_t entries = 0;
        for (int a = 0; a < shape_.nodes; ++a) {
            int before = std::min(a, shape_.reach);
            const auto is_zero = [&](const Matrix& band) { return (band.block(a * m, before * m, m, m).array() == 0.0).all(); };
            while (before > 0 && std::all_of(bands.begin(), bands.end(), is_zero)) --before;
            before_[core::at(a)] = before;
            entries += core::at(m * (m + 1) / 2 + before * m * m);
        }
        factor_.resize(entries);
    }

    /// Block A(a, a - d) of all lanes, row by row.
    void gather(std::span<const Matrix, core::at(Lanes)> bands, int a, int d, Wide* to) const {
        const int m = block();
        for (int lane = 0; lane < Lanes; ++lane) {
            const Matrix& band = bands[core::at(lane)];
            for (int j = 0; j < m; ++j)
                for (int i = 0; i < m; ++i) to[i * m + j][lane] = band(a * m + i, d * m + j);
        }
    }
    /// c -= a b^T
    static void subtract_outer(int m, const Wide* a, const Wide* b, Wide* c) {
        for (int i = 0; i < m; ++i)
            for (int j = 0; j < m; ++j) {
                Wide sum = Wide::Zero();
                for (int k = 0; k < m; ++k) sum += a[i * m + k] * b[j * m + k];
                c[i * m + j] -= sum;
            }
    }
    /// The lower triangle of c -= a a^T.
    static void subtract_outer_lower(int m, const Wide* a, Wide* c) {
        for (int i = 0; i < m; ++i)
            for (int j = 0; j <= i; ++j) {
                Wide sum = Wide::Zero();
                for (int k = 0; k < m; ++k) sum += a[i * m + k] * a[j * m + k];
                c[i * m + j] -= sum;
            }
    }
    /// c = a g^T of a lower triangle g.
    static void multiply_transposed_lower(int m, const Wide* a, const Wide* g, Wide* c) {
        for (int i = 0; i < m; ++i)
            for (int j = 0; j < m; ++j) {
                Wide sum = Wide::Zero();
                for (int k = 0; k <= j; ++k) sum += a[i * m + k] * g[j * m + k];
                c[i * m + j] = sum;
            }
    }
    /// c <- its Cholesky factor, g = c^-1; a refused pivot is replaced by 1, so that other lanes go on undisturbed.
    void invert_cholesky(int m, std::span<const Matrix, core::at(Lanes)> bands, int a, double low, Wide* c, Wide* g,
                         std::array<bool, core::at(Lanes)>& accepted) const {
        for (int j = 0; j < m; ++j) {
            Wide pivot = c[j * m + j];
            for (int k = 0; k < j; ++k) pivot -= c[j * m + k] * c[j * m + k];
            for (int lane = 0; lane < Lanes; ++lane) {
                const double start = bands[core::at(lane)](a * m + j, j);
                if (pivot[lane] > low * start && start > 0.0 && std::isfinite(pivot[lane])) continue;
                accepted[core::at(lane)] = false;
                pivot[lane] = 1.0;
            }
            Wide root;  // lane by lane: of packets of AVX-512 Eigen gives it to the last digit but one, and lanes would differ
            for (int lane = 0; lane < Lanes; ++lane) root[lane] = std::sqrt(pivot[lane]);
            const Wide over = 1.0 / root;
            c[j * m + j] = root;
            for (int i = j + 1; i < m; ++i) {
                Wide sum = c[i * m + j];
                for (int k = 0; k < j; ++k) sum -= c[i * m + k] * c[j * m + k];
                c[i * m + j] = sum * over;
            }
            g[j * m + j] = over;
        }
        for (int j = 0; j < m; ++j)
            for (int i = j + 1; i < m; ++i) {
                Wide sum = Wide::Zero();
                for (int k = j; k < i; ++k) sum += c[i * m + k] * g[k * m + j];
                g[i * m + j] = -sum * g[i * m + i];
            }
    }

    BandShape shape_;
    std::vector<int> before_;   // blocks that are kept left of each diagonal block
    std::vector<Kept> factor_;  // node by node: G packed by rows of its lower triangle, then W(a, 1), W(a, 2), ...
};

}  // namespace fibrant::solver
