// SPDX-License-Identifier: MIT
#pragma once
/// @file What the figures of summary.json mean, a sentence each: for reports.

#include <algorithm>
#include <iterator>
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
    {"mean_move_over_radius", "the mean of all nodes"},
    {"rms_move_over_radius", "the root mean square of all nodes"},
    {"families", "length and crimp of each family of yarns"},
    {"greatest_penetration_over_radius", "deepest contact element, over the radius"},
    {"least_gap_over_radius", "true least gap between any two fibres, over the radius; negative: in each other"},
    {"least_tool_gap_over_radius", "true least gap between any fibre and any tool, over the radius"},
    {"swelling_in_turn",
     "strain by which sections swell and shrink in turn from node to node: elements are long where it is great"},
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
    // Of loads, forces in the unit of the scene.
    {"case", "load case"},
    {"strain", "of the distance of edges, grips or ends"},
    {"shear", "way of a grip aside, over the height"},
    {"angle_deg", "angle of the load [degree]"},
    {"curvature", "of the arc [1 / length]"},
    {"displacement", "way of the end that is pulled [length]"},
    {"distance", "of the plates [length]"},
    {"stroke", "way of the punch [length]"},
    {"force", "that the load takes [force]"},
    {"contact_force", "sum of what contacts press with [force]"},
    {"moment", "that the load takes [force length]"},
    {"torque", "that the load takes [force length]"},
    {"line_load", "force over length"},
    {"tension", "pull that holds the ends"},
    {"die_force", "on the die"},
    {"greatest_shear_deg", "largest change of the angle between tows at a crossing [degree]"},
    {"pressing", "sum of the normal forces on what is pulled"},
    {"woven_strain", "strain of the part in which tows cross"},
    {"inner_tow_force", "mean force of a tow, the outermost ones left out"},
    {"middle_strain", "strain in the middle of the fabric"},
    {"middle_tow_force", "mean force of the tows in the middle"},
    {"damping_force", "what damping holds; small against the force in a good curve"},
    {"unbalanced_force", "what Newton's method left over"},
    {"connection_misfit", "how far what is tied is from its place [length]"},
    {"frame_error", "how far turned edges are from a rotation"},
    {"crimp_before", "crimp of the warp before the load"},
    {"crimp_after", "crimp of the warp after it"},
    {"initial_stiffness", "slope of the curve over its first fifth"},
    {"fit", "coefficients of 1, x, x^2, x^3 of the curve"},
    {"fit_misfit", "greatest misfit of that, over the greatest value"},
    {"length", "of the sample between grips or plates [length]"},
    {"width", "of the sample across the load [length]"},
    {"gripped_low", "fibres in the lower grip"},
    {"gripped_high", "fibres in the upper grip"},
    {"work", "done by the load [force length]"},
    {"lost_to_friction", "of that work"},
    {"lost_to_damping", "of that work"},
    {"missing_energy", "of that work; what the balance misses"},
    {"external_work", "done by loads and prescribed motion [force length]"},
    {"dissipated", "lost to friction [force length]"},
    {"damped", "taken by damping [force length]"},
    {"released", "let go by fibres that broke [force length]"},
    {"energy_error", "what the balance of energy misses [force length]"},
    // Of single programs.
    {"helix_angle_deg", "angle of the fibres to the axis [degree]"},
    {"torque_of_helices", "closed form of ideal helices"},
    {"line_load_of_helices", "closed form of ideal helices"},
    {"line_load_of_sections", "closed form of sections in a stack"},
    {"section_modulus", "of the closed form [force / length^2]"},
    {"shortening", "length of the rod that is in the knot [length]"},
    {"force_of_loose_knots", "closed form of loose knots without friction"},
    {"imbalance", "how far forces in the loop are from those of a rod without friction"},
    {"radius_over_loop_radius", "near 0: a loose knot"},
    {"wires", "number of wires"},
    {"metal_stiffness", "sum of E A of all wires [force]"},
    {"force_over_metal_stiffness_and_strain", "1: as stiff as straight wires"},
    {"moment_at_plate", "the same moment, at the plate"},
    {"moment_of_loose_wires", "closed form: wires bend one by one"},
    {"moment_of_a_solid", "closed form: wires do not slide"},
    {"furthest_from_layer_over_radius", "how far a wire went outwards from its layer, over its radius"},
    {"lost_in_the_wires", "energy lost to plasticity"},
    {"length_over_radius", "of the strand, over the radius of a wire"},
    {"greatest_stress_over_strength", "of the bundle, over the strength of a single fibre"},
    {"of_a_large_bundle", "the same of very many fibres, a closed form"},
    {"strain_at_it_over_that_of_a_large_bundle", "where the stress is greatest"},
    {"ratio", "pull on both sides of the pin, tight over slack"},
    {"ratio_of_closed_form", "of Euler and Eytelwein, or of the stated law"},
    {"volume_fraction", "fibres over the space between the plates"},
    {"pressure", "on the upper plate [force / length^2]"},
    {"lower_pressure", "on the lower plate; the same at rest"},
    {"contacts_per_fibre", "mean number"},
    {"contacts_without_bulk", "the same if fibres could pass through each other (Komori and Makishima, Toll)"},
    {"exponent", "of the pressure over the volume fraction"},
    {"bonds", "bonding elements between fibres and matrix"},
    {"cells", "hexahedra of the matrix"},
    {"solid_unknowns", "unknowns of the matrix"},
    {"top", "height of the nest [length]"},
    {"weight", "of all fibres [force]"},
    {"wall_seconds", "time of the run [s]"},
    {"cpu_seconds", "processor time [s]"},
    {"peak_memory_bytes", "most memory that was used [byte]"},
    {"seconds_by_stage", "where the time went [s]"},
    {"solver", "linear solver that was used, and why"},
    {"threads", "threads that were used"},
    {"version", "of fibrant"},
};

/// Whether a figure has a sentence of its own.
inline bool is_known(std::string_view key) {
    return std::any_of(std::begin(figure_meanings), std::end(figure_meanings), [&](const auto& one) { return key == one.key; });
}

/// Empty for a figure that is not known.
inline std::string meaning_of(std::string_view key) {
    for (const FigureMeaning& one : figure_meanings)
        if (key == one.key) return one.sentence;
    // Of the edges of a loaded fabric.
    for (const std::string_view edge : {"west_", "east_", "south_", "north_"}) {
        if (!key.starts_with(edge) || key.size() < edge.size() + 1) continue;
        const std::string_view what = key.substr(edge.size());
        if (what.starts_with("turn_")) return "rotation vector of this edge [radian]";
        if (what.starts_with("force_")) return "force on this edge";
        if (what.starts_with("moment_")) return "moment on this edge [force length]";
        return "place of this edge [length]";
    }
    return {};
}

}  // namespace example
