// SPDX-License-Identifier: MIT
#pragma once
/// @file The mean motion of each group of fibres in an increment, which damping that is carried along leaves alone.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/core/small_matrix.hpp>
#include <fibrant/core/symmetric_eigen.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fibrant::simulation {

/// Field that is nearest, over the centres of a group's nodes, to their displacement in the last increment, and by how much
/// channels changed in it: affine and, of a group twice as long as it is wide, bent by the square of the place along it. What a
/// further change of the same channels would move is foretold in proportion; other channels foretell nothing. Nothing depends on
/// the axes, and a rigid motion that is repeated is foretold exactly.
class MeanMotion {
public:
    MeanMotion() = default;
    /// Of a mesh that has not moved yet.
    template <beam::BeamElement B>
    MeanMotion(const beam::Mesh<B>& mesh, std::size_t channels) : change_(channels, 0.0) {
        Index groups = 0;
        for (const beam::MeshFibre& fibre : mesh.fibres()) groups = std::max<Index>(groups, fibre.group + 2);
        fields_.assign(core::at(groups), Field{});
    }

    /// Takes over the motion of an increment. One that goes on the same way by less than half of what is known, the last bit of a
    /// ramp or one that was cut, is added to half of that: alone it would tell little of the next.
    /// @param change  of the amplitudes
    template <beam::BeamElement B>
    void learn(const beam::Mesh<B>& mesh, const Vector& before, const Vector& after, const std::vector<double>& change) {
        const double same = along(change), square = along(change_);
        const double kept = same > 0.0 && same < 0.5 * square ? 0.5 : 0.0;
        const std::vector<Field> known = fields_;
        for (std::size_t c = 0; c < change_.size(); ++c) change_[c] = kept * change_[c] + change[c];
        std::vector<Mat3> spread(fields_.size(), Mat3::Zero()), lean(fields_.size(), Mat3::Zero());
        std::vector<double> count(fields_.size(), 0.0);
        std::vector<Bend> bend(fields_.size());
        fields_.assign(fields_.size(), Field{});
        const auto arm = [&](std::size_t g, Index v) { return Vec3(before.segment<3>(3 * v) - fields_[g].middle); };
        const auto moved = [&](std::size_t g, Index v) {
            const Vec3 shift = known[g].at(before.segment<3>(3 * v));
            Vec3 sum;
            for (Index c = 0; c < 3; ++c) sum[c] = after[3 * v + c] - before[3 * v + c] + kept * shift[c];
            return sum;
        };
        each_centre(mesh, [&](std::size_t g, Index v) { fields_[g].middle += before.segment<3>(3 * v), count[g] += 1.0; });
        for (std::size_t g = 0; g < fields_.size(); ++g) fields_[g].middle /= std::max(1.0, count[g]);
        each_centre(mesh, [&](std::size_t g, Index v) {
            fields_[g].shift += moved(g, v);
            core::add_outer(arm(g, v), arm(g, v), spread[g]), core::add_outer(moved(g, v), arm(g, v), lean[g]);
        });
        for (std::size_t g = 0; g < fields_.size(); ++g) {
            if (!(count[g] > 0.0)) continue;
            fields_[g].shift /= count[g];
            // A straight fibre has no extent across itself, and says nothing of a gradient there.
            const core::SymmetricEigen<3> axes(spread[g]);
            for (int k = 0; k < 3; ++k)
                for (Index c = 0; c < 3 && axes.values()[k] > 1e-8 * axes.values()[2]; ++c)
                    for (Index r = 0; r < 3; ++r)
                        bend[g].inverse(r, c) += axes.vectors()(r, k) * axes.vectors()(c, k) / axes.values()[k];
            fields_[g].gradient = lean[g] * bend[g].inverse;
            if (axes.values()[2] > 4.0 * axes.values()[1])
                fields_[g].axis = axes.vectors().col(2) / std::sqrt(axes.values()[2] / count[g]);
        }
        // What an affine field leaves of the square of the place along the axis, and what the motion has of that.
        each_centre(mesh, [&](std::size_t g, Index v) {
            const double out = std::pow(fields_[g].axis.dot(arm(g, v)), 2);
            bend[g].mean += out / count[g], bend[g].lean += out * arm(g, v);
        });
        for (std::size_t g = 0; g < fields_.size(); ++g)
            fields_[g].level = bend[g].mean, fields_[g].slope = bend[g].inverse * bend[g].lean;
        each_centre(mesh, [&](std::size_t g, Index v) {
            const double part = fields_[g].bow(arm(g, v));
            bend[g].square += part * part / count[g], bend[g].moved += part * moved(g, v) / count[g];
        });
        for (std::size_t g = 0; g < fields_.size(); ++g)
            if (bend[g].square > 1e-6) fields_[g].bend = bend[g].moved / bend[g].square;
    }

    /// Is anything known of such a change, going on the same way?
    bool foretells(const std::vector<double>& change) const { return along(change) > 0.0; }

    /// A state with its centres where the last motion leads when amplitudes change so.
    template <beam::BeamElement B>
    Vector ahead(const beam::Mesh<B>& mesh, const Vector& state, const std::vector<double>& change) const {
        const double same = along(change), square = along(change_);
        if (same == 0.0) return state;
        const double part = std::clamp(same / square, -largest_part, largest_part);
        Vector moved = state;
        each_centre(mesh,
                    [&](std::size_t g, Index v) { moved.segment<3>(3 * v) += part * fields_[g].at(state.segment<3>(3 * v)); });
        return moved;
    }

    /// Every number that it keeps, for a file.
    template <class Body>
    void each(const Body& body) {
        each_of(*this, body);
    }
    template <class Body>
    void each(const Body& body) const {
        each_of(*this, body);
    }

private:
    static constexpr double largest_part = 2.0;  ///< of an increment that a motion is trusted for

    struct Field {
        Vec3 middle = Vec3::Zero(), shift = Vec3::Zero();
        Mat3 gradient = Mat3::Zero();
        Vec3 axis = Vec3::Zero(), slope = Vec3::Zero(),
             bend = Vec3::Zero();  // axis: over the root mean square of the places along it
        double level = 0.0;

        double bow(const Vec3& arm) const noexcept { return std::pow(axis.dot(arm), 2) - level - slope.dot(arm); }
        Vec3 at(const Vec3& place) const noexcept {
            const Vec3 arm = place - middle;
            const Vec3 turned = gradient * arm;
            return shift + turned + bow(arm) * bend;
        }
    };
    struct Bend {
        Mat3 inverse = Mat3::Zero();
        Vec3 lean = Vec3::Zero(), moved = Vec3::Zero();
        double mean = 0.0, square = 0.0;
    };

    /// What a change of the channels has of the known one, times that.
    double along(const std::vector<double>& change) const noexcept {
        double sum = 0.0;
        for (std::size_t c = 0; c < change_.size(); ++c) sum += change[c] * change_[c];
        return sum;
    }

    template <beam::BeamElement B, class Body>
    static void each_centre(const beam::Mesh<B>& mesh, const Body& body) {
        for (Index f = 0; f < mesh.fibre_count(); ++f)
            for (Index a = 0; a < mesh.own_nodes(f); ++a) body(core::at(mesh.fibre(f).group + 1), mesh.node_vector(f, a, 0));
    }
    template <class Self, class Body>
    static void each_of(Self& self, const Body& body) {
        for (auto& change : self.change_) body(change);
        for (auto& field : self.fields_) {
            for (int k = 0; k < 3; ++k)
                body(field.middle[k]), body(field.shift[k]), body(field.axis[k]), body(field.slope[k]), body(field.bend[k]);
            body(field.level);
            for (int k = 0; k < 9; ++k) body(field.gradient.data()[k]);
        }
    }

    std::vector<Field> fields_;  ///< first that of the fibres of no group, then one a group
    std::vector<double> change_;
};

}  // namespace fibrant::simulation
