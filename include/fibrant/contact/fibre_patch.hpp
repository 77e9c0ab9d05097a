// SPDX-License-Identifier: MIT
#pragma once
/// @file Patches over which two fibres touch: means of their centrelines, and the pair of patches that is closest.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/core/symmetric_eigen.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace fibrant::contact {

/// Two fibres touch over a patch of about a radius to either side, over which centrelines and sections are averaged. A force at a
/// point bends and shears a centreline into a corner there, in which the closest point hops, and is worth more or less between
/// nodes than at them; a mean over up to one element has a continuous tangent, and a force that is spread as it is averaged. Half
/// of it [radius], and at most [element].
inline constexpr double patch_half = 1.0, most_patch_half = 0.5;

/// Mean of a fibre over [u - half, u + half].
template <class B>
class Patches {
public:
    Patches(const beam::Mesh<B>& mesh, const Vector& state) noexcept : mesh_{&mesh}, state_{&state} {}

    /// Mean of the centreline [length].
    Vec3 place(Index fibre, double u, double half) const noexcept {
        Vec3 sum = Vec3::Zero();
        each_sample(fibre, u, half, [&](Index e, double xi, double weight) {
            sum +=
                weight * beam::Mesh<B>::centre(*state_, mesh_->first_unknown(fibre, around(fibre, e)), B::centreline_weights(xi));
        });
        return sum;
    }
    /// Its derivatives by u [length].
    Vec3 tangent(Index fibre, double u, double half) const noexcept {
        return (at<0>(fibre, u + half) - at<0>(fibre, u - half)) / (2.0 * half);
    }
    Vec3 bend(Index fibre, double u, double half) const noexcept {
        return (at<1>(fibre, u + half) - at<1>(fibre, u - half)) / (2.0 * half);
    }

    /// Calls see(element, xi, weight) at points whose weighted sum is the mean: exact for cubics.
    template <class See>
    void each_sample(Index fibre, double u, double half, const See& see) const noexcept {
        const double gauss = 0.5 / std::sqrt(3.0);
        double from = u - half;
        while (from < u + half - 1e-12) {
            const auto [e, xi] = located(fibre, from + 1e-12);
            // What reaches beyond an end is the last element, drawn out.
            const bool last = !mesh_->fibre(fibre).closed && e + 1 >= mesh_->fibre(fibre).elements;
            const double to = last ? u + half : std::min(u + half, static_cast<double>(e + 1));
            for (const double side : {-gauss, gauss}) {
                const double v = 0.5 * (from + to) + side * (to - from);
                see(e, 2.0 * (v - static_cast<double>(e)) - 1.0, 0.5 * (to - from) / (2.0 * half));
            }
            from = to;
        }
    }
    /// Element that holds u, and its natural coordinate: beyond [-1, 1] beyond an end. Those of a closed fibre count on around
    /// it.
    std::pair<Index, double> located(Index fibre, double u) const noexcept {
        Index e = static_cast<Index>(std::floor(u));
        if (!mesh_->fibre(fibre).closed) e = std::clamp<Index>(e, 0, mesh_->fibre(fibre).elements - 1);
        return {e, 2.0 * (u - static_cast<double>(e)) - 1.0};
    }
    Index around(Index fibre, Index e) const noexcept {
        const Index n = mesh_->fibre(fibre).elements;
        return mesh_->fibre(fibre).closed ? (e % n + n) % n : e;
    }

private:
    template <int Derivative>
    Vec3 at(Index fibre, double u) const noexcept {
        const auto [e, xi] = located(fibre, u);
        const Index first = mesh_->first_unknown(fibre, around(fibre, e));
        if constexpr (Derivative == 0)
            return beam::Mesh<B>::centre(*state_, first, B::centreline_weights(xi));
        else
            return 2.0 * beam::Mesh<B>::centre(*state_, first, B::centreline_derivative_weights(xi));
    }
    const beam::Mesh<B>* mesh_;
    const Vector* state_;
};

/// Half of the patches of a pair on one of its fibres [elements].
template <class B>
double half_of_patch(const beam::Mesh<B>& mesh, Index i, Index j, Index of) noexcept {
    const double radius = 0.5 * (mesh.fibre(i).section.radius() + mesh.fibre(j).section.radius());
    return std::min(most_patch_half, patch_half * radius / mesh.fibre(of).element_length);
}

/// What two patches are to each other, to second order.
struct PairGeometry {
    Vec3 centres;               ///< x_j - x_i [length]
    Vec3 t_i, t_j;              ///< unit tangents
    double speed_i, speed_j;    ///< |dx/du| [length]
    Vec3 bend_i, bend_j;        ///< second derivatives by arc length [1 / length]
    Eigen::Matrix2d closeness;  ///< second derivatives of |x_j - x_i|^2 / 2 by both arc lengths [1]
};

/// How two fibres stand to each other at u_i and u_j, as means over patches about these.
template <class B>
PairGeometry pair_geometry(const beam::Mesh<B>& mesh, const Vector& state, Index i, Index j, double u_i, double u_j) noexcept {
    const Patches<B> patches(mesh, state);
    const double half_i = half_of_patch(mesh, i, j, i), half_j = half_of_patch(mesh, i, j, j);
    PairGeometry pair;
    pair.centres = patches.place(j, u_j, half_j) - patches.place(i, u_i, half_i);
    const Vec3 d_i = patches.tangent(i, u_i, half_i), d_j = patches.tangent(j, u_j, half_j);
    pair.speed_i = d_i.norm(), pair.speed_j = d_j.norm();
    pair.t_i = d_i / pair.speed_i, pair.t_j = d_j / pair.speed_j;
    const Vec3 bend_i = patches.bend(i, u_i, half_i), bend_j = patches.bend(j, u_j, half_j);
    const double square_i = pair.speed_i * pair.speed_i, square_j = pair.speed_j * pair.speed_j, cosine = pair.t_i.dot(pair.t_j);
    pair.bend_i = bend_i / square_i, pair.bend_j = bend_j / square_j;
    pair.closeness(0, 0) = 1.0 - pair.centres.dot(bend_i) / square_i;
    pair.closeness(1, 1) = 1.0 + pair.centres.dot(bend_j) / square_j;
    pair.closeness(0, 1) = pair.closeness(1, 0) = -cosine;
    return pair;
}

/// A symmetric matrix with its eigenvalues raised to at least `least`.
inline Eigen::Matrix2d raised(const Eigen::Matrix2d& matrix, double least) noexcept {
    const core::SymmetricEigen<2> parts(matrix);
    return parts.values()[0] >= least ? matrix : parts.raised(least);
}

/// How a pair of patches may slide on its two fibres while a place is followed.
struct Slide {
    enum Kind : std::int8_t { freely, along, nowhere };
    Kind kind = freely;
    Eigen::Vector2d direction = Eigen::Vector2d::Zero();  ///< of both abscissae [element], where it slides along one

    /// Part of the inverse of a second variation by both arc lengths that sliding takes, which counts with at least `least`.
    Eigen::Matrix2d slack(const PairGeometry& pair, const Eigen::Matrix2d& closeness, double least) const noexcept {
        if (kind == nowhere) return Eigen::Matrix2d::Zero();
        if (kind == freely) return raised(closeness, least).inverse();
        const Eigen::Vector2d way = arc(pair);
        return way * way.transpose() / std::max(way.dot(closeness * way), least);
    }
    /// The direction in arc lengths, unit.
    Eigen::Vector2d arc(const PairGeometry& pair) const noexcept {
        return Eigen::Vector2d(direction[0] * pair.speed_i, direction[1] * pair.speed_j).normalized();
    }
};

/// Second variation of a distance that steps to where patches are closest count with at least, over the distance [1].
inline constexpr double least_of_steps = 0.1;

/// Moves a pair of patches step by step until it comes to rest, both inside their fibres.
/// @param steps  called with the pair's geometry: steps of both abscissae [element]
template <class B, class Steps>
void follow_steps(const beam::Mesh<B>& mesh, const Vector& state, Index i, Index j, double& u_i, double& u_j,
                  const Steps& steps) noexcept {
    const auto [low_i, high_i] = mesh.bounds(i);
    const auto [low_j, high_j] = mesh.bounds(j);
    for (int iteration = 0; iteration < 30; ++iteration) {
        const std::pair<double, double> step = steps(pair_geometry(mesh, state, i, j, u_i, u_j));
        const double largest = std::max(std::abs(step.first), std::abs(step.second));
        // Bends jump where a patch comes to another element, between which a full step may go to and fro.
        const double shorten = std::min(largest > 0.5 ? 0.5 / largest : 1.0, iteration > 8 ? 0.5 : 1.0);
        u_i = std::clamp(u_i + shorten * step.first, low_i, high_i);
        u_j = std::clamp(u_j + shorten * step.second, low_j, high_j);
        if (largest < 1e-11) break;
    }
    u_i = mesh.wrapped(i, u_i), u_j = mesh.wrapped(j, u_j);
}

/// Moves a pair of patches along one direction of both abscissae to where they are closest, both inside their fibres.
template <class B>
void follow_along(const beam::Mesh<B>& mesh, const Vector& state, Index i, Index j, const Slide& slide, double& u_i,
                  double& u_j) noexcept {
    follow_steps(mesh, state, i, j, u_i, u_j, [&](const PairGeometry& pair) {
        const Eigen::Vector2d direction = slide.arc(pair);
        const double downhill = pair.centres.dot(direction[0] * pair.t_i - direction[1] * pair.t_j);
        const double step = downhill / std::max(direction.dot(pair.closeness * direction), least_of_steps);
        return std::pair{step * direction[0] / pair.speed_i, step * direction[1] / pair.speed_j};
    });
}

/// Moves a pair of patches to the closest ones near it, both inside their fibres.
///
/// Newton's method with the bends of both; where they are bent around each other so that none is closest nearby, or it does not
/// come to rest, the pair stays nearby all the same.
template <class B>
void follow_closest(const beam::Mesh<B>& mesh, const Vector& state, Index i, Index j, double& u_i, double& u_j) noexcept {
    const auto bounds_i = mesh.bounds(i), bounds_j = mesh.bounds(j);
    const auto outside = [](double u, const auto& bounds) { return u < bounds.first || u > bounds.second; };
    follow_steps(mesh, state, i, j, u_i, u_j, [&](const PairGeometry& pair) {
        const Eigen::Matrix2d matrix = raised(pair.closeness, least_of_steps);
        const double p = pair.centres.dot(pair.t_i), q = -pair.centres.dot(pair.t_j);  // minus the gradient
        const double determinant = matrix.determinant();
        double step_i = (matrix(1, 1) * p - matrix(0, 1) * q) / determinant / pair.speed_i;
        double step_j = (matrix(0, 0) * q - matrix(0, 1) * p) / determinant / pair.speed_j;
        if (outside(u_i + step_i, bounds_i)) {  // at an end the other one goes alone
            step_i = std::clamp(u_i + step_i, bounds_i.first, bounds_i.second) - u_i;
            step_j = (q - matrix(0, 1) * step_i * pair.speed_i) / matrix(1, 1) / pair.speed_j;
        }
        if (outside(u_j + step_j, bounds_j)) {
            step_j = std::clamp(u_j + step_j, bounds_j.first, bounds_j.second) - u_j;
            step_i = (p - matrix(0, 1) * step_j * pair.speed_j) / matrix(0, 0) / pair.speed_i;
        }
        return std::pair{step_i, step_j};
    });
}

}  // namespace fibrant::contact
