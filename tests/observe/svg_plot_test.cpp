// SPDX-License-Identifier: MIT
#include "refusal.hpp"

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

TEST_CASE("a plot of nothing is refused") {
    CHECK(test::refusal([] {
              observe::log_log_svg({"", "", "", {{"a", {{1.0, 0.0}}}}});
          }) == "LogLogPlot.lines = no point, but it must be a point with both numbers > 0");
}

}  // namespace svg_plot_test
