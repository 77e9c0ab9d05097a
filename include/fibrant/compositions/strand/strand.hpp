// SPDX-License-Identifier: MIT
#pragma once
/// @file The scene of a strand, what holds its two ends, and what is measured on it.

#include <fibrant/compositions/strand/strand_parameters.hpp>
#include <fibrant/scene/assembly.hpp>
#include <fibrant/simulation/support_wrench.hpp>

#include <string>
#include <vector>

namespace fibrant::compositions::strand {

/// Channels of the far end. The amplitude of `stretch` is the strain of the strand, that of `twist` the rotation a length of its
/// ends, positive where it tightens a right-handed helix [radian / length].
inline const std::string stretch = "stretch", twist = "twist";

/// The wires without conditions: the core is fibre 0, then each layer, wires in the order of their angle.
inline scene::Assembly wires_of(const StrandParameters& parameters) {
    parameters.validate();
    scene::Assembly assembly;
    const Index group = assembly.add_group("core");
    scene::FibreSpecification core{.from = Vec3::Zero(),
                                   .to = {0, 0, parameters.length},
                                   .section = scene::circular(parameters.core_radius),
                                   .material = parameters.material,
                                   .elements = parameters.elements,
                                   .director = Vec3::UnitX(),
                                   .group = group};
    assembly.add(core);
    for (std::size_t k = 0; k < parameters.layers.size(); ++k) {
        const Layer& layer = parameters.layers[k];
        const Index own = assembly.add_group("layer " + std::to_string(k + 1));
        const double a = parameters.helix_radius(k), turn = parameters.turn_rate(k) * parameters.length,
                     length = parameters.length;
        for (Index wire = 0; wire < layer.wires; ++wire) {
            const double start = 2.0 * std::numbers::pi * static_cast<double>(wire) / static_cast<double>(layer.wires);
            scene::FibreSpecification fibre;
            fibre.curve = [=](double t) {
                return Vec3(a * std::cos(start + turn * t), a * std::sin(start + turn * t), length * t);
            };
            fibre.section = scene::circular(layer.radius);
            fibre.material = parameters.material_of(layer);
            fibre.elements = parameters.elements;
            fibre.director = Vec3(std::cos(start), std::sin(start), 0.0);
            fibre.group = own;
            assembly.add(fibre);
        }
    }
    return assembly;
}

/// Two plates, at z = 0 and z = length, that hold every fibre along the axis and around it, and its turn about itself. Fibres may
/// move towards the axis and tilt, so that the plates hardly disturb the state in between.
inline void hold_between_plates(scene::Assembly& assembly, double length) {
    for (Index fibre = 0; fibre < core::count(assembly.fibres()); ++fibre)
        for (const double end : {0.0, 1.0}) {
            const scene::FibreSpecification& wire = assembly.fibres()[core::at(fibre)];
            const Vec3 place = wire.curve ? wire.curve(end) : Vec3(0, 0, end * length);
            const auto turned = [=](double amplitude) {
                return Mat3(Eigen::AngleAxisd(end * amplitude * length, Vec3::UnitZ()));
            };
            scene::Hold along;
            along.at = {fibre, end}, along.channel = stretch;
            along.directions = Vec3(0, 0, 1).asDiagonal();
            along.displacement = Vec3(0, 0, end * length);
            assembly.hold(along);
            scene::Hold around;
            around.at = {fibre, end}, around.channel = twist, around.rotation = turned;
            const Vec3 aside = Vec3::UnitZ().cross(place);
            around.directions = aside.norm() < 1e-9 * length ? Mat3(Vec3(1, 1, 0).asDiagonal())
                                                             : Mat3(aside.normalized() * aside.normalized().transpose());
            assembly.hold(around);
            // About itself: both off-axis components, as Assembly::hold_axial_rotation does.
            around.axes = scene::Axes::section;
            around.vector = scene::NodeVector::director_1, around.directions = Vec3(0, 1, 0).asDiagonal();
            assembly.hold(around);
            around.vector = scene::NodeVector::director_2, around.directions = Vec3(1, 0, 0).asDiagonal();
            assembly.hold(around);
        }
}

/// The strand between two plates that hold its wires.
inline scene::Assembly straight_strand(const StrandParameters& parameters) {
    scene::Assembly assembly = wires_of(parameters);
    hold_between_plates(assembly, parameters.length);
    return assembly;
}

/// What the far end of a strand exerts, and how the middle half of it is strained: there the ends are not felt.
struct StrandState {
    double force = 0.0;     ///< along the axis [force]
    double torque = 0.0;    ///< about the axis [force * length]
    double strain = 0.0;    ///< of the middle half, mean of core and wires by their number [1]
    double rotation = 0.0;  ///< of the middle half, a length at rest, mean of the wires [radian / length]
};

/// Pull, torque, strain and rotation of a strand in the present state of a run.
/// @param parameters  of a strand, or of what else has wires of so many elements between two plates, the first of them straight
template <simulation::Model M, class Parameters>
StrandState measure(const simulation::Simulator<M>& simulator, const Parameters& parameters) {
    std::vector<scene::Station> ends;
    for (Index fibre = 0; fibre < parameters.wires(); ++fibre) ends.push_back(scene::last_end(fibre));
    const simulation::Wrench wrench = simulation::support_wrench(simulator, ends);
    StrandState state{wrench.force.z(), wrench.moment.z()};
    const double n = static_cast<double>(parameters.elements);
    for (Index fibre = 0; fibre < parameters.wires(); ++fibre) {
        const auto& mesh = simulator.mesh();
        const auto span = [&](const Vector& at) {
            return Vec3(mesh.position(at, fibre, 0.75 * n) - mesh.position(at, fibre, 0.25 * n)).z();
        };
        const double rest = span(mesh.rest_state());
        state.strain += (span(simulator.state()) / rest - 1.0) / static_cast<double>(parameters.wires());
        if (fibre == 0) continue;
        const auto moved = [&](double u) {  // about the axis
            const Vec3 then = mesh.position(mesh.rest_state(), fibre, u), now = mesh.position(simulator.state(), fibre, u);
            return std::atan2(then.x() * now.y() - then.y() * now.x(), then.x() * now.x() + then.y() * now.y());
        };
        state.rotation += (moved(0.75 * n) - moved(0.25 * n)) / rest / static_cast<double>(parameters.wires() - 1);
    }
    return state;
}

}  // namespace fibrant::compositions::strand
