// SPDX-License-Identifier: MIT
#pragma once
/// @file Files that other programs read and write: centrelines in, and centrelines, surfaces and voxels out.

#include <fibrant/exchange/binary_curves.hpp>
#include <fibrant/exchange/curves.hpp>
#include <fibrant/exchange/files.hpp>
#include <fibrant/exchange/surface_files.hpp>
#include <fibrant/exchange/text_curves.hpp>
#include <fibrant/exchange/tubes.hpp>
#include <fibrant/exchange/voxel_tables.hpp>
#include <fibrant/exchange/voxels.hpp>
#include <fibrant/exchange/yarn_surfaces.hpp>
