// SPDX-License-Identifier: MIT
#pragma once
/// @file The matrix of a system, formed from its terms in linear time.

#include <fibrant/assembly/visited_system.hpp>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

namespace fibrant::assembly {

/// Forms A from the terms of a system: the pattern once, the values as often as wanted.
class TermAssembly {
public:
    /// Pattern of A: 3 x 3 blocks between vectors that share a term. Linear in the entries of the terms.
    /// @throws std::length_error if A has more than 2^31 - 1 entries
    template <VisitedSystem System>
    void analyse(const System& system) {
        struct Lists {  // the vectors of each term, one list after another
            std::vector<Index> first{0};
            std::vector<int> vectors;
            void add(std::span<const Index> list) {
                for (const Index v : list) vectors.push_back(static_cast<int>(v));
                first.push_back(core::count(vectors));
            }
            void point(const PointTerm& term) { add(term.vectors); }
            void dense(const DenseTerm& term) { add(term.vectors); }
        } lists;
        system.visit(lists);

        const Index n = system.layout().vectors();
        std::vector<Index> start(core::at(n + 1), 0);  // of the terms of a vector
        for (const int v : lists.vectors) ++start[core::at(v) + 1];
        for (Index v = 0; v < n; ++v) start[core::at(v + 1)] += start[core::at(v)];
        std::vector<Index> terms(lists.vectors.size()), next(start.begin(), start.end() - 1);
        for (Index t = 0; t + 1 < core::count(lists.first); ++t) {
            for (Index k = lists.first[core::at(t)]; k < lists.first[core::at(t + 1)]; ++k) {
                terms[core::at(next[core::at(lists.vectors[core::at(k)])]++)] = t;
            }
        }
        column_.assign(1, 0);
        row_.clear();
        std::vector<Index> seen(core::at(n), -1);
        for (Index v = 0; v < n; ++v) {
            const Index begin = core::count(row_);
            row_.push_back(static_cast<int>(v));  // held vectors need a diagonal whether or not a term touches them
            seen[core::at(v)] = v;
            for (Index k = start[core::at(v)]; k < start[core::at(v + 1)]; ++k) {
                const Index t = terms[core::at(k)];
                for (Index l = lists.first[core::at(t)]; l < lists.first[core::at(t + 1)]; ++l) {
                    const int other = lists.vectors[core::at(l)];
                    if (seen[core::at(other)] == v) continue;
                    seen[core::at(other)] = v;
                    row_.push_back(other);
                }
            }
            std::sort(row_.begin() + begin, row_.end());
            column_.push_back(core::count(row_));
        }
        if (9 * core::count(row_) > std::numeric_limits<int>::max()) {
            throw std::length_error("TermAssembly: the matrix has more entries than an int counts");
        }
    }

    /// Is it the same pattern?
    friend bool operator==(const TermAssembly&, const TermAssembly&) = default;

    /// Values of A, both triangles, in the pattern of the last analyse.
    template <VisitedSystem System>
    void fill(const System& system, SparseMatrix& a) const {
        const Index n = core::count(column_) - 1;
        assert(n == system.layout().vectors());
        a.resize(3 * n, 3 * n);
        a.resizeNonZeros(9 * core::count(row_));
        Eigen::Map<Vector>(a.valuePtr(), 9 * core::count(row_)).setZero();
        for (Index v = 0; v < n; ++v) {
            const Index blocks = column_[core::at(v + 1)] - column_[core::at(v)];
            for (Index c = 0; c < 3; ++c) {
                Index entry = 9 * column_[core::at(v)] + 3 * c * blocks;
                a.outerIndexPtr()[3 * v + c] = static_cast<int>(entry);
                for (Index k = 0; k < blocks; ++k) {
                    for (int d = 0; d < 3; ++d) {
                        a.innerIndexPtr()[entry++] = 3 * row_[core::at(column_[core::at(v)] + k)] + d;
                    }
                }
            }
        }
        a.outerIndexPtr()[3 * n] = static_cast<int>(9 * core::count(row_));

        const HeldProjector held(system.layout());
        visit_blocks(system, [&](Index i, Index j, Mat3 block) {
            held.project(i, j, block);
            add(i, j, block, a);
        });
        for (const scene::HeldVector& vector : system.layout().held) {
            add(vector.vector, vector.vector, held.held_part(vector), a);
        }
    }

private:
    void add(Index i, Index j, const Mat3& block, SparseMatrix& a) const {
        const auto begin = row_.begin() + column_[core::at(j)], end = row_.begin() + column_[core::at(j + 1)];
        const auto found = std::lower_bound(begin, end, static_cast<int>(i));
        assert(found != end && *found == i);  // else the terms are not those of the analysis
        for (Index c = 0; c < 3; ++c) {
            double* value = a.valuePtr() + 9 * column_[core::at(j)] + 3 * (c * (end - begin) + (found - begin));
            for (Index d = 0; d < 3; ++d) value[d] += block(d, c);
        }
    }

    std::vector<Index> column_;  // first block of each vector's column, in row_
    std::vector<int> row_;       // row vectors of the blocks, rising in each column
};

/// A, both triangles. Linear in the entries of the terms (and a logarithm of those of a column).
template <VisitedSystem System>
void assemble_from_terms(const System& system, SparseMatrix& a) {
    TermAssembly assembly;
    assembly.analyse(system);
    assembly.fill(system, a);
}

}  // namespace fibrant::assembly
