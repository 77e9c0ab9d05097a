// SPDX-License-Identifier: MIT
#pragma once
/// @file Loops over independent items, and sums whose bits do not depend on the number of threads.

#include <fibrant/core/large_array.hpp>
#include <fibrant/core/types.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <type_traits>
#include <vector>

#if defined(_OPENMP)
#include <omp.h>
#endif

namespace fibrant::core {

/// Threads that parallel loops use: OpenMP's setting, 1 without OpenMP.
inline int threads() noexcept {
#if defined(_OPENMP)
    return omp_get_max_threads();
#else
    return 1;
#endif
}

/// Light items, a contact element each, below which threads cost more than they save.
inline constexpr Index light_items = 256;

/// How threads share the items of a loop.
enum class Share : std::uint8_t {
    runs,   ///< each takes a run of them, the same one in every loop, whose data it then has in its cache
    turns,  ///< one by one, as they come to be free: for large items of uneven work
};

#if defined(_OPENMP)
namespace detail {
/// What OpenMP takes for a loop, compiled once and not once a loop: what a loop does is called by its address.
/// @param run  does the items [first, last) of the loop
inline void share_out(Index n, Index grain, Share share, const void* body, void (*run)(const void*, Index, Index)) {
    if (n <= grain || threads() <= 1 || omp_in_parallel() != 0) return run(body, 0, n);
    std::exception_ptr failure;
    const auto guarded = [&](Index first, Index last) {
        try {
            run(body, first, last);
        } catch (...) {
#pragma omp critical(fibrant_parallel_for)
            if (!failure) failure = std::current_exception();
        }
    };
    if (share == Share::runs) {
#pragma omp parallel
        {
            const Index thread = omp_get_thread_num(), all = omp_get_num_threads();
            guarded(n / all * thread + std::min(n % all, thread), n / all * (thread + 1) + std::min(n % all, thread + 1));
        }
    } else {
#pragma omp parallel for schedule(dynamic)
        for (Index k = 0; k < n; ++k) guarded(k, k + 1);
    }
    if (failure) std::rethrow_exception(failure);
}
}  // namespace detail
#endif

/// Calls body(k) for k in [0, n), in any order and on any thread. Items must not share what they write.
/// The first exception that a body throws is thrown again here; other items may be left out then.
/// @param grain  items up to which one thread takes them all
template <Share share = Share::runs, class Body>
void parallel_for(Index n, const Body& body, [[maybe_unused]] Index grain = 1) {
#if defined(_OPENMP)
    detail::share_out(n, grain, share, &body, [](const void* whole, Index first, Index last) {
        // A copy of addresses, which no item can change.
        const std::conditional_t<std::is_trivially_copyable_v<Body>, Body, const Body&> items = *static_cast<const Body*>(whole);
        for (Index k = first; k < last; ++k) items(k);
    });
#else
    for (Index k = 0; k < n; ++k) body(k);
#endif
}

/// whole = all parts, one behind the other.
template <class Value>
void join(const std::vector<std::vector<Value>>& parts, std::vector<Value>& whole) {
    std::vector<std::size_t> first{0};
    for (const auto& part : parts) first.push_back(first.back() + part.size());
    resize_anew(whole, first.back());
    parallel_for(
        count(parts),
        [&](Index p) {
            std::copy(parts[at(p)].begin(), parts[at(p)].end(), whole.begin() + static_cast<std::ptrdiff_t>(first[at(p)]));
        },
        light_items / 8);
}

/// Sum over [0, n) of body(first, last), taken on blocks of fixed length and added in their order.
///
/// The blocks depend on n alone, so the bits do not depend on the number of threads.
template <class Value, class Body>
Value ordered_sum(Index n, Value zero, const Body& body, Index block = 2048) {
    const Index blocks = (n + block - 1) / block;
    if (blocks <= 1) return n > 0 ? Value(zero += body(Index{0}, n)) : zero;
    std::vector<Value> part(at(blocks), zero);
    parallel_for(blocks, [&](Index b) { part[at(b)] = body(b * block, std::min(n, (b + 1) * block)); });
    Value total = zero;
    for (const Value& value : part) total += value;
    return total;
}

/// Largest of body(k) for k in [0, n), not below `least`.
template <class Body>
double largest(Index n, double least, const Body& body, Index block = 2048) {
    struct Most {
        double value;
        Most& operator+=(const Most& other) noexcept { return value = std::max(value, other.value), *this; }
    };
    return ordered_sum(
               n, Most{least},
               [&](Index first, Index last) {
                   Most most{least};
                   for (Index k = first; k < last; ++k) most.value = std::max(most.value, body(k));
                   return most;
               },
               block)
        .value;
}

/// Dot product with bits that do not depend on the number of threads.
inline double dot(const Vector& a, const Vector& b) {
    return ordered_sum(
        a.size(), 0.0,
        [&](Index first, Index last) { return a.segment(first, last - first).dot(b.segment(first, last - first)); }, 8192);
}

}  // namespace fibrant::core
