// SPDX-License-Identifier: MIT
#pragma once
/// @file True gap between two pieces of fibres whose sections are ellipses in any strain, searched over abscissae and directions.

#include <fibrant/core/small_matrix.hpp>
#include <fibrant/core/symmetric_eigen.hpp>
#include <fibrant/observe/flat_gap.hpp>
#include <fibrant/observe/nodal_curve.hpp>
#include <fibrant/observe/snapshot.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace fibrant::observe {

/// A fibre as it stands: its curve, and half axes of its sections along it.
class FibreSurface {
public:
    explicit FibreSurface(const FibreSnapshot& fibre) : fibre_{&fibre}, curve_{fibre} {}

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
    double extent(double t, const Vec3& direction) const noexcept {
        return std::hypot(axis(0, t).dot(direction), axis(1, t).dot(direction));
    }
    /// Greatest half extent in any direction of the sections of an element's nodes, the one that holds a node interval [length].
    double greatest_extent(std::size_t piece) const noexcept {
        double most = 0.0;
        for (std::size_t node = piece - piece % 2, last = node + 2; node <= last; ++node)
            most = std::max(most, fibre_->section.greatest_extent(fibre_->director_1[node], fibre_->director_2[node]));
        return most;
    }
    /// How far the surface of a node interval gets along a unit direction, at most: of a curve through three of its sections,
    /// with four times what it may be beyond them [length].
    double furthest(std::size_t piece, const Vec3& direction) const noexcept {
        std::array<double, 3> at{}, one{}, two{};  // nodes of its element, along the direction
        const std::size_t node = piece - piece % 2;
        for (std::size_t k = 0; k < 3; ++k) {
            at[k] = fibre_->position[node + k].dot(direction);
            one[k] = fibre_->section.semi_axis_1 * fibre_->director_1[node + k].dot(direction);
            two[k] = fibre_->section.semi_axis_2 * fibre_->director_2[node + k].dot(direction);
        }
        const std::size_t from = piece % 2, other = 2 * (1 - from);  // nodes: the first of the interval, the one outside of it
        const auto half_way = [&](const std::array<double, 3>& of) {
            return 0.375 * of[2 - other] + 0.75 * of[1] - 0.125 * of[other];
        };
        const auto out = [](double x, double p, double q) { return x + std::sqrt(p * p + q * q); };
        const double first = out(at[from], one[from], two[from]), last = out(at[from + 1], one[from + 1], two[from + 1]),
                     middle = out(half_way(at), half_way(one), half_way(two));
        return std::max({first, middle, last}) + 0.5 * std::abs(first - 2.0 * middle + last);
    }
    /// All sections are round, undeformed and across nothing but themselves.
    bool round() const noexcept {
        const double rounding = 1e-12;
        if (fibre_->section.semi_axis_1 != fibre_->section.semi_axis_2) return false;
        for (std::size_t node = 0; node < fibre_->position.size(); ++node) {
            const Vec3 &p = fibre_->director_1[node], &q = fibre_->director_2[node];
            if (std::abs(p.squaredNorm() - 1.0) > rounding || std::abs(q.squaredNorm() - 1.0) > rounding ||
                std::abs(p.dot(q)) > rounding)
                return false;
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
/// pairs of sections. It is sought first among pairs in planes across the mean of the tangents, where n is one angle, sampled all
/// round and all along; from there, and from the closest points of the centrelines where a fibre ends, in both abscissae and all
/// directions. Nothing here knows of contact elements.
class PairedPieces {
public:
    /// @param from_i, from_j  first parameter of either node interval
    PairedPieces(const FibreSurface& i, const FibreSurface& j, double from_i, double from_j)
        : i_{i},
          j_{j},
          from_{from_i, from_j},
          sense_{i.curve().tangent(from_i + 0.5).dot(j.curve().tangent(from_j + 0.5)) < 0.0 ? -1.0 : 1.0} {}

    /// @param t, u  closest points of the two centrelines in the intervals
    /// @param most  gap beyond which it is not looked for [length]: one that is greater may be too great
    SurfaceGap closest(double t, double u, double most = std::numeric_limits<double>::infinity()) const {
        SurfaceGap least;
        const Vec3 apart = between(t, u);
        const auto offer = [&](const SurfaceGap& found) {
            if (found.gap < least.gap) least = found;
        };
        SurfaceGap planes = closest_of_planes(t, u);
        const bool apart_too = most > 0.0;  // what is apart stays so
        if (std::isfinite(planes.gap) && (apart_too || planes.gap < 0.0)) settle(planes), offer(planes);
        const bool at_end = i_.at_end(t) || j_.at_end(u);
        if (apart_too && (at_end || !std::isfinite(planes.gap))) {
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
    double value(double t, double u, const Vec3& n) const noexcept {
        return n.dot(between(t, u)) - i_.extent(t, n) - j_.extent(u, n);
    }
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
        const auto flat = [&](const FibreSurface& fibre, double s) {
            const Vec3 p = fibre.axis(0, s), q = fibre.axis(1, s);
            return FlatSection{{p.dot(e), p.dot(f)}, {q.dot(e), q.dot(f)}};
        };
        const FlatGap found = greatest_gap({flat(i_, t), flat(j_, u)}, {d.dot(e), d.dot(f)});
        return {found.gap, t, u, found.normal[0] * e + found.normal[1] * f};
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
        core::Two by_s{}, by_n{};
        core::TwoByTwo ss{}, nn{}, sn{};  // sn: rows abscissae
    };
    using Frame = std::array<Vec3, 2>;
    static core::Two rows(const Frame& rows, const Vec3& v) noexcept {
        const auto row = [&](const Vec3& r) { return r[0] * v[0] + r[1] * v[1] + r[2] * v[2]; };
        return {row(rows[0]), row(rows[1])};
    }
    /// Product of two vectors, summed up from the last component.
    static double from_behind(const Vec3& a, const Vec3& b) noexcept { return a[0] * b[0] + (a[1] * b[1] + a[2] * b[2]); }
    static Vec3 columns(const Frame& rows, const core::Two& by) noexcept {
        const auto entry = [&](Index k) { return rows[0][k] * by[0] + rows[1][k] * by[1]; };
        return {entry(0), entry(1), entry(2)};
    }
    Level level(const std::array<double, 2>& s, const Vec3& n, const Frame& frame) const noexcept {
        const std::array<const FibreSurface*, 2> fibre{&i_, &j_};
        Level made;
        Vec3 by_n = between(s[0], s[1]);
        std::array<std::array<double, 3>, 3> by_nn{};
        for (std::size_t k = 0; k < 2; ++k) {
            const double sign = k == 0 ? -1.0 : 1.0;
            const Vec3 x = fibre[k]->curve().tangent(s[k]), xx = fibre[k]->curve().second(s[k]);
            const Frame w{fibre[k]->axis(0, s[k]), fibre[k]->axis(1, s[k])};
            const Frame w_s{fibre[k]->axis(0, s[k], 1), fibre[k]->axis(1, s[k], 1)};
            const Frame w_ss{fibre[k]->axis(0, s[k], 2), fibre[k]->axis(1, s[k], 2)};
            const core::Two p = rows(w, n), p_s = rows(w_s, n), p_ss = rows(w_ss, n);
            // A section that is seen along the fibre has an edge there.
            const double h = std::max(core::norm(p), 1e-9 * std::sqrt(from_behind(w[0], w[0]) + from_behind(w[1], w[1])));
            const core::Two unit{p[0] / h, p[1] / h};
            const core::TwoByTwo across{core::Two{1.0 - unit[0] * unit[0], 0.0 - unit[0] * unit[1]},
                                        core::Two{0.0 - unit[1] * unit[0], 1.0 - unit[1] * unit[1]}};
            const core::Two turned = core::times(across, p_s);
            const Vec3 along = columns(w, unit), along_s = columns(w_s, unit), side = columns(w, turned);
            Vec3 mixed;
            for (Index r = 0; r < 3; ++r) {
                by_n[r] -= along[r];
                const core::Two row{w[0][r] * across[0][0] + w[1][r] * across[1][0],
                                    w[0][r] * across[0][1] + w[1][r] * across[1][1]};
                for (Index c = 0; c < 3; ++c) by_nn[core::at(r)][core::at(c)] -= (row[0] * w[0][c] + row[1] * w[1][c]) / h;
                mixed[r] = sign * x[r] - along_s[r] - side[r] / h;
            }
            made.by_s[k] = sign * x.dot(n) - core::dot(unit, p_s);
            made.ss[k][k] = sign * xx.dot(n) - core::dot(unit, p_ss) - core::dot(turned, turned) / h;
            made.sn[k] = rows(frame, mixed);
        }
        made.value = n.dot(by_n);
        made.by_n = rows(frame, by_n);
        for (std::size_t r = 0; r < 2; ++r) {
            Vec3 row;
            for (Index c = 0; c < 3; ++c) {
                const auto part = [&](std::size_t k) { return frame[r][static_cast<Index>(k)] * by_nn[k][core::at(c)]; };
                row[c] = part(0) + part(1) + part(2);
            }
            made.nn[r] = {from_behind(row, frame[0]), from_behind(row, frame[1])};
            made.nn[r][r] -= made.value;
        }
        return made;
    }
    static Frame across(const Vec3& n) noexcept {
        const Vec3 e = n.unitOrthogonal();
        return {e, n.cross(e)};
    }

    /// A step no longer than asked.
    static core::Two scaled(const core::Two& step, double most) noexcept {
        const double part = std::min(1.0, most / std::max(1e-300, core::norm(step)));
        return {step[0] * part, step[1] * part};
    }

    /// Greatest F of two sections uphill of n, among all directions of space; the flat end of a fibre may face the other one.
    /// @returns whether n lies on a flat end
    bool climb(const std::array<double, 2>& s, Vec3& n) const noexcept {
        double here = value(s[0], s[1], n);
        for (int iteration = 0; iteration < 100; ++iteration) {
            const Frame frame = across(n);
            const Level at = level(s, n, frame);
            core::Four second{at.nn[0][0], at.nn[1][0], 0.0, at.nn[1][1]}, vectors{};
            core::Two curved{};
            core::symmetric_eigen(2, second.data(), vectors.data(), curved.data());  // uphill, whichever way F is curved
            const core::TwoByTwo turning{core::Two{vectors[0], vectors[1]}, core::Two{vectors[2], vectors[3]}};
            const double least = 1e-9 * core::norm(at.nn) + 1e-300;
            core::Two step = core::times(turning, at.by_n);
            for (std::size_t k = 0; k < 2; ++k) step[k] /= std::max(std::abs(curved[k]), least);
            step = scaled(core::times(core::transposed(turning), step), 0.3);
            double next = here;
            Vec3 turned = n;
            int halvings = 0;
            for (; halvings < 30; ++halvings, step[0] *= 0.5, step[1] *= 0.5) {
                turned = Vec3(n + columns(frame, step)).normalized();
                next = value(s[0], s[1], turned);
                if (next >= here) break;
            }
            if (halvings == 30) break;
            n = turned, here = next;
            if (core::norm(step) < 1e-11) break;
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
            core::TwoByTwo second = at.ss;
            if (!faces) {
                const core::TwoByTwo half = core::times_transposed(at.sn, core::transposed(core::inverse(at.nn)));
                const core::TwoByTwo taken = core::times_transposed(half, at.sn);
                for (std::size_t r = 0; r < 2; ++r) second[r][0] -= taken[r][0], second[r][1] -= taken[r][1];
            }
            core::Two slope = at.by_s;
            for (std::size_t c = 0; c < 2; ++c)
                if ((s[c] <= from_[c] && slope[c] > 0.0) || (s[c] >= last[c] && slope[c] < 0.0)) {
                    second[c][0] = second[c][1] = second[0][c] = second[1][c] = 0.0;
                    second[c][c] = 1.0, slope[c] = 0.0;
                }
            const double size = core::norm(second);
            if (!(size > 0.0)) break;
            second[0][0] += 1e-9 * size, second[1][1] += 1e-9 * size;  // fibres side by side are as close all along
            const bool valley = core::determinant(second) > 0.0 && second[0][0] + second[1][1] > 0.0;
            core::Two step{-slope[0] / size, -slope[1] / size};
            if (valley) step = core::times(core::inverse(second), {-slope[0], -slope[1]});
            if (!std::isfinite(step[0]) || !std::isfinite(step[1])) break;
            const double part = std::min(1.0, 0.25 / std::max(1e-300, std::max(std::abs(step[0]), std::abs(step[1]))));
            step[0] *= part, step[1] *= part;
            bool lower = false;
            for (int halvings = 0; halvings < 20 && !lower; ++halvings, step[0] *= 0.5, step[1] *= 0.5) {
                const std::array<double, 2> next{std::clamp(s[0] + step[0], from_[0], last[0]),
                                                 std::clamp(s[1] + step[1], from_[1], last[1])};
                Vec3 turned = n;
                const bool facing_end = climb(next, turned);
                const double gap = value(next[0], next[1], turned);
                if (!(gap < here)) continue;
                s = next, n = turned, here = gap, faces = facing_end, lower = true;
            }
            if (!lower || core::norm(step) < 1e-8) break;  // the gap is level: its error is of second order
        }
        if (here < 0.0) return false;
        place = {here, s[0], s[1], n};
        return true;
    }

    /// Of two in each other: where F is level in both abscissae and in n, nearby and inside the intervals. Sections alone could
    /// be parted along the fibres, so it is no maximum among all directions.
    bool settle_within(SurfaceGap& place) const noexcept {
        std::array<double, 2> s{place.t, place.u};
        Vec3 n = place.normal;
        const double nearby = 0.9;  // cosine
        for (int iteration = 0; iteration < 20; ++iteration) {
            const Frame frame = across(n);
            const Level at = level(s, n, frame);
            const core::FourByFour second{core::Four{at.ss[0][0], at.ss[0][1], at.sn[0][0], at.sn[0][1]},
                                          core::Four{at.ss[1][0], at.ss[1][1], at.sn[1][0], at.sn[1][1]},
                                          core::Four{at.sn[0][0], at.sn[1][0], at.nn[0][0], at.nn[0][1]},
                                          core::Four{at.sn[0][1], at.sn[1][1], at.nn[1][0], at.nn[1][1]}};
            const core::Four back = core::solve(second, {at.by_s[0], at.by_s[1], at.by_n[0], at.by_n[1]});
            if (!std::all_of(back.begin(), back.end(), [](double value) { return std::isfinite(value); })) return false;
            s[0] -= back[0], s[1] -= back[1];
            n = Vec3(n + columns(frame, {-back[2], -back[3]})).normalized();
            for (std::size_t k = 0; k < 2; ++k)
                if (!(s[k] >= from_[k] && s[k] <= from_[k] + interval)) return false;
            if (!(n.dot(place.normal) > nearby)) return false;
            if (core::norm(core::TwoByTwo{core::Two{back[0], back[2]}, core::Two{back[1], back[3]}}) > 1e-10) continue;
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
