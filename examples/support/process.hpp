// SPDX-License-Identifier: MIT
#pragma once
/// @file Time and memory of the process.

#include <sys/resource.h>

#include <cstdint>

#if __has_include(<malloc.h>)
#include <malloc.h>
#endif

namespace example {

/// Processor time of this process, all threads [second].
inline double cpu_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Greatest resident memory so far [byte]; Linux counts it in kilobytes.
inline std::int64_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
}

/// Keeps freed memory in the process, where the C library is GNU's: every search and every increment takes again what the last
/// one freed, and each page that was given back costs a fault.
inline void keep_freed_memory() {
#if defined(M_TRIM_THRESHOLD) && defined(M_MMAP_MAX)
    mallopt(M_TRIM_THRESHOLD, 2'000'000'000);
    mallopt(M_MMAP_MAX, 0);
#endif
}

}  // namespace example
