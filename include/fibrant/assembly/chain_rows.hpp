// SPDX-License-Identifier: MIT
#pragma once
/// @file Block bands of chains while they are written, and as products read them: no number is in memory twice for long.

#include <fibrant/assembly/band_product.hpp>

#include <utility>
#include <vector>

namespace fibrant::assembly {

/// Symmetric block bands of chains of elements. What is added to a chain that is open goes into rows of its own; once it is
/// closed it is in the lanes of a BandProduct alone, and what is added then goes there.
///
/// @tparam Block, Reach  as of BandProduct
template <int Block, int Reach>
class ChainRows {
public:
    using Row = typename BandProduct<Block, Reach>::Row;

    ChainRows() = default;
    /// All zero. @param layout  chains of nodes of `Block` unknowns
    explicit ChainRows(const scene::DofLayout& layout) : open_(layout.chains.size()) { band_.arrange(layout); }

    // Of different chains from several threads at once:

    /// Sets a chain to zero, and opens it.
    void open(Index chain) { open_[core::at(chain)].assign(core::at(band_.nodes(chain)), Row::Zero()); }
    /// To be called once most has been added to an open chain.
    void close(Index chain) {
        if (open_[core::at(chain)].empty()) return;
        band_.set(chain, open_[core::at(chain)]);
        core::release(open_[core::at(chain)]);
    }
    /// Adds values to a node's row, from its entry (i, column) on. @tparam Values  a matrix of fixed size
    template <class Values>
    void add(Index chain, Index node, Index i, Index column, const Values& values) {
        constexpr int rows = Values::RowsAtCompileTime, columns = Values::ColsAtCompileTime;
        if (std::vector<Row>& own = open_[core::at(chain)]; !own.empty()) {
            own[core::at(node)].template block<rows, columns>(i, column) += values;
            return;
        }
        for (Index c = 0; c < columns; ++c)
            for (Index r = 0; r < rows; ++r) band_.add(chain, node, i + r, column + c, values(r, c));
    }

    /// Of chains that are closed.
    const BandProduct<Block, Reach>& product() const noexcept { return band_; }
    /// A node's row of a chain that is closed.
    Row row(Index chain, Index node) const {
        Row row = Row::Zero();
        band_.each(chain, node, [&](Index i, Index j, Index d, double value) { row(i, (Reach - d) * Block + j) = value; });
        return row;
    }
    /// Adds the band of a chain that is closed, block (a, d) being A(a, a - d).
    void add_to(Index chain, Matrix& blocks) const {
        for (Index a = 0; a < band_.nodes(chain); ++a)
            band_.each(chain, a, [&](Index i, Index j, Index d, double value) { blocks(a * Block + i, d * Block + j) += value; });
    }

private:
    std::vector<std::vector<Row>> open_;  // of each chain; empty: it is closed
    BandProduct<Block, Reach> band_;
};

}  // namespace fibrant::assembly
