// SPDX-License-Identifier: MIT
#pragma once
/// @file A number of threads for part of a test.

#include <utility>

#if defined(_OPENMP)
#include <omp.h>
#endif

namespace fibrant::test {

/// Runs `work` with loops on `threads` threads (on one, where there is no OpenMP) and returns what it returns.
template <class Work>
decltype(auto) with_threads([[maybe_unused]] int threads, Work&& work) {
#if defined(_OPENMP)
    struct Restore {
        int before = omp_get_max_threads();
        ~Restore() { omp_set_num_threads(before); }
    } restore;
    omp_set_num_threads(threads);
#endif
    return std::forward<Work>(work)();
}

}  // namespace fibrant::test
