// SPDX-License-Identifier: MIT
#pragma once
/// @file Channels: named amplitudes that scale what a scene imposes, so that a loading is data.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>
#include <fibrant/scene/assembly.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::scene {

/// Names of the channels of a scene, sorted; amplitudes are kept in the same order.
class Channels {
public:
    Channels() = default;
    /// @param others  that terms of the equilibrium name
    explicit Channels(const Assembly& assembly, std::vector<std::string> others = {}) : names_{std::move(others)} {
        for (const FibreSpecification& fibre : assembly.fibres())
            if (!fibre.law_channel.empty()) names_.push_back(fibre.law_channel);
        for (const Hold& hold : assembly.holds()) names_.push_back(hold.channel);
        for (const DeadForce& force : assembly.forces()) names_.push_back(force.channel);
        for (const LinePressure& load : assembly.pressures()) names_.push_back(load.channel);
        for (const Moment& moment : assembly.moments()) names_.push_back(moment.channel);
        for (const Tool& tool : assembly.tools()) names_.push_back(tool.channel);
        const auto drive = [&](const Coordinate& coordinate) {
            if (coordinate.value != 0.0) names_.push_back(coordinate.channel);
        };
        for (const RigidBody& body : assembly.bodies())
            std::for_each(body.translation.begin(), body.translation.end(), drive),
                std::for_each(body.rotation.begin(), body.rotation.end(), drive);
        for (const AverageConnection& average : assembly.averages())
            if (!average.displacement.isZero(0.0)) names_.push_back(average.channel);
        for (const PeriodicCell& cell : assembly.cells())
            std::for_each(cell.gradient.begin(), cell.gradient.end(), drive),
                std::for_each(cell.curvature.begin(), cell.curvature.end(), drive);
        for (const SolidHold& hold : assembly.solid_holds()) names_.push_back(hold.channel);
        std::sort(names_.begin(), names_.end());
        names_.erase(std::unique(names_.begin(), names_.end()), names_.end());
    }
    const std::vector<std::string>& names() const noexcept { return names_; }

    /// @throws std::invalid_argument if no condition of the scene uses the channel
    Index find(const std::string& name) const {
        const auto it = std::lower_bound(names_.begin(), names_.end(), name);
        if (it == names_.end() || *it != name) {
            std::string known;
            for (const std::string& other : names_) known += (known.empty() ? "" : ", ") + other;
            core::refuse("channel", name, "one that the scene uses (" + known + ")");
        }
        return it - names_.begin();
    }

private:
    std::vector<std::string> names_;
};

}  // namespace fibrant::scene
