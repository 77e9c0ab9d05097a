// SPDX-License-Identifier: MIT
#pragma once
/// @file Keeps the energy balance of a run, increment by increment.

#include <fibrant/core/types.hpp>
#include <fibrant/law/normal_law.hpp>
#include <fibrant/simulation/report.hpp>
#include <fibrant/term/term.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <type_traits>

namespace fibrant::simulation {

/// Books what an increment took, stored and lost.
///
/// Loads and supports work by trapezia: their forces vary linearly from the state that an increment starts from to that which it
/// ends with, those on what a hold turns as the turned section sees them. Contact elements are renewed in between, turned and
/// weighed anew with the fibres. The forces of those that carry the end are therefore not those that the start was in balance
/// with, and what contact stores and takes, which is booked on the elements of the end, is of a path that begins with a jump of
/// forces. Along a path without it renewal works as well, by half of that jump: counted as rearranged with what the elements
/// store at once, it leaves an error of second order. Fibres along each other have their normals of then, or those that slid
/// around each other would seem to have been deep in each other. A pair that lies far deeper where the increment started than its
/// zone did is of places that came together since: it carried nothing there, and has none of this.
class EnergyAccount {
public:
    using Amplitudes = std::array<std::span<const double>, 2>;
    const EnergyBalance& balance() const noexcept { return balance_; }
    /// Force of the damping at the end of the last increment [force].
    const Vector& damping() const noexcept { return damping_; }

    /// What fibres and solids store in a state that a run begins with counts as work done before. What held them so lets go over
    /// the first increment.
    template <class Equilibrium>
    void start(Equilibrium& equilibrium, const Vector& state) {
        const double elastic = equilibrium.elastic_energy(state);
        balance_.external += elastic - balance_.elastic;
        balance_.elastic = elastic;
        if constexpr (Equilibrium::moves)
            equilibrium.terms().moving([&](const auto& term) {
                balance_.external += term.kinetic(state) - balance_.kinetic;
                balance_.kinetic = term.kinetic(state);
            });
        external_ = contact_.size() == state.size() ? contact_ : Vector(Vector::Zero(state.size()));
        equilibrium.add_internal_forces(state, external_);
        damping_.resize(0);
    }
    /// The same with contacts that stand there. @param before  the state as they know it, the first part of `state`
    template <class Equilibrium, class Contacts>
    void start(Equilibrium& equilibrium, const Vector& state, const Contacts& contacts, const Vector& before) {
        const double stored = contacts.figures(before).work;
        balance_.external += stored - balance_.contact;
        balance_.contact = stored;
        Vector forces = Vector::Zero(before.size());
        contacts.add_forces(forces);
        contact_ = Vector::Zero(state.size());
        contact_.head(before.size()) = forces;
        start(equilibrium, state);
    }
    /// The same where another run stored something else in the state that it left: of other fibres, or of other elements.
    template <class Equilibrium>
    void start_from_other(Equilibrium& equilibrium, const Vector& state) {
        const double elastic = equilibrium.elastic_energy(state);
        if (!(std::abs(elastic - balance_.elastic) <= 1e-9 * elastic)) start(equilibrium, state);
    }

    /// An increment that has converged; contacts are evaluated at its end, before and after.
    /// @param amplitudes  of all channels where it starts and where it ends
    /// @param leap        it starts from an overlap that is imposed: it has no balance to check
    template <class Equilibrium, class Contacts>
    void book(const Equilibrium& equilibrium, Contacts& contacts, const Amplitudes& amplitudes, const Vector& from,
              const Vector& to, bool leap) {
        const double error_before = balance_.error();
        const Vector way = to - from;
        if constexpr (Equilibrium::moves)
            equilibrium.terms().moving([&](const auto& term) {
                // What lets go is there from the start on.
                if (term.begins()) external_ = equilibrium.external() + equilibrium.reaction();
                balance_.kinetic = term.kinetic(to);
            });
        if (external_.size() != to.size()) external_ = Vector::Zero(to.size());
        const Vector force = equilibrium.external() + equilibrium.reaction();
        const double turned = equilibrium.beyond_chords({amplitudes, {&from, &to}, {&external_, &force}});
        balance_.external += trapezium(way, external_, force);
        balance_.external += turned;
        balance_.damped += trapezium(way, damping_, equilibrium.damping_force(to));
        if constexpr (requires { contacts.tools(); })
            balance_.external += contacts.tools().half_work(), contacts.tools().stand_back(true);
        const contact::ContactFigures end = contacts.figures(to);
        rest(contacts, true);
        const auto pairs = contacts.turn_back(from);
        contacts.evaluate(from, true);  // the same contact elements, where the increment started
        balance_.rearranged += contacts.figures(from).work - balance_.contact;
        if (contact_.size() != to.size()) contact_ = Vector::Zero(to.size());
        if (!leap && !Equilibrium::moves) {  // a motion has its forces from the elements of its step alone, and bears no jump
            Vector renewed = Vector::Zero(to.size());
            contacts.add_forces(renewed);
            balance_.rearranged -= 0.5 * way.dot(contact_ - renewed);
        }
        if constexpr (requires { contacts.tools(); })
            balance_.external += contacts.tools().half_work(), contacts.tools().stand_back(false);
        contacts.turn_forth(pairs);
        contacts.evaluate(to);
        contact_.setZero();
        contacts.add_forces(contact_);
        if (rest(contacts, false)) contacts.evaluate(to);
        balance_.dissipated += end.dissipated + equilibrium.dissipated(to);
        balance_.contact = end.work;
        balance_.elastic = equilibrium.elastic_energy(to);
        if (leap) balance_.released += balance_.error() - error_before;
    }

    /// The same of an increment that a motion keeps only if it errs and misses little enough: what it is refused for, and then
    /// nothing is booked; empty if it is kept.
    /// @param laws  books what laws of sections have lost
    /// @param part  of the stage's duration that the increment lasts
    /// @param left  of it, after that
    template <class Equilibrium, class Contacts, class Laws>
    std::string book(Equilibrium& equilibrium, Contacts& contacts, const Amplitudes& amplitudes, const Vector& from,
                     const Vector& to, bool leap, const Laws& laws, [[maybe_unused]] double part, [[maybe_unused]] double left) {
        if constexpr (Equilibrium::moves) {
            std::string reason;
            equilibrium.terms().moving([&](auto& term) { reason = term.refusal(to); });
            if (!reason.empty()) return reason;
            const EnergyAccount before = *this;
            book(equilibrium, contacts, amplitudes, from, to, leap), laws(*this);
            term::StepEnergy step = of_step(before.balance_, equilibrium.rounding_energy());
            step.part = part, step.left = left;
            equilibrium.terms().moving([&](auto& term) { reason = term.refusal(step); });
            if (!reason.empty()) *this = before;
            return reason;
        } else {
            book(equilibrium, contacts, amplitudes, from, to, leap), laws(*this);
            return {};
        }
    }

    /// The balance of an increment of which all is booked. What a motion misses then is lost to the scheme that moves it.
    template <bool Moves>
    const EnergyBalance& closed() {
        if constexpr (Moves) balance_.numerical = balance_.error();
        return balance_;
    }
    /// What the laws of sections have lost in an increment, and what work what drives them has done.
    void book_laws(double lost, double driven) { balance_.lost += lost, balance_.external += driven; }

    /// Bonds have let go since: this is stored now.
    void release(double elastic) {
        balance_.released += balance_.elastic - elastic;
        balance_.elastic = elastic;
    }

    /// Follows vectors that are told in another way from now on. @param reaction  what else does
    template <class Mesh>
    void rewind(const Mesh& mesh, Vector& state, Vector& reaction) {
        mesh.rewind(state, {&external_, &damping_, &contact_, &reaction});
    }

    /// All that a checkpoint needs: vectors first.
    void each(auto&& see) { see(external_), see(damping_), see(contact_), see(balance_); }

private:
    /// What has happened since another balance, but for what rounding makes of sums and of strains.
    term::StepEnergy of_step(const EnergyBalance& before, double rounding) const {
        const auto change = [&](double EnergyBalance::*kind) { return std::abs(balance_.*kind - before.*kind); };
        term::StepEnergy step;
        for (const auto kind :
             {&EnergyBalance::external, &EnergyBalance::kinetic, &EnergyBalance::elastic, &EnergyBalance::contact,
              &EnergyBalance::dissipated, &EnergyBalance::lost, &EnergyBalance::damped})
            step.turned += 0.5 * change(kind);  // it is counted where it comes from and where it goes
        step.held = balance_.kinetic + balance_.elastic + balance_.contact;
        const double digits =
            16.0 * std::numeric_limits<double>::epsilon() * (std::abs(balance_.external) + step.held) + rounding;
        step.missed = balance_.error() - before.error();
        if (std::abs(step.missed) <= digits) step.missed = 0.0;
        return step;
    }
    /// A normal law with a rate as it is at rest, and as it was. @returns whether there is one
    template <class Contacts>
    static bool rest([[maybe_unused]] Contacts& contacts, [[maybe_unused]] bool still) {
        constexpr bool stepped = law::SteppedNormal<std::decay_t<decltype(contacts.normal_law())>>;
        if constexpr (stepped) contacts.normal_law().rest(still);
        return stepped;
    }
    /// Half of the work of a force on a way, and of that which it was before. @param last  becomes the force
    static double trapezium(const Vector& way, Vector& last, const Vector& force) {
        if (last.size() != force.size()) last = Vector::Zero(force.size());
        const double work = 0.5 * way.dot(force + last);
        last = force;
        return work;
    }

    EnergyBalance balance_;
    Vector external_, damping_, contact_;  ///< forces at the end of the last increment [force]
};

}  // namespace fibrant::simulation
