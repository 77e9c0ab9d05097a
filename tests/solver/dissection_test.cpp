// SPDX-License-Identifier: MIT
#include <fibrant/solver/block_cholesky.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <set>
#include <vector>

using namespace fibrant;

namespace dissection_test {

// A block of springs: every point is tied to its neighbours along the axes, and to the ground by a weak spring.
struct Block {
    std::vector<Vec3> places;
    std::vector<solver::Supernodes::Pair> pairs;
    Block(int along, int n) {
        for (int k = 0; k < along * n * n; ++k) {
            places.emplace_back(k / (n * n), k % n, k / n % n);
            if (k % n > 0) pairs.emplace_back(k, k - 1);
            if (k / n % n > 0) pairs.emplace_back(k, k - n);
            if (k / (n * n) > 0) pairs.emplace_back(k, k - n * n);
        }
    }
    SparseMatrix graph() const {
        std::vector<Eigen::Triplet<double>> entries;
        for (int k = 0; k < core::count(places); ++k) entries.emplace_back(k, k, 1.0);
        for (const auto& [i, j] : pairs) entries.emplace_back(i, j, 1.0), entries.emplace_back(j, i, 1.0);
        SparseMatrix a(core::count(places), core::count(places));
        a.setFromTriplets(entries.begin(), entries.end());
        return a;
    }
    solver::BlockCholesky<double> matrix(std::span<const Vec3> hint) const {
        solver::BlockCholesky<double> a;
        a.analyse(std::vector<int>(places.size(), 3), pairs, hint);
        for (int k = 0; k < core::count(places); ++k) a.add(k, k, Mat3(0.01 * Mat3::Identity()));
        for (const auto& [i, j] : pairs) {
            a.add(i, i, Mat3(Mat3::Identity())), a.add(j, j, Mat3(Mat3::Identity()));
            a.add(i, j, Mat3(-Mat3::Identity()));
        }
        return a;
    }
};

TEST_CASE("a dissection orders every vertex once, and leaves a section of a bar to the last") {
    const Block bar(24, 4);
    const SparseMatrix graph = bar.graph();
    std::vector<int> order = solver::Dissection(graph, bar.places).order();
    REQUIRE(order.size() == 384);
    const double middle = bar.places[core::at(order.back())].x();  // no cut touches fewer than the 16 of a section
    for (auto it = order.end() - 16; it != order.end(); ++it) CHECK(bar.places[core::at(*it)].x() == middle);
    CHECK(middle > 6.0);
    CHECK(middle < 18.0);
    std::ranges::sort(order);
    std::vector<int> all(384);
    std::iota(all.begin(), all.end(), 0);
    CHECK(order == all);
}

TEST_CASE("places in space change the order of a large factor, and not what it solves") {
    const Block cube(14, 14);
    REQUIRE(cube.places.size() > 1000);
    solver::BlockCholesky<double> without = cube.matrix({}), with = cube.matrix(cube.places);
    CHECK(with.fill() != without.fill());
    const Vector b = Vector::LinSpaced(3 * core::count(cube.places), -1.0, 2.0);
    Vector x = b, y = b;
    without.factor(), with.factor();
    without.solve(x), with.solve(y);
    CHECK((x - y).norm() < 1e-10 * x.norm());  // condition number below 12 / 0.01
}

TEST_CASE("graphs without edges, with all edges, and with all vertices in one place are ordered too") {
    for (const bool all : {false, true}) {
        std::vector<Eigen::Triplet<double>> entries;
        for (int i = 0; i < 30; ++i)
            for (int j = 0; j < 30; ++j) {
                if (i == j || all) entries.emplace_back(i, j, 1.0);
            }
        SparseMatrix graph(30, 30);
        graph.setFromTriplets(entries.begin(), entries.end());
        const std::vector<Vec3> places(30, Vec3::Zero());
        std::vector<int> order = solver::Dissection(graph, places).order();
        std::ranges::sort(order);
        REQUIRE(order.size() == 30);
        for (int k = 0; k < 30; ++k) CHECK(order[core::at(k)] == k);
    }
}

/// Entries of a factor below its diagonal, by the elimination itself.
std::size_t fill(const SparseMatrix& graph, const std::vector<int>& order) {
    std::vector<std::size_t> rank(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) rank[core::at(order[k])] = k;
    std::vector<std::set<std::size_t>> below(order.size());
    for (int v = 0; v < graph.cols(); ++v)
        for (SparseMatrix::InnerIterator it(graph, v); it; ++it)
            if (rank[core::at(it.row())] > rank[core::at(v)]) below[rank[core::at(v)]].insert(rank[core::at(it.row())]);
    std::size_t sum = 0;
    for (const auto& column : below) {
        sum += column.size();
        if (!column.empty()) below[*column.begin()].insert(std::next(column.begin()), column.end());
    }
    return sum;
}

TEST_CASE("a square that is dissected has less than half of the entries of its band: each cut looks at its own part alone") {
    const Block bar(20, 20);
    std::vector<Eigen::Triplet<double>> entries;
    const std::vector<Vec3> places(bar.places.begin(), bar.places.begin() + 400);  // one section of it
    for (const auto& [i, j] : bar.pairs)
        if (i < 400 && j < 400) entries.emplace_back(i, j, 1.0), entries.emplace_back(j, i, 1.0);
    SparseMatrix graph(400, 400);
    graph.setFromTriplets(entries.begin(), entries.end());
    std::vector<int> band(400);
    std::iota(band.begin(), band.end(), 0);
    CHECK(2 * fill(graph, solver::Dissection(graph, places).order()) < fill(graph, band));  // 3581 of 7619
}

}  // namespace dissection_test
