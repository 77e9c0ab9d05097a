// SPDX-License-Identifier: MIT
#pragma once
/// @file What repeats: several cells side by side, gaps across their seams, and the stiffness of a cell.

#include <fibrant/compositions/textile/assemble.hpp>
#include <fibrant/observe/least_gap.hpp>
#include <fibrant/observe/snapshot.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::compositions::textile {

/// From the start of each periodic path to its end in a state, the mean of its fibres; nothing for others [length].
inline std::vector<Vec3> images_of(const Textile& textile, const Assembled& assembled, const observe::Snapshot& snapshot) {
    std::vector<Vec3> images(textile.paths.size(), Vec3::Zero());
    for (std::size_t f = 0; f < snapshot.fibres.size(); ++f) {
        const Index p = assembled.path_of[f];
        if (textile.paths[core::at(p)].kind == PathKind::periodic)
            images[core::at(p)] += (snapshot.fibres[f].position.back() - snapshot.fibres[f].position.front()) /
                                   static_cast<double>(textile.type_of(p).fibres);
    }
    return images;
}

/// Periods of the cell in a state: of each of the lattice, that of the paths that repeat by it [length].
/// @throws std::invalid_argument for a period that no path repeats by
inline std::vector<Vec3> periods_of(const Textile& textile, const std::vector<Vec3>& images) {
    std::vector<Vec3> periods;
    for (const Vec3& period : textile.lattice) {
        Vec3 sum = Vec3::Zero();
        double count = 0.0;
        for (std::size_t p = 0; p < images.size(); ++p)
            if (textile.paths[p].kind == PathKind::periodic && textile.paths[p].image.isApprox(period, 1e-9))
                sum += images[p], count += 1.0;
        if (count == 0.0) core::refuse("Textile.lattice", scene::text(period), "an image of a path");
        periods.push_back(sum / count);
    }
    return periods;
}

/// Two cells each way: what repeats is joined to its image, and both are there once more beside. Their least gap is that of the
/// endless textile.
inline observe::Snapshot doubled(const Textile& textile, const Assembled& assembled, const observe::Snapshot& snapshot) {
    observe::Snapshot answer = snapshot;
    answer.contacts.clear();
    const std::vector<Vec3> periods = periods_of(textile, images_of(textile, assembled, snapshot));
    std::vector<Index> path_of = assembled.path_of;
    for (std::size_t k = 0; k < periods.size(); ++k) {
        const std::size_t count = answer.fibres.size();
        for (std::size_t f = 0; f < count; ++f) {
            const Path& path = textile.paths[core::at(path_of[f])];
            observe::FibreSnapshot image = answer.fibres[f];
            for (Vec3& position : image.position) position += periods[k];
            if (path.kind != PathKind::periodic || !path.image.isApprox(textile.lattice[k], 1e-9)) {
                answer.fibres.push_back(std::move(image)), path_of.push_back(path_of[f]);
                continue;
            }
            observe::FibreSnapshot& fibre = answer.fibres[f];
            const auto join = [](auto& whole, const auto& more) {
                if (!more.empty()) whole.insert(whole.end(), more.begin() + 1, more.end());
            };
            join(fibre.position, image.position), join(fibre.displacement, image.displacement);
            join(fibre.director_1, image.director_1), join(fibre.director_2, image.director_2);
            join(fibre.curvature, image.curvature);
        }
    }
    return answer;
}

/// The true least gap of an endless textile, across seams and between a cell and those beside it.
template <proximity::ProximitySearch Search>
observe::LeastGap image_gap(const Textile& textile, const Assembled& assembled, const observe::Snapshot& snapshot,
                            Search search) {
    return observe::least_gap(doubled(textile, assembled, snapshot), std::move(search), observe::OwnTurns::counted);
}

/// Forces per length N_x, N_y, N_xy [force / length] and moments per length M of w,xx, w,yy and w,xy [force] of a cell that
/// repeats in the plane of x and y, in the order of cell_channels(): work per area of each strain.
using CellVector = Eigen::Matrix<double, 6, 1>;
using CellMatrix = Eigen::Matrix<double, 6, 6>;

/// Efforts of a cell in the present state of a run.
/// @param area  of the cell [length^2], > 0
template <class Simulator>
CellVector cell_efforts(const Simulator& simulator, double area) {
    const auto& ties = simulator.equilibrium().ties();
    const Mat3 force = ties.cell_force(0);
    CellVector efforts;
    efforts << force(0, 0), force(1, 1), 0.5 * (force(0, 1) + force(1, 0)), ties.cell_moment(0);
    return efforts / area;
}

/// What six small strains say of a cell, each by itself from the same state at rest, to both sides: the change of its efforts.
/// What yarns creep by themselves in an increment is the same on either side: it falls out of the difference.
struct CellStiffness {
    std::array<double, 6> amount{};              ///< of each strain, not 0
    CellVector unstrained = CellVector::Zero();  ///< efforts after an increment without a strain
    CellVector later = CellVector::Zero();       ///< after two
    std::vector<CellVector> efforts{};           ///< at each strain from rest, and at its opposite: 12
    CellMatrix matrix = CellMatrix::Zero();      ///< of what `evaluate` found
    double asymmetry = 0.0;                      ///< greatest |K_ij - K_ji| over sqrt(K_ii K_jj) [1]
    double creep = 0.0;  ///< greatest change of an effort in an increment without a strain, over what its own strain does [1]

    /// @throws std::invalid_argument unless there are 12 efforts
    void evaluate() {
        if (efforts.size() != 12) core::refuse("CellStiffness.efforts", std::to_string(efforts.size()), "12");
        for (std::size_t c = 0; c < 6; ++c)
            matrix.col(static_cast<Index>(c)) = 0.5 * (efforts[2 * c] - efforts[2 * c + 1]) / amount[c];
        creep = 0.0;
        for (Index i = 0; i < 6; ++i)
            if (const double own = std::abs(matrix(i, i) * amount[core::at(i)]); own > 0.0)
                creep = std::max(creep, std::abs(later[i] - unstrained[i]) / own);
        asymmetry = 0.0;
        for (Index i = 0; i < 6; ++i)
            for (Index j = 0; j < 6; ++j)
                if (const double unit = std::sqrt(std::abs(matrix(i, i) * matrix(j, j))); unit > 0.0)
                    asymmetry = std::max(asymmetry, std::abs(matrix(i, j) - matrix(j, i)) / unit);
    }
};

}  // namespace fibrant::compositions::textile
