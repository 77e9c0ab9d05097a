// SPDX-License-Identifier: MIT
#pragma once
/// @file All ways to find which fibres are near each other.

#include <fibrant/proximity/automatic_search.hpp>
#include <fibrant/proximity/box_columns.hpp>
#include <fibrant/proximity/box_tree.hpp>
#include <fibrant/proximity/boxes.hpp>
#include <fibrant/proximity/brute_search.hpp>
#include <fibrant/proximity/bvh_search.hpp>
#include <fibrant/proximity/candidate_sink.hpp>
#include <fibrant/proximity/cell_grid.hpp>
#include <fibrant/proximity/closed_zones.hpp>
#include <fibrant/proximity/exact_filter.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/proximity/kd_tree_search.hpp>
#include <fibrant/proximity/moving_segments.hpp>
#include <fibrant/proximity/near_part.hpp>
#include <fibrant/proximity/proximity_search.hpp>
#include <fibrant/proximity/segment_distance.hpp>
#include <fibrant/proximity/segment_table.hpp>
#include <fibrant/proximity/sorted_pairs.hpp>
#include <fibrant/proximity/test_point_search.hpp>
#include <fibrant/proximity/verlet_search.hpp>
#include <fibrant/proximity/zones.hpp>
