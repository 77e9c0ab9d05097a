// SPDX-License-Identifier: MIT
#pragma once
/// @file Products with the stiffness of crossings whose places slide, in plain loops: few scenes have any.

#include <fibrant/contact/sliding_place.hpp>
#include <fibrant/core/small_matrix.hpp>
#include <fibrant/scene/dof_layout.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace fibrant::assembly {

// Templates by the slide, contact::SlidingStiffness: they cost nobody who has none.

/// y += rows^T stiffness rows x
template <class Slide>
void add_slide(const Slide& slide, const Vector& x, Vector& y) {
    Vector motion(slide.rows.cols());
    for (std::size_t k = 0; k < slide.vectors.size(); ++k)
        for (Index c = 0; c < 3; ++c) motion[3 * static_cast<Index>(k) + c] = x[3 * slide.vectors[k] + c];
    const Vector force = core::transposed_times(slide.rows, core::times(slide.stiffness, core::times(slide.rows, motion)));
    for (std::size_t k = 0; k < slide.vectors.size(); ++k)
        for (Index c = 0; c < 3; ++c) y[3 * slide.vectors[k] + c] += force[3 * static_cast<Index>(k) + c];
}

/// Which chains have vectors of which slides: their own parts of these belong into their bands. A coarse space that has what two
/// chains are coupled by, and not what either of them resists with, is no longer positive definite.
template <class Slide>
class SlidesOfChains {
public:
    /// @param number_of  of a vector: the one that counts, which of an image is its source
    template <class NumberOf>
    void index(const std::vector<Slide>& slides, const scene::DofLayout& layout, const NumberOf& number_of) {
        List chain, slide, last(layout.chains.size(), -1);
        for (Index k = 0; k < core::count(slides); ++k)
            for (const Index vector : slides[core::at(k)].vectors) {
                const auto after = std::upper_bound(layout.chains.begin(), layout.chains.end(), number_of(vector),
                                                    [](Index v, const scene::Chain& one) { return v < one.first_vector; });
                const Index own = after - layout.chains.begin() - 1;
                if (last[core::at(own)] == k) continue;
                last[core::at(own)] = k;
                chain.push_back(own), slide.push_back(k);
            }
        first_.assign(layout.chains.size() + 1, 0);
        for (const Index own : chain) ++first_[core::at(own) + 1];
        for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
        List next = first_;
        slide_.resize(slide.size());
        for (std::size_t k = 0; k < chain.size(); ++k) slide_[core::at(next[core::at(chain[k])]++)] = slide[k];
    }

    /// Adds to a lower block band, as LinearSystem::chain_band has it, what lies within it.
    template <class NumberOf, class Band>
    void add(const std::vector<Slide>& slides, const scene::DofLayout& layout, Index chain, const NumberOf& number_of,
             Band& band) const {
        if (first_.empty()) return;  // values wait for `index`
        const scene::Chain& own = layout.chains[core::at(chain)];
        const Index last = own.first_vector + own.nodes * own.vectors_per_node, block = 3 * own.vectors_per_node;
        for (Index k = first_[core::at(chain)]; k < first_[core::at(chain) + 1]; ++k) {
            const Slide& slide = slides[core::at(slide_[core::at(k)])];
            const Index rows = slide.rows.rows();
            for (std::size_t j = 0; j < slide.vectors.size(); ++j) {
                const Index w = number_of(slide.vectors[j]) - own.first_vector;
                if (w < 0 || w + own.first_vector >= last) continue;
                Band half = Band::Zero(rows, 3);
                for (Index c = 0; c < 3; ++c)
                    for (Index m = 0; m < rows; ++m)
                        for (Index r = 0; r < rows; ++r)
                            half(r, c) += slide.stiffness(r, m) * slide.rows(m, 3 * static_cast<Index>(j) + c);
                for (std::size_t i = 0; i < slide.vectors.size(); ++i) {
                    const Index v = number_of(slide.vectors[i]) - own.first_vector;
                    if (v < 0 || v + own.first_vector >= last) continue;
                    const Index apart = v / own.vectors_per_node - w / own.vectors_per_node;
                    if (apart < 0 || apart > own.reach) continue;
                    const Index row = 3 * v, column = apart * block + 3 * (w % own.vectors_per_node);
                    for (Index c = 0; c < 3; ++c)
                        for (Index r = 0; r < 3; ++r)
                            for (Index m = 0; m < rows; ++m)
                                band(row + r, column + c) += slide.rows(m, 3 * static_cast<Index>(i) + r) * half(m, c);
                }
            }
        }
    }

private:
    using List = decltype(Slide::vectors);  // of Index
    List first_, slide_;                    // of each chain: its slides, rising
};

/// rows^T stiffness rows
template <class Slide>
Matrix whole_slide(const Slide& slide) {
    const Index rows = slide.rows.rows(), columns = slide.rows.cols();
    Matrix half = Matrix::Zero(columns, rows), whole = Matrix::Zero(columns, columns);
    for (Index c = 0; c < rows; ++c)
        for (Index k = 0; k < rows; ++k) {
            const double factor = slide.stiffness(k, c);
            if (factor == 0.0) continue;
            for (Index r = 0; r < columns; ++r) half(r, c) += slide.rows(k, r) * factor;
        }
    for (Index c = 0; c < columns; ++c)
        for (Index k = 0; k < rows; ++k) {
            const double factor = slide.rows(k, c);
            if (factor == 0.0) continue;  // most rows know one of the two fibres alone
            double* const to = whole.data() + c * columns;
            const double* const from = half.data() + k * columns;
#ifdef _OPENMP
#pragma omp simd
#endif
            for (Index r = 0; r < columns; ++r) to[r] += from[r] * factor;
        }
    return whole;
}

}  // namespace fibrant::assembly
