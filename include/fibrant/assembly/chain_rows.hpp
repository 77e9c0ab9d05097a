// SPDX-License-Identifier: MIT
#pragma once
/// @file Block bands of chains while they are written, and as products read them: no number is in memory twice for long.

#include <fibrant/assembly/band_product.hpp>

#include <stdexcept>
#include <string>
#include <vector>

namespace fibrant::assembly {

namespace detail {
[[noreturn]] inline void refuse_open(Index chain) {
    throw std::logic_error("what was added to chain " + std::to_string(chain) +
                           " is read, but a chain must be closed first: by close, or by index_points of a system");
}
}  // namespace detail

/// Symmetric block bands of chains of elements. What is added to a chain that is open goes into rows of its own; once it is
/// closed it is in the lanes of a BandProduct alone, and what is added then goes there. Only closed chains can be read.
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
    /// Adds values to a node's row, from its entry (i, column) on. Of a diagonal block the lower half counts, and to the left of
    /// its element a node couples with nothing: what is added there is dropped. @tparam Values  a matrix of fixed size
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

    /// Throws std::logic_error where a chain is open: what was added to it is not yet where it is read.
    void require_closed(Index chain) const {
        if (!open_[core::at(chain)].empty()) detail::refuse_open(chain);
    }
    /// Of all chains.
    void require_closed() const {
        for (Index c = 0; c < core::count(open_); ++c) require_closed(c);
    }
    /// Of chains that are closed; an open one is there as it was when it was closed last.
    const BandProduct<Block, Reach>& product() const noexcept { return band_; }
    /// A copy of a node's row; constant, since what is written to a copy is lost.
    const Row row(Index chain, Index node) const {
        require_closed(chain);
        Row row = Row::Zero();
        band_.each(chain, node, [&](Index i, Index j, Index d, double value) { row(i, (Reach - d) * Block + j) = value; });
        return row;
    }
    /// Adds the band of a chain, block (a, d) being A(a, a - d).
    void add_to(Index chain, Matrix& blocks) const {
        require_closed(chain);
        for (Index a = 0; a < band_.nodes(chain); ++a)
            band_.each(chain, a, [&](Index i, Index j, Index d, double value) { blocks(a * Block + i, d * Block + j) += value; });
    }

private:
    std::vector<std::vector<Row>> open_;  // of each chain; empty: it is closed
    BandProduct<Block, Reach> band_;
};

}  // namespace fibrant::assembly
