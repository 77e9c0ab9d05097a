// SPDX-License-Identifier: MIT
#pragma once
/// @file What a number of a scene file may be, and how that is said.

#include <fibrant/observe/text_file.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace example {

/// A number as it stands in a message: 100000 and not 1e+05.
inline std::string plain_text(double value) {
    return std::isfinite(value) && std::abs(value) < 1e15 && value == std::floor(value) ? fibrant::observe::rounded(value, 0)
                                                                                        : fibrant::observe::shortest(value);
}

/// An interval, open or closed at either end.
struct Bound {
    double low = 0.0, high = 0.0;
    bool above = false, below = false;  ///< `low` and `high` themselves are not allowed
    bool endless = false;               ///< infinity is allowed as well
    std::string said{};                 ///< in the place of the two ends
    std::vector<double> values{};       ///< that alone are allowed; empty: all between the ends

    bool holds(double value) const noexcept {
        if (!values.empty()) return std::find(values.begin(), values.end(), value) != values.end();
        if (endless && value == std::numeric_limits<double>::infinity()) return true;
        return std::isfinite(value) && (above ? value > low : value >= low) && (below ? value < high : value <= high);
    }
    std::string text() const {
        if (!said.empty()) return said;
        return (above ? "> " : ">= ") + plain_text(low) + " and " + (below ? "< " : "<= ") + plain_text(high) +
               (endless ? ", or inf" : "");
    }
};

/// Lengths, moduli and forces are in any unit, and powers of them must still be numbers.
inline constexpr double largest_quantity = 1e30;

/// low <= value <= high.
inline Bound between(double low, double high) { return {.low = low, .high = high}; }
/// low < value <= high.
inline Bound above(double low, double high) { return {.low = low, .high = high, .above = true}; }
/// low < value < high.
inline Bound inside(double low, double high) { return {.low = low, .high = high, .above = true, .below = true}; }
/// A length, a modulus, a force.
inline Bound positive() {
    return {.low = 1.0 / largest_quantity, .high = largest_quantity, .said = "finite and > 0, in any unit from 1e-30 to 1e+30"};
}
/// The same, or none.
inline Bound not_negative() { return {.low = 0.0, .high = largest_quantity, .said = "finite and >= 0, up to 1e+30"}; }
/// The same of either sign.
inline Bound any_number() { return {.low = -largest_quantity, .high = largest_quantity, .said = "finite, from -1e+30 to 1e+30"}; }
/// What an elastic material may have.
inline Bound poisson_ratio() { return inside(-1.0, 0.5); }
/// How deep fibres may be in each other, over a radius: places of up to 100000 radii are rounded by a hundredth of the least.
inline Bound depth_over_radius() { return between(1e-9, 0.5); }
/// Factor on the tolerances of passes.
inline Bound looseness() { return between(1.0, 1000.0); }
/// Of Coulomb's law.
inline Bound friction() { return between(0.0, 1000.0); }
/// Increments of a stage: each has a row in the table, a report in the checkpoint and a file for ParaView.
inline Bound increments() { return between(1.0, 100000.0); }

}  // namespace example
