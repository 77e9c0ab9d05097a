// SPDX-License-Identifier: MIT
#pragma once
/// @file Whether a checkpoint is of the scene that it is asked for.

#include <fibrant/simulation/state_file.hpp>

#include <stdexcept>
#include <string>
#include <vector>

namespace example {

/// What the run was of that left a checkpoint, line by line.
/// @param name  of the file in the message: what the user gave
/// @throws std::invalid_argument if the checkpoint cannot be read or is damaged
inline std::string scene_of(const std::string& checkpoint, const std::string& name) {
    try {
        return fibrant::simulation::checkpoint_scene(checkpoint);
    } catch (const std::runtime_error& error) {
        throw std::invalid_argument(name + ": " + error.what());
    }
}

/// @param told      what the scene is, line by line, as SceneReader tells it
/// @param name      of the file in the message: what the user gave
/// @param sections  that count; empty: all
/// @throws std::invalid_argument if the checkpoint says that it is of another scene, or cannot be read
inline void require_scene_of(const std::string& checkpoint, const std::string& told, const std::string& name,
                             const std::vector<std::string>& sections = {}) {
    const std::string difference = fibrant::simulation::scene_difference(scene_of(checkpoint, name), told, sections);
    if (!difference.empty())
        throw std::invalid_argument(name + ": " + checkpoint + " is of another scene: " + difference +
                                    "; --other-scene takes it all the same");
}

}  // namespace example
