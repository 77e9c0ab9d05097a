// SPDX-License-Identifier: MIT
#pragma once
/// @file The row of increments.csv that every program writes.

#include <fibrant/observe/csv_writer.hpp>
#include <fibrant/simulation/report.hpp>

#include <vector>

namespace example {

/// What is known of an accepted increment, in the order of docs/reference/files.md.
/// @param radius  of the thinnest fibre [length]
/// @param own     of the program, behind `progress`
inline std::vector<fibrant::observe::Column> increment_columns(const fibrant::simulation::IncrementReport& increment,
                                                               double radius,
                                                               const std::vector<fibrant::observe::Column>& own = {}) {
    using fibrant::observe::Column;
    const auto& counts = increment.counts;
    const auto& contact = increment.contact;
    const auto& energy = increment.energy;
    std::vector<Column> columns{{"increment", increment.number},
                                {"stage", increment.stage},
                                {"stage_progress", increment.stage_progress},
                                {"progress", increment.progress}};
    columns.insert(columns.end(), own.begin(), own.end());
    const std::vector<Column> rest{{"fraction", increment.fraction},
                                   {"cuts", increment.cuts},
                                   {"contact_passes", counts.contact_passes},
                                   {"normal_passes", counts.normal_passes},
                                   {"newton_iterations", counts.newton},
                                   {"linear_solves", counts.linear_solves},
                                   {"linear_iterations", counts.linear_iterations},
                                   {"indefinite_tangents", counts.indefinite},
                                   {"residual", increment.residual},
                                   {"displacement_over_radius", increment.displacement / radius},
                                   {"damping_share", increment.damping},
                                   {"springs", increment.springs},
                                   {"hardest_springs", increment.hardest_springs},
                                   {"contact_elements", contact.elements},
                                   {"active_contacts", contact.active},
                                   {"limited_gaps", contact.shifted},
                                   {"greatest_penetration_over_radius", contact.greatest_penetration / radius},
                                   {"reaction_sum", contact.reaction_sum},
                                   {"elastic_energy", energy.elastic},
                                   {"contact_energy", energy.contact},
                                   {"external_work", energy.external},
                                   {"dissipated", energy.dissipated},
                                   {"damped", energy.damped},
                                   {"rearranged", energy.rearranged},
                                   {"released", energy.released},
                                   {"energy_error", energy.error()},
                                   {"seconds", increment.seconds}};
    columns.insert(columns.end(), rest.begin(), rest.end());
    return columns;
}

}  // namespace example
