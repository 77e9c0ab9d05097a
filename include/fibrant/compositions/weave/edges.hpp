// SPDX-License-Identifier: MIT
#pragma once
/// @file The hierarchy at the edges of a woven sample: fibre ends, the body of each tow end, the body of each edge.

#include <fibrant/compositions/weave/fabric.hpp>
#include <fibrant/compositions/weave/tow_geometry.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace fibrant::compositions::weave {

/// The four edges: ends of warp tows at the least and the greatest x, ends of weft tows at the least and the greatest y.
enum class Edge : int { west = 0, east = 1, south = 2, north = 3 };
/// All four, in this order.
inline constexpr std::array<Edge, 4> all_edges{Edge::west, Edge::east, Edge::south, Edge::north};
/// What it is called in tables and messages.
inline const char* edge_name(Edge edge) noexcept {
    static constexpr std::array names{"west", "east", "south", "north"};
    return names[static_cast<std::size_t>(edge)];
}
/// The tows whose ends it has.
constexpr Family family_of(Edge edge) noexcept { return edge == Edge::west || edge == Edge::east ? Family::warp : Family::weft; }
/// Whether these are the last ends of their fibres.
constexpr bool at_last_end(Edge edge) noexcept { return edge == Edge::east || edge == Edge::north; }

/// How the body of an edge moves, and how tow ends hang on it (Durville, section 15.3.4).
struct EdgeParameters {
    bool held = true;              ///< has a body at all; else its tow ends are free
    std::optional<Vec3> pivot{};   ///< where its body is [length]; the middle of its tow ends if not said
    std::optional<Edge> parent{};  ///< an edge that comes before it, on which its body hangs
    std::array<scene::Coordinate, 3> translation{}, rotation{};
    std::array<scene::Coordinate, 3> tow_translation{};  ///< of a tow end from its place at the edge, along x, y and z
    std::string spread_channel{};  ///< of the strain along the edge by which tow ends move apart; empty: they do not
    scene::Coordinate tow_roll{};  ///< of a tow end about its own axis
    bool turning = false;          ///< sections of fibre ends turn with their tow end: it bends them
    bool one_by_one = false;       ///< each fibre end keeps its place at its tow end; else their mean does
    /// No body for the edge: each tow end has one of its own that is free to move, to roll and, if its sections turn with it, to
    /// lean, under this pull outwards at amplitude 1 of the tension channel [force].
    std::optional<double> loose{};
    std::vector<scene::Coordinate> loose_height{};  ///< along z of each loose tow end; none: free
    std::vector<Index> left_out{};                  ///< tows that are not connected
};

/// Bodies of a sample, by edge and tow; -1 where there is none.
struct EdgeBodies {
    std::array<Index, 4> edge{-1, -1, -1, -1};
    std::array<std::vector<Index>, 4> tow_end{};
    Index of(Edge e) const noexcept { return edge[static_cast<std::size_t>(e)]; }
};

/// Ends of a tow's fibres at an edge.
inline std::vector<scene::Station> tow_ends(const FabricParameters& fabric, Edge edge, Index tow) {
    std::vector<scene::Station> ends;
    for (Index k = 0; k < fabric.tow(family_of(edge)).fibres; ++k)
        ends.push_back({fabric.fibre(family_of(edge), tow, k), at_last_end(edge) ? 1.0 : 0.0});
    return ends;
}

/// Middle of a tow's end in a snapshot [length].
inline Vec3 tow_end_middle(const observe::Snapshot& snapshot, const FabricParameters& fabric, Edge edge, Index tow) {
    const std::vector<Vec3> line = tow_centreline(snapshot, fabric, family_of(edge), tow);
    return at_last_end(edge) ? line.back() : line.front();
}

/// What of a fibre's end follows its tow end beside the mean position.
struct SectionTies {
    bool spin = false;     ///< rotation about the fibre's axis: nothing else would hold a round fibre's, at one end of it
    bool turning = false;  ///< the direction of the fibre
};

/// Ties the mean position of a tow's fibre ends, or each of them, to a body, and their sections one by one as asked for.
inline void connect_tow_end(scene::Assembly& assembly, const FabricParameters& fabric, Edge edge, Index tow, Index body,
                            const SectionTies& ties, bool one_by_one = false) {
    const std::vector<scene::Station> ends = tow_ends(fabric, edge, tow);
    if (one_by_one)
        for (const scene::Station& end : ends) assembly.connect({.ends = {end}, .body = body});
    else
        assembly.connect({.ends = ends, .body = body});
    if (!ties.spin && !ties.turning) return;
    Mat3 section;  // g_1 and g_2 at rest
    const Vec3 along = family_of(edge) == Family::warp ? Vec3::UnitX() : Vec3::UnitY();
    section.col(0) = Vec3::UnitZ(), section.col(1) = along.cross(Vec3::UnitZ()), section.col(2) = along;
    for (const scene::Station& end : ends) {
        assembly.connect({.ends = {end},
                          .vector = scene::NodeVector::director_1,
                          .body = body,
                          .directions = section,
                          .tied = {false, ties.spin, ties.turning}});
        assembly.connect({.ends = {end},
                          .vector = scene::NodeVector::director_2,
                          .body = body,
                          .directions = section,
                          .tied = {ties.spin, false, ties.turning}});
    }
}

/// Bodies for all edges and tow ends, and the connections of the whole hierarchy.
/// @param snapshot  the state from which the sample is loaded
inline EdgeBodies add_edges(scene::Assembly& assembly, const observe::Snapshot& snapshot, const FabricParameters& fabric,
                            const std::array<EdgeParameters, 4>& edges) {
    require_snapshot_of(snapshot, fabric);
    EdgeBodies bodies;
    for (const Edge edge : all_edges) {
        const auto e = static_cast<std::size_t>(edge);
        const EdgeParameters& parameters = edges[e];
        const Index tows = fabric.tows(family_of(edge));
        bodies.tow_end[e].assign(core::at(tows), -1);
        if (!parameters.held) continue;
        Vec3 middle = Vec3::Zero();
        const SectionTies ties{!at_last_end(edge), parameters.turning};
        if (parameters.loose) {
            const auto axis = static_cast<std::size_t>(axis_of(family_of(edge)));
            for (Index tow = 0; tow < tows; ++tow) {
                scene::RigidBody end;
                end.name = std::string(edge_name(edge)) + " " + std::to_string(tow);
                end.position = tow_end_middle(snapshot, fabric, edge, tow);
                end.translation.fill(scene::Coordinate::loose());
                if (!parameters.loose_height.empty()) end.translation[2] = parameters.loose_height[core::at(tow)];
                // Sections that do not turn with the body say nothing of how it leans: left loose, it would lean by any angle.
                for (std::size_t k = 0; k < 3; ++k)
                    if (ties.turning || k == axis) end.rotation[k] = scene::Coordinate::loose();
                end.translation[axis] =
                    scene::Coordinate::under(at_last_end(edge) ? *parameters.loose : -*parameters.loose, tension_channel);
                bodies.tow_end[e][core::at(tow)] = assembly.add(end);
                connect_tow_end(assembly, fabric, edge, tow, bodies.tow_end[e][core::at(tow)], ties, parameters.one_by_one);
            }
            continue;
        }
        for (Index tow = 0; tow < tows; ++tow) middle += tow_end_middle(snapshot, fabric, edge, tow) / static_cast<double>(tows);
        scene::RigidBody body;
        body.name = edge_name(edge);
        body.position = parameters.pivot.value_or(middle);
        if (parameters.parent) body.parent = bodies.of(*parameters.parent);
        body.translation = parameters.translation, body.rotation = parameters.rotation;
        bodies.edge[e] = assembly.add(body);
        for (Index tow = 0; tow < tows; ++tow) {
            if (std::find(parameters.left_out.begin(), parameters.left_out.end(), tow) != parameters.left_out.end()) continue;
            scene::RigidBody end;
            end.name = body.name + " " + std::to_string(tow);
            end.position = tow_end_middle(snapshot, fabric, edge, tow);
            end.parent = bodies.edge[e];
            end.translation = parameters.tow_translation;
            if (!parameters.spread_channel.empty()) {
                const auto across = static_cast<std::size_t>(axis_of(other(family_of(edge))));
                end.translation[across] = scene::Coordinate::held_at((end.position - body.position)[static_cast<Index>(across)],
                                                                     parameters.spread_channel);
            }
            end.rotation[static_cast<std::size_t>(axis_of(family_of(edge)))] = parameters.tow_roll;
            bodies.tow_end[e][core::at(tow)] = assembly.add(end);
            connect_tow_end(assembly, fabric, edge, tow, bodies.tow_end[e][core::at(tow)], ties, parameters.one_by_one);
        }
    }
    return bodies;
}

}  // namespace fibrant::compositions::weave
