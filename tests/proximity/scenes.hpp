// SPDX-License-Identifier: MIT
#pragma once
/// @file Sets of fibres on which the searches are compared.

#include "../support/random_vector.hpp"

#include <fibrant/proximity/proximity_search.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace fibrant::test {

/// Fibres that own their vertices.
struct FibreSet {
    std::string name;
    double reach = 0.0;
    std::vector<std::vector<Vec3>> points{};
    std::vector<double> radius{};
    std::vector<std::vector<double>> inflation{};  ///< empty: none
    std::vector<Index> family{};                   ///< empty: none
    double self_skip = std::numeric_limits<double>::infinity();

    void add(std::vector<Vec3> line, double r) {
        points.push_back(std::move(line));
        radius.push_back(r);
    }
    std::vector<proximity::Centreline> centrelines() const {
        std::vector<proximity::Centreline> lines(points.size());
        for (std::size_t f = 0; f < points.size(); ++f) {
            lines[f].points = points[f];
            lines[f].radius = radius[f];
            if (!inflation.empty()) lines[f].inflation = inflation[f];
            if (!family.empty()) lines[f].family = family[f];
            lines[f].self_skip = self_skip;
        }
        return lines;
    }
    FibreSet turned(const Mat3& rotation, const Vec3& shift) const {
        FibreSet other = *this;
        other.name += ", turned";
        for (auto& line : other.points)
            for (Vec3& x : line) x = rotation * x + shift;
        return other;
    }
};

/// A random walk of segments that keeps its direction more or less.
inline std::vector<Vec3> random_fibre(std::mt19937& random, int segments, double length, double curl, const Vec3& start) {
    std::vector<Vec3> line{start};
    Vec3 direction = uniform_vector(random).normalized();
    for (int k = 0; k < segments; ++k) {
        direction = (direction + curl * uniform_vector(random)).normalized();
        line.push_back(line.back() + length * direction);
    }
    return line;
}

inline FibreSet random_fibres(unsigned seed, int fibres, int segments, double length, double curl, double box) {
    std::mt19937 random(seed);
    FibreSet set{.name = "random fibres " + std::to_string(seed), .reach = 0.03};
    for (int f = 0; f < fibres; ++f) {
        const Vec3 start = box * uniform_vector(random);
        set.add(random_fibre(random, segments, length, curl, start), 0.05);
    }
    return set;
}

/// Every kind of arrangement that has broken a search: one set each.
inline std::vector<FibreSet> search_cases() {
    std::vector<FibreSet> cases;
    cases.push_back(random_fibres(1, 60, 20, 0.2, 0.4, 1.0));
    cases.push_back(random_fibres(2, 200, 3, 0.5, 0.1, 1.5));
    cases.push_back({.name = "no fibre"});
    {
        FibreSet set{.name = "two fibres of one segment", .reach = 0.1};
        set.add({{-1, 0, 0}, {1, 0, 0}}, 0.1);
        set.add({{0, -1, 0.25}, {0, 1, 0.25}}, 0.1);
        cases.push_back(set);
    }
    {
        FibreSet set{.name = "parallel fibres on a square lattice, neighbours just within reach", .reach = 0.0101};
        for (int a = 0; a < 8; ++a)
            for (int b = 0; b < 8; ++b) {
                std::vector<Vec3> line;
                for (int k = 0; k <= 12; ++k) line.push_back({0.25 * k + 0.01 * a, 0.21 * a, 0.21 * b});
                if ((a + b) % 2 == 1) std::ranges::reverse(line);
                set.add(line, 0.1);
            }
        cases.push_back(set);
        // Oblique, so that the principal frame is taken.
        cases.push_back(set.turned(Eigen::AngleAxisd(0.9, Vec3(1, 2, 3).normalized()).toRotationMatrix(), {3, -5, 40}));
    }
    {
        FibreSet set{.name = "two layers of crossing fibres", .reach = 0.02};
        for (int a = 0; a < 15; ++a) {
            std::vector<Vec3> along, across;
            for (int k = 0; k <= 30; ++k) {
                along.push_back({0.1 * k, 0.2 * a, 0.0});
                across.push_back({0.2 * a, 0.1 * k, 0.15 + 0.1 * std::sin(a + k)});
            }
            set.add(along, 0.05);
            set.add(across, 0.05);
        }
        cases.push_back(set);
    }
    {
        FibreSet set{.name = "a coil that lies on itself", .reach = 0.02};
        std::vector<Vec3> coil;
        for (int k = 0; k <= 600; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / 40.0;
            coil.push_back({std::cos(angle), std::sin(angle), 0.1 * k / 40.0});
        }
        set.add(coil, 0.05);
        std::mt19937 random(5);
        for (int f = 0; f < 4; ++f) set.add(random_fibre(random, 200, 0.1, 0.9, Vec3::Zero()), 0.05);
        set.self_skip = 0.4;
        cases.push_back(set);
        set.name = "the coil, with all but neighbouring segments";
        set.self_skip = 0.05;
        cases.push_back(set);
        set = {.name = "fine segments, whose neighbours but one already pair", .reach = 0.02};
        set.add(random_fibre(random, 300, 0.02, 0.3, Vec3::Zero()), 0.05);
        set.self_skip = 0.015;
        cases.push_back(set);
    }
    {
        FibreSet set{.name = "radii from 0.01 to 1, lengths from 0.02 to 10", .reach = 0.01};
        std::mt19937 random(7);
        for (int f = 0; f < 80; ++f) {
            const double r = std::pow(10.0, -2.0 + (f % 5) * 0.5), length = 0.02 * std::pow(10.0, (f % 10) * 0.3);
            const Vec3 start = 3.0 * uniform_vector(random);
            set.add(random_fibre(random, 1 + f % 7, length, 0.3, start), r);
        }
        cases.push_back(set);
    }
    {
        FibreSet set{.name = "many thin fibres and a few thick ones", .reach = 0.01};
        std::mt19937 random(8);
        for (int f = 0; f < 150; ++f) {
            const Vec3 start = uniform_vector(random);
            set.add(random_fibre(random, 10, 0.05, 0.3, start), 0.01);
        }
        for (int f = 0; f < 3; ++f) {
            const Vec3 start = uniform_vector(random);
            set.add(random_fibre(random, 4, 0.6, 0.3, start), 0.4);
        }
        cases.push_back(set);
    }
    {
        FibreSet set{.name = "long thin rods", .reach = 0.002};
        std::mt19937 random(9);
        for (int f = 0; f < 300; ++f) {
            const Vec3 start = 0.7 * uniform_vector(random);
            set.add(random_fibre(random, 2, 0.8, 0.03, start), 0.002);
        }
        cases.push_back(set);
    }
    {
        FibreSet set{.name = "fibres that coincide, and segments without length", .reach = 0.05};
        const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
        for (int f = 0; f < 3; ++f) set.add(line, 0.1);
        std::vector<Vec3> back(line.rbegin(), line.rend());
        set.add(back, 0.1);
        set.add({{1, 0, 0}, {1, 0, 0}}, 0.1);
        cases.push_back(set);
    }
    {
        FibreSet set = random_fibres(11, 60, 10, 0.2, 0.2, 0.8);
        set.name = "families, inflated";
        std::mt19937 random(12);
        std::uniform_real_distribution<double> uniform(0.0, 0.05);
        for (std::size_t f = 0; f < set.points.size(); ++f) {
            set.family.push_back(static_cast<Index>(f % 4) - 1);
            set.inflation.emplace_back();
            for (std::size_t k = 0; k + 1 < set.points[f].size(); ++k) set.inflation[f].push_back(uniform(random));
        }
        cases.push_back(set);
    }
    {
        FibreSet set = random_fibres(13, 40, 10, 0.2, 0.2, 0.6);
        set.name = "a crowd, with one fibre far away";
        set.add({{1e6, 2e6, -3e6}, {1e6, 2e6, -3e6 + 1}}, 0.05);
        cases.push_back(set);
    }
    {
        FibreSet set = random_fibres(15, 30, 10, 0.2, 0.2, 0.6);
        set.name = "two crowds and some fibres very far apart from each other, at a slant";
        const FibreSet other = random_fibres(16, 30, 10, 0.2, 0.2, 0.6).turned(Mat3::Identity(), {3e9, -1e3, 2e11});
        for (std::size_t f = 0; f < other.points.size(); ++f) set.add(other.points[f], other.radius[f]);
        for (const double far : {1e4, 1e7, 1e12})
            set.add({{far, 0.1, 0.2}, {far, 0.1, 1.2}}, 0.05), set.add({{far, 0.15, 0.2}, {far, 0.15, 1.2}}, 0.05);
        cases.push_back(set.turned(Eigen::AngleAxisd(0.7, Vec3(1, -2, 2).normalized()).toRotationMatrix(), {1, 2, 3}));
    }
    {
        FibreSet set{.name = "a hundred times as thick ones and thin ones, as many of each", .reach = 0.01};
        std::mt19937 random(17);
        for (int f = 0; f < 60; ++f) {
            const Vec3 start = 20.0 * uniform_vector(random);
            const double r = f % 2 == 0 ? 1.0 : 0.01;
            set.add(random_fibre(random, 12, 4.0 * r, 0.3,
                                 f % 2 == 0 ? start : Vec3(set.points.back()[5] + 0.8 * uniform_vector(random))),
                    r);
        }
        cases.push_back(set);
    }
    {
        FibreSet set{.name = "a tow of straight fibres 2,000 radii long, one segment each", .reach = 0.05};
        for (int f = 0; f < 49; ++f) set.add({{2.02 * (f % 7), 2.02 * (f / 7), 0.0}, {2.02 * (f % 7), 2.02 * (f / 7), 2e3}}, 1.0);
        set.add({{0, 0, 1e3}, {14, 3, 1e3 + 1}}, 1.0);
        cases.push_back(set);
    }
    cases.push_back(random_fibres(14, 300, 10, 0.1, 0.3, 1.0)
                        .turned(Eigen::AngleAxisd(2.0, Vec3(-1, 1, 0.3).normalized()).toRotationMatrix(), {-100, 7, 0.5}));
    return cases;
}

}  // namespace fibrant::test
