// SPDX-License-Identifier: MIT
// Converts centrelines of fibres between files of other programs, and to surfaces and voxels.
//   convert IN [--output FILE]... [--voxels SPACING] [--box X0 Y0 Z0 X1 Y1 Z1] [--map x|y|z] [--stations SPACING] [--radius R]
//           [--scale S] [--metre M] [--largest-turn DEGREES] [--report]
#include "../support/command_line.hpp"

#include <fibrant/exchange/files.hpp>
#include <fibrant/observe/json.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <new>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

using namespace fibrant;

namespace {

std::string report(const std::vector<exchange::FileCurve>& curves) {
    double length = 0.0, volume = 0.0;
    Index points = 0, closed = 0;
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const exchange::FileCurve& curve : curves) {
        const std::size_t n = curve.points.size();
        double own = 0.0;
        for (std::size_t k = 0; k + (curve.closed ? 0 : 1) < n; ++k) own += (curve.points[(k + 1) % n] - curve.points[k]).norm();
        length += own, points += core::count(curve.points), closed += curve.closed ? 1 : 0;
        volume += std::numbers::pi * curve.radius * curve.radius * own;
        for (const Vec3& point : curve.points) low = low.cwiseMin(point), high = high.cwiseMax(point);
    }
    const Mat3 a = exchange::orientation_of(curves);
    observe::JsonObject json;
    json.add("curves", core::count(curves))
        .add("closed", closed)
        .add("points", points)
        .add("length", length)
        .add("fibre_volume", volume);
    json.add("low", std::vector<double>(low.begin(), low.end())).add("high", std::vector<double>(high.begin(), high.end()));
    json.add("orientation_xx_yy_zz_xy_yz_xz", std::vector<double>{a(0, 0), a(1, 1), a(2, 2), a(0, 1), a(1, 2), a(0, 2)});
    return json.text() + "\n";
}

/// A number of an option that is a length or a factor: powers of it must still be numbers.
void require_quantity(const char* option, double value) {
    core::require(value >= 1e-30 && value <= 1e30, option, value, "finite and > 0, in any unit from 1e-30 to 1e+30");
}

/// Refuses names whose endings no writer knows, before any of them is written.
void require_endings(const std::vector<std::string>& outputs) {
    std::vector<std::string> known = exchange::curve_kinds();
    for (const auto& more : {exchange::voxel_kinds(), exchange::yarn_kinds()})
        known.insert(known.end(), more.begin(), more.end());
    std::string all;
    for (const std::string& kind : known) all += (all.empty() ? "." : ", .") + kind;
    for (const std::string& name : outputs)
        if (!exchange::is_one_of(exchange::kind_of(name), known))
            core::refuse("--output", name, "a name that ends in one of " + all);
}

/// What a check of a grid says, without the names of what checked it.
std::string told(const std::invalid_argument& error) {
    std::string text = error.what();
    for (const std::string name : {"VoxelGrid.counts: ", "grid_around: ", "grid_in: "})
        if (text.compare(0, name.size(), name) == 0) text = text.substr(name.size());
    return text;
}

}  // namespace

int main(int argc, char** argv) {
    std::string input;
    std::vector<std::string> outputs;
    double spacing = 0.0, radius = core::unset, metre = 1000.0;
    double stations = 0.0;
    std::vector<double> box;
    std::string along = "z";
    bool wanted = false;
    exchange::CleanParameters clean;
    CLI::App app{
        "Converts centrelines of fibres: .csv .txt .vtk .vtp .obj .bcc .inp .tg3 in, and .csv .vtk .vtp .obj .bcc .inp .tg3 .stl "
        ".glb .vti .raw out; .voxels.inp .voxels.csv .map.csv .map.svg .profile.csv of voxels, .yarns.stl .yarns.vtp .yarns.csv "
        "of yarns as "
        "bodies."};
    app.set_version_flag("--version", FIBRANT_VERSION);
    app.add_option("input", input, "file of centrelines")->required();
    app.add_option("--output", outputs, "file to write; may be given several times")->allow_extra_args(false);
    app.add_option("--voxels", spacing, "spacing of voxels, for .vti, .raw and what is made of voxels [length]");
    app.add_option("--box", box,
                   "low and high corner that voxels fill, a whole number of spacings; left out: all curves [length]")
        ->expected(6);
    app.add_option("--map", along, "axis that maps look along")->check(CLI::IsMember({"x", "y", "z"}));
    app.add_option("--stations", stations, "distance of sections of yarns; left out: twice the radius of a fibre [length]")
        ->check(CLI::PositiveNumber);
    app.add_option("--radius", radius, "of all fibres, in the place of what the file says [length]");
    app.add_option("--scale", clean.scale, "on all lengths of the file");
    app.add_option("--metre", metre, "one metre in the unit of lengths, for .glb");
    app.add_option("--largest-turn", clean.largest_turn_deg, "between neighbouring chords, more is refused [degree]");
    app.add_flag("--report", wanted, "print counts, lengths and the orientation tensor")->disable_flag_override();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return example::ends_by(app, error, "convert");
    }
    try {
        require_quantity("--scale", clean.scale);
        require_quantity("--metre", metre);
        if (app.count("--voxels") > 0) require_quantity("--voxels", spacing);
        if (app.count("--stations") > 0) require_quantity("--stations", stations);
        core::require(clean.largest_turn_deg > 0.0 && clean.largest_turn_deg <= 180.0, "--largest-turn", clean.largest_turn_deg,
                      "> 0 and <= 180");
        if (app.count("--radius") > 0) require_quantity("--radius", radius);
        if (outputs.empty() && !wanted) core::refuse("--output", "not given", "given, or --report");
        require_endings(outputs);
        std::vector<exchange::FileCurve> curves = exchange::read_curves(input, clean);
        if (app.count("--radius") > 0) {
            for (exchange::FileCurve& curve : curves) curve.radius = radius, curve.radii.clear();
        }
        double length = 0.0;
        for (const exchange::FileCurve& curve : curves)
            for (std::size_t k = 1; k < curve.points.size(); ++k) length += (curve.points[k] - curve.points[k - 1]).norm();
        core::require(stations == 0.0 || length / stations <= 1e6, "--stations", stations,
                      "larger, for at most a million sections");
        std::optional<exchange::Voxels> voxels;
        std::vector<exchange::FileYarn> yarns;
        for (const std::string& name : outputs) {
            const std::string kind = exchange::kind_of(name);
            std::error_code same;
            if (std::filesystem::equivalent(name, input, same)) core::refuse("--output", name, "another file than the input");
            const bool cells = exchange::is_one_of(kind, exchange::voxel_kinds()),
                       bodies = exchange::is_one_of(kind, exchange::yarn_kinds());
            const bool thick = kind == "stl" || kind == "glb" || cells || bodies;
            for (std::size_t c = 0; thick && c < curves.size(); ++c)
                if (std::isnan(curves[c].radius) && curves[c].radii.empty())
                    core::refuse("radius of curve " + std::to_string(c), "not given", "in the file, or --radius");
            if (cells && !voxels) {
                if (app.count("--voxels") == 0) core::refuse("--voxels", "not given", "given, for ." + kind);
                const auto grid = [&] {
                    try {
                        return box.empty()
                                   ? exchange::grid_around(curves, spacing)
                                   : exchange::grid_in(Vec3(box[0], box[1], box[2]), Vec3(box[3], box[4], box[5]), spacing);
                    } catch (const std::invalid_argument& error) {
                        const std::string what = told(error);
                        if (what.compare(0, 5, "cells") != 0) throw std::invalid_argument("--box: " + what);
                        core::refuse("--voxels", core::text(spacing), "larger: " + what);
                    }
                };
                voxels = exchange::voxels_of(curves, grid());
                if (wanted)
                    std::printf(
                        "voxels: %td x %td x %td, fibre volume %.9g, of that %.3g in overlaps, fibre volume fraction %.6f\n",
                        voxels->grid.counts[0], voxels->grid.counts[1], voxels->grid.counts[2], voxels->volume, voxels->excess,
                        voxels->volume / (spacing * spacing * spacing * static_cast<double>(voxels->grid.cells())));
            }
            if (bodies && yarns.empty()) yarns = exchange::yarns_of(curves, stations);
            observe::write_file(name, cells    ? exchange::voxel_file_of(*voxels, kind, along[0] - 'x')
                                      : bodies ? exchange::yarn_file_of(yarns, kind)
                                               : exchange::file_of(curves, kind, metre));
            if (kind == "raw") observe::write_file(name + ".json", exchange::raw_head_of(*voxels));
        }
        if (wanted) std::fputs(report(curves).c_str(), stdout);
        return 0;
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "convert: %s: there is not enough memory: take larger --voxels or --stations\n", input.c_str());
        return 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "convert: %s\n", error.what());
        return 2;
    }
}
