// SPDX-License-Identifier: MIT
#pragma once
/// @file A run that several ranks share: exchange between them, subdomains, and a solver whose bits no number of ranks changes.
/// Ranks by MPI are in fibrant/distributed/mpi_exchange.hpp, for those who link it.

#include <fibrant/distributed/agreement.hpp>
#include <fibrant/distributed/chain_joints.hpp>
#include <fibrant/distributed/cut_report.hpp>
#include <fibrant/distributed/exchange.hpp>
#include <fibrant/distributed/halo.hpp>
#include <fibrant/distributed/pair_terms.hpp>
#include <fibrant/distributed/part_product.hpp>
#include <fibrant/distributed/piece_system.hpp>
#include <fibrant/distributed/rank_use.hpp>
#include <fibrant/distributed/routes.hpp>
#include <fibrant/distributed/shared_fibres.hpp>
#include <fibrant/distributed/shared_ties.hpp>
#include <fibrant/distributed/subdomain_levels.hpp>
#include <fibrant/distributed/subdomain_pcg.hpp>
#include <fibrant/distributed/subdomains.hpp>
#include <fibrant/distributed/thread_ranks.hpp>
