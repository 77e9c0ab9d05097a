// SPDX-License-Identifier: MIT
#pragma once
/// @file Everything: the folders in the order of the computation, then the compositions.

#include <fibrant/core/large_array.hpp>
#include <fibrant/core/parallel.hpp>
#include <fibrant/core/parameters.hpp>
#include <fibrant/core/rotation.hpp>
#include <fibrant/core/stage_clock.hpp>
#include <fibrant/core/types.hpp>

#include <fibrant/scene/assembly.hpp>
#include <fibrant/scene/conditions.hpp>
#include <fibrant/scene/cross_section.hpp>
#include <fibrant/scene/dof_layout.hpp>
#include <fibrant/scene/elastic_material.hpp>
#include <fibrant/scene/reference_shape.hpp>
#include <fibrant/scene/rigid_body.hpp>
#include <fibrant/scene/tied_vectors.hpp>
#include <fibrant/scene/solid.hpp>
#include <fibrant/scene/tool.hpp>

#include <fibrant/beam/beam_element.hpp>
#include <fibrant/beam/centre_weights.hpp>
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/beam/kirchhoff_cable.hpp>
#include <fibrant/beam/mesh.hpp>
#include <fibrant/beam/on_centreline.hpp>
#include <fibrant/beam/quaternion.hpp>
#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/beam/section_law.hpp>

#include <fibrant/solid/cell_search.hpp>
#include <fibrant/solid/fibre_surface.hpp>
#include <fibrant/solid/hexahedron.hpp>
#include <fibrant/solid/hexahedron_map.hpp>
#include <fibrant/solid/layer_mesher.hpp>
#include <fibrant/solid/no_solid.hpp>
#include <fibrant/solid/solid_law.hpp>

#include <fibrant/proximity/brute_search.hpp>
#include <fibrant/proximity/bvh_search.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/proximity/kd_tree_search.hpp>
#include <fibrant/proximity/proximity_search.hpp>
#include <fibrant/proximity/segment_distance.hpp>
#include <fibrant/proximity/test_point_search.hpp>
#include <fibrant/proximity/verlet_search.hpp>
#include <fibrant/proximity/zones.hpp>

#include <fibrant/law/augmented.hpp>
#include <fibrant/law/friction_law.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/limited_gap.hpp>
#include <fibrant/law/linear_penalty.hpp>
#include <fibrant/law/normal_law.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/law/smooth_coulomb.hpp>

#include <fibrant/contact/contact_detection.hpp>
#include <fibrant/contact/contact_element.hpp>
#include <fibrant/contact/contact_record.hpp>
#include <fibrant/contact/contact_set.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/contact/intermediate_geometry.hpp>
#include <fibrant/contact/meeting_point.hpp>
#include <fibrant/contact/normal_direction.hpp>
#include <fibrant/contact/pair_rules.hpp>
#include <fibrant/contact/side_index.hpp>
#include <fibrant/contact/station_pairs.hpp>
#include <fibrant/contact/support.hpp>
#include <fibrant/contact/tool_contacts.hpp>
#include <fibrant/contact/tool_element.hpp>
#include <fibrant/contact/zone_stiffness.hpp>

#include <fibrant/connection/applied_load.hpp>
#include <fibrant/connection/body_motion.hpp>
#include <fibrant/connection/bonded_solid.hpp>
#include <fibrant/connection/bonding.hpp>
#include <fibrant/connection/carriers.hpp>
#include <fibrant/connection/channels.hpp>
#include <fibrant/connection/connections.hpp>
#include <fibrant/connection/prescribed_motion.hpp>
#include <fibrant/connection/rigid_bodies.hpp>

#include <fibrant/assembly/chain_system.hpp>
#include <fibrant/assembly/equilibrium.hpp>
#include <fibrant/assembly/linear_system.hpp>
#include <fibrant/assembly/solid_system.hpp>
#include <fibrant/assembly/term_assembly.hpp>
#include <fibrant/assembly/terms.hpp>
#include <fibrant/assembly/visited_system.hpp>

#include <fibrant/solver/any_solver.hpp>
#include <fibrant/solver/automatic_solver.hpp>
#include <fibrant/solver/fibre_block_pcg.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>
#include <fibrant/solver/linear_solver.hpp>
#include <fibrant/solver/nested_loops.hpp>
#include <fibrant/solver/newton.hpp>
#include <fibrant/solver/recording_solver.hpp>
#include <fibrant/solver/saved_system.hpp>
#include <fibrant/solver/solid_pcg.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

#include <fibrant/observe/contact_statistics.hpp>
#include <fibrant/observe/csv_writer.hpp>
#include <fibrant/observe/json.hpp>
#include <fibrant/observe/least_gap.hpp>
#include <fibrant/observe/loading_curve.hpp>
#include <fibrant/observe/nodal_curve.hpp>
#include <fibrant/observe/observer.hpp>
#include <fibrant/observe/progress_printer.hpp>
#include <fibrant/observe/snapshot.hpp>
#include <fibrant/observe/svg_curves.hpp>
#include <fibrant/observe/solid_writer.hpp>
#include <fibrant/observe/svg_plot.hpp>
#include <fibrant/observe/svg_slice.hpp>
#include <fibrant/observe/svg_solid.hpp>
#include <fibrant/observe/svg_view.hpp>
#include <fibrant/observe/vtk_writer.hpp>

#include <fibrant/simulation/checkpoint.hpp>
#include <fibrant/simulation/energy_account.hpp>
#include <fibrant/simulation/increment_file.hpp>
#include <fibrant/simulation/loading.hpp>
#include <fibrant/simulation/model.hpp>
#include <fibrant/simulation/programme.hpp>
#include <fibrant/simulation/position.hpp>
#include <fibrant/simulation/refined_state.hpp>
#include <fibrant/simulation/report.hpp>
#include <fibrant/simulation/simulator.hpp>
#include <fibrant/simulation/snapshot_of.hpp>
#include <fibrant/simulation/state_file.hpp>
#include <fibrant/simulation/stored_state.hpp>
#include <fibrant/simulation/support_wrench.hpp>

#include <fibrant/compositions/composite/composite.hpp>
#include <fibrant/compositions/composite/composite_parameters.hpp>
#include <fibrant/compositions/composite/edges.hpp>

#include <fibrant/compositions/knot/overhand_knot.hpp>
#include <fibrant/compositions/mat/random_mat.hpp>
#include <fibrant/compositions/strand/bending.hpp>
#include <fibrant/compositions/strand/strand.hpp>
#include <fibrant/compositions/strand/strand_parameters.hpp>
#include <fibrant/compositions/two_ply/two_ply.hpp>

#include <fibrant/compositions/weave/audit.hpp>
#include <fibrant/compositions/weave/edges.hpp>
#include <fibrant/compositions/weave/fabric.hpp>
#include <fibrant/compositions/weave/fabric_parameters.hpp>
#include <fibrant/compositions/weave/fibre_figures.hpp>
#include <fibrant/compositions/weave/load_cases.hpp>
#include <fibrant/compositions/weave/measures.hpp>
#include <fibrant/compositions/weave/packing.hpp>
#include <fibrant/compositions/weave/pattern.hpp>
#include <fibrant/compositions/weave/periodic.hpp>
#include <fibrant/compositions/weave/repeated.hpp>
#include <fibrant/compositions/weave/settle.hpp>
#include <fibrant/compositions/weave/slices.hpp>
#include <fibrant/compositions/weave/tow_section.hpp>
