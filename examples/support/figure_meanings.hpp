// SPDX-License-Identifier: MIT
#pragma once
/// @file What the figures of summary.json mean, a sentence each: for reports.

#include <string>
#include <string_view>

namespace example {

struct FigureMeaning {
    const char* key;
    const char* sentence;
};

inline constexpr FigureMeaning figure_meanings[] = {
    {"converged", "forces balance at the end of every stage"},
    {"audit_clean", "no two fibres are deeper in each other than allowed, anywhere"},
    {"topology_clean", "every yarn lies above and below the others as the textile says"},
    {"reason", "why the run stopped early"},
    {"textile", "kind of textile"},
    {"yarns", "number of yarns"},
    {"fibres", "fibres that were computed"},
    {"nodes", "nodes of all fibres"},
    {"dofs", "unknowns"},
    {"contact_elements", "contact elements at the end, open ones too"},
    {"active_contacts", "contact elements that press"},
    {"increments", "accepted increments"},
    {"rejected_increments", "attempts that were given up"},
    {"newton_iterations", "iterations of Newton's method"},
    {"linear_solves", "linear systems that were solved"},
    {"linear_iterations", "iterations of the linear solver"},
    {"crossings", "pairs of fibres or yarns that cross"},
    {"right_crossings", "crossings as the textile says"},
    {"wrong_crossings", "crossings the other way round"},
    {"missing_crossings", "crossings that are not there"},
    {"extra_crossings", "crossings that nobody asked for"},
    {"linked_pairs", "pairs of yarns whose links are compared"},
    {"links_changed", "of these, pairs that went through each other"},
    {"greatest_linking_change", "change of the linking integral; below 0.5 nothing went through"},
    {"greatest_move_over_radius", "how far a point moved from where it was drawn, over the radius"},
    {"families", "length and crimp of each family of yarns"},
    {"greatest_penetration_over_radius", "deepest contact element, over the radius"},
    {"least_gap_over_radius", "true least gap between any two fibres, over the radius; negative: in each other"},
    {"deepest_allowed_over_radius", "how deep fibres may be in each other, over the radius"},
    {"least_gap_fibre_i", "one fibre of that pair"},
    {"least_gap_fibre_j", "the other fibre of that pair"},
    {"least_gap_x", "where that is [length]"},
    {"least_gap_y", "where that is [length]"},
    {"least_gap_z", "where that is [length]"},
    {"residual_over_tolerance", "what is out of balance at the end, over what is allowed"},
    {"penetration_over_allowed", "deepest zone at the end, over what is allowed"},
    {"most_residual_over_tolerance", "the same, the most of any increment; stages on the way may be loose"},
    {"most_penetration_over_allowed", "the same, the most of any increment; stages on the way may be loose"},
    {"crimp_warp", "length of a warp fibre over its chord, less one"},
    {"crimp_weft", "length of a weft fibre over its chord, less one"},
    {"thickness", "of the fabric [length]"},
    {"energy_error_over_work", "what the energy balance misses, over what was turned over"},
    {"wall_seconds", "time of the run [s]"},
    {"cpu_seconds", "processor time [s]"},
    {"peak_memory_bytes", "most memory that was used [byte]"},
    {"seconds_by_stage", "where the time went [s]"},
    {"solver", "linear solver that was used, and why"},
    {"threads", "threads that were used"},
    {"version", "of fibrant"},
};

/// Empty for a figure that is not known.
inline std::string meaning_of(std::string_view key) {
    for (const FigureMeaning& one : figure_meanings)
        if (key == one.key) return one.sentence;
    return {};
}

}  // namespace example
