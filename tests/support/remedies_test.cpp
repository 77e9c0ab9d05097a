// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "../../examples/support/remedies.hpp"

#include <string>

namespace remedies_test {

TEST_CASE("a reason is given the remedy of its cause, and none where nothing is known") {
    const std::string newton = "stage handover, increment 31: Newton did not converge after 15 iterations, residual 0.5";
    CHECK(example::remedy(newton).starts_with("more increments, more damping"));
    // Of a fibre that buckles the message says both; what makes it buckle is what helps.
    CHECK(example::remedy(newton + "; the tangent was not positive definite in 7 of 15 iterations")
              .starts_with("hold what is free"));
    CHECK(example::remedy("cannot write the file a.csv").empty());
    CHECK(example::remedy("").empty());
}

}  // namespace remedies_test
