// SPDX-License-Identifier: MIT
#pragma once
/// @file Sets of fibres for the search benchmark: scene files of both forms, and a random mat.

#include <fibrant/proximity/proximity_search.hpp>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace fibrant::benchmarks {

/// Fibres that own their vertices.
struct Scene {
    std::string name;
    double margin = 0.0;
    std::uint64_t self_skip = 0;  ///< segments
    std::vector<std::vector<Vec3>> points{};
    std::vector<double> radius{};

    std::size_t segments() const {
        std::size_t sum = 0;
        for (const auto& line : points) sum += line.size() - 1;
        return sum;
    }
    /// Cuts each segment into n.
    void refine(int n) {
        self_skip *= static_cast<std::uint64_t>(n);
        for (auto& line : points) {
            std::vector<Vec3> fine{line.front()};
            for (std::size_t k = 1; k < line.size(); ++k)
                for (int part = 1; part <= n; ++part) fine.push_back(line[k - 1] + (line[k] - line[k - 1]) * (static_cast<double>(part) / n));
            line = fine;
        }
    }
    /// @param self  fibres pair with themselves too, by self_skip
    std::vector<proximity::Centreline> centrelines(bool self) const {
        std::vector<proximity::Centreline> lines(points.size());
        for (std::size_t f = 0; f < points.size(); ++f) {
            lines[f].points = points[f];
            lines[f].radius = radius[f];
            double length = 0.0;
            for (std::size_t k = 1; k < points[f].size(); ++k) length += (points[f][k] - points[f][k - 1]).norm();
            // |i - j| > skip on segments of one length: half a segment below the arc of skip segments between them.
            if (self) lines[f].self_skip = (static_cast<double>(self_skip) - 0.5) * length / static_cast<double>(points[f].size() - 1);
        }
        return lines;
    }
};

namespace detail {

template <class T>
void read(std::ifstream& in, T* values, std::size_t n) {
    in.read(reinterpret_cast<char*>(values), static_cast<std::streamsize>(n * sizeof(T)));
    if (!in) throw std::runtime_error("the scene file ends too early");
}

}  // namespace detail

/// .fpl, little endian: 8 bytes FIBPOL01; u64 fibres F, vertices V; f64 margin; u64 self_skip; F f64 radii; F + 1 u64 first
/// vertices; 3 V f64 coordinates. .fpt, text: "FIBPOL 1", "F V margin self_skip", then "n radius" and n lines "x y z" a fibre.
inline Scene read_scene(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error(path + " cannot be read");
    const std::size_t slash = path.find_last_of('/'), start = slash == std::string::npos ? 0 : slash + 1;
    Scene scene{.name = path.substr(start, path.find_last_of('.') - start)};
    std::uint64_t fibres = 0, vertices = 0;
    std::string magic(8, ' ');
    detail::read(in, magic.data(), 8);
    if (magic == "FIBPOL 1") {
        in >> fibres >> vertices >> scene.margin >> scene.self_skip;
        for (std::uint64_t f = 0; f < fibres && in; ++f) {
            std::size_t n = 0;
            in >> n >> scene.radius.emplace_back();
            for (Vec3& x : scene.points.emplace_back(n, Vec3::Zero())) in >> x[0] >> x[1] >> x[2];
        }
        if (!in) throw std::runtime_error(path + " ends too early");
        return scene;
    }
    if (magic != "FIBPOL01") throw std::runtime_error(path + " is no scene file");
    detail::read(in, &fibres, 1);
    detail::read(in, &vertices, 1);
    detail::read(in, &scene.margin, 1);
    detail::read(in, &scene.self_skip, 1);
    scene.radius.resize(fibres);
    detail::read(in, scene.radius.data(), fibres);
    std::vector<std::uint64_t> first(fibres + 1);
    detail::read(in, first.data(), fibres + 1);
    scene.points.resize(fibres);
    for (std::size_t f = 0; f < fibres; ++f) {
        scene.points[f].resize(first[f + 1] - first[f]);
        detail::read(in, scene.points[f].front().data(), 3 * scene.points[f].size());
    }
    return scene;
}

/// Random curved fibres of 64 segments of 4 r that fill 10 % of a cube, overlaps allowed; seed 1.
/// @param segments  about so many
inline Scene random_mat(std::size_t segments) {
    const double r = 1.0, length = 4.0 * r, curl = 0.12, fraction = 0.1;
    const std::size_t each = 64, fibres = std::max<std::size_t>(1, segments / each);
    const double box = std::cbrt(static_cast<double>(fibres * each) * length * std::numbers::pi * r * r / fraction);
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> place(0.0, box);
    std::normal_distribution<double> normal;
    const auto vector = [](auto& draw, auto& from) {
        const double x = draw(from), y = draw(from), z = draw(from);
        return Vec3(x, y, z);
    };
    Scene scene{.name = "mat" + std::to_string(fibres * each), .margin = 0.5 * r, .self_skip = 3};
    for (std::size_t f = 0; f < fibres; ++f) {
        std::vector<Vec3> line{vector(place, random)};
        Vec3 direction = vector(normal, random).normalized();
        for (std::size_t k = 0; k < each; ++k) {
            line.push_back(line.back() + length * direction);
            direction = (direction + curl * vector(normal, random)).normalized();
        }
        scene.points.push_back(std::move(line));
        scene.radius.push_back(r);
    }
    return scene;
}

}  // namespace fibrant::benchmarks
