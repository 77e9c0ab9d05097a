// SPDX-License-Identifier: MIT
#pragma once
/// @file Prescribed components of nodal vectors: which they are, and where they go.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/connection/channels.hpp>
#include <fibrant/connection/turned_work.hpp>
#include <fibrant/core/ordering.hpp>
#include <fibrant/core/rotation.hpp>
#include <fibrant/core/symmetric_eigen.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::connection {

/// Holds of a scene, merged by nodal vector. Where two holds of a vector overlap, the one added first decides.
template <beam::BeamElement B>
class PrescribedMotion {
public:
    PrescribedMotion(const scene::Assembly& assembly, const beam::Mesh<B>& mesh, const Channels& channels) {
        for (scene::Hold hold : assembly.holds()) {
            const Index node = mesh.node_at(hold.at);
            if constexpr (requires { B::hold(hold, Mat3()); })
                if (!B::hold(hold, mesh.frame(hold.at.fibre, node).basis())) continue;
            if (static_cast<Index>(hold.vector) >= B::vectors_per_node)
                core::with_place([&] { return mesh.node_label(hold.at.fibre, node); },
                                 [&] {
                                     core::refuse("Hold.vector", std::to_string(static_cast<int>(hold.vector)),
                                                  "a vector of the beam's nodes");
                                 });
            Item item{mesh.node_vector(hold.at.fibre, node, static_cast<Index>(hold.vector)), channels.find(hold.channel),
                      mesh.frame(hold.at.fibre, node).basis(), Vec3::Zero(), hold};
            item.rest = mesh.start_state().template segment<3>(3 * item.vector);
            items_.push_back(item);
        }
        if constexpr (turning)  // what turns is held as a whole, or about axes that stay
            for (Item& item : items_) {
                if (item.hold.vector == scene::NodeVector::position) continue;
                Mat3 held = Mat3::Zero();
                for (const Item& other : items_)
                    if (other.vector == item.vector) held = held.cwiseMax(other.hold.directions);
                item.whole = held.trace() > 2.5;
                if (!item.whole && item.hold.rotation)
                    core::refuse("Hold.rotation", "of " + std::to_string(std::lround(held.trace())) + " axes",
                                 "of all three: rotations do not add up");
            }
        core::stable_sort(items_, [](const Item& a, const Item& b) { return a.vector < b.vector; });
    }

    /// Held vectors at the given amplitudes; target[k] is the held part of held[k]'s vector.
    /// @param state  from which the increment starts: of the vectors of one rotation the nearest is meant, and a section that is
    ///               held about some axes only does not spin about them from there
    void at(std::span<const double> amplitudes, [[maybe_unused]] const Vector& state, std::vector<scene::HeldVector>& held,
            std::vector<Vec3>& target) const {
        held.clear(), target.clear();
        for (const Item& item : items_) {
            const double amplitude = amplitudes[core::at(item.channel)];
            const Mat3 turn = item.hold.rotation ? item.hold.rotation(amplitude) : Mat3(Mat3::Identity());
            const Mat3 axes = item.hold.axes == scene::Axes::section ? Mat3(turn * item.basis) : turn;
            const bool position = item.hold.vector == scene::NodeVector::position;
            Mat3 directions_held = item.hold.directions;
            Vec3 goal = turned_goal(item, turn);
            goal += shift_of(item, amplitude);
            Mat3 axes_held = axes;
            if constexpr (turning) {
                if (!position) {
                    const Vec3 now = state.segment<3>(3 * item.vector);
                    goal = item.whole ? core::nearest_rotation_vector(core::rotation_vector(turn * item.basis), now) : now;
                    axes_held = item.whole ? Mat3(Mat3::Identity()) : Mat3(core::spin_matrix(now).transpose() * axes);
                    if (item.whole) directions_held = Mat3::Identity();
                }
            }
            if (held.empty() || held.back().vector != item.vector) {
                held.push_back({item.vector, Mat3::Identity()});
                target.push_back(Vec3::Zero());
            }
            Mat3& free = held.back().free;
            Mat3 wanted = axes_held * directions_held * axes_held.transpose();
            double least = turning && !position ? 1e-3 : 0.5;
            if (free != Mat3::Identity()) {  // first of all what no earlier hold has taken a part of
                wanted = (wanted * free * wanted).eval();
                least = 1e-12;
            }
            const core::SymmetricEigen<3> directions(wanted);
            const bool overlap = least < 1e-6;
            for (int n = 0; n < 3; ++n) {
                const int k = overlap ? 2 - n : n;
                if (directions.values()[k] < least) continue;
                const Vec3 direction = directions.vectors().col(k);
                Vec3 fresh = free * direction;  // what earlier holds leave of it
                if (fresh.norm() < 1e-8) continue;
                fresh = (free * fresh.normalized()).normalized();  // again: cancellation may have left digits only
                target.back() += fresh * (direction.dot(goal - target.back()) / direction.dot(fresh));
                free -= fresh * fresh.transpose();
            }
        }
    }

    /// What forces on vectors that holds turn do beyond what a trapezium takes (`beyond_chord`) [force * length].
    double beyond_chords(const Way& way) const {
        std::array<std::vector<scene::HeldVector>, 2> held;
        std::vector<Vec3> targets;
        double sum = 0.0;
        for (std::size_t first = 0, last = 0, entry = 0; first < items_.size(); first = last, ++entry) {
            while (last < items_.size() && items_[last].vector == items_[first].vector) ++last;
            const std::span<const Item> holds = std::span<const Item>(items_).subspan(first, last - first);
            const auto item = std::find_if(holds.begin(), holds.end(), [&](const Item& one) {
                const bool position = one.hold.vector == scene::NodeVector::position;
                const std::size_t channel = core::at(one.channel);
                return one.hold.rotation && way.amplitudes[0][channel] != way.amplitudes[1][channel] && (!turning || position);
            });
            if (item == holds.end()) continue;
            std::array<Turned, 2> ends;
            for (const std::size_t k : {0u, 1u}) {
                if (held[k].empty()) at(way.amplitudes[k], *way.states[k], held[k], targets);
                const double amplitude = way.amplitudes[k][core::at(item->channel)];
                Vec3 about = shift_of(*item, amplitude);
                if (item->hold.vector == scene::NodeVector::position) about += item->hold.pivot;
                ends[k] = {item->hold.rotation(amplitude), about, way.place(k, item->vector),
                           way.force(k, item->vector, held[k][entry].free)};
            }
            sum += beyond_chord(ends);
        }
        return sum;
    }

    /// Greatest turn of a held section on the way between amplitudes, which may be several times around, and the vector that is
    /// turned [radian]. Rotations and paths are looked at in between, so that up to half as many turns are told as there are
    /// looks.
    std::pair<double, Index> greatest_turn(std::span<const double> from, std::span<const double> to) const {
        constexpr int looks = 64;
        std::pair<double, Index> most{0.0, -1};
        for (const Item& item : items_) {
            const double a = from[core::at(item.channel)], b = to[core::at(item.channel)];
            const bool position = item.hold.vector == scene::NodeVector::position,
                       led = item.hold.path || !item.hold.displacement.isZero(0.0);
            if (a == b || position || (!item.hold.rotation && !(led && !turning))) continue;
            double sum = 0.0;
            Mat3 turn_before;
            Vec3 vector_before = Vec3::Zero();
            for (int k = 0; k <= looks; ++k) {
                const double amplitude = a + (b - a) * k / looks;
                const Mat3 turn = item.hold.rotation ? item.hold.rotation(amplitude) : Mat3(Mat3::Identity());
                Vec3 vector = turn * item.rest;
                vector += shift_of(item, amplitude);
                if (k > 0) {
                    const double by_turn = core::rotation_vector(Mat3(turn_before.transpose() * turn)).norm();
                    const double by_vector =
                        turning ? 0.0 : std::atan2(vector_before.cross(vector).norm(), vector_before.dot(vector));
                    sum += std::max(by_turn, by_vector);
                }
                turn_before = turn, vector_before = vector;
            }
            if (sum > most.first) most = {sum, item.vector};
        }
        return most;
    }

    /// Throws std::invalid_argument where holds of one vector ask for different places in a direction that both hold, and, if
    /// `finite`, where one asks for no place at all.
    void check(std::span<const double> amplitudes, const beam::Mesh<B>& mesh, bool finite) const {
        for (std::size_t first = 0, last = 0; first < items_.size(); first = last) {
            while (last < items_.size() && items_[last].vector == items_[first].vector) ++last;
            core::with_place(
                [&] { return mesh.vector_label(items_[first].vector); },
                [&] { check_vector(std::span<const Item>(items_).subspan(first, last - first), amplitudes, finite); });
        }
    }

private:
    static constexpr double agreement = 1e-9;  ///< of goals, over their size: what rounding leaves of paths that are the same
    static constexpr bool turning = beam::TurningSections<B>;
    struct Item {
        Index vector, channel;
        Mat3 basis;
        Vec3 rest;
        scene::Hold hold;
        bool whole = false;  ///< of a rotation: all three axes are held
    };

    static Vec3 shift_of(const Item& item, double amplitude) {
        return item.hold.path ? item.hold.path(amplitude) : Vec3(amplitude * item.hold.displacement);
    }
    /// A held vector turned, a place about its pivot.
    static Vec3 turned_goal(const Item& item, const Mat3& turn) {
        if (item.hold.vector != scene::NodeVector::position) return turn * item.rest;
        const Vec3 arm = item.rest - item.hold.pivot, turned = turn * arm;
        return item.hold.pivot + turned;
    }
    static void check_vector(std::span<const Item> items, std::span<const double> amplitudes, bool finite) {
        Mat3 sum = Mat3::Zero();
        Vec3 pull = Vec3::Zero();
        std::vector<std::pair<Mat3, Vec3>> asked;
        double size = 0.0;
        for (const Item& item : items) {
            const double amplitude = amplitudes[core::at(item.channel)];
            if (finite) scene::require_at("Hold", amplitude, item.hold.path, item.hold.rotation);
            if (items.size() == 1) continue;
            const Mat3 turn = item.hold.rotation ? item.hold.rotation(amplitude) : Mat3(Mat3::Identity());
            const bool position = item.hold.vector == scene::NodeVector::position;
            Mat3 axes = item.hold.axes == scene::Axes::section ? Mat3(turn * item.basis) : turn;
            Vec3 goal = turned_goal(item, turn);
            goal += shift_of(item, amplitude);
            if (turning && !position) axes = item.basis, goal = core::rotation_vector(turn);
            if (!axes.allFinite() || !goal.allFinite()) return;
            asked.emplace_back(axes * item.hold.directions * axes.transpose(), goal);
            sum += asked.back().first, pull += asked.back().first * goal;
            size = std::max(size, goal.norm() + (position ? 0.0 : 1.0));
        }
        if (items.size() == 1) return;
        // The place that meets all best: they agree if it meets each.
        const core::SymmetricEigen<3> solver(sum);
        Vec3 best = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
            if (solver.values()[k] > agreement)
                best += solver.vectors().col(k) * (solver.vectors().col(k).dot(pull) / solver.values()[k]);
        // Directors that may be stretched agree on none at all, wherever they point to.
        const bool collapsed = !turning && items[0].hold.vector != scene::NodeVector::position &&
                               solver.values()[0] > agreement && best.norm() < 0.5 * items[0].rest.norm();
        for (std::size_t k = asked.size(); k-- > 0;) {
            const Vec3 missed =
                collapsed ? Vec3(asked[k].second - asked[0].second) : Vec3(asked[k].first * (asked[k].second - best));
            if (missed.norm() <= agreement * size) continue;
            core::refuse("Hold: what holds of " + kind(items[k]) + " ask for differs by",
                         scene::text(collapsed ? missed : Vec3(2.0 * missed)),
                         "0: holds agree in the directions that they share, at channel '" + items[k].hold.channel +
                             "' = " + core::text(amplitudes[core::at(items[k].channel)]));
        }
    }
    static std::string kind(const Item& item) {
        return item.hold.vector == scene::NodeVector::position ? "a position"
                                                               : "director " + std::to_string(static_cast<int>(item.hold.vector));
    }

    std::vector<Item> items_;
};

}  // namespace fibrant::connection
