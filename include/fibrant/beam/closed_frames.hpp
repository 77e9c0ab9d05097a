// SPDX-License-Identifier: MIT
#pragma once
/// @file Directors of a closed fibre: they match where it closes, and differ from those at rest by its twist alone.

#include <fibrant/beam/beam_element.hpp>
#include <fibrant/scene/assembly.hpp>

#include <cmath>
#include <numbers>
#include <vector>

namespace fibrant::beam {

/// Frames of a closed fibre where it lies and at rest. Both are carried along without twist and turned evenly, the start
/// until it closes; the rest shape by as much less as the fibre is twisted by.
/// @throws std::invalid_argument if the start does not close
template <BeamElement B>
void closed_frames(const scene::FibreSpecification& fibre, Index nodes, std::vector<scene::NodeFrame>& starts,
                   std::vector<scene::NodeFrame>& frames) {
    starts = scene::reference_frames(fibre.start ? fibre.start : fibre.curve, nodes, fibre.director, true);
    constexpr double turn = 2.0 * std::numbers::pi;
    const double closing = scene::closing_angle(starts) + turn * std::round(fibre.twist / turn);
    if (fibre.straightened()) {
        const auto at = [&](Index k, Index parts) { return fibre.start(static_cast<double>(k) / static_cast<double>(parts)); };
        const auto chords = [&](Index parts) {
            double sum = 0.0;
            for (Index k = 0; k < parts; ++k) sum += (at(k + 1, parts) - at(k, parts)).norm();
            return sum;
        };
        // What chords miss goes with the square of their length; straight elements are chords, and would be stretched.
        const Index fine = 16 * nodes;
        double length = (4.0 * chords(2 * fine) - chords(fine)) / 3.0;
        if constexpr (B::nodes == 2 && !requires { B::centreline_bend_weights(0.0); }) {
            length = 0.0;
            for (std::size_t k = 1; k < starts.size(); ++k) length += (starts[k].position - starts[k - 1].position).norm();
        }
        const scene::NodeFrame& first = starts.front();
        frames = scene::straight_frames(first.position, first.position + length * first.tangent, nodes, first.director_1);
    } else {
        frames = !fibre.start  ? starts
                 : fibre.curve ? scene::reference_frames(fibre.curve, nodes, fibre.director)
                               : scene::straight_frames(fibre.from, fibre.to, nodes, fibre.director);
    }
    scene::turn_along(frames, closing - fibre.twist);
    scene::turn_along(starts, closing);
    starts.back() = starts.front();
    if (!fibre.start && fibre.twist == 0.0) frames.back() = frames.front();
}

}  // namespace fibrant::beam
