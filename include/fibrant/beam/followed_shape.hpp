// SPDX-License-Identifier: MIT
#pragma once
/// @file Shapes of fibres as elements and sections can follow them: what is too curved, or of another length than it should be,
/// is refused.

#include <fibrant/beam/closed_frames.hpp>
#include <fibrant/scene/assembly.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::beam {

/// Turn of a centreline within an element [degree]: beyond it the element is no curve of that turn any more.
inline constexpr double greatest_turn_deg = 90.0;
/// Curvature over that at which the inside of a section folds over [1].
inline constexpr double greatest_fold = 1.0;
/// Strain of a fibre that is as long where a run begins as it is at rest [1]: what is meant to be stretched is stretched by a
/// load.
inline constexpr double greatest_start_strain = 0.01;

/// Throws std::invalid_argument where a curve turns by more than its elements or its sections can follow.
/// @param per_element  node intervals of an element, >= 1
/// @param radius       of the section, the lesser one: flat fibres bend over it [length]
/// @param name         what messages call the curve
inline void require_followed(const scene::ReferenceShape& shape, Index per_element, double radius, const std::string& name) {
    const double spacing = shape.length / static_cast<double>(shape.turn.size());
    const auto where = [&](Index first, Index last) {
        return " (element " + std::to_string(first / per_element) + ", from " +
               scene::text(shape.frames[core::at(first)].position) + " to " + scene::text(shape.frames[core::at(last)].position) +
               ")";
    };
    for (Index first = 0; first < core::count(shape.turn); first += per_element) {
        const Index last = std::min(first + per_element, core::count(shape.turn));
        double turn = 0.0, sharpest = 0.0;
        for (Index k = first; k < last; ++k)
            turn += shape.turn[core::at(k)], sharpest = std::max(sharpest, shape.turn[core::at(k)]);
        const double degrees = turn * 180.0 / std::numbers::pi, fold = radius * sharpest / spacing;
        if (!(degrees <= greatest_turn_deg + 1e-3))  // of differences over sixteen steps
            core::refuse(name + ": turn [degree]", core::text(degrees),
                         "<= " + core::text(greatest_turn_deg) + " within an element: more elements, or a smoother curve" +
                             where(first, last));
        if (!(fold <= greatest_fold))
            core::refuse(
                name + ": radius of the section times curvature", core::text(fold),
                "<= " + core::text(greatest_fold) + ": beyond it a section folds into the next one" + where(first, last));
    }
}

/// Throws std::invalid_argument where a fibre begins with another length than it has at rest.
inline void require_as_long(double start, double rest) {
    const double strain = start / rest - 1.0;
    core::require(std::abs(strain) <= greatest_start_strain, "fibre.start: length over that at rest", start / rest,
                  "within " + core::text(greatest_start_strain) + " of 1");
}

/// Frames of a fibre where a run begins and at rest.
/// @throws std::invalid_argument if there is no fibre of such a shape
template <BeamElement B>
void cut_fibre(const scene::FibreSpecification& fibre, Index nodes, std::vector<scene::NodeFrame>& starts,
               std::vector<scene::NodeFrame>& frames) {
    const auto shape_of = [&](const scene::Curve& curve, const std::string& name, bool closed) {
        scene::ReferenceShape shape = scene::reference_shape(curve, nodes, fibre.director, name, closed);
        require_followed(shape, B::nodes - 1, std::min(fibre.section.semi_axis_1, fibre.section.semi_axis_2), name);
        return shape;
    };
    scene::ReferenceShape rest, begun;
    if (fibre.curve)
        rest = shape_of(fibre.curve, "fibre.curve", fibre.closed && !fibre.start);
    else if (!fibre.straightened())
        rest = {scene::straight_frames(fibre.from, fibre.to, nodes, fibre.director), {}, (fibre.to - fibre.from).norm()};
    if (fibre.start) begun = shape_of(fibre.start, "fibre.start", fibre.closed);
    if (fibre.start && !fibre.straightened()) require_as_long(begun.length, rest.length);
    if constexpr (CentrelineOnly<B>)
        core::require(fibre.twist == 0.0, "fibre.twist", fibre.twist, "0, of a beam that does not turn");
    if (fibre.closed) return closed_frames<B>(fibre, nodes, starts, frames);
    frames = std::move(rest.frames);
    starts = fibre.start ? std::move(begun.frames) : frames;
    if (fibre.twist != 0.0) scene::turn_along(starts, fibre.twist);
    if (!fibre.repeats) return;
    const double closing = scene::closing_angle(starts);
    scene::turn_along(frames, closing), scene::turn_along(starts, closing);
}

}  // namespace fibrant::beam
