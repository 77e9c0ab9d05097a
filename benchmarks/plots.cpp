// SPDX-License-Identifier: MIT
// What do the tables of the other benchmarks look like? Reads those that are there of a folder's search.csv, growth.csv,
// solver.csv and scaling.csv, as `benchmarks/run.sh` leaves them, and writes plots beside them. usage: benchmark_plots FOLDER
#include <fibrant/observe/svg_plot.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

using namespace fibrant;

namespace {

/// A table with a header; lines that begin with # are left out.
struct Table {
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;

    explicit Table(const std::filesystem::path& path) {
        std::ifstream in(path);
        std::string line;
        while (std::getline(in, line)) {
            if (line.empty() || line.front() == '#') continue;
            std::vector<std::string> cells;
            std::stringstream text(line);
            for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
            if (header.empty())
                header = std::move(cells);
            else if (cells.size() + 1 >= header.size())
                rows.push_back(std::move(cells)), rows.back().resize(header.size());
        }
        if (header.empty()) throw std::runtime_error(path.string() + " has no header");
    }
    std::size_t column(const std::string& name) const {
        const auto found = std::find(header.begin(), header.end(), name);
        if (found == header.end()) throw std::runtime_error("a table has no column " + name);
        return static_cast<std::size_t>(found - header.begin());
    }
};

double number(const std::string& cell) { return std::strtod(cell.c_str(), nullptr); }

/// A line for each name, its points by x.
using Lines = std::map<std::string, std::vector<std::pair<double, double>>>;

void write(const std::filesystem::path& path, const std::string& title, const std::string& x, const std::string& y, Lines lines,
           bool orders) {
    observe::LogLogPlot plot{.title = title, .x_label = x, .y_label = y, .lines = {}};
    for (auto& [name, points] : lines) {
        std::sort(points.begin(), points.end());
        plot.lines.push_back(
            {orders && points.size() > 1 ? name + " ~ " + observe::rounded(observe::fitted_order(points), 2) : name, points});
    }
    std::ofstream(path) << observe::log_log_svg(plot);
    std::printf("%s\n", path.string().c_str());
}

void plot_search(const std::filesystem::path& folder) {
    const Table table(folder / "search.csv");
    const std::size_t name = table.column("search"), segments = table.column("segments"), time = table.column("total_ms");
    Lines lines;
    for (const auto& row : table.rows) lines[row[name]].emplace_back(number(row[segments]), number(row[time]));
    write(folder / "search.svg", "Search of every scene", "segments", "ms", std::move(lines), false);
}

void plot_growth(const std::filesystem::path& folder) {
    const Table table(folder / "growth.csv");
    const std::size_t name = table.column("search"), segments = table.column("segments"), time = table.column("milliseconds");
    Lines lines;
    for (const auto& row : table.rows)
        if (number(row[segments]) > 0.0) lines[row[name]].emplace_back(number(row[segments]), number(row[time]));
    write(folder / "growth.svg", "Search of random mats, and its exponent", "segments", "ms", std::move(lines), true);
}

/// One plot a system: the error that is reached against the time that it takes.
void plot_solvers(const std::filesystem::path& folder) {
    const Table table(folder / "solver.csv");
    const std::size_t scene = table.column("scene"), unknowns = table.column("dofs"), name = table.column("strategy"),
                      error = table.column("error"), prepare = table.column("prepare_s"), solve = table.column("solve_s");
    std::map<std::string, Lines> systems;
    for (const auto& row : table.rows)
        if (!row[name].starts_with("product"))
            systems[row[scene] + "_" + row[unknowns]][row[name]].emplace_back(number(row[prepare]) + number(row[solve]),
                                                                              number(row[error]));
    for (auto& [system, lines] : systems)
        write(folder / ("solver_" + system + ".svg"), "Linear solvers: " + system + " unknowns", "preparing and solving [s]",
              "error in energy", std::move(lines), false);
}

void plot_scaling(const std::filesystem::path& folder) {
    const Table table(folder / "scaling.csv");
    const std::size_t unknowns = table.column("unknowns");
    Lines lines;
    for (const char* name : {"seconds", "seconds_a_newton"})
        for (const auto& row : table.rows) lines[name].emplace_back(number(row[unknowns]), number(row[table.column(name)]));
    write(folder / "scaling.svg", "Settling a weave, and its exponents", "unknowns", "s", std::move(lines), true);
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc != 2) {
        std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    const std::vector<std::pair<const char*, void (*)(const std::filesystem::path&)>> plots{
        {"search.csv", plot_search}, {"growth.csv", plot_growth}, {"solver.csv", plot_solvers}, {"scaling.csv", plot_scaling}};
    int written = 0;
    try {
        for (const auto& [table, plot] : plots)
            if (std::filesystem::exists(folder / table)) plot(folder), ++written;
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "benchmark_plots: %s\n", problem.what());
        return 2;
    }
    if (written == 0) std::fprintf(stderr, "benchmark_plots: %s holds none of the tables\n", argv[1]);
    return written > 0 ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
