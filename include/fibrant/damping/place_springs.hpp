// SPDX-License-Identifier: MIT
#pragma once
/// @file Damping: springs from every centre to a place where it was, which leave no force once nothing moves.

#include <fibrant/term/list.hpp>

#include <span>
#include <vector>

namespace fibrant::damping {

/// A spring from every centre to its last place, or to one that moves on with its group; directors count at the surface. It holds
/// what nothing else holds. A static increment with it is a step of implicit Euler for a motion that is damped by stiffness *
/// time step.
class PlaceSprings : public term::NoSearch,
                     public term::NoBands,
                     public term::NoCouplings,
                     public term::NoEnergy,
                     public term::NoMemory,
                     public term::NoPicture {
public:
    static constexpr auto role = term::Role::aid;
    using Parameters = core::NoParameters;
    struct Slot {
        Parameters place_springs{};
    };
    explicit PlaceSprings(const term::Site& site, const Parameters& = {}) : layout_{&site.layout()} {}

    static std::vector<std::string> channels(const Parameters&) { return {}; }
    /// To the places of a state. @param accepted  from which an increment starts
    void begin(std::span<const double>, const Vector& accepted) {
        if (stiffness_ > 0.0) places_ = accepted;
    }
    /// To be called before `begin`.
    /// @param stiffness  of each spring, >= 0 [force / length]
    /// @param harder     factor on it of each fibre, >= 1; none: 1
    void set(double stiffness, std::span<const double> harder) {
        stiffness_ = stiffness;
        harder_.assign(harder.begin(), harder.end());
    }
    /// Springs have their places in this state instead.
    void move_to(const Vector& places) { places_ = places; }

    /// Force on the fibres' supports in a state: what damping takes is work of this force [force].
    Vector force(const Vector& state) const {
        Vector force = Vector::Zero(state.size());
        if (!(stiffness_ > 0.0)) return force;
        for (Index v = 0; v < core::count(layout_->length); ++v) {
            const double length = layout_->length[core::at(v)];
            force.segment<3>(3 * v) = stiffness_ * length * length * (state.segment<3>(3 * v) - places_.segment<3>(3 * v));
        }
        for (const scene::ImageVector& one : layout_->images) force.segment<3>(3 * one.image).setZero();
        for (Index f = 0; f < core::count(harder_); ++f)
            if (harder(f) != 1.0)
                scene::for_own_vectors(*layout_, f, [&](Index v, double) { force.segment<3>(3 * v) *= harder(f); });
        return force;
    }
    void add_forces(const Vector& state, Vector& sum) const {
        if (stiffness_ > 0.0) sum += force(state);
    }
    double spring(Index fibre) const noexcept { return fibre < 0 ? stiffness_ : stiffness_ * harder(fibre); }

private:
    double harder(Index f) const noexcept { return harder_.empty() ? 1.0 : harder_[core::at(f)]; }

    const scene::DofLayout* layout_;
    double stiffness_ = 0.0;
    std::vector<double> harder_;
    Vector places_;
};
static_assert(term::Term<PlaceSprings>);

}  // namespace fibrant::damping
