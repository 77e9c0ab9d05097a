// SPDX-License-Identifier: MIT
#pragma once
/// @file Wall time by part of the computation.

#include <fibrant/core/config.hpp>

#include <array>
#include <chrono>
#include <cstddef>

namespace fibrant::core {

/// Parts of a run whose time is told apart.
enum class Part : std::size_t { search, contact, assembly, preparation, solution, output };
inline constexpr std::size_t part_count = 6;
inline constexpr std::array<const char*, part_count> part_names{"search",      "contact",  "assembly",
                                                                "preparation", "solution", "output"};

/// Wall time that has gone by [second].
inline double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

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
        std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
        ~Timer() { *sum += seconds_since(start); }
    };
    std::array<double, part_count> seconds_{};
};

}  // namespace fibrant::core
