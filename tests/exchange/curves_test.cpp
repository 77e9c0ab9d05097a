// SPDX-License-Identifier: MIT
// Files of curves: written and read again they are the same; what is wrong in them is refused by its place.
#include "../refusal.hpp"
#include <near.hpp>

#include <fibrant/exchange/binary_curves.hpp>
#include <fibrant/exchange/text_curves.hpp>
#include <fibrant/exchange/tubes.hpp>
#include <fibrant/exchange/voxel_tables.hpp>
#include <fibrant/exchange/yarn_surfaces.hpp>
#if __has_include(<pugixml.hpp>) && defined(FIBRANT_WITH_PUGIXML)
#include <fibrant/exchange/xml_curves.hpp>
#endif
#include <fibrant/observe/poly_data.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace exchange_curves_test {

using namespace fibrant;
using namespace fibrant::exchange;
using fibrant::test::refusal;
constexpr double pi = std::numbers::pi;

std::vector<FileCurve> sample() {
    FileCurve wave, ring;
    for (Index k = 0; k <= 20; ++k) {
        const double t = 0.1 * static_cast<double>(k);
        wave.points.emplace_back(t / 3.0, std::sin(t), 0.2 * std::cos(2.0 * t));
    }
    for (Index k = 0; k < 24; ++k) {
        const double a = 2.0 * pi * static_cast<double>(k) / 24.0;
        ring.points.emplace_back(std::cos(a), std::sin(a), 1.0 / 3.0);
    }
    wave.radius = 0.05, wave.group = 3, ring.radius = 0.07, ring.group = 4, ring.closed = true;
    return {wave, ring};
}
double greatest_difference(const std::vector<FileCurve>& a, const std::vector<FileCurve>& b) {
    if (a.size() != b.size()) return 1e9;
    double most = 0.0;
    for (std::size_t c = 0; c < a.size(); ++c) {
        if (a[c].points.size() != b[c].points.size() || a[c].closed != b[c].closed) return 1e9;
        for (std::size_t k = 0; k < a[c].points.size(); ++k) most = std::max(most, (a[c].points[k] - b[c].points[k]).norm());
    }
    return most;
}

TEST_CASE("text files give back the same numbers, closed curves closed and radii where the file has them") {
    const std::vector<FileCurve> given = sample();
    const std::vector<FileCurve> csv = cleaned(curves_of_csv(csv_of(given), "a.csv"), "a.csv"),
                                 vtk = cleaned(curves_of_vtk(vtk_of(given), "a.vtk"), "a.vtk"),
                                 obj = cleaned(curves_of_obj(obj_of(given), "a.obj"), "a.obj"),
                                 inp = cleaned(curves_of_inp(inp_of(given), "a.inp"), "a.inp");
    for (const auto* read : {&csv, &vtk, &obj, &inp}) CHECK(greatest_difference(given, *read) == 0.0);
    for (const auto* read : {&csv, &vtk, &inp}) CHECK((*read)[1].radius == 0.07);
    CHECK(csv[0].group == 3);
}

TEST_CASE("binary curves are the same in single precision, and closed where their count is negative") {
    const std::vector<FileCurve> read = cleaned(curves_of_bcc(bcc_of(sample()), "a.bcc"), "a.bcc");
    CHECK(greatest_difference(sample(), read) < 1e-7);
    CHECK(curves_of_bcc(bcc_of(read), "a.bcc")[0].points == read[0].points);
}

TEST_CASE("VTK's binary numbers are big-endian, and lines of version 5 are offsets") {
    std::string text =
        "# vtk DataFile Version 5.1\nt\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0\n2 0 0 3 0.5 0\nLINES 2 4\nOFFSETS "
        "vtktypeint64\n0 4\nCONNECTIVITY vtktypeint64\n0 1 2 3\n";
    CHECK(curves_of_vtk(text, "b.vtk")[0].points[3] == Vec3(3.0, 0.5, 0.0));
    std::string bytes = "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET POLYDATA\nPOINTS 2 float\n";
    for (const int c : {0x3f, 0x80, 0, 0, 0, 0, 0, 0, 0x40, 0, 0, 0, 0x40, 0x40, 0, 0, 0, 0, 0, 0, 0xbf, 0x80, 0, 0})
        bytes += static_cast<char>(c);
    bytes += "\nLINES 1 3\n";
    for (const int c : {0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 1}) bytes += static_cast<char>(c);
    const std::vector<FileCurve> read = curves_of_vtk(bytes + "\n", "b.vtk");
    CHECK(read.at(0).points == std::vector<Vec3>{Vec3(1, 0, 2), Vec3(3, 0, -1)});
}

TEST_CASE("an Abaqus file of quadratic beams in any order makes one chain, its radius that of its section") {
    const std::string text =
        "*Heading\n** a comment\n*Node\n 1, 0., 0., 0.\n2, 1,0,0\n3, 2,0,0\n4,3,0.1,0\n5,4,0.2,0\n*Element, type=B32, "
        "elset=tow\n2, 3, 4, 5\n1, 1,\n 2, 3\n*Beam section, section=CIRC, elset=TOW, material=m\n0.25\n0,1,0\n";
    const std::vector<FileCurve> read = curves_of_inp(text, "c.inp");
    REQUIRE(read.size() == 1);
    CHECK(read[0].points.size() == 5);
    CHECK(read[0].radius == 0.25);
    CHECK(refusal([&] { curves_of_inp("*NODE\n1, 0,0,0\n*ELEMENT, TYPE=B31\n1, 1, 7\n", "c.inp"); }) ==
          "c.inp:4: node = 7, but it must be one of *NODE");
}

TEST_CASE("what is wrong in a file is refused by file, place and value") {
    CHECK(refusal([] { curves_of_csv("fibre,x,y,z\n0,1,2,3\n0,1,two,3\n", "d.csv"); }) ==
          "d.csv:3: y = two, but it must be a finite number");
    CHECK(refusal([] { curves_of_csv("fibre,x,y,z\n0,1,2\n", "d.csv"); }).find("d.csv:2: 3 values, but it must be 4") == 0);
    CHECK(refusal([] { curves_of_csv("fibre,x,y\n0,1,2\n", "d.csv"); }).find("d.csv:1: has no column z") == 0);
    CHECK(refusal([] { curves_of_csv("fibre;x;y;z\n0;1;2;nan\n", "d.csv"); }).find("d.csv:2: z = nan") == 0);
    CHECK(refusal([] { curves_of_obj("v 0 0 0\nl 1 2\n", "d.obj"); }).find("d.obj:2: point = 2") == 0);
    CHECK(refusal([] { curves_of_bcc("BCX", "d.bcc"); }).find("d.bcc:byte 0") == 0);
    std::string cut = bcc_of(sample());
    CHECK(refusal([&] { curves_of_bcc(std::string_view(cut).substr(0, cut.size() - 5), "d.bcc"); }).find("points of curve 1") !=
          std::string::npos);
    CHECK(refusal([] {
              curves_of_vtk("# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS -3 float\n", "d.vtk");
          }).find("POINTS = -3") != std::string::npos);
    const auto vtk_lines = [](const std::string& rest) {
        return refusal([&] {
            curves_of_vtk("# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0 0 0 1 0 0\n" + rest,
                          "d.vtk");
        });
    };
    CHECK(vtk_lines("LINES 1 3\n2 0 0.5\n").find("point = 0.5, but it must be one of 2") != std::string::npos);
    CHECK(vtk_lines("LINES 1 3\n2.5 0 1\n").find("points of a line = 2.5, but it must be a whole number") != std::string::npos);
    CHECK(vtk_lines("LINES 1 3\n1e300 0 1\n").find("points of a line = 1e+300, but it must be a whole number") !=
          std::string::npos);
    CHECK(vtk_lines("LINES 1 3\n2 0 1\nPOINT_DATA 3\n").find("POINT_DATA = 3, but it must be 2") != std::string::npos);
    CHECK(vtk_lines("LINES 1 3\n2 0 1\nPOINT_DATA 2\n").empty());
    std::vector<FileCurve> sharp{FileCurve{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(2, 1, 0)}}};
    CHECK(refusal([&] { cleaned(sharp, "e.csv"); }).find("e.csv:curve 0, point 1: chords turn by 90 degrees") == 0);
    CHECK(refusal([&] {
              cleaned({FileCurve{{Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)}}}, "e.csv");
          }).find("e.csv:curve 0: 3 points that differ") == 0);
}

#if __has_include(<pugixml.hpp>) && defined(FIBRANT_WITH_PUGIXML)
TEST_CASE("what ParaView is given is read again, whatever way its numbers are written") {
    observe::PolyData data;
    const std::vector<FileCurve> given = sample();
    for (const FileCurve& curve : given) {
        const Index first = data.add_point(curve.points.front());
        for (std::size_t k = 1; k < curve.points.size(); ++k) data.add_point(curve.points[k]);
        data.add_line(first, core::count(curve.points), curve.closed);
    }
    CHECK(greatest_difference(given, cleaned(curves_of_vtp(data.text(), "f.vtp"), "f.vtp")) == 0.0);
    const std::string ascii =
        "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\"><PolyData><Piece NumberOfPoints=\"2\"><Points><DataArray "
        "type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0\n1 2 3</DataArray></Points><Lines><DataArray "
        "type=\"Int32\" Name=\"connectivity\" format=\"binary\">CAAAAAAAAAABAAAA</DataArray><DataArray type=\"Int32\" "
        "Name=\"offsets\" format=\"binary\">BAAAAA==AgAAAA==</DataArray></Lines></Piece></PolyData></VTKFile>";
    CHECK(curves_of_vtp(ascii, "g.vtp").at(0).points == std::vector<Vec3>{Vec3(0, 0, 0), Vec3(1, 2, 3)});
    // Counts that do not fit what follows, places that are none, and a file that was cut short behind its last number.
    const auto changed = [](std::string text, const std::string& from, const std::string& to) {
        const std::size_t at = text.find(from);
        REQUIRE(at != std::string::npos);
        text.replace(at, from.size(), to);
        return refusal([&] { curves_of_vtp(text, "g.vtp"); });
    };
    CHECK(changed(ascii, "NumberOfPoints=\"2\"", "NumberOfPoints=\"3\"") ==
          "g.vtp: NumberOfPoints = 3, but it must be 2, as many as there are");
    CHECK(changed(ascii, "NumberOfPoints=\"2\"", "NumberOfPoints=\"2\" NumberOfLines=\"7\"") ==
          "g.vtp: NumberOfLines = 7, but it must be 1, as many as there are");
    CHECK(changed(ascii, "NumberOfComponents=\"3\"", "NumberOfComponents=\"2\"") ==
          "g.vtp: Points: NumberOfComponents = 2, but it must be 3");
    CHECK(changed(ascii, "1 2 3<", "1 2<") == "g.vtp: Points: 5 numbers, but it must be three a point");
    CHECK(changed(ascii, "format=\"binary\">CAAAAAAAAAABAAAA", "format=\"ascii\">0 0.5") ==
          "g.vtp: point = 0.5 of a line, but it must be one of 2");
    const std::string whole = data.text();
    CHECK(refusal([&] {
              curves_of_vtp(std::string_view(whole).substr(0, whole.find("</AppendedData>") + 3), "g.vtp");
          }).find("the file ends early, before </VTKFile>") != std::string::npos);
    CHECK(refusal([] { curves_of_vtp("<VTKFile type=\"ImageData\"/>", "g.vtp"); }).find("g.vtp: VTKFile type = ImageData") == 0);
    CHECK(refusal([] { curves_of_vtp("<VTKFile", "g.vtp"); }).find("is no XML") != std::string::npos);
}

TEST_CASE("yarns of TexGen come back with their nodes, periods and widths") {
    std::vector<FileCurve> given = sample();
    given[0].period = given[0].points.back() - given[0].points.front();
    const std::vector<FileCurve> read = cleaned(curves_of_tg3(tg3_of(given), "h.tg3"), "h.tg3");
    CHECK(greatest_difference(given, read) == 0.0);
    CHECK(read[1].radius == 0.07);
    CHECK((read[0].period - given[0].period).norm() == 0.0);
    // A flat section is as thick as a round one of its area.
    const std::string flat =
        "<TexGenModel><Textile type=\"CTextile\"><Yarn index=\"0\"><MasterNode index=\"0\" Position=\"0, 0, 0\"/>"
        "<MasterNode index=\"1\" Position=\"1, 0, 0\"/><YarnSection><Section Width=\"0.9\" Height=\"0.1\"/></YarnSection></Yarn>"
        "</Textile></TexGenModel>";
    CHECK(curves_of_tg3(flat, "h.tg3").at(0).radius == test::near(0.15, 1e-12));
    CHECK(refusal([] {
              curves_of_tg3("<TexGenModel><Textile type=\"CTextileWeave2D\"/></TexGenModel>", "h.tg3");
          }).find("h.tg3: Textile type = CTextileWeave2D, but it must be CTextile") == 0);
}
#endif

TEST_CASE("surfaces of fibres are closed, look outwards, and hold the volume of the fibres") {
    FileCurve straight{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)}};
    straight.radius = 0.1;
    for (const FileCurve& curve : {straight, sample()[1]}) {
        Surface surface;
        add_tube(surface, curve, 8);
        double length = 0.0;
        const std::size_t n = curve.points.size();
        for (std::size_t k = 0; k + (curve.closed ? 0 : 1) < n; ++k)
            length += (curve.points[(k + 1) % n] - curve.points[k]).norm();
        CHECK(surface.volume() ==
              test::near(pi * curve.radius * curve.radius * length, curve.closed ? 0.02 : 1e-12));  // chords of a ring of 24
        // Each edge belongs to two triangles that go along it in opposite ways.
        std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
        for (const auto& t : surface.triangles)
            for (std::size_t k = 0; k < 3; ++k) edges.emplace_back(t[k], t[(k + 1) % 3]);
        std::sort(edges.begin(), edges.end());
        CHECK(std::adjacent_find(edges.begin(), edges.end()) == edges.end());
        for (const auto& [a, b] : edges) CHECK(std::binary_search(edges.begin(), edges.end(), std::pair{b, a}));
        CHECK(surface.points.size() + surface.triangles.size() == edges.size() / 2 + (curve.closed ? 0 : 2));  // Euler
    }
    const std::string glb = glb_of(sample());
    CHECK(glb.substr(0, 4) == "glTF");
    std::uint32_t size = 0;
    std::memcpy(&size, glb.data() + 8, 4);
    CHECK(size == glb.size());
    // Its root turns z up into y up, and millimetres into metres.
    const auto numbers_after = [&](const std::string& key) {
        std::vector<double> numbers;
        std::istringstream text(glb.substr(glb.find(key) + key.size()));
        for (double x = 0.0; text >> x; text.get()) numbers.push_back(x);
        return numbers;
    };
    const std::vector<double> turn = numbers_after("\"rotation\":[");
    REQUIRE(turn.size() == 4);
    CHECK((Eigen::Quaterniond(turn[3], turn[0], turn[1], turn[2]) * Vec3(Vec3::UnitZ()) - Vec3::UnitY()).norm() < 1e-15);
    CHECK(numbers_after("\"scale\":[") == std::vector<double>(3, 1e-3));
    const std::string stl = stl_of(sample());
    std::memcpy(&size, stl.data() + 80, 4);
    CHECK(stl.size() == 84 + 50 * size);
}

TEST_CASE("a tube that tapers is a frustum, and one around a knot is no more twisted at its seam than elsewhere") {
    FileCurve cone{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(3, 0, 0)}};
    cone.radius = 0.2, cone.radii = {0.1, 0.2, 0.4};
    Surface surface;
    add_tube(surface, cone, 8);
    CHECK(surface.volume() == test::near(pi / 3.0 * (0.01 + 0.02 + 0.04 + 2.0 * (0.04 + 0.08 + 0.16)), 1e-12));
    FileCurve trefoil;
    const std::size_t n = 200, sides = 8;
    for (std::size_t k = 0; k < n; ++k) {
        const double t = 2.0 * pi * static_cast<double>(k) / static_cast<double>(n);
        trefoil.points.emplace_back(std::sin(t) + 2.0 * std::sin(2.0 * t), std::cos(t) - 2.0 * std::cos(2.0 * t),
                                    -std::sin(3.0 * t));
    }
    trefoil.radius = 0.3, trefoil.closed = true;
    Surface knot;
    add_tube(knot, trefoil, sides);
    double seam = 0.0, most = 0.0;  // longest edge along the tube
    for (std::size_t k = 0; k < n; ++k)
        for (std::size_t a = 0; a < sides; ++a) {
            double& longest = k + 1 == n ? seam : most;
            longest = std::max(longest, (knot.points[(k + 1) % n * sides + a] - knot.points[k * sides + a]).norm());
        }
    CHECK(seam < 1.01 * most);
}

TEST_CASE("voxels hold the volume of fibres to a thousandth at half a radius, and their orientation") {
    FileCurve slanted;
    const Vec3 along = Vec3(3, 2, 1).normalized();
    for (Index k = 0; k <= 40; ++k) slanted.points.push_back(0.05 * static_cast<double>(k) * along);
    slanted.radius = 0.1, slanted.group = 7;
    const double volume = pi * 0.01 * 2.0;
    const Voxels fine = voxels_of({slanted}, grid_around({slanted}, 0.05));
    CHECK(std::abs(fine.volume / volume - 1.0) < 1e-3);
    CHECK(fine.excess == 0.0);
    CHECK((fine.mean_orientation - along * along.transpose()).norm() < 1e-6);
    CHECK((orientation_of({slanted}) - along * along.transpose()).norm() < 1e-12);
    double sum = 0.0;
    for (std::size_t k = 0; k < fine.share.size(); ++k) {
        sum += static_cast<double>(fine.share[k]);
        if (fine.share[k] == 0.0f) continue;
        CHECK(fine.yarn[k] == 7);
        const auto& d = fine.direction[k];
        const auto& o = fine.orientation[k];
        CHECK((Vec3(d[0], d[1], d[2]) - along).norm() < 1e-6);
        CHECK((Vec3(o[3], o[4], o[5]) - Vec3(along.x() * along.y(), along.y() * along.z(), along.x() * along.z())).norm() < 1e-6);
        CHECK(std::abs(static_cast<double>(fine.orientation[k][0] + fine.orientation[k][1] + fine.orientation[k][2]) - 1.0) <
              1e-6);  // single precision
    }
    CHECK(sum * std::pow(0.05, 3) == test::near(fine.volume, 1e-6));
    // Drawn twice it is too much wherever a cell is more than half full, and a cell is of the yarn that fills most of
    // it.
    const Voxels twice = voxels_of({slanted, slanted}, fine.grid);
    double excess = 0.0;
    for (const float share : fine.share) excess += std::max(0.0, 2.0 * static_cast<double>(share) - 1.0) * std::pow(0.05, 3);
    CHECK(twice.excess == test::near(excess, 1e-6));
    FileCurve thin = slanted;
    thin.radius = 0.05, thin.group = 3;
    for (const std::vector<FileCurve>& both : {std::vector{slanted, thin}, std::vector{thin, slanted}})
        CHECK(voxels_of(both, grid_around(both, 3.0), 40).yarn == std::vector<std::int32_t>{7});
    CHECK((orientation_of({FileCurve{.points = {Vec3(0, 0, 0), Vec3(3, 0, 0)}, .radius = 2.0},
                           FileCurve{.points = {Vec3(0, 0, 0), Vec3(0, 4, 0)}, .radius = 1.0}}) -
           Mat3(Vec3(0.75, 0.25, 0.0).asDiagonal()))
              .norm() < 1e-15);  // by volume
    // The middle of a cone is nearer to its thick end: (1 + 2 q + 3 q^2) / (1 + q + q^2) / 4 of the way, q = 3 times as
    // thick there.
    FileCurve cone{{Vec3(0, 0, 0), Vec3(2, 0, 0)}};
    cone.radius = 0.3, cone.radii = {0.1, 0.3};
    const Voxels tapered = voxels_of({cone}, grid_around({cone}, 0.05));
    double middle = 0.0, filled = 0.0;
    for (std::size_t k = 0; k < tapered.share.size(); ++k) {
        const double x =
            tapered.grid.origin.x() + 0.05 * (static_cast<double>(static_cast<Index>(k) % tapered.grid.counts[0]) + 0.5);
        filled += static_cast<double>(tapered.share[k]), middle += static_cast<double>(tapered.share[k]) * x;
    }
    CHECK(middle / filled == test::near(2.0 * (1.0 + 6.0 + 27.0) / (1.0 + 3.0 + 9.0) / 4.0, 1e-3));
    // A ring: tr A = 1, and as much along x as along y.
    FileCurve ring;
    for (Index k = 0; k < 400; ++k)
        ring.points.emplace_back(std::cos(2.0 * pi * static_cast<double>(k) / 400.0),
                                 std::sin(2.0 * pi * static_cast<double>(k) / 400.0), 0.0);
    ring.radius = 0.2, ring.closed = true;
    const Voxels around = voxels_of({ring}, grid_around({ring}, 0.1));
    CHECK(std::abs(around.volume / (pi * 0.04 * 2.0 * pi) - 1.0) < 1e-3);
    CHECK((orientation_of({ring}) - Mat3(Vec3(0.5, 0.5, 0.0).asDiagonal())).norm() < 1e-6);
    CHECK(vti_of(around).find("fibre_volume_fraction") != std::string::npos);
}

/// Seven fibres that touch, about a line: straight along x, or a ring about z.
std::vector<FileCurve> seven(double radius, double size, bool ring) {
    std::vector<FileCurve> tow;
    for (int f = 0; f < 7; ++f) {
        FileCurve fibre;
        const double angle = pi / 3.0 * f, off = f == 0 ? 0.0 : 2.0 * radius;
        const double y = off * std::cos(angle), z = off * std::sin(angle);
        for (Index k = 0; k < 121 - (ring ? 1 : 0); ++k) {
            const double t = static_cast<double>(k) / 120.0, a = 2.0 * pi * t;
            fibre.points.push_back(ring ? Vec3((size + y) * std::cos(a), (size + y) * std::sin(a), z) : Vec3(size * t, y, z));
        }
        if (f % 2 == 1 && !ring) std::reverse(fibre.points.begin(), fibre.points.end());
        if (ring) std::rotate(fibre.points.begin(), fibre.points.begin() + 10 * f, fibre.points.end());
        fibre.radius = radius, fibre.group = 5, fibre.closed = ring;
        tow.push_back(fibre);
    }
    return tow;
}

TEST_CASE("a yarn's surface is closed and holds the hull of its fibres, whichever way they are listed") {
    const double r = 0.1, hull = (6.0 * std::sqrt(3.0) + 12.0 + pi) * r * r;  // a hexagon of side 2 r, and a rim as wide as r
    for (const bool ring : {false, true}) {
        CAPTURE(ring);
        const std::vector<FileYarn> yarns = yarns_of(seven(r, 2.0, ring));
        REQUIRE(yarns.size() == 1);
        const FileYarn& yarn = yarns[0];
        const double length = ring ? 4.0 * pi : 2.0;
        CHECK(yarn.length == test::near(length, 1e-3));
        for (const YarnStation& station : yarn.stations) {
            CHECK(station.section.area == test::near(hull, 2e-3));  // polygons of 64 sides
            CHECK(station.section.fibre_volume_fraction == test::near(7.0 * pi * r * r / hull, 3e-3));
        }
        Surface surface;
        add_yarn(surface, yarn);
        CHECK(surface.volume() == test::near(hull * length, 3e-3));  // Pappus
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
        for (const auto& t : surface.triangles)
            for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
        for (const auto& [edge, count] : edges) CHECK((count == 1 && edges.count({edge.second, edge.first}) == 1));
        CHECK(surface.points.size() + surface.triangles.size() == edges.size() / 2 + (ring ? 0 : 2));  // Euler
        const std::string table = csv_of(yarns);
        CHECK(std::count(table.begin(), table.end(), '\n') == core::count(yarn.stations) + 1);
    }
    // Half a turn a length, left-handed, about a wave: it is told whatever the line does in its plane.
    std::vector<FileCurve> twisted = seven(0.02, 4.0, false);
    for (FileCurve& fibre : twisted) {
        if (fibre.points.front().x() > fibre.points.back().x()) std::reverse(fibre.points.begin(), fibre.points.end());
        for (Vec3& point : fibre.points) {
            const double a = -pi * point.x(), height = 0.2 * std::sin(point.x());
            point = Vec3(point.x(), std::cos(a) * point.y() - std::sin(a) * point.z(),
                         std::sin(a) * point.y() + std::cos(a) * point.z() + height);
        }
    }
    const FileYarn wave = yarns_of(twisted)[0];
    CHECK(turns_of(wave) * wave.length == test::near(-2.0, 0.01));
    CHECK(std::abs(turns_of(yarns_of(seven(r, 2.0, true))[0])) < 1e-12);
    // Two that lean to either side by a cosine of 0.8 are cut in ellipses.
    std::vector<FileCurve> leaning(2);
    for (const double side : {-1.0, 1.0}) {
        FileCurve& one = leaning[side > 0.0 ? 1 : 0];
        one.points = {Vec3(-1.0, -0.75 * side, 0.0), Vec3(1.0, 0.75 * side, 0.0)}, one.radius = r, one.group = 0;
    }
    const FileYarn both = yarns_of(leaning).at(0);
    for (const YarnStation& station : both.stations)
        CHECK(station.section.fibre_area == test::near(2.0 * pi * r * r / 0.8, 1e-9));
    std::vector<FileCurve> mixed = seven(r, 2.0, false);
    mixed[3].closed = true;
    CHECK(refusal([&] { yarns_of(mixed); }) == "curve 3 = closed, but it must be as the other curves of yarn 5");
}

/// Rows of numbers of an Abaqus file by their keyword line, read without anything that wrote them.
std::map<std::string, std::vector<std::vector<double>>> rows_of(const std::string& text) {
    std::map<std::string, std::vector<std::vector<double>>> sections;
    std::istringstream lines(text);
    std::string line, keyword;
    while (std::getline(lines, line)) {
        if (line[0] == '*') {
            keyword = line;
            continue;
        }
        if (keyword == "*HEADING" || line.find_first_of("ABCDEFIRS") != std::string::npos) continue;
        std::vector<double> row;
        std::istringstream words(line);
        for (std::string word; std::getline(words, word, ',');)
            row.push_back(word.find_first_not_of(' ') == std::string::npos ? 0.0 : std::stod(word));
        sections[keyword].push_back(row);
    }
    return sections;
}

TEST_CASE("an Abaqus mesh of voxels fills its box with cubes, each in one set, with the fibre's direction") {
    FileCurve one;
    const Vec3 along = Vec3(2, 1, 0.5).normalized();
    for (Index k = 0; k <= 20; ++k) one.points.push_back(0.1 * static_cast<double>(k) * along);
    one.radius = 0.2, one.group = 3;
    const Voxels voxels = voxels_of({one}, grid_in(Vec3(-0.4, -0.4, -0.4), Vec3(2.0, 1.2, 1.0), 0.1));
    const auto parts = rows_of(voxel_inp_of(voxels));
    const auto& nodes = parts.at("*NODE");
    const auto& cells = parts.at("*ELEMENT, TYPE=C3D8R, ELSET=ALL_CELLS");
    REQUIRE(nodes.size() == 25u * 17u * 15u);
    REQUIRE(cells.size() == 24u * 16u * 14u);
    const auto place = [&](double n) {
        const auto& row = nodes.at(static_cast<std::size_t>(n) - 1);
        return Vec3(row[1], row[2], row[3]);
    };
    for (const auto& cell : cells) {  // anticlockwise below, then above: Abaqus's order
        const Vec3 a = place(cell[2]) - place(cell[1]), b = place(cell[4]) - place(cell[1]), c = place(cell[5]) - place(cell[1]);
        CHECK(a.cross(b).dot(c) == test::near(1e-3, 1e-9));
        CHECK((place(cell[7]) - place(cell[1]) - a - b - c).norm() < 1e-12);
    }
    std::size_t yarn = 0, matrix = 0;
    for (const auto& row : parts.at("*ELSET, ELSET=YARN_3")) yarn += row.size();
    for (const auto& row : parts.at("*ELSET, ELSET=MATRIX")) matrix += row.size();
    const auto filled = static_cast<std::size_t>(std::count(voxels.yarn.begin(), voxels.yarn.end(), 3));
    CHECK(yarn >= filled);  // a comma at the end of a line that goes on
    CHECK(filled > 200);
    CHECK(matrix > cells.size() - filled - 1);
    const auto& axes = parts.at("*DISTRIBUTION, LOCATION=ELEMENT, TABLE=FIBRE_AXES_TABLE, NAME=FIBRE_AXES");
    REQUIRE(axes.size() == filled + 1);
    CHECK(axes[0] == std::vector<double>{0, 1, 0, 0, 0, 1, 0});
    for (std::size_t k = 1; k < axes.size(); ++k) {
        const Vec3 first(axes[k][1], axes[k][2], axes[k][3]), second(axes[k][4], axes[k][5], axes[k][6]);
        CHECK((first - along).norm() < 1e-6);  // single precision
        CHECK(std::abs(first.dot(second)) < 1e-12);
        CHECK(second.norm() == test::near(1.0, 1e-12));
    }
    // The table's shares are the fibre's volume; so are those of maps along any axis and of profiles.
    std::istringstream table(cells_csv_of(voxels));
    std::string line;
    double sum = 0.0, profile = 0.0;
    for (std::getline(table, line); std::getline(table, line);) {
        std::istringstream words(line);
        std::string word;
        for (int k = 0; k < 6; ++k) std::getline(words, word, ',');
        sum += std::stod(word) * 1e-3;
    }
    CHECK(sum == test::near(pi * 0.04 * 2.0, 1e-3));
    for (int axis = 0; axis < 3; ++axis) {
        const VolumeMap map = volume_map(voxels, axis);
        CHECK(map.counts == (axis == 0   ? std::array<Index, 2>{16, 14}
                             : axis == 1 ? std::array<Index, 2>{24, 14}
                                         : std::array<Index, 2>{24, 16}));
        double columns = 0.0;
        for (const double mean : map.mean) columns += mean * map.height * 0.01;
        CHECK(columns == test::near(sum, 1e-6));
    }
    std::istringstream slices(profile_csv_of(voxels));
    for (std::getline(slices, line); std::getline(slices, line);)
        if (line[0] == 'y') profile += std::stod(line.substr(line.rfind(',') + 1)) * 2.4 * 1.4 * 0.1;
    CHECK(profile == test::near(sum, 1e-6));
    CHECK(map_svg_of(volume_map(voxels)).find("fibre volume fraction along z: mean") != std::string::npos);
    CHECK(refusal([] { grid_in(Vec3::Zero(), Vec3(1, 1, 1), 0.3); }).find("edge along x over the spacing = 3.33") !=
          std::string::npos);
}

TEST_CASE("lines of OBJ count from the end, radii of a table from its first point, and long numbers of VTK are long") {
    const auto obj = curves_of_obj("v 0 0 0\nv 1 0 0\nv 3 0 0\nl -3 -2 -1\n", "b.obj");
    CHECK(obj.at(0).points == std::vector<Vec3>{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(3, 0, 0)});
    const auto csv = curves_of_csv("x,y,z,radius\n0,0,0,0.1\n1,0,0,0.1\n2,0,0,0.3\n", "b.csv");
    CHECK(csv.at(0).radii == std::vector<double>{0.1, 0.1, 0.3});
    std::string bytes = "# vtk DataFile Version 5.1\nt\nBINARY\nDATASET POLYDATA\nPOINTS 2 float\n";
    for (const int c : {0x3f, 0x80, 0, 0, 0, 0, 0, 0, 0x40, 0, 0, 0, 0x40, 0x40, 0, 0, 0, 0, 0, 0, 0xbf, 0x80, 0, 0})
        bytes += static_cast<char>(c);
    const auto put = [&](std::initializer_list<char> values) {
        for (const char value : values) bytes += std::string(7, '\0') + value;
        bytes += '\n';
    };
    bytes += "\nLINES 2 2\nOFFSETS vtktypeint64\n", put({0, 2});
    bytes += "CONNECTIVITY vtktypeint64\n", put({0, 1});
    CHECK(curves_of_vtk(bytes, "b.vtk").at(0).points == std::vector<Vec3>{Vec3(1, 0, 2), Vec3(3, 0, -1)});
}

}  // namespace exchange_curves_test
