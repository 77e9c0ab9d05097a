// SPDX-License-Identifier: MIT
#pragma once
/// @file Lines of progress, on the standard output.

#include <fibrant/observe/progress_printer.hpp>

#include <iostream>
#include <ostream>

namespace example {

/// @param radius   of the thinnest fibre [length]
/// @param figures  of the example's own, at the end of a line
/// @param quiet    prints nothing
inline fibrant::observe::ProgressPrinter progress_printer(double radius, fibrant::Index figures, bool quiet) {
    static std::ostream nowhere(nullptr);
    return {{.radius = radius, .figures = figures}, quiet ? nowhere : std::cout};
}

}  // namespace example
