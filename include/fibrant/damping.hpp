// SPDX-License-Identifier: MIT
#pragma once
/// @file Damping: springs to last places.

#include <fibrant/damping/place_springs.hpp>
