// SPDX-License-Identifier: MIT
// The reaction of one contact, summed over many in parallel, through Eigen and a law.
#include <fibrant/core/parallel.hpp>
#include <fibrant/law/regularised_penalty.hpp>

#include <nanoflann.hpp>

#include <cmath>
#include <cstdio>

int main() {
    const fibrant::law::RegularisedPenalty law{{.regularisation_depth = 0.5}};
    // 4096 contacts at penetration 1: 2 * (1 - 0.25) = 1.5 each.
    const fibrant::Vector gap = fibrant::Vector::Constant(4096, -1.0);
    const double sum = fibrant::core::ordered_sum(gap.size(), 0.0, [&](fibrant::Index first, fibrant::Index last) {
        double part = 0.0;
        for (fibrant::Index k = first; k < last; ++k) part += law.response(gap[k], 2.0).reaction;
        return part;
    });
    std::printf("fibrant %s, %d threads: %g\n", FIBRANT_VERSION, fibrant::core::threads(), sum);
    return std::abs(sum - 6144.0) < 1e-9 ? 0 : 1;
}
