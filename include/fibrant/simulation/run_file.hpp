// SPDX-License-Identifier: MIT
#pragma once
/// @file All of a run that goes into its checkpoint, and comes back from it.

#include <fibrant/core/stage_clock.hpp>
#include <fibrant/simulation/energy_account.hpp>
#include <fibrant/simulation/increment_file.hpp>
#include <fibrant/simulation/mean_motion.hpp>
#include <fibrant/simulation/position.hpp>
#include <fibrant/simulation/state_file.hpp>
#include <fibrant/simulation/swing.hpp>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace fibrant::simulation {

/// What a run consists of, by reference: all that was accepted last.
template <class Contacts, class Equilibrium, class Mesh, class Laws>
struct RunParts {
    Vector& state;
    std::vector<double>& amplitudes;
    EnergyAccount& energy;
    Contacts& contacts;
    Equilibrium& equilibrium;
    Position& position;
    MeanMotion& motion;
    Swing& swing;
    core::StageClock& clock;
    Mesh& mesh;
    Laws& laws;  // of sections
};
template <class Contacts, class Equilibrium, class Mesh, class Laws>
RunParts(Vector&, std::vector<double>&, EnergyAccount&, Contacts&, Equilibrium&, Position&, MeanMotion&, Swing&,
         core::StageClock&, Mesh&, Laws&) -> RunParts<Contacts, Equilibrium, Mesh, Laws>;

/// Writes all that a run goes on from to a checkpoint.
template <Model M, class Contacts, class Equilibrium, class Mesh, class Laws>
void put_run(CheckpointWriter& file, const RunParts<Contacts, Equilibrium, Mesh, Laws>& run, const Report& report) {
    const auto put = [&](const auto& value) { file.put(value); };
    put(run.state);
    run.energy.each(put);
    put_memory(file, run.contacts.accepted_memory().records(), run.contacts.accepted_zones());
    put(run.laws.numbers(run.mesh));
    for (const double amplitude : run.amplitudes) put(amplitude);
    std::as_const(run.position).each(put);
    if constexpr (HasTools<M>) run.contacts.tools().each_accepted(put);
    if constexpr (HasConnections<M>)
        run.equilibrium.ties().motion().each_accepted([&](const auto& value) { put_value(file, value); });
    if constexpr (HasSolid<M>) put_solid(file, run.equilibrium.solid());
    put(report.rejected_increments), put(report.counts), put(run.clock.seconds());
    put(core::count(report.increments));
    for (const IncrementReport& increment : report.increments) put_increment(file, increment);
    run.motion.each(put);
    run.swing.each(put);
    run.equilibrium.terms().each([&](auto& term) { term.each(put); });
}

/// The part of a checkpoint that has to do with fibres and contacts alone.
template <class Contacts, class Equilibrium, class Mesh, class Laws>
void get_fibres(CheckpointReader& file, const RunParts<Contacts, Equilibrium, Mesh, Laws>& run) {
    const Index size = run.state.size();
    run.state = get_state(file, size);
    run.energy.each([&]<class Value>(Value& value) {
        if constexpr (std::is_same_v<Value, Vector>)
            value = get_state(file, size, true);
        else
            value = file.get<Value>();
    });
    std::vector<typename Contacts::Memory::Record> records;
    std::vector<contact::Zone> zones;
    get_memory(file, records, zones, run.equilibrium.mesh().line_count());
    run.contacts.resume(std::move(records), std::move(zones));
    run.laws.take(run.mesh, get_state(file, run.laws.count(run.mesh)));
}

/// What follows.
/// @param stages  of the loading
/// @param placed  is called once amplitudes and position stand
template <Model M, class Contacts, class Equilibrium, class Mesh, class Laws, class Placed>
void get_rest(CheckpointReader& file, const RunParts<Contacts, Equilibrium, Mesh, Laws>& run, Index stages, Report& report,
              const Placed& placed) {
    const auto get = [&]<class Value>(Value& value) { value = file.get<Value>(); };
    for (double& amplitude : run.amplitudes) get(amplitude);
    run.position.each(get);
    file.require(run.position.sound(stages));
    placed();
    if constexpr (HasTools<M>) get_tools(file, run.contacts.tools());
    if constexpr (HasConnections<M>) {
        run.equilibrium.ties().motion().each_accepted([&](auto& value) { get_value(file, value); });
        run.equilibrium.ties().motion().restore();
    }
    if constexpr (HasSolid<M>) get_solid(file, run.equilibrium.solid());
    get(report.rejected_increments), get(report.counts), get(run.clock.seconds());
    report.increments.resize(core::at(file.get_count(sizeof(double))));
    for (IncrementReport& increment : report.increments) {
        get_increment(file, increment);
        report.wall_seconds += increment.seconds;
    }
    run.motion.each(get);
    const Index size = run.state.size();
    run.swing.each([&]<class Value>(Value& value) {
        if constexpr (std::is_same_v<Value, Vector>)
            value = get_state(file, size, true);
        else
            get(value);
    });
    run.equilibrium.terms().each([&](auto& term) {
        term.each([&]<class Value>(Value& value) {
            if constexpr (std::is_same_v<Value, Vector>)
                value = get_state(file, value.size());
            else
                get(value);
        });
        term.restore();
    });
    file.require_end();
}

/// Where a run goes on from. Contact elements are not kept; what is written of them at the end of a run would be missing in one
/// that resumes there. So the checkpoint before the end is kept beside the last one, and a run that has ended goes on from it,
/// to the same bits. One that had none before its end is begun again.
class ResumedFile {
public:
    /// @param path        of the checkpoint; empty: none
    /// @param before_end  keep what a run needs that is resumed at its end
    ResumedFile(const std::string& path, bool resume, bool before_end) : path_{path}, before_end_{before_end} {
        if (!resume || path.empty() || !exists(path)) return;
        if (!before_end || !exists(before()))
            from_ = path;
        else if (has_more(before(), sizeof(std::uint64_t)))  // than the sum
            from_ = before();
    }
    /// File to begin from; empty: at the start.
    const std::string& from() const noexcept { return from_; }
    /// @param put   writes the run to a CheckpointWriter
    /// @param ends  the run does, with this increment
    template <class Put>
    void write(const Put& put, bool ends) {
        if (ends && before_end_ && from_ != before()) {
            CheckpointWriter last(before());
            if (!from_.empty()) last.put_file(from_);
            last.finish();
        }
        CheckpointWriter file(path_);
        put(file);
        file.finish();
        if (ends) return;
        from_ = path_;
        if (before_end_) std::remove(before().c_str());  // last: without it a run that had ended resumes at its end
    }

private:
    std::string before() const { return path_ + ".before"; }
    /// A file that is there but may not be read is one: whoever reads it says so.
    static bool exists(const std::string& path) {
        errno = 0;
        return detail::open_to_read(path) || errno == EACCES;
    }
    /// A file has so many bytes, and one more.
    static bool has_more(const std::string& path, std::size_t bytes) {
        const detail::ReadFile file = detail::open_to_read(path);
        for (std::size_t k = 0; file && k <= bytes; ++k)
            if (std::fgetc(file.get()) == EOF) return false;
        return file != nullptr;
    }
    std::string path_, from_;
    bool before_end_;
};

}  // namespace fibrant::simulation
