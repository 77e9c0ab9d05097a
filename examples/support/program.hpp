// SPDX-License-Identifier: MIT
#pragma once
/// @file A program that solves a scene, as the command line and other callers see it.

#include <string>

namespace example {

class SceneReader;
struct Output;

struct Program {
    const char* name;
    const char* description;
    bool (*solve)(SceneReader&, Output&);  ///< @returns that what came of it is sound
};

/// Reads what all programs are told, takes so many threads, and solves the scene.
/// @param threads  as told to the caller, and by what name; empty: as solver.threads says
/// @returns that what came of it is sound
/// @throws std::invalid_argument where the scene is refused
bool solve(const Program& program, SceneReader& scene, Output& output, const std::string& threads = {},
           const std::string& threads_name = {});

/// The same with the command line NAME SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume |
/// --overwrite]
/// [--other-scene] [--quiet], or tells the keys of a scene: NAME --help-scene.
/// @returns 0 if it is sound, 1 if not, 2 if the scene is refused or what is needed cannot be read, written or held in memory,
/// 130 and 143 if it was stopped by SIGINT and SIGTERM
int run(int argc, char** argv, const Program& program);

}  // namespace example
