// SPDX-License-Identifier: MIT
#pragma once
/// @file Memory of programs that free and take the same arrays again and again.

#if __has_include(<malloc.h>)
#include <malloc.h>
#endif

namespace example {

/// Keeps freed memory in the process, where the C library is GNU's: every search and every increment takes again what the last one
/// freed, and each page that was given back costs a fault.
inline void keep_freed_memory() {
#if defined(M_TRIM_THRESHOLD) && defined(M_MMAP_MAX)
    mallopt(M_TRIM_THRESHOLD, 2'000'000'000);
    mallopt(M_MMAP_MAX, 0);
#endif
}

}  // namespace example
