// SPDX-License-Identifier: MIT
#pragma once
/// @file Sorting that is compiled once for all types: for what is sorted now and then, and not in an inner loop.

#include <fibrant/core/large_array.hpp>
#include <fibrant/core/types.hpp>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace fibrant::core {

/// Numbers in [0, n) in an order, equal ones by their number.
/// @param before  (context, a, b) -> whether a comes before b
inline std::vector<Index> stable_order(Index n, bool (*before)(const void*, Index, Index), const void* context) {
    std::vector<Index> order(at(n)), merged(at(n));
    std::iota(order.begin(), order.end(), Index{0});
    for (Index width = 1; width < n; width *= 2, order.swap(merged)) {
        for (Index first = 0; first < n; first += 2 * width) {
            const Index middle = std::min(first + width, n), last = std::min(first + 2 * width, n);
            Index a = first, b = middle;
            for (Index k = first; k < last; ++k) {
                const bool second = a == middle || (b < last && before(context, order[at(b)], order[at(a)]));
                merged[at(k)] = order[at(second ? b++ : a++)];
            }
        }
    }
    return order;
}

/// As std::stable_sort.
template <class Value, class Before>
void stable_sort(std::vector<Value>& values, const Before& before) {
    struct Seen {
        const std::vector<Value>& values;
        const Before& before;
    } seen{values, before};
    const auto erased = [](const void* context, Index a, Index b) -> bool {
        const Seen& in = *static_cast<const Seen*>(context);
        return in.before(in.values[at(a)], in.values[at(b)]);
    };
    std::vector<Value> sorted;
    sorted.reserve(values.size());
    for (const Index k : stable_order(count(values), erased, &seen)) sorted.push_back(std::move(values[at(k)]));
    values = std::move(sorted);
}

/// Puts values behind others.
template <class Value>
void append(std::vector<Value>& values, const std::vector<Value>& more) {
    reserve_for(values, values.size() + more.size());
    for (const Value& value : more) values.push_back(value);
}

}  // namespace fibrant::core
