// SPDX-License-Identifier: MIT
#include <fibrant/observe/flat_gap.hpp>

#include <doctest/doctest.h>

#include <near.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

using namespace fibrant;

namespace flat_gap_test {

constexpr double pi = std::numbers::pi;

// Half axes that need not be square to each other, of an ellipse with the given half axes.
observe::FlatSection ellipse(double a, double b, double tilt, double from) {
    const auto at = [&](double angle) {
        const double x = a * std::cos(angle), y = b * std::sin(angle);
        return core::Two{std::cos(tilt) * x - std::sin(tilt) * y, std::sin(tilt) * x + std::cos(tilt) * y};
    };
    return {at(from), at(from + 0.5 * pi)};
}

TEST_CASE("the gap of two ellipses is the greatest of all directions, however flat they are and however deep in each other") {
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    constexpr int around = 2000;
    for (int trial = 0; trial < 600; ++trial) {
        const double flattening = trial % 3 == 0 ? 1e-3 : trial % 3 == 1 ? 0.1 : 0.9;
        std::array<observe::FlatSection, 2> sections;
        for (auto& section : sections) {
            const double b = 1.0 - flattening * uniform(generator), tilt = pi * uniform(generator);
            section = ellipse(1.0, b, tilt, 2.0 * pi * uniform(generator));
        }
        const double distance = 3.0 * uniform(generator), angle = 2.0 * pi * uniform(generator);
        const core::Two apart{distance * std::cos(angle), distance * std::sin(angle)};
        const auto along = [&](const core::Two& n) {
            return core::dot(apart, n) - sections[0].extent(n) - sections[1].extent(n);
        };
        double most = -std::numeric_limits<double>::infinity();
        for (int k = 0; k < around; ++k)
            most = std::max(most, along({std::cos(2.0 * pi * k / around), std::sin(2.0 * pi * k / around)}));
        const observe::FlatGap found = observe::greatest_gap(sections, apart);
        CAPTURE(trial);
        CHECK(found.gap >= most - 1e-12);
        CHECK(found.gap < most + 0.5 * (pi / around) * (pi / around) * (distance + 2.0 / (1.0 - flattening)));
        CHECK(core::norm(found.normal) == test::near(1.0));
        CHECK(std::abs(along(found.normal) - found.gap) < 1e-12);
    }
}

}  // namespace flat_gap_test
