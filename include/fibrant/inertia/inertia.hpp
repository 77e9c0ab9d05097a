// SPDX-License-Identifier: MIT
#pragma once
/// @file Inertia as a term of the equilibrium: a model that has it moves in time, and one that has not pays nothing.

#include <fibrant/inertia/mass.hpp>
#include <fibrant/inertia/time_integrator.hpp>
#include <fibrant/term/list.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace fibrant::inertia {

/// What a fibre begins to move with: as a rigid body. Fibres that nothing is said of begin at rest.
struct Start {
    Index fibre = -1;              ///< -1: all
    Vec3 velocity = Vec3::Zero();  ///< of `centre` [length / time]
    Vec3 spin = Vec3::Zero();      ///< [radian / time]
    Vec3 centre = Vec3::Zero();    ///< [length]
};

/// Energy and momenta of a motion.
struct Motion {
    double kinetic = 0.0;                  ///< [force length]
    Vec3 momentum = Vec3::Zero();          ///< [force time]
    Vec3 angular_momentum = Vec3::Zero();  ///< about the origin [force length time]
};

/// Density of fibres, and how finely motion is resolved.
template <TimeIntegrator Integrator>
struct InertiaParameters {
    double density = core::unset;     ///< of all fibres [mass / length^3], > 0
    std::vector<double> densities{};  ///< or one for each fibre
    double allowed_error =
        std::numeric_limits<double>::infinity();  ///< of a step, directors counted at the surface [length], > 0
    /// What the balance of a step may miss: this part of the energy that the step turns from one kind into another, and, of all
    /// that there is, this part in the duration of a stage. Steps that miss less leave that to later ones [1], > 0, <= 1.
    double allowed_loss = core::unset;  // left out: any
    typename Integrator::Parameters integrator{};
    std::vector<Start> starts{};  ///< the last that is said of a fibre counts
};
/// What parameters of a model with inertia have beside the others.
template <TimeIntegrator Integrator>
struct InertiaSlot {
    InertiaParameters<Integrator> inertia{};
};

/// Inertia of the fibres of a beam: a spring from every vector to where it would go without forces, of the stiffness M/c^2.
///
/// Each stage has a `duration`; its increments are the steps of time, and what follows its ramps goes on in steps of the last
/// one. A step that errs by more than `allowed_error`, or whose balance of energy misses more than `allowed_loss` lets it, is
/// cut, and grows again by as much as both let it. So a motion misses no more than `may_miss`, however it is
/// stepped, but for what contact misses in steps of any length: `missed` tells.
template <beam::BeamElement B, TimeIntegrator Integrator>
class InertiaOf : public term::NoSearch,
                  public term::NoSpring,
                  public term::NoCouplings,
                  public term::NoEnergy,
                  public term::NoPicture {
    using Own = Coordinates<B>;
    static constexpr Index vectors = B::nodes * B::vectors_per_node;  // of an element

public:
    static constexpr auto role = term::Role::aid;
    using Parameters = InertiaParameters<Integrator>;
    using Slot = InertiaSlot<Integrator>;

    /// @throws std::invalid_argument naming the parameter that is wrong
    InertiaOf(const term::SiteOf<B>& site, const Parameters& parameters)
        : mesh_{&site.mesh()},
          integrator_{core::validated(parameters.integrator)},
          allowed_{parameters.allowed_error},
          loss_{parameters.allowed_loss} {
        core::require(allowed_ > 0.0, "Inertia.allowed_error", allowed_, "> 0");
        if (limits_loss()) core::require(loss_ > 0.0 && loss_ <= 1.0, "Inertia.allowed_loss", loss_, "> 0 and <= 1");
        const Index fibres = mesh_->fibre_count();
        if (!parameters.densities.empty() && core::count(parameters.densities) != fibres)
            core::refuse("Inertia.densities", std::to_string(parameters.densities.size()) + " numbers",
                         "one for each of " + std::to_string(fibres) + " fibres");
        for (Index f = 0; f < fibres; ++f) {
            const double density = parameters.densities.empty() ? parameters.density : parameters.densities[core::at(f)];
            core::require_positive("Inertia.density of fibre " + std::to_string(f), density);
            masses_.emplace_back(mesh_->fibre(f), density);
            const double node = density * mesh_->fibre(f).section.area() * mesh_->fibre(f).element_length;
            mass_norm_ = std::hypot(mass_norm_, node * std::sqrt(static_cast<double>(mesh_->node_count(f))));
        }
        size_ = mesh_->rest_state().size();
        velocity_ = acceleration_ = Vector::Zero(Own::size(mesh_->rest_state()));
        force_ = Vector::Zero(size_);
        set_off(parameters.starts);
    }

    static std::vector<std::string> channels(const Parameters&) { return {}; }
    /// How long the next increments last; to be called before `begin`. @param duration  [time], > 0
    void last(double duration) noexcept {
        duration_ = duration;
        if (!(duration_ > 0.0)) return;
        step_ = integrator_.step(duration_);
        if (moving_ == 0.0 && (step_.by_acceleration != 0.0 || step_.old_acceleration != 0.0 || step_.share != 1.0))
            step_ = first_step(duration_);
    }
    void begin(std::span<const double>, const Vector& accepted) {
        from_ = Own::of(accepted);
        extent_ = from_.cwiseAbs().maxCoeff();
        if (!(duration_ > 0.0)) return;
        place_ = from_ + step_.by_velocity * velocity_ + step_.by_acceleration * acceleration_;
    }
    double share() const noexcept { return step_.share; }
    bool begins() const noexcept { return moving_ == 0.0; }
    /// Places keep the digits of coordinates.
    double rounding() const noexcept {
        return duration_ > 0.0 ? 8.0 * std::numeric_limits<double>::epsilon() * extent_ * mass_norm_ / step_.c2 : 0.0;
    }

    void add_forces(const Vector& state, Vector& sum) const {
        if (!(duration_ > 0.0)) return;
        const Vector away = (Own::of(state) - place_) / step_.c2;
        Vector force = Vector::Zero(size_);
        times_mass(away, force, state);
        sum.head(size_) += force;
    }
    void add_bands(const Vector& state, term::Bands& bands) const {
        if (!(duration_ > 0.0)) return;
        beam::ElementMatrix<B> stiffness;
        for (Index f = 0; f < mesh_->fibre_count(); ++f) {
            stiffness.setZero();
            for (Index a = 0; a < vectors; ++a)
                for (Index b = 0; b < vectors; ++b)
                    for (Index c = 0; c < 3; ++c)
                        stiffness(3 * a + c, 3 * b + c) = masses_[core::at(f)].of[core::at(a)][core::at(b)] / step_.c2;
            for (Index e = 0; e < mesh_->fibre(f).elements; ++e) bands.element(f, e, stiffness);
        }
        if constexpr (Own::turn)
            each_turning([&](Index vector, const std::array<double, 2>& mass) {
                // The moment of J (g - p)/c^2 about a director's arm is one of a dead force on it; forces of the accepted state
                // have theirs.
                const Vec3 psi = state.segment<3>(3 * vector);
                const Mat3 R = core::rotation(psi), T = core::spin_matrix(psi);
                Mat3 sum = (1.0 - step_.share) * core::spin_slope(psi, force_.segment<3>(3 * vector));
                for (Index k = 0; k < 2; ++k) {
                    const double stiffness = mass[core::at(k)] / step_.c2;
                    const Vec3 g = R.col(k), arm = arm_of(vector, k, g), place = place_of(vector, k),
                               pull = stiffness * (arm - step_.share * (g - place));
                    Mat3 bend = 0.5 * (g * pull.transpose() + pull * g.transpose());
                    bend.diagonal().array() -= g.dot(pull);
                    sum -= T.transpose() * bend * T - core::spin_slope(psi, stiffness * arm.cross(g - place));
                }
                bands.diagonal(vector, sum);
            });
    }
    /// Forces of the fibres as the step has them. @param internal  those in `state`
    void add_averaged(const Vector& state, const Vector& internal, Vector& sum) {
        now_ = Own::in_space(state, internal.head(size_));
        sum.head(size_) += step_.share * internal.head(size_) + (1.0 - step_.share) * Own::from_space(state, force_);
    }
    /// What forces of the fibres at the end of the step are more than the step had them: what holds the fibres carries it.
    Vector left(const Vector& state) const { return Own::from_space(state, (1.0 - step_.share) * (now_ - force_)); }

    double kinetic(const Vector& state) const {
        return duration_ > 0.0 ? kinetic_of(arrived(state).first) : kinetic_of(velocity_);
    }
    /// Of the state that was accepted last, which is `state`.
    Motion motion(const Vector& state) const {
        const Vector p = times_mass(velocity_), q = Own::of(state.head(size_));
        Motion all{0.5 * velocity_.dot(p), Vec3::Zero(), Vec3::Zero()};
        for (Index v = 0; 3 * v < p.size(); ++v) {
            if (v % Own::per_node == 0) all.momentum += p.segment<3>(3 * v);
            all.angular_momentum += Vec3(q.segment<3>(3 * v)).cross(Vec3(p.segment<3>(3 * v)));
        }
        return all;
    }
    /// Why a step to a state is too long; empty if it is not.
    std::string refusal(const Vector& state) {
        if (!(allowed_ < std::numeric_limits<double>::infinity()) || !(duration_ > 0.0)) return {};
        error_ = error(state);
        if (error_ <= allowed_) return {};
        return "the step of time errs by " + core::text(error_) + ", more than the allowed error, " + core::text(allowed_);
    }
    /// The same of its energy: half of what is left over may go into one step. What half of the step misses nearly as well is of
    /// contact, and no step resolves it: half of what the rest of the stage may miss goes into it, and later steps make up for
    /// that. What three halvings do not make less is let pass, until steps miss little by themselves again.
    std::string refusal(const term::StepEnergy& step) {
        step_missed_ = std::abs(step.missed), step_may_ = step_most_ = 0.0;
        if (!limits_loss()) return {};
        const double over = may_miss_ - missed_;
        step_may_ = loss_ * (step.turned + step.part * step.held);
        step_most_ = over >= 0.0 ? step_may_ : 0.5 * step_may_;
        double most = step_most_ + 0.5 * std::max(0.0, over);
        const bool no_better = duration_ < shorter * refused_duration_ && step_missed_ > hardly_less * refused_missed_;
        halvings_ = no_better ? halvings_ + 1 : 0;
        if (no_better) most = std::max(most, step_may_ + over + 0.5 * loss_ * step.left * step.held);
        if (halvings_ >= most_halvings) unresolved_ = step_missed_ / duration_;
        most = std::max(most, unevenness * unresolved_ * duration_);
        if (step_missed_ <= most) return {};
        refused_missed_ = step_missed_, refused_duration_ = duration_;
        return "the balance of energy of the step of time misses " + core::text(step_missed_) + ", more than " +
               core::text(most) + ", which an allowed loss of " + core::text(loss_) + " lets it";
    }
    /// What the balances of all accepted steps miss, whether lost or gained [force length].
    double missed() const noexcept { return missed_; }
    /// What they may, by `allowed_loss`; 0 if any may [force length].
    double may_miss() const noexcept { return may_miss_; }
    /// Whether a step that is `growth` times as long would be accepted, as what it errs by and misses grows by the third power,
    /// and what it may miss as it lasts.
    bool may_grow(double growth) const noexcept {
        return error_ * growth * growth * growth <= allowed_ && (!limits_loss() || step_missed_ * growth * growth <= step_most_);
    }

    void accept(const Vector& state) {
        if (!(duration_ > 0.0)) return;
        std::tie(velocity_, acceleration_) = arrived(state);
        if (now_.size() == size_) force_ = now_;
        moving_ = 1.0;
        missed_ += step_missed_, may_miss_ += step_may_;
        if (step_missed_ <= step_most_) unresolved_ = 0.0;
        step_missed_ = step_may_ = refused_missed_ = refused_duration_ = 0.0, halvings_ = 0;
    }
    void restore() const noexcept {}
    void each(const auto& see) {
        see(velocity_), see(acceleration_), see(force_), see(moving_), see(missed_), see(may_miss_), see(unresolved_);
    }

    /// Begins anew from a state: at rest, or as it is told. @throws std::invalid_argument for a fibre that is none
    void set_off(const std::vector<Start>& starts) {
        velocity_.setZero(), moving_ = 0.0;
        const Vector q = Own::of(mesh_->start_state());
        for (const Start& start : starts) {
            if (start.fibre < -1 || start.fibre >= mesh_->fibre_count())
                core::refuse("Inertia.starts: fibre", std::to_string(start.fibre), "a fibre of this assembly, or -1");
            scene::require_finite("Inertia.starts: velocity", start.velocity),
                scene::require_finite("Inertia.starts: spin", start.spin);
            for (Index f = 0; f < mesh_->fibre_count(); ++f) {
                if (start.fibre >= 0 && f != start.fibre) continue;
                const Index first = mesh_->fibre(f).first_vector / B::vectors_per_node, nodes = mesh_->node_count(f);
                for (Index v = first * Own::per_node; v < (first + nodes) * Own::per_node; ++v) {
                    const Vec3 arm = q.segment<3>(3 * v);
                    const bool position = v % Own::per_node == 0;
                    velocity_.segment<3>(3 * v) =
                        position ? Vec3(start.velocity + start.spin.cross(arm - start.centre)) : Vec3(start.spin.cross(arm));
                }
            }
        }
    }

protected:                                   // for what has masses beside those of fibres
    static constexpr double shorter = 0.75;  // than a step that is halved, or cut by more
    static constexpr double hardly_less =
        0.4;  // of what that missed: an eighth it should be, a quarter by a scheme of first order
    static constexpr Index most_halvings = 3;
    static constexpr double unevenness = 1.5;  // of what no step resolves
    bool limits_loss() const noexcept { return !std::isnan(loss_); }
    std::pair<Vector, Vector> arrived(const Vector& state) const {
        Vector acceleration = (Own::of(state.head(size_)) - place_) / step_.c2;
        Vector velocity = velocity_ + step_.old_acceleration * acceleration_ + step_.new_acceleration * acceleration;
        return {std::move(velocity), std::move(acceleration)};
    }
    double kinetic_of(const Vector& velocity) const { return 0.5 * velocity.dot(times_mass(velocity)); }
    double error(const Vector& state) const {
        if (moving_ == 0.0) return 0.0;
        const Vector error = step_.error_old * acceleration_ + step_.error_new * arrived(state).second;
        const std::vector<double>& length = mesh_->layout().length;
        double most = 0.0;
        for (Index v = 0; 3 * v < error.size(); ++v) {
            const Index node = v / Own::per_node, k = v % Own::per_node;
            const double size = length[core::at(node * B::vectors_per_node + std::min<Index>(k, B::vectors_per_node - 1))];
            most = std::max(most, size * error.segment<3>(3 * v).norm());
        }
        return most;
    }
    /// A director as it is when the scheme has its forces: those of its mass turn a section by that.
    Vec3 arm_of(Index vector, Index k, const Vec3& g) const {
        const Vec3 from = from_.segment<3>(9 * (vector / 2) + 3 * (k + 1));
        return from + step_.share * (g - from);
    }
    Vec3 place_of(Index vector, Index k) const { return place_.segment<3>(9 * (vector / 2) + 3 * (k + 1)); }
    /// see(rotation vector, masses of its two directors), images left out.
    template <class See>
    void each_turning(const See& see) const {
        for (Index f = 0; f < mesh_->fibre_count(); ++f) {
            const beam::MeshFibre& fibre = mesh_->fibre(f);
            for (Index node = 0; node <= fibre.elements; ++node) {
                if (fibre.closed && node == fibre.elements) continue;
                const double sides = !fibre.closed && (node == 0 || node == fibre.elements) ? 1.0 : 2.0;
                const auto& own = masses_[core::at(f)].turning;
                see(fibre.first_vector + 2 * node + 1, std::array<double, 2>{sides * own[0], sides * own[1]});
            }
        }
    }
    /// Adds to forces on nodal vectors the mass times what is given in the coordinates of mass.
    void times_mass(const Vector& q, Vector& sum, [[maybe_unused]] const Vector& state) const {
        core::parallel_for(
            mesh_->fibre_count(),
            [&](Index f) {
                const ElementMass<B>& mass = masses_[core::at(f)];
                for (Index e = 0; e < mesh_->fibre(f).elements; ++e) {
                    const Index first = mesh_->first_unknown(f, e);
                    for (Index a = 0; a < vectors; ++a)
                        for (Index b = 0; b < vectors; ++b) {
                            if (mass.of[core::at(a)][core::at(b)] == 0.0) continue;
                            const Index other = Own::turn ? first / 6 * 9 + 9 * (b / 2) : first + 3 * b;  // rods: positions alone
                            sum.segment<3>(first + 3 * a) += mass.of[core::at(a)][core::at(b)] * q.segment<3>(other);
                        }
                }
            },
            mesh_->grain());
        if constexpr (Own::turn)
            each_turning([&](Index vector, const std::array<double, 2>& mass) {
                const Vec3 psi = state.segment<3>(3 * vector);
                const Mat3 R = core::rotation(psi);
                Vec3 moment = Vec3::Zero();
                for (Index k = 0; k < 2; ++k)
                    moment +=
                        mass[core::at(k)] * arm_of(vector, k, R.col(k)).cross(Vec3(q.segment<3>(9 * (vector / 2) + 3 * (k + 1))));
                sum.segment<3>(3 * vector) += core::spin_matrix(psi).transpose() * moment;
            });
    }
    /// Mass times what is given, both in the coordinates of mass.
    Vector times_mass(const Vector& q) const {
        Vector product = Vector::Zero(q.size());
        if constexpr (!Own::turn) {
            times_mass(q, product, q);
        } else {
            Vector positions = Vector::Zero(size_);
            for (Index f = 0; f < mesh_->fibre_count(); ++f)
                for (Index e = 0; e < mesh_->fibre(f).elements; ++e) {
                    const Index first = mesh_->first_unknown(f, e) / 6 * 9;
                    for (Index a = 0; a < 2; ++a)
                        for (Index b = 0; b < 2; ++b)
                            product.segment<3>(first + 9 * a) +=
                                masses_[core::at(f)].of[core::at(2 * a)][core::at(2 * b)] * q.segment<3>(first + 9 * b);
                }
            each_turning([&](Index vector, const std::array<double, 2>& mass) {
                for (Index k = 0; k < 2; ++k) {
                    const Index at = 9 * (vector / 2) + 3 * (k + 1);
                    product.segment<3>(at) = mass[core::at(k)] * q.segment<3>(at);
                }
            });
        }
        return product;
    }

    const beam::Mesh<B>* mesh_;
    Integrator integrator_;
    double allowed_, loss_, error_ = 0.0;
    double missed_ = 0.0, may_miss_ = 0.0;  // of all steps
    // Of the last one that has converged; `most` without what others leave.
    double step_missed_ = 0.0, step_may_ = 0.0, step_most_ = 0.0;
    double unresolved_ = 0.0;                               // missed in a time by accepted steps that none resolves
    Index halvings_ = 0;                                    // in a row that made it hardly less
    double refused_missed_ = 0.0, refused_duration_ = 0.0;  // of the last one that missed too much, since one was accepted
    std::vector<ElementMass<B>> masses_;                    // of each fibre
    Index size_ = 0;                                        // of a state of the fibres
    double duration_ = 0.0, extent_ = 0.0;
    double mass_norm_ = 0.0;  // of the masses of nodes
    TimeStep step_{};
    Vector velocity_, acceleration_;  // accepted, in the coordinates of mass
    Vector force_;                    // accepted: forces of the fibres less the loads, in space
    double moving_ = 0.0;             // 1: an acceleration is known
    Vector from_, place_, now_;       // of the step: start and place in the coordinates of mass, forces in space
};

/// Inertia for any beam: `using Acts = term::List<inertia::Inertia<>, ...>` in a model.
template <TimeIntegrator Integrator = GeneralisedAlpha>
struct Inertia {
    using Parameters = InertiaParameters<Integrator>;
    using Slot = InertiaSlot<Integrator>;
    template <beam::BeamElement B>
    using Of = InertiaOf<B, Integrator>;
};

}  // namespace fibrant::inertia
