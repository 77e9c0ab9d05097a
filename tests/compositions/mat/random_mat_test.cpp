// SPDX-License-Identifier: MIT
// Random fibres: as many pairs as the excluded volume says, as many as brute force finds, and none in another one where they may not be.
#include <fibrant/compositions/mat/random_mat.hpp>
#include <fibrant/proximity/brute_search.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <refusal.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

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
                        if (middle.minCoeff() > -margin && middle.maxCoeff() < w + margin) soft.ends.push_back({fibre(0.0) + shift, fibre(1.0) + shift});
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
        // Pairs of one box scatter by about 1.5 of the root of their number (METHOD 9.2, C2).
        const double sigma = 1.5 * std::sqrt(expected / boxes);
        std::printf("%s: %.1f pairs a box, %.1f by the excluded volume, %.2f sigma\n", planar ? "planar" : "isotropic", sum / boxes, expected, (sum / boxes - expected) / sigma);
        CHECK(std::abs(sum / boxes - expected) < 3.0 * sigma);
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
            CHECK(arc == doctest::Approx(0.8).epsilon(1e-4));  // chords of a two-hundredth
        }
        CHECK(most <= -0.02 + 1e-3);
        // A chord of a piece is 4 r long: its arc of 90 / 10 degrees rises by a fiftieth of that at most.
        CHECK(nearest > 1.95 * 0.02);
    }
}

TEST_CASE("a box that is full, and what is not a mat, is refused by name") {
    mat::MatParameters parameters{.radius = 0.02, .length = 0.8, .width = 1.2, .height = 0.2, .fibres = 1000, .material = {7300.0, 0.3}};
    parameters.draws = 20000;
    const std::string full = test::refusal([&] { mat::random_fibres(parameters); });
    CHECK(full.find("MatParameters.fibres = 1000, but it must be at most ") == 0);
    parameters.tilt_deg = 100.0;
    CHECK(test::refusal([&] { parameters.validate(); }).find("MatParameters.tilt_deg = 100") == 0);
}

}  // namespace random_mat_test
