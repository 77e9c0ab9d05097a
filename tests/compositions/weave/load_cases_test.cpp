// SPDX-License-Identifier: MIT
#include "compositions/weave/woven_snapshot.hpp"
#include "refusal.hpp"

#include <fibrant/compositions/weave/fibre_figures.hpp>
#include <fibrant/compositions/weave/load_cases.hpp>
#include <fibrant/connection/body_motion.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace fibrant;

namespace load_cases_test {

using namespace fibrant::compositions::weave;

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
    CHECK(west.x() == doctest::Approx(-0.5 * fabric.fibre_length(Family::warp)));
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
    const auto tow = [&](Edge edge, Index t) { return motion.position(load.bodies.tow_end[static_cast<std::size_t>(edge)][core::at(t)]); };
    for (Index t = 0; t < 4; ++t) {
        CHECK(std::abs((tow(Edge::east, t) - tow(Edge::west, t)).head<2>().norm() - load.width) < 1e-12);
        CHECK(std::abs((tow(Edge::north, t) - tow(Edge::south, t)).head<2>().norm() - load.height) < 1e-12);
    }
    const LoadCase shear = load_case("shear", snapshot, fabric);
    const connection::Channels names(shear.assembly);
    CHECK(names.names() == std::vector<std::string>{shear_channel, tension_channel});
    CHECK(connection::BodyMotion(shear.assembly, names).free_coordinates() == 7);  // the height; of two edges both places and the turn
}

TEST_CASE("every load case can be built, and one that is not known is refused") {
    const FabricParameters fabric = small_fabric();
    const observe::Snapshot snapshot = woven_snapshot(fabric, 0.1);
    for (const std::string& name : load_case_names()) {
        CAPTURE(name);
        const LoadCase load = load_case(name, snapshot, fabric, true);
        CHECK(core::count(load.assembly.fibres()) == fabric.fibres());
        CHECK(!load.assembly.averages().empty());
        CHECK(load.width == doctest::Approx(fabric.fibre_length(Family::warp)));
    }
    CHECK(load_case("compaction", snapshot, fabric).plate_distance == doctest::Approx(2.0 * 0.1 + fabric.warp.packing().thickness).epsilon(0.05));
    CHECK(test::refusal([&] { load_case("tickle", snapshot, fabric); }) == "load_case.name = tickle, but it must be a load case");
}

TEST_CASE("figures of tows are those of the sections they are drawn with") {
    const FabricParameters fabric = small_fabric();
    const observe::Snapshot snapshot = woven_snapshot(fabric, 0.1);
    const TowFigures figures = tow_figures(snapshot, fabric, Family::warp);
    const Packing packing = fabric.warp.packing();
    // Convex hulls of 128-gons: 2e-4 of a radius; tows are level at their crossings.
    CHECK(figures.width == doctest::Approx(packing.width).epsilon(1e-3));
    CHECK(figures.gap == doctest::Approx(fabric.warp_spacing - packing.width).epsilon(1e-2));
    // A uniform stretch of straight fibres.
    observe::Snapshot straight = woven_snapshot(fabric, 0.0);
    for (observe::FibreSnapshot& fibre : straight.fibres)
        for (std::size_t k = 0; k < fibre.position.size(); ++k) {
            fibre.displacement[k] = 0.01 * fibre.position[k];
            fibre.position[k] *= 1.01;
        }
    const ElementFigures elements = element_figures(straight);
    CHECK(core::count(elements.strain) == fabric.fibres() * fabric.elements);
    for (const double strain : elements.strain) CHECK(strain == doctest::Approx(0.01));
    for (const double curvature : elements.curvature) CHECK(std::abs(curvature) < 1e-9);
}

}  // namespace load_cases_test
