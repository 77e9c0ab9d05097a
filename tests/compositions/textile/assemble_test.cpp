// SPDX-License-Identifier: MIT
// Scenes of textiles: fibres along paths, orders of yarns of several fibres; audits that see what was exchanged, lost or
// unlinked.
#include <near.hpp>
#include "../../refusal.hpp"

#include <fibrant/compositions/textile/audit.hpp>
#include <fibrant/compositions/textile/braids.hpp>
#include <fibrant/compositions/textile/imported.hpp>
#include <fibrant/compositions/textile/strands.hpp>
#include <fibrant/compositions/textile/weaves.hpp>
#include <fibrant/exchange/files.hpp>

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

TEST_CASE("tows of an interlock have one order for each pair that crosses; pairs that cross both ways have none") {
    const Textile weave = woven({.levels = levels_of({"0202", "1111", "2020"}),
                                 .layers = 2,
                                 .column_spacing = 1.8,
                                 .warp_spacing = 0.95,
                                 .warp = yarn(7),
                                 .weft = yarn(7)});
    CHECK(assemble(weave, {}).assembly.orders().size() == 3 * 4 * 2);
    const Textile braid = flat_braid({.yarns = 3, .half_width = 0.8, .period = 8.0, .type = yarn(7)});
    CHECK(assemble(braid, {}).assembly.orders().size() == 3);  // of three strands each lies above the next, for good
    CHECK(assemble(flat_braid({.yarns = 4, .half_width = 1.2, .period = 12.0, .type = yarn(7)}), {}).assembly.orders().size() <
          6);
    CHECK(assemble(flat_braid({.yarns = 3, .half_width = 0.18, .period = 1.8, .type = yarn(1)}), {}).assembly.orders().empty());
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

}  // namespace textile_assemble_test
