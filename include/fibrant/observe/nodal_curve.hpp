// SPDX-License-Identifier: MIT
#pragma once
/// @file The curve through the nodes of 3-node elements: points, lengths, curvature, and where it meets a plane.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>
#include <fibrant/observe/snapshot.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>

namespace fibrant::observe {

/// Quadratic elements over nodes (0, 1, 2), (2, 3, 4), ...; the parameter t counts nodes, so node k is at t = k.
/// It does not own the nodes.
class NodalCurve {
public:
    /// @param nodes  an odd number, >= 3
    explicit NodalCurve(std::span<const Vec3> nodes) : nodes_{nodes} {
        if (nodes.size() < 3 || nodes.size() % 2 == 0)
            core::refuse("NodalCurve.nodes", std::to_string(nodes.size()), "odd and >= 3");
    }

    /// @throws std::invalid_argument if the fibre's nodes are not joined so
    explicit NodalCurve(const FibreSnapshot& fibre) : NodalCurve{checked(fibre)} {}

    double end() const noexcept { return static_cast<double>(nodes_.size() - 1); }  ///< last parameter; the first is 0
    Index elements() const noexcept { return core::count(nodes_) / 2; }
    std::span<const Vec3> nodes() const noexcept { return nodes_; }

    Vec3 position(double t) const noexcept { return interpolate(nodes_, t); }

    /// dx / dt [length]; at an end of an element, that of the following one.
    Vec3 tangent(double t) const noexcept {
        const auto [first, s] = local(t);
        return (s - 0.5) * nodes_[first] - 2.0 * s * nodes_[first + 1] + (s + 0.5) * nodes_[first + 2];
    }

    /// d2x / dt2 [length], constant over an element.
    Vec3 second(double t) const noexcept {
        const std::size_t first = local(t).first;
        return nodes_[first] - 2.0 * nodes_[first + 1] + nodes_[first + 2];
    }

    /// |x' x x''| / |x'|^3 [1 / length].
    double curvature(double t) const noexcept {
        const Vec3 slope = tangent(t);
        const double length = slope.norm();
        return slope.cross(second(t)).norm() / (length * length * length);
    }

    /// Nodal values (directors, displacements) carried along the same shape functions.
    template <class Value>
    Value interpolate(std::span<const Value> values, double t) const noexcept {
        const auto [first, s] = local(t);
        return 0.5 * s * (s - 1.0) * values[first] + (1.0 - s * s) * values[first + 1] + 0.5 * s * (s + 1.0) * values[first + 2];
    }

    /// Calls visit(t, weight) at Gauss points of arc length between two parameters, `weight` in units of length.
    template <class Visit>
    void integrate(double from, double to, const Visit& visit) const {
        static constexpr std::array<double, 5> point{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                                     0.9061798459386640};
        static constexpr std::array<double, 5> weight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                                      0.4786286704993665, 0.2369268850561891};
        for (double start = from; start < to;) {
            const double stop = std::min(to, 2.0 * (std::floor(0.5 * start) + 1.0));
            const double half = 0.5 * (stop - start), middle = 0.5 * (stop + start);
            for (std::size_t k = 0; k < point.size(); ++k) {
                const double t = middle + half * point[k];
                visit(t, half * weight[k] * tangent(t).norm());
            }
            start = stop;
        }
    }

    /// Arc length between two parameters, from <= to [length].
    double length(double from, double to) const {
        double sum = 0.0;
        integrate(from, to, [&](double, double weight) { sum += weight; });
        return sum;
    }

    /// First parameter at which `normal . x` reaches `level`; nothing if the curve stays on one side.
    std::optional<double> meets(const Vec3& normal, double level) const noexcept {
        for (std::size_t first = 0; first + 2 < nodes_.size(); first += 2) {
            const double a = normal.dot(nodes_[first]) - level, b = normal.dot(nodes_[first + 1]) - level,
                         c = normal.dot(nodes_[first + 2]) - level;
            // q s^2 + p s + b on [-1, 1]; the stable form of its roots.
            const double q = 0.5 * (a + c) - b, p = 0.5 * (c - a), square = p * p - 4.0 * q * b;
            if (square < 0.0) continue;
            const double half = -0.5 * (p + std::copysign(std::sqrt(square), p));
            double best = std::numeric_limits<double>::infinity();
            const double other = half != 0.0 ? b / half : (b == 0.0 ? 0.0 : half / q);
            for (const double s : {half / q, other})
                if (s >= -1.0 - 1e-12 && s <= 1.0 + 1e-12) best = std::min(best, std::clamp(s, -1.0, 1.0));
            if (std::isfinite(best)) return static_cast<double>(first) + 1.0 + best;
        }
        return std::nullopt;
    }

private:
    static std::span<const Vec3> checked(const FibreSnapshot& fibre) {
        if (fibre.interpolation != Interpolation::quadratic)
            core::refuse("FibreSnapshot.interpolation", fibre.interpolation == Interpolation::linear ? "linear" : "cubic",
                         "quadratic");
        return fibre.position;
    }
    struct Local {
        std::size_t first;
        double s;
    };
    Local local(double t) const noexcept {
        const double last = static_cast<double>(nodes_.size() - 3);
        // A parameter that is not a number gives points that are not.
        const double first = t >= 0.0 ? std::min(2.0 * std::floor(0.5 * t), last) : 0.0;
        return {static_cast<std::size_t>(first), t - first - 1.0};
    }

    std::span<const Vec3> nodes_;
};

}  // namespace fibrant::observe
