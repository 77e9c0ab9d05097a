// SPDX-License-Identifier: MIT
#pragma once
/// @file All normal and friction laws.

#include <fibrant/law/augmented.hpp>
#include <fibrant/law/coulomb_friction.hpp>
#include <fibrant/law/directed_friction.hpp>
#include <fibrant/law/friction_law.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/impact.hpp>
#include <fibrant/law/limited_gap.hpp>
#include <fibrant/law/linear_penalty.hpp>
#include <fibrant/law/normal_law.hpp>
#include <fibrant/law/physical_normal.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/law/shaped_friction.hpp>
#include <fibrant/law/smooth_coulomb.hpp>
