// SPDX-License-Identifier: MIT
#pragma once
/// @file Voxels for solvers and tables: an Abaqus mesh of cubes with orientations, all fields as CSV, maps and profiles of the
/// fibre volume fraction.

#include <fibrant/exchange/voxels.hpp>
#include <fibrant/observe/svg.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace fibrant::exchange {

namespace detail {
/// Numbers of a set, sixteen a line at most, as Abaqus reads them.
inline void put_set(std::string& text, const std::string& keyword, const std::vector<Index>& members) {
    constexpr std::size_t most = 16;
    text += keyword + "\n";
    for (std::size_t k = 0; k < members.size(); ++k)
        text += std::to_string(members[k]) + (k + 1 == members.size() ? "\n" : k % most == most - 1 ? ",\n" : ", ");
}
/// A line of a table, numbers between commas.
inline std::string row(std::initializer_list<double> values) {
    std::string text;
    for (const double value : values) text += (text.empty() ? "" : ", ") + observe::shortest(value);
    return text;
}
/// Cell (i, j, k) of a grid, x fastest.
inline std::size_t cell_of(const VoxelGrid& grid, Index i, Index j, Index k) noexcept {
    return core::at(i + grid.counts[0] * (j + grid.counts[1] * k));
}
inline Vec3 centre_of(const VoxelGrid& grid, Index i, Index j, Index k) noexcept {
    return grid.origin +
           grid.spacing * Vec3(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5, static_cast<double>(k) + 0.5);
}
}  // namespace detail

/// An Abaqus input file of cubes (C3D8R, x fastest): a set of elements a yarn (YARN_n) and one for what no fibre is in (MATRIX),
/// sets of nodes on the six faces, and orientations element by element as a distribution: the first axis along the fibres, the
/// second across. Materials, sections and steps are the user's. Volume fractions are in the table of `cells_csv_of`, by the
/// number of the element.
/// @throws std::invalid_argument for more than 2e7 cells, some 4 GB of text
inline std::string voxel_inp_of(const Voxels& voxels) {
    const VoxelGrid& grid = voxels.grid;
    constexpr double most = 2e7;
    core::require(static_cast<double>(grid.cells()) <= most, "VoxelGrid.counts: cells of an Abaqus file",
                  static_cast<double>(grid.cells()), "<= 2e7");
    const auto [nx, ny, nz] = grid.counts;
    std::string text = "*HEADING\nfibres as cubes; the length is that of the curves\n*NODE\n";
    const auto node = [&, x = nx, y = ny](Index i, Index j, Index k) { return 1 + i + (x + 1) * (j + (y + 1) * k); };
    std::array<std::vector<Index>, 6> faces;
    for (Index k = 0; k <= nz; ++k)
        for (Index j = 0; j <= ny; ++j)
            for (Index i = 0; i <= nx; ++i) {
                const Vec3 p = detail::centre_of(grid, i, j, k) - Vec3::Constant(0.5 * grid.spacing);
                const Index n = node(i, j, k);
                text += std::to_string(n) + ", " + detail::row({p.x(), p.y(), p.z()}) + "\n";
                if (i == 0) faces[0].push_back(n);
                if (i == nx) faces[1].push_back(n);
                if (j == 0) faces[2].push_back(n);
                if (j == ny) faces[3].push_back(n);
                if (k == 0) faces[4].push_back(n);
                if (k == nz) faces[5].push_back(n);
            }
    text += "*ELEMENT, TYPE=C3D8R, ELSET=ALL_CELLS\n";
    std::vector<std::pair<std::int32_t, Index>> owners;
    for (Index k = 0; k < nz; ++k)
        for (Index j = 0; j < ny; ++j)
            for (Index i = 0; i < nx; ++i) {
                const std::size_t cell = detail::cell_of(grid, i, j, k);
                text += std::to_string(cell + 1);
                for (const Index n : {node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k),
                                      node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)})
                    text += ", " + std::to_string(n);
                text += "\n";
                owners.emplace_back(voxels.yarn[cell], static_cast<Index>(cell) + 1);
            }
    std::sort(owners.begin(), owners.end());
    for (std::size_t k = 0; k < owners.size();) {
        const std::int32_t yarn = owners[k].first;
        std::vector<Index> members;
        for (; k < owners.size() && owners[k].first == yarn; ++k) members.push_back(owners[k].second);
        detail::put_set(text, "*ELSET, ELSET=" + (yarn < 0 ? std::string("MATRIX") : "YARN_" + std::to_string(yarn)), members);
    }
    static constexpr std::array names{"X_LOW", "X_HIGH", "Y_LOW", "Y_HIGH", "Z_LOW", "Z_HIGH"};
    for (std::size_t f = 0; f < faces.size(); ++f) detail::put_set(text, std::string("*NSET, NSET=") + names[f], faces[f]);
    text +=
        "*DISTRIBUTION TABLE, NAME=FIBRE_AXES_TABLE\nCOORD3D, COORD3D\n"
        "*DISTRIBUTION, LOCATION=ELEMENT, TABLE=FIBRE_AXES_TABLE, NAME=FIBRE_AXES\n, 1., 0., 0., 0., 1., 0.\n";
    for (std::size_t cell = 0; cell < voxels.yarn.size(); ++cell) {
        if (voxels.yarn[cell] < 0) continue;
        const auto& d = voxels.direction[cell];
        const Vec3 along = Vec3(static_cast<double>(d[0]), static_cast<double>(d[1]), static_cast<double>(d[2])).normalized();
        const Vec3 across = scene::any_perpendicular(along);
        text += std::to_string(cell + 1) + ", " +
                detail::row({along.x(), along.y(), along.z(), across.x(), across.y(), across.z()}) + "\n";
    }
    return text + "*ORIENTATION, NAME=FIBRES, DEFINITION=COORDINATES, SYSTEM=RECTANGULAR\nFIBRE_AXES\n1, 0.\n";
}

/// All fields, a row a cell; elements are numbered as in `voxel_inp_of`.
inline std::string cells_csv_of(const Voxels& voxels) {
    std::string text =
        "element,x,y,z,yarn,fibre_volume_fraction,direction_x,direction_y,direction_z,a_xx,a_yy,a_zz,a_xy,a_yz,a_xz\n";
    const VoxelGrid& grid = voxels.grid;
    for (Index k = 0; k < grid.counts[2]; ++k)
        for (Index j = 0; j < grid.counts[1]; ++j)
            for (Index i = 0; i < grid.counts[0]; ++i) {
                const std::size_t cell = detail::cell_of(grid, i, j, k);
                const Vec3 p = detail::centre_of(grid, i, j, k);
                text += std::to_string(cell + 1);
                for (const double x : p) text += "," + observe::shortest(x);
                text +=
                    "," + std::to_string(voxels.yarn[cell]) + "," + observe::shortest(static_cast<double>(voxels.share[cell]));
                for (const float x : voxels.direction[cell]) text += "," + observe::shortest(static_cast<double>(x));
                for (const float x : voxels.orientation[cell]) text += "," + observe::shortest(static_cast<double>(x));
                text += "\n";
            }
    return text;
}

/// The fibre volume fraction seen along an axis: of each column of cells its mean, and the thickness that its fibres would have
/// if they were pressed to a solid.
struct VolumeMap {
    int axis = 2;                 ///< that is looked along
    std::array<int, 2> across{};  ///< the other two
    std::array<Index, 2> counts{};
    Vec3 origin = Vec3::Zero();          ///< of the grid [length]
    double spacing = 0.0, height = 0.0;  ///< of cells, and of a column [length]
    std::vector<double> mean;            ///< of the columns, the first of `across` fastest [1]
};

/// Mean fibre volume fraction of the columns of a grid of voxels.
/// @param axis  0, 1 or 2
inline VolumeMap volume_map(const Voxels& voxels, int axis = 2) {
    core::require_between("volume_map.axis", static_cast<double>(axis), 0.0, 2.0);
    const VoxelGrid& grid = voxels.grid;
    VolumeMap map;
    map.axis = axis, map.across = {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
    map.counts = {grid.counts[static_cast<std::size_t>(map.across[0])], grid.counts[static_cast<std::size_t>(map.across[1])]};
    map.origin = grid.origin, map.spacing = grid.spacing;
    const Index deep = grid.counts[static_cast<std::size_t>(axis)];
    map.height = grid.spacing * static_cast<double>(deep);
    map.mean.assign(core::at(map.counts[0] * map.counts[1]), 0.0);
    for (Index k = 0; k < grid.counts[2]; ++k)
        for (Index j = 0; j < grid.counts[1]; ++j)
            for (Index i = 0; i < grid.counts[0]; ++i) {
                const std::array<Index, 3> at{i, j, k};
                const Index column =
                    at[static_cast<std::size_t>(map.across[0])] + map.counts[0] * at[static_cast<std::size_t>(map.across[1])];
                map.mean[core::at(column)] +=
                    static_cast<double>(voxels.share[detail::cell_of(grid, i, j, k)]) / static_cast<double>(deep);
            }
    return map;
}

/// A map of volume fraction as CSV: two coordinates [length], fraction [1], thickness [length].
inline std::string map_csv_of(const VolumeMap& map) {
    static constexpr std::array names{"x", "y", "z"};
    std::string text = std::string(names[static_cast<std::size_t>(map.across[0])]) + "," +
                       names[static_cast<std::size_t>(map.across[1])] + ",fibre_volume_fraction,fibre_thickness\n";
    for (Index b = 0; b < map.counts[1]; ++b)
        for (Index a = 0; a < map.counts[0]; ++a) {
            const double mean = map.mean[core::at(a + map.counts[0] * b)];
            text += observe::shortest(map.origin[map.across[0]] + map.spacing * (static_cast<double>(a) + 0.5)) + "," +
                    observe::shortest(map.origin[map.across[1]] + map.spacing * (static_cast<double>(b) + 0.5)) + "," +
                    observe::shortest(mean) + "," + observe::shortest(mean * map.height) + "\n";
        }
    return text;
}

/// The same as a picture: white where there is no fibre, dark where there is nothing else.
/// @param unit  of lengths
inline std::string map_svg_of(const VolumeMap& map, const std::string& unit = "mm") {
    constexpr double longest = 800.0, margin = 60.0;  // [pixel]
    const auto wide = static_cast<double>(map.counts[0]), tall = static_cast<double>(map.counts[1]);
    const double pixel = longest / std::max(wide, tall);
    std::string body;
    double least = 1.0, most = 0.0, sum = 0.0;
    for (const double mean : map.mean) least = std::min(least, mean), most = std::max(most, mean), sum += mean;
    for (Index b = 0; b < map.counts[1]; ++b)
        for (Index a = 0; a < map.counts[0]; ++a) {
            const double mean = map.mean[core::at(a + map.counts[0] * b)];
            if (mean <= 0.0) continue;
            const double shade = 1.0 - 0.9 * std::min(1.0, mean);
            body += "<rect x=\"" + observe::rounded(margin + pixel * static_cast<double>(a), 2) + "\" y=\"" +
                    observe::rounded(margin + pixel * (tall - 1.0 - static_cast<double>(b)), 2) + "\" width=\"" +
                    observe::rounded(pixel, 2) + "\" height=\"" + observe::rounded(pixel, 2) + "\" fill=\"" +
                    observe::Colour{shade, shade, 0.3 + 0.7 * shade}.text() + "\"/>\n";
        }
    static constexpr std::array names{"x", "y", "z"};
    const std::string title = "fibre volume fraction along " + std::string(names[static_cast<std::size_t>(map.axis)]) +
                              ": mean " + observe::rounded(sum / static_cast<double>(map.mean.size()), 3) + ", " +
                              observe::rounded(least, 3) + " to " + observe::rounded(most, 3);
    body += observe::detail::svg_text(
        margin, 2.0 * margin + pixel * tall - 20.0,
        observe::rounded(map.spacing * wide, 2) + " x " + observe::rounded(map.spacing * tall, 2) + " " + unit);
    return observe::detail::svg_page(2.0 * margin + pixel * wide, 2.0 * margin + pixel * tall, "", body, title);
}

/// Mean fibre volume fraction of each slice of cells across x, y and z.
inline std::string profile_csv_of(const Voxels& voxels) {
    static constexpr std::array names{"x", "y", "z"};
    const VoxelGrid& grid = voxels.grid;
    std::array<std::vector<double>, 3> sums;
    for (std::size_t a = 0; a < 3; ++a) sums[a].assign(core::at(grid.counts[a]), 0.0);
    for (Index k = 0; k < grid.counts[2]; ++k)
        for (Index j = 0; j < grid.counts[1]; ++j)
            for (Index i = 0; i < grid.counts[0]; ++i) {
                const auto share = static_cast<double>(voxels.share[detail::cell_of(grid, i, j, k)]);
                sums[0][core::at(i)] += share, sums[1][core::at(j)] += share, sums[2][core::at(k)] += share;
            }
    std::string text = "axis,place,fibre_volume_fraction\n";
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t k = 0; k < sums[a].size(); ++k)
            text += std::string(names[a]) + "," +
                    observe::shortest(grid.origin[static_cast<Index>(a)] + grid.spacing * (static_cast<double>(k) + 0.5)) + "," +
                    observe::shortest(sums[a][k] * static_cast<double>(grid.counts[a]) / static_cast<double>(grid.cells())) +
                    "\n";
    return text;
}

}  // namespace fibrant::exchange
