// SPDX-License-Identifier: MIT
#pragma once
/// @file What ties hold in a coarse space of rigid motions: the means of tied ends, which no term of the system knows.

#include <fibrant/solver/coarse_couplings.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace fibrant::solver {

/// Calls body(station i, station j, block) for k P^T B^T (I - U U^T) B P over the ties of positions, as CoarseCouplings does:
/// stations whose motion a tie blocks are held by springs k, stiffer than the chains are, and no station is cut off from its
/// neighbours.
template <bool Values, class Body>
void couple_ties(const CoarseModes& modes, const scene::DofLayout& layout, const assembly::HeldProjector& held,
                 const Body& body) {
    constexpr double stiffer = 1e2;                    // than the support of a tie
    using Rows = std::vector<std::pair<int, Matrix>>;  // of stations
    const auto rows_of = [](Rows& rows, int station, Index count) -> Matrix& {
        const auto place = std::ranges::find(rows, station, &std::pair<int, Matrix>::first);
        if (place != rows.end()) return place->second;
        rows.emplace_back(station, Matrix::Zero(count, 6));
        return rows.back().second;
    };
    double stiffness = 0.0;
    std::vector<std::pair<Index, Index>> tie_of(core::at(scene::tied_scalars(layout)), {-1, 0});
    std::vector<Rows> tied(layout.ties.size());
    for (std::size_t t = 0; t < layout.ties.size(); ++t) {
        const scene::Tie& tie = layout.ties[t];
        if (layout.kind[core::at(tie.vectors.front())] != scene::VectorKind::position) continue;
        stiffness = std::max(stiffness, stiffer * tie.support);
        for (Index a = 0; a < tie.count; ++a) tie_of[core::at(tie.first + a)] = {static_cast<Index>(t), a};
        for (std::size_t k = 0; k < tie.vectors.size(); ++k) {
            const CoarseModes::Hat& hat = modes.places[core::at(tie.vectors[k])].hat;
            const Matrix motion =
                tie.weights[k] * tie.axes.leftCols(tie.count).transpose() * modes.mode(layout, held, tie.vectors[k]);
            for (int i = 0; i < 2; ++i)
                if (hat.weight(i) != 0.0) rows_of(tied[t], hat.station + i, tie.count) += hat.weight(i) * motion;
        }
    }
    if (stiffness == 0.0) return;
    const auto emit = [&](const Rows& rows, double sign) {
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (std::size_t j = 0; j <= i; ++j) {
                CoarseModes::Block block = CoarseModes::Block::Zero();
                if constexpr (Values)
                    block = (i == j ? 0.5 : 1.0) * sign * stiffness * rows[i].second.transpose() * rows[j].second;
                body(rows[i].first, rows[j].first, block);
            }
    };
    for (const Rows& rows : tied) emit(rows, 1.0);
    for (const scene::TiedMotion& motion : layout.motions) {
        if (motion.modes.cols() == 0) continue;
        Rows together;
        for (Index k = 0; k < motion.modes.rows(); ++k) {
            const auto [t, a] = tie_of[core::at(motion.scalars[core::at(k)])];
            if (t < 0) continue;
            for (const auto& [station, rows] : tied[core::at(t)])
                rows_of(together, station, motion.modes.cols()) += motion.modes.row(k).transpose() * rows.row(a);
        }
        emit(together, -1.0);
    }
}

}  // namespace fibrant::solver
