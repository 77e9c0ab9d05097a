// SPDX-License-Identifier: MIT
#pragma once
/// @file The repeating cell of a fabric: tows end half way between crossings, and each end is the image of the other.

#include <fibrant/compositions/weave/fabric.hpp>
#include <fibrant/simulation/model.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace fibrant::compositions::weave {

/// How a periodic cell is driven: under tension while it settles, by its strains when it is loaded.
enum class CellDrive { tension, strain };

/// Channels of the strains of a cell; amplitudes are strains.
inline constexpr std::array cell_strain_channels{"strain_x", "strain_y"};

/// Scene of a periodic cell before it is settled, or, started from what that left, while it is loaded.
///
/// The overhang is half the spacing of the tows that are crossed, so that a tow is as long as the cell and the seams lie where no
/// tow crosses: fibres touch their neighbours of the same tow there, on both sides of the seam alike, and no contact crosses it.
/// Tows do not touch their images beside the cell; a cell of two tows each way knows the gap between neighbours from inside.
/// All of them together keep their place: that carries no force. While it settles, each tow keeps its mean place along itself.
/// @param tension_strain  tension of a tow over its E A at amplitude 1 of the tension channel [1], > 0
inline scene::Assembly periodic_fabric(const FabricParameters& fabric, CellDrive drive, double tension_strain) {
    fabric.validate();
    core::require_positive("periodic_fabric.tension_strain", tension_strain);
    for (const double spacing : {fabric.warp_spacing, fabric.weft_spacing})
        core::require(std::abs(fabric.overhang - 0.5 * spacing) < 1e-9 * spacing, "FabricParameters.overhang", fabric.overhang,
                      "half the spacing of the tows, in a periodic cell");
    scene::Assembly assembly;
    const std::array<std::vector<Index>, 2> groups = add_flat_fibres(assembly, fabric);
    scene::PeriodicCell cell;
    cell.name = "cell";
    for (const Family family : {Family::warp, Family::weft}) {
        const int axis = family == Family::warp ? 0 : 1;
        const double force = tension_strain * static_cast<double>(fabric.tows(family)) * fabric.tow(family).axial_stiffness();
        cell.component(axis, axis) = drive == CellDrive::tension
                                         ? scene::Coordinate::under(force * fabric.fibre_length(family), tension_channel)
                                         : scene::Coordinate::held_at(1.0, cell_strain_channels[static_cast<std::size_t>(axis)]);
    }
    const Index of = assembly.add(cell), ground = assembly.add(scene::RigidBody{});
    scene::AverageConnection height{.ends = {}, .body = ground, .tied = {false, false, true}};
    for (Index f = 0; f < fabric.fibres(); ++f) {
        const FibrePlace place = fabric.place(f);
        const Vec3 along = place.family == Family::warp ? Vec3::UnitX() : Vec3::UnitY();
        assembly.connect(
            scene::PeriodicPair{scene::first_end(f), scene::last_end(f), fabric.fibre_length(place.family) * along, of});
        assembly.hold_axial_rotation({f, 0.5});
        height.ends.push_back({f, 0.25});
    }
    assembly.connect(height);
    // Tows that have not met yet would drift along themselves. In a cell that is loaded their crimp holds them, and all of them
    // together are held by a force that is nothing.
    scene::AverageConnection all{.ends = {}, .body = ground, .tied = {true, true, false}};
    for (const Family family : {Family::warp, Family::weft})
        for (Index tow = 0; tow < fabric.tows(family); ++tow) {
            scene::AverageConnection middle{
                .ends = {}, .body = ground, .tied = {family == Family::warp, family == Family::weft, false}};
            for (Index k = 0; k < fabric.tow(family).fibres; ++k) middle.ends.push_back({fabric.fibre(family, tow, k), 0.5});
            if (drive == CellDrive::tension) assembly.connect(middle);
            all.ends.insert(all.ends.end(), middle.ends.begin(), middle.ends.end());
        }
    if (drive == CellDrive::strain) assembly.connect(all);
    force_pattern(assembly, fabric, groups);
    return assembly;
}

/// Volume times mean nominal stress of a cell, from the forces in fibres and contacts: the work that they do on a displacement
/// gradient of the places of the fibres at rest, between whose ends the periods lie; directors stay. At equilibrium what the
/// ties of the seams say.
template <class Simulator>
Mat3 virial(const Simulator& simulator) {
    using Mesh = typename Simulator::Mesh;
    const Mesh& mesh = simulator.mesh();
    const Vector& origin = mesh.rest_state();
    Mat3 sum = Mat3::Zero();
    const auto add = [&](const Vector& forces, Index first, Index vectors) {
        for (Index v = 0; v < vectors; ++v)
            if (mesh.layout().kind[core::at(first / 3 + v)] == scene::VectorKind::position)
                sum += forces.template segment<3>(3 * v) * origin.template segment<3>(first + 3 * v).transpose();
    };
    for (Index f = 0; f < mesh.fibre_count(); ++f)
        for (Index e = 0; e < mesh.fibre(f).elements; ++e)
            add(Vector(simulator.beam().internal_force(mesh.rest(f, e), mesh.element(simulator.state(), f, e))),
                mesh.first_unknown(f, e), Mesh::element_unknowns / 3);
    Vector forces = Vector::Zero(simulator.state().size());
    simulator.contacts().add_forces(forces);
    add(forces, 0, forces.size() / 3);
    return sum;
}

}  // namespace fibrant::compositions::weave
