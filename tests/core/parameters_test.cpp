// SPDX-License-Identifier: MIT
#include "refusal.hpp"

#include <fibrant/core/parameters.hpp>

#include <doctest/doctest.h>

using namespace fibrant;

namespace parameters_test {

using test::refusal;

struct Depth {
    double value = core::unset;
    void validate() const { core::require_positive("Depth.value", value); }
};

struct Spring {
    using Parameters = Depth;
    explicit Spring(const Parameters& parameters) : depth{core::validated(parameters)} {}
    Depth depth;
};
struct NoSpring : core::Inactive {
    using Parameters = core::NoParameters;
    explicit NoSpring(const Parameters& = {}) {}
};
struct NeedsMore {
    using Parameters = Depth;
    NeedsMore(const Parameters&, int) {}
};

TEST_CASE("a refusal names field, value and bound") {
    CHECK(refusal([] { core::require_positive("Law.depth", -0.001); }) == "Law.depth = -0.001, but it must be finite and > 0");
    CHECK(refusal([] { core::require_not_negative("Law.mu", -1.0); }) == "Law.mu = -1, but it must be finite and >= 0");
    CHECK(refusal([] { core::require_finite("Law.x", 1.0 / 0.0); }) == "Law.x = inf, but it must be finite");
    CHECK(refusal([] { core::require_between("Law.angle", 91.0, 0.0, 90.0); }) == "Law.angle = 91, but it must be in [0, 90]");
    CHECK(refusal([] { core::require_at_least("Law.count", -3, 1); }) == "Law.count = -3, but it must be >= 1");
    CHECK(refusal([] { core::refuse("Law.name", "steel", "a name"); }) == "Law.name = steel, but it must be a name");
}

TEST_CASE("bounds belong to the range where the text says so, and to neither side of a strict one") {
    CHECK(refusal([] { core::require_between("x", 0.0, 0.0, 90.0); }).empty());
    CHECK(refusal([] { core::require_between("x", 90.0, 0.0, 90.0); }).empty());
    CHECK(refusal([] { core::require_not_negative("x", 0.0); }).empty());
    CHECK(refusal([] { core::require_at_least("x", 1, 1); }).empty());
    CHECK(!refusal([] { core::require_positive("x", 0.0); }).empty());
    CHECK(refusal([] { core::require_positive("x", std::numeric_limits<double>::denorm_min()); }).empty());
}

TEST_CASE("what is not a number passes no check") {
    for (const double value : {core::unset, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
        CAPTURE(value);
        CHECK(!refusal([&] { core::require_positive("x", value); }).empty());
        CHECK(!refusal([&] { core::require_not_negative("x", value); }).empty());
        CHECK(!refusal([&] { core::require_finite("x", value); }).empty());
        CHECK(!refusal([&] { core::require_between("x", value, -1.0, 1.0); }).empty());
    }
}

TEST_CASE("a quantity left unset is refused by its name") {
    CHECK(refusal([] { Spring spring{Depth{}}; }) == "Depth.value = nan, but it must be finite and > 0");
    CHECK(Spring{Depth{2.0}}.depth.value == 2.0);
}

TEST_CASE("a value is printed with the digits that identify it") {
    CHECK(core::text(0.0201) == "0.0201");
    CHECK(core::text(1e-9) == "1e-09");
    CHECK(core::text(1.23456789) == "1.23456789");
}

TEST_CASE("a policy is a value built from its parameters, and is active unless it says otherwise") {
    static_assert(core::Policy<Spring> && core::Active<Spring>);
    static_assert(core::Policy<NoSpring> && !core::Active<NoSpring>);
    static_assert(!core::Policy<NeedsMore>);
    static_assert(!core::Policy<Depth>);
    static_assert(sizeof(NoSpring) == 1);
}

}  // namespace parameters_test
