// SPDX-License-Identifier: MIT
#pragma once
/// @file What two runs say that they are of, compared.

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fibrant::simulation {

/// Value of a name in lines "name = value"; null where the name is not there.
inline const char* scene_value(std::string_view scene, std::string_view name, std::size_t& size) {
    for (std::size_t from = 0; from < scene.size();) {
        const std::size_t end = std::min(scene.find('\n', from), scene.size());
        const std::string_view line = scene.substr(from, end - from);
        if (line.size() >= name.size() + 3 && line.substr(0, name.size()) == name && line.substr(name.size(), 3) == " = ") {
            size = line.size() - name.size() - 3;
            return line.data() + name.size() + 3;
        }
        from = end + 1;
    }
    return nullptr;
}

/// Names that both have and whose values differ, up to three of them: "a (1 there and 2 here), ...". Empty if there are none.
/// @param sections  only names that begin with one of these and a point are compared; empty: all
inline std::string scene_difference(std::string_view there, std::string_view here,
                                    const std::vector<std::string>& sections = {}) {
    std::string text;
    int found = 0;
    for (std::size_t from = 0; from < here.size();) {
        const std::size_t end = std::min(here.find('\n', from), here.size());
        const std::string_view line = here.substr(from, end - from);
        from = end + 1;
        const std::size_t equals = line.find(" = ");
        if (equals == std::string_view::npos) continue;
        const std::string_view name = line.substr(0, equals), own = line.substr(equals + 3);
        const auto within = [&](const std::string& section) { return name.substr(0, section.size() + 1) == section + "."; };
        if (!sections.empty() && std::none_of(sections.begin(), sections.end(), within)) continue;
        std::size_t size = 0;
        const char* value = scene_value(there, name, size);
        if (value == nullptr || std::string_view(value, size) == own) continue;
        if (++found > 3) return text + ", and more";
        text += (text.empty() ? "" : ", ") + std::string(name) + " (" + std::string(value, size) + " there and " +
                std::string(own) + " here)";
    }
    return text;
}

}  // namespace fibrant::simulation
