// SPDX-License-Identifier: MIT
#pragma once
/// @file Times of a search in halves, and what its pairs miss.

#include "../timing.hpp"

#include <fibrant/proximity/exact_filter.hpp>

#include <algorithm>
#include <atomic>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

namespace fibrant::benchmarks {

using Pairs = std::vector<proximity::SegmentPair>;

/// What is allocated while somebody watches; a program's operator new and delete tell it.
struct Allocations {
    inline static std::atomic<bool> watched{false};
    inline static std::atomic<std::int64_t> held{0}, most{0};  ///< since `watch` [byte]

    static void watch() noexcept { held = 0, most = 0, watched = true; }
    /// Ends it. @return the most that was held at once beyond what there was [byte]
    static std::size_t end() noexcept {
        watched = false;
        return static_cast<std::size_t>(most.load());
    }
    /// @param bytes  < 0 for what is given back
    static void tell(std::int64_t bytes) noexcept {
        if (!watched.load(std::memory_order_relaxed)) return;
        const std::int64_t now = held.fetch_add(bytes, std::memory_order_relaxed) + bytes;
        std::int64_t before = most.load(std::memory_order_relaxed);
        while (now > before && !most.compare_exchange_weak(before, now, std::memory_order_relaxed)) {
        }
    }
};

/// One call of a search. `built` is when its structure stood; 0 if it has no such moment.
struct Call {
    Pairs pairs{};
    double built = 0.0;
    std::size_t bytes = 0;  ///< that it holds then, without pairs; 0 if unknown
};
using Method = std::function<Call()>;

struct Figures {
    double build = 0.0, query = 0.0, total = 0.0;  ///< medians [s]; halves 0 where not known
    double least = 0.0, most = 0.0;                ///< of the total [s]
    std::size_t bytes = 0;
    std::size_t peak = 0;  ///< allocated at once in the first call, pairs with it [byte]
    Pairs pairs{};         ///< sorted
};

/// Calls methods in turn, so that all see the same machine. A method that is called once only has `once` set.
struct Turn {
    Method method;
    bool once = false;
};
inline std::vector<Figures> measure_in_turn(int repeats, const std::vector<Turn>& turns) {
    struct Times {
        std::vector<double> build{}, query{}, total{};
    };
    std::vector<Times> times(turns.size());
    std::vector<Figures> all(turns.size());
    for (int k = 0; k < repeats; ++k)
        for (std::size_t m = 0; m < turns.size(); ++m) {
            if (turns[m].once && k > 0) continue;
            const double start = time_now();
            if (k == 0) Allocations::watch();
            Call call = turns[m].method();
            if (k == 0) all[m].peak = Allocations::end();
            const double end = time_now();
            times[m].total.push_back(end - start);
            if (call.built > 0.0) times[m].build.push_back(call.built - start), times[m].query.push_back(end - call.built);
            all[m].bytes = call.bytes;
            all[m].pairs = std::move(call.pairs);
        }
    for (std::size_t m = 0; m < turns.size(); ++m) {
        Figures& figures = all[m];
        std::sort(figures.pairs.begin(), figures.pairs.end());
        const auto [least, most] = std::minmax_element(times[m].total.begin(), times[m].total.end());
        figures.least = *least, figures.most = *most, figures.total = median(times[m].total);
        if (!times[m].build.empty()) figures.build = median(times[m].build), figures.query = median(times[m].query);
    }
    return all;
}

/// Sum modulo 2^64 of the splitmix64 step of (i << 32) | j.
inline std::uint64_t checksum(const Pairs& pairs) {
    std::uint64_t sum = 0;
    for (const proximity::SegmentPair& pair : pairs) {
        std::uint64_t z = ((static_cast<std::uint64_t>(pair.i) << 32) | static_cast<std::uint64_t>(pair.j)) + 0x9E3779B97F4A7C15u;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        sum += z ^ (z >> 31);
    }
    return sum;
}

/// Pairs of `all` that `some` lacks; both sorted.
inline std::size_t lacking(const Pairs& all, const Pairs& some) {
    Pairs missed;
    std::set_difference(all.begin(), all.end(), some.begin(), some.end(), std::back_inserter(missed));
    return missed.size();
}

/// What no method with this filter can beat: the vertices read once, and the filter on the pairs that are wanted [s].
inline double floor_seconds(int repeats, std::span<const proximity::Centreline> fibres, double reach, const Pairs& wanted) {
    const proximity::detail::SegmentTable table(fibres, reach);
    const auto records = table.records();
    std::vector<proximity::detail::Candidate> candidates;
    for (const proximity::SegmentPair& pair : wanted) candidates.push_back({pair.i, pair.j});
    std::vector<double> seconds;
    volatile double keep = 0.0;
    for (int k = 0; k < repeats; ++k) {
        Pairs close;
        close.reserve(wanted.size() + 64);
        const double start = time_now();
        Vec3 sum = Vec3::Zero();
        for (const proximity::Centreline& line : fibres)
            for (const Vec3& x : line.points) sum += x;
        proximity::detail::keep_close(table, records.data(), candidates, close);
        seconds.push_back(time_now() - start);
        keep = keep + sum.sum();
    }
    return median(seconds);
}

}  // namespace fibrant::benchmarks
