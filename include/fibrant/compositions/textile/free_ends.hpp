// SPDX-License-Identifier: MIT
#pragma once
/// @file Whether friction can keep yarns whose ends nothing holds: asked of their drawn paths, before any work.

#include <fibrant/compositions/textile/crossings.hpp>
#include <fibrant/scene/cross_section.hpp>

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace fibrant::compositions::textile {

/// Friction that a yarn whose ends are free needs, so that those across it do not push it off.
struct FrictionNeeded {
    double coefficient = 0.0;  ///< [1], >= 0; infinity: none is enough
    Index path = -1;           ///< that needs it; -1: none needs any
};

namespace detail {

/// Nothing holds its ends or a place of it, and it is bent as long as it does not lie on a straight line.
inline bool springs_back(const Path& path) {
    return path.kind == PathKind::open && path.ends == Ends::free && path.straight && path.guides.empty();
}

/// Yarns as slender beams over the places where they cross others, at rest where they are straight: deflections along the axis
/// of sight and slopes at these places, and the forces there.
class CrossedBeams {
public:
    explicit CrossedBeams(const Textile& textile) : textile_{textile}, lines_{lines_of(textile)} {
        place_knots();
        std::vector<Eigen::Triplet<double>> bending;
        double stiffest = 0.0, farthest = 0.0;
        for (std::size_t p = 0; p < arcs_.size(); ++p)
            for (std::size_t k = 0; k + 1 < arcs_[p].size(); ++k) {
                const double l = way(static_cast<Index>(p), k);
                const Eigen::Matrix4d element = stiffness(static_cast<Index>(p), l);
                const Index first = 2 * (start_[p] + static_cast<Index>(k));
                for (Index i = 0; i < 4; ++i)
                    for (Index j = 0; j < 4; ++j) bending.emplace_back(first + i, first + j, element(i, j));
                stiffest = std::max(stiffest, element(0, 0)), farthest = std::max(farthest, l);
            }
        // Of yarns that nothing bends any place is as good: next to no stiffness keeps them where they are.
        constexpr double hardly = 1e-7, hard = 1e3;  // of the stiffest piece of a yarn against a deflection
        const Index unknowns = 2 * start_.back();
        for (Index k = 0; k < unknowns; ++k)
            bending.emplace_back(k, k, hardly * stiffest * (k % 2 == 0 ? 1.0 : farthest * farthest));
        contact_ = hard * stiffest;
        forces_.assign(textile.crossings.size(), 0.0);
        solution_ = Vector::Zero(unknowns);
        for (Index p = 0; p < core::count(arcs_); ++p)
            for (std::size_t k = 0; k < arcs_[core::at(p)].size(); ++k)
                solution_[2 * (start_[core::at(p)] + static_cast<Index>(k))] =
                    point(p, arcs_[core::at(p)][k]).dot(textile.view.axis.normalized());
        if (stiffest > 0.0) solve(bending);
    }

    /// Friction that each yarn needs to be at rest: against what yarns across it push it to, for they lie on it aslant, and
    /// against its own bending in the plane.
    FrictionNeeded needed() const {
        std::vector<Vec3> push(arcs_.size(), Vec3::Zero());
        std::vector<double> pressed(arcs_.size(), 0.0);
        for (std::size_t c = 0; c < forces_.size(); ++c) {
            const Crossing& crossing = textile_.crossings[c];
            if (crossing.above == crossing.below) continue;
            const Vec3 along_a = along(crossing.above, crossing.at_above, crossing.axis),
                       along_b = along(crossing.below, crossing.at_below, crossing.axis);
            const double cosine = along_a.dot(along_b), sine_squared = 1.0 - cosine * cosine;
            constexpr double parallel = 0.03;  // 10 degrees: of lines along each other no place is theirs
            pressed[core::at(crossing.above)] += forces_[c], pressed[core::at(crossing.below)] += forces_[c];
            if (sine_squared < parallel) continue;
            const double a = slope(crossing.above, crossing.at_above), b = slope(crossing.below, crossing.at_below);
            // The normal, upwards 1, is across both yarns.
            const Vec3 aslant = -((a - cosine * b) * along_a + (b - cosine * a) * along_b) / sine_squared;
            push[core::at(crossing.above)] += forces_[c] * aslant, push[core::at(crossing.below)] -= forces_[c] * aslant;
        }
        FrictionNeeded answer;
        constexpr double nothing = 1e-4;  // of what bends a yarn by its radius between its crossings
        for (Index p = 0; p < core::count(arcs_); ++p) {
            const std::vector<double>& arcs = arcs_[core::at(p)];
            if (arcs.size() < 2 || !springs_back(textile_.paths[core::at(p)])) continue;
            const double force = push[core::at(p)].norm() + bent_in_plane(p),
                         mean = (arcs.back() - arcs.front()) / static_cast<double>(arcs.size() - 1);
            if (!(force > nothing * stiffness(p, mean)(0, 0) * textile_.type_of(p).radius)) continue;
            const double coefficient = force / std::max(pressed[core::at(p)], nothing * force);
            if (coefficient > answer.coefficient) answer = {coefficient, p};
        }
        return answer;
    }

private:
    /// Of a piece of a yarn between two knots, for deflection and slope at both: a slender beam.
    Eigen::Matrix4d stiffness(Index p, double l) const {
        const YarnType& type = textile_.type_of(p);
        const double bending = static_cast<double>(type.fibres) * type.material.young_modulus *
                               scene::circular(type.radius, type.inertia_factor).second_moment_1();
        Eigen::Matrix4d element;
        element << 12.0, 6.0 * l, -12.0, 6.0 * l, 6.0 * l, 4.0 * l * l, -6.0 * l, 2.0 * l * l, -12.0, -6.0 * l, 12.0, -6.0 * l,
            6.0 * l, 2.0 * l * l, -6.0 * l, 4.0 * l * l;
        return bending / (l * l * l) * element;
    }
    /// Places of a yarn that are within its thickness of each other are one, as those over the wefts of a column.
    void place_knots() {
        arcs_.resize(textile_.paths.size());
        for (const Crossing& crossing : textile_.crossings)
            if (crossing.above != crossing.below)
                arcs_[core::at(crossing.above)].push_back(crossing.at_above),
                    arcs_[core::at(crossing.below)].push_back(crossing.at_below);
        start_.push_back(0);
        for (std::size_t p = 0; p < arcs_.size(); ++p) {
            std::vector<double>& arcs = arcs_[p];
            const double apart = half_width(textile_.type_of(static_cast<Index>(p)));
            std::sort(arcs.begin(), arcs.end());
            std::vector<double> kept;
            for (const double arc : arcs)
                if (kept.empty() || arc - kept.back() > apart) kept.push_back(arc);
            arcs = kept;
            start_.push_back(start_.back() + core::count(arcs));
        }
    }
    Index knot(Index p, double arc) const {
        const std::vector<double>& arcs = arcs_[core::at(p)];
        const auto after = std::upper_bound(arcs.begin(), arcs.end(), arc);
        return start_[core::at(p)] + std::max<Index>(0, static_cast<Index>(after - arcs.begin()) - 1);
    }
    double slope(Index p, double arc) const { return solution_[2 * knot(p, arc) + 1]; }
    Vec3 point(Index p, double arc) const {
        const Line& line = lines_[core::at(p)];
        const auto after = std::upper_bound(line.arc.begin() + 1, line.arc.end() - 1, arc);
        const auto k = static_cast<std::size_t>(after - line.arc.begin());
        const double part = (arc - line.arc[k - 1]) / (line.arc[k] - line.arc[k - 1]);
        return (1.0 - part) * line.points[k - 1] + part * line.points[k];
    }
    /// From one knot to the next, as it is seen: what is straight there is so however it rises and falls.
    double way(Index p, std::size_t k) const {
        constexpr int chords = 16;
        const Vec3 axis = textile_.view.axis.normalized();
        const double from = arcs_[core::at(p)][k], to = arcs_[core::at(p)][k + 1];
        double sum = 0.0;
        Vec3 last = point(p, from);
        for (int c = 1; c <= chords; ++c) {
            const Vec3 next = point(p, from + (to - from) * c / chords), chord = next - last;
            sum += (chord - chord.dot(axis) * axis).norm(), last = next;
        }
        return sum;
    }
    /// Unit direction of a yarn as it is seen.
    Vec3 along(Index p, double arc, const Vec3& axis) const {
        const double step = textile_.type_of(p).radius;
        Vec3 chord = point(p, arc + step) - point(p, arc - step);
        chord -= chord.dot(axis) * axis;
        return chord.normalized();
    }
    /// Sum of the forces in the plane that keep a yarn on its path through its crossings.
    double bent_in_plane(Index p) const {
        const std::vector<double>& arcs = arcs_[core::at(p)];
        const Index n = core::count(arcs);
        if (n < 3) return 0.0;
        const Vec3 axis = textile_.view.axis.normalized();
        Matrix places(n, 3), slopes = Matrix::Zero(n, 3), forces = Matrix::Zero(n, 3);
        for (Index k = 0; k < n; ++k) {
            const Vec3 place = point(p, arcs[core::at(k)]);
            places.row(k) = place - place.dot(axis) * axis;
        }
        // No moment acts at a knot: a tridiagonal system for the slopes, solved from the first one on and back.
        std::vector<Eigen::Matrix4d> pieces;
        Vector pivot = Vector::Zero(n);
        for (Index k = 0; k + 1 < n; ++k) {
            const Eigen::Matrix4d& e = pieces.emplace_back(stiffness(p, way(p, core::at(k))));
            pivot[k] += e(1, 1), pivot[k + 1] += e(3, 3);
            slopes.row(k) -= e(1, 0) * places.row(k) + e(1, 2) * places.row(k + 1);
            slopes.row(k + 1) -= e(3, 0) * places.row(k) + e(3, 2) * places.row(k + 1);
        }
        for (Index k = 0; k + 1 < n; ++k) {
            const double factor = pieces[core::at(k)](1, 3) / pivot[k];
            pivot[k + 1] -= factor * pieces[core::at(k)](1, 3), slopes.row(k + 1) -= factor * slopes.row(k);
        }
        slopes.row(n - 1) /= pivot[n - 1];
        for (Index k = n - 2; k >= 0; --k)
            slopes.row(k) = (slopes.row(k) - pieces[core::at(k)](1, 3) * slopes.row(k + 1)) / pivot[k];
        for (Index k = 0; k + 1 < n; ++k)
            for (const Index end : {0, 1}) {
                const Eigen::RowVector4d e = pieces[core::at(k)].row(2 * end);
                forces.row(k + end) +=
                    e[0] * places.row(k) + e[1] * slopes.row(k) + e[2] * places.row(k + 1) + e[3] * slopes.row(k + 1);
            }
        return forces.rowwise().norm().sum();
    }
    /// Yarns may not be in each other: Newton's method on a penalty, which is convex, each step as long as its energy falls.
    void solve(const std::vector<Eigen::Triplet<double>>& entries) {
        constexpr int most = 100, halvings = 20;  // iterations: five to fifteen are usual; of the length of a step
        constexpr double small = 1e-9;            // of the forces
        const Index unknowns = 2 * start_.back();
        using Sparse = Eigen::SparseMatrix<double>;
        Sparse bending(unknowns, unknowns);
        bending.setFromTriplets(entries.begin(), entries.end());
        const auto each = [&](const auto& with) {
            for (std::size_t c = 0; c < forces_.size(); ++c) {
                const Crossing& crossing = textile_.crossings[c];
                if (crossing.above == crossing.below) continue;
                with(c, 2 * knot(crossing.above, crossing.at_above), 2 * knot(crossing.below, crossing.at_below),
                     half_thickness(textile_.type_of(crossing.above)) + half_thickness(textile_.type_of(crossing.below)));
            }
        };
        const auto residual = [&](const Vector& x) {
            Vector sum = bending * x;
            each([&](std::size_t c, Index a, Index b, double apart) {
                forces_[c] = contact_ * std::max(0.0, apart - x[a] + x[b]);
                sum[a] -= forces_[c], sum[b] += forces_[c];
            });
            return sum;
        };
        for (int iteration = 0; iteration < most; ++iteration) {
            const Vector left = residual(solution_);
            double pressing = 0.0;
            std::vector<Eigen::Triplet<double>> touching;
            each([&](std::size_t c, Index a, Index b, double) {
                if (!(forces_[c] > 0.0)) return;
                pressing = std::max(pressing, forces_[c]);
                touching.emplace_back(a, a, contact_), touching.emplace_back(b, b, contact_);
                touching.emplace_back(a, b, -contact_), touching.emplace_back(b, a, -contact_);
            });
            if (left.cwiseAbs().maxCoeff() <= small * pressing) return;
            Sparse matrix(unknowns, unknowns);
            matrix.setFromTriplets(touching.begin(), touching.end());
            matrix += bending;
            const Vector step = Eigen::SimplicialLDLT<Sparse>(matrix).solve(-left);
            double low = 0.0, high = 1.0;
            if (residual(solution_ + step).dot(step) > 0.0)
                for (int k = 0; k < halvings; ++k) {
                    const double middle = 0.5 * (low + high);
                    (residual(solution_ + middle * step).dot(step) > 0.0 ? high : low) = middle;
                }
            solution_ += high * step;
        }
    }

    const Textile& textile_;
    std::vector<Line> lines_;
    std::vector<std::vector<double>> arcs_{};
    std::vector<Index> start_{};  ///< of the knots of each path, and their count
    double contact_ = 0.0;
    Vector solution_{};
    std::vector<double> forces_{};
};

}  // namespace detail

/// Friction that keeps yarns whose ends are free, straight at rest, in the places where they are drawn: what interlaces them
/// bends them, and, since they lie aslant on each other, pushes the outermost ones off. It is the balance of each yarn's forces
/// in the plane, for small slopes, and necessary. Yarns that interlace on straight lines, as two warps and their wefts may, need
/// none; those round a line (`View::radial`) are held by no friction. Of yarns at rest as drawn, which push no longer than they
/// overlap, nothing is asked.
inline FrictionNeeded friction_that_holds(const Textile& textile) {
    const auto& paths = textile.paths;
    const auto first = std::find_if(paths.begin(), paths.end(), detail::springs_back);
    if (first == paths.end() || textile.crossings.empty()) return {};
    if (textile.view.radial) return {std::numeric_limits<double>::infinity(), static_cast<Index>(first - paths.begin())};
    return detail::CrossedBeams(textile).needed();
}

}  // namespace fibrant::compositions::textile
