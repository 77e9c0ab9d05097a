// SPDX-License-Identifier: MIT
#pragma once
/// @file Snapshots, figures of them, and all writers of files and pictures.

#include <fibrant/observe/contact_statistics.hpp>
#include <fibrant/observe/csv_writer.hpp>
#include <fibrant/observe/flat_gap.hpp>
#include <fibrant/observe/json.hpp>
#include <fibrant/observe/least_gap.hpp>
#include <fibrant/observe/linking.hpp>
#include <fibrant/observe/loading_curve.hpp>
#include <fibrant/observe/nodal_curve.hpp>
#include <fibrant/observe/observer.hpp>
#include <fibrant/observe/poly_data.hpp>
#include <fibrant/observe/progress_printer.hpp>
#include <fibrant/observe/snapshot.hpp>
#include <fibrant/observe/solid_writer.hpp>
#include <fibrant/observe/surface_gap.hpp>
#include <fibrant/observe/svg.hpp>
#include <fibrant/observe/svg_curves.hpp>
#include <fibrant/observe/svg_plot.hpp>
#include <fibrant/observe/svg_slice.hpp>
#include <fibrant/observe/svg_solid.hpp>
#include <fibrant/observe/svg_view.hpp>
#include <fibrant/observe/swelling.hpp>
#include <fibrant/observe/text_file.hpp>
#include <fibrant/observe/tool_gap.hpp>
#include <fibrant/observe/vtk_writer.hpp>
#include <fibrant/observe/yarn_section.hpp>
