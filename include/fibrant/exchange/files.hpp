// SPDX-License-Identifier: MIT
#pragma once
/// @file Curves of a file by the ending of its name. With FIBRANT_WITH_PUGIXML defined, and pugixml linked, files of XML are read
/// as well.

#include <fibrant/exchange/binary_curves.hpp>
#include <fibrant/exchange/text_curves.hpp>
#include <fibrant/exchange/tubes.hpp>
#include <fibrant/exchange/voxel_tables.hpp>
#include <fibrant/exchange/yarn_surfaces.hpp>
#include <fibrant/observe/poly_data.hpp>
#if defined(FIBRANT_WITH_PUGIXML)
#include <fibrant/exchange/xml_curves.hpp>
#endif

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <vector>

namespace fibrant::exchange {

/// Ending of a file's name in small letters, without its point.
inline std::string ending(const std::filesystem::path& path) {
    std::string text = path.extension().string();
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text.empty() ? text : text.substr(1);
}

/// What a file to be written is: its ending, with the one before it where that says of what: yarns.stl, voxels.inp, map.svg.
inline std::string kind_of(const std::filesystem::path& path) {
    const std::string before = ending(path.stem());
    const bool derived = before == "yarns" || before == "voxels" || before == "map" || before == "profile";
    return derived ? before + "." + ending(path) : ending(path);
}
/// Kinds of files of curves that are written.
inline const std::vector<std::string>& curve_kinds() {
    static const std::vector<std::string> kinds {
        "csv", "vtk", "vtp", "obj", "bcc", "inp", "stl", "glb",
#if defined(FIBRANT_WITH_PUGIXML)
            "tg3"
#endif
    };
    return kinds;
}
inline const std::vector<std::string>& voxel_kinds() {
    static const std::vector<std::string> kinds{"vti", "raw", "voxels.inp", "voxels.csv", "map.csv", "map.svg", "profile.csv"};
    return kinds;
}
inline const std::vector<std::string>& yarn_kinds() {
    static const std::vector<std::string> kinds{"yarns.stl", "yarns.vtp", "yarns.csv"};
    return kinds;
}
inline bool is_one_of(const std::string& kind, const std::vector<std::string>& kinds) {
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

/// A file of voxels. @param kind  one of `voxel_kinds()` @param axis  that a map looks along: 0, 1 or 2
inline std::string voxel_file_of(const Voxels& voxels, const std::string& kind, int axis = 2, const std::string& unit = "mm") {
    if (kind == "vti") return vti_of(voxels);
    if (kind == "raw") return raw_of(voxels);
    if (kind == "voxels.inp") return voxel_inp_of(voxels);
    if (kind == "voxels.csv") return cells_csv_of(voxels);
    if (kind == "map.csv") return map_csv_of(volume_map(voxels, axis));
    if (kind == "map.svg") return map_svg_of(volume_map(voxels, axis), unit);
    if (kind == "profile.csv") return profile_csv_of(voxels);
    core::refuse("ending of the file", "." + kind, ".vti, .raw, .voxels.inp, .voxels.csv, .map.csv, .map.svg or .profile.csv");
}
/// A file of yarns as bodies. @param kind  one of `yarn_kinds()`
inline std::string yarn_file_of(const std::vector<FileYarn>& yarns, const std::string& kind) {
    if (kind == "yarns.stl") return stl_of(yarns);
    if (kind == "yarns.vtp") return vtp_of(yarns);
    if (kind == "yarns.csv") return csv_of(yarns);
    core::refuse("ending of the file", "." + kind, ".yarns.stl, .yarns.vtp or .yarns.csv");
}

/// Reads .csv, .txt, .vtk, .obj, .bcc, .inp, and .vtp and .tg3 where there is pugixml.
/// @throws std::invalid_argument for what cannot be read, by file, place and value
inline std::vector<FileCurve> read_curves(const std::filesystem::path& path, const CleanParameters& clean = {}) {
    const std::string name = path.string(), kind = ending(path);
    const std::string bytes = detail::bytes_of_file(path);
    std::vector<FileCurve> curves;
    if (kind == "csv" || kind == "txt")
        curves = curves_of_csv(bytes, name);
    else if (kind == "vtk")
        curves = curves_of_vtk(bytes, name);
    else if (kind == "obj")
        curves = curves_of_obj(bytes, name);
    else if (kind == "bcc")
        curves = curves_of_bcc(bytes, name);
    else if (kind == "inp")
        curves = curves_of_inp(bytes, name);
#if defined(FIBRANT_WITH_PUGIXML)
    else if (kind == "vtp")
        curves = curves_of_vtp(bytes, name);
    else if (kind == "tg3")
        curves = curves_of_tg3(bytes, name);
#else
    else if (kind == "vtp" || kind == "tg3")
        refuse_file(name, "", "is XML, which this program was built without: it needs pugixml");
#endif
    else
        refuse_file(name, "", "ends in ." + kind + ", but it must end in .csv, .txt, .vtk, .vtp, .obj, .bcc, .inp or .tg3");
    CleanParameters own = clean;
    if (kind == "tg3") own.largest_turn_deg = 180.0, own.least_points = 2;  // nodes of a spline, not points of its curve
    return cleaned(std::move(curves), name, own);
}

/// Text or bytes of a file of curves. @param kind  one of `curve_kinds()`
/// @param metre  one metre in the unit of the curves, for glb
inline std::string file_of(const std::vector<FileCurve>& curves, const std::string& kind, double metre = 1000.0) {
    if (kind == "csv") return csv_of(curves);
    if (kind == "vtk") return vtk_of(curves);
    if (kind == "obj") return obj_of(curves);
    if (kind == "bcc") return bcc_of(curves);
    if (kind == "inp") return inp_of(curves);
    if (kind == "stl") return stl_of(curves);
    if (kind == "glb") return glb_of(curves, metre);
#if defined(FIBRANT_WITH_PUGIXML)
    if (kind == "tg3") return tg3_of(curves);
#endif
    if (kind == "vtp") {
        observe::PolyData data;
        std::vector<double> radii, groups;
        for (const FileCurve& curve : curves) {
            Index first = -1;
            for (std::size_t k = 0; k < curve.points.size(); ++k) {
                const Index at = data.add_point(curve.points[k]);
                if (k == 0) first = at;
                radii.push_back(curve.radii.empty() ? curve.radius : curve.radii[k]);
            }
            data.add_line(first, core::count(curve.points), curve.closed);
            groups.push_back(static_cast<double>(curve.group));
        }
        data.point_scalars("radius", radii), data.cell_scalars("group", groups);
        return data.text();
    }
    core::refuse(
        "ending of the file", "." + kind,
        ".csv, .vtk, .vtp, .obj, .bcc, .inp, .stl, .glb, .vti, .raw, .voxels.inp, .voxels.csv, .map.csv, .map.svg, .profile.csv, "
        ".yarns.stl, .yarns.vtp, .yarns.csv, or .tg3 where there is pugixml");
}

}  // namespace fibrant::exchange
