// SPDX-License-Identifier: MIT
#include "compositions/weave/woven_snapshot.hpp"
#include "refusal.hpp"

#include <fibrant/compositions/weave/fibre_figures.hpp>
#include <fibrant/compositions/weave/load_cases.hpp>
#include <fibrant/connection/body_motion.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

using namespace fibrant;

namespace load_cases_test {

using namespace fibrant::compositions::weave;

const FormingParameters ball{.punch_radius = 0.5, .hole_radius = 2.0, .ring_width = 1.0, .edge_radius = 0.1};

TEST_CASE("one call builds the hierarchy of a sample: every fibre end in the average of its tow end, every tow end on its edge") {
    FabricParameters fabric = small_fabric(3, 7);
    fabric.weft_tows = 5;
    const observe::Snapshot snapshot = woven_snapshot(fabric, 0.1);
    scene::Assembly assembly;
    add_flat_fibres(assembly, fabric);
    const EdgeBodies bodies = add_edges(assembly, snapshot, fabric, {});
    CHECK(assembly.bodies().size() == 4 + 2 * (3 + 5));
    std::vector<int> ends(core::at(2 * fabric.fibres()), 0);
    for (const scene::AverageConnection& average : assembly.averages()) {
        if (average.vector != scene::NodeVector::position) continue;
        CHECK(average.ends.size() == 7);
        Vec3 mean = Vec3::Zero();
        for (const scene::Station& at : average.ends) {
            ++ends[core::at(2 * at.fibre + (at.fraction > 0.5 ? 1 : 0))];
            const auto& nodes = snapshot.fibres[core::at(at.fibre)].position;
            mean += (at.fraction > 0.5 ? nodes.back() : nodes.front()) / 7.0;
        }
        const scene::RigidBody& end = assembly.bodies()[core::at(average.body)];
        CHECK((mean - end.position).norm() < 1e-14);
        REQUIRE(end.parent >= 0);
        CHECK(assembly.bodies()[core::at(end.parent)].parent == -1);
    }
    for (const int count : ends) CHECK(count == 1);
    const Vec3 west = assembly.bodies()[core::at(bodies.of(Edge::west))].position;
    CHECK(west.x() == test::near(-0.5 * fabric.fibre_length(Family::warp), 1e-12));
    CHECK(std::abs(west.y()) < 1e-12);
}

TEST_CASE("the picture frame keeps its sides, and the chapter's shear leaves the other edges free to follow") {
    const FabricParameters fabric = small_fabric();
    const observe::Snapshot snapshot = woven_snapshot(fabric, 0.1);
    const LoadCase load = load_case("frame", snapshot, fabric);
    const connection::Channels channels(load.assembly);
    connection::BodyMotion motion(load.assembly, channels);
    CHECK(motion.free_coordinates() == 0);
    const double angle = 0.6;
    motion.begin(std::vector<double>{angle});
    const Vec3 north = motion.position(load.bodies.of(Edge::north)), west = motion.position(load.bodies.of(Edge::west));
    // The north-west corner goes round on a circle about the south-west one; the north side stays parallel to x.
    CHECK((north - west - load.height * Vec3(std::sin(angle), std::cos(angle), 0)).norm() < 1e-12);
    CHECK((motion.frame(load.bodies.of(Edge::north)) - Mat3::Identity()).norm() < 1e-12);
    const auto tow = [&](Edge edge, Index t) {
        return motion.position(load.bodies.tow_end[static_cast<std::size_t>(edge)][core::at(t)]);
    };
    for (Index t = 0; t < 4; ++t) {
        CHECK(std::abs((tow(Edge::east, t) - tow(Edge::west, t)).head<2>().norm() - load.width) < 1e-12);
        CHECK(std::abs((tow(Edge::north, t) - tow(Edge::south, t)).head<2>().norm() - load.height) < 1e-12);
    }
    const LoadCase shear = load_case("shear", snapshot, fabric);
    const connection::Channels names(shear.assembly);
    CHECK(names.names() == std::vector<std::string>{shear_channel, tension_channel});
    CHECK(connection::BodyMotion(shear.assembly, names).free_coordinates() ==
          7);  // the height; of two edges both places and the turn
}

TEST_CASE("a bent sheet's edges turn against each other, and the ends of the tows across go along with the arc") {
    const FabricParameters fabric = small_fabric();
    const LoadCase load = load_case("bending", woven_snapshot(fabric, 0.1), fabric);
    const connection::Channels channels(load.assembly);
    connection::BodyMotion motion(load.assembly, channels);
    // The distance of the edges; of eight ends the places in the plane and the roll. Nothing says how sections that roll alone
    // lean.
    CHECK(motion.free_coordinates() == 1 + 8 * 3);
    for (const scene::RigidBody& body : load.assembly.bodies())
        if (body.translation[0].free && body.translation[1].free) {
            CHECK(!body.rotation[0].free);
            CHECK(body.rotation[1].free);
            CHECK(!body.rotation[2].free);
        }
    const double angle = 0.05, radius = 0.5 * load.width / angle;
    std::vector<double> amplitudes(channels.names().size(), 0.0);
    amplitudes[core::at(channels.find(bend_channel))] = angle;
    motion.begin(amplitudes);
    for (const Edge edge : {Edge::south, Edge::north})
        for (const Index end : load.bodies.tow_end[static_cast<std::size_t>(edge)]) {
            const Vec3 place = motion.position(end);
            const double height = radius * (std::cos(angle) - std::cos(place.x() / radius));
            const double risen = place.z() - load.assembly.bodies()[core::at(end)].position.z();
            CHECK(std::abs(risen - height) < 0.1 * angle * angle * angle * load.width);  // a parabola in the place of the arc
        }
    // Edges lie across the arc there: along it, the west one goes down and the east one up.
    const Vec3 west = motion.frame(load.bodies.of(Edge::west)).col(0), east = motion.frame(load.bodies.of(Edge::east)).col(0);
    CHECK(west.z() == test::near(-std::sin(angle), 1e-12));
    CHECK(east.z() == test::near(std::sin(angle), 1e-12));
}

TEST_CASE("the woven part of a sample and its straight ends stretch one after the other") {
    const FabricParameters fabric = small_fabric(6);
    const double woven = 0.94 * 5.0 * 0.88, ends = 2.0 * 0.88, force = 0.7, own = 0.004;
    const double strain = (own * woven + force / fabric.weft.axial_stiffness() * ends) / (woven + ends);
    for (const Family family : {Family::warp, Family::weft})
        CHECK(woven_strain(fabric, family, woven + ends, strain, force) == test::near(own, 1e-12));
}

TEST_CASE("tow ends that are spread move as the fabric does: every one by the same strain along and across") {
    FabricParameters fabric = small_fabric(3, 7);
    fabric.weft_tows = 5;
    const observe::Snapshot snapshot = woven_snapshot(fabric, 0.1);
    const double strain = 0.01;
    for (const TowEnds how : {TowEnds::kept, TowEnds::spread, TowEnds::free}) {
        const LoadCase load = load_case("equibiaxial", snapshot, fabric, how);
        const connection::Channels channels(load.assembly);
        connection::BodyMotion motion(load.assembly, channels);
        CHECK(motion.free_coordinates() == (how == TowEnds::free ? 2 * (3 + 5) : 0));
        std::vector<double> amplitudes(channels.names().size(), 0.0);
        amplitudes[core::at(channels.find(strain_channel))] = strain;
        motion.begin(amplitudes);
        for (const Edge edge : all_edges)
            for (const Index end : load.bodies.tow_end[static_cast<std::size_t>(edge)]) {
                const Vec3 from = load.assembly.bodies()[core::at(end)].position;
                Vec3 to = (1.0 + strain) * from;
                to.z() = from.z();
                if (how != TowEnds::spread) to[axis_of(other(family_of(edge)))] = from[axis_of(other(family_of(edge)))];
                CHECK((motion.position(end) - to).norm() < 1e-14);
            }
    }
    // What is drawn alone spreads the ends that lie along it.
    const LoadCase load = load_case("uniaxial", snapshot, fabric, TowEnds::spread);
    for (const Edge edge : all_edges)
        for (const Index end : load.bodies.tow_end[static_cast<std::size_t>(edge)]) {
            const scene::RigidBody& body = load.assembly.bodies()[core::at(end)];
            CHECK(std::abs(body.translation[0].value - (family_of(edge) == Family::weft ? body.position.x() : 0.0)) < 1e-14);
            CHECK(body.translation[1].value == 0.0);
        }
}

TEST_CASE("fibre ends that are held one by one have each a tie to their tow end, in the place of one for all") {
    const FabricParameters fabric = small_fabric(4, 7);
    const observe::Snapshot snapshot = woven_snapshot(fabric, 0.1);
    for (const std::string& name : load_case_names()) {
        CAPTURE(name);
        if (name == "forming") continue;  // which holds no end
        const LoadCase load = load_case(name, snapshot, fabric, TowEnds::fibres);
        std::vector<int> ends(core::at(2 * fabric.fibres()), 0);
        for (const scene::AverageConnection& average : load.assembly.averages()) {
            if (average.vector != scene::NodeVector::position) continue;
            CHECK(average.ends.size() == 1);
            for (const scene::Station& at : average.ends) ++ends[core::at(2 * at.fibre + (at.fraction > 0.5 ? 1 : 0))];
        }
        for (const int count : ends) CHECK(count == 1);
        if (name != "pull_out") continue;
        // Both ends of the tow that is pulled: the one is driven, the other goes along with nothing to hold it.
        const connection::Channels channels(load.assembly);
        connection::BodyMotion motion(load.assembly, channels);
        CHECK(motion.free_coordinates() == 6);
        for (Index k = 0; k < 6; ++k) CHECK(motion.moves(k, core::count(load.assembly.bodies()) - 1));
    }
}

TEST_CASE("the middle of a sample lies between its middle tows, over two spacings where their number is odd") {
    for (const Index tows : {2, 3, 4, 5, 8}) {
        FabricParameters fabric = small_fabric(4, 7);
        fabric.weft_tows = tows;
        CAPTURE(tows);
        const auto [first, last] = middle_tows(tows);
        CHECK(first + last == tows - 1);
        CHECK(last - first == (tows % 2 == 0 ? 1 : 2));
        CHECK(middle_spacing(woven_snapshot(fabric, 0.1), fabric) == test::near(static_cast<double>(last - first) * 0.88, 1e-12));
    }
    CHECK(middle_tows(1) == std::array<Index, 2>{0, 0});
}

TEST_CASE("what presses a tow is the sum of the reactions with all other fibres") {
    observe::Snapshot snapshot;
    snapshot.fibres.resize(8);
    for (const auto& [i, j, reaction] : {std::array{0.0, 1.0, 1.0}, {0.0, 2.0, 10.0}, {1.0, 3.0, 100.0}, {2.0, 3.0, 1000.0}})
        snapshot.contacts.push_back({.fibre_i = static_cast<Index>(i), .fibre_j = static_cast<Index>(j), .reaction = reaction});
    CHECK(pressing_force(snapshot, {0, 1}) == 110.0);
}

TEST_CASE("every load case can be built, and one that is not known is refused") {
    const FabricParameters fabric = small_fabric();
    const observe::Snapshot snapshot = woven_snapshot(fabric, 0.1);
    for (const std::string& name : load_case_names()) {
        CAPTURE(name);
        const LoadCase load = load_case(name, snapshot, fabric, TowEnds::free, ball);
        CHECK(core::count(load.assembly.fibres()) == fabric.fibres());
        CHECK(load.assembly.averages().empty() == (name == "forming"));
        CHECK(load.width == test::near(fabric.fibre_length(Family::warp), 1e-12));
    }
    CHECK(load_case("compaction", snapshot, fabric).plate_distance ==
          test::near(2.0 * 0.1 + fabric.warp.packing().thickness, 0.05));
    CHECK(test::refusal([&] { load_case("tickle", snapshot, fabric); }) == "load_case.name = tickle, but it must be a load case");
}

TEST_CASE("figures of tows are those of the sections they are drawn with") {
    const FabricParameters fabric = small_fabric();
    const observe::Snapshot snapshot = woven_snapshot(fabric, 0.1);
    const TowFigures figures = tow_figures(snapshot, fabric, Family::warp);
    const Packing packing = fabric.warp.packing();
    // Convex hulls of 128-gons: 2e-4 of a radius; tows are level at their crossings.
    CHECK(figures.width == test::near(packing.width, 3e-3));  // the principal axes of seven fibres are turned a little
    CHECK(figures.gap == test::near(fabric.warp_spacing - packing.width, 1e-2));
    // A uniform stretch of straight fibres.
    observe::Snapshot straight = woven_snapshot(fabric, 0.0);
    for (observe::FibreSnapshot& fibre : straight.fibres)
        for (std::size_t k = 0; k < fibre.position.size(); ++k) {
            fibre.displacement[k] = 0.01 * fibre.position[k];
            fibre.position[k] *= 1.01;
        }
    const ElementFigures elements = element_figures(straight);
    CHECK(core::count(elements.strain) == fabric.fibres() * fabric.elements);
    for (const double strain : elements.strain) CHECK(strain == test::near(0.01, 1e-12));
    for (const double curvature : elements.curvature) CHECK(std::abs(curvature) < 1e-9);
}

TEST_CASE("forming begins with tools that touch the fabric and do not overlap it, and its shear is the angle between tows") {
    const FabricParameters fabric = small_fabric();
    observe::Snapshot snapshot = woven_snapshot(fabric, 0.1);
    const LoadCase load = load_case("forming", snapshot, fabric, TowEnds::kept, ball);
    CHECK(load.bodies.of(Edge::west) == -1);
    REQUIRE(load.assembly.tools().size() == 3);
    double low = 1e9, high = -1e9;
    for (const observe::FibreSnapshot& fibre : snapshot.fibres)
        for (const Vec3& node : fibre.position)
            low = std::min(low, node.z() - fibre.section.radius()), high = std::max(high, node.z() + fibre.section.radius());
    CHECK(load.forming.thickness == test::near(high - low, 1e-13));
    const auto distance = [&](Index tool, const Vec3& x) {
        return scene::tool_distance(load.assembly.tools()[core::at(tool)], x).distance;
    };
    const Vec3 below(0, 0, low), beside(2.5, 0, low), above(2.5, 0, high);
    CHECK(std::abs(distance(load.forming.punch, below)) < 1e-13);
    CHECK(std::abs(distance(load.forming.holder, beside)) < 1e-13);
    CHECK(std::abs(distance(load.forming.die, above)) < 1e-13);
    CHECK(distance(load.forming.die, {0, 0, high}) > 1.8);  // its hole
    // The holder meets the die where the fabric would be gone, the punch has risen by the radius of the hole.
    const scene::Tool &holder = load.assembly.tools()[core::at(load.forming.holder)],
                      &punch = load.assembly.tools()[core::at(load.forming.punch)];
    CHECK((scene::tool_pose(holder, 1.0).place(beside) - above).norm() < 1e-13);
    CHECK(scene::tool_pose(punch, 1.0).shift.z() == test::near(2.0, 1e-14));

    FormingParameters tight = ball;
    tight.hole_radius = 0.5;
    CHECK(test::refusal([&] {
              load_case("forming", snapshot, fabric, TowEnds::kept, tight);
          }).starts_with("FormingParameters.hole_radius = 0.5, but it must be >= the punch's radius and the thickness"));
    tight.hole_radius = core::unset;
    CHECK(test::refusal([&] { load_case("forming", snapshot, fabric, TowEnds::kept, tight); }) ==
          "FormingParameters.hole_radius = nan, but it must be finite and > 0");

    CHECK(greatest_shear_deg(snapshot, fabric) < 0.05);  // waves between nodes are cubic
    const double angle = 0.3;                            // x of the wefts' nodes goes along with y: warps stay
    for (observe::FibreSnapshot& fibre : snapshot.fibres)
        for (Vec3& node : fibre.position) node.x() += std::tan(angle) * node.y();
    // Tows are waved: their tangents at crossings lie in the plane.
    CHECK(greatest_shear_deg(snapshot, fabric) == test::near(angle * 180.0 / 3.14159265358979, 3e-3));
}

}  // namespace load_cases_test
