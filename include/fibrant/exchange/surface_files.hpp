// SPDX-License-Identifier: MIT
#pragma once
/// @file Closed surfaces of triangles in STL files, as rigid tools: moulds, punches, holders.

#include <fibrant/exchange/binary_curves.hpp>
#include <fibrant/scene/triangle_surface.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace fibrant::exchange {

namespace detail {

/// Corners of triangles, three and three. Both kinds of STL may begin with "solid": the size tells which one it is.
inline std::vector<Vec3> stl_corners(std::string_view bytes, const std::string& file) {
    constexpr std::size_t head = 80, triangle_bytes = 50;
    ByteReader reader(bytes, file);
    std::vector<Vec3> corners;
    const auto finite = [&](const Vec3& corner) {
        if (!corner.allFinite()) reader.refuse("corner = " + scene::text(corner) + ", but it must be finite");
        corners.push_back(corner);
    };
    std::uint32_t count = 0;
    if (bytes.size() >= head + sizeof count) std::memcpy(&count, bytes.data() + head, sizeof count);
    if (bytes.size() == head + sizeof count + triangle_bytes * std::size_t{count} && count > 0) {
        for (std::size_t k = 0; k < head + sizeof count; ++k) reader.raw<char>();
        for (std::uint32_t t = 0; t < count; ++t) {
            for (int k = 0; k < 3; ++k) reader.raw<float>();  // its normal: the order of the corners has it
            for (int k = 0; k < 3; ++k) {
                const auto x = reader.raw<float>(), y = reader.raw<float>(), z = reader.raw<float>();
                finite(Vec3(x, y, z));
            }
            reader.raw<std::uint16_t>();
        }
        return corners;
    }
    if (reader.word() != "solid")
        refuse_file(
            file, "byte 0",
            "is no STL file: it neither begins with solid nor has the size, 84 bytes and 50 a triangle, that its byte 80 tells");
    reader.line();
    while (!reader.done()) {
        const std::string_view word = reader.word();
        if (word != "vertex") continue;
        Vec3 corner;
        for (Index k = 0; k < 3; ++k) corner[k] = reader.text_number<double>(k == 0 ? "x" : k == 1 ? "y" : "z");
        finite(corner);
    }
    if (corners.empty() || corners.size() % 3 != 0)
        reader.refuse("vertices = " + std::to_string(corners.size()) + ", but it must be three a facet");
    return corners;
}

}  // namespace detail

/// The body that an STL file encloses. Corners with the same coordinates are one; the normals in the file are not read.
/// @param scale  of all lengths, > 0
/// @throws std::invalid_argument for what is no STL, and what scene::TriangleSurface refuses, by file
inline std::shared_ptr<const scene::TriangleSurface> surface_of_stl(std::string_view bytes, const std::string& file,
                                                                    double scale = 1.0) {
    core::require_positive("surface_of_stl.scale", scale);
    const std::vector<Vec3> all = detail::stl_corners(bytes, file);
    std::vector<std::uint32_t> order(all.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t k) { return std::array{all[k][0], all[k][1], all[k][2]}; };
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b) || (key(a) == key(b) && a < b); });
    std::vector<Vec3> corners;
    std::vector<scene::TriangleSurface::Triangle> triangles(all.size() / 3);
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (k == 0 || key(order[k]) != key(order[k - 1])) corners.push_back(scale * all[order[k]]);
        triangles[order[k] / 3][order[k] % 3] = static_cast<std::uint32_t>(corners.size() - 1);
    }
    try {
        return std::make_shared<const scene::TriangleSurface>(std::move(corners), std::move(triangles));
    } catch (const std::invalid_argument& error) {
        refuse_file(file, "", error.what());
    }
}
inline std::shared_ptr<const scene::TriangleSurface> read_surface(const std::filesystem::path& path, double scale = 1.0) {
    return surface_of_stl(detail::bytes_of_file(path), path.string(), scale);
}

}  // namespace fibrant::exchange
