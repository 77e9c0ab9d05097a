// SPDX-License-Identifier: MIT
#pragma once
/// @file True gap between two pieces of fibres whose sections are ellipses in any strain, searched over abscissae and directions.

#include <fibrant/core/symmetric_eigen.hpp>
#include <fibrant/observe/nodal_curve.hpp>
#include <fibrant/observe/snapshot.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

namespace fibrant::observe {

/// A fibre as it stands: its curve, and half axes of its sections along it.
class FibreSurface {
public:
    explicit FibreSurface(const FibreSnapshot& fibre) : fibre_{&fibre}, curve_{fibre.position} {}

    const NodalCurve& curve() const noexcept { return curve_; }
    /// The parameter is where the fibre ends, flat.
    bool at_end(double t) const noexcept { return !fibre_->closed && (t <= 0.0 || t >= curve_.end()); }
    /// Half axis a g_1 (which = 0) or b g_2 (which = 1) of the section at t, or its first or second derivative by t [length].
    Vec3 axis(int which, double t, int derivative = 0) const noexcept {
        const std::span<const Vec3> directors{which == 0 ? fibre_->director_1 : fibre_->director_2};
        const double size = which == 0 ? fibre_->section.semi_axis_1 : fibre_->section.semi_axis_2;
        if (derivative == 0) return size * curve_.interpolate(directors, t);
        const NodalCurve along{directors};
        return size * (derivative == 1 ? along.tangent(t) : along.second(t));
    }
    /// Half extent of the section at t along a unit direction [length].
    double extent(double t, const Vec3& direction) const noexcept { return std::hypot(axis(0, t).dot(direction), axis(1, t).dot(direction)); }
    /// Greatest half extent in any direction of the sections of an element's nodes, the one that holds a node interval [length].
    double greatest_extent(std::size_t piece) const noexcept {
        double most = 0.0;
        for (std::size_t node = piece - piece % 2, last = node + 2; node <= last; ++node)
            most = std::max(most, fibre_->section.greatest_extent(fibre_->director_1[node], fibre_->director_2[node]));
        return most;
    }
    /// All sections are round, undeformed and across nothing but themselves.
    bool round() const noexcept {
        const double rounding = 1e-12;
        if (fibre_->section.semi_axis_1 != fibre_->section.semi_axis_2) return false;
        for (std::size_t node = 0; node < fibre_->position.size(); ++node) {
            const Vec3 &p = fibre_->director_1[node], &q = fibre_->director_2[node];
            if (std::abs(p.squaredNorm() - 1.0) > rounding || std::abs(q.squaredNorm() - 1.0) > rounding || std::abs(p.dot(q)) > rounding) return false;
        }
        return true;
    }

private:
    const FibreSnapshot* fibre_;
    NodalCurve curve_;
};

/// Where two pieces of fibres are closest, and by how much.
struct SurfaceGap {
    double gap = std::numeric_limits<double>::infinity();  ///< < 0 in penetration [length]
    double t = 0.0, u = 0.0;                               ///< parameters of the two sections
    Vec3 normal = Vec3::Zero();                            ///< from the first to the second
};

/// Two fibres within one node interval each.
///
/// The gap of two sections is the greatest F(n) = n.d - h_i(n) - h_j(n) over unit directions, that of two surfaces its least over
/// pairs of sections. It is sought first among pairs in planes across the mean of the tangents, where n is one angle, sampled all round
/// and all along; from there, and from the closest points of the centrelines where a fibre ends, in both abscissae and all
/// directions. Nothing here knows of contact elements.
class PairedPieces {
public:
    /// @param from_i, from_j  first parameter of either node interval
    PairedPieces(const FibreSurface& i, const FibreSurface& j, double from_i, double from_j) : i_{i}, j_{j}, from_{from_i, from_j},
          sense_{i.curve().tangent(from_i + 0.5).dot(j.curve().tangent(from_j + 0.5)) < 0.0 ? -1.0 : 1.0} {}

    /// @param t, u  closest points of the two centrelines in the intervals
    SurfaceGap closest(double t, double u) const {
        SurfaceGap least;
        const Vec3 apart = between(t, u);
        const auto offer = [&](const SurfaceGap& found) {
            if (found.gap < least.gap) least = found;
        };
        SurfaceGap planes = closest_of_planes(t, u);
        if (std::isfinite(planes.gap)) settle(planes), offer(planes);
        const bool at_end = i_.at_end(t) || j_.at_end(u);
        if (at_end || !std::isfinite(planes.gap)) {
            SurfaceGap centres{0.0, t, u, apart.norm() > 0.0 ? Vec3(apart.normalized()) : Vec3(Vec3::UnitZ())};
            if (settle(centres)) offer(centres);
        }
        // Tubes that cross cannot be parted along either of them: deep in each other, sections alone could be.
        const Vec3 t_i = i_.curve().tangent(t).normalized(), t_j = j_.curve().tangent(u).normalized(), both = t_i.cross(t_j);
        const double crossing_sine = 0.5, off = 0.1;
        if (least.gap < 0.0 && both.norm() > crossing_sine && inside(t, u)) {
            const Vec3 n = both.dot(apart) < 0.0 ? Vec3(-both.normalized()) : Vec3(both.normalized());
            if (std::abs(n.dot(least.normal)) < 1.0 - off) offer({value(t, u, n), t, u, n});
        }
        return least;
    }

private:
    static constexpr double tolerance = 1e-9;
    static constexpr double interval = 1.0 - 1e-10;  // a node itself belongs to the element that follows

    Vec3 between(double t, double u) const noexcept { return j_.curve().position(u) - i_.curve().position(t); }
    double value(double t, double u, const Vec3& n) const noexcept { return n.dot(between(t, u)) - i_.extent(t, n) - j_.extent(u, n); }
    bool inside(double t, double u) const noexcept {
        return t > from_[0] && t < from_[0] + 1.0 && u > from_[1] && u < from_[1] + 1.0;
    }
    Vec3 mean(double t, double u) const noexcept {
        const Vec3 a = i_.curve().tangent(t).normalized(), b = j_.curve().tangent(u).normalized();
        return (a + sense_ * b).normalized();
    }
    /// Parameter of one fibre in the plane across the mean tangent through a point of the other, not bound to its interval.
    double facing(bool of_i, double given, double start) const noexcept {
        double sought = start;
        for (int iteration = 0; iteration < 20; ++iteration) {
            const double t = of_i ? sought : given, u = of_i ? given : sought;
            const Vec3 m = mean(t, u);
            const double speed = of_i ? -i_.curve().tangent(t).dot(m) : j_.curve().tangent(u).dot(m);
            if (speed == 0.0) break;
            const double step = std::clamp(-between(t, u).dot(m) / speed, -1.0, 1.0), bound = of_i ? from_[0] : from_[1];
            const double next = std::clamp(sought + step, bound - 1.0, bound + 2.0);
            const bool still = std::abs(next - sought) < 1e-12;
            sought = next;
            if (still) break;
        }
        return sought;
    }

    /// Greatest gap of two sections among the directions across m, looked for all round.
    SurfaceGap greatest_across(double t, double u, const Vec3& m) const {
        const Vec3 e = m.unitOrthogonal(), f = m.cross(e), d = between(t, u);
        struct Flat {
            Eigen::Vector2d p, q;
        };
        const auto flat = [&](const FibreSurface& fibre, double s) {
            const Vec3 p = fibre.axis(0, s), q = fibre.axis(1, s);
            return Flat{{p.dot(e), p.dot(f)}, {q.dot(e), q.dot(f)}};
        };
        const std::array<Flat, 2> sections{flat(i_, t), flat(j_, u)};
        const Eigen::Vector2d apart{d.dot(e), d.dot(f)};
        const auto slope = [&](double angle, double& gap) {
            const Eigen::Vector2d n{std::cos(angle), std::sin(angle)}, across{-n[1], n[0]};
            gap = apart.dot(n);
            double sum = apart.dot(across);
            for (const Flat& s : sections) {
                const double p = s.p.dot(n), q = s.q.dot(n), h = std::hypot(p, q);
                gap -= h;
                if (h > 0.0) sum -= (p * s.p.dot(across) + q * s.q.dot(across)) / h;
            }
            return sum;
        };
        // All round, and at the thinnest and widest directions: between two of these no peak is hidden.
        constexpr int around = 24;
        std::array<double, around + 8> angles{};
        for (int k = 0; k < around; ++k) angles[core::at(k)] = 2.0 * std::numbers::pi * k / around;
        for (std::size_t s = 0; s < 2; ++s) {
            const Eigen::Vector2d &p = sections[s].p, &q = sections[s].q;
            const double wide = 0.5 * std::atan2(2.0 * (p[0] * p[1] + q[0] * q[1]), p[0] * p[0] + q[0] * q[0] - p[1] * p[1] - q[1] * q[1]);
            for (std::size_t k = 0; k < 4; ++k) {
                const double angle = wide + 0.5 * std::numbers::pi * static_cast<double>(k);
                angles[around + 4 * s + k] = angle - 2.0 * std::numbers::pi * std::floor(angle / (2.0 * std::numbers::pi));
            }
        }
        std::sort(angles.begin(), angles.end());
        double best = 0.0, most = -std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < angles.size(); ++k) {
            double low = angles[k], high = k + 1 < angles.size() ? angles[k + 1] : angles[0] + 2.0 * std::numbers::pi, gap = 0.0;
            if (!(slope(low, gap) >= 0.0)) continue;
            if (gap > most) most = gap, best = low;
            if (!(slope(high, gap) <= 0.0)) continue;
            for (int halving = 0; halving < 50 && high - low > 1e-9; ++halving) {
                const double middle = 0.5 * (low + high);
                (slope(middle, gap) > 0.0 ? low : high) = middle;
            }
            slope(0.5 * (low + high), gap);
            if (gap > most) most = gap, best = 0.5 * (low + high);
        }
        return {most, t, u, std::cos(best) * e + std::sin(best) * f};
    }

    /// Least of that over pairs of sections in planes across the mean tangent; infinite if no such pair is in both intervals.
    SurfaceGap closest_of_planes(double t, double u) const {
        double low = from_[0], high = from_[0] + 1.0;
        const double a = facing(true, from_[1], t), b = facing(true, from_[1] + 1.0, t);
        low = std::max(low, std::min(a, b)), high = std::min(high, std::max(a, b));
        if (!(low <= high)) return {};
        const auto at = [&](double s) {
            const double v = facing(false, s, u);
            if (v < from_[1] - tolerance || v > from_[1] + 1.0 + tolerance) return SurfaceGap{};
            const double inside = std::clamp(v, from_[1], from_[1] + 1.0);
            return greatest_across(s, inside, mean(s, inside));
        };
        constexpr int parts = 8;
        SurfaceGap least;
        double width = (high - low) / parts;
        for (int k = 0; k <= parts; ++k) {
            const SurfaceGap found = at(low + width * k);
            if (found.gap < least.gap) least = found;
        }
        if (!std::isfinite(least.gap)) return least;
        for (; width > 1e-4; width *= 0.5)  // down to where Newton's method takes over
            for (const double s : {least.t - 0.5 * width, least.t + 0.5 * width}) {
                if (s < low || s > high) continue;
                const SurfaceGap found = at(s);
                if (found.gap < least.gap) least = found;
            }
        return least;
    }

    /// F with its slopes and second derivatives by both abscissae and by n in a frame across it.
    struct Level {
        double value = 0.0;
        Eigen::Vector2d by_s, by_n;
        Eigen::Matrix2d ss, nn, sn;  // sn: rows abscissae
    };
    Level level(const std::array<double, 2>& s, const Vec3& n, const Eigen::Matrix<double, 2, 3>& frame) const noexcept {
        const std::array<const FibreSurface*, 2> fibre{&i_, &j_};
        Level made;
        made.ss.setZero();
        Vec3 by_n = between(s[0], s[1]);
        Mat3 by_nn = Mat3::Zero();
        for (std::size_t k = 0; k < 2; ++k) {
            const double sign = k == 0 ? -1.0 : 1.0;
            const Vec3 x = fibre[k]->curve().tangent(s[k]), xx = fibre[k]->curve().second(s[k]);
            Eigen::Matrix<double, 2, 3> w, w_s, w_ss;
            for (int axis = 0; axis < 2; ++axis) {
                w.row(axis) = fibre[k]->axis(axis, s[k]).transpose();
                w_s.row(axis) = fibre[k]->axis(axis, s[k], 1).transpose();
                w_ss.row(axis) = fibre[k]->axis(axis, s[k], 2).transpose();
            }
            const Eigen::Vector2d p = w * n, p_s = w_s * n, p_ss = w_ss * n;
            const double h = std::max(p.norm(), 1e-9 * w.norm());  // a section that is seen along the fibre has an edge there
            const Eigen::Vector2d unit = p / h;
            const Eigen::Matrix2d across = Eigen::Matrix2d::Identity() - unit * unit.transpose();
            by_n -= w.transpose() * unit;
            by_nn -= w.transpose() * across * w / h;
            const auto c = static_cast<Index>(k);
            made.by_s[c] = sign * x.dot(n) - unit.dot(p_s);
            made.ss(c, c) = sign * xx.dot(n) - unit.dot(p_ss) - (across * p_s).squaredNorm() / h;
            const Vec3 mixed = sign * x - w_s.transpose() * unit - w.transpose() * (across * p_s) / h;
            made.sn.row(c) = (frame * mixed).transpose();
        }
        made.value = n.dot(by_n);
        made.by_n = frame * by_n;
        made.nn = frame * by_nn * frame.transpose() - made.value * Eigen::Matrix2d::Identity();
        return made;
    }
    static Eigen::Matrix<double, 2, 3> across(const Vec3& n) noexcept {
        const Vec3 e = n.unitOrthogonal();
        Eigen::Matrix<double, 2, 3> frame;
        frame << e.transpose(), n.cross(e).transpose();
        return frame;
    }

    /// Greatest F of two sections uphill of n, among all directions of space; the flat end of a fibre may face the other one.
    /// @returns whether n lies on a flat end
    bool climb(const std::array<double, 2>& s, Vec3& n) const noexcept {
        double here = value(s[0], s[1], n);
        for (int iteration = 0; iteration < 100; ++iteration) {
            const Eigen::Matrix<double, 2, 3> frame = across(n);
            const Level at = level(s, n, frame);
            const core::SymmetricEigen<2> turning(at.nn);  // uphill, whichever way F is curved
            const Eigen::Vector2d curved = turning.values().cwiseAbs().cwiseMax(1e-9 * at.nn.norm() + 1e-300);
            Eigen::Vector2d step = turning.vectors() * (turning.vectors().transpose() * at.by_n).cwiseQuotient(curved);
            step *= std::min(1.0, 0.3 / std::max(1e-300, step.norm()));
            double next = here;
            Vec3 turned = n;
            int halvings = 0;
            for (; halvings < 30; ++halvings, step *= 0.5) {
                turned = (n + frame.transpose() * step).normalized();
                next = value(s[0], s[1], turned);
                if (next >= here) break;
            }
            if (halvings == 30) break;
            n = turned, here = next;
            if (step.norm() < 1e-11) break;
        }
        bool faces = false;
        const std::array<const FibreSurface*, 2> fibre{&i_, &j_};
        for (std::size_t k = 0; k < 2; ++k) {
            if (!fibre[k]->at_end(s[k])) continue;
            Vec3 end = fibre[k]->axis(0, s[k]).cross(fibre[k]->axis(1, s[k])).normalized();
            if (end.dot(n) < 0.0) end = -end;
            if (!(value(s[0], s[1], end) >= here)) continue;
            n = end, here = value(s[0], s[1], end), faces = true;
        }
        return faces;
    }

    /// The pair of sections nearby, in the intervals, at which their gap is least, with any direction of space.
    /// @returns false, and the place as it was, if none is found
    bool settle(SurfaceGap& place) const noexcept {
        if (place.gap < 0.0) return settle_within(place);
        std::array<double, 2> s{place.t, place.u}, last{from_[0] + interval, from_[1] + interval};
        if (from_[0] + 1.0 >= i_.curve().end()) last[0] = i_.curve().end();
        if (from_[1] + 1.0 >= j_.curve().end()) last[1] = j_.curve().end();
        Vec3 n = place.normal;
        bool faces = climb(s, n);
        double here = value(s[0], s[1], n);
        for (int iteration = 0; iteration < 60; ++iteration) {
            const Level at = level(s, n, across(n));
            Eigen::Matrix2d second = at.ss;
            if (!faces) second -= at.sn * at.nn.inverse() * at.sn.transpose();
            Eigen::Vector2d slope = at.by_s;
            for (Index c = 0; c < 2; ++c)
                if ((s[core::at(c)] <= from_[core::at(c)] && slope[c] > 0.0) || (s[core::at(c)] >= last[core::at(c)] && slope[c] < 0.0)) {
                    second.row(c).setZero(), second.col(c).setZero();
                    second(c, c) = 1.0, slope[c] = 0.0;
                }
            const double size = second.norm();
            if (!(size > 0.0)) break;
            second += 1e-9 * size * Eigen::Matrix2d::Identity();  // fibres side by side are as close all along
            const bool valley = second.determinant() > 0.0 && second.trace() > 0.0;
            Eigen::Vector2d step = valley ? Eigen::Vector2d(-second.inverse() * slope) : Eigen::Vector2d(-slope / size);
            if (!step.allFinite()) break;
            step *= std::min(1.0, 0.25 / std::max(1e-300, step.cwiseAbs().maxCoeff()));
            bool lower = false;
            for (int halvings = 0; halvings < 20 && !lower; ++halvings, step *= 0.5) {
                const std::array<double, 2> next{std::clamp(s[0] + step[0], from_[0], last[0]), std::clamp(s[1] + step[1], from_[1], last[1])};
                Vec3 turned = n;
                const bool facing_end = climb(next, turned);
                const double gap = value(next[0], next[1], turned);
                if (!(gap < here)) continue;
                s = next, n = turned, here = gap, faces = facing_end, lower = true;
            }
            if (!lower || step.norm() < 1e-8) break;  // the gap is level: its error is of second order
        }
        if (here < 0.0) return false;
        place = {here, s[0], s[1], n};
        return true;
    }

    /// Of two in each other: where F is level in both abscissae and in n, nearby and inside the intervals. Sections alone could be
    /// parted along the fibres, so it is no maximum among all directions.
    bool settle_within(SurfaceGap& place) const noexcept {
        std::array<double, 2> s{place.t, place.u};
        Vec3 n = place.normal;
        const double nearby = 0.9;  // cosine
        for (int iteration = 0; iteration < 20; ++iteration) {
            const Eigen::Matrix<double, 2, 3> frame = across(n);
            const Level at = level(s, n, frame);
            Eigen::Matrix4d second;
            second << at.ss, at.sn, at.sn.transpose(), at.nn;
            Eigen::Vector4d slope;
            slope << at.by_s, at.by_n;
            const Eigen::Vector4d step = -second.fullPivLu().solve(slope);
            if (!step.allFinite()) return false;
            s[0] += step[0], s[1] += step[1];
            n = (n + frame.transpose() * step.tail<2>()).normalized();
            for (std::size_t k = 0; k < 2; ++k)
                if (!(s[k] >= from_[k] && s[k] <= from_[k] + interval)) return false;
            if (!(n.dot(place.normal) > nearby)) return false;
            if (step.norm() > 1e-10) continue;
            place = {value(s[0], s[1], n), s[0], s[1], n};
            return true;
        }
        return false;
    }

    const FibreSurface &i_, &j_;
    std::array<double, 2> from_;
    double sense_;  // of the second tangent in the mean: at a right angle either will do, but the same all along
};

}  // namespace fibrant::observe
