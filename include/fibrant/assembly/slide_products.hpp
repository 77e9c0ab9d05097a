// SPDX-License-Identifier: MIT
#pragma once
/// @file Products with the stiffness of crossings whose places slide, in plain loops: few scenes have any.

#include <fibrant/contact/sliding_place.hpp>
#include <fibrant/core/small_matrix.hpp>
#include <fibrant/scene/dof_layout.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace fibrant::assembly {

/// y += rows^T stiffness rows x
inline void add_slide(const contact::SlidingStiffness& slide, const Vector& x, Vector& y) {
    Vector motion(slide.rows.cols());
    for (std::size_t k = 0; k < slide.vectors.size(); ++k)
        for (Index c = 0; c < 3; ++c) motion[3 * static_cast<Index>(k) + c] = x[3 * slide.vectors[k] + c];
    const Vector force = core::transposed_times(slide.rows, core::times(slide.stiffness, core::times(slide.rows, motion)));
    for (std::size_t k = 0; k < slide.vectors.size(); ++k)
        for (Index c = 0; c < 3; ++c) y[3 * slide.vectors[k] + c] += force[3 * static_cast<Index>(k) + c];
}

/// Which chains have vectors of which slides: their own parts of these belong into their bands. A coarse space that has what two
/// chains are coupled by, and not what either of them resists with, is no longer positive definite.
class SlidesOfChains {
public:
    /// @param number_of  of a vector: the one that counts, which of an image is its source
    template <class NumberOf>
    void index(const std::vector<contact::SlidingStiffness>& slides, const scene::DofLayout& layout, const NumberOf& number_of) {
        parts_.clear();
        for (std::size_t k = 0; k < slides.size(); ++k)
            for (const Index vector : slides[k].vectors) {
                const auto after = std::upper_bound(layout.chains.begin(), layout.chains.end(), number_of(vector),
                                                    [](Index v, const scene::Chain& chain) { return v < chain.first_vector; });
                parts_.emplace_back(after - layout.chains.begin() - 1, static_cast<std::int32_t>(k));
            }
        std::sort(parts_.begin(), parts_.end());
        parts_.erase(std::unique(parts_.begin(), parts_.end()), parts_.end());
    }

    /// Adds to a lower block band, as LinearSystem::chain_band has it, what lies within it.
    template <class NumberOf>
    void add(const std::vector<contact::SlidingStiffness>& slides, const scene::DofLayout& layout, Index chain,
             const NumberOf& number_of, Matrix& band) const {
        const scene::Chain& own = layout.chains[core::at(chain)];
        const Index last = own.first_vector + own.nodes * own.vectors_per_node, block = 3 * own.vectors_per_node;
        const auto begin = std::lower_bound(parts_.begin(), parts_.end(), std::pair<Index, std::int32_t>(chain, 0));
        for (auto part = begin; part != parts_.end() && part->first == chain; ++part) {
            const contact::SlidingStiffness& slide = slides[core::at(part->second)];
            const Index rows = slide.rows.rows();
            for (std::size_t j = 0; j < slide.vectors.size(); ++j) {
                const Index w = number_of(slide.vectors[j]) - own.first_vector;
                if (w < 0 || w + own.first_vector >= last) continue;
                Eigen::Matrix<double, Eigen::Dynamic, 3> half = Eigen::Matrix<double, Eigen::Dynamic, 3>::Zero(rows, 3);
                for (Index c = 0; c < 3; ++c)
                    for (Index k = 0; k < rows; ++k)
                        for (Index r = 0; r < rows; ++r)
                            half(r, c) += slide.stiffness(r, k) * slide.rows(k, 3 * static_cast<Index>(j) + c);
                for (std::size_t i = 0; i < slide.vectors.size(); ++i) {
                    const Index v = number_of(slide.vectors[i]) - own.first_vector;
                    if (v < 0 || v + own.first_vector >= last) continue;
                    const Index apart = v / own.vectors_per_node - w / own.vectors_per_node;
                    if (apart < 0 || apart > own.reach) continue;
                    const Index row = 3 * v, column = apart * block + 3 * (w % own.vectors_per_node);
                    for (Index c = 0; c < 3; ++c)
                        for (Index r = 0; r < 3; ++r)
                            for (Index k = 0; k < rows; ++k)
                                band(row + r, column + c) += slide.rows(k, 3 * static_cast<Index>(i) + r) * half(k, c);
                }
            }
        }
    }

private:
    std::vector<std::pair<Index, std::int32_t>> parts_;  // chain and slide, sorted
};

/// rows^T stiffness rows
inline Matrix whole_slide(const contact::SlidingStiffness& slide) {
    const Index rows = slide.rows.rows(), columns = slide.rows.cols();
    Matrix half = Matrix::Zero(columns, rows), whole = Matrix::Zero(columns, columns);
    for (Index c = 0; c < rows; ++c)
        for (Index r = 0; r < columns; ++r)
            for (Index k = 0; k < rows; ++k) half(r, c) += slide.rows(k, r) * slide.stiffness(k, c);
    for (Index c = 0; c < columns; ++c)
        for (Index k = 0; k < rows; ++k)
            for (Index r = 0; r < columns; ++r) whole(r, c) += half(r, k) * slide.rows(k, c);
    return whole;
}

}  // namespace fibrant::assembly
