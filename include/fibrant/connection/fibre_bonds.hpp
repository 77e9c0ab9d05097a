// SPDX-License-Identifier: MIT
#pragma once
/// @file Bonds between fibres that carry force and moment and may break: glue, sintered necks, crosslinks.

#include <fibrant/term/term.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace fibrant::connection {

/// Springs between particles of two centrelines, at rest as the fibres are at rest. A bond without a span is one spring. One with
/// a span has two particles on either fibre, half a span before and behind its station, and the four springs between them: a
/// truss that resists relative motion in all directions and relative turns but those of a fibre about itself.
///
/// A bond breaks at the end of the increment in which F/strength + M/moment_strength reaches 1, F and M the size of what it
/// carries from one fibre to the other, M about the middle of its particles. What it stored then counts as dissipated in the next
/// increment.
class FibreBonds : public term::NoDrive,
                   public term::NoSearch,
                   public term::NoBands,
                   public term::NoSpring,
                   public term::NoPicture {
public:
    static constexpr auto role = term::Role::interaction;
    struct Bond {
        scene::Station i{}, j{};                                           ///< places of the two fibres
        double stiffness = core::unset;                                    ///< of each spring [force / length], > 0
        double span = 0.0;                                                 ///< along either fibre at rest [length], >= 0
        double strength = std::numeric_limits<double>::infinity();         ///< [force], > 0
        double moment_strength = std::numeric_limits<double>::infinity();  ///< [force length], > 0
        void validate() const {
            core::require_positive("FibreBonds.Bond.stiffness", stiffness);
            core::require_not_negative("FibreBonds.Bond.span", span);
            core::require(strength > 0.0, "FibreBonds.Bond.strength", strength, "> 0");
            core::require(moment_strength > 0.0, "FibreBonds.Bond.moment_strength", moment_strength, "> 0");
        }
    };
    struct Parameters {
        std::vector<Bond> bonds{};  ///< all that there are
        void validate() const {
            for (const Bond& bond : bonds) bond.validate();
        }
    };
    struct Slot {
        Parameters bonds{};
    };

    /// @throws std::invalid_argument naming the parameter that is wrong
    FibreBonds(const term::Site& site, const Parameters& parameters) {
        for (const Bond& bond : core::validated(parameters).bonds) {
            Truss truss{bond, ends(site, bond.i, bond.span), ends(site, bond.j, bond.span), {}};
            for (std::size_t a = 0; a < truss.i.size(); ++a)
                for (std::size_t b = 0; b < truss.j.size(); ++b) {
                    const double length = (truss.j[b].place(site.rest_state()) - truss.i[a].place(site.rest_state())).norm();
                    core::require_positive("FibreBonds.Bond: distance of its particles", length);
                    truss.length[2 * a + b] = length;
                }
            trusses_.push_back(std::move(truss));
        }
        broken_ = Vector::Zero(core::count(trusses_));
    }

    void add_forces(const Vector& state, Vector& sum) const {
        each_spring(state, [&](const Spring& spring) {
            const Vec3 force = spring.tension * spring.along;
            spring.j->push(force, sum), spring.i->push(-force, sum);
        });
    }
    /// What compression takes off across a spring is left out.
    void add_couplings(const Vector& state, term::Couplings& couplings) const {
        each_spring(state, [&](const Spring& spring) {
            const Mat3 onto = spring.along * spring.along.transpose();
            const Mat3 stiffness =
                spring.stiffness * onto + std::max(0.0, spring.tension) / spring.length * (Mat3::Identity() - onto);
            couplings.between(*spring.i, *spring.j, stiffness);
        });
    }
    double stored(const Vector& state) const {
        double sum = 0.0;
        each_spring(state, [&](const Spring& spring) { sum += 0.5 * spring.tension * spring.tension / spring.stiffness; });
        return sum;
    }
    double dissipated(const Vector&) const noexcept { return released_; }
    void accept(const Vector& state) {
        released_ = 0.0;
        for (Index k = 0; k < core::count(trusses_); ++k) {
            if (broken_[k] != 0.0) continue;
            if (use(k, state) < 1.0) continue;
            springs_of(k, state,
                       [&](const Spring& spring) { released_ += 0.5 * spring.tension * spring.tension / spring.stiffness; });
            broken_[k] = 1.0;
        }
    }
    void restore() const noexcept {}
    void each(const auto& see) { see(broken_), see(released_); }

    /// Whether a bond has broken. @param bond  its number among the parameters
    bool broken(Index bond) const { return broken_[bond] != 0.0; }
    /// What a bond pulls fibre j with towards fibre i in a state [force].
    Vec3 force(Index bond, const Vector& state) const {
        Vec3 sum = Vec3::Zero();
        if (broken_[bond] == 0.0) springs_of(bond, state, [&](const Spring& spring) { sum -= spring.tension * spring.along; });
        return sum;
    }
    /// F/strength + M/moment_strength in a state [1].
    double use(Index bond, const Vector& state) const {
        const Truss& truss = trusses_[core::at(bond)];
        Vec3 middle = Vec3::Zero(), moment = Vec3::Zero(), pull = Vec3::Zero();
        for (const auto& end : truss.i) middle += 0.5 / static_cast<double>(truss.i.size()) * end.place(state);
        for (const auto& end : truss.j) middle += 0.5 / static_cast<double>(truss.j.size()) * end.place(state);
        springs_of(bond, state, [&](const Spring& spring) {
            const Vec3 own = spring.tension * spring.along, arm = spring.j->place(state) - middle;
            pull += own, moment += arm.cross(own);
        });
        return pull.norm() / truss.bond.strength + moment.norm() / truss.bond.moment_strength;
    }

private:
    struct Truss {
        Bond bond;
        std::vector<term::CentrePoint> i, j;  // one or two each
        std::array<double, 4> length;         // at rest
    };
    struct Spring {
        const term::CentrePoint *i, *j;
        Vec3 along;
        double length, tension, stiffness;
    };
    static std::vector<term::CentrePoint> ends(const term::Site& site, const scene::Station& at, double span) {
        if (!(span > 0.0)) return {site.point(at)};
        if (at.fibre < 0 || at.fibre >= core::count(site.fibres()))
            core::refuse("Station.fibre", std::to_string(at.fibre), "a fibre of this assembly");
        const double half = 0.5 * span / site.fibres()[core::at(at.fibre)].length();
        core::require(at.fraction >= half && at.fraction <= 1.0 - half, "FibreBonds.Bond.span", span, "on the fibre");
        return {site.point({at.fibre, at.fraction - half}), site.point({at.fibre, at.fraction + half})};
    }
    template <class See>
    void springs_of(Index k, const Vector& state, const See& see) const {
        const Truss& truss = trusses_[core::at(k)];
        for (std::size_t a = 0; a < truss.i.size(); ++a)
            for (std::size_t b = 0; b < truss.j.size(); ++b) {
                const Vec3 away = truss.j[b].place(state) - truss.i[a].place(state);
                const double length = away.norm(), tension = truss.bond.stiffness * (length - truss.length[2 * a + b]);
                see(Spring{&truss.i[a], &truss.j[b], away / length, length, tension, truss.bond.stiffness});
            }
    }
    template <class See>
    void each_spring(const Vector& state, const See& see) const {
        for (Index k = 0; k < core::count(trusses_); ++k)
            if (broken_[k] == 0.0) springs_of(k, state, see);
    }

    std::vector<Truss> trusses_;
    Vector broken_;          // accepted: 1 of a bond that has broken
    double released_ = 0.0;  // by bonds that broke at the end of the last increment
};
static_assert(term::Term<FibreBonds>);

}  // namespace fibrant::connection
