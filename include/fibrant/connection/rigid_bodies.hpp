// SPDX-License-Identifier: MIT
#pragma once
/// @file Averages of fibre ends tied to rigid bodies, and ends tied to their periodic images (Durville, section 15.3.4).

#include <fibrant/connection/body_motion.hpp>
#include <fibrant/connection/connections.hpp>
#include <fibrant/connection/coordinate_groups.hpp>
#include <fibrant/connection/image_bends.hpp>
#include <fibrant/connection/prescribed_motion.hpp>
#include <fibrant/connection/solid_places.hpp>
#include <fibrant/scene/image_vectors.hpp>
#include <fibrant/scene/tied_vectors.hpp>

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace fibrant::connection {

/// Force and moment.
struct Wrench {
    Vec3 force = Vec3::Zero();   ///< [force]
    Vec3 moment = Vec3::Zero();  ///< about the place that is asked for [force * length]
};

/// The average connections and periodic pairs of a scene.
///
/// A condition is d.(c - sqrt(n) x_M) = d.offset sqrt(n) in each tied direction d of its body, c = sum x_k / sqrt(n): linear in
/// the tied vectors, so a body whose coordinates are prescribed is reached in one step. Free coordinates q are those that the
/// tied vectors fit best; with D their derivative and U an orthonormal basis of its columns, a step of the vectors is free in U
/// and blocked across it, and a force on q is U Sigma^-1 V^T of it on them. Neither the averages nor the bodies are unknowns of
/// the system. A single vector that is tied to what is prescribed altogether is held: no solver has to know of a tie there.
template <beam::BeamElement B>
class BodyTies {
public:
    BodyTies(const scene::Assembly& assembly, const beam::Mesh<B>& mesh, const Channels& channels)
        : mesh_{&mesh}, motion_{assembly, channels}, images_{assembly} {
        const SolidPlaces solids(assembly, mesh.start_state());
        std::vector<char> taken(core::at(solids.state.size() / 3), 0);
        for (const scene::Hold& hold : assembly.holds())
            taken[core::at(mesh.node_vector(hold.at.fibre, mesh.node_at(hold.at), static_cast<Index>(hold.vector)))] = 1;
        for (const scene::SolidHold& hold : assembly.solid_holds())
            for (const Index node : hold.nodes) taken[core::at(solids.vector({hold.solid, node}))] = 1;
        const auto take = [&](Index vector) {
            if (taken[core::at(vector)] != 0)
                core::with_place(
                    [&] { return vector < mesh.layout().vectors() ? mesh.vector_label(vector) : "a node of a solid"; },
                    [&] {
                        core::refuse("connection", "vector " + std::to_string(vector),
                                     "of a nodal vector that is neither held nor tied twice");
                    });
            taken[core::at(vector)] = 1;
        };
        const auto finish = [&](scene::Tie& tie, const Condition& condition, double support) {
            tie.support = support;
            ties_.push_back(tie), conditions_.push_back(condition);
        };
        const auto fibre_support = [&](Index fibre) {
            const beam::MeshFibre& of = mesh.fibre(fibre);
            return of.material.young_modulus * of.section.area() / of.length();
        };
        for (const scene::AverageConnection& average : assembly.averages()) {
            if (beam::TurningSections<B> && average.vector != scene::NodeVector::position)
                core::refuse("AverageConnection.vector", "a director", "the position, for a beam whose sections turn");
            if (static_cast<Index>(average.vector) >= B::vectors_per_node)
                core::refuse("AverageConnection.vector", "a director", "a vector of the beam's nodes");
            scene::Tie tie;
            Condition condition;
            condition.owner = average.body, condition.director = average.vector != scene::NodeVector::position;
            condition.root = std::sqrt(static_cast<double>(average.ends.size() + average.nodes.size()));
            tie.count = 0;
            for (int k = 0; k < 3; ++k) {
                if (!average.tied[core::at(k)]) continue;
                condition.axes.col(tie.count) = motion_.frame(average.body).transpose() * average.directions.col(k);
                condition.displacement[tie.count++] = average.displacement[k];
            }
            if (!average.displacement.isZero(0.0)) condition.channel = channels.find(average.channel);
            for (const scene::Station& at : average.ends)
                tie.vectors.push_back(mesh.node_vector(at.fibre, mesh.node_at(at), static_cast<Index>(average.vector)));
            for (const scene::SolidNode& at : average.nodes) tie.vectors.push_back(solids.vector(at));
            tie.weights.assign(tie.vectors.size(), 1.0 / condition.root);
            for (const Index vector : tie.vectors) take(vector);
            finish(tie, condition,
                   average.ends.empty() ? solids.support(assembly, average.nodes.front())
                                        : fibre_support(average.ends.front().fibre));
        }
        for (const scene::PeriodicPair& pair : assembly.pairs())
            for (Index v = 0; v < B::vectors_per_node; ++v) {
                scene::Tie tie;
                Condition condition;
                condition.periodic = true, condition.owner = pair.cell, condition.director = v > 0;
                condition.root = std::sqrt(2.0), condition.period = pair.period;
                tie.vectors = {mesh.node_vector(pair.first.fibre, mesh.node_at(pair.first), v),
                               mesh.node_vector(pair.last.fibre, mesh.node_at(pair.last), v)};
                tie.weights = {-1.0 / condition.root, 1.0 / condition.root};
                for (const Index vector : tie.vectors) take(vector);
                finish(tie, condition, fibre_support(pair.first.fibre));
            }
        sort_ties();
        groups_ = coordinate_groups(motion_.free_coordinates(), core::count(conditions_),
                                    [&](Index c, Index coordinate) { return depends(conditions_[core::at(c)], coordinate); });
        for (Group& group : groups_)
            for (const Index c : group.conditions)
                for (Index a = 0; a < ties_[core::at(c)].count; ++a) group.scalars.push_back(ties_[core::at(c)].first + a);
        anchor(solids.state);
    }

    /// Conditions count from this state from now on, with the bodies where they were at the start.
    void anchor(const Vector& state) {
        extent_ = scene::extent_of(mesh_->layout(), state);
        images_.anchor(mesh_->layout(), state);
        for (std::size_t k = 0; k < conditions_.size(); ++k) {
            Condition& condition = conditions_[k];
            const Vec3 sum = combination(ties_[k], state);
            if (condition.periodic) {
                condition.offset = sum;
                condition.bend = bend_jump(state.segment<3>(3 * ties_[k].vectors.front()), condition.period, condition.director);
            } else {
                condition.offset = motion_.frame(condition.owner).transpose() *
                                   (condition.director ? sum : Vec3(sum - condition.root * motion_.position(condition.owner)));
            }
        }
    }

    void begin(std::span<const double> amplitudes) {
        motion_.begin(amplitudes);
        for (Condition& condition : conditions_)
            condition.amplitude = condition.channel < 0 ? 0.0 : amplitudes[core::at(condition.channel)];
    }

    /// Adds the vectors that are held to those of other holds, whose order by vector is kept. @param targets  held parts
    void hold(scene::DofLayout& layout, std::vector<Vec3>& targets) const {
        images_.place(motion_, layout);
        if (tied_ == ties_.size()) return;
        std::vector<scene::HeldTarget> more;
        for (std::size_t k = tied_; k < ties_.size(); ++k) {
            const Condition& condition = conditions_[k];
            const Vec3 from = condition.director ? Vec3(Vec3::Zero()) : motion_.position(condition.owner);
            more.push_back({{ties_[k].vectors.front(), Mat3::Identity()}, Vec3::Zero()});
            auto& [one, target] = more.back();
            for (Index a = 0; a < ties_[k].count; ++a) {
                const Vec3 axis = direction(condition, a);
                one.free -= axis * axis.transpose();
                target += (axis.dot(from) + offset(condition, a)) * axis;
            }
        }
        scene::hold_more(layout.held, targets, more);
    }

    void place(const Vector& state, scene::DofLayout& layout) {
        if (ties_.empty()) return;
        sums_.resize(conditions_.size());
        for (std::size_t k = 0; k < conditions_.size(); ++k) sums_[k] = combination(ties_[k], state);
        Vector change = Vector::Zero(motion_.free_coordinates());
        for (int iteration = 0; iteration < 25; ++iteration) {
            change.setZero();
            double most = 0.0;
            for (Group& group : groups_) most = std::max(most, fit(group, change));
            if (most <= 1e-14) break;
            motion_.move(change);
        }
        gap_.resize(scalars_);
        for (std::size_t k = 0; k < conditions_.size(); ++k) {
            for (Index a = 0; a < ties_[k].count; ++a) {
                ties_[k].axes.col(a) = direction(conditions_[k], a);
                gap_[ties_[k].first + a] = gap(k, a);
            }
        }
        if (layout.ties.size() != tied_) layout.ties.assign(ties_.begin(), ties_.begin() + static_cast<std::ptrdiff_t>(tied_));
        for (std::size_t k = 0; k < tied_; ++k) layout.ties[k].axes = ties_[k].axes;
        layout.motions.resize(groups_.size());
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            layout.motions[g].scalars = groups_[g].scalars;
            layout.motions[g].modes = groups_[g].modes;
            layout.motions[g].stiffness.resize(0, 0);
        }
        scene::remove_motions(layout, gap_);
    }

    void add_closing(const scene::DofLayout& layout, Vector& step) const {
        if (!ties_.empty()) scene::add_tied(layout, Vector(-gap_), step);
    }
    /// How far the conditions miss, over all of them [length, or 1 of directors].
    double misfit() const {
        double most = 0.0;
        for (std::size_t k = 0; k < conditions_.size(); ++k)
            for (Index a = 0; a < ties_[k].count; ++a)
                most = std::max(most, std::abs(gap_[ties_[k].first + a]) / conditions_[k].root);
        return most;
    }

    /// Whether they are met but for rounding.
    bool met() const {
        for (std::size_t k = 0; k < conditions_.size(); ++k)
            for (Index a = 0; a < ties_[k].count; ++a)
                if (std::abs(gap_[ties_[k].first + a]) > 1e-13 * conditions_[k].root * unit_of(conditions_[k])) return false;
        return true;
    }

    void add_forces(const scene::DofLayout& layout, Vector& external) const {
        if (groups_.empty()) return;
        Vector scalars = Vector::Zero(scalars_);
        for (const Group& group : groups_) {
            Vector force(core::count(group.coordinates));
            for (Index j = 0; j < force.size(); ++j) force[j] = motion_.free(group.coordinates[core::at(j)]).force;
            const Vector own = group.modes * (group.pull.transpose() * force);
            for (Index k = 0; k < own.size(); ++k) scalars[group.scalars[core::at(k)]] += own[k];
        }
        scene::add_tied(layout, scalars, external);
    }

    /// Keeps what fibres and contacts exert on the tied vectors: at equilibrium the force of the ties on them.
    void hold_forces(const scene::DofLayout&, const Vector& internal) {
        if (!ties_.empty()) forces_ = scene::tied_part(ties_, internal);
    }

    /// Stiffness of the free coordinates from the forces that turn with them. @param whole  else none
    void stiffen(scene::DofLayout& layout, bool whole) const {
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            const Group& group = groups_[g];
            Matrix& stiffness = layout.motions[g].stiffness;
            stiffness.resize(0, 0);
            if (!whole || group.modes.cols() == 0 || forces_.size() == 0) continue;
            const Index n = core::count(group.coordinates);
            Matrix of_coordinates = Matrix::Zero(n, n);
            for (const Index c : group.conditions) {
                const Condition& condition = conditions_[core::at(c)];
                if (condition.periodic) continue;
                const Vec3 force = condition.director ? force_of(c) : Vec3(condition.root * force_of(c)),
                           &sum = sums_[core::at(c)];
                for (Index i = 0; i < n; ++i)
                    for (Index j = 0; j < n; ++j) {
                        const Index upper = group.coordinates[core::at(i)], lower = group.coordinates[core::at(j)];
                        if (!motion_.moves(upper, condition.owner) || !motion_.moves(lower, condition.owner) ||
                            !motion_.above(upper, lower))
                            continue;
                        const bool same = motion_.above(lower, upper);
                        if (motion_.free(upper).component < 3 || (same && motion_.free(lower).component < 3)) continue;
                        const Vec3 moved =
                            condition.director ? motion_.spin(lower, sum) : motion_.velocity(lower, Vec3(sum / condition.root));
                        const double value = force.dot(motion_.spin(upper, moved));
                        of_coordinates(i, j) += same ? 0.5 * value : value;
                        of_coordinates(j, i) += same ? 0.5 * value : value;
                    }
            }
            if (!of_coordinates.isZero(0.0)) stiffness = group.pull.transpose() * of_coordinates * group.pull;
        }
    }

    void accept() { motion_.accept(); }
    void see_images(const scene::DofLayout& layout, const Vector& forces) { images_.see(layout, forces); }
    const BodyMotion& motion() const noexcept { return motion_; }
    BodyMotion& motion() noexcept { return motion_; }

    /// What a body, and those that hang on it, exert on fibres, about a place.
    Wrench wrench(Index body, const Vec3& about) const {
        Wrench sum;
        for (std::size_t k = 0; k < conditions_.size() && forces_.size() > 0; ++k) {
            const Condition& condition = conditions_[k];
            bool below = false;
            for (Index b = condition.periodic ? -1 : condition.owner; b >= 0; b = motion_.parent(b)) below = below || b == body;
            if (!below) continue;
            const Vec3 force = force_of(static_cast<Index>(k));
            if (condition.director) {
                sum.moment += sums_[k].cross(force);
            } else {
                sum.force += condition.root * force;
                sum.moment += (sums_[k] / condition.root - about).cross(Vec3(condition.root * force));
            }
        }
        return sum;
    }
    Wrench wrench(Index body) const { return wrench(body, motion_.position(body)); }

    /// Calls see(tie, condition, force on its last vector) for a cell's pairs.
    template <class See>
    void each_pair(Index cell, const See& see) const {
        for (std::size_t k = 0; k < conditions_.size() && forces_.size() > 0; ++k)
            if (auto& one = conditions_[k]; one.periodic && one.owner == cell)
                see(ties_[k], one, force_of(static_cast<Index>(k)) / one.root);
    }
    /// Work of a cell's ties for each component of its gradient: volume times nominal stress [force * length].
    Mat3 cell_force(Index cell) const {
        Mat3 sum = Mat3::Zero();
        each_pair(cell, [&](auto&, auto& one, const Vec3& f) {
            if (!one.director) sum += f * one.period.transpose();
        });
        return sum;
    }
    /// The same for its curvatures w,xx, w,yy and w,xy [force * length^2].
    Vec3 cell_moment(Index cell) const {
        Vec3 sum = images_.moment(cell);
        each_pair(cell, [&](auto&, auto& one, const Vec3& f) { sum += one.bend.transpose() * f; });
        return sum;
    }
    const ImageBends& images() const noexcept { return images_; }

private:
    struct Condition {
        Index owner = -1, channel = -1;
        bool periodic = false, director = false;
        double root = 1.0, amplitude = 0.0;  // 1 / weight
        Mat3 axes = Mat3::Identity();        // in the body's frame
        Vec3 offset = Vec3::Zero();          // in the body's frame, times the root
        Vec3 displacement = Vec3::Zero(), period = Vec3::Zero();
        Mat3 bend = Mat3::Zero();  // what a curvature of 1 adds to the difference of two images, a column each
    };
    using Group = CoordinateGroup;

    static Vec3 combination(const scene::Tie& tie, const Vector& state) noexcept {
        Vec3 sum = Vec3::Zero();
        for (std::size_t k = 0; k < tie.vectors.size(); ++k) sum += tie.weights[k] * state.segment<3>(3 * tie.vectors[k]);
        return sum;
    }
    Vec3 direction(const Condition& condition, Index a) const noexcept {
        return condition.periodic ? Vec3(Vec3::Unit(a)) : Vec3(motion_.frame(condition.owner) * condition.axes.col(a));
    }
    double gap(std::size_t k, Index a) const noexcept {
        const Condition& condition = conditions_[k];
        if (condition.periodic) {
            const double bent = condition.bend.row(a).dot(motion_.curvature(condition.owner)),
                         moved = condition.director ? 0.0 : motion_.gradient(condition.owner).row(a).dot(condition.period);
            return sums_[k][a] - condition.offset[a] - (moved + bent) / condition.root;
        }
        const Vec3 from = condition.director ? sums_[k] : Vec3(sums_[k] - condition.root * motion_.position(condition.owner));
        return direction(condition, a).dot(from) - offset(condition, a);
    }
    static double offset(const Condition& condition, Index a) noexcept {
        return condition.axes.col(a).dot(condition.offset) + condition.root * condition.amplitude * condition.displacement[a];
    }
    /// The combination, where the conditions hold: a lever that should be nothing is nothing.
    Vec3 closed(std::size_t k) const noexcept {
        Vec3 sum = sums_[k];
        for (Index a = 0; a < ties_[k].count; ++a) sum -= gap(k, a) * direction(conditions_[k], a);
        return sum;
    }
    /// Force on the combination in the tied directions.
    Vec3 force_of(Index k) const noexcept {
        Vec3 force = Vec3::Zero();
        const scene::Tie& tie = ties_[core::at(k)];
        for (Index a = 0; a < tie.count; ++a) force += forces_[tie.first + a] * tie.axes.col(a);
        return force;
    }
    bool depends(const Condition& condition, Index coordinate) const noexcept {
        const FreeCoordinate& free = motion_.free(coordinate);
        if (!condition.periodic) return motion_.moves(coordinate, condition.owner) && !(condition.director && free.component < 3);
        return free.of_cell && free.owner == condition.owner && !condition.director;
    }

    /// What a gap of a condition is measured by: the extent of the scene, or a director.
    double unit_of(const Condition& condition) const noexcept { return condition.director ? 1.0 : extent_; }

    /// Change of a group's coordinates that brings the tied vectors and them together as far as it can; what scalars change by,
    /// over their units.
    double fit(Group& group, Vector& change) {
        const Index rows = core::count(group.scalars), columns = core::count(group.coordinates);
        Matrix slope = Matrix::Zero(rows, columns);
        Vector gaps(rows), unit(rows), size = Vector::Ones(columns);
        Index row = 0;
        for (const Index c : group.conditions) {
            const Condition& condition = conditions_[core::at(c)];
            const Vec3 sum = closed(core::at(c));
            for (Index a = 0; a < ties_[core::at(c)].count; ++a, ++row) {
                gaps[row] = gap(core::at(c), a), unit[row] = unit_of(condition);
                for (Index j = 0; j < columns; ++j) {
                    const Index k = group.coordinates[core::at(j)];
                    if (!depends(condition, k)) continue;
                    if (condition.periodic) {
                        const int component = motion_.free(k).component;
                        if (component % 3 == a) slope(row, j) = condition.period[component / 3] / condition.root;
                    } else {
                        const Vec3 moved = condition.director
                                               ? motion_.spin(k, sum)
                                               : Vec3(condition.root * motion_.velocity(k, Vec3(sum / condition.root)));
                        slope(row, j) = direction(condition, a).dot(moved);
                    }
                }
            }
        }
        for (Index j = 0; j < columns; ++j) {  // angles and displacements alike
            const FreeCoordinate& free = motion_.free(group.coordinates[core::at(j)]);
            const bool moves = !free.of_cell && free.component < 3;
            // Levers that are rounding would mix the places of ends with the turns of their sections.
            for (Index i = 0; i < rows; ++i)
                if (std::abs(slope(i, j)) <= 1e-14 * (moves ? 1.0 : unit[i])) slope(i, j) = 0.0;
            const double norm = slope.col(j).norm();
            if ((moves ? norm : slope.col(j).cwiseQuotient(unit).norm()) > 1e-7)
                size[j] = 1.0 / norm;
            else if (!moves)
                size[j] = 1.0 / extent_;
            slope.col(j) *= size[j];
        }
        const Eigen::JacobiSVD<Matrix> svd(slope, Eigen::ComputeThinU | Eigen::ComputeThinV);
        Index rank = 0;
        while (rank < svd.singularValues().size() && svd.singularValues()[rank] > 1e-8) ++rank;
        group.modes = svd.matrixU().leftCols(rank);
        group.pull =
            size.asDiagonal() * (svd.matrixV().leftCols(rank) * svd.singularValues().head(rank).cwiseInverse().asDiagonal());
        const Vector along = group.modes.transpose() * gaps;
        const Vector own = group.pull * along;
        for (Index j = 0; j < columns; ++j) change[group.coordinates[core::at(j)]] = own[j];
        return along.size() > 0 ? (group.modes * along).cwiseQuotient(unit).cwiseAbs().maxCoeff() : 0.0;
    }

    /// Puts what is held behind what is tied, and numbers the scalars of all.
    void sort_ties() {
        const auto held = [&](std::size_t k) {
            if (ties_[k].vectors.size() > 1) return false;
            for (Index q = 0; q < motion_.free_coordinates(); ++q)
                if (depends(conditions_[k], q)) return false;
            return true;
        };
        std::vector<std::size_t> order(ties_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        tied_ = static_cast<std::size_t>(
            std::stable_partition(order.begin(), order.end(), [&](std::size_t k) { return !held(k); }) - order.begin());
        std::vector<scene::Tie> ties;
        std::vector<Condition> conditions;
        for (const std::size_t k : order) {
            ties.push_back(ties_[k]), conditions.push_back(conditions_[k]);
            ties.back().first = scalars_, scalars_ += ties.back().count;
        }
        ties_ = std::move(ties), conditions_ = std::move(conditions);
    }

    const beam::Mesh<B>* mesh_;
    BodyMotion motion_;
    ImageBends images_;
    std::vector<scene::Tie> ties_;  // the first `tied_` are ties, all others hold one vector each
    std::vector<Condition> conditions_;
    std::size_t tied_ = 0;
    std::vector<Group> groups_;
    std::vector<Vec3> sums_;
    Vector gap_, forces_;
    Index scalars_ = 0;
    double extent_ = 0.0;
};

/// The part `Connections` of a model whose scenes have rigid bodies or periodic cells.
struct RigidBodies {
    using Parameters = core::NoParameters;
    explicit RigidBodies(const Parameters& = {}) {}
    template <beam::BeamElement B>
    using Of = BodyTies<B>;
};

}  // namespace fibrant::connection
