// SPDX-License-Identifier: MIT
// Generators: crossings counted against closed forms, and who alternates how.
#include "../../refusal.hpp"
#include <near.hpp>

#include <fibrant/compositions/textile/braids.hpp>
#include <fibrant/compositions/textile/knits.hpp>
#include <fibrant/compositions/textile/plies.hpp>
#include <fibrant/compositions/textile/strands.hpp>
#include <fibrant/compositions/textile/triaxial_weave.hpp>
#include <fibrant/compositions/textile/weaves.hpp>
#include <fibrant/observe/linking.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <tuple>

namespace textile_generators_test {

using namespace fibrant;
using namespace fibrant::compositions::textile;
using fibrant::test::refusal;

YarnType yarn(double radius = 0.05) {
    YarnType type;
    type.radius = radius;
    type.material = {3000.0, 0.3};
    return type;
}
/// Letters come in runs of `run`, but for the first and the last run, which ends may have cut.
bool in_runs_of(const std::string& word, std::size_t run) {
    std::size_t start = 0;
    for (std::size_t k = 1; k <= word.size(); ++k) {
        if (k < word.size() && word[k] == word[start]) continue;
        const std::size_t size = k - start;
        if (size > run || (size < run && start > 0 && k < word.size())) return false;
        start = k;
    }
    return true;
}

TEST_CASE("a flat braid of N yarns has N (N - 1) crossings a period, and each yarn alternates across its turns") {
    for (const Index n : {3, 4, 5, 7, 8}) {
        const double r = 0.05;
        const Textile braid = flat_braid({.yarns = n,
                                          .half_width = 1.6 * static_cast<double>(n) * r,
                                          .period = 16.0 * static_cast<double>(n) * r,
                                          .periods = 3.0,
                                          .type = yarn(r)});
        CHECK(core::count(braid.crossings) == 3 * n * (n - 1));
        for (const std::string& word : order_words(braid.crossings, n)) {
            CHECK(core::count(word) == 3 * 2 * (n - 1));
            CHECK(in_runs_of(word, 1));
        }
        CHECK(refusal([&] { validate(braid); }).empty());
        CHECK(refusal([&] { require_holding(braid); }).empty());
    }
}

TEST_CASE("a tubular braid of n and n carriers has 2 n^2 crossings a turn, in runs of one or two, at the angle of its pitch") {
    for (const Index over : {1, 2})
        for (const Index n : {4, 6, 8}) {
            const double r = 0.05, radius = 2.0 * static_cast<double>(n) * r, pitch = 2.0 * std::numbers::pi * radius;
            const TubularBraid parameters{
                .carriers = n, .radius = radius, .pitch = pitch, .turns = 1.0, .over = over, .overhang = 1.0, .type = yarn(r)};
            const Textile braid = tubular_braid(parameters);
            CHECK(core::count(braid.crossings) == 2 * n * n);
            for (const std::string& word : order_words(braid.crossings, 2 * n)) {
                CHECK(core::count(word) == 2 * n);
                CHECK(in_runs_of(word, static_cast<std::size_t>(over)));
            }
            CHECK(parameters.angle() == test::near(std::numbers::pi / 4.0, 1e-12));
            // The mean of a carrier's slope over a whole turn, without its ends, is that of the helix: heights only go to and
            // fro.
            const Path& path = braid.paths.front();
            const double rise = path.curve(1.0).z() - path.curve(0.0).z() - 2.0 * parameters.overhang;
            CHECK(std::tan(parameters.angle()) == test::near(2.0 * std::numbers::pi * radius / rise, 1e-12));
            CHECK(refusal([&] { require_holding(braid); }).empty());
        }
    CHECK(refusal([] {
              tubular_braid({.carriers = 5, .radius = 1.0, .pitch = 1.0, .over = 2, .type = yarn()});
          }).find("TubularBraid.over = 2") == 0);
}

TEST_CASE("ends of a tubular braid leave its helices, and lie along the tube in grips, side by side: no crossing slides off") {
    const double r = 0.05, radius = 0.4;
    for (const Index n : {3, 4, 5})
        for (const double angle : {30.0, 45.0, 60.0, 65.0}) {
            const double pitch = 2.0 * std::numbers::pi * radius / std::tan(angle * std::numbers::pi / 180.0);
            // Of turns that are no whole rows, the crossings within them are there.
            const double turns = (static_cast<double>(n) + 0.3) / (2.0 * static_cast<double>(n));
            const Textile braid =
                tubular_braid({.carriers = n, .radius = radius, .pitch = pitch, .turns = turns, .type = yarn(r)});
            CHECK(core::count(braid.crossings) == n * n);
            CHECK(refusal([&] { validate(braid); }).empty());
            for (const double end : {0.0, 1.0}) {
                std::vector<double> angles;
                for (const Path& path : braid.paths) {
                    const Vec3 tip = path.curve(end);
                    angles.push_back(std::atan2(tip.y(), tip.x()));
                    REQUIRE(path.grip > 0.0);
                    const double held = path.grip * scene::length_of(path.curve, 1024);
                    CHECK(held > 4.0 * r);
                    const Vec3 along = path.curve(std::abs(end - 0.5 * path.grip)) - tip;
                    CHECK(along.head<2>().norm() < 1e-9 * along.norm());
                    // The grip is all of what is straight: a tenth of a row behind it yarns have begun to turn.
                    const double beyond =
                        (held + 0.05 * pitch / static_cast<double>(n)) / (path.curve(1.0) - path.curve(0.0)).z();
                    const Vec3 turned = path.curve(std::abs(end - beyond));
                    CHECK(std::abs(std::remainder(std::atan2(turned.y(), turned.x()) - angles.back(), 2.0 * std::numbers::pi)) >
                          1e-4);
                }
                std::sort(angles.begin(), angles.end());
                for (std::size_t k = 1; k < angles.size(); ++k)
                    CHECK(angles[k] - angles[k - 1] == test::near(std::numbers::pi / static_cast<double>(n), 1e-9));
            }
            for (const Crossing& crossing : braid.crossings)  // grips end before the outermost ones
                CHECK(crossing.at_above > braid.paths[0].grip * scene::length_of(braid.paths[0].curve, 1024));
        }
    CHECK(refusal([&] {
              tubular_braid({.carriers = 4, .radius = 0.4, .pitch = 2.5, .overhang = 0.1, .type = yarn(r)});
          }).find("TubularBraid.overhang = 0.1") == 0);
    CHECK(refusal([&] {
              tubular_braid({.carriers = 4, .radius = 0.4, .pitch = 2.5, .axials = true, .overhang = 0.1, .type = yarn(r)});
          }).find("TubularBraid.overhang = 0.1, but it must be 0, or >= ") == 0);
    // Of a flat one: an arc of 0.4 (1 + sec a) rows from 0.4 rows within the crossings, and two diameters.
    const double row = 0.3, least = 0.4 * row * std::hypot(1.0, 0.4) + 4.0 * r;
    for (const double overhang : {0.999 * least, 1.001 * least}) {
        const std::string message =
            refusal([&] { flat_braid({.yarns = 3, .half_width = 0.18, .period = 1.8, .overhang = overhang, .type = yarn(r)}); });
        CHECK((overhang < least ? message.find("FlatBraid.overhang = " + core::text(overhang) +
                                               ", but it must be 0, or >= " + core::text(least)) == 0
                                : message.empty()));
    }
    CHECK(refusal([&] {
              tubular_braid({.carriers = 4, .radius = 0.4, .pitch = 2.5, .turns = 0.01, .type = yarn(r)});
          }).find("TubularBraid.turns: rows of crossings = 0.08") == 0);
}

/// Checks that a generator refuses a length by its field and names one that does, while a twentieth less does not; the length.
template <class Parameters, class Draw>
double least_length(Parameters parameters, double Parameters::*length, const std::string& field, const Draw& draw) {
    const std::string message = refusal([&] { draw(parameters); });
    const std::string start = field + " = " + core::text(parameters.*length) + ", but it must be >= ";
    CHECK(message.find(start) == 0);
    REQUIRE(message.size() > start.size());
    const double least = parameters.*length = std::stod(message.substr(start.size()));
    CHECK(refusal([&] { validate(draw(parameters)); }).empty());
    parameters.*length *= 0.95;
    CHECK(refusal([&] { draw(parameters); }).find(field) == 0);
    return least;
}

TEST_CASE("yarns that would lie in each other or bend more sharply than they are thick are refused by the length that would do") {
    const double r = 0.05;
    for (const double period : {1e-9, 1e-3, 0.4}) {
        const FlatBraid flat{.yarns = 3, .half_width = 0.18, .period = period, .type = yarn(r)};
        const double least = least_length(flat, &FlatBraid::period, "FlatBraid.period", flat_braid);
        // Beside each other in one direction, across them.
        CHECK(4.0 * 0.18 / 3.0 / std::hypot(1.0, 4.0 * 0.18 / least) > 2.0 * r);
    }
    for (const double pitch : {1e-9, 1e-3, 0.2}) {
        const TubularBraid tube{.carriers = 4, .radius = 0.4, .pitch = pitch, .type = yarn(r)};
        TubularBraid good = tube;
        good.pitch = least_length(tube, &TubularBraid::pitch, "TubularBraid.pitch", tubular_braid);
        CHECK(good.spacing() > 2.0 * r * (1.0 - 1e-6));
    }
    for (const double period : {1e-9, 1e-3, 0.5}) {
        const double least =
            least_length(Net{.yarns = 4, .spacing = 0.8, .period = period, .type = yarn(r)}, &Net::period, "Net.period", net);
        CHECK(std::pow(least / (2.0 * std::numbers::pi), 2) / 0.5 > r);  // radius of curvature of a cosine of amplitude 0.5
    }
    for (const double spacing : {1e-9, 1e-3, 0.2})
        least_length(
            LenoWeave{.pairs = 2, .picks = 4, .pick_spacing = spacing, .pair_spacing = 0.7, .aside = 0.15, .type = yarn(r)},
            &LenoWeave::pick_spacing, "LenoWeave.pick_spacing", leno);
    // Layers far apart: warps climb, and the wefts have to give them room.
    least_length(LevelPlan{.levels = levels_of({"01", "10"}),
                           .column_spacing = 0.4,
                           .warp_spacing = 0.3,
                           .layer_spacing = 10.0,
                           .warp = yarn(r),
                           .weft = yarn(r)},
                 &LevelPlan::column_spacing, "LevelPlan.column_spacing", woven);
    CHECK(refusal([&] {
              tubular_braid({.carriers = 100, .radius = 0.4, .pitch = 2.5, .type = yarn(r)});
          }).find("TubularBraid.radius = 0.4, but it must be > " + core::text(5.0 / std::numbers::pi)) == 0);
    // A slip of the unit is told by the length that is the largest.
    CHECK(refusal([&] {
              flat_braid({.yarns = 3, .half_width = 1e9, .period = 1e12, .type = yarn(r)});
          }).find("FlatBraid.period") == 0);
    CHECK(refusal([&] {
              flat_braid({.yarns = 3, .half_width = 1e9, .period = 1.8, .type = yarn(r)});
          }).find("FlatBraid.half_width = 1e+09") == 0);
    CHECK(refusal([&] { net({.yarns = 3, .spacing = 0.8, .period = 1e9, .type = yarn(r)}); }).find("Net.period = 1e+09") == 0);
    // What may not be as long is refused by its length as well, before it is drawn: 3 yarns of 2 periods.
    YarnType few = yarn(r);
    for (const double most : {4.0, 10.0}) {
        few.longest = most * 3.0 / r;
        const std::string message =
            refusal([&] { flat_braid({.yarns = 3, .half_width = 0.18, .period = 1.8, .periods = 2.0, .type = few}); });
        CHECK((most < 5.0 ? message.find("FlatBraid.period = 1.8, but it must be less with fibres of radius 0.05: ") == 0 &&
                                message.find("memory") != std::string::npos
                          : message.empty()));
    }
}

TEST_CASE("a curve that goes back within its points is as sharp as it is") {
    // To and fro on a line, a thousandth apart: half a circle of that, however points lie about it.
    for (const double shift : {0.0, 0.003, 0.011}) {
        const scene::Curve hairpin = [=](double t) {
            const double x = std::abs(t - 0.5 - shift);
            return Vec3(-x, t > 0.5 + shift ? 1e-3 : 0.0, 0.0);
        };
        CHECK(detail::tightest(hairpin, 64, false).first < 0.02);
    }
}

/// Where a path is at an arc from its start, and where it goes.
std::pair<Vec3, Vec3> place_at(const Line& line, double arc) {
    const auto k = static_cast<std::size_t>(std::upper_bound(line.arc.begin() + 1, line.arc.end() - 1, arc) - line.arc.begin());
    const Vec3 along = line.points[k] - line.points[k - 1];
    return {line.points[k - 1] + (arc - line.arc[k - 1]) / (line.arc[k] - line.arc[k - 1]) * along, along};
}

TEST_CASE("orders of braids are those of their closed forms: z = h sin 2 f over x = A sin f, and r = R + h cos n f going right") {
    const double r = 0.05;
    const Textile flat = flat_braid({.yarns = 3, .half_width = 5.0 * r, .period = 50.0 * r, .type = yarn(r)});
    std::vector<Line> lines = lines_of(flat);
    for (const Crossing& crossing : flat.crossings) {
        const auto [place, along] = place_at(lines[core::at(crossing.above)], crossing.at_above);
        CHECK((along.x() > 0.0) == (place.x() > 0.0));   // sin 2 f = 2 sin f cos f > 0
        CHECK(place.z() == test::near(1.05 * r, 5e-3));  // between points half a radius apart, on a slope that is level there
    }
    // Of five yarns over two: what goes right is above in the outer two of four lines of meetings, at 0.6 and 0.2 of the half
    // width.
    const double half = 8.0 * r;
    const Textile twill = flat_braid({.yarns = 5, .half_width = half, .period = 80.0 * r, .over = 2, .type = yarn(r)});
    lines = lines_of(twill);
    for (const Crossing& crossing : twill.crossings) {
        const auto [place, along] = place_at(lines[core::at(crossing.above)], crossing.at_above);
        CHECK((along.x() > 0.0) == (std::abs(place.x()) > 0.4 * half));
    }
    const Index n = 4;
    const double radius = 0.4, pitch = 2.5;
    const Textile tube = tubular_braid({.carriers = n, .radius = radius, .pitch = pitch, .turns = 1.0, .type = yarn(r)});
    lines = lines_of(tube);
    for (const Crossing& crossing : tube.crossings) {
        const double f = 2.0 * std::numbers::pi * place_at(lines[core::at(crossing.above)], crossing.at_above).first.z() / pitch;
        CHECK((crossing.above < n) == (std::cos(static_cast<double>(n) * f) > 0.0));
    }
}

TEST_CASE("a path has the heights of its crossings however many there are, and of those at one point the greatest") {
    for (const Index n : {4, 20000}) {
        std::vector<std::pair<double, double>> knots;
        const auto at = [&](Index k) { return (static_cast<double>(k) + 0.5) / static_cast<double>(n); };
        for (Index k = 0; k < n; ++k) knots.emplace_back(at(k), k % 2 == 0 ? 1.0 : -1.0);
        knots.emplace_back(at(1) + 1e-9, -2.0);
        const detail::HeightLine heights(std::move(knots), false);
        Index right = 0;
        for (Index k = 0; k < n; ++k)
            right += std::abs(heights(at(k)) - (k % 2 == 0 ? 1.0 : k == 1 ? -2.0 : -1.0)) < 1e-6 ? 1 : 0;
        CHECK(right == n);
    }
}

TEST_CASE("axial yarns of a triaxial tube pass between the two that meet on them: two orders a passage") {
    const Index n = 6;
    const double r = 0.05, radius = 3.0 * static_cast<double>(n) * r;
    const Textile braid = tubular_braid({.carriers = n,
                                         .radius = radius,
                                         .pitch = 2.0 * std::numbers::pi * radius,
                                         .turns = 1.0,
                                         .axials = true,
                                         .type = yarn(r)});
    // An axial line meets each carrier of each way once a turn.
    CHECK(core::count(braid.crossings) == 2 * n * n + 2 * n * n);
    for (const Crossing& crossing : braid.crossings) {
        if (crossing.below >= 2 * n) CHECK(crossing.above >= n);
        if (crossing.above >= 2 * n) CHECK(crossing.below < n);
    }
}

TEST_CASE("a level matrix has warps x columns x layers crossings, and warp w lies above the weft of layer l where l < level") {
    struct Case {
        std::vector<std::string> levels;
        Index layers;
    };
    for (const Case& c : {Case{{"01", "10"}, 1}, Case{{"0033", "3300", "1111", "2222"}, 3},
                          Case{{"0123321", "3210123", "1111111", "2222222"}, 3}, Case{{"0220", "2002", "1111"}, 2}}) {
        LevelPlan plan{.levels = levels_of(c.levels),
                       .layers = c.layers,
                       .column_spacing = 0.6,
                       .warp_spacing = 0.3,
                       .warp = yarn(),
                       .weft = yarn()};
        const Textile weave = woven(plan);
        const Index columns = plan.column_count();
        REQUIRE(core::count(weave.crossings) == plan.warps() * columns * c.layers);
        Index right = 0;
        for (const Crossing& crossing : weave.crossings) {
            const bool warp_above = crossing.above < plan.warps();
            const Index w = warp_above ? crossing.above : crossing.below,
                        weft = (warp_above ? crossing.below : crossing.above) - plan.warps();
            right += warp_above == (weft % c.layers < c.levels[core::at(w)][core::at(weft / c.layers)] - '0') ? 1 : 0;
        }
        CHECK(right == core::count(weave.crossings));
        CHECK(refusal([&] { validate(weave); }).empty());
        // Warps go on by a spacing beyond the outermost wefts.
        CHECK(weave.paths[0].curve(0.0).x() == test::near(-0.6, 1e-12));
        CHECK(weave.paths[0].curve(1.0).x() == test::near(0.6 * static_cast<double>(columns), 1e-12));
        // Turned over, every order is the other way round.
        Textile mirrored = weave;
        mirrored.view.axis = -Vec3::UnitZ();
        for (const Crossing& crossing : crossings_of(mirrored)) right -= crossing.axis.z() < 0.0 ? 1 : 0;
        CHECK(right == 0);
        CHECK(audit_crossings(weave.crossings, crossings_of(mirrored)).wrong == core::count(weave.crossings));
    }
    CHECK(angle_interlock(3) == std::vector<Index>{0, 1, 2, 3, 2, 1});
    CHECK(angle_interlock(3, 1) == std::vector<Index>{1, 2, 3, 2, 1, 0});
    CHECK(refusal([] {
              woven({.levels = levels_of({"04"}),
                     .layers = 3,
                     .column_spacing = 0.6,
                     .warp_spacing = 0.3,
                     .warp = yarn(),
                     .weft = yarn()});
          }).find("LevelPlan.levels[0][1] = 4") == 0);
    CHECK(refusal([] {
              woven({.levels = levels_of({"01"}), .column_spacing = 0.15, .warp_spacing = 0.3, .warp = yarn(), .weft = yarn()});
          }).find("LevelPlan.column_spacing") == 0);
    const auto rows = [](const std::vector<std::string>& levels, Index columns) {
        LevelPlan plan{.levels = levels_of(levels), .columns = columns, .column_spacing = 0.6, .warp_spacing = 0.3};
        plan.warp = plan.weft = yarn();
        return refusal([&] { plan.validate(); });
    };
    CHECK(
        rows({"0101", "101"}, 0) ==
        "LevelPlan.levels[1] = 3 columns, but it must be a number of columns that divides the 4 of the first row, unless columns "
        "are given");
    CHECK(rows({"01", "1010"}, 0).find("LevelPlan.levels[1] = 4 columns") == 0);  // the rest would be unheard
    CHECK(rows({"0101", "10"}, 0).empty());
    CHECK(rows({"0101", "1"}, 0).empty());
    CHECK(rows({"0101", "101"}, 12).empty());
}

TEST_CASE("a weave that goes on has its middle at the origin, and all of its yarns have theirs across it") {
    const Textile cell = woven({.levels = levels_of({"01", "10", "01", "10"}),
                                .column_spacing = 0.6,
                                .warp_spacing = 0.3,
                                .periodic = true,
                                .warp = yarn(),
                                .weft = yarn()});
    Vec3 sum = Vec3::Zero();
    for (const Path& path : cell.paths) {
        const Vec3 middle = path.curve(0.5), along = path.curve(1.0) - path.curve(0.0);
        CHECK(std::abs(middle.dot(along)) < 1e-12);
        sum += middle;
    }
    CHECK(sum.head<2>().norm() < 1e-12);
}

TEST_CASE("a lift plan gives back its levels, and one bit that contradicts them is refused by warp and pick") {
    const std::vector<std::vector<Index>> levels = levels_of({"0123", "3210", "1111"});
    std::vector<std::vector<bool>> lift;
    for (const auto& row : levels) {
        lift.emplace_back();
        for (const Index level : row)
            for (Index l = 0; l < 3; ++l) lift.back().push_back(l < level);
    }
    CHECK(levels_of_lifts(lift, 3) == levels);
    lift[1][0] = false;  // below the lowest weft and above the two over it
    CHECK(refusal([&] { levels_of_lifts(lift, 3); }).find("lift[1][1] = 1, but it must be 0: in column 0") == 0);
}

TEST_CASE("a cloth whose warps all lie above comes apart, and is refused by name before work") {
    const Textile loose = woven({.levels = levels_of({"1111", "0101", "1010"}),
                                 .column_spacing = 0.6,
                                 .warp_spacing = 0.3,
                                 .warp = yarn(),
                                 .weft = yarn()});
    const std::string message = refusal([&] { require_holding(loose); });
    CHECK(message.find("warp 0") != std::string::npos);
    CHECK(refusal([] {
              require_wefts_held({.levels = levels_of({"01", "12"}), .layers = 2});
          }) ==
          "LevelPlan.levels: column 0 = levels from 0 to 1, an interlacing that comes apart, but it must be from 0 to layers "
          "= 2: else no warp lies above its uppermost weft");
    CHECK(refusal([] { require_wefts_held({.levels = levels_of({"02", "20"}), .layers = 2}); }).empty());
    CHECK(refusal([] {
              require_holding(woven({.levels = levels_of({"0101", "1010"}),
                                     .column_spacing = 0.6,
                                     .warp_spacing = 0.3,
                                     .warp = yarn(),
                                     .weft = yarn()}));
          }).empty());
}

TEST_CASE("leno has two crossings a pick and one a gap for each pair, always in the one order of its yarns") {
    const LenoWeave parameters{.pairs = 3, .picks = 5, .pick_spacing = 1.0, .pair_spacing = 0.6, .aside = 0.15, .type = yarn()};
    const Textile weave = leno(parameters);
    CHECK(core::count(weave.crossings) == 3 * (2 * 5 + 4));
    for (const Crossing& crossing : weave.crossings) {  // ground and doup by turns, then wefts
        const auto kind = [](Index path) -> Index { return path >= 6 ? 2 : path % 2; };
        const Index above = kind(crossing.above), below = kind(crossing.below);
        CHECK(((above == 1 && below == 2) || (above == 2 && below == 0) || (above == 0 && below == 1)));
    }
    CHECK(refusal([&] { require_holding(weave); }).empty());
    CHECK(refusal([&] { validate(weave); }).empty());
}

TEST_CASE("the outermost wefts of a leno keep their places along its ends where pairs cross them, so that none is pushed off") {
    const double spacing = 0.6;
    const Textile weave =
        leno({.pairs = 3, .picks = 4, .pick_spacing = 1.0, .pair_spacing = spacing, .aside = 0.15, .type = yarn()});
    for (Index m = 0; m < 4; ++m) {
        const Path& weft = weave.paths[core::at(6 + m)];
        REQUIRE(core::count(weft.guides) == (m == 0 || m == 3 ? 3 : 0));
        for (std::size_t k = 0; k < weft.guides.size(); ++k) {
            const double width = weft.curve(1.0).y() - weft.curve(0.0).y();  // rounding is that of it
            CHECK(std::abs(weft.curve(weft.guides[k].at).y() - spacing * static_cast<double>(k)) < 1e-12 * width);
            CHECK((weft.guides[k].directions - Mat3(Vec3::UnitX() * Vec3::UnitX().transpose())).norm() == 0.0);
        }
    }
}

TEST_CASE("no end of a triaxial weave of single fibres stands on another yarn or just behind one, whatever the sample's radius") {
    for (const auto& sample : {std::pair{0.8, 1.2}, {0.8, 2.0}, {0.8, 2.4}, {0.45, 1.0}, {0.6, 1.4}}) {
        const double spacing = sample.first, radius = sample.second;
        CAPTURE(spacing);
        CAPTURE(radius);
        const Textile weave = triaxial_weave({.spacing = spacing, .radius = radius, .type = yarn(), .height_over_radius = 0.5});
        const std::vector<Line> lines = lines_of(weave);
        double nearest = spacing;
        for (std::size_t a = 0; a < lines.size(); ++a)
            for (std::size_t b = 0; b < lines.size(); ++b)
                for (const Vec3& end : {lines[a].points.front(), lines[a].points.back()})
                    for (const Vec3& point : lines[b].points)
                        if (a != b) nearest = std::min(nearest, std::hypot(point.x() - end.x(), point.y() - end.y()));
        CHECK(nearest > 0.12);  // 3 radii along itself are 0.13 across the other, at 60 degrees; diameters are 0.1
    }
}

TEST_CASE("a triaxial weave crosses each pair once at most, in cyclic order, and every yarn alternates") {
    const Textile weave = triaxial_weave({.spacing = 0.8, .radius = 2.4, .type = yarn()});
    std::vector<std::pair<Index, Index>> pairs;
    for (const Crossing& c : weave.crossings) {
        const Index a = weave.paths[core::at(c.above)].family, b = weave.paths[core::at(c.below)].family;
        CHECK((a + 1) % 3 == b);
        pairs.emplace_back(std::min(c.above, c.below), std::max(c.above, c.below));
    }
    std::sort(pairs.begin(), pairs.end());
    CHECK(std::adjacent_find(pairs.begin(), pairs.end()) == pairs.end());
    for (const std::string& word : order_words(weave.crossings, core::count(weave.paths))) CHECK(in_runs_of(word, 1));
    CHECK(refusal([&] { validate(weave); }).empty());
}

TEST_CASE(
    "each loop of a weft knit crosses the one above it four times: heads over legs, legs under feet, or the other way round") {
    const double r = 0.1;
    for (const std::vector<std::string>& stitches : {std::vector<std::string>{"f"}, {"fr"}, {"f", "r"}, {"fr", "rf"}}) {
        const WeftKnit parameters{.stitches = stitches,
                                  .courses = 4,
                                  .wales = 3,
                                  .wale_spacing = 12.0 * r,
                                  .course_spacing = 9.0 * r,
                                  .loop_height = 8.0 * r,
                                  .height_over_radius = 0.3,
                                  .type = yarn(r)};
        const Textile knit = weft_knit(parameters);
        CHECK(core::count(knit.crossings) == 3 * 3 * 4);
        for (const Crossing& c : knit.crossings) CHECK(std::abs(c.above - c.below) == 1);
        for (Index k = 0; k + 1 < 4; ++k) {
            std::vector<std::pair<double, bool>> seen;  // along the lower course
            for (const Crossing& c : knit.crossings) {
                if (std::min(c.above, c.below) != k || std::max(c.above, c.below) != k + 1) continue;
                seen.emplace_back(c.above == k ? c.at_above : c.at_below, c.above == k);
            }
            std::sort(seen.begin(), seen.end());
            REQUIRE(seen.size() == 12);
            for (Index m = 0; m < 3; ++m) {  // legs and heads of the lower loop: -, +, +, - where the loop above is a face stitch
                const bool face = parameters.face(k + 1, m);
                for (const auto& [at, head] : {std::pair{0, false}, {1, true}, {2, true}, {3, false}})
                    CHECK(seen[core::at(4 * m + at)].second == (head == face));
            }
        }
        CHECK(refusal([&] { validate(knit); }).empty());
        // The first course is held by its feet between wales, the last one by its heads.
        for (const auto& [course, guides, y] :
             {std::tuple{std::size_t{0}, std::size_t{2}, -8.0 * r}, {std::size_t{3}, std::size_t{3}, 3.0 * 9.0 * r + 8.0 * r}}) {
            const Path& path = knit.paths[course];
            REQUIRE(path.guides.size() == guides);
            for (const auto& guide : path.guides) CHECK(std::abs(path.curve(guide.at).y() - y) < 0.05 * r);
        }
        CHECK(knit.paths[1].guides.empty());
    }
}

TEST_CASE("each loop of a tricot crosses that drawn through it four times") {
    const double r = 0.05;
    const Textile knit = tricot({.needles = 4,
                                 .courses = 4,
                                 .needle_spacing = 20.0 * r,
                                 .course_spacing = 16.0 * r,
                                 .loop_height = 22.0 * r,
                                 .type = yarn(r)});
    // Needle m is laid by yarn m in even courses and by yarn m - 1 in odd ones: of 3 gaps of courses, on 4 needles all but those
    // that an edge leaves.
    std::vector<Index> of_pair(16, 0);
    for (const Crossing& c : knit.crossings) ++of_pair[core::at(4 * std::min(c.above, c.below) + std::max(c.above, c.below))];
    for (Index m = 0; m + 1 < 4; ++m) CHECK(of_pair[core::at(4 * m + m + 1)] == 3 * 4);
    for (const Path& path : knit.paths) {  // held by the last head
        REQUIRE(path.guides.size() == 1);
        CHECK(std::abs(path.curve(path.guides[0].at).y() - (3.0 * 16.0 * r + 22.0 * r)) < 0.1 * r);
    }
    CHECK(refusal([&] { validate(knit); }).empty());
}

TEST_CASE("underlaps of a tricot pass the head of their own yarn's loop, with room for two fibres side by side") {
    const double r = 0.05;
    YarnType two = yarn(r);
    two.fibres = 2;
    for (const YarnType& type : {yarn(r), two}) {
        const Textile knit =
            tricot({.needles = 3, .courses = 3, .needle_spacing = 1.0, .course_spacing = 0.8, .loop_height = 1.1, .type = type});
        constexpr int pieces = 600;
        const double length = scene::length_of(knit.paths[0].curve), far = 0.8;  // along the yarn, beyond the turn of a foot
        std::vector<std::vector<Vec3>> fibres;
        for (const scene::Curve& curve : detail::fibre_curves(knit, 0)) {
            fibres.emplace_back();
            for (int k = 0; k <= pieces; ++k) fibres.back().push_back(curve(k / double(pieces)));
        }
        double least = 1e9;
        for (const auto& one : fibres)
            for (const auto& other : fibres)
                for (int k = 0; k <= pieces; ++k)
                    for (int l = k + static_cast<int>(far / length * pieces) + 1; l <= pieces; ++l)
                        least = std::min(least, (one[core::at(k)] - other[core::at(l)]).norm());
        CHECK(least >= 2.0 * r);
    }
}

TEST_CASE("plies lie on helices as long as their angle says, and do not touch") {
    const double r = 0.05, pitch = 40.0 * r, length = 3.0 * pitch;
    const Plied parameters{.plies = 3, .pitch = pitch, .length = length, .type = yarn(r)};
    const Textile yarn3 = plied(parameters);
    const double a = parameters.lay_radius(3, r, pitch);
    for (const Path& path : yarn3.paths)
        CHECK(scene::length_of(path.curve) == test::near(length * helix_length_ratio(a, pitch), 1e-4));
    double least = 1e9;
    for (Index k = 0; k <= 400; ++k)
        for (Index l = 0; l <= 400; ++l)
            least = std::min(least, (yarn3.paths[0].curve(static_cast<double>(k) / 400.0) -
                                     yarn3.paths[1].curve(static_cast<double>(l) / 400.0))
                                        .norm());
    // Two helices a third of a turn apart, one point on each, f more than that apart: 4 a^2 sin^2(pi / 3 + f / 2) + (H f / 2
    // pi)^2.
    const auto apart = [&](double f) {
        return std::hypot(2.0 * a * std::sin(std::numbers::pi / 3.0 + 0.5 * f), pitch * f / (2.0 * std::numbers::pi));
    };
    double closest = 1e9;
    for (Index k = -2000; k <= 0; ++k) closest = std::min(closest, apart(1e-3 * static_cast<double>(k)));
    CHECK(least == test::near(closest, 3e-3));  // points are 0.32 r apart, half of which misses by (0.16 r)^2 / (2 * 2.1 r)
    CHECK(closest >= 1.05 * 2.0 * r);           // the slack that is taken where none is given
    // No further apart than if sections were as wide all around as ellipses that lean are at their widest.
    CHECK(closest <= 1.05 * 2.0 * r * helix_length_ratio(a, pitch));
    const Textile rope =
        plied({.plies = 3, .pitch = pitch, .strands = 3, .strand_pitch = 100.0 * r, .length = length, .type = yarn(r)});
    CHECK(core::count(rope.paths) == 9);
    // Strands go round the other way than their plies, and keep clear of each other.
    const auto middle = [&](double t) {
        return Vec3((rope.paths[0].curve(t) + rope.paths[1].curve(t) + rope.paths[2].curve(t)) / 3.0);
    };
    const auto turns = [](const Vec3& from, const Vec3& to) { return from.cross(to).z(); };
    CHECK(turns(middle(0.0), middle(0.01)) < 0.0);
    CHECK(turns(rope.paths[0].curve(0.0) - middle(0.0), rope.paths[0].curve(0.01) - middle(0.01)) > 0.0);
    least = 1e9;
    for (Index k = 0; k <= 400; ++k)
        for (std::size_t one = 0; one < 3; ++one)
            for (std::size_t other = 3; other < 6; ++other)
                for (Index l = std::max<Index>(0, k - 20); l <= std::min<Index>(400, k + 20); ++l)
                    least = std::min(least, (rope.paths[one].curve(static_cast<double>(k) / 400.0) -
                                             rope.paths[other].curve(static_cast<double>(l) / 400.0))
                                                .norm());
    CHECK(least > 2.0 * r);
    CHECK(refusal([&] { validate(rope); }).empty());
}

TEST_CASE("a ring of chain mail is linked once with each of four neighbours, and with no other") {
    const Textile mail = chain_mail({.rows = 5, .columns = 4, .ring_radius = 1.0, .type = yarn(0.08)});
    const std::vector<Line> lines = lines_of(mail);
    std::vector<Index> links(lines.size(), 0);
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (std::size_t j = i + 1; j < lines.size(); ++j) {
            const Index link = std::abs(observe::linking_number(lines[i].points, lines[j].points));
            CHECK(link <= 1);
            links[i] += link, links[j] += link;
        }
    CHECK(links[4 * 2 + 1] == 4);  // inside
    CHECK(links[0] == 1);          // at a corner that a row stands back from
}

TEST_CASE("rings of a row of mail are drawn a radius of the wire from each other at least, and are linked as further ones are") {
    for (const double r : {0.08, 0.2}) {
        const ChainMail touching{.rows = 3, .columns = 3, .ring_radius = 1.0, .pitch = 2.0, .row_pitch = 0.9, .type = yarn(r)};
        const Textile mail = chain_mail(touching);
        // The nearest points of neighbours of a row: half a turn and none.
        const double between = (mail.paths[1].curve(0.5) - mail.paths[0].curve(0.0)).norm();
        CHECK(between == test::near(r, 1e-12));
        ChainMail apart = touching;
        apart.pitch = 2.0 + 2.0 * r;
        const Textile further = chain_mail(apart);
        CHECK((further.paths[1].curve(0.5) - further.paths[0].curve(0.0)).norm() == test::near(2.0 * r, 1e-12));
        const std::vector<Line> near_lines = lines_of(mail), far_lines = lines_of(further);
        for (std::size_t i = 0; i < near_lines.size(); ++i)
            for (std::size_t j = i + 1; j < near_lines.size(); ++j)
                CHECK(std::abs(observe::linking_number(near_lines[i].points, near_lines[j].points)) ==
                      std::abs(observe::linking_number(far_lines[i].points, far_lines[j].points)));
    }
}

TEST_CASE("yarns of a net clasp each other at every turn: two crossings, one above, then the other") {
    const double r = 0.05;
    const Textile meshes = net({.yarns = 4, .spacing = 16.0 * r, .period = 60.0 * r, .periods = 2.0, .type = yarn(r)});
    CHECK(core::count(meshes.crossings) == 2 * (2 + 2 + 2));
    for (Index k = 0; k + 1 < 4; ++k) {
        Index above = 0, below = 0;
        for (const Crossing& c : meshes.crossings)
            above += c.above == k && c.below == k + 1, below += c.below == k && c.above == k + 1;
        CHECK(above == 2);
        CHECK(below == 2);
    }
    CHECK(refusal([&] { require_holding(meshes); }).empty());
}

/// Words of who is above along thread `name`: a for the thread, b for what it crosses.
std::string thread_word(const Textile& textile, Index thread) {
    std::vector<std::pair<double, char>> seen;
    for (const Crossing& c : textile.crossings) {
        if (c.above == thread) seen.emplace_back(c.at_above, 'a');
        if (c.below == thread) seen.emplace_back(c.at_below, 'b');
    }
    std::sort(seen.begin(), seen.end());
    std::string word;
    for (const auto& [at, letter] : seen) word += letter;
    return word;
}

TEST_CASE("stitched plies lie on each other, and threads are over all of them for a stitch and under all for the next") {
    const double r = 0.05;
    // Two plies at a right angle, 6 yarns along x and 12 along y. Between two places where threads go through lie 3 yarns along
    // y, and threads go sideways over or under 2 along x.
    const StitchedPlies two{.angles_deg = {0.0, 90.0},
                            .yarn_spacing = 0.3,
                            .length = 3.6,
                            .width = 1.8,
                            .stitch_length = 0.9,
                            .row_spacing = 0.6,
                            .sideways = 0.6,
                            .yarn = yarn(r),
                            .thread = yarn(0.6 * r)};
    const Textile cloth = stitched(two);
    REQUIRE(cloth.paths.size() == 6 + 12 + 3);
    CHECK(core::count(cloth.crossings) == 6 * 12 + 3 * (12 + 2 * 2));
    for (const Crossing& c : cloth.crossings)
        if (c.above < 18 && c.below < 18) CHECK((c.above >= 6 && c.below < 6));
    CHECK(thread_word(cloth, 18) == "aaabbbbbaaaaabbb");
    CHECK(thread_word(cloth, 19) == "bbbaaaaabbbbbaaa");
    CHECK(refusal([&] { validate(cloth); }).empty());
    CHECK(refusal([&] { require_holding(cloth); }).empty());
    StitchedPlies loose = two;  // threads along yarns do not hold them
    loose.sideways = 0.0;
    CHECK(refusal([&] { require_holding(stitched(loose)); }).find("an interlacing that comes apart") != std::string::npos);
    for (Index p = 18; p < 21; ++p)  // nothing lies in a thread
        for (Index q = 0; q < 18; ++q)
            for (Index k = 0; k <= 400; ++k) {
                const Vec3 at = cloth.paths[core::at(p)].curve(static_cast<double>(k) / 400.0),
                           from = cloth.paths[core::at(q)].curve(0.0), chord = cloth.paths[core::at(q)].curve(1.0) - from;
                if ((at - from).cross(chord).norm() / chord.norm() < 1.6 * r * 0.98) FAIL_CHECK("thread ", p, " in yarn ", q);
            }
    // Slanted plies: lines of 45 degrees meet the places at whole multiples of their spacing. With stitches twice as long a yarn
    // lies below all that it crosses.
    StitchedPlies slanted = two;
    slanted.angles_deg = {45.0, -45.0}, slanted.stitch_length = 0.3 * std::sqrt(2.0), slanted.row_spacing = 0.6 * std::sqrt(2.0);
    slanted.sideways = 0.0, slanted.width = 3.6;
    const Textile biaxial = stitched(slanted);
    CHECK(refusal([&] { require_holding(biaxial); }).empty());
    StitchedPlies long_stitches = slanted;
    long_stitches.stitch_length *= 2.0;
    CHECK(refusal([&] { require_holding(stitched(long_stitches)); }).find("'ply 0 yarn 13' lies below all that it crosses") !=
          std::string::npos);
    for (const Crossing& c : biaxial.crossings) {
        const Index a = biaxial.paths[core::at(c.above)].family, b = biaxial.paths[core::at(c.below)].family;
        CHECK((a == 2 || b == 2 || a > b));
    }
    slanted.row_spacing = 0.7;
    CHECK(refusal([&] { stitched(slanted); }).find("from a yarn of ply 0 where it goes through, at x = ") != std::string::npos);
    // Others that are named would do.
    for (const std::vector<double>& angles : {std::vector<double>{45.0, -45.0}, {30.0, -30.0}, {0.0, 45.0, 90.0}}) {
        StitchedPlies other = two;
        other.angles_deg = angles;
        const std::string message = refusal([&] { stitched(other); }),
                          field =
                              "StitchedPlies.stitch_length, row_spacing, sideways = 0.9, 0.6, 0.6, but it must be others, "
                              "as ";
        CAPTURE(message);
        REQUIRE(message.find(field) == 0);
        REQUIRE(std::sscanf(message.c_str() + field.size(), "%lf, %lf, %lf:", &other.stitch_length, &other.row_spacing,
                            &other.sideways) == 3);
        CHECK(refusal([&] { require_holding(stitched(other)); }).empty());
    }
    StitchedPlies none = two;  // near which nothing holds at 60 degrees
    none.angles_deg = {0.0, 60.0};
    CHECK(refusal([&] { stitched(none); }).find("0.9, 0.6, 0.6, but it must be others: distance of thread") != std::string::npos);
    slanted.yarn_spacing = 0.1;
    CHECK(refusal([&] { stitched(slanted); }).find("StitchedPlies.yarn_spacing = 0.1, but it must be >= 0.16") == 0);
}

TEST_CASE("loops, ends and rings that do not reach each other, or reach too far, are refused before work") {
    const double r = 0.05;
    WeftKnit knit{
        .courses = 3, .wales = 3, .wale_spacing = 12.0 * r, .course_spacing = 9.0 * r, .loop_height = 4.6 * r, .type = yarn(r)};
    // The message names the nearest value that would do, and it does.
    const auto named = [](const std::string& message) {
        const std::size_t at = message.find(" at this");
        return at == std::string::npos ? 0.0 : std::stod(message.substr(message.rfind(' ', at - 1)));
    };
    std::string message = refusal([&] { weft_knit(knit); });
    CHECK(message.find("WeftKnit.loop_height = 0.23, but it must be >= ") == 0);
    CHECK(message.find("for 24 crossings, not ") != std::string::npos);
    knit.loop_height = named(message);
    CHECK(refusal([&] { weft_knit(knit); }).empty());
    Tricot warp{.needles = 4,
                .courses = 4,
                .needle_spacing = 20.0 * r,
                .course_spacing = 16.0 * r,
                .loop_height = 40.0 * r,
                .type = yarn(r)};
    message = refusal([&] { tricot(warp); });
    CHECK(message.find("Tricot.loop_height = 2, but it must be <= ") == 0);
    CHECK(message.find("for 36 crossings, not ") != std::string::npos);
    warp.loop_height = named(message);
    CHECK(refusal([&] { tricot(warp); }).empty());
    // Right crossings, but underlaps that lie in the heads of their own yarn's loops.
    warp.loop_height = 26.0 * r;
    message = refusal([&] { tricot(warp); });
    CHECK(message.find("Tricot.loop_height = 1.3, but it must be <= ") == 0);
    CHECK(message.find("heads of their own yarn's loops") != std::string::npos);
    warp.loop_height = named(message);
    CHECK(refusal([&] { tricot(warp); }).empty());
    CHECK(refusal([&] {
              chain_mail({.rows = 2, .columns = 2, .ring_radius = 1.0, .pitch = 4.5, .row_pitch = 1.9, .type = yarn(r)});
          }).find("links of yarn 0 'ring 0.0' with yarn 2 'ring 1.0' = 0, but it must be 1 or -1") != std::string::npos);
}

TEST_CASE("heights at which fibres of several would lie on the wrong side are refused by field, value and bound") {
    const double r = 0.05;
    for (const Index fibres : {1, 2, 7}) {
        YarnType type = yarn(r);
        type.fibres = fibres;
        const auto said = [&](double h) {
            FlatBraid flat{.yarns = 3, .half_width = 1.0, .period = 9.0, .type = type, .height_over_radius = h};
            TubularBraid tube{.carriers = 4, .radius = 1.0, .pitch = 6.0, .type = type, .height_over_radius = h};
            TriaxialWeave weave{.spacing = 2.0, .radius = 3.0, .type = type, .height_over_radius = h};
            WeftKnit knit{.wale_spacing = 2.0, .course_spacing = 1.6, .loop_height = 1.4, .height_over_radius = h, .type = type};
            Tricot warp{.needle_spacing = 3.0, .course_spacing = 2.4, .loop_height = 3.3, .height_over_radius = h, .type = type};
            Net net{.spacing = 2.0, .period = 9.0, .type = type, .height_over_radius = h};
            return std::vector<std::pair<std::string, std::string>>{
                {"FlatBraid", refusal([&] { flat.validate(); })},      {"TubularBraid", refusal([&] { tube.validate(); })},
                {"TriaxialWeave", refusal([&] { weave.validate(); })}, {"WeftKnit", refusal([&] { knit.validate(); })},
                {"Tricot", refusal([&] { warp.validate(); })},         {"Net", refusal([&] { net.validate(); })}};
        };
        for (const auto& [name, message] : said(0.9)) {
            if (fibres == 1)
                CHECK(message.empty());
            else
                CHECK(message.find(name + ".height_over_radius = 0.9, but it must be >= 1.05 ") == 0);
        }
        for (const auto& one : said(1.05)) {
            CAPTURE(one.first);
            CHECK(one.second == "");
        }
    }
}

TEST_CASE("texts say levels up to 35") {
    // An interlock of twelve layers, drawn by its rule and said by texts.
    const Index layers = 12;
    std::vector<std::string> rows;
    std::vector<std::vector<Index>> drawn;
    for (Index w = 0; w < 2 * layers; ++w) {
        drawn.push_back(angle_interlock(layers, w));
        std::string row;
        for (const Index level : drawn.back()) row += "0123456789abcdefghijklmnopqrstuvwxyz"[core::at(level)];
        rows.push_back(row);
    }
    CHECK(levels_of(rows) == drawn);
    CHECK(levels_of({"z"}) == std::vector<std::vector<Index>>{{highest_level}});
    for (const char* row : {"0A", "0 ", "0{", "0/", "0:", "0`"})
        CHECK(refusal([&] { levels_of({row}); }).starts_with("levels: \"0"));
}

}  // namespace textile_generators_test
