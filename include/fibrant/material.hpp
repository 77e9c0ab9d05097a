// SPDX-License-Identifier: MIT
#pragma once
/// @file All laws of sections beyond the one that a beam has by itself.

#include <fibrant/material/brittle.hpp>
#include <fibrant/material/composed.hpp>
#include <fibrant/material/damped.hpp>
#include <fibrant/material/eigenstrain.hpp>
#include <fibrant/material/elastic.hpp>
#include <fibrant/material/viscoelastic.hpp>
#include <fibrant/material/wire.hpp>
