// SPDX-License-Identifier: MIT
// Random fibres: as many pairs as the excluded volume says, as many as brute force finds, and none in another one where they may
// not be.
#include <fibrant/compositions/mat/random_mat.hpp>
#include <fibrant/proximity/brute_search.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <near.hpp>
#include <refusal.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

using namespace fibrant;

namespace random_mat_test {

namespace mat = compositions::mat;

/// Straight fibres at any place of a box, with all copies that a periodic box of side V^(1/3) has around it.
struct Soft {
    std::vector<std::array<Vec3, 2>> ends;
    std::vector<proximity::Centreline> lines;
    Index own = 0;
};

Soft soft(mat::MatParameters parameters, std::uint64_t seed, bool periodic) {
    mat::Draws draw(seed);
    Soft soft;
    std::vector<mat::MatFibre> fibres;
    for (Index k = 0; k < parameters.fibres; ++k) fibres.push_back(mat::drawn_fibre(parameters, draw));
    const double w = parameters.width, margin = parameters.length + parameters.diameter();
    for (const mat::MatFibre& fibre : fibres) soft.ends.push_back({fibre(0.0), fibre(1.0)});
    soft.own = parameters.fibres;
    if (periodic)
        for (int i = -1; i <= 1; ++i)
            for (int j = -1; j <= 1; ++j)
                for (int k = -1; k <= 1; ++k) {
                    if (i == 0 && j == 0 && k == 0) continue;
                    const Vec3 shift = w * Vec3(i, j, k);
                    for (const mat::MatFibre& fibre : fibres) {
                        const Vec3 middle = fibre.middle + shift;
                        if (middle.minCoeff() > -margin && middle.maxCoeff() < w + margin)
                            soft.ends.push_back({fibre(0.0) + shift, fibre(1.0) + shift});
                    }
                }
    for (const auto& e : soft.ends) soft.lines.push_back({.points = e, .radius = parameters.radius});
    return soft;
}

/// Each pair of a periodic box once: one of the fibres is the box's own; pairs with a copy are seen from both sides.
double periodic_pairs(const std::vector<proximity::SegmentPair>& pairs, Index own) {
    double sum = 0.0;
    for (const proximity::SegmentPair& pair : pairs) {
        const Index a = pair.i, b = pair.j;  // one segment a fibre
        sum += a < own && b < own ? 1.0 : a < own || b < own ? 0.5 : 0.0;
    }
    return sum;
}

TEST_CASE("random fibres touch as often as the excluded volume says, and the search finds them all") {
    for (const bool planar : {false, true}) {
        mat::MatParameters parameters{.radius = 0.015, .length = 0.5, .width = 2.5, .height = 2.5, .fibres = 1000};
        parameters.tilt_deg = planar ? 0.0 : 90.0;
        const double sine = planar ? 2.0 / std::numbers::pi : std::numbers::pi / 4.0;
        const double expected = mat::expected_pairs(1000.0, 0.5, 0.03, sine, 2.5 * 2.5 * 2.5);
        double sum = 0.0;
        const int boxes = 4;
        for (int seed = 1; seed <= boxes; ++seed) {
            const Soft box = soft(parameters, static_cast<std::uint64_t>(seed), true);
            proximity::GridSearch grid;
            const auto pairs = grid.pairs(box.lines, 0.0);
            sum += periodic_pairs(pairs, box.own);
            if (seed > 1) continue;
            proximity::BruteSearch brute;
            CHECK(pairs == brute.pairs(box.lines, 0.0));
        }
        // Pairs of one box scatter by about 1.5 of the root of their number.
        const double sigma = 1.5 * std::sqrt(expected / boxes);
        std::printf("%s: %.1f pairs a box, %.1f by the excluded volume, %.2f sigma\n", planar ? "planar" : "isotropic",
                    sum / boxes, expected, (sum / boxes - expected) / sigma);
        CHECK(std::abs(sum / boxes - expected) < 3.0 * sigma);
    }
}

TEST_CASE("directions of a mat are uniform on the sphere, or on the part of it that tilt and spread leave") {
    // Archimedes: heights on a sphere are uniform, and independent of the azimuth. Kolmogorov's distance of n uniform numbers is
    // above 1.95 / sqrt(n) once in a thousand times.
    struct Directions {
        double tilt_deg, spread_deg;
    };
    for (const auto& [tilt_deg, spread_deg] : {Directions{90.0, 90.0}, {35.0, 90.0}, {35.0, 10.0}}) {
        mat::MatParameters parameters{.radius = 0.01,
                                      .length = 0.5,
                                      .width = 2.0,
                                      .height = 1.0,
                                      .fibres = 1,
                                      .tilt_deg = tilt_deg,
                                      .spread_deg = spread_deg};
        const double widest = (spread_deg < 90.0 ? spread_deg / 180.0 : 1.0) * std::numbers::pi;  // a fibre has two ends
        const std::size_t n = 20000;
        const double highest = std::sin(tilt_deg * std::numbers::pi / 180.0);
        mat::Draws draw(3);
        std::vector<double> height, azimuth;
        Vec3 middle = Vec3::Zero();
        double both = 0.0;
        for (std::size_t k = 0; k < n; ++k) {
            const mat::MatFibre fibre = mat::drawn_fibre(parameters, draw);
            CHECK(std::abs(fibre.along.norm() - 1.0) < 1e-14);
            height.push_back(0.5 * (1.0 + fibre.along.z() / highest)),
                azimuth.push_back(0.5 + std::atan2(fibre.along.y(), fibre.along.x()) / (2.0 * widest));
            both += 12.0 * (height.back() - 0.5) * (azimuth.back() - 0.5) / std::sqrt(static_cast<double>(n));
            middle += fibre.middle / static_cast<double>(n);
        }
        CHECK(std::abs(both) < 3.3);  // of a variance of 1
        for (auto* uniform : {&height, &azimuth}) {
            std::sort(uniform->begin(), uniform->end());
            double furthest = 0.0;
            for (std::size_t k = 0; k < n; ++k)
                furthest = std::max(furthest, std::abs((*uniform)[k] - (static_cast<double>(k) + 0.5) / static_cast<double>(n)));
            CHECK(furthest * std::sqrt(static_cast<double>(n)) < 1.95);
        }
        for (int k = 0; k < 3; ++k)
            CHECK(std::abs(middle[k] / (k < 2 ? 2.0 : 1.0) - 0.5) < 3.3 / std::sqrt(12.0 * static_cast<double>(n)));
    }
}

TEST_CASE("fibres of a mat are inside their box and apart from each other, the same for the same seed, others for another") {
    for (const double bend : {0.0, 90.0}) {
        mat::MatParameters parameters{.radius = 0.02, .length = 0.8, .width = 1.2, .height = 0.8, .fibres = 60};
        parameters.bend_deg = bend, parameters.tilt_deg = 40.0, parameters.material = {7300.0, 0.3};
        const auto fibres = mat::random_fibres(parameters), again = mat::random_fibres(parameters);
        parameters.seed = 2;
        const auto others = mat::random_fibres(parameters);
        REQUIRE(core::count(fibres) == 60);
        CHECK(fibres[17](0.3) == again[17](0.3));
        CHECK(fibres[17](0.3) != others[17](0.3));
        double nearest = 1e300, most = -1e300;
        for (std::size_t i = 0; i < fibres.size(); ++i) {
            double arc = 0.0;
            for (int a = 0; a <= 200; ++a) {
                const Vec3 x = fibres[i](a / 200.0);
                most = std::max({most, -x.minCoeff(), x.x() - 1.2, x.y() - 1.2, x.z() - 0.8});
                if (a > 0) arc += (x - fibres[i]((a - 1) / 200.0)).norm();
                for (std::size_t j = 0; j < i; ++j)
                    for (int b = 0; b <= 200; b += 2) nearest = std::min(nearest, (x - fibres[j](b / 200.0)).norm());
            }
            CHECK(arc == test::near(0.8, 1e-4));  // chords of a two-hundredth
        }
        CHECK(most <= -0.02 + 1e-3);
        // A chord of a piece is 4 r long: its arc of 90 / 10 degrees rises by a fiftieth of that at most.
        CHECK(nearest > 1.95 * 0.02);
    }
}

TEST_CASE(
    "a mat that is cut at its sides has as much fibre there as inside, of all directions of the plane, and the length that was "
    "asked for") {
    // Outside of the inner square are three quarters of the area, less the rim of a radius that no axis may reach. What is
    // shorter than a tenth of a fibre is left out at the sides: s^2 / pi of each length of side for one fibre an area, a 150th of
    // all that there is.
    const double width = 1.6, shortest = 0.08, reached = (width - 0.02) * (width - 0.02), inner = 0.25 * width * width;
    const double lost = 4.0 * (width - 0.02) * shortest * shortest / std::numbers::pi / 0.8;
    const double expected = (reached - inner - lost) / (reached - lost);
    const int boxes = 40;
    double sum = 0.0, squares = 0.0, cosine = 0.0;
    for (int seed = 1; seed <= boxes; ++seed) {
        mat::MatParameters parameters{.radius = 0.01,
                                      .length = 0.8,
                                      .width = width,
                                      .height = 0.8,
                                      .fibres = 60,
                                      .cut = true,
                                      .tilt_deg = 0.0,
                                      .clearance = -2.0,
                                      .material = {7300.0, 0.3}};
        parameters.seed = static_cast<std::uint64_t>(seed);
        double length = 0.0, near_sides = 0.0;
        for (const mat::MatFibre& fibre : mat::random_fibres(parameters)) {
            CHECK(fibre.length >= shortest * (1.0 - 1e-9));
            CHECK(fibre.length <= 0.8 * (1.0 + 1e-12));
            length += fibre.length;
            cosine += fibre.length * (2.0 * fibre.along.x() * fibre.along.x() - 1.0) / (48.0 * boxes);
            for (const double t : {0.0, 1.0})
                CHECK(std::min(fibre(t).head<2>().minCoeff(), width - fibre(t).head<2>().maxCoeff()) >= 0.01 * (1.0 - 1e-9));
            for (int k = 0; k < 100; ++k) {
                const Vec3 x = fibre((k + 0.5) / 100.0);
                if (std::max(std::abs(x.x() - 0.5 * width), std::abs(x.y() - 0.5 * width)) > 0.25 * width)
                    near_sides += fibre.length / 100.0;
            }
        }
        CHECK(length == test::near(48.0, 1e-9));
        sum += near_sides / length, squares += near_sides / length * near_sides / length;
    }
    const double share = sum / boxes, sigma = std::sqrt((squares / boxes - share * share) / (boxes - 1));
    std::printf(
        "cut mats: share near the sides %.4f, %.4f by the area, %.2f sigma of %.4f; mean cosine of twice the azimuth %.4f\n",
        share, expected, (share - expected) / sigma, sigma, cosine);
    CHECK(std::abs(share - expected) < 3.0 * sigma);
    CHECK(std::abs(cosine) < 3.0 * std::sqrt(0.5 / (60.0 * boxes)));  // of as many directions as there are lengths
}

TEST_CASE("stacked fibres touch a lid and a floor, are apart from each other, and lie as close as straight ones can") {
    mat::MatParameters parameters{.radius = 0.02,
                                  .length = 1.2,
                                  .width = 1.5,
                                  .height = 2.0,
                                  .fibres = 60,
                                  .cut = true,
                                  .tilt_deg = 0.0,
                                  .material = {7300.0, 0.3}};
    const mat::StackedMat tight = mat::stacked_fibres(parameters, 1.0), loose = mat::stacked_fibres(parameters, 1.1);
    CHECK(loose.height == test::near(1.1 * tight.height, 1e-12));
    const double reach = 2.02 * 0.02;  // two radii and the clearance
    for (const mat::StackedMat* stacked : {&tight, &loose}) {
        double nearest = 1e300, lowest = 1e300, highest = -1e300;
        const auto& fibres = stacked->fibres;
        for (std::size_t i = 0; i < fibres.size(); ++i) {
            lowest = std::min(lowest, fibres[i].middle.z()), highest = std::max(highest, fibres[i].middle.z());
            CHECK(fibres[i].along.z() == 0.0);
            for (std::size_t j = 0; j < i; ++j)
                nearest = std::min(nearest, proximity::segment_distance(fibres[i](0.0), fibres[i].length * fibres[i].along,
                                                                        fibres[j](0.0), fibres[j].length * fibres[j].along)
                                                .squared);
        }
        CHECK(std::sqrt(nearest) >= reach * (1.0 - 1e-9));
        CHECK(lowest >= 0.02 * (1.0 - 1e-9));
        CHECK(highest <= stacked->height - 0.02 * (1.0 - 1e-9));
        if (stacked ==
            &tight) {  // what cannot be lower holds the lid and the floor apart: a chain of fibres each of which touches the next
            CHECK(lowest == test::near(0.02, 1e-9));
            CHECK(highest == test::near(stacked->height - 0.02, 1e-9));
            CHECK(std::sqrt(nearest) == test::near(reach, 1e-9));
        }
    }
    std::printf("stacked: %.4f of the box is fibre\n", parameters.volume_fraction(tight.height));
    parameters.tilt_deg = 10.0;
    CHECK(test::refusal([&] { mat::stacked_fibres(parameters, 1.0); }).find("MatParameters.tilt_deg = 10") == 0);
    parameters.bend_deg = 20.0;
    CHECK(test::refusal([&] { parameters.validate(); }).find("MatParameters.bend_deg = 20") == 0);
}

TEST_CASE("no piece of fibres that are cut is longer than the sides of the box allow, and some are nearly as long") {
    for (const double tilt : {0.0, 30.0, 90.0})
        for (const double spread : {10.0, 90.0}) {
            mat::MatParameters parameters{.radius = 0.01,
                                          .length = 4.0,
                                          .width = 1.0,
                                          .height = 0.4,
                                          .fibres = 400,
                                          .cut = true,
                                          .tilt_deg = tilt,
                                          .spread_deg = spread,
                                          .clearance = -2.0,
                                          .material = {7300.0, 0.3}};
            const double most = mat::longest_piece(parameters);
            double longest = 0.0;
            for (const mat::MatFibre& piece : mat::random_fibres(parameters)) longest = std::max(longest, piece.length);
            CHECK(longest <= most * (1.0 + 1e-12));
            CHECK(longest >= 0.95 * most);  // of thousands of pieces, one in hundreds is so near to a diagonal
        }
    // A fibre of which a tenth is longer than any piece is to blame itself, not how many there are.
    mat::MatParameters parameters{.radius = 0.01,
                                  .length = 20.0,
                                  .width = 1.0,
                                  .height = 0.4,
                                  .fibres = 4,
                                  .cut = true,
                                  .tilt_deg = 0.0,
                                  .clearance = -2.0,
                                  .material = {7300.0, 0.3}};
    parameters.draws = 20000;
    REQUIRE(mat::shortest_piece * parameters.length > mat::longest_piece(parameters));
    const std::string refused = test::refusal([&] { mat::random_fibres(parameters); });
    CHECK(refused.find("MatParameters.length = 20, but it must be less, or width more: of 20000 fibres") == 0);
}

TEST_CASE(
    "few short fibres are drawn in a box as wide and high as may be, and one that fits in no box is refused by its length") {
    mat::MatParameters parameters{
        .radius = 0.02, .length = 0.04, .width = 2000.0, .height = 2000.0, .fibres = 3, .material = {7300.0, 0.3}};
    CHECK(mat::random_fibres(parameters).size() == 3);  // cells of the size of a fibre would take 2e14 bytes
    parameters.width = parameters.height = 0.041, parameters.length = 0.4, parameters.draws = 2000;
    const std::string refused = test::refusal([&] { mat::random_fibres(parameters); });
    CHECK(refused.find("MatParameters.length = 0.4, but it must be less, or width or height more: of 2000 fibres") == 0);
}

TEST_CASE("a box that is full, and what is not a mat, is refused by name") {
    mat::MatParameters parameters{
        .radius = 0.02, .length = 0.8, .width = 1.2, .height = 0.2, .fibres = 1000, .material = {7300.0, 0.3}};
    parameters.draws = 20000;
    const std::string full = test::refusal([&] { mat::random_fibres(parameters); });
    CHECK(full.find("MatParameters.fibres = 1000, but it must be at most ") == 0);
    parameters.spread_deg = -1.0;
    CHECK(test::refusal([&] { parameters.validate(); }).find("MatParameters.spread_deg = -1") == 0);
    parameters.tilt_deg = 100.0;
    CHECK(test::refusal([&] { parameters.validate(); }).find("MatParameters.tilt_deg = 100") == 0);
}

}  // namespace random_mat_test
