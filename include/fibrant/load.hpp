// SPDX-License-Identifier: MIT
#pragma once
/// @file All loads: terms of the equilibrium.

#include <fibrant/load/applied_load.hpp>
#include <fibrant/load/follower_force.hpp>
#include <fibrant/load/gravity.hpp>
#include <fibrant/load/line_load.hpp>
