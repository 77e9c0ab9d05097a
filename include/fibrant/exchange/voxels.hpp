// SPDX-License-Identifier: MIT
#pragma once
/// @file Fibres as voxels: the share of each cell that fibres fill, whose they are, which way they go, and their orientation
/// tensor.

#include <fibrant/core/parallel.hpp>
#include <fibrant/exchange/curves.hpp>
#include <fibrant/observe/json.hpp>
#include <fibrant/observe/text_file.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

namespace fibrant::exchange {

/// A grid of cubes.
struct VoxelGrid {
    Vec3 origin = Vec3::Zero();            ///< its lowest corner [length]
    double spacing = core::unset;          ///< of cells [length], > 0
    std::array<Index, 3> counts{1, 1, 1};  ///< cells along x, y and z, >= 1

    Index cells() const noexcept { return counts[0] * counts[1] * counts[2]; }
    void validate() const {
        scene::require_finite("VoxelGrid.origin", origin);
        core::require_positive("VoxelGrid.spacing", spacing);
        double all = 1.0;
        for (const Index count : counts) core::require_at_least("VoxelGrid.counts", count, 1), all *= static_cast<double>(count);
        constexpr double most = 1e9;
        core::require(all <= most, "VoxelGrid.counts: cells in all", all, "<= 1e9");
    }
};

/// The grid of a spacing that holds all curves with their thickness.
inline VoxelGrid grid_around(const std::vector<FileCurve>& curves, double spacing) {
    core::require_positive("grid_around.spacing", spacing);
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const FileCurve& curve : curves)
        for (std::size_t k = 0; k < curve.points.size(); ++k) {
            const Vec3 r = Vec3::Constant(curve.radii.empty() ? curve.radius : curve.radii[k]);
            low = low.cwiseMin(curve.points[k] - r), high = high.cwiseMax(curve.points[k] + r);
        }
    VoxelGrid grid{low, spacing, {}};
    for (int k = 0; k < 3; ++k) {
        const double count = std::ceil((high[k] - low[k]) / spacing);
        core::require(count <= 1e9, "grid_around: cells along an axis", count, "<= 1e9");  // more than an index may hold
        grid.counts[static_cast<std::size_t>(k)] = std::max<Index>(1, static_cast<Index>(count));
    }
    grid.validate();
    return grid;
}

/// The grid of a spacing that fills a box.
/// @throws std::invalid_argument where an edge is no whole number of spacings, to a millionth
inline VoxelGrid grid_in(const Vec3& low, const Vec3& high, double spacing) {
    core::require_positive("grid_in.spacing", spacing);
    VoxelGrid grid{low, spacing, {}};
    for (int k = 0; k < 3; ++k) {
        static constexpr std::array names{"grid_in: edge along x over the spacing", "grid_in: edge along y over the spacing",
                                          "grid_in: edge along z over the spacing"};
        const double count = (high[k] - low[k]) / spacing;
        core::require(std::isfinite(count) && count > 0.5 && count < 1e9 && std::abs(count - std::round(count)) <= 1e-6 * count,
                      names[static_cast<std::size_t>(k)], count, "a whole number, >= 1");
        grid.counts[static_cast<std::size_t>(k)] = static_cast<Index>(std::round(count));
    }
    grid.validate();
    return grid;
}

/// Fields of the cells, x fastest.
struct Voxels {
    VoxelGrid grid;
    std::vector<std::int32_t> yarn;  ///< of the largest share; -1: none
    std::vector<float> share;        ///< of fibres [1], at most 1
    std::vector<std::array<float, 3>>
        direction;  ///< first direction of the orientation tensor, unit; zero where there is no fibre
    std::vector<std::array<float, 6>>
        orientation;      ///< mean of t (x) t over the fibres in the cell: xx, yy, zz, xy, yz, xz; its trace is 1
    double volume = 0.0;  ///< of fibres inside the grid, overlaps counted as often as they are [length^3]
    double excess = 0.0;  ///< of that, where shares of a cell came to more than 1 [length^3]
    Mat3 mean_orientation = Mat3::Zero();  ///< over all fibres inside [1]
};

/// Fills a grid. A cell's share is the mean over points of a lattice within it, each in or out of a fibre but for a rim as wide
/// as the points are apart, so a cell that no surface is near is exact; the volume of a fibre is right to 1e-3 at a spacing of
/// half its radius, with four points each way.
/// @param points  of a cell each way, >= 1
/// Time linear in segments and the cells that they reach.
inline Voxels voxels_of(const std::vector<FileCurve>& curves, const VoxelGrid& grid, Index points = 4) {
    grid.validate();
    core::require_at_least("voxels_of.points", points, 1);
    struct Reach {
        Index cell;
        std::int32_t curve, segment;
    };
    std::vector<Reach> reaches;
    const double h = grid.spacing;
    const auto last_of = [](const FileCurve& curve) { return core::count(curve.points) - (curve.closed ? 0 : 1); };
    for (std::size_t c = 0; c < curves.size(); ++c) {
        const FileCurve& curve = curves[c];
        const std::size_t n = curve.points.size();
        for (Index k = 0; k < last_of(curve); ++k) {
            const Vec3 &p = curve.points[core::at(k)], &q = curve.points[(core::at(k) + 1) % n];
            const double r =
                curve.radii.empty() ? curve.radius : std::max(curve.radii[core::at(k)], curve.radii[(core::at(k) + 1) % n]);
            core::require_positive("FileCurve.radius", r);
            std::array<Index, 3> low, high;
            bool outside = false;
            for (int a = 0; a < 3; ++a) {
                const auto axis = static_cast<std::size_t>(a);
                const double from = (std::min(p[a], q[a]) - r - grid.origin[a]) / h,
                             to = (std::max(p[a], q[a]) + r - grid.origin[a]) / h;
                low[axis] = std::max<Index>(0, static_cast<Index>(std::floor(std::max(from, -1.0))));
                high[axis] = std::min<Index>(
                    grid.counts[axis] - 1, static_cast<Index>(std::floor(std::min(to, static_cast<double>(grid.counts[axis])))));
                outside = outside || low[axis] > high[axis];
            }
            if (outside) continue;
            const Vec3 chord = q - p;
            const double square = chord.squaredNorm(), far = r + 0.8660254037844386 * h;
            for (Index z = low[2]; z <= high[2]; ++z)
                for (Index y = low[1]; y <= high[1]; ++y)
                    for (Index x = low[0]; x <= high[0]; ++x) {
                        const Vec3 centre = grid.origin + h * Vec3(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5,
                                                                   static_cast<double>(z) + 0.5);
                        const double t = std::clamp((centre - p).dot(chord) / square, 0.0, 1.0);
                        if ((centre - p - t * chord).squaredNorm() <= far * far)
                            reaches.push_back({x + grid.counts[0] * (y + grid.counts[1] * z), static_cast<std::int32_t>(c),
                                               static_cast<std::int32_t>(k)});
                    }
        }
    }
    std::sort(reaches.begin(), reaches.end(), [](const Reach& a, const Reach& b) {
        return std::tie(a.cell, a.curve, a.segment) < std::tie(b.cell, b.curve, b.segment);
    });
    Voxels voxels{grid, {}, {}, {}, {}};
    const std::size_t cells = core::at(grid.cells());
    voxels.yarn.assign(cells, -1), voxels.share.assign(cells, 0.0f);
    voxels.direction.assign(cells, {0.0f, 0.0f, 0.0f}), voxels.orientation.assign(cells, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f});
    std::vector<std::size_t> starts;
    for (std::size_t k = 0; k < reaches.size(); ++k)
        if (k == 0 || reaches[k].cell != reaches[k - 1].cell) starts.push_back(k);
    starts.push_back(reaches.size());
    struct Sum {
        double volume = 0.0, excess = 0.0;
        Mat3 moment = Mat3::Zero();
        Sum& operator+=(const Sum& other) {
            return volume += other.volume, excess += other.excess, moment += other.moment, *this;
        }
    };
    const double weight = 1.0 / static_cast<double>(points * points * points);
    const Sum sum = core::ordered_sum(
        core::count(starts) - 1, Sum{},
        [&](Index first, Index last) {
            Sum part;
            for (Index s = first; s < last; ++s) {
                const std::size_t from = starts[core::at(s)], to = starts[core::at(s) + 1];
                const Index cell = reaches[from].cell, x = cell % grid.counts[0], y = cell / grid.counts[0] % grid.counts[1],
                            z = cell / (grid.counts[0] * grid.counts[1]);
                const Vec3 corner =
                    grid.origin + h * Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
                double all = 0.0, largest = 0.0;
                Mat3 moment = Mat3::Zero();
                for (std::size_t a = from; a < to;) {
                    std::size_t b = a;
                    while (b < to && reaches[b].curve == reaches[a].curve) ++b;
                    const FileCurve& curve = curves[static_cast<std::size_t>(reaches[a].curve)];
                    const std::size_t n = curve.points.size();
                    double own = 0.0;
                    Mat3 own_moment = Mat3::Zero();
                    for (Index i = 0; i < points * points * points; ++i) {
                        const double d = h / static_cast<double>(points);
                        const Vec3 at = corner + d * Vec3(static_cast<double>(i % points) + 0.5,
                                                          static_cast<double>(i / points % points) + 0.5,
                                                          static_cast<double>(i / (points * points)) + 0.5);
                        double nearest = std::numeric_limits<double>::infinity();
                        Vec3 along = Vec3::Zero();
                        double inside = 0.0;
                        for (std::size_t k = a; k < b; ++k) {
                            const auto segment = static_cast<std::size_t>(reaches[k].segment);
                            const Vec3 &p = curve.points[segment], &q = curve.points[(segment + 1) % n], chord = q - p;
                            const double free = (at - p).dot(chord) / chord.squaredNorm(), t = std::clamp(free, 0.0, 1.0);
                            const double distance = (at - p - t * chord).squaredNorm();
                            if (!(distance < nearest)) continue;
                            nearest = distance, along = chord;
                            const double r = curve.radii.empty()
                                                 ? curve.radius
                                                 : (1.0 - t) * curve.radii[segment] + t * curve.radii[(segment + 1) % n];
                            // Even in the square of the distance, so that a ring of it holds what it should whatever its
                            // curvature.
                            inside = std::clamp(0.5 + (r * r - distance) / (2.0 * r * d), 0.0, 1.0);
                            if (curve.closed) continue;
                            const double size = chord.norm();  // ends are flat
                            if (segment == 0) inside *= std::clamp(0.5 + free * size / d, 0.0, 1.0);
                            if (segment + 2 == n) inside *= std::clamp(0.5 + (1.0 - free) * size / d, 0.0, 1.0);
                            // Beyond an end the nearest point is the end itself, and the way to it goes along the fibre.
                            if ((segment == 0 && free < 0.0) || (segment + 2 == n && free > 1.0)) {
                                const double across = (at - p - free * chord).squaredNorm();
                                inside = std::clamp(0.5 + (r * r - across) / (2.0 * r * d), 0.0, 1.0) *
                                         std::clamp(0.5 - (free < 0.0 ? -free : free - 1.0) * size / d, 0.0, 1.0);
                            }
                        }
                        if (!(inside > 0.0)) continue;
                        along.normalize();
                        own += inside * weight, own_moment += inside * weight * along * along.transpose();
                    }
                    all += own, moment += own_moment;
                    if (own > largest) {
                        largest = own;
                        voxels.yarn[core::at(cell)] =
                            static_cast<std::int32_t>(curve.group >= 0 ? curve.group : reaches[a].curve);
                    }
                    a = b;
                }
                part.volume += h * h * h * all, part.excess += h * h * h * std::max(0.0, all - 1.0),
                    part.moment += h * h * h * moment;
                if (!(all > 0.0)) continue;
                voxels.share[core::at(cell)] = static_cast<float>(std::min(1.0, all));
                const Mat3 a2 = moment / all;
                voxels.orientation[core::at(cell)] = {static_cast<float>(a2(0, 0)), static_cast<float>(a2(1, 1)),
                                                      static_cast<float>(a2(2, 2)), static_cast<float>(a2(0, 1)),
                                                      static_cast<float>(a2(1, 2)), static_cast<float>(a2(0, 2))};
                const Eigen::SelfAdjointEigenSolver<Mat3> axes(a2);
                Vec3 main = axes.eigenvectors().col(2);
                Index big = 0;
                main.cwiseAbs().maxCoeff(&big);
                if (main[big] < 0.0) main = -main;
                voxels.direction[core::at(cell)] = {static_cast<float>(main.x()), static_cast<float>(main.y()),
                                                    static_cast<float>(main.z())};
            }
            return part;
        },
        64);
    voxels.volume = sum.volume, voxels.excess = sum.excess;
    if (sum.volume > 0.0) voxels.mean_orientation = sum.moment / sum.volume;
    return voxels;
}

/// Orientation tensor of curves by their chords, each as heavy as it is long and thick: what voxels of any size tend to [1].
inline Mat3 orientation_of(const std::vector<FileCurve>& curves) {
    Mat3 sum = Mat3::Zero();
    double all = 0.0;
    for (const FileCurve& curve : curves) {
        const std::size_t n = curve.points.size();
        for (std::size_t k = 0; k + (curve.closed ? 0 : 1) < n; ++k) {
            const Vec3 chord = curve.points[(k + 1) % n] - curve.points[k];
            const double radius = std::isnan(curve.radius) ? 1.0 : curve.radius, weight = radius * radius * chord.norm();
            sum += radius * radius * chord * chord.transpose() / chord.norm(), all += weight;
        }
    }
    return sum / all;
}

/// VTK's ImageData (.vti) with all fields as data of cells, raw.
inline std::string vti_of(const Voxels& voxels) {
    const VoxelGrid& grid = voxels.grid;
    std::string extent, data;
    for (const Index count : grid.counts) extent += (extent.empty() ? "0 " : " 0 ") + std::to_string(count);
    const std::string spacing = observe::shortest(grid.spacing);
    std::string head =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\">\n<ImageData WholeExtent=\"" +
        extent + "\" Origin=\"" + observe::shortest(grid.origin.x()) + " " + observe::shortest(grid.origin.y()) + " " +
        observe::shortest(grid.origin.z()) + "\" Spacing=\"" + spacing + " " + spacing + " " + spacing + "\">\n<Piece Extent=\"" +
        extent + "\">\n<CellData>\n";
    const auto add = [&](const char* name, const char* type, int components, const void* values, std::size_t size) {
        head += "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(data.size()) + "\"/>\n";
        const std::uint64_t bytes = size;
        data.append(reinterpret_cast<const char*>(&bytes), sizeof bytes).append(static_cast<const char*>(values), size);
    };
    add("yarn", "Int32", 1, voxels.yarn.data(), voxels.yarn.size() * sizeof(std::int32_t));
    add("fibre_volume_fraction", "Float32", 1, voxels.share.data(), voxels.share.size() * sizeof(float));
    add("direction", "Float32", 3, voxels.direction.data(), voxels.direction.size() * 3 * sizeof(float));
    add("orientation", "Float32", 6, voxels.orientation.data(), voxels.orientation.size() * 6 * sizeof(float));
    return head + "</CellData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_" + data +
           "\n</AppendedData>\n</VTKFile>\n";
}

/// Numbers of yarns as bytes, and the text that says how they lie.
inline std::string raw_of(const Voxels& voxels) {
    return {reinterpret_cast<const char*>(voxels.yarn.data()), voxels.yarn.size() * sizeof(std::int32_t)};
}
inline std::string raw_head_of(const Voxels& voxels) {
    observe::JsonObject json;
    std::vector<double> counts, origin;
    for (const Index count : voxels.grid.counts) counts.push_back(static_cast<double>(count));
    for (const double x : voxels.grid.origin) origin.push_back(x);
    json.add("type", "int32, little-endian, x fastest")
        .add("field", "yarn, -1 none")
        .add("counts", counts)
        .add("origin", origin)
        .add("spacing", voxels.grid.spacing);
    return json.text() + "\n";
}

}  // namespace fibrant::exchange
