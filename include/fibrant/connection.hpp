// SPDX-License-Identifier: MIT
#pragma once
/// @file What is imposed, tied and bonded.

#include <fibrant/connection/body_motion.hpp>
#include <fibrant/connection/bonded_solid.hpp>
#include <fibrant/connection/bonding.hpp>
#include <fibrant/connection/carriers.hpp>
#include <fibrant/connection/channels.hpp>
#include <fibrant/connection/connections.hpp>
#include <fibrant/connection/coordinate_groups.hpp>
#include <fibrant/connection/fibre_bonds.hpp>
#include <fibrant/connection/image_bends.hpp>
#include <fibrant/connection/prescribed_motion.hpp>
#include <fibrant/connection/rigid_bodies.hpp>
#include <fibrant/connection/solid_places.hpp>
#include <fibrant/connection/turned_work.hpp>
