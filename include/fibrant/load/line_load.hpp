// SPDX-License-Identifier: MIT
#pragma once
/// @file Dead forces that are spread along fibres.

#include <fibrant/term/term.hpp>

#include <utility>

namespace fibrant::load {

/// Dead forces along fibres, uniform by rest length.
class LineLoads : public term::NoSearch,
                  public term::NoStiffness,
                  public term::NoEnergy,
                  public term::NoMemory,
                  public term::NoPicture {
public:
    static constexpr auto role = term::Role::external;
    struct Load {
        Index fibre = -1;                          ///< number of the fibre that it acts on
        Vec3 force = Vec3::Constant(core::unset);  ///< at amplitude 1 [force / length]
        double from = 0.0, to = 1.0;               ///< parts of the fibre's rest length, 0 <= from < to <= 1
        std::string channel = "load";              ///< whose amplitude it is multiplied by
        void validate() const {
            scene::require_finite("LineLoads.Load.force", force);
            core::require_between("LineLoads.Load.from", from, 0.0, 1.0);
            core::require(to > from && to <= 1.0, "LineLoads.Load.to", to, "> from and <= 1");
        }
    };
    struct Parameters {
        std::vector<Load> loads{};  ///< all that there are
        void validate() const {
            for (const Load& load : loads) load.validate();
        }
    };
    struct Slot {
        Parameters lines{};
    };

    /// @throws std::invalid_argument naming the parameter that is wrong
    LineLoads(const term::Site& site, const Parameters& parameters) {
        for (const Load& load : core::validated(parameters).loads) {
            if (load.fibre < 0 || load.fibre >= core::count(site.fibres()))
                core::refuse("LineLoads.Load.fibre", std::to_string(load.fibre), "a fibre of this assembly");
            const Index channel = site.channel(load.channel);
            site.each_point(load.fibre, load.from, load.to, [&](const term::CentrePoint& at, double length) {
                points_.push_back({at, length * load.force, channel});
            });
        }
    }
    static std::vector<std::string> channels(const Parameters& parameters) {
        std::vector<std::string> names;
        for (const Load& load : parameters.loads) names.push_back(load.channel);
        return names;
    }
    void begin(std::span<const double> amplitudes, const Vector&) { amplitudes_.assign(amplitudes.begin(), amplitudes.end()); }
    void add_forces(const Vector&, Vector& external) const {
        for (const Point& one : points_) one.at.push(amplitudes_[core::at(one.channel)] * one.force, external);
    }

private:
    struct Point {
        term::CentrePoint at;
        Vec3 force;  // at amplitude 1 [force]
        Index channel;
    };
    std::vector<Point> points_;
    std::vector<double> amplitudes_;
};
static_assert(term::Term<LineLoads>);

}  // namespace fibrant::load
