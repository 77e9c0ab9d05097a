// SPDX-License-Identifier: MIT
#pragma once
/// @file What a report draws beside its view: curves over the increments and of the load, slices, the table of stages.

#include "table.hpp"

#include <fibrant/observe/json.hpp>
#include <fibrant/observe/svg_curves.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace example::detail {

namespace observe = fibrant::observe;

/// A number as a reader wants it.
inline std::string short_number(double value, const char* format = "%.4g") {
    char text[40];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

/// A name of a column as words, without its unit.
inline std::string words(std::string name) {
    if (name.ends_with("_deg")) name.resize(name.size() - 4);
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

/// A picture with its caption; what the lines of a plot are stands below it in the text, where a narrow window has room for it.
inline std::string figure(const observe::CurvePlot& curves, const std::string& caption = {}) {
    if (curves.lines.empty()) return {};
    std::string names;
    const observe::Palette palette;
    for (std::size_t l = 0; l < curves.lines.size() && curves.lines.size() > 1; ++l)
        names += "<span><i style=\"background:" + palette.of(0, static_cast<fibrant::Index>(l)).text() + "\"></i>" +
                 observe::xml_escaped(curves.lines[l].name) + "</span> ";
    return "<figure>" + observe::curves_svg(curves) + "<figcaption>" + names + caption + "</figcaption></figure>\n";
}

/// Size of a plot [pixel]: three of them stand beside each other in a wide window, and one fills that of a phone.
inline observe::CurvePlot empty_plot(const std::string& title, const std::string& x_label, const std::string& y_label,
                                     bool decades = false) {
    return {title, x_label, y_label, {}, false, 400.0, 280.0, decades, false};
}

/// One column over another; none where a column is missing or nothing can be shown of it.
inline void add_line(observe::CurvePlot& curves, const Table& table, std::size_t x, const std::string& name) {
    observe::PlotLine line = table.line(name, x, table.column(name));
    std::erase_if(line.points, [&](const auto& point) { return curves.decades && !(point.second > 0.0); });
    line.name = words(line.name);
    const bool nothing =
        std::all_of(line.points.begin(), line.points.end(), [](const auto& point) { return point.second == 0.0; });
    if (line.points.size() > 1 && !nothing) curves.lines.push_back(std::move(line));
}

/// A plot of columns over the increments; empty where no column is there.
inline std::string plot(const Table& table, const std::string& title, const std::string& label,
                        const std::vector<std::string>& names, bool decades = false, const std::string& caption = {}) {
    observe::CurvePlot curves = empty_plot(title, "increment", label, decades);
    for (const std::string& name : names) add_line(curves, table, table.column("increment"), name);
    return figure(curves, caption);
}

/// A picture as an image within the page: its style does not meet that of the page.
inline std::string image(const std::filesystem::path& path, const std::string& name) {
    std::string data;
    for (const char c : observe::read_file(path)) {
        if (std::string_view("\"#%&<>\n").find(c) == std::string_view::npos) {
            data += c;
            continue;
        }
        char code[4];
        std::snprintf(code, sizeof code, "%%%02X", static_cast<unsigned>(c));
        data += code;
    }
    return "<figure><img alt=\"" + name + "\" src=\"data:image/svg+xml," + data + "\"><figcaption>" + name +
           "</figcaption></figure>\n";
}

/// What a program measures of its load: each of its efforts over the first of its own columns that changes and is no share
/// of the load. They stand between `progress` and `fraction`.
inline std::string curves_of_load(const Table& table, const std::string& unit) {
    static const std::set<std::string> efforts{
        "force", "moment", "torque", "stress", "line_load", "ratio", "pressure_over_modulus"};
    std::size_t x = table.column("progress") + 1;
    const std::size_t end = table.column("fraction");
    std::string text;
    if (end >= table.names().size()) return text;
    const auto constant = [&](std::size_t column) {
        for (std::size_t row = 1; row < table.rows(); ++row)
            if (table.cell(row, column) != table.cell(0, column)) return false;
        return true;
    };
    while (x < end && (constant(x) || table.names()[x] == "load")) ++x;
    for (std::size_t y = x + 1; y < end; ++y) {
        const std::string &over = table.names()[x], &name = table.names()[y];
        if (efforts.count(name) == 0) continue;
        observe::CurvePlot curves =
            empty_plot(words(name) + " over " + words(over), words(axis_label(over, unit)), words(axis_label(name, unit)));
        add_line(curves, table, x, name);
        if (name == "force") add_line(curves, table, x, "damping_force");
        for (const char* theory : {"_of_helices", "_of_closed_form", "_of_sections", "_of_loose_knots"})
            add_line(curves, table, x, name + theory);
        text += figure(curves);
    }
    return text;
}

/// The curve of the load: from the table, or the picture of it that the program wrote.
inline std::string load(const std::filesystem::path& folder, const Table& table, const std::string& unit) {
    std::string text = curves_of_load(table, unit);
    if (const auto picture = folder / "curve.svg"; text.empty() && std::filesystem::exists(picture))
        text = image(picture, "curve of the load");
    return text.empty() ? text : "<h2>The load</h2>\n<div class=\"plots load\">\n" + text + "</div>\n";
}

/// The pictures slice_*.svg of a folder.
inline std::string slices(const std::filesystem::path& folder) {
    constexpr std::uintmax_t most_bytes = 8'000'000;  // of a page that is sent by mail
    std::set<std::filesystem::path> pictures;
    std::uintmax_t bytes = 0;
    if (!std::filesystem::is_directory(folder)) return {};
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (const std::string name = entry.path().filename().string(); name.starts_with("slice_") && name.ends_with(".svg"))
            pictures.insert(entry.path()), bytes += entry.file_size();
    if (pictures.empty()) return {};
    std::string text = "<h2>Slices</h2>\n";
    if (bytes > most_bytes) return text + "<p>They are large, and stay in the files slice_*.svg beside this page.</p>\n";
    text += "<div class=\"slices\">\n";
    for (const std::filesystem::path& path : pictures) text += image(path, words(path.stem().string().substr(6)));
    return text + "</div>\n";
}

/// Which increments each stage took: a row a stage.
inline std::string stages(const Table& table) {
    const std::size_t stage = table.column("stage"), iterations = table.column("newton_iterations"),
                      seconds = table.column("seconds");
    if (table.rows() == 0 || std::max({stage, iterations, seconds}) == table.names().size()) return {};
    std::string text = "<table><tr><th>stage</th><th>increments</th><th>Newton iterations</th><th>seconds</th></tr>\n";
    for (std::size_t from = 0, to = 0; from < table.rows(); from = to) {
        double newton = 0.0, taken = 0.0;
        for (to = from; to < table.rows() && table.cell(to, stage) == table.cell(from, stage); ++to)
            newton += number_of(table.cell(to, iterations)), taken += number_of(table.cell(to, seconds));
        text += "<tr><td>" + observe::xml_escaped(table.cell(from, stage)) + "</td><td>" + table.cell(from, 0) +
                (to - from > 1 ? " to " + table.cell(to - 1, 0) : std::string()) + "</td><td>" + short_number(newton) +
                "</td><td>" + short_number(taken, "%.3g") + "</td></tr>\n";
    }
    return text + "</table>\n";
}

}  // namespace example::detail
