// SPDX-License-Identifier: MIT
#pragma once
/// @file Models that are compiled once, in the target fibrant::compiled.

#include <fibrant/compiled/rough_fibres.hpp>
