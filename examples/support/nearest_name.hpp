// SPDX-License-Identifier: MIT
#pragma once
/// @file The name that a misspelt one stands for.

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace example {

/// Letters that are put in, left out, replaced or swapped with their neighbour to make one word of another (optimal string
/// alignment, after Damerau 1964). Capitals count as small letters.
inline std::size_t misprints(std::string_view a, std::string_view b) {
    const auto same = [](char x, char y) {
        return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
    };
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before.swap(last), last.swap(row);
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same(a[i - 1], b[j - 1]) ? 0 : 1)});
            if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
    }
    return row[b.size()];
}

/// The name of a list that a wrong one is most like; empty where none is like it, or the wrong one is no word that is looked up.
inline std::string nearest_name(std::string_view wrong, const std::vector<std::string>& names) {
    constexpr std::size_t longest = 60;            // more is no misprint of a key, and would take long
    constexpr std::size_t letters_a_misprint = 3;  // one in fewer makes another word of it: end, bend
    if (wrong.size() > longest) return "";
    std::size_t fewest = std::max<std::size_t>(wrong.size() / letters_a_misprint, 1) + 1;
    std::string nearest;
    for (const std::string& name : names)
        if (const std::size_t wrongs = misprints(wrong, name); wrongs < fewest && wrongs < name.size())
            fewest = wrongs, nearest = name;
    return nearest;
}

}  // namespace example
