// SPDX-License-Identifier: MIT
#pragma once
/// @file The iteration and all strategies for linear systems, but those that need a library of their own.

#include <fibrant/solver/any_solver.hpp>
#include <fibrant/solver/attempt_report.hpp>
#include <fibrant/solver/automatic_solver.hpp>
#include <fibrant/solver/block_band_cholesky.hpp>
#include <fibrant/solver/block_cholesky.hpp>
#include <fibrant/solver/chain_closing.hpp>
#include <fibrant/solver/chain_clusters.hpp>
#include <fibrant/solver/chain_couplings.hpp>
#include <fibrant/solver/chain_factors.hpp>
#include <fibrant/solver/chain_sweeps.hpp>
#include <fibrant/solver/coarse_couplings.hpp>
#include <fibrant/solver/coarse_ties.hpp>
#include <fibrant/solver/compressed_panel.hpp>
#include <fibrant/solver/confirmed.hpp>
#include <fibrant/solver/conjugate_gradient.hpp>
#include <fibrant/solver/dense_elimination.hpp>
#include <fibrant/solver/dissection.hpp>
#include <fibrant/solver/fibre_block_pcg.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>
#include <fibrant/solver/linear_solver.hpp>
#include <fibrant/solver/nested_loops.hpp>
#include <fibrant/solver/newton.hpp>
#include <fibrant/solver/one_of.hpp>
#include <fibrant/solver/recording_solver.hpp>
#include <fibrant/solver/rigid_coarse_space.hpp>
#include <fibrant/solver/saved_system.hpp>
#include <fibrant/solver/solid_pcg.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>
#include <fibrant/solver/stabilised_biconjugate_gradient.hpp>
#include <fibrant/solver/supernodes.hpp>
#include <fibrant/solver/tied_chains.hpp>
#include <fibrant/solver/tolerance_use.hpp>
#include <fibrant/solver/two_level_pcg.hpp>
