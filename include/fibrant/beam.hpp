// SPDX-License-Identifier: MIT
#pragma once
/// @file All beams, their section laws and meshes.

#include <fibrant/beam/beam_element.hpp>
#include <fibrant/beam/centre_weights.hpp>
#include <fibrant/beam/closed_frames.hpp>
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/beam/director_beam_with.hpp>
#include <fibrant/beam/director_points.hpp>
#include <fibrant/beam/director_strains.hpp>
#include <fibrant/beam/element_memory.hpp>
#include <fibrant/beam/followed_shape.hpp>
#include <fibrant/beam/kirchhoff_cable.hpp>
#include <fibrant/beam/lagrange.hpp>
#include <fibrant/beam/mesh.hpp>
#include <fibrant/beam/mesh_fibre.hpp>
#include <fibrant/beam/nodal_sums.hpp>
#include <fibrant/beam/on_centreline.hpp>
#include <fibrant/beam/quaternion.hpp>
#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/beam/rigid_section_rod_with.hpp>
#include <fibrant/beam/section_law.hpp>
#include <fibrant/beam/section_material.hpp>
#include <fibrant/beam/section_sides.hpp>
#include <fibrant/beam/with_law.hpp>
