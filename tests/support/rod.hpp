// SPDX-License-Identifier: MIT
#pragma once
/// @file A small static solver for one rod, to compare a beam element with reference solutions.

#include <fibrant/beam/director_beam.hpp>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>

#include <cmath>
#include <vector>

namespace fibrant::test {

/// A section in space: centre and two directors.
struct Frame {
    Vec3 position = Vec3::Zero();
    Vec3 director_1 = Vec3::UnitX();
    Vec3 director_2 = Vec3::UnitY();
};

/// What a solution cost.
struct RodSolution {
    bool converged = false;
    int iterations = 0;  ///< of Newton, those of rejected attempts included
    int rejected = 0;    ///< attempts: with independent stresses, without, or a load step that was cut
};

/// One rod with dead forces, moments that turn with a section, and held components; 9 unknowns a node.
template <beam::BeamElement Beam = beam::DirectorBeam<3>>
class Rod {
public:
    /// @param shape  section at rest arc length s; nodes are equally spaced in s
    template <class Shape>
    Rod(const Beam& beam, const beam::SectionConstants& section, const scene::ElasticMaterial& material, int intervals,
        double length, const Shape& shape)
        : beam_{beam}, intervals_{intervals}, length_{length} {
        const Index vectors = 3 * nodes();
        value_.resize(3 * vectors);
        for (int node = 0; node < nodes(); ++node) {
            const Frame frame = shape(length * node / intervals);
            value_.segment<9>(9 * node) << frame.position, frame.director_1, frame.director_2;
        }
        for (int e = 0; e < elements(); ++e) rest_.push_back(beam_.rest(section, material, of_element(value_, e)));
        force_.setZero(value_.size());
        target_.setZero(value_.size());
        free_.assign(core::at(vectors), Mat3::Identity());
        moment_.assign(core::at(nodes()), Vec3::Zero());
    }

    int nodes() const { return intervals_ + 1; }
    int elements() const { return intervals_ / Beam::reach; }
    Vec3 position(int node) const { return value_.segment<3>(9 * node); }
    /// @param a  1 or 2
    Vec3 director(int node, int a) const { return value_.segment<3>(9 * node + 3 * a); }
    /// Unit normal of the section.
    Vec3 normal(int node) const { return director(node, 1).cross(director(node, 2)).normalized(); }
    Vector& value() { return value_; }

    /// Dead force on vector k (0 centre, 1, 2 directors) of a node.
    Eigen::Ref<Vec3> force(int node, int k) { return force_.segment<3>(9 * node + 3 * k); }
    /// Moment on a section: components along g_1, g_2 and the normal, with which it turns.
    Vec3& body_moment(int node) { return moment_[core::at(node)]; }
    /// Holds the components of a vector that `held` (a projector) selects, at those of `target`.
    void hold(int node, int k, const Mat3& held, const Vec3& target) {
        free_[core::at(3 * node + k)] = Mat3::Identity() - held;
        target_.segment<3>(9 * node + 3 * k) = target;
    }
    /// Holds centre and rotation of a section; it may still stretch along its directors unless `rigid`.
    void place(int node, const Frame& frame, bool rigid) {
        const Mat3 all = Mat3::Identity();
        hold(node, 0, all, frame.position);
        const Vec3 &d1 = frame.director_1, &d2 = frame.director_2;
        hold(node, 1, rigid ? all : Mat3(all - d1 * d1.transpose()), d1);
        hold(node, 2, rigid ? all : Mat3(all - d2 * d2.transpose()), d2);
    }

    /// Equilibrium from the present state, as it is loaded and held.
    RodSolution solve(double tolerance = 1e-9, bool independent_stresses = true) {
        const Vector start = value_;
        RodSolution total = newton(tolerance, independent_stresses);
        if (total.converged || !independent_stresses) return total;
        value_ = start;
        const RodSolution plain = newton(tolerance, false);
        return {plain.converged, total.iterations + plain.iterations, 1};
    }
    /// Follows path(t) from 0 to 1, which loads and holds the rod; steps that fail are halved.
    template <class Path>
    RodSolution follow(int steps, const Path& path, double tolerance = 1e-9, bool independent_stresses = true) {
        RodSolution total{true, 0, 0};
        double done = 0.0, step = 1.0 / steps;
        while (done < 1.0 - 1e-12) {
            const Vector start = value_;
            const double next = std::min(1.0, done + step);
            path(next);
            const RodSolution one = solve(tolerance, independent_stresses);
            total.iterations += one.iterations;
            total.rejected += one.rejected;
            if (one.converged) {
                done = next;
            } else {
                value_ = start;
                step *= 0.5;
                if (++total.rejected > 30) return {false, total.iterations, total.rejected};
            }
        }
        return total;
    }

    double energy() const {
        double sum = 0.0;
        for (int e = 0; e < elements(); ++e) sum += beam_.energy(rest_[core::at(e)], of_element(value_, e));
        return sum;
    }
    /// What supports exert on a node: force, and moment about its centre.
    Vec3 reaction_force(int node) const { return out_of_balance().template segment<3>(9 * node); }
    Vec3 reaction_moment(int node) const {
        const Vector r = out_of_balance();
        return director(node, 1).cross(Vec3(r.segment<3>(9 * node + 3))) +
               director(node, 2).cross(Vec3(r.segment<3>(9 * node + 6)));
    }
    /// Conjugate stresses of an element.
    typename Beam::Stresses stresses(int e) const { return beam_.stresses(rest_[core::at(e)], of_element(value_, e)); }
    /// Negative pivots of the tangent: > 0 once equilibrium is unstable. Dead loads only.
    int negative_pivots() {
        const Reduced system = reduced(current_stresses());
        Cholesky factor(system.matrix);
        return factor.info() == Eigen::Success ? static_cast<int>((factor.vectorD().array() < 0.0).count()) : -1;
    }
    /// Largest step of a position over the length, and of a director.
    double measure(const Vector& step) const {
        double largest = 0.0;
        for (Index v = 0; v < core::count(free_); ++v) {
            const double size = step.segment<3>(3 * v).norm() / (v % 3 == 0 ? length_ : 1.0);
            if (!(size <= largest)) largest = size;
        }
        return largest;
    }

private:
    using Cholesky = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<int>>;
    using ElementVector = beam::ElementVector<Beam>;
    using Stresses = std::vector<typename Beam::Stresses>;
    struct Reduced {
        SparseMatrix matrix;
        Vector right;
        Vector prescribed;
    };

    ElementVector of_element(const Vector& v, int e) const { return v.template segment<9 * Beam::nodes>(9 * Beam::reach * e); }
    Stresses current_stresses() const {
        Stresses s;
        for (int e = 0; e < elements(); ++e) s.push_back(stresses(e));
        return s;
    }
    /// Force on directors that exerts the moment m (components on the turning section) and does not stretch it.
    static Eigen::Matrix<double, 6, 1> director_force(const Eigen::Matrix<double, 6, 1>& g, const Vec3& m) {
        const Vec3 g1 = g.head<3>(), g2 = g.tail<3>(), n = g1.cross(g2).normalized();
        const Vec3 about_1 = m[0] * g2.cross(n) / g2.norm(), about_2 = m[1] * n.cross(g1) / g1.norm();
        Eigen::Matrix<double, 6, 1> f;
        f << (about_2 + 0.5 * m[2] * n).cross(g1) / g1.squaredNorm(), (about_1 + 0.5 * m[2] * n).cross(g2) / g2.squaredNorm();
        return f;
    }
    Vector external() const {
        Vector f = force_;
        for (int node = 0; node < nodes(); ++node) {
            if (moment_[core::at(node)].squaredNorm() > 0.0) {
                f.segment<6>(9 * node + 3) += director_force(value_.segment<6>(9 * node + 3), moment_[core::at(node)]);
            }
        }
        return f;
    }
    bool follower() const {
        return std::ranges::any_of(moment_, [](const Vec3& m) { return m.squaredNorm() > 0.0; });
    }
    /// Internal less external force.
    Vector out_of_balance() const {
        Vector r = -external();
        for (int e = 0; e < elements(); ++e) {
            r.template segment<9 * Beam::nodes>(9 * Beam::reach * e) +=
                beam_.internal_force(rest_[core::at(e)], of_element(value_, e));
        }
        return r;
    }
    /// P K P + (1 - P) and P (-r - K (1 - P)(target - value)).
    Reduced reduced(const Stresses& geometric) const {
        const Index n = value_.size();
        Vector prescribed = Vector::Zero(n), right = external();
        std::vector<Eigen::Triplet<double>> entries;
        for (Index v = 0; v < core::count(free_); ++v) {
            const Mat3 held = Mat3::Identity() - free_[core::at(v)];
            prescribed.segment<3>(3 * v) = held * (target_ - value_).segment<3>(3 * v);
            for (int j = 0; j < 3; ++j) {
                for (int i = 0; i < 3; ++i) entries.emplace_back(int(3 * v + i), int(3 * v + j), held(i, j));
            }
        }
        const auto add_block = [&](Index row, Index column, const Mat3& K) {
            right.segment<3>(3 * row) -= K * prescribed.segment<3>(3 * column);
            const Mat3 block = free_[core::at(row)] * K * free_[core::at(column)];
            for (int j = 0; j < 3; ++j) {
                for (int i = 0; i < 3; ++i) entries.emplace_back(int(3 * row + i), int(3 * column + j), block(i, j));
            }
        };
        for (int e = 0; e < elements(); ++e) {
            ElementVector f;
            beam::ElementMatrix<Beam> K;
            beam_.residual_and_tangent(rest_[core::at(e)], of_element(value_, e), geometric[core::at(e)], f, K);
            const Index first = 3 * Beam::reach * e;
            right.template segment<9 * Beam::nodes>(3 * first) -= f;
            for (int b = 0; b < 3 * Beam::nodes; ++b) {
                for (int a = 0; a < 3 * Beam::nodes; ++a) {
                    add_block(first + a, first + b, K.template block<3, 3>(3 * a, 3 * b));
                }
            }
        }
        for (int node = 0; node < nodes(); ++node) {
            const Vec3& m = moment_[core::at(node)];
            if (m.squaredNorm() == 0.0) continue;
            Eigen::Matrix<double, 6, 6> K;  // directors are of the order of 1: 1e-6 leaves an error of 1e-10
            for (int j = 0; j < 6; ++j) {
                Eigen::Matrix<double, 6, 1> ahead = value_.segment<6>(9 * node + 3), behind = ahead;
                ahead[j] += 1e-6;
                behind[j] -= 1e-6;
                K.col(j) = (director_force(behind, m) - director_force(ahead, m)) / 2e-6;
            }
            for (int b = 0; b < 2; ++b) {
                for (int a = 0; a < 2; ++a) {
                    add_block(3 * node + 1 + a, 3 * node + 1 + b, K.block<3, 3>(3 * a, 3 * b));
                }
            }
        }
        for (Index v = 0; v < core::count(free_); ++v) {
            right.segment<3>(3 * v) = (free_[core::at(v)] * right.segment<3>(3 * v)).eval();
        }
        SparseMatrix matrix(n, n);
        matrix.setFromTriplets(entries.begin(), entries.end());
        return {std::move(matrix), std::move(right), std::move(prescribed)};
    }

    RodSolution newton(double tolerance, bool independent_stresses) {
        Stresses geometric = current_stresses();
        for (int iteration = 1; iteration <= 60; ++iteration) {
            const Reduced system = reduced(geometric);
            Vector step;
            if (follower()) {
                Eigen::SparseLU<SparseMatrix> factor(system.matrix);
                if (factor.info() != Eigen::Success) return {false, iteration, 0};
                step = factor.solve(system.right);
            } else {
                Cholesky factor(system.matrix);
                if (factor.info() != Eigen::Success) return {false, iteration, 0};
                step = factor.solve(system.right);
            }
            step += system.prescribed;
            const double size = measure(step);
            if (!(size < 1e3)) return {false, iteration, 0};
            if (independent_stresses) {
                for (int e = 0; e < elements(); ++e) {
                    geometric[core::at(e)] =
                        beam_.predicted_stresses(rest_[core::at(e)], of_element(value_, e), of_element(step, e));
                }
            }
            value_ += step;
            if (!independent_stresses) geometric = current_stresses();
            if (size < tolerance) return {true, iteration, 0};
        }
        return {false, 60, 0};
    }

    Beam beam_;
    int intervals_;
    double length_;
    Vector value_, force_, target_;
    std::vector<Mat3> free_;
    std::vector<Vec3> moment_;
    std::vector<typename Beam::Rest> rest_;
};

/// Straight along +z, d_1 = x, d_2 = y, as the reference solutions start.
inline Frame straight(double s) { return {Vec3(0.0, 0.0, s), Vec3::UnitX(), Vec3::UnitY()}; }

}  // namespace fibrant::test
