// SPDX-License-Identifier: MIT
// An interrupted run goes on to the same bits; files that are damaged or belong to another scene are refused.
#include "simulation/scenes.hpp"

#include <fibrant/law/limited_gap.hpp>

#include <doctest/doctest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

using namespace fibrant;

namespace checkpoint_test {

using simulation::Loading;
using simulation::Report;
using simulation::Simulator;
using simulation::Stage;
using test::Crossing;
using test::Record;
using test::Rod;
using test::Rough;
using test::same_bits;
using test::Smooth;

/// A file in the system's folder for temporary files, removed at the end.
struct TemporaryFile {
    std::filesystem::path path;
    explicit TemporaryFile(const std::string& name)
        : path{std::filesystem::temp_directory_path() / ("fibrant_checkpoint_test_" + name)} {
        std::filesystem::remove(path);
    }
    ~TemporaryFile() {
        std::error_code ignored;
        std::filesystem::remove(path, ignored);
    }
    std::string name() const { return path.string(); }
    std::string bytes() const {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    void write(const std::string& bytes) const { std::ofstream(path, std::ios::binary) << bytes; }
};

struct Interruption {};
/// Interrupts a run after a number of accepted increments.
struct Interrupter {
    Index after;
    void reported(const simulation::IncrementReport& increment) const {
        if (increment.number == after) throw Interruption{};
    }
};

/// Message of what reading throws.
template <class Work>
std::string failure(const Work& work) {
    try {
        work();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return {};
}

/// Runs a loading at once, and again interrupted after each increment in turn: states and reports must agree.
template <simulation::Model M>
void check_resumes(const scene::Assembly& assembly, const simulation::ModelParameters<M>& parameters, Loading<M> loading) {
    Simulator<M> whole(assembly, parameters);
    Record<M> record(whole);
    const Report report = whole.run(loading, record);
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    for (Index after = 1; after <= core::count(report.increments); ++after) {
        CAPTURE(after);
        const TemporaryFile file("resume");
        loading.checkpoint = file.name();
        {
            Simulator<M> first(assembly, parameters);
            Interrupter stop{after};
            loading.resume = false;
            CHECK_THROWS_AS(first.run(loading, stop), Interruption);
        }
        Simulator<M> second(assembly, parameters);
        Record<M> rest(second);
        loading.resume = true;
        const Report resumed = second.run(loading, rest);
        REQUIRE(resumed.converged);
        CHECK(same_bits(second.state(), whole.state()));
        // Observers come before the file: the increment that was interrupted is computed again.
        REQUIRE(core::count(rest.states) == core::count(report.increments) - after + 1);
        for (std::size_t k = 0; k < rest.states.size(); ++k)
            CHECK(same_bits(rest.states[k], record.states[core::at(after - 1) + k]));
        REQUIRE(resumed.increments.size() == report.increments.size());
        CHECK(resumed.counts.newton == report.counts.newton);
        CHECK(resumed.rejected_increments == report.rejected_increments);
        CHECK(resumed.energy.external == report.energy.external);
        CHECK(resumed.energy.elastic == report.energy.elastic);
        CHECK(resumed.energy.dissipated == report.energy.dissipated);
        CHECK(resumed.contact.greatest_penetration == report.contact.greatest_penetration);
        for (std::size_t k = 0; k < report.increments.size(); ++k) {
            CHECK(resumed.increments[k].stage == report.increments[k].stage);
            CHECK(resumed.increments[k].progress == report.increments[k].progress);
            CHECK(resumed.increments[k].displacement == report.increments[k].displacement);
        }
    }
}

TEST_CASE("an interrupted bending of one fibre resumes to the same bits, through cuts") {
    const Rod rod;
    simulation::ModelParameters<Smooth> parameters = test::model_parameters<Smooth>(rod.radius);
    parameters.iteration.newton_limit = 6;  // too few for the first steps: some are cut
    check_resumes<Smooth>(rod.pushed(20.0), parameters, {.increments = 4});
}

TEST_CASE("an interrupted contact with friction resumes to the same bits") {
    Crossing crossing;
    crossing.approach = 0.8 * crossing.radius;
    crossing.drag = 0.2 * crossing.radius;
    Loading<Rough> loading;
    loading.stages = {{.name = "press", .increments = 3, .ramps = {{"approach", 1.0}}},
                      {.name = "drag", .increments = 3, .ramps = {{"drag", 1.0}}, .damping = 1e-3, .damping_carried = true}};
    check_resumes<Rough>(crossing.assembly(), test::model_parameters<Rough>(crossing.radius), loading);
}

TEST_CASE("an interrupted run in which one fibre is held harder than the others resumes to the same bits") {
    const Rod rod;
    const double stiffness = rod.tip_stiffness();
    Loading<Smooth> loading;
    loading.stages = {
        {.increments = 4, .ramps = {{"load", 1.0}}, .damping = 1e-3 * stiffness, .largest_displacement = 0.02 * rod.length}};
    check_resumes<Smooth>(rod.row(0.1, 10.0), test::model_parameters<Smooth>(rod.radius), loading);
}

TEST_CASE("laws that an earlier stage has set are in force after a run is resumed") {
    Crossing crossing;
    crossing.approach = 0.8 * crossing.radius;
    crossing.drag = 0.2 * crossing.radius;
    simulation::ModelParameters<Rough> parameters = test::model_parameters<Rough>(crossing.radius);
    parameters.friction.friction_coefficient = 0.0;
    Loading<Rough> loading;
    loading.stages = {{.name = "press", .increments = 2, .ramps = {{"approach", 1.0}}},
                      {.name = "handover",
                       .increments = 1,
                       .normal = law::RegularisedPenalty({.regularisation_depth = 2e-3 * crossing.radius}),
                       .friction = law::RegularisedCoulomb({0.3, 0.02 * crossing.radius})},
                      {.name = "drag", .increments = 3, .ramps = {{"drag", 1.0}}}};
    check_resumes<Rough>(crossing.assembly(), parameters, loading);
}

TEST_CASE("a finished run that is resumed has nothing left to do") {
    const Rod rod;
    const TemporaryFile file("finished");
    Loading<Smooth> loading{.increments = 2, .checkpoint = file.name(), .resume = true};  // no file yet: starts anew
    Simulator<Smooth> first(rod.pushed(1.0), test::model_parameters<Smooth>(rod.radius));
    const Report report = first.run(loading);
    REQUIRE(report.converged);
    Simulator<Smooth> second(rod.pushed(1.0), test::model_parameters<Smooth>(rod.radius));
    Record<Smooth> record(second);
    const Report resumed = second.run(loading, record);
    CHECK(resumed.converged);
    CHECK(record.states.empty());
    CHECK(resumed.increments.size() == 2);
    CHECK(resumed.residual == report.residual);
    CHECK(same_bits(first.state(), second.state()));
}

TEST_CASE("a damaged checkpoint is refused, wherever the damage is") {
    const Rod rod;
    const TemporaryFile file("damaged");
    Loading<Smooth> loading{.increments = 1, .checkpoint = file.name()};
    Simulator<Smooth>(rod.pushed(1.0), test::model_parameters<Smooth>(rod.radius)).run(loading);
    loading.resume = true;
    const std::string whole = file.bytes();
    REQUIRE(whole.size() > 1000);
    const auto refused = [&](const std::string& bytes) {
        file.write(bytes);
        return failure([&] { Simulator<Smooth>(rod.pushed(1.0), test::model_parameters<Smooth>(rod.radius)).run(loading); });
    };
    const std::string expected = "checkpoint " + file.name() + " is damaged";
    for (const std::size_t place : {std::size_t{0}, std::size_t{9}, whole.size() / 2, whole.size() - 1}) {
        std::string bytes = whole;
        bytes[place] = static_cast<char>(bytes[place] ^ 4);
        CHECK(refused(bytes) == expected);
    }
    CHECK(refused(whole.substr(0, whole.size() / 2)) == expected);
    CHECK(refused(whole.substr(0, 3)) == expected);
    CHECK(refused("") == expected);
    CHECK(refused(whole + "x") == expected);
    CHECK(refused(whole).empty());
}

TEST_CASE("a checkpoint of another scene is refused, and says what differs") {
    const TemporaryFile file("foreign");
    const Rod rod;
    Loading<Smooth> loading{.increments = 1, .checkpoint = file.name()};
    Simulator<Smooth>(rod.pushed(1.0), test::model_parameters<Smooth>(rod.radius)).run(loading);
    loading.resume = true;
    const auto refused = [&](const scene::Assembly& assembly) {
        return failure([&] { Simulator<Smooth>(assembly, test::model_parameters<Smooth>(rod.radius)).run(loading); });
    };
    Rod finer = rod;
    finer.elements = 17;
    CHECK(refused(finer.pushed(1.0)) ==
          "checkpoint " + file.name() + " belongs to another scene: the set of fibres and channels differs");
    // As many unknowns, but other fibres, other channels, another loading.
    Rod longer = rod;
    longer.length *= 2.0;
    CHECK(refused(longer.pushed(1.0)).starts_with("checkpoint " + file.name() + " belongs to another scene: "));
    scene::Assembly other = rod.pushed(1.0);
    other.apply(scene::DeadForce{scene::last_end(0), {}, Vec3::UnitY(), "more"});
    CHECK(refused(other).starts_with("checkpoint " + file.name() + " belongs to another scene: "));
    loading.stages = {{.ramps = {{"load", 1.0}}}, {.ramps = {{"load", 2.0}}}};
    CHECK(refused(rod.pushed(1.0)).starts_with("checkpoint " + file.name() + " belongs to another scene: "));
}

TEST_CASE("a checkpoint that cannot be written ends the run with a message, and leaves no part of a file") {
    const Rod rod;
    Loading<Smooth> loading{.increments = 1, .checkpoint = "no/such/folder/checkpoint"};
    Simulator<Smooth> simulator(rod.pushed(1.0), test::model_parameters<Smooth>(rod.radius));
    CHECK(failure([&] { simulator.run(loading); }) ==
          "cannot write checkpoint no/such/folder/checkpoint: No such file or directory");
}

TEST_CASE("a disk that is full ends the run with a message, and the file before stays") {
    if (!std::filesystem::exists("/dev/full")) return;
    const TemporaryFile file("full"), part("full.part");
    const auto write = [&] {
        simulation::CheckpointWriter one(file.path);
        one.put(1.0);
        one.finish();
    };
    write();
    const std::string before = file.bytes();
    std::filesystem::create_symlink("/dev/full", part.path);
    CHECK(failure(write) == "cannot write checkpoint " + file.name() + ": No space left on device");
    CHECK(file.bytes() == before);
}

TEST_CASE("a checkpoint says what it is of, and goes on as another scene only where that is asked for") {
    const Rod rod;
    const TemporaryFile file("of");
    Loading<Smooth> loading{
        .increments = 1, .checkpoint = file.name(), .scene = "law.friction = 0.1\nlaw.depth = 2\nonly.there = 1\n"};
    const auto failed = [&] {
        return failure([&] { Simulator<Smooth>(rod.pushed(1.0), test::model_parameters<Smooth>(rod.radius)).run(loading); });
    };
    CHECK(failed().empty());
    CHECK(simulation::checkpoint_scene(file.name()) == loading.scene);
    loading.resume = true;
    CHECK(failed().empty());
    loading.scene = "law.friction = 0.2\nlaw.depth = 2\nonly.here = 1\n";
    CHECK(failed() == "checkpoint " + file.name() + " belongs to another scene: law.friction (0.1 there and 0.2 here) differs");
    loading.other_scene = true;
    CHECK(failed().empty());
    loading.other_scene = false, loading.scene.clear();  // says nothing
    CHECK(failed().empty());
    CHECK(simulation::scene_difference("a.b = 1\nc.d = 2\n", "a.b = 3\nc.d = 4\n", {"c"}) == "c.d (2 there and 4 here)");
}

TEST_CASE("a run that is stopped leaves a checkpoint, and the rest of it ends at the same bits") {
    const Rod rod;
    const TemporaryFile file("stopped");
    Loading<Smooth> loading{.increments = 4, .checkpoint = file.name(), .checkpoint_seconds = 1e9};
    Simulator<Smooth> whole(rod.pushed(1.0), test::model_parameters<Smooth>(rod.radius));
    REQUIRE(whole.run(loading).converged);
    std::filesystem::remove(file.path);
    Index asked = 0;
    loading.stop = [&] { return ++asked == 2; };
    Simulator<Smooth> first(rod.pushed(1.0), test::model_parameters<Smooth>(rod.radius));
    const Report report = first.run(loading);
    CHECK(!report.converged);
    CHECK(report.reason == "stopped as asked, after increment 2");
    CHECK(report.increments.size() == 2);
    loading.resume = true, loading.stop = {};
    Simulator<Smooth> second(rod.pushed(1.0), test::model_parameters<Smooth>(rod.radius));
    CHECK(second.run(loading).converged);
    CHECK(same_bits(second.state(), whole.state()));
}

/// The same bytes with a sum that is right.
std::string signed_again(std::string bytes) {
    const std::uint64_t sum = simulation::CheckpointWriter::hash(bytes.data(), bytes.size() - sizeof sum);
    std::memcpy(bytes.data() + bytes.size() - sizeof sum, &sum, sizeof sum);
    return bytes;
}

TEST_CASE(
    "a checkpoint that was made up, with a right sum, is refused or run, and ends neither in a crash nor in a leap of memory") {
    Crossing crossing;
    crossing.approach = 0.8 * crossing.radius;
    const TemporaryFile file("crafted");
    Loading<Rough> loading;
    loading.stages = {{.name = "press", .increments = 3, .ramps = {{"approach", 1.0}}}};
    loading.checkpoint = file.name();
    Index asked = 0;
    loading.stop = [&] { return ++asked == 2; };  // so that what is read is computed with
    Simulator<Rough>(crossing.assembly(), test::model_parameters<Rough>(crossing.radius)).run(loading);
    loading.resume = true, loading.stop = {};
    const std::string whole = file.bytes();
    const auto resumed = [&](const std::string& bytes) {
        file.write(signed_again(bytes));
        return failure([&] {
            try {
                Simulator<Rough>(crossing.assembly(), test::model_parameters<Rough>(crossing.radius)).run(loading);
            } catch (const std::invalid_argument&) {
            }
        });
    };
    CHECK(resumed(whole).empty());
    const std::string damaged = "checkpoint " + file.name() + " is damaged";
    CHECK(resumed(whole + std::string(8, 'x')) == damaged);
    CHECK(resumed(whole.substr(0, whole.size() / 2)) == damaged);
    // Sizes and numbers all over the file are made absurd, one at a time. What is refused says so; what is not may take any way
    // but a wild one.
    Index refused = 0;
    for (std::size_t place = 0; place + 16 <= whole.size(); place += 149)  // numbers lie at any place
        for (const std::uint64_t absurd : {~std::uint64_t{0}, std::uint64_t{1} << 61, std::uint64_t{0x7ff8000000000000}}) {
            std::string bytes = whole;
            std::memcpy(bytes.data() + place, &absurd, sizeof absurd);
            const std::string message = resumed(bytes);
            CHECK((message.empty() || message.starts_with("checkpoint " + file.name())));
            refused += message.empty() ? 0 : 1;
        }
    CHECK(refused > 10);
}

TEST_CASE("a new file takes the place of the old one only when it is whole") {
    const TemporaryFile file("replaced");
    {
        simulation::CheckpointWriter one(file.path);
        one.put(1.0), one.put(std::string("a"));
        one.finish();
        simulation::CheckpointWriter two(file.path);
        two.put(2.0), two.put(std::string("bc"));
        CHECK(simulation::CheckpointReader(file.path).get<double>() == 1.0);
        two.finish();
        simulation::CheckpointWriter three(file.path);
        three.put(3.0);
    }
    CHECK(!std::filesystem::exists(file.name() + ".part"));
    simulation::CheckpointReader reader(file.path);
    CHECK(reader.get<double>() == 2.0);
    CHECK(reader.get_text() == "bc");
    CHECK(failure([&] { reader.get<int>(); }) == "checkpoint " + file.name() + " is damaged");
}

}  // namespace checkpoint_test
