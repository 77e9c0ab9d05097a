// SPDX-License-Identifier: MIT
#pragma once
/// @file A scene as data: fibres, what is imposed on them, tools, solids.

#include <fibrant/scene/assembly.hpp>
#include <fibrant/scene/channels.hpp>
#include <fibrant/scene/conditions.hpp>
#include <fibrant/scene/cross_section.hpp>
#include <fibrant/scene/dof_layout.hpp>
#include <fibrant/scene/elastic_material.hpp>
#include <fibrant/scene/image_vectors.hpp>
#include <fibrant/scene/places.hpp>
#include <fibrant/scene/reference_shape.hpp>
#include <fibrant/scene/rigid_body.hpp>
#include <fibrant/scene/solid.hpp>
#include <fibrant/scene/spline.hpp>
#include <fibrant/scene/tied_vectors.hpp>
#include <fibrant/scene/tool.hpp>
#include <fibrant/scene/tool_surface.hpp>
#include <fibrant/scene/triangle_surface.hpp>
#include <fibrant/scene/tube.hpp>
