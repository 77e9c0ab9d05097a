// SPDX-License-Identifier: MIT
#pragma once
/// @file A settled fabric between two layers of matrix, held at the edges across its warp.

#include <fibrant/compositions/composite/composite_parameters.hpp>
#include <fibrant/compositions/weave/fabric_parameters.hpp>
#include <fibrant/core/rotation.hpp>
#include <fibrant/observe/snapshot.hpp>
#include <fibrant/simulation/support_wrench.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace fibrant::compositions::composite {

using weave::FabricParameters;
using weave::Family;

/// Channel of the load; its amplitude goes from 0 to 1.
inline constexpr const char* load_channel = "load";

/// Sections of all fibres as the mesher wants them.
inline std::vector<std::vector<solid::SectionPlace>> sections_of(const observe::Snapshot& snapshot) {
    std::vector<std::vector<solid::SectionPlace>> fibres;
    for (const observe::FibreSnapshot& fibre : snapshot.fibres) {
        fibres.emplace_back();
        for (std::size_t k = 0; k < fibre.position.size(); ++k)
            fibres.back().push_back({fibre.position[k], fibre.section.semi_axis_1 * fibre.director_1[k], fibre.section.semi_axis_2 * fibre.director_2[k]});
    }
    return fibres;
}

/// Layers over the whole fabric, from the ends of its fibres to the opposite ones.
inline solid::Layers layers_of(const observe::Snapshot& snapshot, const FabricParameters& fabric, const MatrixParameters& matrix) {
    matrix.validate();
    const double radius = std::min(fabric.warp.fibre_radius, fabric.weft.fibre_radius);
    solid::LayerParameters parameters;
    parameters.low = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    parameters.high = {-parameters.low[0], -parameters.low[1]};
    double top = parameters.high[0], bottom = parameters.low[0];
    for (Index f = 0; f < core::count(snapshot.fibres); ++f) {
        const observe::FibreSnapshot& fibre = snapshot.fibres[core::at(f)];
        const std::size_t axis = fabric.place(f).family == Family::warp ? 0 : 1;
        const auto [a, b] = std::minmax(fibre.position.front()[static_cast<Index>(axis)], fibre.position.back()[static_cast<Index>(axis)]);
        parameters.low[axis] = std::min(parameters.low[axis], a), parameters.high[axis] = std::max(parameters.high[axis], b);
        for (std::size_t k = 0; k < fibre.position.size(); ++k) {
            const double reach = std::hypot(fibre.section.semi_axis_1 * fibre.director_1[k].z(), fibre.section.semi_axis_2 * fibre.director_2[k].z());
            top = std::max(top, fibre.position[k].z() + reach), bottom = std::min(bottom, fibre.position[k].z() - reach);
        }
    }
    parameters.cells = {matrix.cells_along, matrix.cells_across};
    parameters.through = matrix.through, parameters.grading = matrix.grading, parameters.smoothing = matrix.smoothing;
    parameters.upper_face = top + matrix.cover, parameters.lower_face = bottom - matrix.cover;
    parameters.penetration_depth = matrix.penetration_depth_over_radius * radius;
    parameters.clearance = matrix.clearance_over_radius * radius;
    parameters.least_thickness = matrix.least_thickness_over_cover * matrix.cover;
    parameters.sides = matrix.sides, parameters.crossing = matrix.crossing, parameters.material = matrix.material;
    return solid::mesh_layers(solid::FibreSurface(sections_of(snapshot)), parameters);
}

/// A rigid motion by the amplitude of the load: x -> pivot + rotation (x - pivot) + path.
struct EdgeMotion {
    Vec3 pivot = Vec3::Zero();
    std::function<Mat3(double)> rotation = [](double) { return Mat3(Mat3::Identity()); };
    std::function<Vec3(double)> path = [](double) { return Vec3(Vec3::Zero()); };
    Vec3 centre(double amplitude) const { return pivot + path(amplitude); }
};

/// Motions of the edges at x = -length / 2 and length / 2.
///
/// Bent, their centres stay on an arc of the length between them; twisted, they approach by what keeps the mean length over the
/// width, (width angle / length)^2 / 24 of the length. So the force between them is a result, and not zero as with free edge bodies.
inline std::pair<EdgeMotion, EdgeMotion> edge_motions(const LoadParameters& load, double length, double width) {
    load.validate();
    std::pair<EdgeMotion, EdgeMotion> edges;
    edges.first.pivot.x() = -0.5 * length, edges.second.pivot.x() = 0.5 * length;
    const double full = load.angle_deg * std::numbers::pi / 180.0;
    for (const double side : {-1.0, 1.0}) {
        EdgeMotion& edge = side < 0.0 ? edges.first : edges.second;
        switch (load.load) {
            case LoadCase::tension: edge.path = [=](double a) { return Vec3(0.5 * side * a * load.strain * length, 0, 0); }; break;
            case LoadCase::shear: edge.path = [=](double a) { return Vec3(0, 0.5 * side * a * load.strain * length, 0); }; break;
            case LoadCase::bending:
                edge.rotation = [=](double a) { return core::rotation(Vec3(0, 0.5 * side * a * full, 0)); };
                edge.path = [=](double a) {
                    const double half = 0.5 * a * full;
                    // length / (2 half) (sin half, 1 - cos half), near zero by its series
                    const double sine = std::abs(half) < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
                    const double rise = std::abs(half) < 1e-4 ? 0.5 * half : (1.0 - std::cos(half)) / half;
                    return Vec3(0.5 * length * side * (sine - 1.0), 0, -0.5 * length * rise);
                };
                break;
            case LoadCase::twisting:
                edge.rotation = [=](double a) { return core::rotation(Vec3(0.5 * side * a * full, 0, 0)); };
                edge.path = [=](double a) { return Vec3(-0.5 * side * std::pow(width * a * full / length, 2) / 24.0 * length, 0, 0); };
                break;
        }
    }
    return edges;
}

/// The composite as a scene, and what is held where.
struct Composite {
    scene::Assembly assembly;
    EdgeMotion west, east;
    double length = 0.0, width = 0.0;
    std::vector<scene::Station> east_ends;      ///< of fibres
    std::vector<Index> east_nodes;              ///< of the solids, numbered through both
};

/// @param state  of the fabric's fibres where it has settled
inline Composite composite_of(const FabricParameters& fabric, const Vector& state, const scene::Assembly& flat, const solid::Layers& layers,
                              const LoadParameters& load) {
    Composite composite;
    scene::Assembly& assembly = composite.assembly;
    for (const scene::Group& group : flat.groups()) assembly.add_group(group.name, group.parent);
    for (const scene::FibreSpecification& fibre : flat.fibres()) assembly.add(fibre);
    assembly.begin_at(state);
    Vec3 low = layers.list.front().solid.nodes.front(), high = low;
    for (const solid::Layer& layer : layers.list)
        for (const Vec3& node : layer.solid.nodes) low = low.cwiseMin(node), high = high.cwiseMax(node);
    composite.length = high.x() - low.x(), composite.width = high.y() - low.y();
    std::tie(composite.west, composite.east) = edge_motions(load, composite.length, composite.width);
    const auto hold_fibre = [&](const scene::Station& at, const EdgeMotion& edge) {
        scene::Hold hold;
        hold.at = at, hold.channel = load_channel;
        hold.rotation = edge.rotation, hold.path = edge.path, hold.pivot = edge.pivot;
        assembly.hold(hold);
        if (at.fraction > 0.5) return;
        // A fibre's turn about itself: nothing else may hold it.
        hold.path = {}, hold.axes = scene::Axes::section;
        hold.vector = scene::NodeVector::director_1, hold.directions = Vec3(0, 1, 0).asDiagonal();
        assembly.hold(hold);
        hold.vector = scene::NodeVector::director_2, hold.directions = Vec3(1, 0, 0).asDiagonal();
        assembly.hold(hold);
    };
    for (Index f = 0; f < fabric.fibres(); ++f) {
        if (fabric.place(f).family != Family::warp) continue;
        hold_fibre(scene::first_end(f), composite.west), hold_fibre(scene::last_end(f), composite.east);
        composite.east_ends.push_back(scene::last_end(f));
    }
    Index first = 0;
    for (const solid::Layer& layer : layers.list) {
        const Index number = assembly.add(layer.solid);
        for (const bool east : {false, true}) {
            const EdgeMotion& edge = east ? composite.east : composite.west;
            scene::SolidHold hold;
            hold.solid = number, hold.channel = load_channel;
            hold.rotation = edge.rotation, hold.path = edge.path, hold.pivot = edge.pivot;
            for (Index k = 0; k <= layer.cells[2]; ++k)
                for (Index j = 0; j <= layer.cells[1]; ++j) {
                    hold.nodes.push_back(layer.node(east ? layer.cells[0] : 0, j, k));
                    if (east) composite.east_nodes.push_back(first + hold.nodes.back());
                }
            assembly.hold(hold);
        }
        first += core::count(layer.solid.nodes);
    }
    return composite;
}

/// What the edge at the warps' last ends takes, about its centre.
template <simulation::Model M>
simulation::Wrench edge_wrench(const simulation::Simulator<M>& simulator, const Composite& composite) {
    const Vec3 centre = composite.east.centre(simulator.amplitude(load_channel));
    simulation::Wrench sum = simulation::support_wrench(simulator, composite.east_ends, centre);
    const auto& solid = simulator.equilibrium().solid();
    if (simulator.equilibrium().reaction().size() == 0) return sum;
    for (const Index node : composite.east_nodes) {
        const Index v = 3 * (solid.first_vector() + node);
        const Vec3 force = simulator.equilibrium().reaction().template segment<3>(v);
        sum.force += force;
        sum.moment += (Vec3(simulator.state().template segment<3>(v)) - centre).cross(force);
    }
    return sum;
}

/// One stage that takes the load from 0 to 1.
template <simulation::Model M>
simulation::Loading<M> loading_of(const FabricParameters& fabric, const LoadParameters& load) {
    simulation::Loading<M> loading;
    loading.stages.resize(1);
    simulation::Stage<M>& stage = loading.stages[0];
    stage.name = "load";
    stage.increments = load.increments, stage.most_increments = 50 * load.increments;
    stage.ramps = {{load_channel, 1.0}};
    stage.looseness = load.looseness;
    const auto& tow = fabric.warp;
    stage.damping = load.damping_over_stiffness * tow.material.young_modulus * tow.section().area() * static_cast<double>(fabric.elements) / fabric.fibre_length(Family::warp);
    return loading;
}

}  // namespace fibrant::compositions::composite
