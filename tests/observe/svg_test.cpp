// SPDX-License-Identifier: MIT
#include "observe/snapshot_samples.hpp"
#include "refusal.hpp"

#include <fibrant/observe/svg_slice.hpp>
#include <fibrant/observe/svg_view.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>
#include <string>

using namespace fibrant;

namespace svg_test {

using namespace fibrant::observe;

double area(const std::vector<Eigen::Vector2d>& polygon) {
    double doubled = 0.0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Eigen::Vector2d &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
        doubled += a.x() * b.y() - b.x() * a.y();
    }
    return 0.5 * std::abs(doubled);
}

std::size_t occurrences(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

Snapshot only(const FibreSnapshot& fibre) {
    Snapshot snapshot;
    snapshot.fibres.push_back(fibre);
    return snapshot;
}

/// Area of the regular polygon that is drawn for a circle, over the circle's.
const double polygon_share = 32.0 * std::sin(2.0 * std::numbers::pi / 32.0) / (2.0 * std::numbers::pi);

TEST_CASE("a fibre cut square shows its circle, one cut at an angle an ellipse longer by one over the sine") {
    const auto square = slice_shapes(only(straight_fibre({-1, 2, 3}, {1, 2, 3}, 4, 0.1, 0)), 0, 0.25);
    REQUIRE(square.size() == 1);
    CHECK_FALSE(square[0].along);
    CHECK(area(square[0].outline) == test::near(std::numbers::pi * 0.01 * polygon_share, 1e-12));
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const auto& corner : square[0].outline) middle += corner / 32.0;
    CHECK((middle - Eigen::Vector2d{2, 3}).norm() < 1e-12);

    const auto slanted = slice_shapes(only(straight_fibre({-1, -1, 0}, {1, 1, 0}, 4, 0.1, 0)), 0, 0.0);
    REQUIRE(slanted.size() == 1);
    const double ellipse = std::numbers::pi * 0.01 * std::numbers::sqrt2;
    CHECK(area(slanted[0].outline) == test::near(ellipse * polygon_share, 1e-12));
}

TEST_CASE("a fibre that runs in the plane shows a strip as wide as the chord at its distance") {
    const Snapshot snapshot = only(straight_fibre({0.06, -1, 0}, {0.06, 1, 0}, 4, 0.1, 0));
    const auto strip = slice_shapes(snapshot, 0, 0.0);
    REQUIRE(strip.size() == 1);
    CHECK(strip[0].along);
    CHECK(area(strip[0].outline) == test::near(2.0 * 2.0 * 0.08, 1e-12));  // length 2, half chord sqrt(0.1^2 - 0.06^2)
    CHECK(slice_shapes(snapshot, 0, -0.05).empty());                       // 0.11 away
}

TEST_CASE("a fibre that leaves the plane slowly shows the tip of a cut cylinder") {
    // Slope 0.1 through the plane at y = 0: the cut is an ellipse of half axes r and r / sin(angle), inside the fibre.
    const double sine = 0.1 / std::sqrt(1.01);
    const auto strip = slice_shapes(only(straight_fibre({-0.3, -3, 0}, {0.3, 3, 0}, 121, 0.1, 0)), 0, 0.0);
    REQUIRE(strip.size() == 1);
    // The strip is sampled at 0.006 of length 2, and its tips lose less than one sample each.
    CHECK(area(strip[0].outline) == test::near(std::numbers::pi * 0.1 * 0.1 / sine, 2e-3));
}

TEST_CASE("a slice names its plane, draws its scale, and says where nothing is cut") {
    SliceParameters parameters;
    parameters.axis = 1;
    parameters.position = 0.5;
    parameters.unit = "mm";
    parameters.title = "two <fibres>";
    const std::string slice = svg_slice(crossing_pair(), parameters);
    CHECK(slice.find("two &lt;fibres&gt;, y = 0.5 mm") != std::string::npos);
    parameters.position = 0.123456789;
    CHECK(svg_slice(crossing_pair(), parameters).find("y = 0.1235 mm") !=
          std::string::npos);  // to a thousandth of a picture 0.2 wide
    CHECK(slice.find("mm</text>") != std::string::npos);
    CHECK(occurrences(slice, "<path fill=") == 1);
    parameters.position = 5.0;
    CHECK(svg_slice(crossing_pair(), parameters).find("(no fibre)") != std::string::npos);
    parameters.axis = 3;
    CHECK(test::refusal([&] { return svg_slice(crossing_pair(), parameters); }) ==
          "SliceParameters.axis = 3, but it must be 0, 1 or 2");
}

TEST_CASE("the nearer of two crossing fibres is painted last") {
    ViewParameters view;
    view.elevation = 90.0;
    view.palette.groups = {{1, 0, 0}, {0, 0, 1}};  // red below, blue above
    const auto last_body = [&](double elevation) {
        view.elevation = elevation;
        const std::string picture = svg_view(crossing_pair(), view);
        const std::size_t at = picture.rfind("class=\"o");
        const std::string name = picture.substr(at + 7, picture.find('"', at + 7) - at - 7);
        const std::size_t style = picture.find("." + name + "{stroke:");
        return picture.substr(picture.find('#', style), 7);
    };
    CHECK(last_body(90.0) == Colour{0, 0, 1}.toned(0.32).text());
    CHECK(last_body(-90.0) == Colour{1, 0, 0}.toned(0.32).text());
}

TEST_CASE("what is hidden is left out: a stack of fibres costs no more than its top") {
    Snapshot stack;
    for (int level = 0; level < 50; ++level) {
        const double z = -0.2 * level;
        stack.fibres.push_back(straight_fibre({-1, 0, z}, {1, 0, z}, 33, 0.1, 0));
    }
    ViewParameters view;
    view.elevation = 90.0;
    const std::string all = svg_view(stack, view);
    stack.fibres.resize(1);
    const std::string top = svg_view(stack, view);
    CHECK(occurrences(all, "<path") <= occurrences(top, "<path") + 50);  // an end may show through a rounded cell
}

TEST_CASE("the number of pieces bounds the size of the file") {
    Snapshot mat;
    for (int k = 0; k < 600; ++k) {
        const double angle = 2.399963 * k, c = std::cos(angle), s = std::sin(angle), z = 0.05 * k;
        mat.fibres.push_back(straight_fibre({-30 * c, -30 * s, z}, {30 * c, 30 * s, z}, 65, 0.02, k));
    }
    ViewParameters view;
    CHECK(svg_view(mat, view).size() < 10'000'000);  // not even with nothing hidden
    view.pieces = 3000;
    CHECK(svg_view(mat, view).size() < 1'500'000);
}

TEST_CASE("a view of nothing, or from a wrong elevation, is no accident") {
    CHECK(svg_view(Snapshot{}).find("<svg") == 0);
    ViewParameters view;
    view.elevation = 91.0;
    CHECK(test::refusal([&] { return svg_view(crossing_pair(), view); }) ==
          "ViewParameters.elevation = 91, but it must be in [-90, 90]");
}

TEST_CASE("numbers of pictures are short and independent of the locale") {
    CHECK(rounded(12.50, 2) == "12.5");
    CHECK(rounded(-0.001, 1) == "0");
    CHECK(rounded(300.0, 0) == "300");
    CHECK(shortest(0.1) == "0.1");
    CHECK(detail::round_length(0.7) == 0.5);
    CHECK(detail::round_length(200.0) == 200.0);
    CHECK(Colour{1, 0.5, 0}.text() == "#ff8000");
}

}  // namespace svg_test
