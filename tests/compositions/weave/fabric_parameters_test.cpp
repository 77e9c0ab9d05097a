// SPDX-License-Identifier: MIT
#include "compositions/weave/woven_snapshot.hpp"
#include "refusal.hpp"

#include <fibrant/compositions/weave/fabric_limits.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

using namespace fibrant;

namespace fabric_parameters_test {

using namespace fibrant::compositions::weave;

/// What a fabric that was changed in one field says.
template <class Change>
std::string refused(const Change& change) {
    FabricParameters fabric = small_fabric(4, 19);
    change(fabric);
    return test::refusal([&] { fabric.validate(); });
}

TEST_CASE("the fabric of the chapter's tables is accepted, with its sizes") {
    FabricParameters fabric = small_fabric(4, 76);
    fabric.warp = {76, 0.0201, 0.20, {7300.0, 0.3}};
    fabric.weft = fabric.warp;
    CHECK_NOTHROW(fabric.validate());
    CHECK(fabric.fibres() == 608);
    CHECK(fabric.fibres() * fabric.nodes_per_fibre() == 39520);  // table 15.1
    CHECK(fabric.fibre_length(Family::warp) == test::near(4.4, 1e-12));
    // Table 15.2 gives the tow's area with three digits, and r with three.
    CHECK(static_cast<double>(fabric.warp.fibres) * fabric.warp.section().area() == test::near(0.0967, 5e-3));
}

TEST_CASE("macro-fibres of the two scenes stand for the same real fibres") {
    const scene::CrossSection coarse = scene::macro_fibre(380, 0.018, 19), fine = scene::macro_fibre(380, 0.018, 76);
    CHECK(19.0 * coarse.area() == test::near(76.0 * fine.area(), 1e-12));
    CHECK(19.0 * coarse.second_moment_1() == test::near(76.0 * fine.second_moment_1(), 1e-12));
    CHECK(fine.radius() == test::near(0.0201, 2e-3));       // table 15.2, three digits
    CHECK(fine.inertia_factor == test::near(0.20, 1e-12));  // table 15.3
}

TEST_CASE("a fibre's number and its place in the fabric say the same") {
    FabricParameters fabric = small_fabric(3, 5);
    fabric.weft_tows = 2;
    fabric.weft.fibres = 7;
    CHECK(fabric.fibres() == 29);
    for (Index number = 0; number < fabric.fibres(); ++number) {
        const FibrePlace place = fabric.place(number);
        CHECK(fabric.fibre(place.family, place.tow, place.fibre) == number);
    }
    CHECK(fabric.place(15).family == Family::weft);
    CHECK(fabric.tow_position(Family::warp, 0) == test::near(-0.88, 1e-12));
    CHECK(fabric.tow_position(Family::weft, 1) == test::near(0.44, 1e-12));
}

TEST_CASE("every field that cannot be is refused by field, value and bound") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    using F = FabricParameters;
    CHECK(refused([](F& f) { f.warp_tows = 0; }) == "FabricParameters.warp_tows = 0, but it must be >= 1");
    CHECK(refused([](F& f) { f.weft_tows = -1; }) == "FabricParameters.weft_tows = -1, but it must be >= 1");
    CHECK(refused([](F& f) { f.warp.fibres = 0; }) == "FabricParameters.warp.fibres = 0, but it must be >= 1");
    CHECK(refused([](F& f) { f.weft.fibre_radius = -0.04; }) ==
          "FabricParameters.weft.fibre_radius = -0.04, but it must be finite and > 0");
    CHECK(refused([&](F& f) { f.warp.fibre_radius = nan; }) ==
          "FabricParameters.warp.fibre_radius = nan, but it must be finite and > 0");
    CHECK(refused([](F& f) { f.warp.inertia_factor = 0.0; }) ==
          "FabricParameters.warp.inertia_factor = 0, but it must be finite and > 0");
    CHECK(refused([&](F& f) { f.weft.material.young_modulus = nan; }) ==
          "FabricParameters.weft.material.young_modulus = nan, but it must be finite and > 0");
    CHECK(refused([](F& f) { f.warp.material.poisson_ratio = 0.5; }) ==
          "FabricParameters.warp.material.poisson_ratio = 0.5, but it must be > -1 and < 0.5");
    CHECK(refused([](F& f) { f.warp.aspect = 0.5; }) == "FabricParameters.warp.aspect = 0.5, but it must be in [1, 20]");
    CHECK(refused([](F& f) { f.warp.packing_gap = -1e-3; }) ==
          "FabricParameters.warp.packing_gap = -0.001, but it must be in [0, 1]");
    CHECK(refused([&](F& f) { f.warp_spacing = nan; }) == "FabricParameters.warp_spacing = nan, but it must be finite and > 0");
    CHECK(refused([](F& f) { f.weft_spacing = 0.0; }) == "FabricParameters.weft_spacing = 0, but it must be finite and > 0");
    CHECK(refused([&](F& f) { f.overhang = nan; }) == "FabricParameters.overhang = nan, but it must be finite and > 0");
    CHECK(refused([](F& f) { f.elements = 0; }) == "FabricParameters.elements = 0, but it must be >= 1");
}

TEST_CASE("tows that overlap their neighbours, ends that miss a tow and elements shorter than a diameter are refused") {
    using F = FabricParameters;
    // 19 fibres at aspect 2.5 lie in rows of 6, 7, 6: 7 diameters and 6 gaps wide.
    const double width = 0.08 * (7.0 + 6.0 * 1e-3);
    CHECK(refused([&](F& f) { f.warp_spacing = width + 1e-6; }).empty());
    CHECK(refused([](F& f) { f.warp_spacing = 0.56; }).find("FabricParameters.warp_spacing = 0.56, but it must be >= width") ==
          0);
    CHECK(refused([](F& f) { f.overhang = 0.28; }).find("FabricParameters.overhang = 0.28, but it must be > half the width") ==
          0);
    CHECK(refused([](F& f) { f.elements = 55; }).empty());  // 4.4 / 55 = 0.08, a diameter
    CHECK(refused([](F& f) { f.elements = 56; }).find("FabricParameters.elements = 56, but it must be <= 55") == 0);
    CHECK(refused([](F& f) { f.warp_tows = 1; }).find("Pattern = plain on 1 warp and 4 weft tows") == 0);
}

TEST_CASE("a weft fibre may have elements of its own, and is refused by its own bound") {
    FabricParameters fabric = small_fabric(4, 19);
    fabric.weft_elements = 16;
    CHECK(fabric.elements_of(Family::warp) == fabric.elements);
    CHECK(fabric.elements_of(Family::weft) == 16);
    CHECK(fabric.nodes() == fabric.fibres() / 2 * (2 * fabric.elements + 1 + 2 * 16 + 1));
    CHECK(refused([](FabricParameters& f) {
              f.weft_elements = 56;
          }).find("FabricParameters.weft_elements = 56, but it must be <= 55") == 0);
}

TEST_CASE("single fibres jam where round ones touch their neighbours over every crossing: equal ones at 1.732 diameters") {
    FabricParameters fabric = small_fabric(4, 19);
    fabric.pattern = Pattern::named("plain");
    fabric.warp.fibres = fabric.weft.fibres = 1;
    fabric.warp.fibre_radius = fabric.weft.fibre_radius = 0.05;
    fabric.warp_spacing = fabric.weft_spacing = 0.1 * std::sqrt(3.0);
    CHECK(std::abs(jamming(fabric) - 1.0) < 1e-12);  // rounding
    REQUIRE(doubts(fabric).size() == 1);             // and those that nearly jam
    CHECK(doubts(fabric).front().find("from 0.181") != std::string::npos);
    fabric.warp_spacing = fabric.weft_spacing = 0.18;
    CHECK(jamming(fabric) < 1.0);
    CHECK(doubts(fabric).empty());
    // Straight wefts, so close that they nearly touch, take as much room from the warps as these have: a spacing of the sum of
    // both diameters.
    fabric.warp_spacing = 0.2, fabric.weft_spacing = 1e-9;
    CHECK(std::abs(jamming(fabric) - 1.0) < 1e-12);
    fabric.warp_spacing = 0.19, fabric.weft_spacing = 0.11;
    CHECK(jamming(fabric) > 1.0);
    REQUIRE(doubts(fabric).size() == 1);
    CHECK(doubts(fabric).front().find("a spacing of 0.1732") != std::string::npos);
    fabric.pattern = Pattern::named("twill22");
    CHECK(jamming(fabric) == 0.0);
}

TEST_CASE("an overhang that ends may slip out of is told") {
    FabricParameters fabric = small_fabric(4, 19);
    CHECK(doubts(fabric).empty());
    fabric.overhang = 0.51 * fabric.warp.packing().width;  // crossed at the ends, before they draw in
    CHECK(doubts(fabric).size() == 2);
}

TEST_CASE(
    "fibres that turn over less than a fifth of an element under the tension at the end are told, and over a twelfth refused") {
    FabricParameters fabric = small_fabric(4, 19);
    SettleParameters settle;
    CHECK(doubts(fabric, settle).empty());
    // A round fibre turns over sqrt(E I / T) = r / 2 sqrt(factor / strain).
    const double elements = static_cast<double>(fabric.elements), r = fabric.warp.fibre_radius;
    const double element = fabric.fibre_length(Family::warp) / elements;
    const double strain = settle.tension_strain * settle.final_tension_factor;
    const auto turning = [&](double part) {
        FabricParameters other = fabric;
        other.warp.inertia_factor = strain * std::pow(2.0 * part * element / r, 2);
        return other;
    };
    CHECK(doubts(turning(0.205), settle).empty());
    REQUIRE(doubts(turning(0.2), settle).size() == 1);
    const std::string told = doubts(turning(0.2), settle).front(),
                      factor = core::text(strain * std::pow(2.0 * element / r, 2) / 24.0);
    CAPTURE(told);
    CHECK(told.find("warp.inertia_factor >= " + factor.substr(0, 4)) != std::string::npos);
    // As many elements as it takes, or none are named where they would be shorter than a diameter.
    CHECK(told.find(std::to_string(static_cast<Index>(std::ceil(0.2041 / 0.2 * elements))) + " elements") != std::string::npos);
    CHECK(doubts(turning(0.09), settle).front().find(" elements") == std::string::npos);
    settle.final_tension_factor /= 1.1;
    CHECK(doubts(turning(0.2), settle).empty());
    settle.final_tension_factor *= 1.1;

    // 1 / e is left an element further.
    CHECK(std::abs(turn_left(least_turn) - std::exp(-1.0)) < 1e-3);  // four digits of the bound
    CHECK(std::abs(even_turn - 1.0 / std::sqrt(24.0)) < 1e-4);
    CHECK_NOTHROW(require_turns(turning(0.084), settle));
    std::string said;
    try {
        require_turns(turning(0.0412), settle);
    } catch (const std::invalid_argument& error) {
        said = error.what();
    }
    CAPTURE(said);
    CHECK(said.find("SettleParameters.final_tension_factor = 0.01, but it must be <= 0.0024") == 0);
    settle.final_tension_factor = 0.0024;
    CHECK_NOTHROW(require_turns(turning(0.0412), settle));
}

TEST_CASE("a programme of settling that cannot be is refused") {
    using S = SettleParameters;
    const auto refused_settling = [](auto&& change) {
        S settle;
        change(settle);
        return test::refusal([&] { settle.validate(); });
    };
    CHECK(refused_settling([](S&) {}).empty());
    CHECK(refused_settling([](S& s) { s.tension_strain = 0.0; }) ==
          "SettleParameters.tension_strain = 0, but it must be finite and > 0");
    CHECK(refused_settling([](S& s) { s.final_tension_factor = 1.5; }) ==
          "SettleParameters.final_tension_factor = 1.5, but it must be > 0 and <= 1");
    CHECK(refused_settling([](S& s) { s.gap_limit_over_radius = core::unset; }) ==
          "SettleParameters.gap_limit_over_radius = nan, but it must be finite and > 0");
    CHECK(refused_settling([](S& s) { s.allowed_penetration_over_radius = 0.6; }) ==
          "SettleParameters.allowed_penetration_over_radius = 0.6, but it must be > 0 and <= 0.5");
    CHECK(refused_settling([](S& s) { s.release_increments = 0; }) ==
          "SettleParameters.release_increments = 0, but it must be >= 1");
    CHECK(refused_settling([](S& s) { s.friction_coefficient = -0.1; }) ==
          "SettleParameters.friction_coefficient = -0.1, but it must be finite and >= 0");
}

}  // namespace fabric_parameters_test
