// SPDX-License-Identifier: MIT
#pragma once
/// @file Sets of fibres for the search benchmark: files of centrelines, scene files of two forms, and a random mat.

#include <fibrant/exchange/files.hpp>
#include <fibrant/proximity/proximity_search.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
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
                for (int part = 1; part <= n; ++part)
                    fine.push_back(line[k - 1] + (line[k] - line[k - 1]) * (static_cast<double>(part) / n));
            line = fine;
        }
    }
    /// Sets a copy beside all there is, so that boxes around both meet where they are shortest: twice as much, as dense.
    void double_up() {
        Vec3 low = points.front().front(), high = low;
        for (const auto& line : points)
            for (const Vec3& x : line) low = low.cwiseMin(x), high = high.cwiseMax(x);
        Index axis = 0;
        const double thickest = 2.0 * *std::max_element(radius.begin(), radius.end()),
                     shortest = (high - low).minCoeff(&axis) + thickest;
        const std::size_t n = points.size();
        for (std::size_t f = 0; f < n; ++f) {
            points.push_back(points[f]), radius.push_back(radius[f]);
            for (Vec3& x : points.back()) x[axis] += shortest;
        }
    }
    /// @throws std::invalid_argument naming the file and the first fibre that is not as in another scene
    void require_fibres_of(const Scene& other, const std::string& file) const;
    /// @param self  fibres pair with themselves too, by self_skip
    std::vector<proximity::Centreline> centrelines(bool self) const {
        std::vector<proximity::Centreline> lines(points.size());
        for (std::size_t f = 0; f < points.size(); ++f) {
            lines[f].points = points[f];
            lines[f].radius = radius[f];
            double length = 0.0;
            for (std::size_t k = 1; k < points[f].size(); ++k) length += (points[f][k] - points[f][k - 1]).norm();
            // |i - j| > skip on segments of one length: half a segment below the arc of skip segments between them.
            if (self)
                lines[f].self_skip = (static_cast<double>(self_skip) - 0.5) * length / static_cast<double>(points[f].size() - 1);
        }
        return lines;
    }
};

namespace detail {

template <class T>
void read(std::ifstream& in, const std::string& path, T* values, std::size_t n) {
    in.read(reinterpret_cast<char*>(values), static_cast<std::streamsize>(n * sizeof(T)));
    if (!in) exchange::refuse_file(path, "", "ends too early");
}
inline std::string of_fibre(std::uint64_t f) { return "fibre " + std::to_string(f); }

/// Text: "FIBPOL 1" has been read.
inline void read_text(std::ifstream& in, const std::string& path, Scene& scene) {
    std::uint64_t fibres = 0, vertices = 0;
    const auto number = [&](auto& value, const std::string& place) {
        if (!(in >> value)) exchange::refuse_file(path, place, in.eof() ? "ends too early" : "is no number that can be used");
    };
    number(fibres, "fibres"), number(vertices, "vertices"), number(scene.margin, "margin"), number(scene.self_skip, "self_skip");
    for (std::uint64_t f = 0; f < fibres; ++f) {
        std::size_t n = 0;
        number(n, of_fibre(f) + ", vertices"), number(scene.radius.emplace_back(), of_fibre(f) + ", radius");
        scene.points.emplace_back();
        for (std::size_t k = 0; k < n; ++k)  // one by one: a wrong number must not take all memory
            for (double& x : scene.points.back().emplace_back(Vec3::Zero()))
                number(x, of_fibre(f) + ", vertex " + std::to_string(k));
    }
}
/// Little endian: "FIBPOL01" has been read.
inline void read_binary(std::ifstream& in, const std::string& path, Scene& scene) {
    std::uint64_t fibres = 0, vertices = 0;
    read(in, path, &fibres, 1), read(in, path, &vertices, 1), read(in, path, &scene.margin, 1),
        read(in, path, &scene.self_skip, 1);
    const std::uint64_t bytes = std::filesystem::file_size(path);
    if (fibres > bytes / 8 || vertices > bytes / 24)
        exchange::refuse_file(path, "", "ends too early for its " + std::to_string(fibres) + " fibres");
    scene.radius.resize(fibres);
    if (fibres > 0) read(in, path, scene.radius.data(), fibres);
    std::vector<std::uint64_t> first(fibres + 1);
    read(in, path, first.data(), fibres + 1);
    scene.points.resize(fibres);
    for (std::size_t f = 0; f < fibres; ++f) {
        if (first[f + 1] < first[f] || first[f + 1] > vertices)
            exchange::refuse_file(path, of_fibre(f), "its first vertices do not increase");
        scene.points[f].resize(first[f + 1] - first[f]);
        if (!scene.points[f].empty()) read(in, path, scene.points[f].front().data(), 3 * scene.points[f].size());
    }
}

}  // namespace detail

inline void Scene::require_fibres_of(const Scene& other, const std::string& file) const {
    const auto need = [&](const std::string& place, const std::string& what, auto own, auto wanted) {
        if (own != wanted)
            exchange::refuse_file(file, place,
                                  what + " = " + core::text(static_cast<double>(own)) + ", but " + other.name + " has " +
                                      core::text(static_cast<double>(wanted)));
    };
    need("", "fibres", points.size(), other.points.size());
    for (std::size_t f = 0; f < points.size(); ++f) {
        need(detail::of_fibre(f), "vertices", points[f].size(), other.points[f].size());
        need(detail::of_fibre(f), "radius", radius[f], other.radius[f]);
    }
}

/// A scene of any file of centrelines that the toolkit reads (.csv .vtk .vtp .obj .bcc .inp .tg3), or of a scene file.
/// .fpl, little endian: 8 bytes FIBPOL01; u64 fibres F, vertices V; f64 margin; u64 self_skip; F f64 radii; F + 1 u64 first
/// vertices; 3 V f64 coordinates. .fpt, text: "FIBPOL 1", "F V margin self_skip", then "n radius" and n lines "x y z" a fibre.
/// @param radius  of files that have none [length]
/// @throws std::invalid_argument naming file, fibre and vertex
inline Scene read_scene(const std::string& path, double radius) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::invalid_argument(path + ": cannot be read");
    Scene scene{.name = std::filesystem::path(path).stem().string()};
    std::string magic(8, ' ');
    in.read(magic.data(), 8);
    if (in && magic == "FIBPOL 1")
        detail::read_text(in, path, scene);
    else if (in && magic == "FIBPOL01")
        detail::read_binary(in, path, scene);
    else {
        exchange::CleanParameters clean;
        clean.least_points = 2, clean.largest_turn_deg = 180.0;
        for (const exchange::FileCurve& curve : exchange::read_curves(path, clean)) {
            scene.points.push_back(curve.points);
            if (curve.closed) scene.points.back().push_back(curve.points.front());
            scene.radius.push_back(std::isnan(curve.radius) ? radius : curve.radius);
            if (std::isnan(scene.radius.back())) exchange::refuse_file(path, "", "has no radii: --radius");
        }
        scene.margin = 0.5 * *std::min_element(scene.radius.begin(), scene.radius.end()), scene.self_skip = 3;
    }
    if (scene.points.empty()) exchange::refuse_file(path, "", "has no fibres");
    for (std::size_t f = 0; f < scene.points.size(); ++f)
        if (scene.points[f].size() < 2)
            exchange::refuse_file(path, detail::of_fibre(f),
                                  "has " + std::to_string(scene.points[f].size()) + " vertices, but it needs 2");
    return scene;
}

/// Curved fibres of segments of 4 radii at random, overlaps allowed, that turn back at the walls of a cube where they then stay
/// inside.
class RandomFibres {
public:
    explicit RandomFibres(double box) : box_(box) {}

    void add(Scene& scene, double r, std::size_t segments) {
        std::uniform_real_distribution<double> place(0.0, box_);
        const double length = 4.0 * r, curl = 0.12;
        std::vector<Vec3> line{vector(place)};
        Vec3 direction = vector(normal_).normalized();
        for (std::size_t k = 0; k < segments; ++k) {
            Vec3 next = line.back() + length * direction;
            for (Index axis = 0; axis < 3; ++axis) {
                const double back = line.back()[axis] - length * direction[axis];
                if (inside(next[axis]) || !inside(back)) continue;
                direction[axis] = -direction[axis], next[axis] = back;
            }
            line.push_back(next);
            direction = (direction + curl * vector(normal_)).normalized();
        }
        scene.points.push_back(std::move(line));
        scene.radius.push_back(r);
    }

private:
    bool inside(double x) const { return x >= 0.0 && x <= box_; }
    template <class Draw>
    Vec3 vector(Draw& draw) {
        const double x = draw(random_), y = draw(random_), z = draw(random_);
        return Vec3(x, y, z);
    }

    double box_;
    std::mt19937_64 random_{1};
    std::normal_distribution<double> normal_;
};

/// Side of a cube of which fibres of segments of 4 radii fill 10 %.
/// @param cubes  sum over segments of their radii to the third power
inline double box_of(double cubes) { return std::cbrt(cubes * 4.0 * std::numbers::pi / 0.1); }

/// Random curved fibres of 64 segments of 4 r that fill 10 % of a cube: as dense in any number.
/// @param segments  about so many
inline Scene random_mat(std::size_t segments) {
    const std::size_t each = 64, fibres = std::max<std::size_t>(1, segments / each);
    Scene scene{.name = "mat" + std::to_string(fibres * each), .margin = 0.5, .self_skip = 3};
    RandomFibres random(box_of(static_cast<double>(fibres * each)));
    for (std::size_t f = 0; f < fibres; ++f) random.add(scene, 1.0, each);
    return scene;
}

/// Fibres of two sizes, of 16 segments each.
struct Mixture {
    std::size_t thick, thin;
    double ratio;  ///< of their radii
    bool dense;    ///< thin ones alone fill 10 % of a cube, else all do
};
inline Scene random_mixture(const Mixture& mixture) {
    const auto& [thick, thin, ratio, dense] = mixture;
    const std::size_t each = 16;
    Scene scene{.name = std::to_string(thick) + " thick; " + std::to_string(thin) + " thin; " + core::text(ratio) + " : 1" +
                        (dense ? "; dense" : ""),
                .margin = 0.5,
                .self_skip = 3};
    const auto cubes = static_cast<double>(each) *
                       (static_cast<double>(thin) + (dense ? 0.0 : static_cast<double>(thick) * ratio * ratio * ratio));
    RandomFibres random(box_of(cubes));
    for (std::size_t f = 0; f < thick + thin; ++f) random.add(scene, f < thick ? ratio : 1.0, each);
    return scene;
}

}  // namespace fibrant::benchmarks
