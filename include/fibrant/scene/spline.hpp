// SPDX-License-Identifier: MIT
#pragma once
/// @file The cubic curve through given points with continuous curvature, open, closed, or repeating with a shift.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>
#include <fibrant/scene/places.hpp>
#include <fibrant/scene/reference_shape.hpp>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::scene {

/// How a spline begins and ends.
enum class SplineEnds : std::uint8_t {
    parabolic,  ///< the second derivative is constant over the first and over the last piece
    natural,    ///< the second derivative is zero there
    repeating,  ///< its last point is its first one plus a shift, which may be zero, and it goes on so (closed with no shift)
};

/// How the parameter runs from point to point.
enum class SplineSteps : std::uint8_t {
    by_distance,  ///< in proportion to the distance of the points
    even,         ///< in equal steps
};

/// Interpolating cubic spline of points in space (de Boor 1978, chapter 4: slopes from a tridiagonal system). Time linear in the
/// points.
class Spline {
public:
    /// @param points  at least two, no two neighbours the same [length]; a repeating one has its first point, shifted, as its
    /// last
    /// @param name    what messages call it
    /// @throws std::invalid_argument naming the point that is not finite, or that repeats the one before it
    explicit Spline(std::vector<Vec3> points, SplineEnds ends = SplineEnds::parabolic,
                    SplineSteps steps = SplineSteps::by_distance, const std::string& name = "Spline")
        : points_{std::move(points)} {
        const std::size_t least = ends == SplineEnds::repeating ? 3 : 2, n = points_.size();
        if (n < least) core::refuse(name + ".points", std::to_string(n), ">= " + std::to_string(least));
        breaks_.assign(n, 0.0);
        for (std::size_t k = 0; k < n; ++k) {
            require_finite(name + ".points[" + std::to_string(k) + "]", points_[k]);
            if (k == 0) continue;
            const double distance = (points_[k] - points_[k - 1]).norm();
            if (!(distance > 0.0))
                core::refuse(name + ".points[" + std::to_string(k) + "]", text(points_[k]),
                             "another point than the one before it");
            breaks_[k] = breaks_[k - 1] + (steps == SplineSteps::even ? 1.0 : distance);
        }
        slopes_.assign(n, Vec3::Zero());
        if (n == 2 && ends != SplineEnds::repeating)
            slopes_[0] = slopes_[1] = (points_[1] - points_[0]) / breaks_[1];
        else
            solve(ends);
    }

    /// Point at a parameter in [0, 1] [length].
    Vec3 operator()(double t) const { return evaluate(t, 0); }
    /// First and second derivative by that parameter [length].
    Vec3 derivative(double t) const { return breaks_.back() * evaluate(t, 1); }
    Vec3 second(double t) const { return breaks_.back() * breaks_.back() * evaluate(t, 2); }
    /// Parameter of a point that it was made of, in [0, 1].
    double parameter(Index point) const noexcept { return breaks_[core::at(point)] / breaks_.back(); }
    const std::vector<Vec3>& points() const noexcept { return points_; }

private:
    double step(std::size_t k) const noexcept { return breaks_[k + 1] - breaks_[k]; }
    Vec3 rise(std::size_t k) const { return points_[k + 1] - points_[k]; }

    void solve(SplineEnds ends) {
        const bool repeating = ends == SplineEnds::repeating;
        const std::size_t n = points_.size(), rows = repeating ? n - 1 : n;
        std::vector<double> below(rows, 0.0), diagonal(rows, 1.0), above(rows, 0.0);
        std::vector<Vec3> right(rows, Vec3::Zero());
        for (std::size_t k = 0; k < rows; ++k) {
            if (!repeating && (k == 0 || k == n - 1)) {
                const std::size_t piece = k == 0 ? 0 : n - 2;
                const bool natural = ends == SplineEnds::natural;
                diagonal[k] = natural ? 2.0 : 1.0;
                (k == 0 ? above : below)[k] = 1.0;
                right[k] = (natural ? 3.0 : 2.0) * rise(piece) / step(piece);
                continue;
            }
            const std::size_t before = k == 0 ? n - 2 : k - 1;
            const double left = 1.0 / step(before), next = 1.0 / step(k);
            below[k] = left, above[k] = next, diagonal[k] = 2.0 * (left + next);
            right[k] = 3.0 * (left * left * rise(before) + next * next * rise(k));
        }
        if (!repeating) {
            eliminate(below, diagonal, above, right);
            slopes_ = right;
            return;
        }
        // The corners of the cyclic system are a change of rank one (Sherman and Morrison 1950).
        const double corner_low = above[rows - 1], corner_high = below[0], gamma = -diagonal[0];
        diagonal[0] -= gamma, diagonal[rows - 1] -= corner_low * corner_high / gamma;
        below[0] = above[rows - 1] = 0.0;
        std::vector<Vec3> change(rows, Vec3::Zero());
        change[0] = Vec3::Constant(gamma), change[rows - 1] += Vec3::Constant(corner_low);
        std::vector<double> copy = diagonal;
        eliminate(below, copy, above, change);
        eliminate(below, diagonal, above, right);
        const double ratio = corner_high / gamma;
        const Vec3 part = (right[0] + ratio * right[rows - 1]) / (1.0 + change[0].x() + ratio * change[rows - 1].x());
        for (std::size_t k = 0; k < rows; ++k) slopes_[k] = right[k] - change[k].x() * part;
        slopes_[n - 1] = slopes_[0];
    }
    static void eliminate(const std::vector<double>& below, std::vector<double>& diagonal, const std::vector<double>& above,
                          std::vector<Vec3>& x) {
        for (std::size_t k = 1; k < x.size(); ++k) {
            const double factor = below[k] / diagonal[k - 1];
            diagonal[k] -= factor * above[k - 1], x[k] -= factor * x[k - 1];
        }
        for (std::size_t k = x.size(); k-- > 0;)
            x[k] = (k + 1 < x.size() ? Vec3(x[k] - above[k] * x[k + 1]) : x[k]) / diagonal[k];
    }
    Vec3 evaluate(double t, int order) const {
        const double u = std::clamp(t, 0.0, 1.0) * breaks_.back();
        const auto after = std::upper_bound(breaks_.begin() + 1, breaks_.end() - 1, u);
        const std::size_t k = static_cast<std::size_t>(after - breaks_.begin()) - 1;
        const double h = step(k), s = (u - breaks_[k]) / h;
        const Vec3 a = h * slopes_[k] - rise(k),
                   b = rise(k) - h * slopes_[k + 1];  // Hermite form: chord and what bends away from it
        if (order == 0) return (1.0 - s) * points_[k] + s * points_[k + 1] + s * (1.0 - s) * ((1.0 - s) * a + s * b);
        if (order == 1) return (rise(k) + (1.0 - s) * (1.0 - 3.0 * s) * a + s * (2.0 - 3.0 * s) * b) / h;
        return ((6.0 * s - 4.0) * a + (2.0 - 6.0 * s) * b) / (h * h);
    }

    std::vector<Vec3> points_, slopes_;
    std::vector<double> breaks_;
};

/// The spline as a curve that owns it.
inline Curve curve_through(std::vector<Vec3> points, SplineEnds ends = SplineEnds::parabolic,
                           SplineSteps steps = SplineSteps::by_distance, const std::string& name = "Spline") {
    const auto spline = std::make_shared<const Spline>(std::move(points), ends, steps, name);
    return [spline](double t) { return (*spline)(t); };
}

/// Length of a curve from chords of `pieces` and of twice as many steps, of which the error of second order is taken out
/// (Richardson).
inline double length_of(const Curve& curve, Index pieces = 512) {
    core::require_at_least("length_of.pieces", pieces, 1);
    double coarse = 0.0, fine = 0.0;
    Vec3 last = curve(0.0), before = last;
    for (Index k = 1; k <= 2 * pieces; ++k) {
        const Vec3 next = curve(static_cast<double>(k) / static_cast<double>(2 * pieces));
        fine += (next - last).norm(), last = next;
        if (k % 2 == 0) coarse += (next - before).norm(), before = next;
    }
    return (4.0 * fine - coarse) / 3.0;
}

/// A curve beside frames of a path, which are apart by equal arcs: offset in its sections.
/// @param x,y  offset along the two directors [length]
inline Curve beside(const std::vector<NodeFrame>& frames, double x, double y, SplineEnds ends = SplineEnds::parabolic) {
    std::vector<Vec3> points;
    points.reserve(frames.size());
    for (const NodeFrame& frame : frames) points.push_back(frame.position + x * frame.director_1 + y * frame.director_2);
    // What a path that repeats is shifted by, and no more, so that a closed one closes.
    if (ends == SplineEnds::repeating) points.back() = points.front() + (frames.back().position - frames.front().position);
    return curve_through(std::move(points), ends, SplineSteps::even, "beside");
}

/// A curve beside a path: offset in its sections, which do not twist about it but for what is asked.
///
/// Sections of the path are carried along by parallel transport; of a path that repeats they are turned evenly, so that the last
/// one lies on the first. The offset turns by `turns` against them, evenly.
/// @param samples  at which the path is taken, at equal arc; the curve is the spline through them, >= 8
/// @param x,y      offset along the two directors at the start of the path [length]
/// @param turns    from one end to the other [1], > 0 right-handed
/// @param director  g_1 at the start is its part across the path; zero: any
inline Curve beside(const Curve& path, double x, double y, double turns, Index samples, const Vec3& director = Vec3::Zero(),
                    SplineEnds ends = SplineEnds::parabolic) {
    core::require_at_least("beside.samples", samples, 8);
    std::vector<NodeFrame> frames = reference_frames(path, samples + 1, director, false);
    if (ends == SplineEnds::repeating) turn_along(frames, closing_angle(frames));
    constexpr double full_turn = 6.283185307179586;
    turn_along(frames, full_turn * turns);
    return beside(frames, x, y, ends);
}

}  // namespace fibrant::scene
