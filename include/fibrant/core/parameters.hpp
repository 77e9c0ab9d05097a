// SPDX-License-Identifier: MIT
#pragma once
/// @file Parameters of policies: unset values, checks that name field, value and bound, and the contract of a policy.

#include <fibrant/core/config.hpp>

#include <cmath>
#include <concepts>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

namespace fibrant::core {

/// A quantity without a sensible default starts as this and is refused by name if left so.
inline constexpr double unset = std::numeric_limits<double>::quiet_NaN();

/// Value as text with the digits that identify it.
inline std::string text(double value) {
    std::ostringstream out;
    out.precision(9);
    out << value;
    return out.str();
}

/// Throws std::invalid_argument "field = value, but it must be bound".
[[noreturn]] inline void refuse(std::string_view field, std::string_view value, std::string_view bound) {
    throw std::invalid_argument(std::string(field) + " = " + std::string(value) + ", but it must be " + std::string(bound));
}

/// Throws unless `holds`; the value is printed as a number.
inline void require(bool holds, std::string_view field, double value, std::string_view bound) {
    if (!holds) refuse(field, text(value), bound);
}

/// Throws unless the value is finite and > 0.
inline void require_positive(std::string_view field, double value) {
    require(std::isfinite(value) && value > 0.0, field, value, "finite and > 0");
}

/// Throws unless the value is finite and >= 0.
inline void require_not_negative(std::string_view field, double value) {
    require(std::isfinite(value) && value >= 0.0, field, value, "finite and >= 0");
}

/// Throws unless the value is finite.
inline void require_finite(std::string_view field, double value) { require(std::isfinite(value), field, value, "finite"); }

/// Throws unless low <= value <= high.
inline void require_between(std::string_view field, double value, double low, double high) {
    require(std::isfinite(value) && value >= low && value <= high, field, value, "in [" + text(low) + ", " + text(high) + "]");
}

/// Throws unless value >= low.
inline void require_at_least(std::string_view field, std::ptrdiff_t value, std::ptrdiff_t low) {
    if (value < low) refuse(field, std::to_string(value), ">= " + std::to_string(low));
}

/// Calls `body`; what it refuses is said with the place that `place()` tells: "field = value, but it must be bound (place)".
template <class Place, class Body>
decltype(auto) with_place(const Place& place, const Body& body) {
    try {
        return body();
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(std::string(error.what()) + " (" + place() + ")");
    }
}

/// The parameters themselves, once their own check has passed.
template <class Parameters>
const Parameters& validated(const Parameters& parameters) {
    parameters.validate();
    return parameters;
}

/// Parameters of a policy that has none.
struct NoParameters {
    void validate() const noexcept {}
};

/// Base of null policies: named, empty, and compiled away.
struct Inactive {};

/// A part of a model: a value that is built from its parameters.
template <class P>
concept Policy = std::copyable<P> && requires {
    typename P::Parameters;
} && std::constructible_from<P, const typename P::Parameters&>;

/// A policy that does something; `if constexpr (Active<P>)` leaves out what an inactive one does not need.
template <class P>
concept Active = !std::derived_from<P, Inactive>;

}  // namespace fibrant::core
