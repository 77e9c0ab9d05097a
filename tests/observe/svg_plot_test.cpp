// SPDX-License-Identifier: MIT
#include "refusal.hpp"

#include <fibrant/observe/svg_curves.hpp>
#include <fibrant/observe/svg_plot.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace fibrant;

namespace svg_plot_test {

using observe::LogLogPlot;

std::size_t times(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}
TEST_CASE("the fitted order of a power law is its power, whatever its factor") {
    for (const double order : {-4.0, 1.5}) {
        std::vector<std::pair<double, double>> points;
        for (const double x : {1.0, 3.0, 10.0, 70.0}) points.emplace_back(x, 0.3 * std::pow(x, order));
        points.emplace_back(5.0, 0.0);  // an error that is exactly nothing is not on the line
        CHECK(observe::fitted_order(points) == test::near(order, 1e-12));
    }
    CHECK(std::isnan(observe::fitted_order({{1.0, 2.0}})));
    CHECK(std::isnan(observe::fitted_order({{1.0, 2.0}, {1.0, 3.0}})));
}

TEST_CASE("decades are equally far apart, and a power law is a straight line") {
    LogLogPlot plot{
        "title <1>", "time [s]", "error", {{"a", {{1e-3, 1.0}, {1e-2, 1e-2}, {1e-1, 1e-4}}}, {"b", {{1e-2, 0.0}, {-1.0, 1.0}}}}};
    const std::string page = observe::log_log_svg(plot);
    CHECK(page.find("title &lt;1&gt;") != std::string::npos);
    CHECK(times(page, "<circle") == 3);          // nothing of what has no logarithm
    CHECK(times(page, "class=\"g\"") == 3 + 5);  // 1e-3 to 1e-1, and 1e-4 to 1
    // left 78 to right 470, bottom 384 to top 46: the middle point is half-way
    CHECK(page.find("M78 46L274 215L470 384") != std::string::npos);
}

TEST_CASE("within a decade its multiples are marked") {
    LogLogPlot plot{"", "x", "y", {{"a", {{0.2, 3e2}, {0.4, 3e2 * 8.0}}}}};
    const std::string page = observe::log_log_svg(plot);
    CHECK(times(page, "class=\"g\"") == 3 + 3);  // 0.2, 0.3 and 0.4; two decades
    CHECK(page.find(">0.2<") != std::string::npos);
    CHECK(page.find(">0.4<") != std::string::npos);
    CHECK(page.find(">1e2<") != std::string::npos);
    // From side to side; a cube between the marks of 100 and 10,000.
    CHECK(page.find("M78 ") != std::string::npos);
    CHECK(page.find("L470 ") != std::string::npos);
}

TEST_CASE("over increments a power of ten each is a straight line on decades, and what is not above zero is left out") {
    observe::CurvePlot plot{
        "", "increment", "residual", {{"a", {{1.0, 1e-1}, {2.0, 1e-2}, {3.0, 0.0}, {4.0, -1.0}, {5.0, 1e-5}}}}};
    plot.decades = true;
    const std::string page = observe::curves_svg(plot);
    CHECK(times(page, "<circle") == 3);
    for (const char* decade : {">1e-1<", ">1e-2<", ">1e-3<", ">1e-4<", ">1e-5<"}) CHECK(times(page, decade) == 1);
    // left 84 to right 610 for 0 to 5, top 46 to bottom 384 for 1e-1 to 1e-5
    CHECK(page.find("M189.2 46L294.4 130.5L610 384") != std::string::npos);
}

TEST_CASE("numbers along the axis that would run into each other are left out, their marks are not") {
    observe::CurvePlot plot{"", "strain", "stress", {{"a", {{0.0, 0.0}, {0.016, 1.0}}}}};
    plot.width = 400.0;
    const std::string page = observe::curves_svg(plot);
    CHECK(times(page, "class=\"g\"") == 9 + 6);  // 0, 0.002, ... and 0, 0.2, ...
    CHECK(times(page, ">0.004<") == 1);
    CHECK(times(page, ">0.002<") == 0);  // 41 pixels of room and 45 of text
}

TEST_CASE("names of several lines stand beside them, or are left to the page around it") {
    observe::CurvePlot plot{"", "x", "y", {{"upper", {{0.0, 1.0}, {1.0, 2.0}}}, {"lower", {{0.0, 0.0}, {1.0, 1.0}}}}};
    CHECK(times(observe::curves_svg(plot), ">upper<") == 1);
    plot.names = false;
    const std::string page = observe::curves_svg(plot);
    CHECK(times(page, ">upper<") == 0);
    CHECK(page.find("610 46") != std::string::npos);  // the plot has the room
}

TEST_CASE("a plot of nothing is refused") {
    CHECK(test::refusal([] {
              observe::log_log_svg({"", "", "", {{"a", {{1.0, 0.0}}}}});
          }) == "LogLogPlot.lines = no point, but it must be a point with both numbers > 0");
}

}  // namespace svg_plot_test
