// SPDX-License-Identifier: MIT
#pragma once
/// @file Time and memory of the process.

#include <sys/resource.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

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

/// How many threads, of so many, can be had at once beside this one: each takes some megabytes of memory that is allowed.
inline int threads_at_once(int wanted) {
    std::vector<std::thread> taken;
    taken.reserve(static_cast<std::size_t>(std::max(0, wanted)));
    std::mutex all;
    {
        const std::lock_guard until_all_are_there(all);
        try {
            for (int k = 0; k < wanted; ++k) taken.emplace_back([&all] { const std::lock_guard wait(all); });
        } catch (const std::system_error&) {  // that was the last one
        }
    }
    for (std::thread& thread : taken) thread.join();
    return static_cast<int>(taken.size());
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
