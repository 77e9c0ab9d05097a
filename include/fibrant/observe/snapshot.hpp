// SPDX-License-Identifier: MIT
#pragma once
/// @file What an observer is shown after an accepted increment: plain data, free of the model's types.

#include <fibrant/core/types.hpp>
#include <fibrant/scene/cross_section.hpp>

#include <array>
#include <string>
#include <vector>

namespace fibrant::observe {

/// The curve between the nodes of a fibre.
enum class Interpolation {
    linear,     ///< straight from node to node
    quadratic,  ///< elements of three nodes (0, 1, 2), (2, 3, 4), ...
    cubic,      ///< by slopes at the nodes, which are not told
};

/// One fibre: values at its nodes, in order.
struct FibreSnapshot {
    Interpolation interpolation = Interpolation::quadratic;
    std::vector<Vec3> position;      ///< centreline x_0 [length]
    std::vector<Vec3> displacement;  ///< since the rest shape [length]
    std::vector<Vec3> director_1;    ///< g_1 [1]
    std::vector<Vec3> director_2;    ///< g_2 [1]
    std::vector<double> curvature;   ///< of the centreline, |x' x x''| / |x'|^3 [1 / length]
    scene::CrossSection section;     ///< at rest
    Index group = -1;                ///< innermost group of the scene
    bool closed = false;             ///< its last node is its first one
    std::vector<Index> inside;       ///< tubes that it is in
};

/// One contact element; fibre i < j, the normal points from i to j.
struct ContactSnapshot {
    Index fibre_i = -1, fibre_j = -1;
    double abscissa_i = 0, abscissa_j = 0;  ///< rest arc length [length]
    Vec3 position = Vec3::Zero();           ///< middle of the two particles [length]
    Vec3 normal = Vec3::Zero();             ///< N [1]
    double gap = 0;                         ///< < 0 in penetration [length]
    double reaction = 0;                    ///< R_N >= 0 [force], on fibre j along +N
    Vec3 friction = Vec3::Zero();           ///< R_T on fibre i [force]
    double stiffness = 0;                   ///< k_N of the zone [force / length]
    bool crossing = false;                  ///< one element for the whole zone
};

/// A contact of a fibre with a rigid tool; the normal points away from the tool.
struct ToolContactSnapshot {
    Index fibre = -1, tool = -1;
    double abscissa = 0;           ///< rest arc length [length]
    Vec3 position = Vec3::Zero();  ///< of the tool's point below the particle [length]
    Vec3 normal = Vec3::Zero();    ///< [1]
    double gap = 0;                ///< < 0 in penetration [length]
    double reaction = 0;           ///< >= 0 [force], on the fibre along the normal
    Vec3 friction = Vec3::Zero();  ///< on the tool [force]
    double stiffness = 0;          ///< [force / length]
};

/// A bonding element.
struct BondSnapshot {
    Vec3 position = Vec3::Zero();  ///< of the fibre's node [length]
    Vec3 force = Vec3::Zero();     ///< on the solid [force]
    bool holds = true;
};

/// All solids; empty where there is none.
struct SolidSnapshot {
    std::vector<Vec3> position, displacement;  ///< of the nodes [length]
    std::vector<std::array<Index, 8>> cells;   ///< nodes of each cell
    std::vector<Mat3> strain, stress;          ///< means over a cell: Green-Lagrange [1], Cauchy [force / length^2]
    std::vector<BondSnapshot> bonds;
};

/// State after an accepted increment.
struct Snapshot {
    Index increment = 0;  ///< accepted increments so far
    std::string stage;    ///< name of the loading stage
    double progress = 0;  ///< of the whole loading, in [0, 1]
    std::vector<FibreSnapshot> fibres;
    std::vector<ContactSnapshot> contacts;           ///< active ones and candidates, sorted by fibres and abscissa
    std::vector<ToolContactSnapshot> tool_contacts;  ///< sorted by fibre, tool and abscissa
    SolidSnapshot solid;
};

}  // namespace fibrant::observe
