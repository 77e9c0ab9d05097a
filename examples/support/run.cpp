// SPDX-License-Identifier: MIT
#include "command_line.hpp"
#include "example.hpp"
#include "program.hpp"

#include <CLI/CLI.hpp>
#if defined(_OPENMP)
#include <omp.h>
#endif

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace example {

namespace {

/// Threads that a program may be told to use: more do not help, and far more cannot be had.
int most_threads() {
#if defined(_OPENMP)
    return std::max(64, 4 * omp_get_num_procs());
#else
    return 1;
#endif
}

/// Threads as told, read whole.
/// @throws std::invalid_argument
int threads_of(const std::string& text, const std::string& name) {
    int value = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value < 0 || value > most_threads())
        fibrant::core::refuse(name, clipped(text),
                              "a whole number from 0 (as many as the machine has) to " + std::to_string(most_threads()));
    return value;
}

#if defined(_OPENMP)
/// Starts all threads now: later, where memory has run short, OpenMP would end the program without a word of ours.
/// @param name  of what asked for them
/// @throws std::invalid_argument where so many cannot be had
void take_threads(const std::string& name) {
    const int wanted = omp_get_max_threads(), more = threads_at_once(wanted - 1);
    if (more < wanted - 1)
        fibrant::core::refuse(
            name, std::to_string(wanted),
            "at most " + std::to_string(more + 1) + ", for no more threads can be had: " + memory_room().text() + " of memory");
    int started = 0;
#pragma omp parallel reduction(+ : started)
    started += 1;
    static_cast<void>(started);
}
#endif

}  // namespace

bool solve(const Program& program, SceneReader& scene, Output& output, const std::string& threads,
           const std::string& threads_name) {
    scene.read("output", "paraview", output.paraview, "write files for ParaView");
    scene.read("output", "pictures", output.pictures, "write pictures of the end");
    scene.read("output", "unit", output.unit, any_text(), "name of the unit of length, for pictures");
    scene.read("output", "deepest_over_radius", output.deepest_over_radius, above(0.0, 2.0), "1",
               "how deep fibres may be in each other at the end, anywhere, over the radius; left out: as deep as contact "
               "may be, and what its points may leave unseen");
    Index wanted = 0;
    scene.read("solver", "threads", wanted, between(0, 100000),
               "number of threads; 0: as many as the machine has; --threads goes first");
    const int count = threads.empty() ? threads_of(std::to_string(wanted), scene.file() + ": solver.threads")
                                      : threads_of(threads, threads_name);
#if defined(_OPENMP)
    if (count > 0)
        omp_set_num_threads(count);
    else
        threads_of(std::to_string(omp_get_max_threads()), threads_name + " is not given, and OMP_NUM_THREADS");
    if (!scene.describes()) take_threads(count > 0 && threads.empty() ? scene.file() + ": solver.threads" : threads_name);
#else
    static_cast<void>(count);
#endif
    try {
        return program.solve(scene, output);
    } catch (const std::filesystem::filesystem_error& error) {  // such as a folder that is not empty
        throw std::runtime_error(error.path1().string() + ": cannot be made or taken away: " + error.code().message());
    } catch (const std::invalid_argument& error) {  // of the command line: as it is
        throw std::invalid_argument(std::string_view(error.what()).substr(0, 2) == "--" ? error.what()
                                                                                        : scene.told(error.what()));
    }
}

int run(int argc, char** argv, const Program& program) {
    std::string scene, folder, threads = "0";
    std::vector<std::string> set;
    bool keys = false;
    Output output;
    CLI::App app{program.description};
    app.set_version_flag("--version", FIBRANT_VERSION);
    app.add_option("scene", scene, "scene file (TOML)");
    app.add_option("--output", folder, "folder for the results, made if need be");
    app.add_option("--set", set, "section.key=value, in the place of what the file says")->allow_extra_args(false);
    app.add_option("--threads", threads, "0: as many as the machine has");
    // A flag has no value: --quiet=3 would be taken for --quiet. A parser that is told so still takes --resume=true.
    std::vector<std::string> flags;
    const auto flag = [&](const char* name, bool& value, const char* what) {
        flags.push_back(name);
        return app.add_flag(name, value, what);
    };
    auto* overwrite = flag("--overwrite", output.overwrite, "begin anew in a folder that holds results");
    flag("--resume", output.resume, "go on from the last accepted increment in the folder")->excludes(overwrite);
    flag("--other-scene", output.other_scene, "take a checkpoint although it is of another scene");
    flag("--quiet", output.quiet, "print nothing but errors");
    flag("--help-scene", keys, "print the keys of a scene file, with their units, bounds and defaults");
    try {
        for (const std::string& name : flags)
            if (std::any_of(argv, argv + argc, [&](const std::string& given) { return given.starts_with(name + "="); }))
                throw CLI::ArgumentMismatch(name + " has a value, but it must have none");
        app.parse(argc, argv);
        if (!keys && scene.empty()) throw CLI::RequiredError("scene");
        if (!keys && app.count("--output") == 0) throw CLI::RequiredError("--output");
    } catch (const CLI::ParseError& error) {
        return ends_by(app, error, program.name);
    }
    keep_freed_memory();
    const ListeningForStops listening;
    const auto fail = [&](const std::string& message) {
        std::fprintf(stderr, "%s: %s\n", program.name, message.c_str());
        return stopped() ? 128 + stop_signal() : 2;
    };
    try {
        if (!keys) require_folder(folder);
        if (app.count("--threads") > 0) threads_of(threads, "--threads");  // also where it is empty, which says nothing
        SceneReader reader = keys ? SceneReader::of_keys() : SceneReader(scene, set);
        output.folder = folder, output.scene = scene;
        if (!output.quiet)
            reader.when_read([&] {
                std::printf("%s: %s is read, results go to %s\n", program.name, scene.c_str(), folder.c_str());
                std::fflush(stdout);
            });
        try {
            const bool sound = solve(program, reader, output, app.count("--threads") == 0 ? "" : threads, "--threads");
            if (!stopped()) return sound ? 0 : 1;
            if (!output.quiet)
                std::fprintf(stderr, "%s: stopped by signal %d: --resume goes on from the last increment\n", program.name,
                             stop_signal());
            return 128 + stop_signal();
        } catch (const Described&) {
            std::printf("Keys of a scene of %s. Values after = are taken where a key is not given.\n\n%s", program.name,
                        reader.help().c_str());
            return 0;
        }
    } catch (const std::bad_alloc&) {
        return fail(scene + ": there is not enough memory for this scene (" + memory_room().text() + ", and this process had " +
                    memory_text(static_cast<double>(peak_memory_bytes())) + ")");
    } catch (const std::length_error&) {
        return fail(scene + ": a count of this scene is larger than memory can hold (" + memory_room().text() + ")");
    } catch (const std::exception& error) {
        return fail(error.what());
    }
}

}  // namespace example
