// SPDX-License-Identifier: MIT
#pragma once
/// @file The scene of a rope. What holds its ends, what draws and turns it and what is measured on it are those of a strand
/// (strand.hpp).

#include <fibrant/compositions/strand/rope_parameters.hpp>
#include <fibrant/compositions/strand/strand.hpp>

namespace fibrant::compositions::strand {

/// The wires without conditions, strand by strand, the one in the middle first; in each the core first. Each strand is a group.
inline scene::Assembly wires_of(const RopeParameters& parameters) {
    parameters.validate();
    scene::Assembly assembly;
    for (Index strand = 0; strand < parameters.strands(); ++strand) {
        const Index group = assembly.add_group("strand " + std::to_string(strand));
        for (const WireLine& line : parameters.lines(strand)) {
            scene::FibreSpecification fibre;
            fibre.section = scene::circular(line.radius), fibre.material = parameters.material,
            fibre.elements = parameters.elements, fibre.group = group;
            const double first = line.at_height(0.0), last = line.at_height(parameters.length);
            const Vec3 aside = line.place(first) - Vec3(0, 0, line.place(first).z());
            fibre.director = aside.norm() > 0.0 ? aside : Vec3(Vec3::UnitX());
            if (line.helix_radius > 0.0 || line.distance > 0.0)
                fibre.curve = [=](double t) { return line.place(first + t * (last - first)); };
            else
                fibre.from = Vec3::Zero(), fibre.to = Vec3(0, 0, parameters.length);
            assembly.add(fibre);
        }
    }
    return assembly;
}

/// The rope between two plates that hold its wires.
inline scene::Assembly straight_rope(const RopeParameters& parameters) {
    scene::Assembly assembly = wires_of(parameters);
    hold_between_plates(assembly, parameters.length);
    return assembly;
}

}  // namespace fibrant::compositions::strand
