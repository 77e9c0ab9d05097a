// SPDX-License-Identifier: MIT
#pragma once
/// @file Loadings, simulators, their reports and checkpoints.

#include <fibrant/simulation/acceptance.hpp>
#include <fibrant/simulation/audit.hpp>
#include <fibrant/simulation/calming.hpp>
#include <fibrant/simulation/checkpoint.hpp>
#include <fibrant/simulation/deep_places.hpp>
#include <fibrant/simulation/energy_account.hpp>
#include <fibrant/simulation/increment_file.hpp>
#include <fibrant/simulation/kept_depth.hpp>
#include <fibrant/simulation/limits.hpp>
#include <fibrant/simulation/loading.hpp>
#include <fibrant/simulation/mean_motion.hpp>
#include <fibrant/simulation/model.hpp>
#include <fibrant/simulation/near_names.hpp>
#include <fibrant/simulation/part_overlaps.hpp>
#include <fibrant/simulation/parting_parameters.hpp>
#include <fibrant/simulation/position.hpp>
#include <fibrant/simulation/programme.hpp>
#include <fibrant/simulation/refined_state.hpp>
#include <fibrant/simulation/report.hpp>
#include <fibrant/simulation/run_file.hpp>
#include <fibrant/simulation/scene_checks.hpp>
#include <fibrant/simulation/scene_difference.hpp>
#include <fibrant/simulation/section_laws.hpp>
#include <fibrant/simulation/settle_parameters.hpp>
#include <fibrant/simulation/settling.hpp>
#include <fibrant/simulation/settling_scales.hpp>
#include <fibrant/simulation/simulator.hpp>
#include <fibrant/simulation/snapshot_of.hpp>
#include <fibrant/simulation/stall.hpp>
#include <fibrant/simulation/state_file.hpp>
#include <fibrant/simulation/step_control.hpp>
#include <fibrant/simulation/stored_state.hpp>
#include <fibrant/simulation/support_wrench.hpp>
#include <fibrant/simulation/watching.hpp>
