// SPDX-License-Identifier: MIT
#pragma once
/// @file Forces that stay along their fibre as it turns.

#include <fibrant/term/term.hpp>

#include <utility>

namespace fibrant::load {

/// Forces along the tangent of a fibre where they act. They have no potential; the tangent is symmetrised.
class FollowerForces : public term::NoSearch,
                       public term::NoSpring,
                       public term::NoCouplings,
                       public term::NoEnergy,
                       public term::NoMemory,
                       public term::NoPicture {
public:
    static constexpr auto role = term::Role::external;
    struct Force {
        scene::Station at{};
        double along = core::unset;  ///< the tangent, which points to the fibre's last end, at amplitude 1 [force]
        std::string channel = "load";
    };
    struct Parameters {
        std::vector<Force> forces{};  ///< all that there are
        void validate() const {
            for (const Force& force : forces) core::require_finite("FollowerForces.Force.along", force.along);
        }
    };
    struct Slot {
        Parameters followers{};
    };

    /// @throws std::invalid_argument naming the parameter that is wrong
    FollowerForces(const term::Site& site, const Parameters& parameters) {
        for (const Force& force : core::validated(parameters).forces)
            points_.push_back({site.point(force.at), force.along, site.channel(force.channel)});
    }
    static std::vector<std::string> channels(const Parameters& parameters) {
        std::vector<std::string> names;
        for (const Force& force : parameters.forces) names.push_back(force.channel);
        return names;
    }
    void begin(std::span<const double> amplitudes, const Vector&) { amplitudes_.assign(amplitudes.begin(), amplitudes.end()); }
    void add_forces(const Vector& state, Vector& external) const {
        for (const Point& one : points_) one.at.push(size(one) * one.at.derivative(state).normalized(), external);
    }
    /// Of w_a f t with t = d / |d| and d the sum of v_b y_b: w_a v_b f (I - t t^T) / |d|.
    void add_bands(const Vector& state, term::Bands& bands) const {
        for (const Point& one : points_) {
            const Vec3 along = one.at.derivative(state), tangent = along.normalized();
            const Mat3 turn = size(one) / along.norm() * (Mat3::Identity() - tangent * tangent.transpose());
            const auto& w = one.at.weights.place;
            const auto& v = one.at.weights.derivative;
            Matrix stiffness(3 * one.at.vectors, 3 * one.at.vectors);
            for (Index a = 0; a < one.at.vectors; ++a)
                for (Index b = 0; b < one.at.vectors; ++b)
                    stiffness.block<3, 3>(3 * a, 3 * b) =
                        -0.5 * (w[core::at(a)] * v[core::at(b)] + v[core::at(a)] * w[core::at(b)]) * turn;
            bands.element(one.at.fibre, one.at.element, stiffness);
        }
    }

private:
    struct Point {
        term::CentrePoint at;
        double along;
        Index channel;
    };
    double size(const Point& one) const noexcept { return amplitudes_[core::at(one.channel)] * one.along; }
    std::vector<Point> points_;
    std::vector<double> amplitudes_;
};
static_assert(term::Term<FollowerForces>);

}  // namespace fibrant::load
