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
///
/// A bond of a section has the same form: it ties a director g to the displacement gradient F of the cell, R = k_s (g - F G), for
/// F G is a sum of the cell's nodes too, with weights w_J = grad N_J . G that sum to nothing. R is then a force on the director
/// [force * length].
struct Bond {
    Index vector = -1;     ///< nodal vector of the fibre that it holds, among all
    bool section = false;  ///< holds a director; follows the bond of the same node's position
    Index solid = -1, cell = -1;
    std::array<Index, 8> nodes{};  ///< of the cell, numbered through all solids
    solid::CellWeights weights = solid::CellWeights::Zero();
    double stiffness = 0.0;     ///< k_b [force / length]
    double surface = 0.0;       ///< of the fibre that the node stands for [length^2]
    double fibre_volume = 0.0;  ///< that the node stands for [length^3]
    Vec3 point = Vec3::Zero();  ///< natural coordinates in the cell
};

/// k_b = factor l_f 2 pi G_m / ln(h_m / (2 r)), the logarithm at least ln 2.
///
/// The shear lag of a rigid fibre in a cylinder of the radius h_m / 2 that holds still, on the length l_f. Per length
/// of fibre it does not depend on the fibre's mesh; it grows as cells shrink, and no further once they are of the size 4 r: a
/// mesh finer than that resolves the fibre's surroundings itself, and indents at the nodes.
/// @param cell_size  h_m, cube root of the cell's volume [length]
inline double bonding_stiffness(double factor, double shear_modulus, double length, double radius, double cell_size) noexcept {
    const double log = std::max(std::log(cell_size / (2.0 * radius)), std::numbers::ln2);
    return factor * length * 2.0 * std::numbers::pi * shear_modulus / log;
}

/// k_s = factor l_f A 2 G_m c / (1 - V), c = 16 (1 - nu) / (9 - 12 nu): of each director, for the volume l_f A of fibre.
///
/// A stiff cylinder in a matrix that is strained by e far away holds its place against e, and that costs A 2 G_m c e:e a length
/// (Eshelby): c = 4 (1 - nu) / (3 - 4 nu) for shear across it, 1 for shear along it and for its turning, (1 - nu) / (1 - 2 nu)
/// times 2 for a change of its area. A section on springs of that stiffness between it and the mean strain around gives the
/// stiffness of a dilute suspension, and divided by 1 - V, V the fibres' part of the cell, the lower bound of Hashin and
/// Shtrikman. One c stands for all, as a constant matrix that a rotation leaves alone has to: 4/3 of that of shear, so that
/// Young's modulus across the fibres reaches the lower bound too, up to V = 0.65 and nu = 0.4; shear then lies above it by up to
/// a fifth.
/// @param volume    l_f A [length^3]
/// @param fraction  V [1], counted as at most that of touching round fibres in a square array
inline double section_stiffness(double factor, const scene::ElasticMaterial& material, double volume, double fraction) noexcept {
    const double nu = material.poisson_ratio, shape = 16.0 * (1.0 - nu) / (9.0 - 12.0 * nu);
    return factor * volume * 2.0 * material.shear_modulus() * shape / (1.0 - std::min(fraction, 0.25 * std::numbers::pi));
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

/// Weights of a cell's nodes whose sum moves as the displacement gradient at a point says for a rest vector.
inline solid::CellWeights gradient_weights(const scene::Solid& solid, Index cell, const Vec3& point, const Vec3& rest) {
    return solid::shape_derivatives(point) * (solid::jacobian(solid::cell_nodes(solid, cell), point).inverse() * rest);
}

/// [length^3]
inline double cell_volume(const scene::Solid& solid, Index cell) {
    const auto nodes = solid::cell_nodes(solid, cell);
    double volume = 0.0;
    for (int k = 0; k < 8; ++k) volume += solid::jacobian(nodes, solid::corner(k) / std::sqrt(3.0)).determinant();
    return volume;
}

/// After each bond of a position those of the section's two directors.
template <beam::BeamElement B>
std::vector<Bond> with_sections(const std::vector<Bond>& bonds, const std::vector<scene::Solid>& solids, const Vector& state,
                                double factor) {
    std::vector<std::vector<double>> filled;  // volume of fibres in each cell
    for (const scene::Solid& solid : solids) filled.emplace_back(solid.cells.size(), 0.0);
    for (const Bond& bond : bonds) filled[core::at(bond.solid)][core::at(bond.cell)] += bond.fibre_volume;
    std::vector<Bond> all;
    for (const Bond& bond : bonds) {
        all.push_back(bond);
        const scene::Solid& solid = solids[core::at(bond.solid)];
        const double fraction = filled[core::at(bond.solid)][core::at(bond.cell)] / cell_volume(solid, bond.cell);
        for (Index v = 1; v < B::vectors_per_node; ++v) {
            Bond section = bond;
            section.section = true, section.vector = bond.vector + v;
            section.weights = gradient_weights(solid, bond.cell, bond.point, state.segment<3>(3 * section.vector));
            section.stiffness = section_stiffness(factor, solid.material, bond.fibre_volume, fraction);
            all.push_back(section);
        }
    }
    return all;
}

/// Bonds of all nodes of fibres that lie in a cell of a solid at `state`; a node in several solids is bonded to the first.
/// Sorted by node.
/// @param factor          on the stiffness [1], > 0
/// @param section_factor  on that of the bonds of sections [1], >= 0; 0: there are none
template <beam::BeamElement B>
std::vector<Bond> find_bonds(const beam::Mesh<B>& mesh, const std::vector<scene::Solid>& solids, const Vector& state,
                             double factor, double section_factor = 0.0) {
    if (beam::TurningSections<B> && section_factor > 0.0)
        core::refuse("BondedSolid.section_factor", core::text(section_factor), "0 for a beam whose sections turn");
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
        for (Index a = 0; a < mesh.own_nodes(f); ++a) {
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
                const bool end = !fibre.closed && (a == 0 || a + 1 == mesh.node_count(f));
                double share = end ? 0.5 : 1.0;
                if constexpr (B::nodes == 3) share = a % 2 == 1 ? 4.0 / 6.0 : end ? 1.0 / 6.0 : 2.0 / 6.0;
                const double length = share * fibre.element_length;
                const double volume = cell_volume(solid, found.cell);
                bond.stiffness = bonding_stiffness(factor, solid.material.shear_modulus(), length, radius, std::cbrt(volume));
                bond.surface = 2.0 * std::numbers::pi * radius * length;
                bond.fibre_volume = length * fibre.section.area();
                of_fibre[core::at(f)].push_back(bond);
                break;
            }
        }
    });
    std::vector<Bond> bonds;
    for (const std::vector<Bond>& own : of_fibre) bonds.insert(bonds.end(), own.begin(), own.end());
    return section_factor > 0.0 ? with_sections<B>(bonds, solids, state, section_factor) : bonds;
}

}  // namespace fibrant::connection
