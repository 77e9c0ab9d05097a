// SPDX-License-Identifier: MIT
#pragma once
/// @file Hexahedra, their law, and meshers.

#include <fibrant/solid/cell_search.hpp>
#include <fibrant/solid/fibre_surface.hpp>
#include <fibrant/solid/hexahedron.hpp>
#include <fibrant/solid/hexahedron_map.hpp>
#include <fibrant/solid/layer_mesher.hpp>
#include <fibrant/solid/no_solid.hpp>
#include <fibrant/solid/solid_law.hpp>
