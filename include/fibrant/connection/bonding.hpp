// SPDX-License-Identifier: MIT
#pragma once
/// @file Bonding elements: nodes of fibres tied to the material points of a solid in which they lie.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/solid/cell_search.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <numbers>
#include <vector>

namespace fibrant::connection {

/// A bonding element: R = k_b (x_f - sum w_J X_J) on the solid, against it on the fibre (Durville, section 15.3.3).
///
/// The energy k_b |.|^2 / 2 has the constant tangent k_b v v^T (x) 1 with v = (w_1 ... w_8, -1).
struct Bond {
    Index vector = -1;                 ///< position of the fibre's node among all nodal vectors
    Index solid = -1, cell = -1;
    std::array<Index, 8> nodes{};      ///< of the cell, numbered through all solids
    solid::CellWeights weights = solid::CellWeights::Zero();
    double stiffness = 0.0;            ///< k_b [force / length]
    double surface = 0.0;              ///< of the fibre that the node stands for [length^2]
    Vec3 point = Vec3::Zero();         ///< natural coordinates in the cell
};

/// k_b = factor l_f 2 pi G_m / ln(h_m / (2 r)), the logarithm at least ln 2.
///
/// The shear lag of a rigid fibre in a cylinder of the radius h_m / 2 that holds still, on the length l_f (METHOD 7). Per length
/// of fibre it does not depend on the fibre's mesh; it grows as cells shrink, and no further once they are of the size 4 r: a mesh
/// finer than that resolves the fibre's surroundings itself, and indents at the nodes.
/// @param cell_size  h_m, cube root of the cell's volume [length]
inline double bonding_stiffness(double factor, double shear_modulus, double length, double radius, double cell_size) noexcept {
    const double log = std::max(std::log(cell_size / (2.0 * radius)), std::numbers::ln2);
    return factor * length * 2.0 * std::numbers::pi * shear_modulus / log;
}

/// When bonds break. Asked once an increment has been accepted.
template <class D>
concept DebondingLaw = core::Policy<D> && requires(const D law, const Bond& bond, double force) {
    { law.breaks(bond, force) } -> std::same_as<bool>;
};
struct NeverDebonds : core::Inactive {
    using Parameters = core::NoParameters;
    NeverDebonds() = default;
    explicit NeverDebonds(const Parameters&) {}
    bool breaks(const Bond&, double) const noexcept { return false; }
};
static_assert(DebondingLaw<NeverDebonds> && std::is_empty_v<NeverDebonds>);

/// Breaks for good where the mean traction on the fibre's surface exceeds a strength.
class DebondsAtTraction {
public:
    struct Parameters {
        double strength = core::unset;  ///< [force / length^2], > 0
        void validate() const { core::require_positive("DebondsAtTraction.strength", strength); }
    };
    explicit DebondsAtTraction(const Parameters& parameters) : parameters_{core::validated(parameters)} {}
    bool breaks(const Bond& bond, double force) const noexcept { return force > parameters_.strength * bond.surface; }

private:
    Parameters parameters_;
};
static_assert(DebondingLaw<DebondsAtTraction>);

/// Bonds of all nodes of fibres that lie in a cell of a solid at `state`; a node in several solids is bonded to the first.
/// Sorted by node.
/// @param factor  on the stiffness [1], > 0
template <beam::BeamElement B>
std::vector<Bond> find_bonds(const beam::Mesh<B>& mesh, const std::vector<scene::Solid>& solids, const Vector& state, double factor) {
    std::vector<solid::CellSearch> searches;
    std::vector<Index> first{0};
    for (const scene::Solid& solid : solids) {
        searches.emplace_back(solid);
        first.push_back(first.back() + core::count(solid.nodes));
    }
    std::vector<std::vector<Bond>> of_fibre(core::at(mesh.fibre_count()));
    core::parallel_for(mesh.fibre_count(), [&](Index f) {
        const beam::MeshFibre& fibre = mesh.fibre(f);
        const double radius = fibre.section.radius();
        for (Index a = 0; a < mesh.node_count(f); ++a) {
            const Vec3 place = state.segment<3>(3 * mesh.node_vector(f, a));
            for (Index s = 0; s < core::count(solids); ++s) {
                const solid::CellSearch::Found found = searches[core::at(s)].find(place);
                if (found.cell < 0) continue;
                const scene::Solid& solid = solids[core::at(s)];
                Bond bond;
                bond.vector = mesh.node_vector(f, a);
                bond.solid = s, bond.cell = found.cell, bond.point = found.xi;
                for (std::size_t k = 0; k < 8; ++k) bond.nodes[k] = first[core::at(s)] + solid.cells[core::at(found.cell)][k];
                bond.weights = solid::shape(found.xi);
                // The length that a node stands for: its share in the integral along an element.
                const bool end = a == 0 || a + 1 == mesh.node_count(f);
                double share = end ? 0.5 : 1.0;
                if constexpr (B::nodes == 3) share = a % 2 == 1 ? 4.0 / 6.0 : end ? 1.0 / 6.0 : 2.0 / 6.0;
                const double length = share * fibre.element_length;
                double volume = 0.0;
                const auto nodes = solid::cell_nodes(solid, found.cell);
                for (int k = 0; k < 8; ++k) volume += solid::jacobian(nodes, solid::corner(k) / std::sqrt(3.0)).determinant();
                bond.stiffness = bonding_stiffness(factor, solid.material.shear_modulus(), length, radius, std::cbrt(volume));
                bond.surface = 2.0 * std::numbers::pi * radius * length;
                of_fibre[core::at(f)].push_back(bond);
                break;
            }
        }
    });
    std::vector<Bond> bonds;
    for (const std::vector<Bond>& own : of_fibre) bonds.insert(bonds.end(), own.begin(), own.end());
    return bonds;
}

}  // namespace fibrant::connection
