// SPDX-License-Identifier: MIT
#pragma once
/// @file Layers of hexahedra on both sides of a sheet of fibres (Durville, section 15.3.3).

#include <fibrant/core/parameters.hpp>
#include <fibrant/solid/cell_search.hpp>
#include <fibrant/solid/fibre_surface.hpp>

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::solid {

/// Which sides of the sheet have a layer.
enum class Sides { both, upper, lower };

/// What happens where the two inner faces would cross.
enum class Crossing { refuse, clip };

/// How layers are meshed. The sheet lies across z.
struct LayerParameters {
    std::array<double, 2> low{core::unset, core::unset}, high{core::unset, core::unset};  ///< rectangle in the plane [length]
    std::array<Index, 2> cells{0, 0};                                                     ///< along x and y, >= 1
    Index through = 2;                                                                    ///< cells through the thickness, >= 1
    double grading = 1.0;  ///< height of the outermost cell over that of the innermost [1], in [0.01, 100]
    double upper_face = core::unset, lower_face = core::unset;  ///< heights of the outer faces [length]
    double penetration_depth = core::unset;                     ///< of the inner faces below the fibres' surface [length], >= 0
    double least_thickness = core::unset;                       ///< of a layer anywhere [length], > 0
    double clearance = core::unset;                             ///< between the inner faces, where there are two [length], > 0
    Index smoothing = 1;                                        ///< passes over the inner faces, >= 0
    Sides sides = Sides::both;                                  ///< which of the two layers there are
    Crossing crossing = Crossing::clip;                         ///< what to do where the inner faces would cross
    scene::ElasticMaterial material{};

    void validate() const {
        const std::string name = "LayerParameters.";
        for (std::size_t k = 0; k < 2; ++k) {
            const std::string axis = k == 0 ? "x" : "y";
            core::require_finite(name + "low." + axis, low[k]);
            core::require(std::isfinite(high[k]) && high[k] > low[k], name + "high." + axis, high[k],
                          "finite and > low = " + core::text(low[k]));
            core::require_at_least(name + "cells." + axis, cells[k], 1);
        }
        core::require_at_least(name + "through", through, 1);
        core::require_between(name + "grading", grading, 0.01, 100.0);
        core::require_positive(name + "least_thickness", least_thickness);
        core::require_not_negative(name + "penetration_depth", penetration_depth);
        core::require_at_least(name + "smoothing", smoothing, 0);
        if (sides != Sides::lower) core::require_finite(name + "upper_face", upper_face);
        if (sides != Sides::upper) core::require_finite(name + "lower_face", lower_face);
        if (sides == Sides::both) core::require_positive(name + "clearance", clearance);
        core::require_positive(name + "material.young_modulus", material.young_modulus);
    }
};

/// One layer; nodes in planes of equal number from the lower face up, rows along x.
struct Layer {
    scene::Solid solid;
    std::array<Index, 3> cells{};
    Index node(Index i, Index j, Index k) const noexcept { return (k * (cells[1] + 1) + j) * (cells[0] + 1) + i; }
};
struct Layers {
    std::vector<Layer> list;    ///< upper, then lower, as far as there are such
    Index columns = 0;          ///< of nodes
    Index met = 0, filled = 0;  ///< columns of a face that met a fibre, and of pores, both faces together
    Index clipped = 0;          ///< columns whose inner faces would have crossed
};

namespace detail {

/// A grid of heights, some of which are not known.
class HeightGrid {
public:
    HeightGrid(Index nx, Index ny) : nx_{nx}, ny_{ny}, height_(core::at(nx * ny), 0.0), known_(core::at(nx * ny), false) {}
    double& at(Index i, Index j) noexcept { return height_[core::at(j * nx_ + i)]; }
    double at(Index i, Index j) const noexcept { return height_[core::at(j * nx_ + i)]; }
    void set(Index i, Index j, double value) { at(i, j) = value, known_[core::at(j * nx_ + i)] = true; }
    Index unknown() const { return core::count(known_) - std::count(known_.begin(), known_.end(), true); }

    /// Heights that are not known become those of a soap film hung from the others: Laplace's equation.
    void fill() {
        std::vector<int> number(known_.size(), -1);
        int unknowns = 0;
        for (std::size_t k = 0; k < known_.size(); ++k)
            if (!known_[k]) number[k] = unknowns++;
        if (unknowns == 0) return;
        std::vector<Eigen::Triplet<double, int>> entries;
        Vector right = Vector::Zero(unknowns);
        for (Index j = 0; j < ny_; ++j)
            for (Index i = 0; i < nx_; ++i) {
                const int row = number[core::at(j * nx_ + i)];
                if (row < 0) continue;
                each_neighbour(i, j, [&](Index a, Index b) {
                    entries.emplace_back(row, row, 1.0);
                    const int column = number[core::at(b * nx_ + a)];
                    if (column >= 0)
                        entries.emplace_back(row, column, -1.0);
                    else
                        right[row] += at(a, b);
                });
            }
        SparseMatrix matrix(unknowns, unknowns);
        matrix.setFromTriplets(entries.begin(), entries.end());
        const Vector found = Eigen::SimplicialLDLT<SparseMatrix>(matrix).solve(right);
        for (std::size_t k = 0; k < known_.size(); ++k)
            if (number[k] >= 0) height_[k] = found[number[k]];
    }
    /// Half of each height from itself, half from its neighbours.
    void smooth() {
        const HeightGrid before = *this;
        for (Index j = 0; j < ny_; ++j)
            for (Index i = 0; i < nx_; ++i) {
                double sum = 0.0, count = 0.0;
                each_neighbour(i, j, [&](Index a, Index b) { sum += before.at(a, b), count += 1.0; });
                if (count > 0.0) at(i, j) = 0.5 * before.at(i, j) + 0.5 * sum / count;
            }
    }

private:
    template <class Body>
    void each_neighbour(Index i, Index j, const Body& body) const {
        if (i > 0) body(i - 1, j);
        if (i + 1 < nx_) body(i + 1, j);
        if (j > 0) body(i, j - 1);
        if (j + 1 < ny_) body(i, j + 1);
    }
    Index nx_, ny_;
    std::vector<double> height_;
    std::vector<bool> known_;
};

}  // namespace detail

/// Meshes the layers: a regular grid on each outer face, projected along z on the first fibre met, moved on by the penetration
/// depth, carried over pores, smoothed, and cut into cells.
/// @throws std::invalid_argument if no fibre is met, a layer is too thin somewhere, or, as `crossing` says, faces would cross
inline Layers mesh_layers(const FibreSurface& surface, const LayerParameters& parameters) {
    parameters.validate();
    const Index nx = parameters.cells[0] + 1, ny = parameters.cells[1] + 1;
    const auto x = [&](Index i) {
        return parameters.low[0] +
               (parameters.high[0] - parameters.low[0]) * static_cast<double>(i) / static_cast<double>(nx - 1);
    };
    const auto y = [&](Index j) {
        return parameters.low[1] +
               (parameters.high[1] - parameters.low[1]) * static_cast<double>(j) / static_cast<double>(ny - 1);
    };
    Layers layers;
    layers.columns = nx * ny;
    std::vector<double> signs;
    if (parameters.sides != Sides::lower) signs.push_back(1.0);
    if (parameters.sides != Sides::upper) signs.push_back(-1.0);
    std::vector<detail::HeightGrid> faces;
    for (const double sign : signs) {
        detail::HeightGrid& face = faces.emplace_back(nx, ny);
        for (Index j = 0; j < ny; ++j)
            for (Index i = 0; i < nx; ++i)
                if (const auto height = surface.height(x(i), y(j), sign))
                    face.set(i, j, *height - sign * parameters.penetration_depth);
        const Index pores = face.unknown();
        if (pores == nx * ny) core::refuse("LayerParameters.low, high", "a rectangle without a fibre", "one over fibres");
        layers.filled += pores, layers.met += nx * ny - pores;
        face.fill();
        for (Index pass = 0; pass < parameters.smoothing; ++pass) face.smooth();
    }
    if (faces.size() == 2) {
        for (Index j = 0; j < ny; ++j)
            for (Index i = 0; i < nx; ++i) {
                double &up = faces[0].at(i, j), &down = faces[1].at(i, j);
                if (up - down >= parameters.clearance) continue;
                if (parameters.crossing == Crossing::refuse)
                    core::refuse("LayerParameters.penetration_depth", core::text(parameters.penetration_depth),
                                 "less: at x = " + core::text(x(i)) + ", y = " + core::text(y(j)) + " the inner faces are " +
                                     core::text(up - down) + " apart, less than the clearance " +
                                     core::text(parameters.clearance));
                const double middle = 0.5 * (up + down);
                up = middle + 0.5 * parameters.clearance, down = middle - 0.5 * parameters.clearance;
                ++layers.clipped;
            }
    } else {
        for (Index j = 0; j < ny; ++j)
            for (Index i = 0; i < nx; ++i) {
                const auto other = surface.height(x(i), y(j), -signs[0]);
                if (other && signs[0] * (faces[0].at(i, j) - *other) < 0.0)
                    core::refuse("LayerParameters.penetration_depth", core::text(parameters.penetration_depth),
                                 "less: at x = " + core::text(x(i)) + ", y = " + core::text(y(j)) +
                                     " the inner face comes out of the fibres on the other side");
            }
    }
    // Shares of the thickness from the inner face on.
    std::vector<double> share{0.0};
    for (Index k = 0; k < parameters.through; ++k)
        share.push_back(share.back() + (parameters.through == 1
                                            ? 1.0
                                            : std::pow(parameters.grading,
                                                       static_cast<double>(k) / static_cast<double>(parameters.through - 1))));
    for (double& s : share) s /= share.back();
    for (std::size_t side = 0; side < signs.size(); ++side) {
        const bool upper = signs[side] > 0.0;
        const std::string name = upper ? "LayerParameters.upper_face" : "LayerParameters.lower_face";
        const double outer = upper ? parameters.upper_face : parameters.lower_face;
        Layer layer;
        layer.cells = {nx - 1, ny - 1, parameters.through};
        layer.solid.material = parameters.material;
        for (Index j = 0; j < ny; ++j)
            for (Index i = 0; i < nx; ++i) {
                const double thickness = signs[side] * (outer - faces[side].at(i, j));
                core::require(thickness >= parameters.least_thickness, name, outer,
                              std::string(upper ? "higher" : "lower") + ": at x = " + core::text(x(i)) +
                                  ", y = " + core::text(y(j)) + " the layer is " + core::text(thickness) +
                                  " thick, less than least_thickness = " + core::text(parameters.least_thickness));
            }
        for (Index k = 0; k <= parameters.through; ++k) {
            const double s = upper ? share[core::at(k)] : share[core::at(parameters.through - k)];
            for (Index j = 0; j < ny; ++j)
                for (Index i = 0; i < nx; ++i)
                    layer.solid.nodes.push_back({x(i), y(j), faces[side].at(i, j) + s * (outer - faces[side].at(i, j))});
        }
        for (Index k = 0; k < parameters.through; ++k)
            for (Index j = 0; j + 1 < ny; ++j)
                for (Index i = 0; i + 1 < nx; ++i)
                    layer.solid.cells.push_back({layer.node(i, j, k), layer.node(i + 1, j, k), layer.node(i + 1, j + 1, k),
                                                 layer.node(i, j + 1, k), layer.node(i, j, k + 1), layer.node(i + 1, j, k + 1),
                                                 layer.node(i + 1, j + 1, k + 1), layer.node(i, j + 1, k + 1)});
        require_valid_cells(layer.solid);
        layers.list.push_back(std::move(layer));
    }
    return layers;
}

}  // namespace fibrant::solid
