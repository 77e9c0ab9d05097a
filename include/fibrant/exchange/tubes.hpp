// SPDX-License-Identifier: MIT
#pragma once
/// @file Fibres as closed surfaces of triangles: for viewers as glTF (.glb), for meshers as STL.

#include <fibrant/exchange/curves.hpp>
#include <fibrant/observe/text_file.hpp>
#include <fibrant/scene/reference_shape.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace fibrant::exchange {

/// Triangles over points; seen from outside they go round anticlockwise.
struct Surface {
    std::vector<Vec3> points{};
    std::vector<std::array<std::uint32_t, 3>> triangles{};

    /// Volume inside, > 0 where all triangles look outwards [length^3].
    double volume() const {
        double sum = 0.0;
        const Vec3 origin = points.empty() ? Vec3(Vec3::Zero()) : points.front();
        for (const auto& t : triangles)
            sum += (points[t[0]] - origin).dot((points[t[1]] - origin).cross(points[t[2]] - origin)) / 6.0;
        return sum;
    }
};

/// Unit tangents of a polyline, and directions across it.
struct LineFrames {
    std::vector<Vec3> tangent{}, first{}, second{};
};

/// Frames at the points of a line: carried along by the least turn from point to point; round a closed line the turn that is left
/// over is shared out evenly.
/// @param points  >= 2, neighbours apart
inline LineFrames frames_of(const std::vector<Vec3>& points, bool closed) {
    const std::vector<Vec3>& p = points;
    const std::size_t n = p.size();
    core::require_at_least("frames_of.points", core::count(p), 2);
    LineFrames frames{std::vector<Vec3>(n), std::vector<Vec3>(n), std::vector<Vec3>(n)};
    std::vector<Vec3>&tangent = frames.tangent, &g = frames.first;
    for (std::size_t k = 0; k < n; ++k) {
        const Vec3 before = k > 0 ? p[k] - p[k - 1] : closed ? p[0] - p[n - 1] : p[1] - p[0];
        const Vec3 after = k + 1 < n ? p[k + 1] - p[k] : closed ? p[0] - p[k] : p[k] - p[k - 1];
        tangent[k] = (before.normalized() + after.normalized()).normalized();
    }
    const auto carried = [](const Vec3& v, const Vec3& from, const Vec3& to) {
        const Vec3 axis = from.cross(to);
        const double cosine = from.dot(to);
        return Vec3(v + axis.cross(v) + axis.cross(axis.cross(v)) / (1.0 + cosine));
    };
    g[0] = scene::any_perpendicular(tangent[0]);
    for (std::size_t k = 1; k < n; ++k) g[k] = carried(g[k - 1], tangent[k - 1], tangent[k]).normalized();
    double turn = 0.0;
    if (closed) {
        const Vec3 end = carried(g[n - 1], tangent[n - 1], tangent[0]);
        turn = std::atan2(tangent[0].dot(end.cross(g[0])), end.dot(g[0])) / static_cast<double>(n);
    }
    for (std::size_t k = 0; k < n; ++k) {
        const Vec3 across = tangent[k].cross(g[k]);
        const double angle = turn * static_cast<double>(k);
        if (closed) g[k] = Vec3(std::cos(angle) * g[k] + std::sin(angle) * across);
        frames.second[k] = tangent[k].cross(g[k]);
    }
    return frames;
}

/// Adds a surface through rings of points, as many in each, that go round the line's tangent anticlockwise. The ends of an open
/// one are closed by fans.
/// @param middles  of the first and the last ring
inline void add_loft(Surface& surface, const std::vector<std::vector<Vec3>>& rings, bool closed,
                     const std::array<Vec3, 2>& middles) {
    const auto first = static_cast<std::uint32_t>(surface.points.size()), s = static_cast<std::uint32_t>(rings.front().size()),
               count = static_cast<std::uint32_t>(rings.size());
    for (const std::vector<Vec3>& ring : rings) surface.points.insert(surface.points.end(), ring.begin(), ring.end());
    for (std::uint32_t k = 0; k + (closed ? 0 : 1) < count; ++k)
        for (std::uint32_t a = 0; a < s; ++a) {
            const std::uint32_t i = first + k * s, j = first + (k + 1) % count * s, b = (a + 1) % s;
            surface.triangles.push_back({i + a, i + b, j + b}), surface.triangles.push_back({i + a, j + b, j + a});
        }
    if (closed) return;
    for (const bool last : {false, true}) {
        const auto middle = static_cast<std::uint32_t>(surface.points.size());
        surface.points.push_back(middles[last ? 1 : 0]);
        const std::uint32_t i = first + (last ? count - 1 : 0) * s;
        for (std::uint32_t a = 0; a < s; ++a) {
            const std::uint32_t b = (a + 1) % s;
            if (last)
                surface.triangles.push_back({middle, i + a, i + b});
            else
                surface.triangles.push_back({middle, i + b, i + a});
        }
    }
}

/// Adds a curve as a tube of so many sides, whose polygon has the area of its circle; ends are flat.
/// @param sides  >= 3
inline void add_tube(Surface& surface, const FileCurve& curve, Index sides) {
    core::require_at_least("add_tube.sides", sides, 3);
    core::require_positive("FileCurve.radius", curve.radii.empty() ? curve.radius : curve.radii.front());
    const LineFrames frames = frames_of(curve.points, curve.closed);
    const double m = static_cast<double>(sides), full = 2.0 * std::numbers::pi;
    const double wider = std::sqrt(full / m / std::sin(full / m));  // circle over inscribed polygon, by area
    std::vector<std::vector<Vec3>> rings(curve.points.size());
    for (std::size_t k = 0; k < rings.size(); ++k) {
        const double radius = wider * (curve.radii.empty() ? curve.radius : curve.radii[k]);
        for (Index a = 0; a < sides; ++a) {
            const double angle = full * static_cast<double>(a) / m;
            const Vec3 across = std::cos(angle) * frames.first[k] + std::sin(angle) * frames.second[k];
            rings[k].push_back(curve.points[k] + radius * across);
        }
    }
    add_loft(surface, rings, curve.closed, {curve.points.front(), curve.points.back()});
}

namespace detail {
template <class Number>
void put(std::string& bytes, Number value) {
    static_assert(std::endian::native == std::endian::little, "the files are little-endian");
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}
}  // namespace detail

/// Binary STL: single precision.
inline std::string stl_of(const Surface& surface) {
    std::string bytes = "binary STL of fibres";
    bytes.resize(80, ' ');
    detail::put(bytes, static_cast<std::uint32_t>(surface.triangles.size()));
    for (const auto& t : surface.triangles) {
        const Vec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]], normal = (b - a).cross(c - a);
        const double size = normal.norm();
        for (const Vec3& v : {size > 0.0 ? Vec3(normal / size) : Vec3(Vec3::Zero()), a, b, c})
            for (const double x : v) detail::put(bytes, static_cast<float>(x));
        detail::put(bytes, std::uint16_t{0});
    }
    return bytes;
}
inline std::string stl_of(const std::vector<FileCurve>& curves, Index sides = 12) {
    Surface surface;
    for (const FileCurve& curve : curves) add_tube(surface, curve, sides);
    return stl_of(surface);
}

/// glTF 2.0 in one file (Khronos 2021): a mesh a group of curves, with a colour of its own; y is up, lengths are metres.
/// @param metre  one metre in the unit of the curves, 1000 for millimetres
inline std::string glb_of(const std::vector<FileCurve>& curves, double metre = 1000.0, Index sides = 8) {
    core::require_positive("glb_of.metre", metre);
    static constexpr std::array<std::array<double, 3>, 6> colours{
        {{0.20, 0.40, 0.75}, {0.85, 0.45, 0.15}, {0.30, 0.60, 0.30}, {0.70, 0.25, 0.35}, {0.50, 0.40, 0.70}, {0.55, 0.50, 0.40}}};
    std::vector<Index> groups;
    for (const FileCurve& curve : curves) groups.push_back(std::max<Index>(curve.group, 0));
    std::vector<Index> all = groups;
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    std::string binary, views, accessors, meshes, nodes, children, materials;
    Index number = 0;
    for (const Index group : all) {
        Surface surface;
        for (std::size_t c = 0; c < curves.size(); ++c)
            if (groups[c] == group) add_tube(surface, curves[c], sides);
        std::array<float, 3> low, high;
        low.fill(std::numeric_limits<float>::infinity()), high.fill(-std::numeric_limits<float>::infinity());
        const std::size_t points_at = binary.size();
        for (const Vec3& point : surface.points)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto x = static_cast<float>(point[static_cast<Index>(k)]);
                low[k] = std::min(low[k], x), high[k] = std::max(high[k], x);
                detail::put(binary, x);
            }
        const std::size_t triangles_at = binary.size();
        for (const auto& t : surface.triangles)
            for (const std::uint32_t k : t) detail::put(binary, k);
        const auto triple = [](const std::array<float, 3>& v) {
            std::string text = "[";
            for (std::size_t k = 0; k < 3; ++k) text += (k > 0 ? "," : "") + observe::shortest(static_cast<double>(v[k]));
            return text + "]";
        };
        const std::string comma = number > 0 ? "," : "", n = std::to_string(number), m = std::to_string(2 * number),
                          m1 = std::to_string(2 * number + 1);
        views += comma + "{\"buffer\":0,\"byteOffset\":" + std::to_string(points_at) +
                 ",\"byteLength\":" + std::to_string(triangles_at - points_at) +
                 ",\"target\":34962},{\"buffer\":0,\"byteOffset\":" + std::to_string(triangles_at) +
                 ",\"byteLength\":" + std::to_string(binary.size() - triangles_at) + ",\"target\":34963}";
        accessors +=
            comma + "{\"bufferView\":" + m + ",\"componentType\":5126,\"count\":" + std::to_string(surface.points.size()) +
            ",\"type\":\"VEC3\",\"min\":" + triple(low) + ",\"max\":" + triple(high) + "},{\"bufferView\":" + m1 +
            ",\"componentType\":5125,\"count\":" + std::to_string(3 * surface.triangles.size()) + ",\"type\":\"SCALAR\"}";
        meshes += comma + "{\"name\":\"group " + std::to_string(group) + "\",\"primitives\":[{\"attributes\":{\"POSITION\":" + m +
                  "},\"indices\":" + m1 + ",\"material\":" + n + "}]}";
        nodes += ",{\"mesh\":" + n + "}", children += comma + std::to_string(number + 1);
        const auto& colour = colours[static_cast<std::size_t>(group) % colours.size()];
        materials += comma + "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[" + observe::shortest(colour[0]) + "," +
                     observe::shortest(colour[1]) + "," + observe::shortest(colour[2]) +
                     ",1],\"metallicFactor\":0,\"roughnessFactor\":0.8}}";
        ++number;
    }
    // The root turns z up into y up, and scales to metres.
    const std::string scale = observe::shortest(1.0 / metre), half = observe::shortest(std::sqrt(0.5));
    std::string json =
        "{\"asset\":{\"version\":\"2.0\",\"generator\":\"fibrant\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{"
        "\"rotation\":[-" +
        half + ",0,0," + half + "],\"scale\":[" + scale + "," + scale + "," + scale + "],\"children\":[" + children + "]}" +
        nodes + "],\"meshes\":[" + meshes + "],\"materials\":[" + materials + "],\"accessors\":[" + accessors +
        "],\"bufferViews\":[" + views + "],\"buffers\":[{\"byteLength\":" + std::to_string(binary.size()) + "}]}";
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    std::string bytes;
    detail::put(bytes, std::uint32_t{0x46546C67}), detail::put(bytes, std::uint32_t{2}),
        detail::put(bytes, static_cast<std::uint32_t>(28 + json.size() + binary.size()));
    detail::put(bytes, static_cast<std::uint32_t>(json.size())), detail::put(bytes, std::uint32_t{0x4E4F534A});
    bytes += json;
    detail::put(bytes, static_cast<std::uint32_t>(binary.size())), detail::put(bytes, std::uint32_t{0x004E4942});
    return bytes + binary;
}

}  // namespace fibrant::exchange
