// SPDX-License-Identifier: MIT
#pragma once
/// @file A table of increments read back for its curves: that of a run which was resumed is whole.

#include <fibrant/observe/svg_plot.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace example {

/// The number of a cell, however small (std::stod refuses what has less than sixteen digits left); NaN if it is none.
inline double number_of(std::string_view cell) {
    double value = std::numeric_limits<double>::quiet_NaN();
    std::from_chars(cell.data(), cell.data() + cell.size(), value);
    return value;
}

/// Cells of a CSV file without quotes, the first row its names. A last row that is cut short is left out.
class Table {
public:
    explicit Table(const std::filesystem::path& path) {
        std::ifstream file(path);
        std::string line;
        if (std::getline(file, line)) names_ = cells(line);
        while (std::getline(file, line))
            if (auto row = cells(line); row.size() == names_.size()) rows_.push_back(std::move(row));
    }
    const std::vector<std::string>& names() const noexcept { return names_; }
    std::size_t rows() const noexcept { return rows_.size(); }
    const std::string& cell(std::size_t row, std::size_t column) const { return rows_.at(row).at(column); }
    /// Place of a column; names().size() if there is none.
    std::size_t column(std::string_view name) const {
        return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
    }
    /// One column over another, of the rows whose column `where` is `what`, or of all; empty where a column is missing.
    fibrant::observe::PlotLine line(std::string name, std::size_t x, std::size_t y, std::string_view where = {},
                                    std::string_view what = {}) const {
        fibrant::observe::PlotLine answer{std::move(name), {}};
        const std::size_t c = column(where);
        if (std::max(x, y) >= names_.size() || (!where.empty() && c == names_.size())) return answer;
        for (const auto& row : rows_)
            if (where.empty() || row[c] == what) answer.points.emplace_back(number_of(row[x]), number_of(row[y]));
        return answer;
    }

private:
    static std::vector<std::string> cells(const std::string& line) {
        std::vector<std::string> row(1);
        for (const char c : line) {
            if (c == ',')
                row.emplace_back();
            else
                row.back() += c;
        }
        return row;
    }
    std::vector<std::string> names_;
    std::vector<std::vector<std::string>> rows_;
};

/// Name of a figure with its unit, forces in N as in the scene files.
inline std::string axis_label(const std::string& name, const std::string& unit_of_length) {
    if (name == "angle_deg" || name == "helix_angle_deg") return "angle [degrees]";
    for (const char* pure : {"strain", "shear", "turns", "ratio", "compression", "volume_fraction", "pressure_over_modulus"})
        if (name == pure) return name + " [1]";
    if (name == "rotation") return "rotation [rad / " + unit_of_length + "]";
    if (name == "slack" || name.ends_with("force")) return name + " [N]";
    if (name == "moment" || name == "torque") return name + " [N " + unit_of_length + "]";
    if (name == "stress") return name + " [N / " + unit_of_length + "^2]";
    if (name == "line_load") return name + " [N / " + unit_of_length + "]";
    if (name == "curvature") return "curvature [1 / " + unit_of_length + "]";
    return name + " [" + unit_of_length + "]";
}

}  // namespace example
