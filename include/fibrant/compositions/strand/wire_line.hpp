// SPDX-License-Identifier: MIT
#pragma once
/// @file Centreline of a wire in a strand that is itself wound around an axis: a helix about a helix.

#include <fibrant/compositions/strand/strand_parameters.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace fibrant::compositions::strand {

/// A wire at a distance from its strand's core, which goes round the z axis at another. By the length s of the core's line: the
/// directions out of the axis, b along the cylinder and across the core, and the core's tangent are right-handed and turn with
/// the curvature kappa and the torsion tau of a helix. The wire turns at `rate` against sections that do not turn about the core,
/// so at rate - tau against these.
struct WireLine {
    double helix_radius = 0.0;  ///< of the core's line; 0: the axis itself [length]
    double lay = 0.0;           ///< of the core to the axis, positive is right-handed [radian]
    double start = 0.0;         ///< angle of the core about the axis at z = 0 [radian]
    double distance = 0.0;      ///< from the core's line; 0: the core itself [length]
    double rate = 0.0;          ///< about the core's line, a length of it [radian / length]
    double phase = 0.0;         ///< angle about it at its start, from the direction out of the axis [radian]
    double radius = 0.0;        ///< of the wire [length]

    double curvature() const noexcept { return helix_radius > 0.0 ? std::pow(std::sin(lay), 2) / helix_radius : 0.0; }
    double torsion() const noexcept { return helix_radius > 0.0 ? std::sin(lay) * std::cos(lay) / helix_radius : 0.0; }

    /// A point of the line, and its derivative by s: longer than 1 where the wire is outside its core.
    struct Point {
        Vec3 place, derivative;
    };
    Point at(double s) const {
        const double about = start + (helix_radius > 0.0 ? s * std::sin(lay) / helix_radius : 0.0),
                     angle = phase + (rate - torsion()) * s;
        const double sine = std::sin(angle), cosine = std::cos(angle);
        const Vec3 out(std::cos(about), std::sin(about), 0.0), around(-out.y(), out.x(), 0.0);
        const Vec3 across = std::cos(lay) * around - std::sin(lay) * Vec3::UnitZ(),
                   along = std::sin(lay) * around + std::cos(lay) * Vec3::UnitZ();
        return {helix_radius * out + Vec3(0, 0, s * std::cos(lay)) + distance * (cosine * out + sine * across),
                (1.0 + distance * curvature() * cosine) * along + distance * rate * (cosine * across - sine * out)};
    }
    Vec3 place(double s) const { return at(s).place; }
    /// Where the wire meets a plane across the axis; it does so once, as wires never lie across it.
    double at_height(double z) const {
        const double c = std::cos(lay), aside = distance * std::abs(std::sin(lay));
        double low = (z - aside) / c - radius, high = (z + aside) / c + radius;
        for (int k = 0; k < 60; ++k) {
            const double middle = 0.5 * (low + high);
            (place(middle).z() < z ? low : high) = middle;
        }
        return 0.5 * (low + high);
    }
};

/// The wires of a strand, the core first, then each layer in the order of angles, for a strand whose core follows a helix or the
/// axis.
inline std::vector<WireLine> lines_of(const StrandSection& section, double helix_radius = 0.0, double lay = 0.0,
                                      double start = 0.0) {
    std::vector<WireLine> lines{{.helix_radius = helix_radius, .lay = lay, .start = start, .radius = section.core_radius}};
    for (std::size_t k = 0; k < section.layers.size(); ++k)
        for (Index wire = 0; wire < section.layers[k].wires; ++wire) {
            WireLine line = lines.front();
            line.distance = section.helix_radius(k), line.rate = section.turn_rate(k), line.radius = section.layers[k].radius;
            line.phase = 2.0 * std::numbers::pi * static_cast<double>(wire) / static_cast<double>(section.layers[k].wires);
            lines.push_back(line);
        }
    return lines;
}

/// Least distance between the surfaces of two wires between the planes z = 0 and z = length, < 0 if they overlap; `known` if it
/// is not less [length].
///
/// Goes along the one and drops its points on the other. A distance changes by no more than the way, so where wires are far from
/// each other long steps miss nothing; a golden section finds what is between three points the middle one of which is the
/// nearest.
inline double least_gap(const WireLine& one, const WireLine& other, double length,
                        double known = std::numeric_limits<double>::infinity()) {
    const double first = one.at_height(0.0), last = one.at_height(length), low = other.at_height(0.0),
                 high = other.at_height(length);
    const double touching = one.radius + other.radius, fine = 0.5 * std::min(one.radius, other.radius);
    const double speed = 1.0 + one.distance * (one.curvature() + std::abs(one.rate));  // at most
    double foot = low;                                                                 // of the last point on the other wire
    const auto gap = [&](double s) {
        const Vec3 from = one.place(s);
        for (int n = 0; n < 20; ++n) {
            const WireLine::Point to = other.at(foot);
            const double next = std::clamp(foot + to.derivative.dot(from - to.place) / to.derivative.squaredNorm(), low, high),
                         step = std::abs(next - foot);
            foot = next;
            if (step < 1e-7 * other.radius) break;
        }
        return (from - other.place(foot)).norm() - touching;
    };
    constexpr double none = std::numeric_limits<double>::infinity();
    double least = known, earlier = first, before = first, last_but_one = none, previous = none;
    for (double s = first;;) {
        const double here = gap(s);
        least = std::min(least, here);
        if (previous < here - 1e-9 * touching && previous <= last_but_one && previous < least + fine) {
            constexpr double ratio = 0.6180339887498949;
            double a = earlier, b = s;
            for (int n = 0; n < 30; ++n) {
                const double left = b - ratio * (b - a), right = a + ratio * (b - a), x = gap(left), y = gap(right);
                least = std::min({least, x, y});
                (x < y ? b : a) = x < y ? right : left;
            }
        }
        if (s >= last) break;
        earlier = before, before = s, last_but_one = previous, previous = here;
        s = std::min(last, s + std::max(fine, (here - least) / speed));
    }
    return least;
}

}  // namespace fibrant::compositions::strand
