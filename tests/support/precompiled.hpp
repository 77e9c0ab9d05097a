// SPDX-License-Identifier: MIT
#pragma once
/// @file Headers that most tests include, precompiled once where tests are joined.

#include <near.hpp>
#include <refusal.hpp>
#include <support/models.hpp>

#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/compiled/solvers.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/observe/least_gap.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>
