// SPDX-License-Identifier: MIT
#include <fibrant/solver/supernodes.hpp>

#include <doctest/doctest.h>

#include <numeric>
#include <utility>
#include <vector>

using namespace fibrant;

namespace other_order_test {

/// Places of the vertices of a chain.
std::vector<int> places(int vertices) {
    std::vector<solver::Supernodes::Pair> pairs;
    for (int v = 0; v + 1 < vertices; ++v) pairs.emplace_back(v, v + 1);
    solver::Supernodes nodes;
    nodes.analyse(vertices, pairs);
    std::vector<int> all;
    for (int v = 0; v < vertices; ++v) all.push_back(nodes.place(v));
    return all;
}
std::vector<int> backwards(const SparseMatrix& graph) {
    std::vector<int> order(core::at(graph.cols()));
    std::iota(order.rbegin(), order.rend(), 0);
    return order;
}
std::vector<int> none(const SparseMatrix&) { return {}; }

TEST_CASE("an order from elsewhere is that of large graphs, and where it fails there is the headers' own") {
    const solver::OtherOrder before = std::exchange(solver::other_order, nullptr);
    const std::vector<int> small = places(1000), own = places(1001);
    solver::other_order = none;
    CHECK(places(1001) == own);
    solver::other_order = backwards;
    CHECK(places(1000) == small);
    const std::vector<int> other = places(1001);
    solver::other_order = before;
    CHECK(other != own);
    // From its end a chain is eliminated without fill: the last vertex is the first, and the postorder of its tree is no other
    // order.
    for (int v = 0; v <= 1000; ++v) REQUIRE(other[core::at(v)] == 1000 - v);
}

}  // namespace other_order_test
