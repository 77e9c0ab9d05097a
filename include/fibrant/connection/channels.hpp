// SPDX-License-Identifier: MIT
#pragma once
/// @file Channels: named amplitudes that scale what a scene imposes, so that a loading is data.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>
#include <fibrant/scene/assembly.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace fibrant::connection {

/// Names of the channels of a scene, sorted; amplitudes are kept in the same order.
class Channels {
public:
    Channels() = default;
    explicit Channels(const scene::Assembly& assembly) {
        for (const scene::Hold& hold : assembly.holds()) names_.push_back(hold.channel);
        for (const scene::DeadForce& force : assembly.forces()) names_.push_back(force.channel);
        for (const scene::Moment& moment : assembly.moments()) names_.push_back(moment.channel);
        for (const scene::Tool& tool : assembly.tools()) names_.push_back(tool.channel);
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

}  // namespace fibrant::connection
