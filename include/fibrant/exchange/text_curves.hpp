// SPDX-License-Identifier: MIT
#pragma once
/// @file Curves in files of text: tables of points (CSV), lines of OBJ, beams of Abaqus input files.

#include <fibrant/exchange/curves.hpp>
#include <fibrant/observe/text_file.hpp>

#include <cctype>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fibrant::exchange {

/// A table of points: the header names its columns, fibre, x, y, z, and radius, yarn, closed where there are. Rows are in order
/// along a fibre; another number in the column fibre, or an empty line, begins the next. Separators are commas, semicolons,
/// tabulators or blanks; # begins a comment.
inline std::vector<FileCurve> curves_of_csv(std::string_view text, const std::string& file) {
    std::vector<FileCurve> curves;
    std::string separators;
    std::vector<std::string> names;
    std::string last;
    bool fresh = true;
    detail::each_line(text, [&](Index number, std::string_view line) {
        const std::string place = std::to_string(number);
        if (const std::size_t comment = line.find('#'); comment != std::string_view::npos) line = line.substr(0, comment);
        if (detail::words(line, "").empty()) {
            fresh = true;
            return;
        }
        if (names.empty()) {
            for (const char c : {',', ';', '\t'})
                if (separators.empty() && line.find(c) != std::string_view::npos) separators = std::string(1, c);
            for (const std::string_view word : detail::words(line, separators)) {
                std::string name(word);
                std::transform(name.begin(), name.end(), name.begin(),
                               [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
                names.push_back(name);
            }
            for (const char* name : {"x", "y", "z"})
                if (std::find(names.begin(), names.end(), name) == names.end())
                    refuse_file(file, place, "has no column " + std::string(name) + ": the first line must name the columns");
            return;
        }
        const std::vector<std::string_view> words = detail::words(line, separators);
        if (words.size() != names.size())
            refuse_file(file, place,
                        std::to_string(words.size()) + " values, but it must be " + std::to_string(names.size()) +
                            ", as the first line has columns");
        Vec3 point = Vec3::Zero();
        double radius = core::unset;
        std::string fibre = "0";
        Index group = -1;
        bool closed = false;
        for (std::size_t k = 0; k < names.size(); ++k) {
            const auto value = [&] { return detail::number<double>(words[k], file, place, names[k]); };
            if (names[k] == "x")
                point.x() = value();
            else if (names[k] == "y")
                point.y() = value();
            else if (names[k] == "z")
                point.z() = value();
            else if (names[k] == "radius")
                radius = value();
            else if (names[k] == "fibre" || names[k] == "fiber")
                fibre = std::string(words[k]);
            else if (names[k] == "yarn" || names[k] == "group")
                group = detail::number<Index>(words[k], file, place, names[k]);
            else if (names[k] == "closed")
                closed = detail::number<Index>(words[k], file, place, names[k]) != 0;
        }
        if (fresh || curves.empty() || fibre != last) {
            curves.emplace_back();
            curves.back().radius = radius, curves.back().group = group, curves.back().closed = closed, curves.back().name = fibre;
        }
        fresh = false, last = fibre;
        FileCurve& curve = curves.back();
        curve.points.push_back(point);
        if (std::isnan(radius)) return;
        if (!(radius > 0.0)) refuse_file(file, place, "radius = " + core::text(radius) + ", but it must be > 0");
        if (curve.radii.empty() && radius != curve.radius) curve.radii.assign(curve.points.size() - 1, curve.radius);
        if (!curve.radii.empty() || radius != curve.radius) curve.radii.push_back(radius);
    });
    return curves;
}

/// The same table, with the digits that identify each number.
inline std::string csv_of(const std::vector<FileCurve>& curves) {
    std::string text = "fibre,x,y,z,radius,yarn,closed\n";
    for (std::size_t c = 0; c < curves.size(); ++c)
        for (std::size_t k = 0; k < curves[c].points.size(); ++k) {
            const FileCurve& curve = curves[c];
            text += std::to_string(c);
            for (const double x : curve.points[k]) text += "," + observe::shortest(x);
            const double radius = curve.radii.empty() ? curve.radius : curve.radii[k];
            text += "," + observe::shortest(std::isnan(radius) ? 1.0 : radius) + "," + std::to_string(curve.group) + "," +
                    (curve.closed ? "1" : "0") + "\n";
        }
    return text;
}

/// Lines `v x y z` and `l i j k ..` of an OBJ file, numbers from 1, or from the end where they are negative. All else is left.
inline std::vector<FileCurve> curves_of_obj(std::string_view text, const std::string& file) {
    std::vector<Vec3> points;
    std::vector<FileCurve> curves;
    std::string name;
    detail::each_line(text, [&](Index number, std::string_view line) {
        const std::string place = std::to_string(number);
        const std::vector<std::string_view> words = detail::words(line.substr(0, line.find('#')), "");
        if (words.empty()) return;
        if (words[0] == "o" || words[0] == "g") {
            name = words.size() > 1 ? std::string(words[1]) : std::string();
        } else if (words[0] == "v") {
            if (words.size() < 4)
                refuse_file(file, place, "a point of " + std::to_string(words.size() - 1) + " numbers, but it must have three");
            points.emplace_back(detail::number<double>(words[1], file, place, "x"),
                                detail::number<double>(words[2], file, place, "y"),
                                detail::number<double>(words[3], file, place, "z"));
        } else if (words[0] == "l") {
            FileCurve curve;
            curve.name = name;
            for (std::size_t k = 1; k < words.size(); ++k) {
                Index at = detail::number<Index>(words[k].substr(0, words[k].find('/')), file, place, "point");
                at = at < 0 ? core::count(points) + at : at - 1;
                if (at < 0 || at >= core::count(points))
                    refuse_file(file, place,
                                "point = " + std::string(words[k]) + ", but it must be one of the " +
                                    std::to_string(points.size()) + " before it");
                curve.points.push_back(points[core::at(at)]);
            }
            curves.push_back(std::move(curve));
        }
    });
    return curves;
}
inline std::string obj_of(const std::vector<FileCurve>& curves) {
    std::string text = "# curves\n";
    Index first = 1;
    for (std::size_t c = 0; c < curves.size(); ++c) {
        text += "o " + (curves[c].name.empty() ? "curve_" + std::to_string(c) : curves[c].name) + "\n";
        for (const Vec3& point : curves[c].points)
            text += "v " + observe::shortest(point.x()) + " " + observe::shortest(point.y()) + " " +
                    observe::shortest(point.z()) + "\n";
        text += "l";
        for (Index k = 0; k < core::count(curves[c].points); ++k) text += " " + std::to_string(first + k);
        text += (curves[c].closed ? " " + std::to_string(first) : std::string()) + "\n";
        first += core::count(curves[c].points);
    }
    return text;
}

/// Beams of an Abaqus input file: `*NODE` and `*ELEMENT, TYPE=B31` (two nodes) or `B32` (end, middle, end) or B33; chains of
/// elements that share nodes, closed where they have no end. The radius is that of a circular `*BEAM SECTION` of the set that a
/// chain's first element is in.
inline std::vector<FileCurve> curves_of_inp(std::string_view text, const std::string& file) {
    struct Beam {
        std::vector<Index> nodes;
        std::string set;
        Index line;
    };
    std::map<Index, Vec3> nodes;
    std::vector<Beam> beams;
    std::map<std::string, double> radius_of;
    std::string keyword, type, set, section_set;
    Index per_element = 0;
    std::vector<std::string> pending;
    const auto upper = [](std::string_view word) {
        std::string answer(word);
        std::transform(answer.begin(), answer.end(), answer.begin(),
                       [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
        return answer;
    };
    detail::each_line(text, [&](Index number, std::string_view line) {
        const std::string place = std::to_string(number);
        if (line.substr(0, 2) == "**" || detail::words(line, "").empty()) return;
        if (line.front() == '*') {
            if (!pending.empty())
                refuse_file(file, place, "an element ends early, but it must have " + std::to_string(per_element) + " nodes");
            const std::vector<std::string_view> words = detail::words(line, ",");
            keyword = upper(words[0]);
            type.clear(), set.clear(), section_set.clear();
            std::string section;
            for (std::size_t k = 1; k < words.size(); ++k) {
                const std::size_t equal = words[k].find('=');
                if (equal == std::string_view::npos) continue;
                const std::string key = upper(detail::words(words[k].substr(0, equal), ",")[0]),
                                  value = upper(detail::words(words[k].substr(equal + 1), ",")[0]);
                if (key == "TYPE") type = value;
                if (key == "ELSET") set = value;
                if (key == "SECTION") section = value;
            }
            if (keyword == "*INCLUDE") refuse_file(file, place, "*INCLUDE, but it must be one file");
            if (keyword == "*BEAM SECTION") section_set = section == "CIRC" ? set : "";
            per_element = type.rfind("B31", 0) == 0 || type.rfind("B33", 0) == 0 ? 2 : type.rfind("B32", 0) == 0 ? 3 : 0;
            if (keyword == "*BEAM SECTION" && section_set.empty()) keyword.clear();
            return;
        }
        const std::vector<std::string_view> words = detail::words(line, ",");
        if (keyword == "*NODE") {
            if (words.size() < 4)
                refuse_file(
                    file, place,
                    "a node of " + std::to_string(words.size()) + " values, but it must have a number and three coordinates");
            nodes[detail::number<Index>(words[0], file, place, "node")] =
                Vec3(detail::number<double>(words[1], file, place, "x"), detail::number<double>(words[2], file, place, "y"),
                     detail::number<double>(words[3], file, place, "z"));
        } else if (keyword == "*ELEMENT" && per_element > 0) {
            for (const std::string_view word : words)
                if (!word.empty()) pending.emplace_back(word);
            if (core::count(pending) < per_element + 1) return;
            if (core::count(pending) > per_element + 1)
                refuse_file(
                    file, place,
                    std::to_string(pending.size() - 1) + " nodes of an element, but it must be " + std::to_string(per_element));
            Beam beam{{}, set, number};
            for (std::size_t k = 1; k < pending.size(); ++k) {
                beam.nodes.push_back(detail::number<Index>(pending[k], file, place, "node"));
            }
            beams.push_back(std::move(beam));
            pending.clear();
        } else if (keyword == "*BEAM SECTION") {
            const double radius = detail::number<double>(words[0], file, place, "radius");
            if (!(radius > 0.0)) refuse_file(file, place, "radius = " + core::text(radius) + ", but it must be > 0");
            radius_of[section_set] = radius;
            keyword.clear();
        }
    });
    std::map<Index, std::vector<std::size_t>> ends;
    for (std::size_t b = 0; b < beams.size(); ++b) {
        for (const Index node : beams[b].nodes)
            if (nodes.find(node) == nodes.end())
                refuse_file(file, std::to_string(beams[b].line),
                            "node = " + std::to_string(node) + ", but it must be one of *NODE");
        for (const Index node : {beams[b].nodes.front(), beams[b].nodes.back()}) ends[node].push_back(b);
    }
    for (const auto& [node, of] : ends)
        if (of.size() > 2)
            refuse_file(
                file, std::to_string(beams[of[2]].line),
                "node = " + std::to_string(node) + " of " + std::to_string(of.size()) + " beams, but it must be of two at most");
    std::vector<bool> done(beams.size(), false);
    std::vector<FileCurve> curves;
    const auto follow = [&](std::size_t first, Index start) {
        FileCurve curve;
        curve.name = beams[first].set;
        if (const auto found = radius_of.find(beams[first].set); found != radius_of.end()) curve.radius = found->second;
        curve.points.push_back(nodes[start]);
        Index at = start;
        for (std::size_t b = first;;) {
            done[b] = true;
            std::vector<Index> own = beams[b].nodes;
            if (own.front() != at) std::reverse(own.begin(), own.end());
            for (std::size_t k = 1; k < own.size(); ++k) curve.points.push_back(nodes[own[k]]);
            at = own.back();
            const auto& next = ends[at];
            const auto other = std::find_if(next.begin(), next.end(), [&](std::size_t n) { return !done[n]; });
            if (other == next.end()) break;
            b = *other;
        }
        if (at == start) curve.closed = true, curve.points.pop_back();
        curves.push_back(std::move(curve));
    };
    for (std::size_t b = 0; b < beams.size(); ++b)  // from ends first, then what is closed
        for (const Index end : {beams[b].nodes.front(), beams[b].nodes.back()})
            if (!done[b] && ends[end].size() == 1) follow(b, end);
    for (std::size_t b = 0; b < beams.size(); ++b)
        if (!done[b]) follow(b, beams[b].nodes.front());
    return curves;
}

/// Beams of two nodes (B31), a set and a circular section a curve.
inline std::string inp_of(const std::vector<FileCurve>& curves) {
    std::string text = "*HEADING\n beams of circular section, one set a fibre\n*NODE\n", elements;
    Index node = 1, element = 1;
    for (std::size_t c = 0; c < curves.size(); ++c) {
        const Index first = node, count = core::count(curves[c].points);
        for (const Vec3& point : curves[c].points)
            text += std::to_string(node++) + ", " + observe::shortest(point.x()) + ", " + observe::shortest(point.y()) + ", " +
                    observe::shortest(point.z()) + "\n";
        elements += "*ELEMENT, TYPE=B31, ELSET=FIBRE" + std::to_string(c) + "\n";
        for (Index k = 0; k + (curves[c].closed ? 0 : 1) < count; ++k)
            elements += std::to_string(element++) + ", " + std::to_string(first + k) + ", " +
                        std::to_string(first + (k + 1) % count) + "\n";
        if (std::isnan(curves[c].radius)) continue;
        const Vec3 along = (curves[c].points[1] - curves[c].points[0]).normalized();
        Index axis = 0;
        along.cwiseAbs().minCoeff(&axis);
        const Vec3 n1 = (Vec3::Unit(axis) - along[axis] * along).normalized();
        elements += "*BEAM SECTION, SECTION=CIRC, ELSET=FIBRE" + std::to_string(c) + ", MATERIAL=FIBRE\n" +
                    observe::shortest(curves[c].radius) + "\n" + observe::shortest(n1.x()) + ", " + observe::shortest(n1.y()) +
                    ", " + observe::shortest(n1.z()) + "\n";
    }
    return text + elements;
}

}  // namespace fibrant::exchange
