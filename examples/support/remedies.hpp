// SPDX-License-Identifier: MIT
#pragma once
/// @file What may help a run that stopped; docs/how-to/messages.md says more of each message.

#include <cstdio>
#include <string>
#include <string_view>

namespace example {

struct Remedy {
    std::string_view of;  ///< words of the reason
    std::string_view help;
};

/// The first whose words a reason has: those that say more of its cause come first.
inline constexpr Remedy remedies[] = {
    {"changes sides with", "more increments, a smaller allowed penetration, shorter elements there"},
    {"leaves through the wall of", "more increments, a smaller allowed penetration, shorter elements where the tube bends"},
    {"flat or inside out", "more increments; check the units; less tension, or stiffer fibres"},
    {"turns at once", "more increments in this stage"},
    {"not positive definite", "hold what is free, more damping in this stage; less tension on soft fibres"},
    {"fibres moved by", "more damping, more increments, or a larger bound if the motion is what you want"},
    {"times as deep as allowed", "a larger allowed penetration; less tension"},
    {"deep in each other at", "shorter elements, or a larger output.deepest_over_radius"},
    {"contact passes do not settle",
     "some friction, more damping in this stage, tension on what is slack, shorter elements in sharp bends"},
    {"multipliers do not settle", "shorter elements, a larger allowed misfit, finer tolerances, or the penalty alone"},
    {"Newton diverged", "more increments"},
    {"Newton did not converge", "more increments, more damping in this stage; tows less tight, or under less tension"},
    {"did not reach its end in", "friction, less tension at the end, more increments"},
};

/// What may help, empty where nothing is known.
constexpr std::string_view remedy(std::string_view reason) {
    for (const Remedy& one : remedies)
        if (reason.find(one.of) != std::string_view::npos) return one.help;
    return {};
}

/// Says it, also if the program is quiet.
inline void tell_remedy(const std::string& reason) {
    const std::string_view help = remedy(reason);
    if (!help.empty())
        std::fprintf(stderr, "what may help: %.*s (docs/how-to/messages.md)\n", static_cast<int>(help.size()), help.data());
}

}  // namespace example
