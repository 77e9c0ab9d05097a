// SPDX-License-Identifier: MIT
#pragma once
/// @file Which contact elements a fibre takes part in, and on which side of them.

#include <fibrant/core/types.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace fibrant::contact {

/// Sides of contact elements by fibre: 2 k for fibre i and 2 k + 1 for fibre j of element k, in order. So that forces are
/// gathered fibre by fibre: in parallel, and in the same order for any number of threads.
class SideIndex {
public:
    /// @param elements  have fibre_i and fibre_j, each in [0, fibres)
    template <class Elements>
    void build(Index fibres, const Elements& elements) {
        clear(fibres);
        for (const auto& element : elements) {
            ++first_[core::at(element.fibre_i) + 1];
            ++first_[core::at(element.fibre_j) + 1];
        }
        for (std::size_t f = 1; f < first_.size(); ++f) first_[f] += first_[f - 1];
        sides_.resize(2 * elements.size());
        std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
        for (std::int32_t k = 0; k < static_cast<std::int32_t>(elements.size()); ++k) {
            sides_[core::at(next[core::at(elements[core::at(k)].fibre_i)]++)] = 2 * k;
            sides_[core::at(next[core::at(elements[core::at(k)].fibre_j)]++)] = 2 * k + 1;
        }
    }
    void clear(Index fibres) {
        sides_.clear();
        first_.assign(core::at(fibres + 1), 0);
    }
    std::span<const std::int32_t> of(Index fibre) const noexcept {
        const std::size_t first = core::at(first_[core::at(fibre)]), last = core::at(first_[core::at(fibre) + 1]);
        return std::span<const std::int32_t>(sides_).subspan(first, last - first);
    }

private:
    std::vector<std::int32_t> sides_, first_;
};

}  // namespace fibrant::contact
