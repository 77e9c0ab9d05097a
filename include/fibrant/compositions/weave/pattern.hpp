// SPDX-License-Identifier: MIT
#pragma once
/// @file Interlacing of warp and weft: which tow is above at each crossing, and whether the cloth holds together.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fibrant::compositions::weave {

/// Interlacing matrix, repeated in both directions: row = warp tow, column = weft tow, true = warp above weft.
class Pattern {
public:
    /// Plain weave.
    Pattern() : Pattern(formula("plain", 2, 2, [](Index i, Index j) { return (i + j) % 2 == 1; })) {}

    /// A matrix drawn by the user, which a fabric must hold a whole number of times.
    /// @param rows  one text a warp tow: '1' or '0' a weft tow (blanks ignored), or the words "over" and "under"
    static Pattern from_rows(const std::vector<std::string>& rows) {
        if (rows.empty()) core::refuse("Pattern.rows", "[]", "at least one row");
        Pattern pattern{"drawn", 0, 0};
        for (const std::string& row : rows) {
            const std::vector<bool> cells = parse(row);
            if (pattern.rows_ == 0) pattern.columns_ = core::count(cells);
            if (cells.empty() || core::count(cells) != pattern.columns_)
                core::refuse("Pattern.rows[" + std::to_string(pattern.rows_) + "]", "\"" + row + "\"",
                             pattern.rows_ == 0 ? std::string("at least one crossing")
                                                : "as long as the first row, " + std::to_string(pattern.columns_));
            pattern.above_.insert(pattern.above_.end(), cells.begin(), cells.end());
            ++pattern.rows_;
        }
        return pattern;
    }

    /// A built-in weave: plain, twill22, twill31, satin5 or satin8; any number of tows may be cut from it.
    static Pattern named(std::string_view name) {
        if (name == "plain") return Pattern{};
        if (name == "twill22") return formula(name, 4, 4, [](Index i, Index j) { return (i + j) % 4 < 2; });
        if (name == "twill31") return formula(name, 4, 4, [](Index i, Index j) { return (i + j) % 4 < 3; });
        if (name == "satin5") return formula(name, 5, 5, [](Index i, Index j) { return (j + 3 * i) % 5 == 0; });
        if (name == "satin8") return formula(name, 8, 8, [](Index i, Index j) { return (j + 5 * i) % 8 == 0; });
        core::refuse("Pattern.name", "\"" + std::string(name) + "\"", "plain, twill22, twill31, satin5 or satin8");
    }

    /// Is warp tow i above weft tow j? Any i, j >= 0.
    bool over(Index i, Index j) const noexcept { return above_[core::at((i % rows_) * columns_ + j % columns_)]; }
    Index rows() const noexcept { return rows_; }        ///< warp tows of a repeat
    Index columns() const noexcept { return columns_; }  ///< weft tows of a repeat
    bool built_in() const noexcept { return name_ != "drawn"; }
    const std::string& name() const noexcept { return name_; }

    /// Throws unless a fabric of that many tows is a whole number of repeats of a drawn matrix and holds together.
    ///
    /// It falls apart if some tows lie above all others at every crossing, for then they can be lifted off. No such set
    /// exists if and only if the directed graph "tow A lies above tow B" over all crossings is strongly connected
    /// (Clapham 1980, Enns 1984). A tow that never changes side is the simplest case. Time linear in the crossings.
    void require_holding(Index warp_tows, Index weft_tows) const {
        core::require_at_least("Pattern.warp_tows", warp_tows, 1);
        core::require_at_least("Pattern.weft_tows", weft_tows, 1);
        if (!built_in() && (warp_tows % rows_ != 0 || weft_tows % columns_ != 0))
            core::refuse(
                "Pattern.size", std::to_string(rows_) + " x " + std::to_string(columns_),
                "a divisor of the tow counts, " + std::to_string(warp_tows) + " warp x " + std::to_string(weft_tows) + " weft");
        const std::string loose = loose_tows(warp_tows, weft_tows);
        if (!loose.empty())
            core::refuse("Pattern",
                         name_ + " on " + std::to_string(warp_tows) + " warp and " + std::to_string(weft_tows) + " weft tows",
                         "an interlacing that holds, where no tows lie on one side of all others as " + loose + " do");
    }

    /// A set of tows that lie above or below all others, as text; empty if the fabric holds together.
    std::string loose_tows(Index warp_tows, Index weft_tows) const {
        for (const bool down : {true, false}) {
            const std::vector<bool> reached = reachable(warp_tows, weft_tows, down);
            const auto inside = std::count(reached.begin(), reached.end(), true);
            if (inside == warp_tows + weft_tows) continue;
            // Tows that are reached downwards lie below all others, and the reverse; the fewer of the two sets is
            // named.
            const bool named = 2 * inside <= warp_tows + weft_tows;
            std::string names;
            for (Index k = 0; k < warp_tows + weft_tows; ++k) {
                if (reached[core::at(k)] != named) continue;
                names += (names.empty() ? "" : ", ") +
                         (k < warp_tows ? "warp " + std::to_string(k) : "weft " + std::to_string(k - warp_tows));
            }
            return names + (named == down ? " (below)" : " (above)");
        }
        return {};
    }

private:
    Pattern(std::string_view name, Index rows, Index columns) : name_{name}, rows_{rows}, columns_{columns} {}

    template <class Rule>
    static Pattern formula(std::string_view name, Index rows, Index columns, const Rule& rule) {
        Pattern pattern{name, rows, columns};
        for (Index i = 0; i < rows; ++i)
            for (Index j = 0; j < columns; ++j) pattern.above_.push_back(rule(i, j));
        return pattern;
    }

    static std::vector<bool> parse(const std::string& row) {
        std::vector<bool> cells;
        for (std::size_t k = 0; k < row.size(); ++k) {
            const char c = row[k];
            if (c == ' ' || c == ',') continue;
            if (c == '0' || c == '1') {
                cells.push_back(c == '1');
            } else if (row.compare(k, 4, "over") == 0) {
                cells.push_back(true);
                k += 3;
            } else if (row.compare(k, 5, "under") == 0) {
                cells.push_back(false);
                k += 4;
            } else {
                core::refuse("Pattern.rows", "\"" + row + "\"", "made of '0' and '1', or of \"over\" and \"under\"");
            }
        }
        return cells;
    }

    /// Tows that are reached from warp tow 0 along crossings, always to the lower (or upper) tow.
    std::vector<bool> reachable(Index warp_tows, Index weft_tows, bool down) const {
        std::vector<bool> reached(core::at(warp_tows + weft_tows), false);
        std::vector<Index> open{0};
        reached[0] = true;
        while (!open.empty()) {
            const Index tow = open.back();
            open.pop_back();
            const bool warp = tow < warp_tows;
            const Index first = warp ? warp_tows : 0, last = warp ? warp_tows + weft_tows : warp_tows;
            for (Index other = first; other < last; ++other) {
                if (reached[core::at(other)]) continue;
                const bool warp_above = warp ? over(tow, other - warp_tows) : over(other, tow - warp_tows);
                if ((warp_above == warp) != down) continue;
                reached[core::at(other)] = true;
                open.push_back(other);
            }
        }
        return reached;
    }

    std::string name_;
    Index rows_ = 0, columns_ = 0;
    std::vector<bool> above_;  ///< row-major
};

}  // namespace fibrant::compositions::weave
