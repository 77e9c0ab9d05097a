// SPDX-License-Identifier: MIT
#pragma once
/// @file Order of elimination by METIS, for those who define FIBRANT_WITH_METIS and link metis. Only this header includes it.

#if !__has_include(<metis.h>)
#error "fibrant/solver/metis_order.hpp needs <metis.h>: install METIS and add its folder to the include path"
#endif

#include <fibrant/core/types.hpp>

#include <metis.h>

#include <vector>

namespace fibrant::solver {

/// Vertices in the order of elimination that METIS' multilevel nested dissection finds; empty if it fails.
///
/// The seed is fixed: one graph has one order.
///
/// @param graph  symmetric pattern
inline std::vector<int> metis_order(const SparseMatrix& graph) {
    const auto vertices = static_cast<idx_t>(graph.cols());
    std::vector<idx_t> start{0}, neighbours;
    neighbours.reserve(core::at(graph.nonZeros()));
    for (Index v = 0; v < graph.cols(); ++v) {
        for (SparseMatrix::InnerIterator it(graph, v); it; ++it) {
            if (it.row() != v) neighbours.push_back(static_cast<idx_t>(it.row()));
        }
        start.push_back(static_cast<idx_t>(neighbours.size()));
    }
    std::vector<idx_t> options(METIS_NOPTIONS), order(core::at(vertices)), place(core::at(vertices));
    METIS_SetDefaultOptions(options.data());
    options[METIS_OPTION_SEED] = 1;
    idx_t n = vertices;
    if (METIS_NodeND(&n, start.data(), neighbours.data(), nullptr, options.data(), order.data(), place.data()) != METIS_OK)
        return {};
    return {order.begin(), order.end()};
}

}  // namespace fibrant::solver
