// SPDX-License-Identifier: MIT
#pragma once
/// @file Rigid bodies with mass on nodes of fibres: the place and the turn of the node are those of the body.

#include <fibrant/inertia/inertia.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace fibrant::inertia {

/// A rigid body whose centre of mass is a node of a fibre, and whose principal axes are the directors there and their normal. A
/// rod turns it. Sections that deform have two directors alone: they turn a body that is flat in their plane, of which the third
/// moment is the sum of the others. Cables turn none.
struct Body {
    scene::Station at{};        ///< a node
    double mass = core::unset;  ///< [mass], > 0
    /// Principal moments of inertia about g_1, g_2 and g_1 x g_2 [mass length^2], none greater than the others together.
    Vec3 moments = Vec3::Zero();
    /// Integral of x_k^2 over the mass, x_k along axis k (Euler): the kinetic energy is half of the sum of these, each times the
    /// square of the velocity of its axis [mass length^2].
    Vec3 second_moments() const noexcept { return Vec3::Constant(0.5 * moments.sum()) - moments; }
    void validate() const {
        core::require_positive("Body.mass", mass);
        scene::require_finite("Body.moments", moments);
        const double rounding = 1e-12 * moments.cwiseAbs().sum();
        for (Index k = 0; k < 3; ++k)
            core::require(moments[k] >= 0.0 && second_moments()[k] >= -rounding, "Body.moments: of axis " + std::to_string(k + 1),
                          moments[k], ">= 0 and not greater than the others together");
    }
};

/// Inertia of fibres, and the bodies that they carry.
template <TimeIntegrator Integrator>
struct WithBodiesParameters : InertiaParameters<Integrator> {
    std::vector<Body> bodies{};  ///< any number on a node
};
template <TimeIntegrator Integrator>
struct WithBodiesSlot {
    WithBodiesParameters<Integrator> inertia{};
};

/// Inertia of fibres and of rigid bodies on their nodes. A body has no unknown of its own: it adds its mass to that of the node's
/// place, and of each of its axes to that of a director, so that there is no angular velocity and no gyroscopic term. Where a rod
/// turns, the third axis has a velocity here. With the midpoint rule a free body keeps its energy and momenta in steps of any
/// length.
template <beam::BeamElement B, TimeIntegrator Integrator>
class WithBodiesOf : public InertiaOf<B, Integrator> {
    using Base = InertiaOf<B, Integrator>;
    using Coordinates = inertia::Coordinates<B>;
    static constexpr bool turns = Coordinates::turn;

public:
    using Parameters = WithBodiesParameters<Integrator>;
    using Slot = WithBodiesSlot<Integrator>;

    /// @throws std::invalid_argument naming the parameter that is wrong
    WithBodiesOf(const term::SiteOf<B>& site, const Parameters& parameters) : Base(site, parameters) {
        const beam::Mesh<B>& mesh = site.mesh();
        for (std::size_t k = 0; k < parameters.bodies.size(); ++k) {
            const Body& body = parameters.bodies[k];
            core::with_place(
                [&] { return "body " + std::to_string(k); },
                [&] {
                    core::validated(body), site.point(body.at);
                    const double node = body.at.fraction * static_cast<double>(mesh.node_count(body.at.fibre) - 1);
                    core::require(std::abs(node - std::round(node)) < 1e-9, "Body.at: fraction", body.at.fraction, "of a node");
                    if constexpr (!turns) {
                        const double flat = beam::DeformableSections<B> ? body.second_moments().z() : body.moments.sum();
                        core::require(std::abs(flat) <= 1e-12 * body.moments.sum(), "Body.moments: the third", body.moments.z(),
                                      beam::DeformableSections<B> ? "the sum of the others, on sections that deform"
                                                                  : "0, as the others, on a cable");
                    }
                });
            const Vec3 second = body.second_moments().cwiseMax(0.0);
            bodies_.push_back(
                {mesh.node_vector(body.at.fibre, mesh.node_at(body.at)), body.mass, {second[0], second[1], second[2]}});
            this->mass_norm_ = std::hypot(this->mass_norm_, body.mass);
            if constexpr (turns)
                turning_norm_ =
                    std::hypot(turning_norm_, second.norm() / mesh.layout().length[core::at(bodies_.back().vector + 1)]);
        }
        if constexpr (turns) third_.velocity = third_.acceleration = Vector::Zero(3 * core::count(bodies_));
        turn_third();
    }

    void begin(std::span<const double> amplitudes, const Vector& accepted) {
        Base::begin(amplitudes, accepted);
        if constexpr (turns) {
            third_.from = third_.place = third_axes(accepted);
            if (this->duration_ > 0.0)
                third_.place += this->step_.by_velocity * third_.velocity + this->step_.by_acceleration * third_.acceleration;
        }
    }
    /// Axes keep the digits of directors, of the length 1.
    double rounding() const noexcept {
        const double own = 8.0 * std::numeric_limits<double>::epsilon() * turning_norm_ / this->step_.c2;
        return Base::rounding() + (this->duration_ > 0.0 ? own : 0.0);
    }
    void add_forces(const Vector& state, Vector& sum) const {
        Base::add_forces(state, sum);
        if (!(this->duration_ > 0.0)) return;
        for (std::size_t k = 0; k < bodies_.size(); ++k) {
            const Massive& body = bodies_[k];
            const Index at = 3 * body.vector;
            sum.segment<3>(at) += body.mass / this->step_.c2 * (state.segment<3>(at) - place_of(k, 0));
            if constexpr (turns) {
                const Vec3 psi = state.segment<3>(at + 3);
                Vec3 moment = Vec3::Zero();
                each_axis(k, core::rotation(psi), [&](double stiffness, const Vec3& axis, const Vec3& arm, const Vec3& place) {
                    moment += stiffness * arm.cross(axis - place);
                });
                sum.segment<3>(at + 3) += core::spin_matrix(psi).transpose() * moment;
            } else if constexpr (beam::DeformableSections<B>) {
                for (Index d = 1; d <= 2; ++d)
                    sum.segment<3>(at + 3 * d) +=
                        body.second[core::at(d - 1)] / this->step_.c2 * (state.segment<3>(at + 3 * d) - place_of(k, d));
            }
        }
    }
    void add_bands(const Vector& state, term::Bands& bands) const {
        Base::add_bands(state, bands);
        if (!(this->duration_ > 0.0)) return;
        for (std::size_t k = 0; k < bodies_.size(); ++k) {
            const Massive& body = bodies_[k];
            bands.diagonal(body.vector, body.mass / this->step_.c2 * Mat3::Identity());
            if constexpr (turns) {
                const Vec3 psi = state.segment<3>(3 * body.vector + 3);
                const Mat3 T = core::spin_matrix(psi);
                Mat3 sum = Mat3::Zero();
                each_axis(k, core::rotation(psi), [&](double stiffness, const Vec3& axis, const Vec3& arm, const Vec3& place) {
                    const Vec3 pull = stiffness * (arm - arm_share() * (axis - place));
                    Mat3 bend = 0.5 * (axis * pull.transpose() + pull * axis.transpose());
                    bend.diagonal().array() -= axis.dot(pull);
                    sum -= T.transpose() * bend * T - core::spin_slope(psi, stiffness * arm.cross(axis - place));
                });
                bands.diagonal(body.vector + 1, sum);
            } else if constexpr (beam::DeformableSections<B>) {
                for (Index d = 1; d <= 2; ++d)
                    bands.diagonal(body.vector + d, body.second[core::at(d - 1)] / this->step_.c2 * Mat3::Identity());
            }
        }
    }

    double kinetic(const Vector& state) const {
        if (!(this->duration_ > 0.0)) return Base::kinetic(state) + kinetic_of(this->velocity_, third_.velocity);
        return Base::kinetic(state) + kinetic_of(this->arrived(state).first, third_arrived(state).first);
    }
    /// Of fibres and bodies, in the state that was accepted last, which is `state`.
    Motion motion(const Vector& state) const {
        Motion all = Base::motion(state);
        all.kinetic += kinetic_of(this->velocity_, third_.velocity);
        const Vector q = Coordinates::of(state.head(this->size_)), third = third_axes(state);
        for (std::size_t k = 0; k < bodies_.size(); ++k) {
            const Massive& body = bodies_[k];
            const Vec3 momentum = body.mass * this->velocity_.template segment<3>(first_of(body));
            all.momentum += momentum;
            all.angular_momentum += Vec3(q.segment<3>(first_of(body))).cross(momentum);
            each_vector(k, this->velocity_, third_.velocity, [&](double mass, Index at, const Vec3& velocity) {
                const Vec3 axis = at >= 0 ? q.segment<3>(at) : third.segment<3>(3 * static_cast<Index>(k));
                all.angular_momentum += mass * axis.cross(velocity);
            });
        }
        return all;
    }
    void accept(const Vector& state) {
        if constexpr (turns)
            if (this->duration_ > 0.0) std::tie(third_.velocity, third_.acceleration) = third_arrived(state);
        Base::accept(state);
    }
    void each(const auto& see) {
        Base::each(see);
        if constexpr (turns) see(third_.velocity), see(third_.acceleration);
    }
    /// Begins anew, bodies as the nodes that carry them. @throws std::invalid_argument for a fibre that is none
    void set_off(const std::vector<Start>& starts) {
        Base::set_off(starts);
        turn_third();
    }

private:
    struct Massive {
        Index vector;                  // nodal, of the place
        double mass;                   // [mass]
        std::array<double, 3> second;  // moments along its axes [mass length^2]
    };
    struct Third {  // axes of all bodies: accepted, and of the step
        Vector velocity, acceleration, from, place;
    };
    /// Of a body's place in the coordinates of mass; its two directors are behind it.
    static Index first_of(const Massive& body) noexcept { return turns ? body.vector / 2 * 9 : 3 * body.vector; }
    Vec3 place_of(std::size_t k, Index vector) const {
        return this->place_.template segment<3>(first_of(bodies_[k]) + 3 * vector);
    }
    Vector third_axes(const Vector& state) const {
        Vector axes;
        if constexpr (turns) {
            axes.resize(3 * core::count(bodies_));
            for (std::size_t k = 0; k < bodies_.size(); ++k)
                axes.segment<3>(3 * static_cast<Index>(k)) = core::rotation(state.segment<3>(3 * bodies_[k].vector + 3)).col(2);
        }
        return axes;
    }
    std::pair<Vector, Vector> third_arrived(const Vector& state) const {
        if constexpr (!turns) {
            return {};
        } else {
            const TimeStep& step = this->step_;
            Vector acceleration = (third_axes(state) - third_.place) / step.c2;
            Vector velocity =
                third_.velocity + step.old_acceleration * third_.acceleration + step.new_acceleration * acceleration;
            return {std::move(velocity), std::move(acceleration)};
        }
    }
    /// Where in the step a turn of an axis has its arm: where the scheme has its forces, and of the first step in the middle, so
    /// that a free body keeps its angular momentum from the start.
    double arm_share() const noexcept { return this->begins() ? 0.5 : this->step_.share; }
    /// The third axis begins with the velocity that those of the others give it.
    void turn_third() {
        if constexpr (turns) {
            const Vector q = Coordinates::of(this->mesh_->start_state());
            for (std::size_t k = 0; k < bodies_.size(); ++k) {
                const Index first = first_of(bodies_[k]) + 3, second = first + 3;
                const auto axis = [&](const Vector& all, Index at) { return Vec3(all.segment<3>(at)); };
                third_.velocity.template segment<3>(3 * static_cast<Index>(k)) =
                    axis(this->velocity_, first).cross(axis(q, second)) + axis(q, first).cross(axis(this->velocity_, second));
            }
        }
    }
    /// see(stiffness, axis, arm that its force turns the node by, place) of each axis of a body of a rod.
    template <class See>
    void each_axis(std::size_t k, const Mat3& turn, const See& see) const {
        for (Index d = 0; d < 3; ++d) {
            const Vec3 axis = turn.col(d);
            const Index at = d < 2 ? first_of(bodies_[k]) + 3 * (d + 1) : 3 * static_cast<Index>(k);
            const Vec3 from = (d < 2 ? this->from_ : third_.from).template segment<3>(at);
            const Vec3 place = (d < 2 ? this->place_ : third_.place).template segment<3>(at);
            see(bodies_[k].second[core::at(d)] / this->step_.c2, axis, Vec3(from + arm_share() * (axis - from)), place);
        }
    }
    /// see(second moment, place in the coordinates of mass or -1 of a third axis, velocity) of each axis of a body.
    template <class See>
    void each_vector(std::size_t k, const Vector& velocity, [[maybe_unused]] const Vector& third, const See& see) const {
        if constexpr (turns || beam::DeformableSections<B>)
            for (Index d = 0; d < 2; ++d) {
                const Index at = first_of(bodies_[k]) + 3 * (d + 1);
                see(bodies_[k].second[core::at(d)], at, Vec3(velocity.segment<3>(at)));
            }
        if constexpr (turns) see(bodies_[k].second[2], Index{-1}, Vec3(third.segment<3>(3 * static_cast<Index>(k))));
    }
    double kinetic_of(const Vector& velocity, const Vector& third) const {
        double sum = 0.0;
        for (std::size_t k = 0; k < bodies_.size(); ++k) {
            sum += 0.5 * bodies_[k].mass * velocity.segment<3>(first_of(bodies_[k])).squaredNorm();
            each_vector(k, velocity, third, [&](double mass, Index, const Vec3& one) { sum += 0.5 * mass * one.squaredNorm(); });
        }
        return sum;
    }

    std::vector<Massive> bodies_;
    double turning_norm_ = 0.0;  // of their second moments, over the radius [mass length]
    Third third_;
};

/// Inertia of fibres that carry rigid bodies: `using Acts = term::List<inertia::WithBodies<>, ...>` in the place of `Inertia`.
template <TimeIntegrator Integrator = GeneralisedAlpha>
struct WithBodies {
    using Parameters = WithBodiesParameters<Integrator>;
    using Slot = WithBodiesSlot<Integrator>;
    template <beam::BeamElement B>
    using Of = WithBodiesOf<B, Integrator>;
};

}  // namespace fibrant::inertia
