// SPDX-License-Identifier: MIT
#pragma once
/// @file Where channels stood before.

#include <fibrant/scene/channels.hpp>

namespace fibrant::connection {
using scene::Channels;
}  // namespace fibrant::connection
