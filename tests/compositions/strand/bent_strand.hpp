// SPDX-License-Identifier: MIT
#pragma once
/// @file Strands that are bent in tests: the work of their moments.

#include <compositions/bundle_model.hpp>
#include <fibrant/compositions/strand/bending.hpp>

#include <vector>

namespace fibrant::test {

/// What the moments after all increments have done, by the trapezium rule.
inline double work_of(const std::vector<compositions::strand::BendingState>& states) {
    double sum = 0.0;
    for (std::size_t k = 0; k < states.size(); ++k) {
        const double before = k > 0 ? states[k - 1].moment : 0.0, from = k > 0 ? states[k - 1].angle : 0.0;
        sum += 0.5 * (before + states[k].moment) * (states[k].angle - from);
    }
    return sum;
}

}  // namespace fibrant::test
