// SPDX-License-Identifier: MIT
#pragma once
/// @file What pictures share: colours of groups, and the frame of an SVG file.

#include <fibrant/core/types.hpp>
#include <fibrant/observe/text_file.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace fibrant::observe {

/// Red, green, blue, each in [0, 1].
struct Colour {
    double red = 0.6, green = 0.6, blue = 0.6;

    /// Towards black for share < 1, towards white for share > 1 (2 is white).
    Colour toned(double share) const noexcept {
        const auto tone = [&](double c) { return share <= 1.0 ? c * share : c + (1.0 - c) * (share - 1.0); };
        return {tone(red), tone(green), tone(blue)};
    }
    /// As #rrggbb.
    std::string text() const {
        static constexpr char digits[] = "0123456789abcdef";
        std::string answer = "#";
        for (const double c : {red, green, blue}) {
            const auto level = static_cast<unsigned>(std::lround(255.0 * std::clamp(c, 0.0, 1.0)));
            answer += digits[level >> 4];
            answer += digits[level & 15];
        }
        return answer;
    }
};

/// Which colour each fibre has in a picture.
struct Palette {
    /// Of group k: colour k modulo their number; of no group: grey.
    std::vector<Colour> groups{{0.25, 0.47, 0.71}, {0.88, 0.58, 0.25}, {0.42, 0.65, 0.39}, {0.76, 0.36, 0.38},
                               {0.55, 0.45, 0.68}, {0.58, 0.45, 0.36}, {0.84, 0.55, 0.71}, {0.35, 0.69, 0.74}};
    std::vector<Colour> fibres;  ///< if not empty, one a fibre, instead

    Colour of(Index fibre, Index group) const noexcept {
        if (fibre < core::count(fibres)) return fibres[core::at(fibre)];
        if (group < 0 || groups.empty()) return {};
        return groups[core::at(group % core::count(groups))];
    }
};

namespace detail {

/// A point of a picture: pixels, down the page.
inline std::string point_text(const Eigen::Vector2d& p, int decimals = 1) {
    return rounded(p.x(), decimals) + " " + rounded(p.y(), decimals);
}

/// A text of a picture, its place in pixels.
inline std::string svg_text(double x, double y, std::string_view text, std::string_view more = "") {
    return "<text x=\"" + rounded(x, 1) + "\" y=\"" + rounded(y, 1) + "\"" + std::string{more} + ">" + xml_escaped(text) +
           "</text>\n";
}

/// A whole file: white page, style, body, title at the top left.
inline std::string svg_page(double width, double height, const std::string& style, const std::string& body,
                            const std::string& title) {
    const std::string w = rounded(width, 0), h = rounded(height, 0);
    std::string page = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "\" height=\"" + h + "\" viewBox=\"0 0 " + w +
                       " " + h + "\">\n<style>text{font:16px sans-serif;fill:#222}\n" + style + "</style>\n<rect width=\"" + w +
                       "\" height=\"" + h + "\" fill=\"#fff\"/>\n" + body;
    if (!title.empty()) page += svg_text(16, 28, title);
    return page + "</svg>\n";
}

/// 1, 2 or 5 times a power of ten, not above `length`.
inline double round_length(double length) noexcept {
    const double decade = std::pow(10.0, std::floor(std::log10(length)));
    for (const double part : {5.0, 2.0})
        if (part * decade <= length) return part * decade;
    return decade;
}

/// A scale bar whose left end is at (x, y), at most `longest` pixels long.
inline std::string svg_scale_bar(double x, double y, double longest, double pixels_per_length, const std::string& unit) {
    const double length = round_length(longest / pixels_per_length), pixels = length * pixels_per_length;
    const std::string end = rounded(x + pixels, 1), start = rounded(x, 1);
    return "<path d=\"M" + start + " " + rounded(y - 5, 1) + "v10m0-5H" + end +
           "m0-5v10\" stroke=\"#222\" stroke-width=\"2\" fill=\"none\"/>\n" +
           svg_text(x + pixels + 8, y + 5, shortest(length) + (unit.empty() ? "" : " " + unit));
}

}  // namespace detail

}  // namespace fibrant::observe
