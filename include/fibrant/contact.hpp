// SPDX-License-Identifier: MIT
#pragma once
/// @file Contact elements between fibres and with tools.

#include <fibrant/contact/allowed_depth.hpp>
#include <fibrant/contact/closest_places.hpp>
#include <fibrant/contact/contact_detection.hpp>
#include <fibrant/contact/contact_element.hpp>
#include <fibrant/contact/contact_figures.hpp>
#include <fibrant/contact/contact_parameters.hpp>
#include <fibrant/contact/contact_record.hpp>
#include <fibrant/contact/contact_set.hpp>
#include <fibrant/contact/contact_tangent.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/contact/element_directions.hpp>
#include <fibrant/contact/element_normal.hpp>
#include <fibrant/contact/fibre_patch.hpp>
#include <fibrant/contact/followed_places.hpp>
#include <fibrant/contact/intermediate_geometry.hpp>
#include <fibrant/contact/learned_contacts.hpp>
#include <fibrant/contact/meeting_point.hpp>
#include <fibrant/contact/normal_direction.hpp>
#include <fibrant/contact/oval_place.hpp>
#include <fibrant/contact/overlaps.hpp>
#include <fibrant/contact/pair_rules.hpp>
#include <fibrant/contact/particle.hpp>
#include <fibrant/contact/passage.hpp>
#include <fibrant/contact/section_extents.hpp>
#include <fibrant/contact/section_gap.hpp>
#include <fibrant/contact/seen_touch.hpp>
#include <fibrant/contact/side_index.hpp>
#include <fibrant/contact/sliding_place.hpp>
#include <fibrant/contact/station_pairs.hpp>
#include <fibrant/contact/support.hpp>
#include <fibrant/contact/tool_contacts.hpp>
#include <fibrant/contact/tool_element.hpp>
#include <fibrant/contact/watched_places.hpp>
#include <fibrant/contact/zone_stiffness.hpp>
