// SPDX-License-Identifier: MIT
#pragma once
/// @file What all ranks reckon for themselves is the same on all of them, or the run ends with a message.

#include <fibrant/distributed/exchange.hpp>

#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace fibrant::distributed {

/// A whole number below 2^52 that tells values with other bits apart, but for a chance of 2^-52. It is the hash FNV-1a (G.
/// Fowler, L. C. Noll, K.-P. Vo) of words of 64 bits.
inline double fingerprint(std::span<const double> values) noexcept {
    std::uint64_t hash = 14695981039346656037u;  // its offset basis
    for (const double value : values) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * 1099511628211u;  // its prime
    }
    return static_cast<double>(hash >> 12);
}

/// Throws std::runtime_error on all ranks if one has other bits than the first. Ranks that go on with other bits decide
/// differently sooner or later, and then wait for each other for ever.
template <Exchange E>
void require_alike(const E& exchange, std::span<const double> values) {
    if (exchange.ranks() == 1) return;
    const std::vector<double> all = gather_one(exchange, fingerprint(values));
    for (std::size_t r = 1; r < all.size(); ++r)
        if (all[r] != all[0])
            throw std::runtime_error(
                "rank " + std::to_string(r) +
                " has come to other last digits than rank 0: all ranks need the same program, scene and libraries, "
                "on the same kind of processor");
}

}  // namespace fibrant::distributed
