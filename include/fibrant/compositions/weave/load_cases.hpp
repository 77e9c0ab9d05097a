// SPDX-License-Identifier: MIT
#pragma once
/// @file Load cases of a dry fabric: extension, shear, bending, compaction, a tow that is pulled out (Durville, section 15.4.2),
/// forming by a punch.

#include <fibrant/compositions/weave/edges.hpp>
#include <fibrant/compositions/weave/forming.hpp>
#include <fibrant/compositions/weave/measures.hpp>
#include <fibrant/core/rotation.hpp>
#include <fibrant/scene/dof_layout.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::compositions::weave {

/// Channels of the load cases; their amplitudes have no units.
inline constexpr const char* strain_channel = "strain";  ///< change of the distance of two edges over it
inline constexpr const char* shear_channel =
    "shear";  ///< displacement of the north edge over the height, or the angle of a frame [radian]
inline constexpr const char* bend_channel = "bend";     ///< rotation of the west edge, and of the east edge against it [radian]
inline constexpr const char* plate_channel = "plates";  ///< approach of the plates over the thickness between them
inline constexpr const char* pull_channel = "pull";  ///< displacement of a tow's end over the spacing of the tows that it crosses
// tension_channel: tension of a tow over its E A, where an edge is free

/// Names of the load cases of a fabric, as scenes spell them.
inline const std::vector<std::string>& load_case_names() {
    static const std::vector<std::string> names{"release", "equibiaxial", "uniaxial", "shear",  "frame",
                                                "bending", "compaction",  "pull_out", "forming"};
    return names;
}

/// What tow ends do along their edge: keep their places, move apart by the strain of the fabric across them, or go where they
/// like, while it is stretched; or move apart with every fibre at its place in its tow end, in all load cases: tows do not spread
/// there, nor does the free end of one that is pulled out.
enum class TowEnds { kept, spread, free, fibres };
inline const std::vector<std::string>& tow_ends_names() {
    static const std::vector<std::string> names{"kept", "spread", "free", "fibres"};
    return names;
}

/// A scene with its bodies, and which of its figures make the curve.
struct LoadCase {
    std::string name;
    scene::Assembly assembly;
    EdgeBodies bodies;
    Index puller = -1;                    ///< body of the tow that is pulled
    double pulled_from = 0.0;             ///< where it was along x [length]
    std::vector<Index> pulled_fibres{};   ///< of that tow
    std::array<Index, 2> plates{-1, -1};  ///< below and above
    FormingTools forming{};               ///< whose holder and die are the plates
    double width = 0.0, height = 0.0;     ///< between the edges along x and along y at the start [length]
    double plate_distance = 0.0;          ///< at the start [length]
    double middle_spacing = 0.0;          ///< of middle crossings at the start [length]
    FabricParameters fabric;
};

/// Strain of the woven part of a sample, between the outermost crossings [1]: the ends beyond them are straight, and take what E
/// A says.
/// @param length  between the edges, at the start: shorter than the fibres by their crimp [length]
/// @param strain  of the whole, between the edges [1]
/// @param force   of a tow [force]
inline double woven_strain(const FabricParameters& fabric, Family family, double length, double strain, double force) {
    const double ends = 2.0 * fabric.overhang;
    return (strain * length - ends * force / fabric.tow(family).axial_stiffness()) / (length - ends);
}

/// The two middle ones of a family's tows, the outer two of the middle three if their number is odd; the same tow twice if it is
/// alone.
inline std::array<Index, 2> middle_tows(Index tows) noexcept {
    const Index low = (tows - 1) / 2 - (tows > 2 && tows % 2 == 1 ? 1 : 0);
    return {low, tows - 1 - low};
}

/// Mean distance of the crossings of the middle warp tows with the middle weft tows, along the warp [length].
inline double middle_spacing(const observe::Snapshot& snapshot, const FabricParameters& fabric) {
    const auto [first, last] = middle_tows(fabric.weft_tows);
    const std::array<Index, 2> warp = middle_tows(fabric.warp_tows);
    double sum = 0.0;
    for (const Index tow : warp) {
        const std::vector<double> crossings = crossing_parameters(snapshot, fabric, Family::warp, tow);
        const std::vector<Vec3> centre = tow_centreline(snapshot, fabric, Family::warp, tow);
        const observe::NodalCurve line{centre};
        sum += 0.5 * (line.position(crossings[core::at(last)]) - line.position(crossings[core::at(first)])).x();
    }
    return sum;
}

/// How far a place goes up when the edges, `width` apart, are each turned by one radian along a flat arc whose ends stay
/// [length].
/// @param x  from the middle [length]
inline double arc_rise(double x, double width) noexcept { return (x * x - 0.25 * width * width) / width; }

/// A load case of a settled fabric: its ends, channels and stages.
/// @param name      one of load_case_names()
/// @param snapshot  the settled fabric
/// @param forming   the tools of "forming", in which no end is held
/// @throws std::invalid_argument naming the field that is wrong
inline LoadCase load_case(const std::string& name, const observe::Snapshot& snapshot, const FabricParameters& fabric,
                          TowEnds ends = TowEnds::kept, const FormingParameters& forming = {}) {
    using scene::Coordinate;
    const auto& names = load_case_names();
    if (std::find(names.begin(), names.end(), name) == names.end()) core::refuse("load_case.name", name, "a load case");
    fabric.validate();
    LoadCase load;
    load.name = name, load.fabric = fabric;
    add_flat_fibres(load.assembly, fabric);
    std::array<Vec3, 4> middle;
    for (const Edge edge : all_edges) {
        const Index tows = fabric.tows(family_of(edge));
        Vec3& sum = middle[static_cast<std::size_t>(edge)] = Vec3::Zero();
        for (Index tow = 0; tow < tows; ++tow) sum += tow_end_middle(snapshot, fabric, edge, tow) / static_cast<double>(tows);
    }
    load.middle_spacing = middle_spacing(snapshot, fabric);
    load.width = middle[1].x() - middle[0].x(), load.height = middle[3].y() - middle[2].y();
    const std::array<double, 2> pull{static_cast<double>(fabric.warp_tows) * fabric.warp.axial_stiffness(),
                                     static_cast<double>(fabric.weft_tows) * fabric.weft.axial_stiffness()};
    std::array<EdgeParameters, 4> edges;
    for (EdgeParameters& edge : edges) edge.one_by_one = ends == TowEnds::fibres;
    EdgeParameters &west = edges[0], &east = edges[1], &south = edges[2], &north = edges[3];
    const auto stretch = [](EdgeParameters& low, EdgeParameters& high, std::size_t axis, double size) {
        low.translation[axis] = Coordinate::held_at(-0.5 * size, strain_channel),
        high.translation[axis] = Coordinate::held_at(0.5 * size, strain_channel);
    };
    const auto draw = [](EdgeParameters& low, EdgeParameters& high, std::size_t axis, double force) {
        low.translation[axis] = Coordinate::under(-force, tension_channel),
        high.translation[axis] = Coordinate::under(force, tension_channel);
    };
    if (name == "release") {
        // Fibre ends were held one by one: edges that give way under the tension let them rearrange without being pressed.
        draw(west, east, 0, pull[0]), draw(south, north, 1, pull[1]);
    } else if (name == "equibiaxial" || name == "uniaxial") {
        stretch(west, east, 0, load.width);
        if (name == "equibiaxial")
            stretch(south, north, 1, load.height);
        else
            draw(south, north, 1, pull[1]);
        for (const Edge edge : all_edges) {
            EdgeParameters& side = edges[static_cast<std::size_t>(edge)];
            // A uniaxial stretch drives no strain across the ends of the tows that it draws.
            if ((ends == TowEnds::spread || ends == TowEnds::fibres) &&
                (name == "equibiaxial" || family_of(edge) == Family::weft))
                side.spread_channel = strain_channel;
            if (ends == TowEnds::free) side.tow_translation[core::at(1 - axis_of(family_of(edge)))] = Coordinate::loose();
        }
    } else if (name == "shear") {
        north.translation[0] = Coordinate::held_at(load.height, shear_channel);
        north.translation[1] = Coordinate::under(pull[1], tension_channel);
        draw(west, east, 0, pull[0]);
        for (EdgeParameters* edge : {&west, &east})
            edge->translation[1] = Coordinate::loose(), edge->rotation[2] = Coordinate::loose();
    } else if (name == "frame") {
        // Hinged at its corners; the north side hangs on the west side and turns back against it.
        const Vec3 south_west(middle[0].x(), middle[2].y(), 0), south_east(middle[1].x(), middle[2].y(), 0),
            north_west(middle[0].x(), middle[3].y(), 0);
        west.pivot = south_west, east.pivot = south_east, north.pivot = north_west;
        west.rotation[2] = east.rotation[2] = Coordinate::held_at(-1.0, shear_channel);
        north.parent = Edge::west, north.rotation[2] = Coordinate::held_at(1.0, shear_channel);
    } else if (name == "bending") {
        west.rotation[1] = Coordinate::held_at(1.0, bend_channel), east.rotation[1] = Coordinate::held_at(-1.0, bend_channel);
        west.turning = east.turning = true;
        east.translation[0] = Coordinate::under(pull[0], tension_channel);
        // The ends of the tows across go along with the arc, as in a sheet that is wider: left free, they rise from the surface,
        // and the crimp at the sides goes out of the tows that are bent.
        for (const Edge edge : {Edge::south, Edge::north}) {
            EdgeParameters& side = edges[static_cast<std::size_t>(edge)];
            side.loose = fabric.weft.axial_stiffness();
            for (Index tow = 0; tow < fabric.weft_tows; ++tow) {
                const double x = tow_end_middle(snapshot, fabric, edge, tow).x() - 0.5 * (middle[0].x() + middle[1].x());
                side.loose_height.push_back(Coordinate::held_at(arc_rise(x, load.width), bend_channel));
            }
        }
    } else if (name == "compaction") {
        const auto [low, high] = heights(snapshot);
        load.plate_distance = high - low;
        for (const bool above : {false, true}) {
            scene::Tool plate;
            plate.name = above ? "upper plate" : "lower plate";
            plate.origin = Vec3(0, 0, above ? high : low), plate.axis = Vec3(0, 0, above ? -1.0 : 1.0);
            plate.displacement = Vec3(0, 0, (above ? -0.5 : 0.5) * load.plate_distance);
            plate.channel = plate_channel;
            load.plates[above ? 1 : 0] = load.assembly.add(plate);
        }
    } else if (name == "forming") {
        load.forming = add_forming_tools(load.assembly, snapshot, forming);
        load.plates = {load.forming.holder, load.forming.die};
        return load;
    } else {  // pull_out
        const Index tow = fabric.warp_tows / 2;
        west.left_out = east.left_out = {tow};
        scene::RigidBody puller;
        puller.name = "puller", puller.position = tow_end_middle(snapshot, fabric, Edge::east, tow);
        puller.translation[0] = Coordinate::held_at(fabric.weft_spacing, pull_channel);
        load.bodies = add_edges(load.assembly, snapshot, fabric, edges);
        load.puller = load.assembly.add(puller), load.pulled_from = puller.position.x();
        for (Index k = 0; k < fabric.warp.fibres; ++k) load.pulled_fibres.push_back(fabric.fibre(Family::warp, tow, k));
        connect_tow_end(load.assembly, fabric, Edge::east, tow, load.puller, {.spin = true}, west.one_by_one);
        if (west.one_by_one) {  // the other end goes where it likes as well, but as one: single fibres that nothing holds snap
                                // past each other
            scene::RigidBody tail;
            tail.name = "tail", tail.position = tow_end_middle(snapshot, fabric, Edge::west, tow);
            tail.translation.fill(Coordinate::loose()), tail.rotation.fill(Coordinate::loose());
            connect_tow_end(load.assembly, fabric, Edge::west, tow, load.assembly.add(tail), {}, true);
        }
        return load;
    }
    load.bodies = add_edges(load.assembly, snapshot, fabric, edges);
    return load;
}

/// Sum of the reactions between some fibres and all others [force]: times the coefficient of friction, the most that can hold
/// them together against what pulls them along.
inline double pressing_force(const observe::Snapshot& snapshot, const std::vector<Index>& fibres) {
    std::vector<char> one(snapshot.fibres.size(), 0);
    for (const Index fibre : fibres) one[core::at(fibre)] = 1;
    double sum = 0.0;
    for (const observe::ContactSnapshot& contact : snapshot.contacts)
        if (one[core::at(contact.fibre_i)] != one[core::at(contact.fibre_j)]) sum += contact.reaction;
    return sum;
}

/// Sum of what the damping of the last increment exerts on the fibres [force]: its share of the response.
template <class Simulator>
Vec3 damping_force(const Simulator& simulator) {
    const Vector forces = simulator.equilibrium().damping_force(simulator.state());
    const auto& kind = simulator.mesh().layout().kind;
    Vec3 sum = Vec3::Zero();
    for (Index v = 0; v < core::count(kind); ++v)
        if (kind[core::at(v)] == scene::VectorKind::position) sum -= forces.template segment<3>(3 * v);
    return sum;
}

/// A named figure of a load case.
using Figure = std::pair<std::string, double>;

/// Figures of a load case after an increment: the two of its curve first (with their names), then places, turns and reactions of
/// all edges. Forces are those that bodies exert on the sample.
/// @param snapshot  of the simulator now
template <class Simulator>
std::vector<Figure> load_figures(const LoadCase& load, const Simulator& simulator, const observe::Snapshot& snapshot) {
    const auto& ties = simulator.equilibrium().ties();
    const auto force = [&](Edge edge) {
        return load.bodies.of(edge) < 0 ? Vec3(Vec3::Zero()) : ties.wrench(load.bodies.of(edge)).force;
    };
    const auto place = [&](Edge edge) {
        return load.bodies.of(edge) < 0 ? Vec3(Vec3::Zero()) : ties.motion().position(load.bodies.of(edge));
    };
    constexpr double degree = 180.0 / 3.14159265358979323846;
    std::vector<Figure> figures;
    if (load.name == "release" || load.name == "equibiaxial" || load.name == "uniaxial") {
        figures = {{"strain", (place(Edge::east) - place(Edge::west)).x() / load.width - 1.0},
                   {"force", 0.5 * (force(Edge::east) - force(Edge::west)).x()}};
        // What an inner tow carries, and the strain that it sees.
        const std::vector<Index>& ends = load.bodies.tow_end[static_cast<std::size_t>(Edge::east)];
        const Index edge = core::count(ends) >= 4 ? 1 : 0, inner = core::count(ends) - 2 * edge;
        double sum = 0.0;
        for (Index tow = edge; tow < edge + inner; ++tow)
            sum += ties.wrench(ends[core::at(tow)]).force.x() / static_cast<double>(inner);
        figures.push_back({"woven_strain", woven_strain(load.fabric, Family::warp, load.width, figures[0].second, sum)});
        figures.push_back({"inner_tow_force", sum});
        // The same where edges are furthest away.
        figures.push_back({"middle_strain", middle_spacing(snapshot, load.fabric) / load.middle_spacing - 1.0});
        const auto [first, last] = middle_tows(core::count(ends));
        figures.push_back(
            {"middle_tow_force", 0.5 * (ties.wrench(ends[core::at(first)]).force + ties.wrench(ends[core::at(last)]).force).x()});
    } else if (load.name == "shear") {
        const Vec3 side = place(Edge::north) - place(Edge::south);
        figures = {{"angle_deg", degree * std::atan2(side.x(), side.y())}, {"force", force(Edge::north).x()}};
    } else if (load.name == "frame") {
        // Virtual work of the frame: a moment about each of the two corners that it turns about.
        const auto& motion = ties.motion();
        const Mat3 frame = motion.frame(load.bodies.of(Edge::west));
        const double angle = std::atan2(frame(0, 1), frame(1, 1)),
                     height = (motion.position(load.bodies.of(Edge::north)) - motion.position(load.bodies.of(Edge::west))).norm();
        const double work = -ties.wrench(load.bodies.of(Edge::west)).moment.z() -
                            ties.wrench(load.bodies.of(Edge::east)).moment.z() +
                            ties.wrench(load.bodies.of(Edge::north)).moment.z();
        figures = {{"angle_deg", degree * angle}, {"force", work / height}};
    } else if (load.name == "bending") {
        const Mat3 frame = ties.motion().frame(load.bodies.of(Edge::west)),
                   other = ties.motion().frame(load.bodies.of(Edge::east));
        const double turn = std::atan2(frame(0, 2), frame(2, 2)) - std::atan2(other(0, 2), other(2, 2));
        // Half of the work that all bodies do for each radian of an edge, the motions being those of an arc, whose chord the
        // tension shortens.
        const double half = 0.5 * turn,
                     chord = std::abs(half) > 1e-3 ? (half * std::cos(half) - std::sin(half)) / (half * half) : -half / 3.0;
        double work = ties.wrench(load.bodies.of(Edge::west)).moment.y() - ties.wrench(load.bodies.of(Edge::east)).moment.y() +
                      force(Edge::east).x() * load.width * chord;
        for (const Edge edge : {Edge::south, Edge::north})
            for (const Index end : load.bodies.tow_end[static_cast<std::size_t>(edge)]) {
                const double x = ties.motion().position(end).x() - 0.5 * (place(Edge::west) + place(Edge::east)).x();
                work += ties.wrench(end).force.z() * arc_rise(x, load.width);
            }
        figures = {{"curvature", turn / load.width}, {"moment", 0.5 * work}};
    } else if (load.name == "compaction") {
        const auto& tools = simulator.contacts().tools();
        figures = {{"thickness", load.plate_distance * (1.0 - simulator.amplitude(plate_channel))},
                   {"force", 0.5 * std::abs((tools.reaction(load.plates[1]).force - tools.reaction(load.plates[0]).force).z())}};
    } else if (load.name == "forming") {
        const auto& tools = simulator.contacts().tools();
        const scene::Tool& punch = tools.tools()[core::at(load.forming.punch)];
        figures = {{"stroke", (tools.pose(load.forming.punch).place(punch.origin) - punch.origin).z()},
                   {"force", -tools.reaction(load.forming.punch).force.z()},
                   {"die_force", tools.reaction(load.forming.die).force.z()},
                   {"greatest_shear_deg", greatest_shear_deg(snapshot, load.fabric)}};
    } else {
        figures = {{"displacement", ties.motion().position(load.puller).x() - load.pulled_from},
                   {"force", ties.wrench(load.puller).force.x()},
                   {"pressing", pressing_force(snapshot, load.pulled_fibres)}};
    }
    Vec3 sum = Vec3::Zero();
    for (Index body = 0; body < core::count(load.assembly.bodies()); ++body)
        if (ties.motion().parent(body) < 0) sum += ties.wrench(body).force;  // and that of those that hang on it
    for (const Index plate : load.plates)
        if (plate >= 0) sum -= simulator.contacts().tools().reaction(plate).force;
    if (load.forming.punch >= 0) sum -= simulator.contacts().tools().reaction(load.forming.punch).force;
    for (const Edge edge : all_edges) {
        const Index body = load.bodies.of(edge);
        if (body < 0) continue;
        const auto wrench = ties.wrench(body);
        const Vec3 at = ties.motion().position(body), turn = core::rotation_vector(ties.motion().frame(body));
        const char* axes[] = {"_x", "_y", "_z"};
        for (int k = 0; k < 3; ++k) figures.push_back({edge_name(edge) + std::string(axes[k]), at[k]});
        for (int k = 0; k < 3; ++k) figures.push_back({edge_name(edge) + std::string("_turn") + axes[k], turn[k]});
        for (int k = 0; k < 3; ++k) figures.push_back({edge_name(edge) + std::string("_force") + axes[k], wrench.force[k]});
        for (int k = 0; k < 3; ++k) figures.push_back({edge_name(edge) + std::string("_moment") + axes[k], wrench.moment[k]});
    }
    const Vec3 damping = damping_force(simulator);
    figures.push_back({"damping_force", damping.norm()});
    figures.push_back({"unbalanced_force", (sum + damping).norm()});
    figures.push_back({"connection_misfit", ties.misfit()});
    figures.push_back({"frame_error", ties.motion().orthonormality_error()});
    return figures;
}

}  // namespace fibrant::compositions::weave
