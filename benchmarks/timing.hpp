// SPDX-License-Identifier: MIT
#pragma once
/// @file Time and memory as all benchmarks take them.

#include <fibrant/core/parallel.hpp>

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <vector>

namespace fibrant::benchmarks {

/// Processor time of all threads, which others on the machine disturb least [s].
inline double processor_time() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}
/// The same for one thread, else time on the wall [s].
inline double time_now() {
    if (core::threads() == 1) return processor_time();
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Makes the folder that a benchmark writes to, with those above it.
/// @throws std::filesystem::filesystem_error if it cannot be made
inline std::filesystem::path folder(const std::filesystem::path& path) {
    std::filesystem::create_directories(path);
    return path;
}

/// Of at least one value.
inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// Of so many calls [s].
template <class Body>
double median_seconds(int repeats, const Body& body) {
    std::vector<double> times;
    for (int k = 0; k < repeats; ++k) {
        const double start = time_now();
        body();
        times.push_back(time_now() - start);
    }
    return median(times);
}

/// Greatest resident memory of the process so far [bytes].
inline double peak_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

}  // namespace fibrant::benchmarks
