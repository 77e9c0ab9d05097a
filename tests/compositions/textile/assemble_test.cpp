// SPDX-License-Identifier: MIT
// Scenes of textiles: fibres along paths, orders of yarns of several fibres; audits that see what was exchanged, lost or
// unlinked.
#include "../../refusal.hpp"
#include <near.hpp>

#include <fibrant/compositions/textile/audit.hpp>
#include <fibrant/compositions/textile/braids.hpp>
#include <fibrant/compositions/textile/imported.hpp>
#include <fibrant/compositions/textile/knits.hpp>
#include <fibrant/compositions/textile/load_cases.hpp>
#include <fibrant/compositions/textile/periodic.hpp>
#include <fibrant/compositions/textile/settle.hpp>
#include <fibrant/compositions/textile/strands.hpp>
#include <fibrant/compositions/textile/weaves.hpp>
#include <fibrant/compositions/textile/yarn_contacts.hpp>
#include <fibrant/exchange/files.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

namespace textile_assemble_test {

using namespace fibrant;
using namespace fibrant::compositions::textile;
using fibrant::test::refusal;
constexpr double pi = std::numbers::pi;

YarnType yarn(Index fibres, double radius = 0.05) {
    YarnType type;
    type.fibres = fibres, type.radius = radius, type.material = {3000.0, 0.3};
    return type;
}
std::vector<Line> drawn_lines(const Assembled& assembled) {
    std::vector<Line> lines;
    for (const scene::FibreSpecification& fibre : assembled.assembly.fibres()) {
        const scene::Curve& curve = fibre.start ? fibre.start : fibre.curve;
        std::vector<Vec3> points;
        for (Index k = 0; k <= 200; ++k) points.push_back(curve(static_cast<double>(k) / 200.0));
        if (fibre.closed) points.back() = points.front();
        lines.push_back(line_of(std::move(points)));
    }
    return lines;
}

TEST_CASE("fibres of a twisted yarn go round its path: outside ones are as long as their angle says") {
    Textile textile;
    textile.types = {yarn(7)};
    textile.types[0].twist = 0.5;
    Path path;
    path.curve = [](double t) { return Vec3(0.0, 0.0, 8.0 * t); };
    textile.paths = {path};
    const Assembled assembled = assemble(textile, {});
    REQUIRE(assembled.assembly.fibres().size() == 7);
    const double pitch = 2.0 * 0.05 * 1.02;
    for (const scene::FibreSpecification& fibre : assembled.assembly.fibres()) {
        const double length = scene::length_of(fibre.start), along = (fibre.to - fibre.from).norm();
        const double helix = 8.0 * std::hypot(1.0, 2.0 * pi * pitch * 0.5);
        CHECK(std::min(std::abs(length / 8.0 - 1.0), std::abs(length / helix - 1.0)) < 1e-4);
        CHECK(along == test::near(length, 1e-4));  // straight at rest, of the length that is drawn
    }
}

TEST_CASE(
    "tows of an interlock have one order for each pair that crosses; pairs that cross both ways one for each crossing, with its "
    "place") {
    const Textile weave = woven({.levels = levels_of({"0202", "1111", "2020"}),
                                 .layers = 2,
                                 .column_spacing = 1.8,
                                 .warp_spacing = 0.95,
                                 .warp = yarn(7),
                                 .weft = yarn(7)});
    CHECK(assemble(weave, {}).assembly.orders().size() == 3 * 4 * 2);
    const Textile braid = flat_braid({.yarns = 3, .half_width = 0.8, .period = 8.0, .type = yarn(7)});
    CHECK(assemble(braid, {}).assembly.orders().empty());  // drawn apart: each fibre is on its side
    // Drawn lower, fibres of yarns lie between each other.
    const auto lower = [](Textile textile) {
        for (Path& path : textile.paths)
            path.curve = [curve = path.curve](double t) { return Vec3(curve(t).cwiseProduct(Vec3(1.0, 1.0, 0.3))); };
        return textile;
    };
    CHECK(assemble(lower(braid), {}).assembly.orders().size() == 3);  // of three strands each lies above the next, for good
    const Textile four = lower(flat_braid({.yarns = 4, .half_width = 1.2, .period = 12.0, .type = yarn(7)}));
    const auto placed = assemble(four, {}).assembly.orders();
    CHECK(std::any_of(placed.begin(), placed.end(), [](const scene::ForcedOrder& order) { return order.placed(); }));
    for (const scene::ForcedOrder& order : placed)  // groups are numbered as yarns
        if (order.placed())
            CHECK(std::any_of(four.crossings.begin(), four.crossings.end(), [&](const Crossing& crossing) {
                const double length = scene::length_of(four.paths[core::at(order.above)].curve);
                return crossing.above == order.above && crossing.below == order.below &&
                       std::abs(crossing.at_above / length - order.at_above) < 1e-9;
            }));
    CHECK(assemble(flat_braid({.yarns = 3, .half_width = 0.18, .period = 1.8, .type = yarn(1)}), {}).assembly.orders().empty());
}

TEST_CASE("three fibres of a yarn touch each other, four lie in a square: in the least circle that holds them") {
    const double pitch = 2.0 * 0.05 * 1.02;
    for (const auto& [fibres, circle] : {std::pair{Index{3}, 1.0 / std::sqrt(3.0)}, {Index{4}, 1.0 / std::sqrt(2.0)}}) {
        const std::vector<Eigen::Vector2d> centres = section_of(yarn(fibres));
        REQUIRE(core::count(centres) == fibres);
        Eigen::Vector2d sum = Eigen::Vector2d::Zero();
        for (const Eigen::Vector2d& centre : centres) {
            sum += centre;
            CHECK(centre.norm() == test::near(circle * pitch, 1e-12));
        }
        CHECK(sum.norm() < 1e-12 * pitch);
    }
    // Side by side, on each other, and going round each other.
    CHECK(half_thickness(yarn(2)) == test::near(0.05, 1e-12));
    CHECK(half_thickness(yarn(4)) == test::near(0.05 + 0.5 * pitch, 1e-12));
    YarnType twisted = yarn(2);
    twisted.twist = 1.0;
    CHECK(half_thickness(twisted) == test::near(0.05 + 0.5 * pitch, 1e-12));
}

TEST_CASE("sections of yarns lie level however their paths bend, and fibres drawn apart cross as yarns do, without an order") {
    for (const Index fibres : {2, 3, 4}) {
        CAPTURE(fibres);
        WeftKnit plain{
            .courses = 3, .wales = 3, .wale_spacing = 1.6, .course_spacing = 1.2, .loop_height = 1.0, .type = yarn(fibres)};
        const Textile knit = weft_knit(plain);
        const Assembled assembled = assemble(knit, {});
        const std::vector<Line> drawn = drawn_lines(assembled);
        CHECK(audit_topology(knit, assembled, drawn, drawn).clean());
        CHECK(assembled.assembly.orders().empty());
        // Of a pair side by side neither lies above the other, anywhere: but for what splines miss between their points.
        if (fibres == 2)
            for (std::size_t k = 0; k < drawn[0].points.size(); ++k)
                CHECK(std::abs(drawn[0].points[k].z() - drawn[1].points[k].z()) < 1e-3 * 0.05);
    }
}

TEST_CASE(
    "held ends of two yarns that lie in each other are refused by yarn, on either side of a cell's wall; free ones are not") {
    const double r = 0.05, deep = 1e-3;
    for (const double at : {0.0, 1.99 * r, 2.0 * r, -2.01 * r})
        for (int axis = 0; axis < 3; ++axis) {
            const auto apart = [&](double distance, Ends ends) {
                Textile textile;
                textile.name = "two";
                textile.types = {yarn(1, r)};
                for (const double aside : {at, at + distance}) {
                    const Vec3 from = aside * Vec3::Unit(axis), way = 2.0 * Vec3::Unit((axis + 1) % 3);
                    Path path;
                    path.ends = ends, path.curve = [=](double t) { return Vec3(from + t * way); };
                    textile.paths.push_back(path);
                }
                require_ends_apart(textile, assemble(textile, {}), deep);
            };
            apart(2.0 * r - 0.9 * deep, Ends::held);
            apart(-2.0 * r + 0.9 * deep, Ends::held);
            apart(0.5 * r, Ends::free);
            for (const double distance : {0.5 * r, -0.5 * r, 2.0 * r - 1.1 * deep})
                CHECK(refusal([&] { apart(distance, Ends::held); }).find("distance of ends of fibres of") != std::string::npos);
        }
}

TEST_CASE("ends that lie in each other are refused by the field that they are apart by, and the least value named does") {
    const double deep = 1e-3;
    // The value that a message names, and what it says where that is taken.
    const auto named = [](const std::string& message) { return std::stod(message.substr(message.find(">= ") + 3)); };
    const auto ends_of = [&](const Textile& textile) {
        Textile held = textile;
        for (Path& path : held.paths) path.ends = Ends::held;
        return refusal([&] { require_ends_apart(held, assemble(held, {}), deep); });
    };
    const auto expect = [&](const std::string& field, double given, const auto& draw) {
        CAPTURE(field);
        const std::string message = ends_of(draw(given));
        REQUIRE(message.find(field + " = ") == 0);
        const double least = named(message);
        CHECK(least > given);
        CHECK(ends_of(draw(least * 1.001)).empty());
        CHECK_FALSE(ends_of(draw(given + 0.97 * (least - given))).empty());
    };
    const auto woven_at = [&](double column, double warp, double layer) {
        return woven({.levels = levels_of({"02", "02"}),
                      .layers = 2,
                      .column_spacing = column,
                      .warp_spacing = warp,
                      .layer_spacing = layer,
                      .warp = yarn(1),
                      .weft = yarn(1)});
    };
    expect("FlatBraid.half_width", 0.151, [&](double x) {
        return flat_braid({.yarns = 3, .half_width = x, .period = 4.0, .type = yarn(1), .height_over_radius = 0.1});
    });
    expect("LevelPlan.warp_spacing", 0.08, [&](double x) { return woven_at(0.8, x, 0.0); });
    expect("LevelPlan.layer_spacing", 0.09, [&](double x) { return woven_at(0.8, 0.3, x); });
    // Fibres of a yarn stay beside its path as they are: rows of two that lie side by side.
    expect("LevelPlan.warp_spacing", 0.17, [&](double x) {
        return woven(
            {.levels = levels_of({"01", "01"}), .column_spacing = 0.8, .warp_spacing = x, .warp = yarn(2), .weft = yarn(1)});
    });
    // Of paths that no generator has drawn fibres are to be thinner.
    Textile two;
    two.types = {yarn(1)};
    for (const double y : {0.0, 0.09}) {
        Path path;
        path.curve = [=](double t) { return Vec3(2.0 * t, y, 0.0); };
        two.paths.push_back(path);
    }
    const std::string message = ends_of(two);
    REQUIRE(message.find("YarnType.radius = 0.05, but it must be <= ") == 0);
    two.types[0].radius = std::stod(message.substr(message.find("<= ") + 3)) * 0.999;
    CHECK(ends_of(two).empty());
    // So are the two ends of one path that comes round.
    Textile ring;
    ring.types = {yarn(1)};
    Path round;
    round.curve = [](double t) { return Vec3(std::cos(6.2 * t), std::sin(6.2 * t), 0.0); };
    ring.paths = {round};
    const std::string own = ends_of(ring);
    REQUIRE(own.find("YarnType.radius = 0.05, but it must be <= ") == 0);
    ring.types[0].radius = std::stod(own.substr(own.find("<= ") + 3)) * 0.99;
    CHECK(ends_of(ring).empty());
}

TEST_CASE("the audit of crossings sees two fibres that changed places, one that is gone, and the drawn state as right") {
    const Textile weave = woven(
        {.levels = levels_of({"0101", "1010"}), .column_spacing = 0.6, .warp_spacing = 0.3, .warp = yarn(1), .weft = yarn(1)});
    const Assembled assembled = assemble(weave, {});
    const std::vector<Line> drawn = drawn_lines(assembled);
    CHECK(audit_topology(weave, assembled, drawn, drawn).clean());
    std::vector<Line> moved = drawn;
    for (Vec3& point : moved[0].points) point.z() = -point.z();
    TopologyAudit audit = audit_topology(weave, assembled, drawn, moved);
    CHECK(audit.crossings.wrong == 4);
    CHECK(audit.first_yarn == 0);
    moved = drawn;
    for (Vec3& point : moved[5].points) point.x() += 10.0;
    audit = audit_topology(weave, assembled, drawn, moved);
    CHECK(audit.crossings.missing == 2);
    CHECK_FALSE(audit.clean());
}

TEST_CASE(
    "wefts of a column that no warp passes between may roll beside each other, and are wrong once the lower one lies above") {
    const double radius = 0.05;
    const Textile weave = woven({.levels = levels_of({"02", "20", "02"}),
                                 .layers = 2,
                                 .column_spacing = 0.6,
                                 .warp_spacing = 0.3,
                                 .warp = yarn(1, radius),
                                 .weft = yarn(1, radius)});
    const Assembled assembled = assemble(weave, {});
    const std::vector<Line> drawn = drawn_lines(assembled);
    CHECK(detail::lies_along(weave, 4, 3) == 1);
    CHECK(detail::lies_along(weave, 3, 4) == -1);
    CHECK(detail::lies_along(weave, 3, 5) == 0);  // of another column
    CHECK(detail::lies_along(weave, 0, 2) == 0);
    CHECK(detail::lies_along(weave, 0, 3) == 0);
    // From above it the upper one goes to one side, at 45 degrees, and back.
    const auto rolled = [&](Index weft, double aside, double rise) {
        std::vector<Line> moved = drawn;
        std::vector<Vec3>& points = moved[static_cast<std::size_t>(weft)].points;
        const double y0 = points.front().y(), y1 = points.back().y();
        for (Vec3& point : points) {
            const double way = std::min(point.y() - y0, y1 - point.y()) - 2.0 * radius;
            point.x() += std::clamp(way, -0.5 * aside, aside), point.z() += rise;
        }
        return audit_topology(weave, assembled, drawn, moved).crossings;
    };
    CHECK(rolled(4, 1.5 * radius, 0.0).clean());
    const CrossingAudit below = rolled(4, 1.5 * radius, -4.5 * radius);
    CHECK(below.extra == 2);
    // One that lies beside it, in another column, may not come to lie above it.
    CHECK(rolled(6, 0.0, 0.0).clean());
    std::vector<Line> moved = drawn;
    for (Vec3& point : moved[6].points) point.x() -= 2.0 * 0.6 * std::min(1.0, 4.0 * std::abs(point.y() - 0.3));
    CHECK(audit_topology(weave, assembled, drawn, moved).crossings.extra > 0);
}

TEST_CASE("ends of a net are pulled along it and keep their distances, so that those of neighbours never cross") {
    Textile meshes = net({.yarns = 4, .spacing = 0.8, .period = 3.0, .periods = 2.0, .type = yarn(1)});
    for (Path& path : meshes.paths) path.ends = Ends::pulled, path.tension_strain = 1e-3;
    const Assembled assembled = assemble(meshes, {});
    REQUIRE(core::count(assembled.assembly.forces()) == 4);
    const std::vector<Line> drawn = drawn_lines(assembled);
    for (const scene::DeadForce& pull : assembled.assembly.forces()) {
        CHECK(pull.force.normalized().dot(Vec3::UnitY()) == test::near(1.0, 1e-12));
        // Its own slant is another one.
        const std::vector<Vec3>& points = drawn[static_cast<std::size_t>(pull.at.fibre)].points;
        CHECK((points.back() - points[points.size() - 2]).normalized().y() < 0.95);
    }
}

TEST_CASE(
    "rings that are at rest as drawn come to rest once nothing moves: no force is left that damping could be small against") {
    Textile mail = chain_mail({.rows = 2, .columns = 2, .ring_radius = 1.0, .type = yarn(1)});
    const auto driven = [&] { return scales_of(mail, assemble(mail, {})).driven; };
    CHECK(!driven());
    mail.paths[0].guides.push_back({0.5});  // something holds it
    CHECK(driven());
    mail.paths[0].guides.clear(), mail.paths[1].straight = true;  // bent into a ring
    CHECK(driven());
}

TEST_CASE("the audit of links sees rings that came apart, though nothing touches") {
    const Textile mail = chain_mail({.rows = 2, .columns = 2, .ring_radius = 1.0, .type = yarn(1)});
    const Assembled assembled = assemble(mail, {});
    const std::vector<Line> drawn = drawn_lines(assembled);
    const TopologyAudit sound = audit_topology(mail, assembled, drawn, drawn);
    CHECK(sound.clean());
    CHECK(sound.linked == 3);
    std::vector<Line> moved = drawn;
    for (Vec3& point : moved[0].points) point.z() += 10.0;
    CHECK(audit_topology(mail, assembled, drawn, moved).links_changed == 1);
    // Plies that were driven through each other: their linking integral tells.
    const Textile plies = plied({.plies = 2, .pitch = 2.0, .length = 6.0, .type = yarn(1)});
    const Assembled two = assemble(plies, {});
    const std::vector<Line> wound = drawn_lines(two);
    std::vector<Line> unwound = wound;
    for (Line& line : unwound)
        for (std::size_t k = 0; k < line.points.size(); ++k) line.points[k].head<2>() = line.points[0].head<2>();
    CHECK(audit_topology(plies, two, wound, wound).clean());
    CHECK_FALSE(audit_topology(plies, two, wound, unwound).clean());
}

TEST_CASE("what is drawn too sharply for its thickness, or does not close, is refused by yarn before work") {
    Textile textile;
    textile.types = {yarn(1, 0.2)};
    Path path;
    path.name = "bend", path.kind = PathKind::closed;
    path.curve = [](double t) { return Vec3(0.1 * std::cos(2.0 * pi * t), 0.1 * std::sin(2.0 * pi * t), 0.0); };
    textile.paths = {path};
    const std::string message = refusal([&] { validate(textile); });
    CHECK(message.find("radius of curvature") != std::string::npos);
    CHECK(message.find("yarn 0 'bend'") != std::string::npos);
    textile.paths[0].curve = [](double t) { return Vec3(t, 0.0, 0.0); };
    CHECK(refusal([&] { validate(textile); }).find("distance of its end from the image of its start") != std::string::npos);
}

TEST_CASE("a textile that was written and read again has the same paths and crossings") {
    const Textile braid = tubular_braid({.carriers = 4, .radius = 0.4, .pitch = 2.5, .turns = 1.0, .type = yarn(1)});
    const std::vector<exchange::FileCurve> curves = curves_of(braid, 200);
    for (const char* kind : {"csv", "vtk", "obj", "inp"}) {
        std::vector<exchange::FileCurve> read;
        const std::string bytes = exchange::file_of(curves, kind);
        if (std::string(kind) == "csv") read = exchange::curves_of_csv(bytes, "a");
        if (std::string(kind) == "vtk") read = exchange::curves_of_vtk(bytes, "a");
        if (std::string(kind) == "obj") read = exchange::curves_of_obj(bytes, "a");
        if (std::string(kind) == "inp") read = exchange::curves_of_inp(bytes, "a");
        const Textile again = textile_of(exchange::cleaned(read, "a"), yarn(1), braid.view);
        REQUIRE(again.paths.size() == braid.paths.size());
        double off = 0.0;
        for (std::size_t p = 0; p < curves.size(); ++p)
            for (std::size_t k = 0; k < 200; ++k) off = std::max(off, (read[p].points[k] - curves[p].points[k]).norm());
        CHECK(off < 1e-9);
        CHECK(again.crossings.size() == 32);
        CHECK(audit_crossings(braid.crossings, again.crossings).clean());
    }
    // Noise of a twentieth of a radius on every point is gone to a third of it after smoothing over four points.
    std::vector<Vec3> noisy;
    double before = 0.0, after = 0.0;
    for (Index k = 0; k <= 200; ++k)
        noisy.emplace_back(0.05 * static_cast<double>(k), 0.0025 * (static_cast<double>((k * 7919) % 101) / 50.0 - 1.0), 0.0);
    const std::vector<Vec3> smooth = smoothed(noisy, 4.0, false);
    for (std::size_t k = 0; k < noisy.size(); ++k) before += noisy[k].y() * noisy[k].y(), after += smooth[k].y() * smooth[k].y();
    CHECK(after < before / 9.0);
    CHECK((smooth.front() - noisy.front()).norm() < 1e-12);
}

/// A state of straight fibres, nine nodes each, with directors across them.
observe::Snapshot straight(const std::vector<std::pair<Vec3, Vec3>>& ends, double radius) {
    observe::Snapshot state;
    for (const auto& [from, to] : ends) {
        observe::FibreSnapshot fibre;
        const Vec3 along = (to - from).normalized(), first = scene::any_perpendicular(along);
        for (Index k = 0; k <= 8; ++k) {
            fibre.position.push_back(from + 0.125 * static_cast<double>(k) * (to - from));
            fibre.director_1.push_back(first), fibre.director_2.push_back(along.cross(first)), fibre.curvature.push_back(0.0);
        }
        fibre.section = scene::circular(radius);
        state.fibres.push_back(fibre);
    }
    return state;
}
/// Straight yarns of one fibre, and their scene.
std::pair<Textile, Assembled> straight_yarns(const std::vector<std::pair<Vec3, Vec3>>& ends, double radius) {
    Textile textile;
    textile.types = {yarn(1, radius)};
    for (const auto& [from, to] : ends) {
        Path path;
        path.curve = [from = from, to = to](double t) { return Vec3((1.0 - t) * from + t * to); };
        textile.paths.push_back(path);
    }
    Fineness fineness;
    fineness.element_over_radius = 100.0, fineness.least_elements = 4;
    return {textile, assemble(textile, fineness)};
}

TEST_CASE("contact lengths of yarns are those of cylinders, and moves are told fibre by fibre") {
    const double r = 0.1, near = 0.05;
    // Two side by side over their lengths, a third across both, just touching; a fourth far off.
    const std::vector<std::pair<Vec3, Vec3>> ends{{Vec3(-1, 0, 0), Vec3(1, 0, 0)},
                                                  {Vec3(-1, 2 * r, 0), Vec3(1, 2 * r, 0)},
                                                  {Vec3(0, -1, 2 * r), Vec3(0, 1, 2 * r)},
                                                  {Vec3(0, 0, 5), Vec3(1, 0, 5)}};
    const auto [textile, assembled] = straight_yarns(ends, r);
    observe::Snapshot state = straight(ends, r);
    state.contacts.push_back({.fibre_i = 0, .fibre_j = 2, .reaction = 3.0, .friction = Vec3(0.3, 0.4, 0)});
    state.contacts.push_back({.fibre_i = 1, .fibre_j = 2, .reaction = 2.0});
    state.contacts.push_back({.fibre_i = 1, .fibre_j = 2, .reaction = 1.0});
    state.contacts.push_back({.fibre_i = 0, .fibre_j = 1, .reaction = 0.0});
    const YarnContacts contacts = yarn_contacts(textile, assembled, state, near);
    const double reach = 2.0 * std::sqrt(std::pow(2.0 * r + near * r, 2) - 4.0 * r * r), step = 2.0 / 64.0;
    REQUIRE(contacts.pairs.size() == 3);
    CHECK(contacts.pairs[0].length == test::near(2.0, 1e-9));
    CHECK(std::abs(contacts.pairs[1].length - reach) <= 2.0 * step);  // by samples
    CHECK(contacts.length[0] == test::near(2.0, 1e-9));
    CHECK(std::abs(contacts.length[2] - 2.0 * reach) <= 4.0 * step);  // under either of the two
    CHECK(contacts.length[3] == 0.0);
    CHECK(contacts.pairs[1].normal_force == 3.0);
    CHECK(contacts.pairs[1].friction_force == test::near(0.5, 1e-12));
    CHECK(contacts.pairs[2].contacts == 2);
    CHECK(contacts.pairs[2].normal_force == 3.0);
    CHECK(contacts.pairs[0].contacts == 0);
    observe::Snapshot moved = state;
    for (Vec3& point : moved.fibres[2].position) point.z() += 0.03;
    moved.fibres[3].position[4].x() += 0.09;
    const std::vector<Moves> moves = moves_between(state, moved);
    CHECK(moves[0].greatest == 0.0);
    CHECK(moves[2].mean == test::near(0.03, 1e-12));
    CHECK(moves[2].root_mean_square == test::near(0.03, 1e-12));
    CHECK(moves[3].mean == test::near(0.01, 1e-9));
    CHECK(moves[3].root_mean_square == test::near(0.03, 1e-9));
    // Points of a file beside the fibre, one of them beyond its end.
    const Moves own = moves_from({Vec3(-0.93, 0.02, 0), Vec3(0.61, 0, -0.04), Vec3(1.03, 0, 0)}, state.fibres[0]);
    CHECK(own.mean == test::near(0.03, 1e-9));
    CHECK(own.greatest == test::near(0.04, 1e-9));
}

TEST_CASE("what repeats is tied to its image under the pull of its yarns, and its gaps are seen across seams") {
    Textile braid =
        flat_braid({.yarns = 3, .half_width = 0.18, .period = 1.8, .periods = 1.0, .periodic = true, .type = yarn(1)});
    CHECK(core::count(braid.crossings) == 6);
    CHECK(refusal([&] { validate(braid); }).empty());
    for (Path& path : braid.paths) path.tension_strain = 0.002;
    braid.free_lengths();
    const Assembled cell = assemble(braid, {});
    REQUIRE(cell.assembly.cells().size() == 1);
    CHECK(cell.assembly.pairs().size() == 3);
    const scene::Coordinate& along = cell.assembly.cells()[0].component(1, 1);
    CHECK(along.free);
    CHECK(along.value == test::near(3.0 * 0.002 * 3000.0 * pi * 0.0025 * 1.8, 1e-12));  // of three yarns, over the period
    CHECK_FALSE(cell.assembly.cells()[0].component(0, 0).free);
    CHECK(core::count(woven({.levels = levels_of({"01", "10"}),
                             .column_spacing = 0.4,
                             .warp_spacing = 0.4,
                             .periodic = true,
                             .warp = yarn(1),
                             .weft = yarn(1)})
                          .crossings) == 4);
    CHECK(refusal([] {
              flat_braid({.yarns = 3, .half_width = 0.18, .period = 1.8, .periods = 1.5, .periodic = true, .type = yarn(1)});
          }).find("FlatBraid.periods") == 0);
    CHECK(refusal([] {
              woven({.levels = levels_of({"01", "10"}),
                     .columns = 3,
                     .column_spacing = 0.4,
                     .warp_spacing = 0.4,
                     .periodic = true,
                     .warp = yarn(1),
                     .weft = yarn(1)});
          }).find("LevelPlan.columns = 3") == 0);
    // Two bars along x in a cell that is 0.3 wide, 0.12 apart: across its edge they are 0.18 apart. Then one leans to its image.
    const double r = 0.05;
    std::vector<std::pair<Vec3, Vec3>> ends{{Vec3(-1, 0, 0), Vec3(1, 0, 0)}, {Vec3(-1, 0.18, 0), Vec3(1, 0.18, 0)}};
    const auto made = straight_yarns(ends, r);
    const Assembled& assembled = made.second;
    Textile bars = made.first;
    for (Path& path : bars.paths) path.kind = PathKind::periodic, path.image = Vec3(2, 0, 0);
    bars.lattice = {Vec3(2, 0, 0)};
    const proximity::GridSearch search;
    CHECK(image_gap(bars, assembled, straight(ends, r), search).gap == test::near(0.08, 1e-9));
    bars.lattice.push_back(Vec3(0, 0.3, 0));
    CHECK(refusal([&] { image_gap(bars, assembled, straight(ends, r), search); }).find("Textile.lattice") == 0);
    bars.paths[1].image = bars.lattice[1];  // as if it went on sideways: what the bars' own ends say is 0.3 no more
    ends[1] = {Vec3(0, -0.3, 0.14), Vec3(0, 0.0, 0.14)};
    CHECK(image_gap(bars, assembled, straight(ends, r), search).gap == test::near(0.04, 1e-9));
    CHECK(doubled(bars, assembled, straight(ends, r)).fibres.size() == 4);
    CHECK(doubled(bars, assembled, straight(ends, r)).fibres[0].position.back().x() == test::near(3.0, 1e-12));
    // Six strains: the matrix, and how far it is from symmetric.
    CellStiffness stiffness;
    CellMatrix given = CellMatrix::Identity();
    given(0, 1) = 0.5, given(1, 0) = 0.4;
    stiffness.amount.fill(1e-3);
    stiffness.unstrained = CellVector::Ones();
    stiffness.later = stiffness.unstrained + CellVector::Constant(2e-4);  // what creeps in an increment is no stiffness
    for (Index c = 0; c < 6; ++c)
        for (const double side : {1e-3, -1e-3}) stiffness.efforts.push_back(stiffness.unstrained + side * given.col(c));
    stiffness.evaluate();
    CHECK(stiffness.creep == test::near(0.2, 1e-9));
    CHECK((stiffness.matrix - given).norm() < 1e-12);
    CHECK(stiffness.asymmetry == test::near(0.1, 1e-9));
}

TEST_CASE("grips hold the nodes within them, and what they cannot hold is refused") {
    const double r = 0.05;
    const std::vector<std::pair<Vec3, Vec3>> ends{
        {Vec3(0, 0, 0), Vec3(4, 0, 0)}, {Vec3(0, 1, 0), Vec3(4, 1, 0)}, {Vec3(2, -1, 0.1), Vec3(2, 2, 0.1)}};
    const auto yarns = straight_yarns(ends, r);
    const Textile& textile = yarns.first;
    const Assembled& assembled = yarns.second;
    const observe::Snapshot state = straight(ends, r);
    const Vector unknowns = Vector::Zero(0);
    LoadCaseParameters parameters;
    parameters.grip = 1.0, parameters.amount = 0.1;
    const LoadCase pulled = load_case(textile, assembled, state, unknowns, parameters);
    CHECK(pulled.length == test::near(2.0, 1e-12));
    CHECK(pulled.width == test::near(3.0 + 2.0 * r, 1e-12));
    CHECK(pulled.gripped == std::array<Index, 2>{2, 2});
    // Three nodes of two fibres in each of two grips, each with two directors.
    CHECK(pulled.assembly.averages().size() == 2u * 2u * 3u * 3u);
    // The third fibre does not turn about itself, and its ends stay where they are but along x.
    REQUIRE(pulled.assembly.holds().size() == 4);
    CHECK((pulled.assembly.holds().back().directions - Mat3(Vec3(0, 1, 1).asDiagonal())).norm() == 0.0);
    parameters.guided = false;
    CHECK(load_case(textile, assembled, state, unknowns, parameters).assembly.holds().size() == 2);
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
        const scene::RigidBody& grip = pulled.assembly.bodies()[core::at(pulled.bodies[side])];
        CHECK(grip.position.x() == test::near(side == 0 ? 1.0 : 3.0, 1e-12));
        CHECK(grip.translation[0].value == test::near(side == 0 ? -0.1 : 0.1, 1e-12));
    }
    parameters.name = "bending", parameters.across = 2;
    const LoadCase bent = load_case(textile, assembled, state, unknowns, parameters);
    CHECK(bent.assembly.bodies()[0].rotation[1].value == test::near(-0.05, 1e-12));  // what lies between rises
    CHECK(bent.assembly.bodies()[1].translation[0].free);
    parameters.name = "compaction", parameters.axis = 2, parameters.across = 0, parameters.amount = 0.25;
    const LoadCase pressed = load_case(textile, assembled, state, unknowns, parameters);
    CHECK(pressed.length == test::near(0.2, 1e-12));
    CHECK(pressed.assembly.tools()[0].displacement.z() == test::near(0.025, 1e-12));
    CHECK(pressed.assembly.bodies().empty());
    parameters.name = "tension", parameters.axis = 0, parameters.across = 1, parameters.grip = 2.0;
    CHECK(refusal([&] {
              load_case(textile, assembled, state, unknowns, parameters);
          }).find("LoadCaseParameters.grip = 2, but it must be < half the length") == 0);
    parameters.across = 0;
    CHECK(refusal([&] { parameters.validate(); }).find("another axis than axis") != std::string::npos);
    parameters.across = 1, parameters.amount = -0.7;
    CHECK(refusal([&] { parameters.validate(); }).find("> -0.5 and not 0") != std::string::npos);

    std::vector<std::pair<double, double>> cubic;
    for (int k = 0; k <= 10; ++k)
        cubic.emplace_back(0.02 * k, 3.0 * (0.02 * k) - 200.0 * std::pow(0.02 * k, 2) + 5000.0 * std::pow(0.02 * k, 3));
    const CurveFit fit = fit_curve(cubic);
    REQUIRE(fit.coefficients.size() == 4);
    CHECK(fit.coefficients[1] == test::near(3.0, 1e-9));
    CHECK(fit.coefficients[3] == test::near(5000.0, 1e-9));
    CHECK(fit.misfit < 1e-12);
    const CurveFit line = fit_curve({{0.0, 0.0}, {1.0, 1.0}, {2.0, 4.0}}, 1);  // 2 x - 1/3
    CHECK(line.misfit == test::near(2.0 / 3.0 / 4.0, 1e-9));
    CHECK(initial_slope({{0.0, 1.0}, {1.0, 3.0}, {2.0, 5.0}, {3.0, 100.0}}) == test::near(2.0, 1e-12));
}

TEST_CASE("a yarn of several fibres repeats by their mean") {
    Textile textile;
    textile.types = {yarn(7)};
    Path path;
    path.kind = PathKind::periodic, path.image = Vec3(2, 0, 0);
    path.curve = [](double t) { return Vec3(2.0 * t, 0, 0); };
    textile.paths = {path}, textile.lattice = {path.image};
    const Assembled assembled = assemble(textile, {});
    observe::Snapshot state;
    for (const Line& line : drawn_lines(assembled)) {
        state.fibres.emplace_back();
        state.fibres.back().position = line.points;
    }
    REQUIRE(state.fibres.size() == 7);
    CHECK((images_of(textile, assembled, state)[0] - path.image).norm() < 1e-9);
}

TEST_CASE("a cell sees beside itself each of its yarns that comes near one of them, once and where it is") {
    const Textile weave = woven({.levels = levels_of({"01", "10"}),
                                 .column_spacing = 2.0,
                                 .warp_spacing = 1.5,
                                 .periodic = true,
                                 .warp = yarn(1),
                                 .weft = yarn(1)});
    const Assembled cell = assemble(weave, {});
    const std::vector<Line> own = drawn_lines(cell);
    const auto near_one = [&](Index f, const Vec3& shift) {
        for (const Line& line : own)
            for (const Vec3& point : line.points)
                for (const Vec3& other : own[core::at(f)].points)
                    if ((other + shift - point).norm() < 0.15) return true;  // three radii
        return false;
    };
    const auto seen = [&](Index f, const Vec3& shift) {
        Index times = 0;
        for (const scene::FibreImage& image : cell.assembly.images()) {
            Vec3 by = Vec3::Zero();
            for (const auto& one : image.shifts) by += one.times * cell.assembly.pairs()[core::at(one.pair)].period;
            times += image.fibre == f && (by - shift).norm() < 1e-9;
        }
        return times;
    };
    Index wanted = 0;
    for (const auto& [a, b] : {std::pair{1, 0}, std::pair{-1, 1}, std::pair{0, 1}, std::pair{1, 1}})
        for (Index f = 0; f < core::count(own); ++f) {
            const Vec3 shift = static_cast<double>(a) * weave.lattice[0] + static_cast<double>(b) * weave.lattice[1];
            if (!near_one(f, shift)) continue;
            ++wanted;
            CAPTURE(shift.transpose());
            CHECK(seen(f, shift) == 1);
        }
    CHECK(wanted == 4);  // each goes on where it ends
}

TEST_CASE("a yarn that goes aside and back is longer than its chord, and leans by the mean of its angle") {
    const std::vector<std::pair<Vec3, Vec3>> ends{{Vec3(-1, 0, 0), Vec3(1, 0, 0)}};
    const auto made = straight_yarns(ends, 0.1);
    observe::Snapshot state = straight(ends, 0.1);
    for (Vec3& point : state.fibres[0].position) point.y() = 1.0 - std::abs(point.x());
    const YarnFigures figures = yarn_figures(made.first, made.second, state).front();
    CHECK(figures.length == test::near(std::sqrt(8.0), 1e-9));
    CHECK(figures.strain == test::near(std::sqrt(2.0) - 1.0, 1e-9));
    CHECK(figures.crimp == test::near(std::sqrt(2.0) - 1.0, 1e-9));
    CHECK(figures.mean_angle == test::near(0.25 * pi, 1e-9));
}

}  // namespace textile_assemble_test
