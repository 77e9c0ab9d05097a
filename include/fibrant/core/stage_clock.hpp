// SPDX-License-Identifier: MIT
#pragma once
/// @file Wall time by part of the computation.

#include <fibrant/core/config.hpp>

#include <array>
#include <cstddef>
#include <ctime>

namespace fibrant::core {

/// Parts of a run whose time is told apart.
enum class Part : std::size_t { search, contact, assembly, preparation, solution, output };
/// How many they are, and what they are called.
inline constexpr std::size_t part_count = 6;
inline constexpr std::array<const char*, part_count> part_names{"search",      "contact",  "assembly",
                                                                "preparation", "solution", "output"};

/// Wall time since a moment that stays the same while a program runs [second]. From C's library: <chrono> takes more of a
/// compiler's memory than most of what is timed.
inline double wall_seconds() noexcept {
    std::timespec now{};
#if defined(CLOCK_MONOTONIC)
    clock_gettime(CLOCK_MONOTONIC, &now);
#else
    std::timespec_get(&now, TIME_UTC);
#endif
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}
/// Wall time that has gone by [second]. @param start  of wall_seconds
inline double seconds_since(double start) noexcept { return wall_seconds() - start; }

/// Sums the wall time of each part [second].
class StageClock {
public:
    /// Runs `work` on the account of `part` and returns what it returns.
    template <class Work>
    decltype(auto) time(Part part, Work&& work) {
        const Timer timer{&seconds_[static_cast<std::size_t>(part)]};
        return work();
    }
    const std::array<double, part_count>& seconds() const noexcept { return seconds_; }
    std::array<double, part_count>& seconds() noexcept { return seconds_; }

private:
    struct Timer {
        double* sum;
        double start = wall_seconds();
        ~Timer() { *sum += seconds_since(start); }
    };
    std::array<double, part_count> seconds_{};
};

}  // namespace fibrant::core
