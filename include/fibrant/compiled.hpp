// SPDX-License-Identifier: MIT
#pragma once
/// @file Models and strategies that are compiled once, in the target fibrant::compiled.

#include <fibrant/compiled/rough_fibres.hpp>
#include <fibrant/compiled/solvers.hpp>
