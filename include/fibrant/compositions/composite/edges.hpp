// SPDX-License-Identifier: MIT
#pragma once
/// @file How the edges across the warp of a composite are moved: driven node by node, or tied to bodies by averages.

#include <fibrant/compositions/composite/composite_parameters.hpp>
#include <fibrant/compositions/weave/edges.hpp>
#include <fibrant/connection/rigid_bodies.hpp>
#include <fibrant/core/rotation.hpp>
#include <fibrant/simulation/support_wrench.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

namespace fibrant::compositions::composite {

using weave::FabricParameters;
using weave::Family;

/// Channel of the load; its amplitude goes from 0 to 1.
inline constexpr const char* load_channel = "load";

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
/// width, (width angle / length)^2 / 24 of the length. So the force between them is a result, and not zero as with free edge
/// bodies.
inline std::pair<EdgeMotion, EdgeMotion> edge_motions(const LoadParameters& load, double length, double width) {
    load.validate();
    std::pair<EdgeMotion, EdgeMotion> edges;
    edges.first.pivot.x() = -0.5 * length, edges.second.pivot.x() = 0.5 * length;
    const double full = load.angle_deg * std::numbers::pi / 180.0;
    for (const double side : {-1.0, 1.0}) {
        EdgeMotion& edge = side < 0.0 ? edges.first : edges.second;
        switch (load.load) {
            case LoadCase::tension:
                edge.path = [=](double a) { return Vec3(0.5 * side * a * load.strain * length, 0, 0); };
                break;
            case LoadCase::shear:
                edge.path = [=](double a) { return Vec3(0, 0.5 * side * a * load.strain * length, 0); };
                break;
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
                edge.path = [=](double a) {
                    return Vec3(-0.5 * side * std::pow(width * a * full / length, 2) / 24.0 * length, 0, 0);
                };
                break;
        }
    }
    return edges;
}

/// The composite as a scene, and what is held where.
struct Composite {
    scene::Assembly assembly;
    EdgeMotion west, east;  ///< of edges that are driven
    double length = 0.0, width = 0.0;
    std::vector<scene::Station> east_ends;  ///< of fibres that are driven
    std::vector<Index> east_nodes;          ///< of the solids, numbered through all, that are driven
    Index west_body = -1, east_body = -1;   ///< -1: edges are driven
};

/// Ends of the warp's fibres and faces of the layers follow two rigid motions; of fibres' sections one spin each is held.
inline void drive_edges(Composite& composite, const FabricParameters& fabric, const solid::Layers& layers,
                        const LoadParameters& load) {
    scene::Assembly& assembly = composite.assembly;
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
    for (Index number = 0; number < core::count(layers.list); ++number) {
        const solid::Layer& layer = layers.list[core::at(number)];
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
}

/// Nodes of a layer's face at x = -length / 2 or length / 2 in patches: as many across as asked for, two through the thickness.
inline std::vector<std::vector<scene::SolidNode>> face_patches(const solid::Layer& layer, Index number, bool east, Index across) {
    const Index columns = layer.cells[1] + 1, rows = layer.cells[2] + 1, wide = std::min(across, columns);
    std::vector<std::vector<scene::SolidNode>> patches(core::at(2 * wide));
    for (Index k = 0; k < rows; ++k)
        for (Index j = 0; j < columns; ++j)
            patches[core::at(2 * (j * wide / columns) + (2 * k < rows ? 0 : 1))].push_back(
                {number, layer.node(east ? layer.cells[0] : 0, j, k)});
    return patches;
}

/// Two bodies (Durville, sections 15.3.4 and 15.4.3): each takes along the mean of the fibre ends of every warp tow, or every
/// end, and the mean of the nodes of every patch of the layers' faces; single ends and nodes move as they like. The load
/// prescribes one coordinate of both; the east body's other displacements are free, and all other turns are held.
inline void tie_edges(Composite& composite, const FabricParameters& fabric, const solid::Layers& layers,
                      const LoadParameters& load) {
    using scene::Coordinate;
    load.validate();
    const double full = load.angle_deg * std::numbers::pi / 180.0;
    const Index patches = load.patches_across > 0 ? load.patches_across : fabric.warp_tows;
    for (const bool is_east : {false, true}) {
        const double half = is_east ? 0.5 : -0.5;
        scene::RigidBody body;
        body.name = is_east ? "east" : "west";
        body.position = Vec3(half * composite.length, 0, 0);
        if (is_east) body.translation.fill(Coordinate::loose());
        switch (load.load) {
            case LoadCase::tension:
                body.translation[0] = Coordinate::held_at(half * load.strain * composite.length, load_channel);
                break;
            case LoadCase::shear:
                body.translation[1] = Coordinate::held_at(half * load.strain * composite.length, load_channel);
                break;
            case LoadCase::bending:
                body.rotation[1] = Coordinate::held_at(half * full, load_channel);
                break;
            case LoadCase::twisting:
                body.rotation[0] = Coordinate::held_at(half * full, load_channel);
                break;
        }
        const Index number = composite.assembly.add(body);
        (is_east ? composite.east_body : composite.west_body) = number;
        const weave::Edge edge = is_east ? weave::Edge::east : weave::Edge::west;
        for (Index tow = 0; tow < fabric.warp_tows; ++tow)  // a fibre's turn about itself: nothing else may hold it
            weave::connect_tow_end(composite.assembly, fabric, edge, tow, number, {.spin = !is_east}, load.one_by_one);
        for (Index layer = 0; layer < core::count(layers.list); ++layer)
            for (const auto& patch : face_patches(layers.list[core::at(layer)], layer, is_east, patches))
                if (!patch.empty()) composite.assembly.connect({.nodes = patch, .body = number});
    }
}

/// What the edge at the warps' last ends takes, about its centre.
template <simulation::Model M>
simulation::Wrench edge_wrench(const simulation::Simulator<M>& simulator, const Composite& composite) {
    const auto& equilibrium = simulator.equilibrium();
    if constexpr (simulation::HasConnections<M>)
        if (composite.east_body >= 0) {
            const connection::Wrench wrench = equilibrium.ties().wrench(composite.east_body);
            return {wrench.force, wrench.moment};
        }
    const Vec3 centre = composite.east.centre(simulator.amplitude(load_channel));
    simulation::Wrench sum = simulation::support_wrench(simulator, composite.east_ends, centre);
    if (equilibrium.reaction().size() == 0) return sum;
    for (const Index node : composite.east_nodes) {
        const Index v = 3 * (equilibrium.solid().first_vector() + node);
        const Vec3 force = equilibrium.reaction().template segment<3>(v);
        sum.force += force;
        sum.moment += (Vec3(simulator.state().template segment<3>(v)) - centre).cross(force);
    }
    return sum;
}

}  // namespace fibrant::compositions::composite
