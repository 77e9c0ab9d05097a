// SPDX-License-Identifier: MIT
#pragma once
/// @file True gap of two sections that are not round: the direction along which they are furthest apart, and how it turns.

#include <fibrant/core/types.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <utility>

namespace fibrant::contact {

/// A section as it stands in space: conjugate half axes of its ellipse, a g_1 and b g_2 [length].
struct SectionAxes {
    Vec3 first, second;

    /// Half extent along a unit direction: the support function of the ellipse [length].
    double extent(const Vec3& direction) const noexcept {
        const double p = first.dot(direction), q = second.dot(direction);
        return std::sqrt(p * p + q * q);
    }
};

/// The same in two coordinates of a plane that it is looked at in.
class PlaneEllipse {
public:
    using Vec2 = Eigen::Vector2d;
    PlaneEllipse(const SectionAxes& axes, const Vec3& e, const Vec3& f) noexcept
        : p_{axes.first.dot(e), axes.first.dot(f)}, q_{axes.second.dot(e), axes.second.dot(f)} {
        const double area = p_[0] * q_[1] - p_[1] * q_[0];
        square_ = area * area;
        // of a section that is seen along its plane: else its two ends would be kinks of the support function
        const double squares = p_.squaredNorm() + q_.squaredNorm();
        least_ = 1e-6 * std::sqrt(squares) + 1e-300;
        const double wide =
            0.5 * (squares + std::sqrt(std::max(0.0, squares * squares - 4.0 * square_)));  // the larger half axis, squared
        sharpest_ = wide > 0.0 ? square_ / (wide * std::sqrt(wide)) : 0.0;
    }
    /// Support function by the angle of the direction, its derivative, and the radius of curvature where it touches [length].
    struct Support {
        double extent, slope, curvature_radius;
    };
    Support at(const Vec2& n, const Vec2& across) const noexcept {
        const double p = p_.dot(n), q = q_.dot(n), h = std::max(least_, std::sqrt(p * p + q * q));
        return {h, (p * p_.dot(across) + q * q_.dot(across)) / h, square_ / (h * h * h)};
    }
    /// Least radius of curvature of its contour: b^2 / a [length].
    double sharpest() const noexcept { return sharpest_; }
    /// Angle of the direction in which the ellipse is thinnest, and of that in which it is widest.
    double thin_angle() const noexcept { return wide_angle() + 0.5 * std::numbers::pi; }
    double wide_angle() const noexcept {
        return 0.5 *
               std::atan2(2.0 * (p_[0] * p_[1] + q_[0] * q_[1]), p_[0] * p_[0] + q_[0] * q_[0] - p_[1] * p_[1] - q_[1] * q_[1]);
    }

private:
    Vec2 p_, q_;
    double square_, least_, sharpest_ = 0.0;
};

/// Gap of two ellipses in a plane as a function of the direction: F(n) = d.n - h_i(n) - h_j(n), n = (cos phi, sin phi).
///
/// The true gap is the greatest F: apart, the distance of two convex sets; in each other, less the least way that parts
/// them. By the theorem of the envelope its derivatives are those of F with n held: n by d, and minus the weights of the
/// particles that are furthest along n by the half axes. Of second order is the turn of n: F' changes by d.n' and
/// F'' = -(F + R_i + R_j), R the radii of curvature of the contours where they touch.
class PlaneGap {
public:
    using Vec2 = Eigen::Vector2d;
    struct Value {
        double gap = 0.0, slope = 0.0, second = 0.0;  ///< F, F', F'' [length]
    };
    struct Greatest {
        double angle = 0.0;
        Value value;
    };

    PlaneGap(const Vec2& apart, const PlaneEllipse& i, const PlaneEllipse& j) noexcept : d_{apart}, ellipse_{i, j} {}

    Value at(double angle) const noexcept {
        const Vec2 n{std::cos(angle), std::sin(angle)}, across{-n[1], n[0]};
        Value value{d_.dot(n), d_.dot(across), 0.0};
        double radii = 0.0;
        for (const PlaneEllipse& ellipse : ellipse_) {
            const PlaneEllipse::Support support = ellipse.at(n, across);
            value.gap -= support.extent, value.slope -= support.slope, radii += support.curvature_radius;
        }
        value.second = -(value.gap + radii);
        return value;
    }

    /// Greatest gap among directions less than a right angle from angle 0, the side from which contact has come; false if it only
    /// grows until there: the sections have passed each other.
    ///
    /// Where sections are apart there is one maximum with F > 0, the truth. One that is less deep than the contours' least radii
    /// of curvature together is the greatest: a circle of that radius rolls in the sum of both sections, and touches it there
    /// alone. Deeper there may be several: the greatest, and of two that are the same the one that is uphill of angle 0.
    bool greatest_on_side(Greatest& best) const noexcept {
        bool found = climb(0.0, best);
        if (found && best.value.gap >= -(ellipse_[0].sharpest() + ellipse_[1].sharpest())) return true;
        // The thinnest directions of both, where -h has its peaks, and the line of the centres.
        const double right = 0.5 * std::numbers::pi, centres = d_[0] > 0.0 ? std::atan2(d_[1], d_[0]) : 0.0;
        for (const double start : {ellipse_[0].thin_angle(), ellipse_[1].thin_angle(), centres}) {
            const double turned = std::remainder(start, 2.0 * right);
            Greatest other;
            if (!(std::abs(turned) < right) || !climb(turned, other)) continue;
            const double noise = 1e-9 * (std::abs(best.value.gap) + std::abs(other.value.gap));
            if (!found || other.value.gap > best.value.gap + noise) best = other, found = true;
        }
        return found;
    }

private:
    /// The maximum uphill of a start; false if that leads off the side.
    bool climb(double start, Greatest& top) const noexcept {
        const double right = 0.5 * std::numbers::pi,
                     stride = 0.1;    // narrower than the peaks of sections up to ten times as wide as thick
        const double settled = 1e-8;  // [radian]; what is left after such a step of Newton's method is its square
        double low = start, high = start;
        Value here = at(start);
        const double up = here.slope >= 0.0 ? 1.0 : -1.0;
        double angle = start;
        bool between = false;  // two angles have the top between them
        for (int iteration = 0; iteration < 60; ++iteration) {
            bool newton = here.second < 0.0;
            double step = newton ? -here.slope / here.second : up * stride;
            if (!between) {
                step = up * std::min(std::abs(step), stride);
            } else if (!(angle + step > low && angle + step < high)) {
                step = 0.5 * (low + high) - angle;
                newton = false;
            }
            angle += step;
            if (!between && std::abs(angle) >= right) return false;
            here = at(angle);
            if (newton && std::abs(step) < settled) break;
            if (between) {
                (here.slope > 0.0 ? low : high) = angle;
            } else if (here.slope * up < 0.0) {
                between = true;
                low = std::min(angle, angle - step), high = std::max(angle, angle - step);
            }
        }
        top = {angle, here};
        return true;
    }

    Vec2 d_;
    std::array<PlaneEllipse, 2> ellipse_;
};

/// How the direction of the greatest gap turns with what the gap depends on: by (across . change of d) / length, and likewise by
/// minus what the slope of a section's support function changes. For round sections the length is the distance of the centres.
struct NormalTurn {
    Vec3 across = Vec3::Zero();  ///< unit, in the plane of the gap and flat against the normal
    double length = 0.0;         ///< gap + R_i + R_j [length]; <= 0: no maximum
};

/// How the normal turns, if it is that of the greatest gap.
/// @param centres  x_j - x_i [length]
/// @param tangent  unit, across the plane in which the gap is taken
/// @param normal   unit, in that plane
inline NormalTurn normal_turn(const Vec3& centres, const SectionAxes& i, const SectionAxes& j, const Vec3& tangent,
                              const Vec3& normal) noexcept {
    const Vec3 across = tangent.cross(normal);
    const PlaneGap gap({centres.dot(normal), centres.dot(across)}, {i, normal, across}, {j, normal, across});
    return {across, -gap.at(0.0).second};
}

/// Direction in the plane across `tangent` along which two sections are furthest apart, on the side of `side`.
///
/// @param centres  x_j - x_i [length]
/// @param tangent  unit
/// @param side     unit, across `tangent`: the direction stays less than a right angle from it, so that sections which have
/// passed
///                 each other are pushed back the way they came
inline Vec3 furthest_direction(const Vec3& centres, const SectionAxes& i, const SectionAxes& j, const Vec3& tangent,
                               const Vec3& side) noexcept {
    const Vec3 across = tangent.cross(side);
    const PlaneGap gap({centres.dot(side), centres.dot(across)}, {i, side, across}, {j, side, across});
    PlaneGap::Greatest best;
    if (!gap.greatest_on_side(best)) return side;
    return std::cos(best.angle) * side + std::sin(best.angle) * across;
}

}  // namespace fibrant::contact
