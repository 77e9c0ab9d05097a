// SPDX-License-Identifier: MIT
#pragma once
/// @file Equilibrium and its linear system.

#include <fibrant/assembly/band_product.hpp>
#include <fibrant/assembly/chain_rows.hpp>
#include <fibrant/assembly/chain_system.hpp>
#include <fibrant/assembly/equilibrium.hpp>
#include <fibrant/assembly/linear_system.hpp>
#include <fibrant/assembly/particle_blocks.hpp>
#include <fibrant/assembly/point_product.hpp>
#include <fibrant/assembly/residual_figures.hpp>
#include <fibrant/assembly/slide_products.hpp>
#include <fibrant/assembly/solid_system.hpp>
#include <fibrant/assembly/stiffness_sink.hpp>
#include <fibrant/assembly/system_view.hpp>
#include <fibrant/assembly/term_assembly.hpp>
#include <fibrant/assembly/terms.hpp>
#include <fibrant/assembly/vector_measures.hpp>
#include <fibrant/assembly/visited_system.hpp>
