// SPDX-License-Identifier: MIT
#pragma once
/// @file All compositions.

#include <fibrant/compositions/composite/composite.hpp>
#include <fibrant/compositions/composite/composite_parameters.hpp>
#include <fibrant/compositions/composite/edges.hpp>

#include <fibrant/compositions/knot/overhand_knot.hpp>

#include <fibrant/compositions/mat/compaction.hpp>
#include <fibrant/compositions/mat/levels.hpp>
#include <fibrant/compositions/mat/random_mat.hpp>

#include <fibrant/compositions/strand/bending.hpp>
#include <fibrant/compositions/strand/rope.hpp>
#include <fibrant/compositions/strand/rope_parameters.hpp>
#include <fibrant/compositions/strand/strand.hpp>
#include <fibrant/compositions/strand/strand_parameters.hpp>
#include <fibrant/compositions/strand/wire_line.hpp>

#include <fibrant/compositions/textile/assemble.hpp>
#include <fibrant/compositions/textile/audit.hpp>
#include <fibrant/compositions/textile/braids.hpp>
#include <fibrant/compositions/textile/cell_prestress.hpp>
#include <fibrant/compositions/textile/crossings.hpp>
#include <fibrant/compositions/textile/free_ends.hpp>
#include <fibrant/compositions/textile/imported.hpp>
#include <fibrant/compositions/textile/interlaced.hpp>
#include <fibrant/compositions/textile/knits.hpp>
#include <fibrant/compositions/textile/load_cases.hpp>
#include <fibrant/compositions/textile/periodic.hpp>
#include <fibrant/compositions/textile/plies.hpp>
#include <fibrant/compositions/textile/settle.hpp>
#include <fibrant/compositions/textile/strands.hpp>
#include <fibrant/compositions/textile/textile.hpp>
#include <fibrant/compositions/textile/triaxial_weave.hpp>
#include <fibrant/compositions/textile/weaves.hpp>
#include <fibrant/compositions/textile/yarn_contacts.hpp>
#include <fibrant/compositions/textile/yarn_fibres.hpp>
#include <fibrant/compositions/textile/yarn_section.hpp>

#include <fibrant/compositions/two_ply/two_ply.hpp>

#include <fibrant/compositions/weave/audit.hpp>
#include <fibrant/compositions/weave/edges.hpp>
#include <fibrant/compositions/weave/fabric.hpp>
#include <fibrant/compositions/weave/fabric_limits.hpp>
#include <fibrant/compositions/weave/fabric_parameters.hpp>
#include <fibrant/compositions/weave/fibre_figures.hpp>
#include <fibrant/compositions/weave/forming.hpp>
#include <fibrant/compositions/weave/load_cases.hpp>
#include <fibrant/compositions/weave/measures.hpp>
#include <fibrant/compositions/weave/packing.hpp>
#include <fibrant/compositions/weave/pattern.hpp>
#include <fibrant/compositions/weave/periodic.hpp>
#include <fibrant/compositions/weave/repeated.hpp>
#include <fibrant/compositions/weave/settle.hpp>
#include <fibrant/compositions/weave/slices.hpp>
#include <fibrant/compositions/weave/tow_geometry.hpp>
#include <fibrant/compositions/weave/tow_section.hpp>
#include <fibrant/compositions/weave/waved_path.hpp>
