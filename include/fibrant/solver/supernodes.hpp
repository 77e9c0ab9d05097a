// SPDX-License-Identifier: MIT
#pragma once
/// @file Symbolic sparse Cholesky on a graph of blocks: an order with little fill, and the supernodes of the factor.

#include <fibrant/solver/dissection.hpp>
#if defined(FIBRANT_WITH_METIS)
#include <fibrant/solver/metis_order.hpp>
#endif

#include <Eigen/OrderingMethods>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::solver {

/// The order of elimination of large graphs that a program has from elsewhere, METIS with FIBRANT_WITH_METIS; null: the headers'
/// own. What is compiled without it, such as fibrant::compiled, takes it where the program has it.
using OtherOrder = std::vector<int> (*)(const SparseMatrix& graph);
inline OtherOrder other_order = nullptr;
#if defined(FIBRANT_WITH_METIS)
inline const bool metis_orders = (other_order = metis_order) != nullptr;
#endif

/// Order of elimination of the vertices of a graph, and the columns of the factor that share their rows.
class Supernodes {
public:
    using Pair = std::pair<int, int>;
    struct Supernode {
        int first = 0, last = 0;  ///< columns [first, last)
        int parent = -1;          ///< supernode that its first row belongs to
        std::vector<int> rows;    ///< of the factor below the columns, rising
    };

    /// @param vertices  of the graph
    /// @param pairs     neighbours, in either order, each once or several times; loops may be there
    /// @param places    of the vertices in space, if they are known: an order by dissection is then tried too, which is
    ///                  better the larger the graph; `other_order` is taken instead where there is one
    void analyse(int vertices, const std::vector<Pair>& pairs, std::span<const Vec3> places = {}) {
        const SparseMatrix graph = matrix_of(vertices, pairs);
        const bool large = vertices > 1000;
        const std::vector<int> order = large && other_order != nullptr ? other_order(graph) : std::vector<int>{};
        eliminate(graph, order.empty() ? minimum_degree(graph) : order);
        if (large && order.empty() && other_order == nullptr && !places.empty()) {
            Supernodes other;
            other.eliminate(graph, Dissection(graph, places).order());
            if (other.operations() < operations()) *this = std::move(other);
        }
        merge_supernodes();
        sorted_ = !places.empty();
        if (sorted_) sort_by_place(graph, places);
    }

    int vertices() const noexcept { return static_cast<int>(place_.size()); }
    /// Place of a vertex in the order of elimination.
    int place(int vertex) const noexcept { return place_[core::at(vertex)]; }
    const std::vector<Supernode>& list() const noexcept { return list_; }
    /// Whether the columns of each supernode are sorted by their places in space.
    bool sorted() const noexcept { return sorted_; }
    /// Neighbours of a place that come after it, rising.
    std::span<const int> later(int place) const {
        return {later_.data() + start_[core::at(place)], core::at(start_[core::at(place + 1)] - start_[core::at(place)])};
    }

private:
    static SparseMatrix matrix_of(int n, const std::vector<Pair>& pairs) {
        std::vector<Eigen::Triplet<double, int>> entries;
        entries.reserve(2 * pairs.size() + core::at(n));
        for (const Pair& pair : pairs) {
            if (pair.first == pair.second) continue;
            entries.emplace_back(pair.first, pair.second, 1.0);
            entries.emplace_back(pair.second, pair.first, 1.0);
        }
        for (int v = 0; v < n; ++v) entries.emplace_back(v, v, 1.0);  // without it the ordering takes a vertex for dense
        SparseMatrix graph(n, n);
        graph.setFromTriplets(entries.begin(), entries.end());
        return graph;
    }
    static std::vector<int> minimum_degree(const SparseMatrix& graph) {
        Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
        Eigen::AMDOrdering<int>()(graph, order);
        return {order.indices().data(), order.indices().data() + order.size()};
    }
    /// Columns and rows of the factor for an order of elimination.
    void eliminate(const SparseMatrix& graph, const std::vector<int>& order) {
        place_.assign(order.size(), 0);
        for (int k = 0; k < static_cast<int>(order.size()); ++k) place_[core::at(order[core::at(k)])] = k;
        list_later(graph);
        const std::vector<int> renamed = postorder(elimination_tree());
        for (int& place : place_) place = renamed[core::at(place)];
        list_later(graph);
        find_supernodes();
    }
    /// Of the elimination of blocks of one size, in its unit.
    double operations() const {
        double sum = 0.0;
        for (const Supernode& s : list_) {
            const double columns = s.last - s.first, rows = static_cast<double>(s.rows.size());
            sum += columns * (rows * rows + rows * columns + columns * columns / 3.0);
        }
        return sum;
    }

    void list_later(const SparseMatrix& graph) {
        const int n = vertices();
        start_.assign(core::at(n) + 1, 0);
        for (int v = 0; v < n; ++v)
            for (SparseMatrix::InnerIterator it(graph, v); it; ++it)
                start_[core::at(place(v)) + 1] += place(static_cast<int>(it.row())) > place(v);
        for (int k = 0; k < n; ++k) start_[core::at(k) + 1] += start_[core::at(k)];
        later_.resize(core::at(start_.back()));
        std::vector<int> next(start_.begin(), start_.end() - 1);
        for (int v = 0; v < n; ++v)
            for (SparseMatrix::InnerIterator it(graph, v); it; ++it) {
                const int other = place(static_cast<int>(it.row()));
                if (other > place(v)) later_[core::at(next[core::at(place(v))]++)] = other;
            }
        for (int k = 0; k < n; ++k) std::sort(later_.begin() + start_[core::at(k)], later_.begin() + start_[core::at(k) + 1]);
    }

    /// Parent of each column: the first row of the factor below it (Liu, with path compression); -1 for a root.
    std::vector<int> elimination_tree() const {
        const int n = vertices();
        std::vector<std::vector<int>> before(core::at(n));
        for (int k = 0; k < n; ++k)
            for (const int other : later(k)) before[core::at(other)].push_back(k);
        std::vector<int> parent(core::at(n), -1), ancestor(core::at(n), -1);
        for (int k = 0; k < n; ++k)
            for (int i : before[core::at(k)]) {
                while (i != -1 && i != k) {
                    const int next = ancestor[core::at(i)];
                    ancestor[core::at(i)] = k;
                    if (next == -1) parent[core::at(i)] = k;
                    i = next;
                }
            }
        return parent;
    }

    /// New place of each place: children right before their parent.
    static std::vector<int> postorder(const std::vector<int>& parent) {
        const int n = static_cast<int>(parent.size());
        std::vector<int> child(core::at(n), -1), sibling(core::at(n), -1), renamed(core::at(n), 0), stack;
        for (int k = n - 1; k >= 0; --k) {
            if (parent[core::at(k)] < 0) continue;
            sibling[core::at(k)] = child[core::at(parent[core::at(k)])];
            child[core::at(parent[core::at(k)])] = k;
        }
        int next = 0;
        for (int root = 0; root < n; ++root) {
            if (parent[core::at(root)] >= 0) continue;
            stack.push_back(root);
            while (!stack.empty()) {
                const int k = stack.back();
                if (child[core::at(k)] >= 0) {
                    stack.push_back(child[core::at(k)]);
                    child[core::at(k)] = sibling[core::at(stack.back())];
                } else {
                    renamed[core::at(k)] = next++;
                    stack.pop_back();
                }
            }
        }
        return renamed;
    }

    /// Columns whose rows are the next column and its rows are joined.
    void find_supernodes() {
        const int n = vertices();
        list_.clear();
        std::vector<std::vector<int>> rows(core::at(n));
        std::vector<std::vector<int>> children(core::at(n));
        std::vector<int> seen(core::at(n), -1);
        for (int k = 0; k < n; ++k) {
            std::vector<int>& own = rows[core::at(k)];
            const auto take = [&](int row) {
                if (row <= k || seen[core::at(row)] == k) return;
                seen[core::at(row)] = k;
                own.push_back(row);
            };
            for (const int row : later(k)) take(row);
            for (const int c : children[core::at(k)])
                for (const int row : rows[core::at(c)]) take(row);
            std::sort(own.begin(), own.end());
            if (!own.empty()) children[core::at(own.front())].push_back(k);
            const bool joins = k > 0 && !rows[core::at(k - 1)].empty() && rows[core::at(k - 1)].front() == k &&
                               rows[core::at(k - 1)].size() == own.size() + 1;
            if (joins) {
                list_.back().last = k + 1;
                list_.back().rows = own;
            } else {
                list_.push_back({k, k + 1, -1, own});
            }
            for (const int c : children[core::at(k)]) {
                if (c < k - 1) rows[core::at(c)] = {};  // merged, and no longer asked for
            }
        }
    }

    /// Joins a supernode with the parent right after it if that adds few zeros: larger dense blocks are faster.
    void merge_supernodes() {
        std::vector<Supernode> merged;
        std::vector<double> zeros;  // of each, accumulated
        const auto size = [](double columns, double rows) { return columns * (0.5 * (columns + 1.0) + rows); };
        for (Supernode& next : list_) {
            double own = 0.0;
            while (!merged.empty()) {
                const Supernode& before = merged.back();
                if (before.rows.empty() || before.rows.front() >= next.last || before.last != next.first) break;
                const double c = before.last - before.first, p = next.last - next.first;
                const double all = size(c + p, static_cast<double>(next.rows.size()));
                const double added = own + zeros.back() + all - size(c, static_cast<double>(before.rows.size())) -
                                     size(p, static_cast<double>(next.rows.size()));
                if (added > (c + p <= 4.0 ? 0.5 : c + p <= 16.0 ? 0.2 : 0.05) * all) break;
                next.first = before.first;
                own = added;
                merged.pop_back();
                zeros.pop_back();
            }
            merged.push_back(std::move(next));
            zeros.push_back(own);
        }
        list_ = std::move(merged);
        std::vector<int> supernode(place_.size());
        for (int s = 0; s < static_cast<int>(list_.size()); ++s)
            for (int k = list_[core::at(s)].first; k < list_[core::at(s)].last; ++k) supernode[core::at(k)] = s;
        for (Supernode& s : list_) s.parent = s.rows.empty() ? -1 : supernode[core::at(s.rows.front())];
    }

    /// Columns of a supernode that follow each other stand close to each other: what couples runs of them with others far away
    /// has little rank, and rows of its children stay together in long runs.
    void sort_by_place(const SparseMatrix& graph, std::span<const Vec3> places) {
        std::vector<int> vertex(place_.size()), renamed(place_.size());
        for (int v = 0; v < vertices(); ++v) vertex[core::at(place(v))] = v;
        for (const Supernode& s : list_) halve(std::span(vertex).subspan(core::at(s.first), core::at(s.last - s.first)), places);
        for (int k = 0; k < vertices(); ++k) renamed[core::at(place(vertex[core::at(k)]))] = k;
        for (int k = 0; k < vertices(); ++k) place_[core::at(vertex[core::at(k)])] = k;
        for (Supernode& s : list_) {
            for (int& row : s.rows) row = renamed[core::at(row)];
            std::sort(s.rows.begin(), s.rows.end());
        }
        list_later(graph);
    }
    /// Sorts vertices by halves across their longest direction.
    static void halve(std::span<int> vertices, std::span<const Vec3> places) {
        if (vertices.size() <= 8) return;
        Vec3 low = places[core::at(vertices.front())], high = low;
        for (const int v : vertices) low = low.cwiseMin(places[core::at(v)]), high = high.cwiseMax(places[core::at(v)]);
        Index axis = 0;
        (high - low).maxCoeff(&axis);
        const auto key = [&](int v) { return std::pair{places[core::at(v)][axis], v}; };
        const std::size_t half = vertices.size() / 2;
        std::nth_element(vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(half), vertices.end(),
                         [&](int a, int b) { return key(a) < key(b); });
        halve(vertices.first(half), places);
        halve(vertices.subspan(half), places);
    }

    bool sorted_ = false;
    std::vector<int> place_;
    std::vector<int> start_, later_;
    std::vector<Supernode> list_;
};

}  // namespace fibrant::solver
