// SPDX-License-Identifier: MIT
#pragma once
/// @file Where rigid bodies and periodic cells stand, and how what hangs on them moves with each free coordinate.

#include <fibrant/connection/channels.hpp>
#include <fibrant/core/rotation.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::connection {

/// By how much more the image of a vector moves than the vector, for each of the curvatures of scene::PeriodicCell, a column
/// each.
/// @param vector    a place [length], or a director [1]
/// @param period    to its image, in the plane of x and y [length]
inline Mat3 bend_jump(const Vec3& vector, const Vec3& period, bool director) noexcept {
    const double a = period.x(), b = period.y(), x = vector.x(), y = vector.y(), z = vector.z();
    Mat3 jump;
    if (director)  // turned by the change of (w,y, -w,x, 0)
        jump << Vec3(0.0, -a, 0.0).cross(vector), Vec3(b, 0.0, 0.0).cross(vector), Vec3(a, -b, 0.0).cross(vector);
    else
        jump << Vec3(-z * a, 0.0, a * (x + 0.5 * a)), Vec3(0.0, -z * b, b * (y + 0.5 * b)),
            Vec3(-z * b, -z * a, x * b + y * a + a * b);
    return jump;
}

/// A coordinate: of a body, 0 to 2 translations and 3 to 5 rotations; of a cell, one of the nine of its gradient, or a curvature
/// behind them, which is never free.
struct FreeCoordinate {
    bool of_cell = false;
    Index owner = -1;
    int component = 0;
    double force = 0.0;  ///< at the present amplitudes
};

/// Poses of the bodies and gradients of the cells of a scene.
class BodyMotion {
public:
    BodyMotion(const scene::Assembly& assembly, const Channels& channels) {
        for (const scene::RigidBody& body : assembly.bodies()) {
            Pose pose;
            pose.parent = body.parent;
            const Pose* parent = body.parent < 0 ? nullptr : &poses_[core::at(body.parent)];
            pose.offset = parent ? Vec3(parent->frame.transpose() * (body.position - parent->position)) : body.position;
            pose.turn = parent ? Mat3(parent->frame.transpose() * body.frame) : body.frame;
            pose.position = body.position, pose.frame = body.frame;
            for (int k = 0; k < 6; ++k) {
                const scene::Coordinate& coordinate = k < 3 ? body.translation[core::at(k)] : body.rotation[core::at(k - 3)];
                add(coordinate, {false, core::count(poses_), k, 0.0}, channels);
            }
            poses_.push_back(pose);
        }
        for (const scene::PeriodicCell& cell : assembly.cells()) {
            for (int k = 0; k < 9; ++k) {
                scene::Coordinate coordinate = cell.gradient[core::at(k)];
                if (coordinate.free) coordinate.value *= cell.volume;
                add(coordinate, {true, core::count(gradients_), k, 0.0}, channels);
            }
            for (int k = 0; k < 3; ++k) add(cell.curvature[core::at(k)], {true, core::count(gradients_), 9 + k, 0.0}, channels);
            gradients_.push_back(Mat3::Zero()), curvatures_.push_back(Vec3::Zero());
        }
        accept();
    }

    /// Takes prescribed coordinates to what amplitudes say, and free ones back to the accepted.
    void begin(std::span<const double> amplitudes) {
        poses_ = accepted_poses_, gradients_ = accepted_gradients_;
        for (const Driven& driven : held_) {
            const double value = amplitude(driven, amplitudes);
            if (driven.of.of_cell && driven.of.component >= 9)
                curvatures_[core::at(driven.of.owner)][driven.of.component - 9] = value;
            else if (driven.of.of_cell)
                gradients_[core::at(driven.of.owner)](driven.of.component % 3, driven.of.component / 3) = value;
            else if (driven.of.component < 3)
                poses_[core::at(driven.of.owner)].moved[driven.of.component] = value;
            else
                poses_[core::at(driven.of.owner)].held_turn[driven.of.component - 3] = value;
        }
        for (std::size_t k = 0; k < free_.size(); ++k) free_[k].of.force = amplitude(free_[k], amplitudes);
        follow();
    }
    void accept() { accepted_poses_ = poses_, accepted_gradients_ = gradients_; }

    /// Greatest turn of a body that amplitudes prescribe, with those of the bodies it hangs on, and the body [radian].
    std::pair<double, Index> greatest_turn(std::span<const double> from, std::span<const double> to) const {
        std::vector<Vec3> change(poses_.size(), Vec3::Zero());
        for (const Driven& driven : held_)
            if (!driven.of.of_cell && driven.of.component >= 3)
                change[core::at(driven.of.owner)][driven.of.component - 3] = amplitude(driven, to) - amplitude(driven, from);
        std::pair<double, Index> most{0.0, -1};
        for (Index body = 0; body < bodies(); ++body) {
            double sum = 0.0;
            for (Index b = body; b >= 0; b = parent(b)) sum += change[core::at(b)].norm();
            if (sum > most.first) most = {sum, body};
        }
        return most;
    }

    Index bodies() const noexcept { return core::count(poses_); }
    Index cells() const noexcept { return core::count(gradients_); }
    Index free_coordinates() const noexcept { return core::count(free_); }
    const FreeCoordinate& free(Index k) const noexcept { return free_[core::at(k)].of; }
    const Vec3& position(Index body) const noexcept { return poses_[core::at(body)].position; }
    const Mat3& frame(Index body) const noexcept { return poses_[core::at(body)].frame; }
    Index parent(Index body) const noexcept { return poses_[core::at(body)].parent; }
    const Mat3& gradient(Index cell) const noexcept { return gradients_[core::at(cell)]; }
    /// w,xx, w,yy, w,xy of scene::PeriodicCell [1 / length].
    const Vec3& curvature(Index cell) const noexcept { return curvatures_[core::at(cell)]; }
    /// Greatest entry of frame^T frame - 1 over all bodies [1].
    double orthonormality_error() const {
        double most = 0.0;
        for (const Pose& pose : poses_)
            most = std::max(most, (pose.frame.transpose() * pose.frame - Mat3::Identity()).cwiseAbs().maxCoeff());
        return most;
    }

    /// Does a free coordinate move a body?
    bool moves(Index k, Index body) const noexcept {
        const FreeCoordinate& coordinate = free(k);
        if (coordinate.of_cell) return false;
        for (Index b = body; b >= 0; b = parent(b))
            if (b == coordinate.owner) return true;
        return false;
    }
    /// Axis of a body's coordinate in space: of its parent's frame, as it now stands.
    Vec3 axis(Index body, int component) const noexcept {
        const Index above = parent(body);
        return above < 0 ? Vec3(Vec3::Unit(component % 3)) : Vec3(frame(above).col(component % 3));
    }
    /// Velocity of a point of a body that a coordinate of it, or of one it hangs on, makes [length over that of the coordinate].
    Vec3 velocity(Index k, const Vec3& point) const noexcept {
        const FreeCoordinate& coordinate = free(k);
        const Vec3 along = axis(coordinate.owner, coordinate.component);
        return coordinate.component < 3 ? along : Vec3(along.cross(point - position(coordinate.owner)));
    }
    /// The same of a direction.
    Vec3 spin(Index k, const Vec3& direction) const noexcept {
        const FreeCoordinate& coordinate = free(k);
        if (coordinate.component < 3) return Vec3::Zero();
        return axis(coordinate.owner, coordinate.component).cross(direction);
    }
    /// Is the owner of the first coordinate above that of the second, or the same?
    bool above(Index k, Index l) const noexcept { return moves(k, free(l).owner); }

    /// Adds changes of the free coordinates, a number each.
    void move(const Vector& change) {
        std::vector<Vec3> turn(poses_.size(), Vec3::Zero());
        for (Index k = 0; k < free_coordinates(); ++k) {
            const FreeCoordinate& coordinate = free(k);
            if (coordinate.of_cell)
                gradients_[core::at(coordinate.owner)](coordinate.component % 3, coordinate.component / 3) += change[k];
            else if (coordinate.component < 3)
                poses_[core::at(coordinate.owner)].moved[coordinate.component] += change[k];
            else
                turn[core::at(coordinate.owner)][coordinate.component - 3] += change[k];
        }
        for (std::size_t b = 0; b < poses_.size(); ++b)
            if (!turn[b].isZero(0.0))
                poses_[b].free_turn =
                    Eigen::Quaterniond(Mat3(core::rotation(turn[b]) * poses_[b].free_turn)).normalized().toRotationMatrix();
        follow();
    }

    /// Calls see(value) with each number of the accepted coordinates, in a fixed order: for files.
    template <class See>
    void each_accepted(const See& see) {
        for (Pose& pose : accepted_poses_) see(pose.moved), see(pose.held_turn), see(pose.free_turn);
        for (Mat3& gradient : accepted_gradients_) see(gradient);
    }
    /// Back to what was accepted.
    void restore() {
        poses_ = accepted_poses_, gradients_ = accepted_gradients_;
        follow();
        accept();
    }

private:
    struct Pose {
        Index parent = -1;
        Vec3 offset = Vec3::Zero();  // in the parent's frame, at the start
        Mat3 turn = Mat3::Identity();
        Vec3 moved = Vec3::Zero(), held_turn = Vec3::Zero();
        Mat3 free_turn = Mat3::Identity();
        Vec3 position = Vec3::Zero();
        Mat3 frame = Mat3::Identity();
    };
    struct Driven {
        FreeCoordinate of;
        Index channel;
        double value;
    };
    void add(const scene::Coordinate& coordinate, const FreeCoordinate& of, const Channels& channels) {
        (coordinate.free ? free_ : held_)
            .push_back({of, coordinate.value != 0.0 ? channels.find(coordinate.channel) : -1, coordinate.value});
    }
    static double amplitude(const Driven& driven, std::span<const double> amplitudes) noexcept {
        return driven.channel < 0 ? 0.0 : amplitudes[core::at(driven.channel)] * driven.value;
    }
    void follow() {
        for (Pose& pose : poses_) {
            const Pose* parent = pose.parent < 0 ? nullptr : &poses_[core::at(pose.parent)];
            const Vec3 place = pose.offset + pose.moved;
            const Mat3 turn = pose.free_turn * core::rotation(pose.held_turn) * pose.turn;
            pose.position = parent ? Vec3(parent->position + parent->frame * place) : place;
            pose.frame = parent ? Mat3(parent->frame * turn) : turn;
        }
    }

    std::vector<Pose> poses_, accepted_poses_;
    std::vector<Mat3> gradients_, accepted_gradients_;
    std::vector<Vec3> curvatures_;  // all held: amplitudes say them
    std::vector<Driven> held_, free_;
};

}  // namespace fibrant::connection
