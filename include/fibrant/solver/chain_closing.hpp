// SPDX-License-Identifier: MIT
#pragma once
/// @file What closes the chains of a pack whose factors leave their first nodes out.

#include <fibrant/core/types.hpp>

#include <Eigen/Eigenvalues>

#include <array>
#include <vector>

namespace fibrant::solver {

/// Of the blocks B = (B_00 B_01; B_10 B_11) of a closed chain, 0 its first node: V = B_11^-1 B_10 and S = B_00 - B_01 V, with
/// which
///     z_0 = S^-1 (r_0 - V^T r_1),  z_1 = B_11^-1 r_1 - V z_0,
/// which is positive definite whatever V has lost to rounding.
///
/// @tparam Kept  a number of each chain of the pack
template <class Kept>
class ChainClosing {
public:
    /// Takes the first node out of a band, which has its diagonal block and those below, and is to be factored without.
    /// @param corner  columns of the first node in the last `reach` nodes that are its own: reach m x m, in order
    /// @param own     nodes that are not the image of another one
    void take(std::size_t lane, Matrix& band, const Matrix& corner, Index m, Index own) {
        if (sides_.size() <= lane) sides_.resize(lane + 1);
        Side& side = sides_[lane];
        const Index reach = corner.rows() / m;
        side.first = band.topLeftCorner(m, m);
        side.column.setZero(band.rows(), m);
        for (Index d = 1; d <= reach; ++d) {
            side.column.middleRows(d * m, m) = band.block(d * m, d * m, m, m);
            band.block(d * m, d * m, m, m).setZero();
        }
        side.column.middleRows((own - reach) * m, reach * m) += corner;
        band.topLeftCorner(m, m).setIdentity();
    }

    /// To be called once the rest is factored.
    /// @param solve  solve(values): values <- B_11^-1 values of all lanes
    /// @returns whether all chains are positive definite but for rounding. One that floats, as a ring that turns in what holds
    /// it, is not but is
    ///          held by `least` here.
    template <class Solve>
    bool finish(const Solve& solve) {
        if (sides_.empty()) return true;
        const Index rows = sides_.front().column.rows(), m = sides_.front().column.cols();
        answers_.assign(core::at(rows * m), Kept::Zero());
        std::vector<Kept> values(core::at(rows));
        for (Index c = 0; c < m; ++c) {
            for (Index k = 0; k < rows; ++k)
                for (Index lane = 0; lane < Kept::SizeAtCompileTime; ++lane)
                    values[core::at(k)][lane] =
                        static_cast<float>(sides_[core::at(lane) < sides_.size() ? core::at(lane) : 0].column(k, c));
            solve(values);
            for (Index k = 0; k < rows; ++k) answers_[core::at(k * m + c)] = values[core::at(k)];
        }
        bool definite = true;
        for (std::size_t lane = 0; lane < sides_.size(); ++lane) {
            Side& side = sides_[lane];
            if (!side.first.allFinite()) return false;
            Matrix answer(rows, m);
            for (Index k = 0; k < rows; ++k)
                for (Index c = 0; c < m; ++c)
                    answer(k, c) = static_cast<double>(answers_[core::at(k * m + c)][static_cast<Index>(lane)]);
            const Matrix bound = side.column.transpose() * answer;
            Vector scale = side.first.diagonal();
            for (Index v = 0; v < m; v += 3)
                scale.segment<3>(v) =
                    scale.segment<3>(v).cwiseMax(1e-9 * scale.segment<3>(v).maxCoeff()).cwiseSqrt().cwiseInverse().eval();
            const Eigen::SelfAdjointEigenSolver<Matrix> parts(
                scale.asDiagonal() * (side.first - 0.5 * (bound + bound.transpose())) * scale.asDiagonal());
            if (!(parts.eigenvalues()[0] > -rounding)) definite = false;
            const Matrix root = scale.asDiagonal() * parts.eigenvectors() *
                                parts.eigenvalues().cwiseMax(least).cwiseSqrt().cwiseInverse().asDiagonal();
            side.inverse = root * root.transpose();
        }
        return definite;
    }

    /// values <- B^-1 values
    /// @param solve  as of `finish`
    template <class Solve>
    void apply(std::vector<Kept>& values, const Solve& solve) const {
        const std::size_t m = core::at(sides_.front().first.rows());
        std::array<Kept, most> bound;
        for (std::size_t c = 0; c < m; ++c) bound[c] = values[c];
        for (std::size_t k = m; k < values.size(); ++k)
            for (std::size_t c = 0; c < m; ++c) bound[c] -= answers_[k * m + c] * values[k];
        for (std::size_t c = 0; c < m; ++c) values[c] = Kept::Zero();
        solve(values);
        Vector own(static_cast<Index>(m));
        for (std::size_t lane = 0; lane < core::at(Index{Kept::SizeAtCompileTime}); ++lane) {
            const Side& side = sides_[lane < sides_.size() ? lane : 0];
            for (std::size_t c = 0; c < m; ++c)
                own[static_cast<Index>(c)] = static_cast<double>(bound[c][static_cast<Index>(lane)]);
            own = (side.inverse * own).eval();
            for (std::size_t c = 0; c < m; ++c)
                bound[c][static_cast<Index>(lane)] = static_cast<float>(own[static_cast<Index>(c)]);
        }
        for (std::size_t c = 0; c < m; ++c) values[c] = bound[c];
        for (std::size_t k = m; k < values.size(); ++k)
            for (std::size_t c = 0; c < m; ++c) values[k] -= answers_[k * m + c] * bound[c];
    }
    bool empty() const noexcept { return sides_.empty(); }
    void clear() noexcept { sides_.clear(); }

private:
    static constexpr std::size_t most = 32;   // unknowns of a node
    static constexpr double least = 1e-6;     // of the eigenvalues of S over the diagonal of B_00, as ChainFactors::least_shift
    static constexpr double rounding = 1e-3;  // of a factor in float, which misses the root of its condition number
    struct Side {
        Matrix first, column, inverse;  // B_00, B_10, S^-1
    };
    std::vector<Side> sides_;    // of the chains of the pack
    std::vector<Kept> answers_;  // V, row by row
};

}  // namespace fibrant::solver
