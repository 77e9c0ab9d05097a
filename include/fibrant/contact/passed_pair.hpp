// SPDX-License-Identifier: MIT
#pragma once
/// @file Two that a motion takes through each other, and what is said of them.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>

#include <cmath>
#include <string>

namespace fibrant::contact {

/// The first two that a motion takes through each other.
struct PassedPair {
    Index fibre = -1, other = -1;  ///< fibres, the same one twice, or a fibre and a tool
    bool tool = false;
    bool bore = false;                      ///< `other` is a tube that the fibre is in, and leaves through the wall
    bool image = false;                     ///< `other` is not the fibre itself but its image across a seam of a cell
    double along = 0.0, along_other = 0.0;  ///< where on the fibres, over their rest lengths, in [0, 1]; 0 for a tool
    Vec3 place =
        Vec3::Zero();  ///< half way between the two when they are too close; of a tool, on the fibre as it is at the end [length]
    double motion = 0.0;  ///< of one against the other [length]
    double left = 0.0;    ///< distance of the two at the end over their half widths; 0 for a tool
    double time = 0.0;    ///< when they are too close, in [0, 1]
    /// When the first of all that pass touch, in [0, 1]: up to there the motion is sound.
    double touch = 0.0;
};

/// For a report.
inline std::string text(const PassedPair& pair) {
    const auto at = [](double along) { return " at " + core::text(std::round(1e4 * along) / 1e4) + " of its length"; };
    std::string what = "fibre " + std::to_string(pair.fibre) + at(pair.along) +
                       (pair.bore ? " leaves through the wall of " : " changes sides with ");
    what += pair.tool    ? "tool " + std::to_string(pair.other)
            : pair.image ? "the image of fibre " + std::to_string(pair.other) + " across a seam" + at(pair.along_other)
            : pair.fibre == pair.other ? "itself" + at(pair.along_other)
                                       : "fibre " + std::to_string(pair.other) + at(pair.along_other);
    what += ", near (";
    for (int axis = 0; axis < 3; ++axis) what += (axis > 0 ? ", " : "") + core::text(pair.place[axis]);
    what += "), in a motion of " + core::text(pair.motion) + " against each other";
    return pair.tool || pair.bore
               ? what
               : what + ", after which they are " + core::text(std::round(1e4 * pair.left) / 1e4) + " of touching apart";
}

}  // namespace fibrant::contact
