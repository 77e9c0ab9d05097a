// SPDX-License-Identifier: MIT
#pragma once
/// @file Weight of the fibres.

#include <fibrant/term/term.hpp>

namespace fibrant::load {

/// A dead force on all that fibres are made of: weight times the area of the section at rest, a rest length.
class Gravity : public term::NoSearch,
                public term::NoStiffness,
                public term::NoEnergy,
                public term::NoMemory,
                public term::NoPicture {
public:
    static constexpr auto role = term::Role::external;
    struct Parameters {
        Vec3 weight = Vec3::Constant(core::unset);  ///< density times acceleration, at amplitude 1 [force / length^3]
        std::string channel = "gravity";            ///< whose amplitude it is multiplied by
        void validate() const { scene::require_finite("Gravity.weight", weight); }
    };
    struct Slot {
        Parameters gravity{};
    };

    /// @throws std::invalid_argument naming the parameter that is wrong
    Gravity(const term::Site& site, const Parameters& parameters)
        : channel_{site.channel(core::validated(parameters).channel)}, whole_{Vector::Zero(site.layout().unknowns())} {
        for (Index f = 0; f < core::count(site.fibres()); ++f) {
            const Vec3 load = site.fibres()[core::at(f)].section.area() * parameters.weight;
            site.each_point(f, 0.0, 1.0, [&](const term::CentrePoint& at, double length) { at.push(length * load, whole_); });
        }
    }
    static std::vector<std::string> channels(const Parameters& parameters) { return {parameters.channel}; }
    void begin(std::span<const double> amplitudes, const Vector&) noexcept { amplitude_ = amplitudes[core::at(channel_)]; }
    void add_forces(const Vector&, Vector& external) const { external += amplitude_ * whole_; }

private:
    Index channel_;
    Vector whole_;  // at amplitude 1
    double amplitude_ = 0.0;
};
static_assert(term::Term<Gravity>);

}  // namespace fibrant::load
