// SPDX-License-Identifier: MIT
#pragma once
/// @file Rest shape of a fibre: nodes at equal arc length on a curve, with directors that do not twist about it.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>
#include <fibrant/scene/places.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace fibrant::scene {

/// Centreline position as a function of a parameter in [0, 1]; evaluated inside that interval only.
using Curve = std::function<Vec3(double)>;

/// Frame of a section at rest: unit and orthogonal, director_1 x director_2 = tangent.
struct NodeFrame {
    Vec3 position = Vec3::Zero();
    Vec3 tangent = Vec3::UnitZ();
    Vec3 director_1 = Vec3::UnitX();
    Vec3 director_2 = Vec3::UnitY();
    /// Columns g_1, g_2, tangent: section components to space.
    Mat3 basis() const { return core::columns(director_1, director_2, tangent); }
};

namespace detail {

/// Derivative of a curve by five-point differences that stay inside [0, 1], or of a closed one go on beyond.
inline Vec3 curve_derivative(const Curve& curve, double t, double step, bool closed = false) {
    const double low = closed ? t - 2.0 * step : std::clamp(t - 2.0 * step, 0.0, 1.0 - 4.0 * step);
    const double u = (t - low) / step;  // 2 inside, 0 and 4 at the ends
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < 5; ++k) {  // derivative of the Lagrange polynomial of node k at u
        double weight = 0.0;
        for (int m = 0; m < 5; ++m) {
            if (m == k) continue;
            double term = 1.0 / (k - m);
            for (int l = 0; l < 5; ++l)
                if (l != k && l != m) term *= (u - l) / (k - l);
            weight += term;
        }
        const double at = low + k * step;
        sum += weight * curve(closed ? at - std::floor(at) : at);
    }
    return sum / step;
}

/// One step of parallel transport by two reflections (Wang et al. 2008), fourth order in the step.
inline Vec3 transported(const Vec3& director, const Vec3& chord, const Vec3& tangent, const Vec3& next_tangent) {
    const double square = chord.squaredNorm();
    const Vec3 left = director - 2.0 / square * chord.dot(director) * chord;
    const Vec3 turned = tangent - 2.0 / square * chord.dot(tangent) * chord;
    const Vec3 second = next_tangent - turned;
    const double size = second.squaredNorm();
    Vec3 result = size > 0.0 ? Vec3(left - 2.0 / size * second.dot(left) * second) : left;
    result -= result.dot(next_tangent) * next_tangent;
    return result.normalized();
}

}  // namespace detail

/// Any unit vector perpendicular to `tangent`, chosen without regard to handedness of the axes.
inline Vec3 any_perpendicular(const Vec3& tangent) {
    Index axis = 0;
    tangent.cwiseAbs().minCoeff(&axis);
    const Vec3 direction = Vec3::Unit(axis);
    return (direction - direction.dot(tangent) * tangent).normalized();
}

/// Normal of the plane that a curve lies in; nothing of one that is straight, or that leaves its plane by more than rounding.
inline Vec3 plane_normal(const Curve& curve) {
    constexpr Index samples = 64;
    constexpr double flat = 1e-9, straight = 1e-6;  // of the greatest distance from its first point
    std::vector<Vec3> from_first;
    const Vec3 first = curve(0.0);
    for (Index k = 1; k <= samples; ++k) from_first.push_back(curve(static_cast<double>(k) / samples) - first);
    const auto greatest = [&](const auto& size) {
        return *std::max_element(from_first.begin(), from_first.end(),
                                 [&](const Vec3& a, const Vec3& b) { return size(a) < size(b); });
    };
    const Vec3 along = greatest([](const Vec3& x) { return x.norm(); });
    const double extent = along.norm();
    const Vec3 across = along.cross(greatest([&](const Vec3& x) { return along.cross(x).norm(); }));
    if (!(across.norm() > straight * extent * extent)) return Vec3::Zero();
    const Vec3 normal = across.normalized();
    const auto off = [&](const Vec3& x) { return std::abs(x.dot(normal)) > flat * extent; };
    return std::any_of(from_first.begin(), from_first.end(), off) ? Vec3(Vec3::Zero()) : normal;
}

/// What a curve may be like.
///
/// Slower than a ten-thousandth of its mean speed a curve stands still: differences of its points have lost the digits of its
/// direction. Points that have been marched to in equal steps lie within a quarter of the distance of two nodes of each other,
/// or the curve jumps; and nodes are apart by the same arc to one in a hundred, or elements would not be as long as they are
/// taken to be. A parameter that runs unevenly is sampled more finely, until these hold or a sixteenth of the step does not help.
inline constexpr double least_speed = 1e-4, longest_step = 0.25, largest_unevenness = 0.01;

/// A curve cut into nodes.
struct ReferenceShape {
    std::vector<NodeFrame> frames;
    std::vector<double> turn;  ///< of the tangent from each node to the next, along the curve [radian]
    double length = 0.0;       ///< of the curve [length]
};

namespace detail {

/// Place on a curve, for messages.
inline std::string curve_place(double parameter, const Vec3& position) {
    return ", at parameter " + core::text(parameter) + ", point " + text(position);
}

/// One march along a curve with `fine` steps between two nodes. @returns whether nodes came to be as far apart as they should;
/// if `last`, throws where they did not.
inline bool march(const Curve& curve, Index nodes, Index fine, const Vec3& director, const std::string& name, bool closed,
                  bool last_attempt, ReferenceShape& shape) {
    const Index steps = (nodes - 1) * fine;
    std::vector<double> arc(core::at(steps + 1), 0.0);
    Vec3 last = curve(0.0);
    for (Index k = 0; k <= steps; ++k) {
        const double t = static_cast<double>(k) / static_cast<double>(steps);
        const Vec3 next = k > 0 ? curve(t) : last;
        if (!next.allFinite()) core::refuse(name + ": point", text(next), "finite" + curve_place(t, next));
        if (k > 0) arc[core::at(k)] = arc[core::at(k - 1)] + (next - last).norm();
        last = next;
    }
    const double length = shape.length = arc.back(), mean = length / static_cast<double>(steps);
    core::require(std::isfinite(length) && length > 0.0, name + ": length", length, "finite and > 0");
    if (closed) {
        const double open = (last - curve(0.0)).norm();
        core::require(open <= 1e-9 * length, name + ": distance from its end to its start", open, "nothing, of a closed fibre");
    }
    for (Index k = 0; k < steps; ++k)
        if (const double span = arc[core::at(k + 1)] - arc[core::at(k)]; !(span > least_speed * mean)) {
            const double t = static_cast<double>(k) / static_cast<double>(steps);
            core::refuse(name + ": speed", core::text(span / mean),
                         "> " + core::text(least_speed) + " of its mean everywhere: its points repeat, or it stands still" +
                             curve_place(t, curve(t)));
        }

    const double difference = 0.25 / static_cast<double>(steps);
    shape.frames.clear(), shape.turn.clear();
    shape.frames.reserve(core::at(nodes)), shape.turn.reserve(core::at(nodes));
    NodeFrame frame;
    Index k = 0;
    double between = 0.0, turn = 0.0, longest = 0.0, at_longest = 0.0, uneven = 0.0, at_uneven = 0.0;
    for (Index m = 0; m <= steps; ++m) {  // march through points of equal arc length
        const double wanted = length * static_cast<double>(m) / static_cast<double>(steps);
        while (k + 1 < steps && arc[core::at(k + 1)] < wanted) ++k;
        const double span = arc[core::at(k + 1)] - arc[core::at(k)];
        const double t = std::clamp(
            m == steps ? 1.0 : (static_cast<double>(k) + (wanted - arc[core::at(k)]) / span) / static_cast<double>(steps), 0.0,
            1.0);
        const Vec3 position = curve(t);
        const Vec3 derivative = curve_derivative(curve, t, difference, closed), tangent = derivative.normalized();
        if (!(derivative.norm() > least_speed * length))
            core::refuse(name + ": speed", core::text(derivative.norm() / length),
                         "> " + core::text(least_speed) + " of its mean everywhere: its points repeat, or it stands still" +
                             curve_place(t, position));
        if (m == 0) {
            const Vec3 start = director - director.dot(tangent) * tangent;
            frame.director_1 =
                start.norm() > 1e-6 * director.norm() && director.norm() > 0.0 ? start.normalized() : any_perpendicular(tangent);
        } else {
            const Vec3 chord = position - frame.position;
            const double step = chord.norm();
            if (step > longest) longest = step, at_longest = t;
            between += step, turn += std::atan2(frame.tangent.cross(tangent).norm(), frame.tangent.dot(tangent));
            frame.director_1 = step > 0.0 ? transported(frame.director_1, chord, frame.tangent, tangent) : frame.director_1;
        }
        frame.position = position;
        frame.tangent = tangent;
        frame.director_2 = tangent.cross(frame.director_1);
        if (m % fine != 0) continue;
        shape.frames.push_back(frame);
        if (m == 0) continue;
        const double off = std::abs(between * static_cast<double>(nodes - 1) / length - 1.0);
        if (off > uneven) uneven = off, at_uneven = t;
        shape.turn.push_back(turn);
        between = turn = 0.0;
    }
    const double spacing = length / static_cast<double>(nodes - 1);
    if (longest <= longest_step * spacing && uneven <= largest_unevenness) return true;
    if (last_attempt && longest > longest_step * spacing)
        core::refuse(name + ": step", core::text(longest),
                     "<= " + core::text(longest_step * spacing) + ", " + core::text(longest_step) +
                         " of the distance of two nodes: it jumps, or its points are too uneven" +
                         curve_place(at_longest, curve(at_longest)));
    if (last_attempt)
        core::refuse(
            name + ": unevenness of nodes", core::text(uneven),
            "<= " + core::text(largest_unevenness) + ": its points are too uneven" + curve_place(at_uneven, curve(at_uneven)));
    return false;
}

}  // namespace detail

/// Frames at `nodes` points of equal arc length.
///
/// Directors are carried along by parallel transport: rest directors that twist about the axis would cost an error of
/// (r x twist rate)^2.
/// @param curve     regular (its derivative does not vanish)
/// @param nodes     >= 2
/// @param director  g_1 at the start is its part perpendicular to the tangent; zero: the normal of a plane curve, so that what
/// holds a section does to one side of that plane what it does to the other; else any
/// @param name      what messages call the curve
/// @param closed    the curve ends where it begins, and its tangent there is that of a curve that goes on
/// @throws std::invalid_argument if the curve is not finite, stands still, jumps, runs too unevenly or does not close where it
/// should; it says where
inline ReferenceShape reference_shape(const Curve& curve, Index nodes, const Vec3& director = Vec3::Zero(),
                                      const std::string& name = "fibre.curve", bool closed = false) {
    core::require_at_least("reference_frames.nodes", nodes, 2);
    constexpr Index fine = 16, finest = 256;  // substeps between nodes, for arc length and transport
    ReferenceShape shape;
    const Vec3 first = director.isZero(0.0) ? plane_normal(curve) : director;
    for (Index steps = fine; !detail::march(curve, nodes, steps, first, name, closed, steps >= finest, shape);) steps *= 4;
    return shape;
}
inline std::vector<NodeFrame> reference_frames(const Curve& curve, Index nodes, const Vec3& director = Vec3::Zero(),
                                               bool closed = false) {
    return reference_shape(curve, nodes, director, "fibre.curve", closed).frames;
}

/// Turns the sections about their tangents, evenly from nothing at the first one to an angle at the last one [radian].
inline void turn_along(std::vector<NodeFrame>& frames, double angle) {
    for (std::size_t k = 0; k < frames.size(); ++k) {
        NodeFrame& frame = frames[k];
        const double turn = angle * static_cast<double>(k) / static_cast<double>(frames.size() - 1);
        frame.director_1 = std::cos(turn) * frame.director_1 + std::sin(turn) * frame.director_2;
        frame.director_2 = frame.tangent.cross(frame.director_1);
    }
}

/// Angle by which the last section of a closed curve has to be turned to lie on the first one, in (-pi, pi] [radian]. Directors
/// that are carried along a curve in space by parallel transport come back turned by 2 pi times its writhe (Fuller 1971).
inline double closing_angle(const std::vector<NodeFrame>& frames) {
    const NodeFrame &first = frames.front(), &last = frames.back();
    return std::atan2(first.director_1.dot(last.director_2), first.director_1.dot(last.director_1));
}

/// Frames of a straight fibre.
/// @throws std::invalid_argument if the ends are not finite or coincide
inline std::vector<NodeFrame> straight_frames(const Vec3& from, const Vec3& to, Index nodes,
                                              const Vec3& director = Vec3::Zero()) {
    core::require_at_least("straight_frames.nodes", nodes, 2);
    const double length = (to - from).norm();
    core::require(std::isfinite(length) && length > 0.0, "fibre.to: distance from fibre.from", length, "finite and > 0");
    NodeFrame frame;
    frame.tangent = (to - from) / length;
    const Vec3 start = director - director.dot(frame.tangent) * frame.tangent;
    frame.director_1 =
        start.norm() > 1e-6 * director.norm() && director.norm() > 0.0 ? start.normalized() : any_perpendicular(frame.tangent);
    frame.director_2 = frame.tangent.cross(frame.director_1);
    std::vector<NodeFrame> frames(core::at(nodes), frame);
    for (Index k = 0; k < nodes; ++k) {
        const double t = static_cast<double>(k) / static_cast<double>(nodes - 1);
        frames[core::at(k)].position = (1.0 - t) * from + t * to;
    }
    return frames;
}

}  // namespace fibrant::scene
