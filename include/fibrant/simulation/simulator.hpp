// SPDX-License-Identifier: MIT
#pragma once
/// @file Runs a loading on a scene with a model: steps that are cut, restored and grown again.

#include <fibrant/core/stage_clock.hpp>
#include <fibrant/simulation/acceptance.hpp>
#include <fibrant/simulation/kept_depth.hpp>
#include <fibrant/simulation/limits.hpp>
#include <fibrant/simulation/run_file.hpp>
#include <fibrant/simulation/scene_checks.hpp>
#include <fibrant/simulation/section_laws.hpp>
#include <fibrant/simulation/snapshot_of.hpp>
#include <fibrant/simulation/step_control.hpp>
#include <fibrant/simulation/swing.hpp>
#include <fibrant/simulation/watching.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::simulation {

/// A scene in mechanical equilibrium, taken through a loading by quasi-static increments; with `inertia::Inertia` in motion, by
/// steps of time.
template <Model M>
class Simulator {
public:
    using Beam = typename M::Beam;
    using Mesh = beam::Mesh<Beam>;
    using Contacts = typename detail::ContactsOf<M>::Type;
    using Solid = typename detail::SolidOf<M>::Type;
    using Acts = typename detail::ActsOf<M>::Type;
    using Equilibrium = assembly::Equilibrium<Beam, Contacts, typename detail::ConnectionsOf<M>::Type, Solid, Acts>;
    using Passage = typename detail::PassageOf<M>::Type;
    using Steps = typename detail::StepsOf<M>::Type;
    static_assert(StepControl<Steps, M>);

    /// @throws std::invalid_argument naming the field that is wrong
    Simulator(const scene::Assembly& assembly, const ModelParameters<M>& parameters);
    ~Simulator();
    Simulator(const Simulator&) = delete;  // its parts look at each other
    Simulator& operator=(const Simulator&) = delete;

    /// Takes the scene through a loading. Each observer is shown a snapshot of every accepted increment; one that has a
    /// member `reported(const IncrementReport&)` is also given its figures, and one with `gave_up(const FailedAttempt&)` those of
    /// attempts that came to nothing.
    template <Watching... Observers>
    Report run(const Loading<M>& loading, Observers&... observers) {
        const std::array<Watcher, sizeof...(Observers)> watchers{Watcher(observers)...};
        return run_watched(loading, watchers);
    }
    Report run_watched(const Loading<M>& loading, std::span<const Watcher> watchers);

    /// Starts from what a run of another scene of the same fibres left in a checkpoint, with what contacts remember. What is
    /// held, tied and applied is of this scene: averages and periodic pairs count from there.
    /// @throws std::runtime_error if the file cannot be read or has other fibres
    void start_from(const std::string& checkpoint);

    const ModelParameters<M>& parameters() const noexcept { return parameters_; }
    const Beam& beam() const noexcept { return beam_; }
    const Mesh& mesh() const noexcept { return mesh_; }
    const Vector& state() const noexcept { return state_; }
    const Contacts& contacts() const noexcept { return contacts_; }
    Contacts& contacts() noexcept { return contacts_; }
    const Equilibrium& equilibrium() const noexcept { return equilibrium_; }
    const typename M::Solver& linear_solver() const noexcept { return linear_; }
    double amplitude(const std::string& channel) const { return amplitudes_[core::at(channels_.find(channel))]; }
    /// Force of the support on a held nodal vector, in its held directions [force].
    Vec3 reaction(const scene::Station& at, scene::NodeVector vector = scene::NodeVector::position) const {
        return equilibrium_.reaction().size() > 0 ? Vec3(equilibrium_.reaction().template segment<3>(first_of(at, vector)))
                                                  : Vec3(Vec3::Zero());
    }
    /// Of a nodal vector now.
    Vec3 value(const scene::Station& at, scene::NodeVector vector = scene::NodeVector::position) const {
        return state_.segment<3>(first_of(at, vector));
    }

    /// The present state as plain data.
    observe::Snapshot snapshot() const;

    /// Takes over what contacts and laws remember from a run of these fibres, whose state the assembly begins at.
    /// @throws std::invalid_argument if the fibres are not where that run left them
    template <Model Other>
    void go_on_from(const Simulator<Other>& other) {
        const Vector& before = other.state();
        if (before.size() > state_.size() || before != state_.head(before.size()))
            core::refuse("Simulator.state", "another", "that of the run to go on from: use Assembly::begin_at");
        contacts_.resume(other.contacts().accepted_memory().records(), other.contacts().accepted_zones());
        laws_.go_on_from(mesh_, other.mesh());
        energy_.start(equilibrium_, state_, other.contacts(), before);
    }

private:
    Index first_of(const scene::Station& at, scene::NodeVector vector) const {
        return 3 * mesh_.node_vector(at.fibre, mesh_.node_at(at), static_cast<Index>(vector));
    }
    void move_tools([[maybe_unused]] const std::vector<double>& amplitudes) {
        if constexpr (HasTools<M>) {
            std::vector<double> own;
            for (const Index channel : tool_channels_) own.push_back(amplitudes[core::at(channel)]);
            contacts_.tools().move(own);
        }
    }

    void take_laws(const Stage<M>& stage) {
        if (stage.normal) contacts_.normal_law() = *stage.normal;
        if (stage.friction) contacts_.friction_law() = *stage.friction;
    }

    /// One accepted increment, after the cuts it takes; gave_up(attempt) hears of it.
    template <class GaveUp>
    bool advance(const Loading<M>& loading, const std::vector<Stage<M>>& stages, const Stage<M>& stage, Report& report,
                 const GaveUp& gave_up) {
        const auto start = core::wall_seconds();
        IncrementReport increment;
        double effort = 0.0;  // iterations a normal pass of it, over how many it may take
        bool rehearsed = false;
        Index astray = 0;  // attempts that have not settled
        const std::string present = "stage " + stage.name + ", increment " + std::to_string(position_.accepted + 1) + ": ";
        const bool touching = mesh_.line_count() > 1 || parameters_.contact.detection.self_contact || !tool_channels_.empty();
        while (true) {
            if (position_.gives_up(stage, report)) {
                report.reason = position_.not_ended(stage, report) + (deep_.empty() ? deepest_unparted(stage, *this) : deep_);
                return false;
            }
            const double progress = laws_.again() ? position_.progress : position_.next(stage);
            const double stride = position_.stride();
            set_limits(contacts_, stage, position_, parameters_.contact.stiffness.allowed_penetration);
            const std::vector<double> amplitudes = amplitudes_at(stage, progress, position_, channels_, amplitudes_),
                                      change = difference(amplitudes, amplitudes_);
            if (const std::string reason = turned_too_far(mesh_, equilibrium_, amplitudes_, amplitudes); !reason.empty()) {
                ++increment.cuts, position_.fraction *= 0.5, position_.easy = 0;
                gave_up(FailedAttempt{position_.accepted + 1, stage.name, increment.cuts, 2.0 * position_.fraction,
                                      position_.damping, 0, reason, core::seconds_since(start)});
                if (position_.fraction >= loading.smallest_fraction) continue;
                report.reason = present + reason;
                return false;
            }
            const bool loose = position_.iterates(stage);
            Vector trial = swing_.begin(equilibrium_, state_, loose, increment.cuts);
            move_tools(amplitudes);
            const beam::Drive drive =
                let_last(contacts_, equilibrium_, stage.duration * (progress - position_.progress), position_.step(stage));
            laws_.drive(mesh_, amplitudes, drive);
            equilibrium_.begin(amplitudes, state_, position_.damping * stage.damping / stride + position_.calming.springs,
                               position_.held_by_fibre(loading.damping_of_fibres));
            if (stage.damping_carried) equilibrium_.carry(motion_.ahead(mesh_, state_, change));
            const solver::IterationParameters iteration = parameters_.iteration.of_attempt(stage.patience, astray);
            solver::NestedLoops<Equilibrium, Contacts, typename M::Solver, Passage> loops(
                equilibrium_, contacts_, linear_, passage_, iteration, radius_, touching, clock_);
            // A limited gap moves fibres by about it: so far to look.
            const double shown = stage.forced_orders ? stride * stage.gap_limit.value_or(0.0) : 0.0;
            const double ahead = std::max(position_.displacement, shown);
            const auto solve = [&] {
                solver::AttemptReport solved = loops.solve(trial, state_, ahead, stage.forced_orders, position_.looseness(stage),
                                                           stride * stage.largest_displacement);
                if (solved.converged)
                    solved.refuse(clock_.time(core::Part::search, [&] {
                        return refusal(mesh_, beam_, passage_, contacts_, state_, trial, stage.forced_orders, touching);
                    }));
                return solved;
            };
            const double deepest = touching ? deepest_in_increment(loading, stage, position_, contacts_, radius_) : core::unset;
            solver::AttemptReport attempt = solve_kept(mesh_, contacts_, trial, deepest, radius_, clock_, solve);
            increment.counts += attempt.counts;
            const Index most = std::max<Index>(1, attempt.counts.normal_passes) * iteration.newton_limit;
            effort = static_cast<double>(attempt.counts.newton) / static_cast<double>(most);
            if (attempt.converged) attempt.refuse(laws_.refusal(mesh_, beam_, trial));
            // What nothing foretells is held back.
            if (attempt.converged && stage.damping_carried && stage.damping > 0.0 && !rehearsed && !motion_.foretells(change)) {
                motion_.learn(mesh_, state_, trial, change);
                contacts_.restore(), equilibrium_.restore(), rehearsed = true;
                continue;
            }
            if (attempt.converged)
                attempt.refuse(energy_.book(
                    equilibrium_, contacts_, {amplitudes_, amplitudes}, state_, trial, stage.forced_orders || laws_.again(),
                    [&](EnergyAccount& energy) { laws_.book(mesh_, beam_, trial, energy); }, drive.duration / stage.duration,
                    1.0 - progress));
            if (attempt.converged) {
                laws_.accept(mesh_, beam_, trial, energy_);
                increment.energy = energy_.template closed<Equilibrium::moves>();
                if (stage.damping_carried) motion_.learn(mesh_, state_, trial, change);
                swing_.learn(equilibrium_, state_, trial, loose);
                state_ = trial;
                equilibrium_.ties().accept();
                energy_.rewind(mesh_, state_, equilibrium_.reaction());
                amplitudes_ = amplitudes;
                increment.residual = attempt.residual, increment.use = attempt.use;
                increment.displacement = attempt.displacement;
                increment.damping = attempt.acts(radius_) ? equilibrium_.norm(energy_.damping()) / attempt.force_scale : 0.0;
                increment.fraction = position_.fraction, increment.unstable = attempt.counts.indefinite > 0;
                increment.springs = position_.damping, increment.hardest_springs = position_.hardest();
                position_.progress = progress;
                break;
            }
            ++report.rejected_increments, ++increment.cuts, astray += attempt.astray ? 1 : 0;
            gave_up(FailedAttempt{position_.accepted + 1, stage.name, increment.cuts, position_.fraction, position_.damping,
                                  attempt.counts.newton, attempt.reason, core::seconds_since(start)});
            const bool again = touching && !stage.forced_orders && !position_.calming.resting &&
                               position_.try_other_places(mesh_, state_, contacts_, attempt.astray && astray == 1);
            contacts_.restore(), equilibrium_.restore();
            if (again) continue;
            if (loading.calmed && report.rejected_increments <= loading.most_rejected && stage.damping == 0.0 &&
                !stage.forced_orders && position_.calming.harder(position_.fraction, Calming::softest(mesh_))) {
                contacts_.places().follow(position_.following = parameters_.contact.places == contact::Places::as_needed);
                continue;
            }
            steps_.give_way(position_, stage, equilibrium_.greatest_by_fibre(attempt.unsettled), attempt.allowed, increment.cuts);
            if (position_.fraction < loading.smallest_fraction || report.rejected_increments > loading.most_rejected) {
                report.counts += increment.counts;
                report.reason = present + attempt.reason;
                return false;
            }
        }
        increment.contact = contacts_.figures(state_);
        position_.displacement = increment.displacement;
        if (!position_.calming.active())
            position_.calming.none_taken();
        else
            position_.calming.soften_after(increment.unstable, increment.displacement / radius_, Calming::softest(mesh_));
        ++position_.accepted, position_.in_stage += position_.calming.resting ? 0 : 1;
        if (may_grow(equilibrium_, loading.growth)) steps_.grow(position_, stage, increment, loading.growth, effort);
        position_.tell(stage, increment);
        increment.progress = part_done(stages, position_.stage, position_.progress);
        // At rest: what holds takes no more force than the balance may miss anyway.
        const bool reached = position_.progress >= 1.0 && !position_.calming.resting && (!stage.until || stage.until(increment));
        const bool held = stage.held(increment);
        deep_ = touching && reached && !held && !laws_.again()
                    ? mend_deep_places(loading, stages, *this, contacts_, radius_, position_)
                    : std::string();
        const bool ends = position_.ends(stage, reached && !held && deep_.empty(), increment);
        position_.stage_over = !laws_.again() && (ends || position_.enough(stage, report));
        increment.waits = increment.stage_progress >= 1.0 && !position_.stage_over;
        steps_.adapt_damping(position_, stage, increment, effort);
        contacts_.accept(state_), equilibrium_.accept(state_);
        if constexpr (HasSolid<M>)
            if (equilibrium_.solid().accept(state_) > 0)
                energy_.release(equilibrium_.elastic_energy(state_));  // bonds that had too much
        increment.seconds = core::seconds_since(start);
        report.counts += increment.counts;
        report.increments.push_back(increment);
        return true;
    }

    void show(const Watcher& watcher, const IncrementReport& increment) {
        if (watcher.reported) watcher.reported(watcher.observer, increment);
        if (!watcher.accepted || (watcher.due && !watcher.due(watcher.observer, increment.number))) return;
        observe::Snapshot shot = snapshot();
        shot.increment = increment.number, shot.stage = increment.stage, shot.progress = increment.progress;
        watcher.accepted(watcher.observer, shot);
    }

    void finish(Report& report, double start) {
        report.sum_up();
        report.energy = energy_.balance();
        if constexpr (requires {
                          { linear_.account() } -> std::convertible_to<std::string>;
                      })
            report.solver = linear_.account();
        report.seconds = clock_.seconds();
        report.wall_seconds += core::seconds_since(start);
    }

    /// What a checkpoint holds.
    auto parts() noexcept {
        return RunParts{state_, amplitudes_, energy_, contacts_, equilibrium_, position_, motion_, swing_, clock_, mesh_, laws_};
    }
    auto checkpoint(const Loading<M>& loading, const std::vector<Stage<M>>& stages, const Report& report) {
        return [&](CheckpointWriter& file) {
            put_identity<M>(file, mesh_, channels_, stages, loading.scene);
            put_run<M>(file, parts(), report);
        };
    }
    void resume(const std::string& from, const Loading<M>& loading, const std::vector<Stage<M>>& stages, Report& report) {
        CheckpointReader file(from);
        expect_identity<M>(file, mesh_, channels_, stages, loading);
        get_fibres(file, parts());
        get_rest<M>(file, parts(), core::count(stages), report, [&] {
            contacts_.places().follow(position_.following);
            move_tools(amplitudes_);
        });
    }

    ModelParameters<M> parameters_;
    Beam beam_;
    Mesh mesh_;
    connection::Channels channels_;
    Contacts contacts_;
    Equilibrium equilibrium_;
    [[no_unique_address]] Passage passage_;
    typename M::Solver linear_;
    [[no_unique_address]] SectionLaws<Beam> laws_;
    Vector state_;
    std::vector<double> amplitudes_;
    double radius_ = 0.0;
    std::string deep_;           ///< what is too deep, in words
    std::optional<Vec3> loose_;  ///< what nothing holds the scene along
    std::vector<Index> tool_channels_;
    Position position_;
    [[no_unique_address]] Steps steps_;
    MeanMotion motion_;
    Swing swing_;
    EnergyAccount energy_;
    core::StageClock clock_;
};

// What a program calls stands outside of the class: `extern template class` then leaves all below it to the file that has
// `template class`.

template <Model M>
Simulator<M>::Simulator(const scene::Assembly& assembly, const ModelParameters<M>& parameters)
    : parameters_{checked(parameters)},
      beam_{parameters.beam},
      mesh_{assembly, beam_},
      channels_{assembly, term::channels_of<Beam>(Acts(), parameters.acts)},
      contacts_{assembly,
                mesh_,
                parameters.contact,
                typename M::Proximity(parameters.proximity),
                typename M::Normal(parameters.normal),
                typename M::Friction(parameters.friction)},
      equilibrium_{assembly, mesh_, beam_, contacts_, channels_, Solid(parameters.solid), parameters.acts},
      passage_{mesh_, parameters.contact.detection},
      linear_{parameters.solver},
      laws_{assembly, mesh_, beam_, channels_},
      state_{mesh_.start_state()},
      amplitudes_(channels_.names().size(), 0.0) {
    require_parts<M>(assembly);
    if constexpr (HasTools<M>) {
        for (const scene::Tool& tool : assembly.tools()) tool_channels_.push_back(channels_.find(tool.channel));
        move_tools(amplitudes_);
    }
    if constexpr (HasSolid<M>) state_ = equilibrium_.solid().with_rest(state_);
    require_agreement(equilibrium_.motion(), mesh_, channels_);
    contact::require_in_bores(mesh_);
    if constexpr (!Equilibrium::moves) loose_ = loose_direction(assembly, mesh_);
    radius_ = mesh_.fibre(0).section.radius();
    for (const beam::MeshFibre& fibre : mesh_.fibres()) radius_ = std::min(radius_, fibre.section.radius());
    if (Equilibrium::moves || mesh_.start_state() != mesh_.rest_state()) energy_.start(equilibrium_, state_);
}

template <Model M>
Simulator<M>::~Simulator() = default;

template <Model M>
Report Simulator<M>::run_watched(const Loading<M>& loading, std::span<const Watcher> watchers) {
    loading.validate();
    const auto start = core::wall_seconds();
    const std::vector<Stage<M>> stages = stages_of(loading, channels_);
    check_ramps(stages, channels_, amplitudes_);
    if (const Index given = core::count(loading.damping_of_fibres); given > 0 && given != mesh_.fibre_count())
        core::refuse("Loading.damping_of_fibres", std::to_string(given) + " numbers",
                     "one for each of " + std::to_string(mesh_.fibre_count()) + " fibres");
    if (laws_.begin(stages, mesh_, beam_, state_)) energy_.start_from_other(equilibrium_, state_);
    require_paths(stages, equilibrium_.motion(), mesh_, channels_, amplitudes_);
    Report report;
    report.reason = unheld(stages, loose_);
    if (!report.reason.empty()) return report;
    position_ = {};
    position_.from = amplitudes_;
    position_.holding.assign(core::at(mesh_.fibre_count()), 1.0);
    contacts_.places().follow(position_.following);
    motion_ = MeanMotion(mesh_, amplitudes_.size()), swing_ = {};
    ResumedFile kept(loading.checkpoint, loading.resume, loading.resume_before_end);
    if (!kept.from().empty()) resume(kept.from(), loading, stages, report);
    const StartOverlap begun(*this, stages.front(), position_.accepted == 0);
    if (begun.too_deep) {
        report.reason = begun.said;
        return report;
    }
    auto saved = start;
    bool unsaved = false;
    for (Index k = 0; k < position_.stage; ++k) take_laws(stages[core::at(k)]);  // which stay
    for (; position_.stage < core::count(stages); position_.next_stage(stages, amplitudes_)) {
        const Stage<M>& stage = stages[core::at(position_.stage)];
        take_laws(stage);  // of one left out, too: a run that is resumed has them
        if (position_.needless(stage, report)) continue;
        while (!position_.stage_over) {
            contacts_.places().follow(position_.following);
            const auto gave_up = [&](const FailedAttempt& attempt) {
                for (const Watcher& watcher : watchers)
                    if (watcher.gave_up) watcher.gave_up(watcher.observer, attempt);
            };
            if (!advance(loading, stages, stage, report, gave_up)) {
                if (position_.accepted == 0) report.reason += begun.remark();
                if (unsaved) kept.write(checkpoint(loading, stages, report), false);
                finish(report, start);
                return report;
            }
            // Observers first: what a checkpoint holds has been shown, and what is shown twice is told by number.
            clock_.time(core::Part::output, [&] {
                for (const Watcher& watcher : watchers) show(watcher, report.increments.back());
                const auto now = core::wall_seconds();
                unsaved = !loading.checkpoint.empty();
                if (!unsaved || (!position_.stage_over && now - saved < loading.checkpoint_seconds)) return;
                const bool end = position_.stage_over && position_.stage + 1 == core::count(stages);
                kept.write(checkpoint(loading, stages, report), end);
                saved = now, unsaved = false;
            });
            if (loading.stop && loading.stop()) {
                if (unsaved) kept.write(checkpoint(loading, stages, report), false);
                report.reason = "stopped as asked, after increment " + std::to_string(position_.accepted);
                finish(report, start);
                return report;
            }
        }
    }
    report.converged = true;
    finish(report, start);
    return report;
}

template <Model M>
void Simulator<M>::start_from(const std::string& checkpoint) {
    CheckpointReader file = read_from_state(checkpoint, mesh_);
    get_fibres(file, parts());
    if constexpr (HasConnections<M>) equilibrium_.ties().anchor(state_);
    energy_.start_from_other(equilibrium_, state_);
}

template <Model M>
observe::Snapshot Simulator<M>::snapshot() const {
    observe::Snapshot shot = snapshot_of(mesh_, contacts_, state_);
    if constexpr (HasTools<M>) add_tools(shot, mesh_, contacts_.tools(), state_);
    if constexpr (HasSolid<M>) add_solid(shot, equilibrium_.solid(), state_);
    equilibrium_.terms().each([&](const auto& term) { term.show(state_, shot); });
    return shot;
}

}  // namespace fibrant::simulation
