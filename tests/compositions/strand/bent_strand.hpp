// SPDX-License-Identifier: MIT
#pragma once
/// @file Strands that are bent in tests: their model, and the work of their moments.

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/strand/bending.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>

#include <vector>

namespace fibrant::test {

/// Friction, solved directly.
struct RoughStrand {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::DoubleBlockCholesky;
};

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
