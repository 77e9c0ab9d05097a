// SPDX-License-Identifier: MIT
#pragma once
/// @file Weaves of any number of layers from a matrix of levels, and lift plans, and leno.

#include <fibrant/compositions/textile/interlaced.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace fibrant::compositions::textile {

/// A weave of several layers: a row a warp, a column a column of wefts, the level being how many wefts of the column lie below
/// the warp.
///
/// Warp w is above the weft of layer l, 0 the lowest, where l < level: one number says all orders of a column and cannot
/// contradict itself.
struct LevelPlan {
    std::vector<std::vector<Index>> levels{};  ///< [warp][column], repeated over the columns, in [0, layers]
    Index layers = 1;                          ///< of wefts, >= 1
    Index columns = 0;                         ///< in all; 0: as many as the matrix has
    double column_spacing = core::unset;       ///< along the warp [length], > 0
    double warp_spacing = core::unset;         ///< between neighbouring warps, > 0
    double layer_spacing = 0.0;                ///< between wefts of one column [length]; 0: of yarns that just do not touch
    double overhang = 0.0;                     ///< beyond the outermost crossings [length]; 0: as far as they are apart
    /// Goes on along warps and wefts: yarns end half way between crossings, and whole rows of the matrix make the columns.
    bool periodic = false;
    YarnType warp{}, weft{};          ///< of warps and of wefts
    std::vector<Index> warp_types{};  ///< 0 the warp type, 1 the binder's, by row; empty: all 0
    YarnType binder{};                ///< of rows of that type

    Index warps() const noexcept { return core::count(levels); }
    Index column_count() const noexcept { return columns > 0 ? columns : levels.empty() ? 0 : core::count(levels.front()); }
    Index level(Index w, Index c) const { return levels[core::at(w)][core::at(c % core::count(levels[core::at(w)]))]; }
    bool bound(Index w) const { return !warp_types.empty() && warp_types[core::at(w)] == 1; }
    /// Whether two warps come to one level: somewhere the one is not lower, and somewhere not higher.
    bool pass(Index w, Index v) const {
        bool low = false, high = false;
        for (Index c = 0; c < column_count(); ++c)
            low = low || level(w, c) <= level(v, c), high = high || level(w, c) >= level(v, c);
        return low && high;
    }
    double thickest() const {
        double most = half_height(warp);
        for (Index w = 0; w < warps(); ++w)
            if (bound(w)) most = std::max(most, half_height(binder));
        return most;
    }
    /// A twentieth of a diameter more than thickness of warp and weft.
    double pitch() const { return layer_spacing > 0.0 ? layer_spacing : 2.1 * (thickest() + half_height(weft)); }

    void validate() const {
        if (levels.empty()) core::refuse("LevelPlan.levels", "none", "at least one warp");
        core::require_at_least("LevelPlan.layers", layers, 1);
        core::require_at_least("LevelPlan.columns", columns, 0);
        for (std::size_t w = 0; w < levels.size(); ++w) {
            if (levels[w].empty()) core::refuse("LevelPlan.levels[" + std::to_string(w) + "]", "none", "at least one column");
            for (std::size_t c = 0; c < levels[w].size(); ++c)
                if (levels[w][c] < 0 || levels[w][c] > layers)
                    core::refuse("LevelPlan.levels[" + std::to_string(w) + "][" + std::to_string(c) + "]",
                                 std::to_string(levels[w][c]), "in [0, layers = " + std::to_string(layers) + "]");
            // A digit that was forgotten would shift the rest of its row.
            if (columns == 0 && column_count() % core::count(levels[w]) != 0)
                core::refuse("LevelPlan.levels[" + std::to_string(w) + "]", std::to_string(levels[w].size()) + " columns",
                             "a number of columns that divides the " + std::to_string(column_count()) +
                                 " of the first row, unless columns are given");
        }
        core::require_positive("LevelPlan.warp_spacing", warp_spacing);
        core::require_not_negative("LevelPlan.layer_spacing", layer_spacing);
        core::require_not_negative("LevelPlan.overhang", overhang);
        if (periodic && overhang != 0.0)
            core::refuse("LevelPlan.overhang", core::text(overhang), "0, of a weave that goes on: half of the spacing");
        for (std::size_t w = 0; periodic && w < levels.size(); ++w)
            if (column_count() % core::count(levels[w]) != 0)
                core::refuse("LevelPlan.columns", std::to_string(column_count()),
                             "a multiple of the " + std::to_string(levels[w].size()) + " levels of warp " + std::to_string(w) +
                                 ", of a weave that goes on");
        if (!warp_types.empty() && warp_types.size() != levels.size())
            core::refuse("LevelPlan.warp_types", std::to_string(warp_types.size()),
                         "one for each warp, " + std::to_string(levels.size()));
        warp.validate(), weft.validate();
        // Ends of a cell do not keep neighbours apart that go past each other.
        for (Index w = 0; periodic && w < warps(); ++w) {
            const Index v = (w + 1) % warps();
            const double side = half_breadth(bound(w) ? binder : warp) + half_breadth(bound(v) ? binder : warp);
            if (warp_spacing < side && pass(w, v))
                core::refuse("LevelPlan.warp_spacing", core::text(warp_spacing),
                             ">= " + core::text(side) + ", the breadth of warps " + std::to_string(w) + " and " +
                                 std::to_string(v) + ", which go past each other");
        }
        // Between two wefts side by side a warp passes only if their surfaces are two warps' radii apart.
        const double least = 2.0 * (half_room(weft) + thickest());
        core::require(std::isfinite(column_spacing) && column_spacing >= least, "LevelPlan.column_spacing", column_spacing,
                      ">= " + core::text(least) + ", for warps to pass between wefts");
    }
};

/// Refuses a plan whose uppermost weft of a column lies above all warps, or its lowest one below all: it can be lifted off.
/// @param field  that says the levels
inline void require_wefts_held(const LevelPlan& plan, const std::string& field = "LevelPlan.levels") {
    for (Index c = 0; c < plan.column_count(); ++c) {
        Index least = plan.layers, most = 0;
        for (Index w = 0; w < plan.warps(); ++w)
            least = std::min(least, plan.level(w, c)), most = std::max(most, plan.level(w, c));
        if (least == 0 && most == plan.layers) continue;
        core::refuse(field + ": column " + std::to_string(c),
                     "levels from " + std::to_string(least) + " to " + std::to_string(most) + ", an interlacing that comes apart",
                     "from 0 to layers = " + std::to_string(plan.layers) + ": else no warp lies " +
                         (least > 0 ? "below its lowest weft" : "above its uppermost weft"));
    }
}

/// The highest level that a text can say.
inline constexpr Index highest_level = 35;

/// Levels from texts, a text a warp, a sign a column: 0 to 9, and a to z for 10 to 35.
inline std::vector<std::vector<Index>> levels_of(const std::vector<std::string>& rows) {
    std::vector<std::vector<Index>> levels;
    for (const std::string& row : rows) {
        levels.emplace_back();
        for (const char c : row) {
            const bool digit = c >= '0' && c <= '9';
            if (!digit && (c < 'a' || c > 'z'))
                core::refuse("levels: \"" + row + "\"", std::string(1, c), "digits, or a to z for 10 to 35, a column each");
            levels.back().push_back(digit ? c - '0' : 10 + (c - 'a'));
        }
    }
    return levels;
}

/// A warp that goes through the thickness: up by one layer a column, and down again. @param shift  columns by which it starts
/// later
inline std::vector<Index> angle_interlock(Index layers, Index shift = 0) {
    std::vector<Index> levels;
    for (Index c = 0; c < 2 * layers; ++c) {
        const Index at = (c + shift) % (2 * layers);
        levels.push_back(at <= layers ? at : 2 * layers - at);
    }
    return levels;
}

/// Levels from lifts: is warp w up while pick p is laid? Picks come column by column, in each from the lowest layer up.
/// @throws std::invalid_argument naming warp, column and pick, where a warp lies above a weft and below a lower one
inline std::vector<std::vector<Index>> levels_of_lifts(const std::vector<std::vector<bool>>& lift, Index layers) {
    core::require_at_least("levels_of_lifts.layers", layers, 1);
    std::vector<std::vector<Index>> levels;
    for (std::size_t w = 0; w < lift.size(); ++w) {
        const std::string warp = "lift[" + std::to_string(w) + "]";
        if (lift[w].empty() || core::count(lift[w]) % layers != 0)
            core::refuse(warp, std::to_string(lift[w].size()) + " picks",
                         "a whole number of columns of " + std::to_string(layers));
        levels.emplace_back();
        for (Index c = 0; c < core::count(lift[w]) / layers; ++c) {
            Index level = 0;
            for (Index l = 0; l < layers; ++l) {
                const Index pick = layers * c + l;
                if (!lift[w][core::at(pick)]) continue;
                if (level < l)
                    core::refuse(warp + "[" + std::to_string(pick) + "]", "1",
                                 "0: in column " + std::to_string(c) + " the warp lies below a lower weft");
                ++level;
            }
            levels.back().push_back(level);
        }
    }
    return levels;
}

namespace detail {
inline Textile drawn(const LevelPlan& plan) {
    Textile textile;
    textile.name = "weave";
    textile.apart_by = {ApartBy{"LevelPlan.column_spacing", plan.column_spacing},
                        ApartBy{"LevelPlan.warp_spacing", plan.warp_spacing},
                        ApartBy{"LevelPlan.layer_spacing", plan.layer_spacing, plan.pitch() - plan.layer_spacing}};
    textile.types = {plan.warp, plan.weft};
    if (!plan.warp_types.empty()) plan.binder.validate(), textile.types.push_back(plan.binder);
    const Index warps = plan.warps(), columns = plan.column_count(), layers = plan.layers;
    const double px = plan.column_spacing, py = plan.warp_spacing, pz = plan.pitch();
    const auto beyond = [&](double spacing) {
        return plan.periodic ? 0.5 * spacing : plan.overhang > 0.0 ? plan.overhang : spacing;
    };
    const double beyond_x = beyond(px), beyond_y = beyond(py);
    const double length = px * static_cast<double>(columns - 1) + 2.0 * beyond_x,
                 width = py * static_cast<double>(warps - 1) + 2.0 * beyond_y;
    // What goes on has its middle at the origin: a cell is bent about that (scene::PeriodicCell), and yarns, whose spin is held
    // in their middles, do not spin against those that they cross when it is twisted.
    const double x0 = plan.periodic ? beyond_x - 0.5 * length : 0.0, y0 = plan.periodic ? beyond_y - 0.5 * width : 0.0;
    for (Index w = 0; w < warps; ++w) {
        Path path;
        path.name = (plan.bound(w) ? "binder " : "warp ") + std::to_string(w);
        path.type = plan.bound(w) ? 2 : 0, path.family = plan.bound(w) ? 2 : 0;
        path.upward = Vec3::UnitZ();
        std::vector<std::pair<double, double>> knots;
        for (Index c = 0; c < columns; ++c)
            knots.emplace_back((beyond_x + px * static_cast<double>(c)) / length,
                               pz * (static_cast<double>(plan.level(w, c)) - 0.5 * static_cast<double>(layers)));
        const double y = y0 + py * static_cast<double>(w);
        if (plan.periodic) repeat(path, length * Vec3::UnitX());
        path.curve = raised([=](double t) { return Vec3(x0 + length * t - beyond_x, y, 0.0); }, std::move(knots), plan.periodic,
                            textile.view);
        textile.paths.push_back(std::move(path));
    }
    for (Index c = 0; c < columns; ++c)
        for (Index l = 0; l < layers; ++l) {
            Path path;
            path.name = "weft " + std::to_string(c) + "." + std::to_string(l);
            path.type = 1, path.family = 1, path.upward = Vec3::UnitZ();
            const double x = x0 + px * static_cast<double>(c),
                         z = pz * (static_cast<double>(l) - 0.5 * static_cast<double>(layers - 1));
            if (plan.periodic) repeat(path, width * Vec3::UnitY());
            path.curve = [=](double t) { return Vec3(x, y0 + width * t - beyond_y, z); };
            textile.paths.push_back(std::move(path));
        }
    if (plan.periodic) textile.lattice = {length * Vec3::UnitX(), width * Vec3::UnitY()};
    textile.crossings = crossings_of(textile);
    return textile;
}
}  // namespace detail

/// Wefts lie straight, warps at their levels between them, level where they cross and joined by arcs of the third degree: nothing
/// overlaps where there is room. warps x columns x layers crossings.
inline Textile woven(const LevelPlan& plan) {
    plan.validate();
    // A rise h over a spacing p is level at both ends with a radius of curvature of p^2 / 6 h.
    double bend = 0.0;  // greatest product of a rise and half the width of its yarn
    for (Index w = 0; w < plan.warps(); ++w)
        for (Index c = 0; c + (plan.periodic ? 0 : 1) < plan.column_count(); ++c)
            bend = std::max(bend, half_width(plan.bound(w) ? plan.binder : plan.warp) * plan.pitch() *
                                      static_cast<double>(std::abs(plan.level(w, c + 1) - plan.level(w, c))));
    return laid(plan, &LevelPlan::column_spacing, "LevelPlan.column_spacing", std::sqrt(6.0 * bend / 0.95),
                {{"warp_spacing", plan.warp_spacing}, {"layer_spacing", plan.layer_spacing}, {"overhang", plan.overhang}},
                plan.weft, [](const LevelPlan& one) { return detail::drawn(one); });
}

/// Leno: pairs of a ground end and a doup end that crosses to its other side between picks, below it, and lies above all wefts.
/// Where pairs cross them, the outermost wefts keep their places along the ends, as beside wefts of a longer sample.
struct LenoWeave {
    Index pairs = 2, picks = 6;         ///< >= 1, >= 2
    double pick_spacing = core::unset;  ///< [length], > 0
    double pair_spacing = core::unset;  ///< [length], > 0
    double aside = core::unset;         ///< of the doup from its ground end at a pick [length], > 0
    YarnType type{};                    ///< of all yarns

    void validate() const {
        core::require_at_least("LenoWeave.pairs", pairs, 1);
        core::require_at_least("LenoWeave.picks", picks, 2);
        core::require_positive("LenoWeave.pick_spacing", pick_spacing);
        type.validate();
        core::require(aside >= 2.4 * half_room(type), "LenoWeave.aside", aside,
                      ">= " + core::text(2.4 * half_room(type)) + ", 1.2 times the breadth of the yarn");
        core::require(pair_spacing > 2.0 * aside, "LenoWeave.pair_spacing", pair_spacing,
                      "> 2 aside = " + core::text(2.0 * aside));
    }
};

namespace detail {
inline Textile drawn(const LenoWeave& weave) {
    Textile textile;
    textile.name = "leno";
    textile.apart_by = {ApartBy{"LenoWeave.pick_spacing", weave.pick_spacing}, ApartBy{"LenoWeave.aside", weave.aside}, {}};
    textile.types = {weave.type};
    const double p = weave.pick_spacing, s = weave.aside, h = 2.1 * half_height(weave.type), beyond = p;
    const double length = p * static_cast<double>(weave.picks - 1) + 2.0 * beyond;
    const double width = weave.pair_spacing * static_cast<double>(weave.pairs - 1) + 4.0 * s + 2.0 * p;
    const bool several = weave.type.fibres > 1;
    for (Index k = 0; k < weave.pairs; ++k) {
        const double y = weave.pair_spacing * static_cast<double>(k);
        Path ground, doup;
        ground.name = "ground " + std::to_string(k), doup.name = "doup " + std::to_string(k);
        ground.family = 0, doup.family = 1;
        ground.curve = [=](double t) { return Vec3(length * t - beyond, y, -h); };
        // Between picks at a height of -2 h, at picks h. Beyond the outermost picks it keeps its side: no end stands on a
        // crossing.
        doup.curve = [=](double t) {
            const double x = length * t - beyond, f = std::numbers::pi * std::clamp(x, 0.0, length - 2.0 * beyond) / p;
            const double c = std::cos(f), u = c * c;
            // A single fibre parts from its ground end. Yarns of several fibres go round it in an ellipse, which is as far to
            // the side where they are at its height as it is below: u of 1/3.
            const double way = !several || u >= 1.0 / 3.0 ? (several ? std::copysign(1.0, c) : c) : c * std::sqrt(6.0 - 9.0 * u);
            return Vec3(x, y + s * way, h * (-0.5 + 1.5 * std::cos(2.0 * f)));
        };
        textile.paths.push_back(std::move(ground)), textile.paths.push_back(std::move(doup));
    }
    for (Index m = 0; m < weave.picks; ++m) {
        Path path;
        path.name = "weft " + std::to_string(m), path.family = 2;
        const double x = p * static_cast<double>(m);
        path.curve = [=](double t) {
            return Vec3(x, width * (t - 0.5) + 0.5 * weave.pair_spacing * static_cast<double>(weave.pairs - 1), 0.0);
        };
        // Behind an outermost weft no pair crosses any more: pulled straight, pairs would push it along to their ends, and the
        // crossing before it off them.
        if (m == 0 || m + 1 == weave.picks)
            for (Index k = 0; k < weave.pairs; ++k)
                path.guides.push_back(
                    {0.5 + weave.pair_spacing * (static_cast<double>(k) - 0.5 * static_cast<double>(weave.pairs - 1)) / width,
                     Vec3::UnitX() * Vec3::UnitX().transpose()});
        textile.paths.push_back(std::move(path));
    }
    textile.crossings = crossings_of(textile);
    require_crossings(textile, weave.pairs * (3 * weave.picks - 1), "LenoWeave.pick_spacing, pair_spacing, aside",
                      "two of each pair of ends with a weft, and one between two wefts");
    return textile;
}
}  // namespace detail

/// Each pair of yarns has one order for good: doup above wefts, wefts above ground, ground above doup. 2 crossings a pick and one
/// a gap for each pair.
inline Textile leno(const LenoWeave& weave) {
    return laid(weave, &LenoWeave::pick_spacing, "LenoWeave.pick_spacing", 2.0 * half_room(weave.type),
                {{"pair_spacing", weave.pair_spacing}, {"aside", weave.aside}}, weave.type,
                [](const LenoWeave& one) { return detail::drawn(one); });
}

}  // namespace fibrant::compositions::textile
