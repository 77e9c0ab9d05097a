// SPDX-License-Identifier: MIT
#pragma once
/// @file Tension ratio of a fibre that slides around a cylinder, friction acting at its surface.

#include <fibrant/core/types.hpp>

#include <cmath>
#include <numbers>

namespace fibrant::test {

/// Angle that a fibre turns through, clockwise in the plane of x and y, by the forces on its two ends [radian]. It is more than
/// half a turn where the lines of the two forces meet above the cylinder: bending keeps the free parts further away from the axis
/// the slacker they are.
inline double turned_angle(const Vec3& slack, const Vec3& taut) {
    return std::numbers::pi - std::atan2(slack.cross(taut).z(), slack.dot(taut));
}

struct Capstan {
    double fibre_radius, radius;  ///< of the fibre, of the cylinder [length]
    double bending;               ///< E I of the fibre [force * length^2]
    double friction;              ///< coefficient [1]
};

/// Tension ratio by the equations of capstan.json: on the arc
/// dT/dpsi = mu R p, r mu dp/dpsi = T - rho p, with a point force at the exit.
/// @param low    tension at the slack end [force]
/// @param theta  between the directions of the two ends [radian]
inline double capstan_ratio(const Capstan& capstan, double low, double theta) {
    const double r = capstan.fibre_radius, R = capstan.radius, rho = R + r, B = capstan.bending, mu = capstan.friction;
    const double phi_0 = std::acos(1.0 - B / (2.0 * rho * rho * low));
    struct Arc {
        double tension, load;
    };
    const auto along = [&](double contact_angle) {
        Arc arc{low * std::cos(phi_0), low * std::sin(phi_0) / (r * mu)};
        const int steps = 20000;
        const double h = contact_angle / steps;
        const auto slope = [&](const Arc& at) { return Arc{mu * R * at.load, (at.tension - rho * at.load) / (r * mu)}; };
        const auto ahead = [](const Arc& at, const Arc& by, double factor) {
            return Arc{at.tension + factor * by.tension, at.load + factor * by.load};
        };
        for (int k = 0; k < steps; ++k) {
            const Arc a = slope(arc), b = slope(ahead(arc, a, 0.5 * h)), c = slope(ahead(arc, b, 0.5 * h)),
                      d = slope(ahead(arc, c, h));
            arc = ahead(ahead(arc, a, h / 6), ahead(b, ahead(c, d, 0.5), 1.0), h / 3);
        }
        return arc;
    };
    // Exit: T + mu P = F cos phi, P - r mu p = F sin phi, F (1 - cos phi) = (B / rho - r mu P)^2 / (2 B)
    double phi_1 = 0.8 * phi_0, ratio = 0.0;
    for (int pass = 0; pass < 60; ++pass) {
        const Arc arc = along(theta - phi_0 - phi_1);
        double P = 0.0, F = 0.0;
        double low_P = 0.0, high_P = B / (rho * r * mu);
        for (int k = 0; k < 200; ++k) {  // F from the first two, the third decides
            P = 0.5 * (low_P + high_P);
            const double c = arc.tension + mu * P, s = P - r * mu * arc.load;
            F = std::hypot(c, s);
            const double moment = B / rho - r * mu * P;
            const bool too_small = s < 0.0 || F - c < moment * moment / (2.0 * B);
            (too_small ? low_P : high_P) = P;
        }
        phi_1 = std::atan2(P - r * mu * arc.load, arc.tension + mu * P);
        const double next = F / low;
        if (std::abs(next - ratio) < 1e-10) return next;
        ratio = next;
    }
    return ratio;
}

}  // namespace fibrant::test
