// SPDX-License-Identifier: MIT
#pragma once
/// @file What everything stands on: types, parameters, parallel loops.

#include <fibrant/core/blocks.hpp>
#include <fibrant/core/config.hpp>
#include <fibrant/core/eigen_threads.hpp>
#include <fibrant/core/few_of.hpp>
#include <fibrant/core/large_array.hpp>
#include <fibrant/core/ordering.hpp>
#include <fibrant/core/parallel.hpp>
#include <fibrant/core/parameters.hpp>
#include <fibrant/core/rotation.hpp>
#include <fibrant/core/small_matrix.hpp>
#include <fibrant/core/stage_clock.hpp>
#include <fibrant/core/symmetric_eigen.hpp>
#include <fibrant/core/types.hpp>
#include <fibrant/core/vector_units.hpp>
#include <fibrant/core/vectors.hpp>
