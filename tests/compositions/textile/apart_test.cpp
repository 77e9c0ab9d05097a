// SPDX-License-Identifier: MIT
// Fibres of yarns of several start beside those that their yarns cross, whatever their number and twist.
#include "../../refusal.hpp"
#include <near.hpp>

#include <fibrant/compositions/textile/braids.hpp>
#include <fibrant/compositions/textile/imported.hpp>
#include <fibrant/compositions/textile/knits.hpp>
#include <fibrant/compositions/textile/plies.hpp>
#include <fibrant/compositions/textile/strands.hpp>
#include <fibrant/compositions/textile/triaxial_weave.hpp>
#include <fibrant/compositions/textile/weaves.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace textile_apart_test {

using namespace fibrant;
using namespace fibrant::compositions::textile;
using fibrant::test::refusal;

/// Of about the same thickness, however many fibres it has.
YarnType yarn(Index fibres, double twist = 0.0) {
    YarnType type;
    type.fibres = fibres, type.twist = twist, type.material = {3000.0, 0.3};
    type.radius = 0.05 / std::sqrt(static_cast<double>(fibres));
    return type;
}
/// Places where fibres of different yarns would touch were they thinner by this part.
Index touching(const Textile& textile, double thinner) {
    std::vector<std::vector<Vec3>> points;
    std::vector<Index> yarns;
    for (Index p = 0; p < core::count(textile.paths); ++p) {
        const double length = scene::length_of(textile.paths[core::at(p)].curve, 128);
        const auto pieces = std::max<Index>(64, static_cast<Index>(length / textile.type_of(p).radius));
        for (const scene::Curve& curve : detail::fibre_curves(textile, p)) {
            points.emplace_back(), yarns.push_back(p);
            for (Index k = 0; k <= pieces; ++k)
                points.back().push_back(curve(static_cast<double>(k) / static_cast<double>(pieces)));
        }
    }
    std::vector<proximity::Centreline> lines;
    for (std::size_t f = 0; f < points.size(); ++f)
        lines.push_back({.points = points[f], .radius = (1.0 - thinner) * textile.type_of(yarns[f]).radius, .family = yarns[f]});
    return core::count(proximity::GridSearch{}.pairs(lines, 0.0));
}
LevelPlan plain(const YarnType& type) {
    return {.levels = {{0, 1, 0}, {1, 0, 1}, {0, 1, 0}},
            .column_spacing = 0.5,
            .warp_spacing = 0.4,
            .warp = type,
            .weft = type,
            .binder = type};
}
const std::vector<Index> numbers{2, 3, 4, 5, 6, 7, 8, 9, 12};

TEST_CASE("fibres of a weave start beside those of other yarns, however many a yarn has, and twisted or not") {
    for (const Index fibres : numbers)
        for (const double twist : {0.0, 0.5}) {
            CAPTURE(fibres);
            CAPTURE(twist);
            CHECK(touching(woven(plain(yarn(fibres, twist))), 0.0) == 0);
        }
}

TEST_CASE("a doup end of several fibres goes round its ground end, which it does not touch") {
    for (const Index fibres : numbers) {
        CAPTURE(fibres);
        const Textile weave =
            leno({.pairs = 2, .picks = 3, .pick_spacing = 1.0, .pair_spacing = 0.7, .aside = 0.2, .type = yarn(fibres)});
        CHECK(touching(weave, 0.03) == 0);
        CHECK(detail::fibres_cross_rightly(weave));
    }
    CHECK(refusal([] {
              leno({.pairs = 2, .picks = 3, .pick_spacing = 1.0, .pair_spacing = 0.7, .aside = 0.16, .type = yarn(2)});
          }).find("LenoWeave.aside = 0.16, but it must be >= 0.1714") == 0);
}

TEST_CASE("a triaxial weave of several fibres has equal ways between crossings, and its fibres start beside each other") {
    for (const Index fibres : numbers)
        for (const double radius : {1.4, 1.9}) {
            CAPTURE(fibres);
            CAPTURE(radius);
            const Textile weave =
                triaxial_weave({.spacing = 0.8, .radius = radius, .type = yarn(fibres), .height_over_radius = 1.05});
            CHECK(touching(weave, 0.1) == 0);
            CHECK(detail::fibres_cross_rightly(weave));
            std::vector<std::vector<double>> places(weave.paths.size());
            for (const Crossing& crossing : weave.crossings) {
                places[core::at(crossing.above)].push_back(crossing.at_above);
                places[core::at(crossing.below)].push_back(crossing.at_below);
            }
            for (auto& along : places) {
                std::sort(along.begin(), along.end());
                const double way = 0.8 / std::sqrt(3.0);  // and a little more for the rise
                for (std::size_t k = 1; k < along.size(); ++k)
                    CHECK(std::abs(std::remainder(along[k] - along[k - 1], way)) < 0.1 * way);
            }
        }
}

TEST_CASE("threads pass between yarns of several fibres") {
    for (const Index fibres : numbers) {
        CAPTURE(fibres);
        YarnType thread = yarn(1);
        thread.radius = 0.03;
        CHECK(touching(stitched({.angles_deg = {0.0, 90.0},
                                 .yarn_spacing = 0.3,
                                 .length = 3.6,
                                 .width = 1.8,
                                 .stitch_length = 0.9,
                                 .row_spacing = 0.6,
                                 .sideways = 0.6,
                                 .yarn = yarn(fibres),
                                 .thread = thread}),
                       0.05) == 0);
    }
}

TEST_CASE("five, six, eight and nine fibres of a yarn lie in rings, as broad as thick, and touch their neighbours") {
    for (const Index fibres : {5, 6, 8, 9}) {
        CAPTURE(fibres);
        const YarnType type = yarn(fibres);
        const double pitch = 2.0 * type.radius * (1.0 + type.packing_gap);
        const std::vector<Eigen::Vector2d> centres = section_of(type);
        REQUIRE(core::count(centres) == fibres);
        Eigen::Vector2d sum = Eigen::Vector2d::Zero();
        double least = 1e9;
        for (std::size_t a = 0; a < centres.size(); ++a) {
            sum += centres[a];
            for (std::size_t b = 0; b < a; ++b) least = std::min(least, (centres[a] - centres[b]).norm());
        }
        CHECK(sum.norm() < 1e-12);
        CHECK(least == test::near(pitch, 1e-12));
        CHECK(half_thickness(type) == test::near(half_breadth(type), 0.11));
    }
}

TEST_CASE("underlaps that lie in loops of their own yarn are found among near points as among all") {
    const auto among_all = [](const Tricot& given) {
        Tricot knit = given;
        knit.needles = 2, knit.courses = 3;
        const Textile textile = detail::drawn(knit);
        constexpr Index pieces = 400;
        const double length = scene::length_of(textile.paths[0].curve);
        const auto far = static_cast<Index>(2.0 * knit.loop_height / length * static_cast<double>(pieces));
        std::vector<std::vector<Vec3>> fibres;
        for (const scene::Curve& curve : detail::fibre_curves(textile, 0)) {
            fibres.emplace_back();
            for (Index k = 0; k <= pieces; ++k)
                fibres.back().push_back(curve(static_cast<double>(k) / static_cast<double>(pieces)));
        }
        for (const std::vector<Vec3>& one : fibres)
            for (const std::vector<Vec3>& other : fibres)
                for (Index k = 0; k <= pieces; ++k)
                    for (Index l = k + far; l <= pieces; ++l)
                        if ((one[core::at(k)] - other[core::at(l)]).norm() < 2.0 * knit.type.radius) return false;
        return true;
    };
    Index beside = 0, within = 0;
    for (const Index fibres : {1, 2, 3})
        for (double height = 0.9; height < 1.6; height += 0.1) {
            const Tricot knit{.needles = 2,
                              .courses = 3,
                              .needle_spacing = 1.0,
                              .course_spacing = 0.8,
                              .loop_height = height,
                              .type = yarn(fibres)};
            const bool found = detail::underlaps_beside(knit);
            CHECK(found == among_all(knit));
            ++(found ? beside : within);
        }
    CHECK(beside > 3);
    CHECK(within > 3);
}

TEST_CASE("yarns of a tricot lie level where they cross, so that fibres of other yarns start beside theirs") {
    for (const Index fibres : {1, 2, 3, 4, 5, 6, 7, 9, 12}) {
        CAPTURE(fibres);
        const Textile knit = tricot(
            {.needles = 4, .courses = 3, .needle_spacing = 1.0, .course_spacing = 0.8, .loop_height = 1.1, .type = yarn(fibres)});
        // A row of two is twice as broad as it is thick, and lies a little in what comes past it before it crosses.
        CHECK(touching(knit, fibres == 2 ? 0.3 : fibres == 4 ? 0.1 : 0.0) == 0);
        CHECK(detail::fibres_cross_rightly(knit));
    }
}

FlatBraid flat(Index yarns, double room, const YarnType& type) {
    const double half_width = room * static_cast<double>(yarns) * half_room(type);
    return {.yarns = yarns, .half_width = half_width, .period = 10.0 * half_width, .periods = 0.5, .type = type};
}
/// @param spacing  of neighbours of one direction over the breadth of a yarn
TubularBraid tube(Index carriers, double degrees, double spacing, const YarnType& type) {
    const double n = static_cast<double>(carriers), angle = degrees * std::numbers::pi / 180.0,
                 radius = spacing * 2.0 * half_room(type) * n / (2.0 * std::numbers::pi * std::cos(angle));
    return {.carriers = carriers,
            .radius = radius,
            .pitch = 2.0 * std::numbers::pi * radius / std::tan(angle),
            .turns = 2.0 / n,
            .type = type};
}

TEST_CASE("fibres of a braid start less than a radius in those of other yarns: close ones lie level and as high as they need") {
    for (const Index fibres : {2, 3, 4, 5, 7, 12}) {
        CAPTURE(fibres);
        const YarnType type = yarn(fibres);
        for (const Index yarns : {3, 4, 5, 16})
            for (const double room : {1.01, 1.3}) {
                CAPTURE(yarns);
                CAPTURE(room);
                const Textile braid = flat_braid(flat(yarns, room, type));
                CHECK(detail::deepest_start(braid) <= 1.0);
                CHECK(detail::fibres_cross_rightly(braid));
            }
        for (const Index carriers : {4, 16})
            for (const double degrees : {45.0, 64.0}) {
                CAPTURE(carriers);
                CAPTURE(degrees);
                const Textile braid = tubular_braid(tube(carriers, degrees, 2.5, type));
                CHECK(detail::deepest_start(braid) <= 1.0);
                CHECK(detail::fibres_cross_rightly(braid));
            }
    }
}

TEST_CASE("a height of a braid that is given is kept, and single fibres are drawn as they were") {
    YarnType type = yarn(3);
    FlatBraid braid = flat(4, 1.3, type);
    braid.height_over_radius = 1.05;
    const auto highest = [](const Textile& textile) {
        double most = 0.0;
        for (const Path& path : textile.paths)
            for (int k = 0; k <= 2000; ++k) most = std::max(most, path.curve(k / 2000.0).z());
        return most;
    };
    CHECK(highest(flat_braid(braid)) == test::near(1.05 * half_thickness(type), 1e-3));
    braid.type = yarn(1), braid.height_over_radius = core::unset;
    CHECK(highest(flat_braid(braid)) == test::near(1.05 * 0.05, 1e-3));
}

/// Two parallel curves of a file.
std::vector<exchange::FileCurve> side_by_side(double apart) {
    std::vector<exchange::FileCurve> curves(2);
    for (const int k : {0, 1})
        for (int n = 0; n <= 20; ++n) curves[core::at(k)].points.emplace_back(0.1 * n, apart * k, 0.0);
    return curves;
}

TEST_CASE("how deep yarns start in each other is told in radii of their fibres") {
    const auto depth = [](double apart) { return detail::deepest_start(textile_of(side_by_side(apart), yarn(1), {})); };
    CHECK(depth(0.07) == test::near(0.6, 1e-9));
    CHECK(depth(0.11) == 0.0);
}

TEST_CASE("curves of a file that are nearer than yarns of several fibres are broad are refused with a radius that would do") {
    YarnType type = yarn(7);
    type.radius = 0.05;
    const std::vector<exchange::FileCurve> curves = side_by_side(0.09);
    const std::string message = refusal([&] { textile_of(curves, type, {}); });
    REQUIRE(message.find("YarnType.radius = 0.05, but it must be <= ") == 0);
    CHECK(message.find("7 fibres of each curve of the file") != std::string::npos);
    type.radius = std::stod(message.substr(message.find("<= ") + 3));
    CHECK(type.radius > 0.015);  // 0.09 over the six radii of three in a row: they may start in each other by one
    CHECK(refusal([&] { textile_of(curves, type, {}); }).empty());
    type.fibres = 1, type.radius = 0.05;  // were measured, and are parted
    CHECK(refusal([&] { textile_of(curves, type, {}); }).empty());
}

TEST_CASE("radii that a file has are those of its fibres, where nobody says another one") {
    std::vector<exchange::FileCurve> curves = side_by_side(0.2);
    curves[0].radius = 0.04;
    curves[1].radius = 0.05, curves[1].radii.assign(curves[1].points.size(), 0.05), curves[1].radii.back() = 0.071;
    YarnType type = yarn(1);
    CHECK(textile_of(curves, type, {}).smallest_radius() == 0.05);
    type.radius = core::unset;
    const Textile textile = textile_of(curves, type, {});
    CHECK(textile.type_of(0).radius == 0.04);
    CHECK(textile.type_of(1).radius == test::near(0.051, 1e-12));
    curves[0].radius = core::unset;
    CHECK(refusal([&] { textile_of(curves, type, {}); }).find("radius of curve 0 = not given") == 0);
}

TEST_CASE("a curve of a file that is there twice, or so far away that it loses the digits of a radius, is refused") {
    YarnType type = yarn(1);
    type.radius = 0.05;
    std::vector<exchange::FileCurve> twice = side_by_side(0.2);
    CHECK(refusal([&] { textile_of(twice, type, {}); }).empty());
    const std::size_t of = twice.size();
    twice.push_back(twice.front());
    const std::string again = "yarn " + std::to_string(of);
    CHECK(refusal([&] { textile_of(twice, type, {}); }).starts_with(again));
    CHECK(refusal([&] { textile_of(twice, type, {}); }).find("where yarn 0") != std::string::npos);
    std::reverse(twice.back().points.begin(), twice.back().points.end());
    CHECK(refusal([&] { textile_of(twice, type, {}); }).starts_with(again));
    for (Vec3& point : twice.back().points) point.x() += 1e8;
    CHECK(refusal([&] { textile_of(twice, type, {}); }).starts_with(again + ", point 0 = (10000000"));
    for (Vec3& point : twice.back().points) point.x() -= 0.99e8;
    CHECK(refusal([&] { textile_of(twice, type, {}); }).empty());
}

TEST_CASE("a net so short that neighbours do not hook into each other is refused by its periods") {
    const auto said = [](double periods, Index yarns) {
        return refusal([&] { net({.yarns = yarns, .spacing = 0.8, .period = 3.0, .periods = periods, .type = yarn(1)}); });
    };
    for (const Index yarns : {2, 3, 6})
        CHECK(said(0.5, yarns).find("Net.periods = 0.5, but it must be >= 1, for yarn 0 'yarn 0' and yarn 1 'yarn 1' to hook") ==
              0);
    CHECK(said(1.0, 2) == "");
    CHECK(said(1.0, 6) == "");
}

TEST_CASE("rings of mail that go through others of their row are refused by their pitch, value and bound") {
    const auto said = [](double pitch) {
        return refusal([&] { chain_mail({.rows = 2, .columns = 2, .ring_radius = 1.0, .pitch = pitch, .type = yarn(1)}); });
    };
    CHECK(said(1.9).find("ChainMail.pitch = 1.9, but it must be >= 2, two ring radii") == 0);
    CHECK(said(2.0) == "");
    // Rows so far apart that rings do not reach each other, tilted as they are.
    ChainMail steep{
        .rows = 2, .columns = 2, .ring_radius = 1.0, .pitch = 2.0, .row_pitch = 0.9, .tilt_deg = 60.0, .type = yarn(1)};
    const std::string message = refusal([&] { chain_mail(steep); });
    REQUIRE(message.find("ChainMail.row_pitch = 0.9, but it must be <= ") == 0);
    steep.row_pitch = std::stod(message.substr(message.find("<= ") + 3));
    CHECK(refusal([&] { chain_mail(steep); }) == "");
}

TEST_CASE("warps of a cell that go past each other have room side by side, or are refused by their spacing") {
    const auto said = [](double spacing, std::vector<std::vector<Index>> levels) {
        LevelPlan plan = plain(yarn(1));
        plan.periodic = true, plan.levels = std::move(levels), plan.layers = 2, plan.warp_spacing = spacing;
        return refusal([&] { woven(plan); });
    };
    CHECK(
        said(0.09, {{0, 2}, {2, 0}}).find("LevelPlan.warp_spacing = 0.09, but it must be >= 0.1, the breadth of warps 0 and 1") ==
        0);
    CHECK(said(0.09, {{0, 1}, {1, 2}}) == "");  // the one lies above the other all along
    CHECK(said(0.1, {{0, 2}, {2, 0}}) == "");
}

TEST_CASE("a twist that does not close over a path that repeats is refused by value, and the one named closes") {
    LevelPlan plan{.levels = {{0, 1}, {1, 0}}, .column_spacing = 0.5, .warp_spacing = 0.5, .periodic = true};
    plan.warp = plan.weft = plan.binder = yarn(3, 0.9);
    const Textile weave = woven(plan);
    const Index weft = core::count(weave.paths) - 1;  // straight: a length of one
    const std::string message = refusal([&] { detail::fibre_curves(weave, weft); });
    CHECK(message.find("YarnType.twist = 0.9, but it must be 1 or another one that makes whole turns over the length of ") == 0);
    plan.warp = plan.weft = plan.binder = yarn(3, 1.0);
    CHECK(refusal([&] { detail::fibre_curves(woven(plan), weft); }) == "");
}

}  // namespace textile_apart_test
