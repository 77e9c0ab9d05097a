// SPDX-License-Identifier: MIT
#pragma once
/// @file The contract of what pushes on fibres, and lists of it.

#include <fibrant/term/list.hpp>
#include <fibrant/term/site.hpp>
#include <fibrant/term/stiffness.hpp>
#include <fibrant/term/term.hpp>
