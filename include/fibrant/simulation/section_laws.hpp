// SPDX-License-Identifier: MIT
#pragma once
/// @file What a run does for laws of sections that remember: it drives them, lets them accept, breaks them, and keeps what they
/// remember.

#include <fibrant/beam/element_memory.hpp>
#include <fibrant/beam/mesh.hpp>
#include <fibrant/connection/channels.hpp>
#include <fibrant/law/friction_law.hpp>
#include <fibrant/law/normal_law.hpp>
#include <fibrant/simulation/energy_account.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace fibrant::simulation {

/// Tells inertia and laws of contact that have a rate how long an increment lasts; in one that takes no time what flows is at
/// rest. Where fibres move none takes no time: what follows the ramps of a stage goes on in steps of it. @returns what laws of
/// sections are told of it
/// @param step  part of the stage that the increment is made for, if that is not over
template <class Contacts, class Equilibrium>
beam::Drive let_last([[maybe_unused]] Contacts& contacts, [[maybe_unused]] Equilibrium& equilibrium, double duration,
                     [[maybe_unused]] double step) {
    double share = 1.0;
    if constexpr (Equilibrium::moves) {
        if (!(duration > 0.0)) duration = step;
        equilibrium.terms().moving([&](auto& term) { term.last(duration), share = term.share(); });
    }
    if constexpr (law::SteppedNormal<std::decay_t<decltype(contacts.normal_law())>>) contacts.normal_law().last(duration, share);
    if constexpr (law::FrictionWithRate<std::decay_t<decltype(contacts.friction_law())>>)
        contacts.friction_law().last(duration > 0.0 ? duration : std::numeric_limits<double>::infinity());
    return {duration, 0.0, share};
}

/// Whether the next step of time may be longer than the last one, by a factor; without inertia any may.
template <class Equilibrium>
bool may_grow(const Equilibrium& equilibrium, double factor) {
    bool all = true;
    equilibrium.terms().moving([&](const auto& term) { all = all && term.may_grow(factor); });
    return all;
}

/// Of a beam whose law has no memory: nothing.
template <beam::BeamElement B>
class SectionLaws {
public:
    using Mesh = beam::Mesh<B>;
    SectionLaws(const scene::Assembly& assembly, const Mesh& mesh, const B&, const connection::Channels&) {
        for (Index f = 0; f < mesh.fibre_count(); ++f)
            if (const std::string& channel = assembly.fibres()[core::at(f)].law_channel; !channel.empty())
                core::refuse(mesh.label(f) + ": law_channel", channel, "empty, for a beam without a law of its own");
    }
    static constexpr bool again() noexcept { return false; }
    static constexpr bool begin(const auto&, const Mesh&, const B&, const Vector&) noexcept { return false; }
    static void drive(const Mesh&, const std::vector<double>&, const beam::Drive&) noexcept {}
    static std::string refusal(const Mesh&, const B&, const Vector&) { return {}; }
    static void book(const Mesh&, const B&, const Vector&, const EnergyAccount&) noexcept {}
    static void accept(const Mesh&, const B&, const Vector&, const EnergyAccount&) noexcept {}
    static Index count(const Mesh&) noexcept { return 0; }
    static Vector numbers(const Mesh&) { return {}; }
    static void take(const Mesh&, const Vector&) noexcept {}
    static void go_on_from(const auto&, const auto&) noexcept {}
};

/// Points break one at a time: after an increment in which one reaches its strength, equilibrium is found again at the same
/// amplitudes, until none does. An increment that overshoots a strength by more than `overshoot` is cut, so that the first to
/// break is the right one.
template <beam::Remembering B>
class SectionLaws<B> {
    using M = typename B::Material;

public:
    using Mesh = beam::Mesh<B>;
    static constexpr double overshoot = 0.02;  ///< of a strength, at which an increment is still accepted [1]

    SectionLaws(const scene::Assembly& assembly, Mesh& mesh, const B& beam, const connection::Channels& channels)
        : channel_(core::at(mesh.fibre_count()), -1) {
        for_elements(mesh, [&](Index f, Index e, typename B::Rest& rest) { beam.place(rest, f, e); });
        for (Index f = 0; f < mesh.fibre_count(); ++f)
            if (const std::string& channel = assembly.fibres()[core::at(f)].law_channel; !channel.empty())
                channel_[core::at(f)] = channels.find(channel);
    }
    /// Whether a point has broken, so that the next increment moves nothing.
    bool again() const noexcept { return again_; }
    /// Throws std::invalid_argument for stages without a duration, if the law has a rate. Memory that has come from another mesh
    /// is put where the strains of this one have it: back on bounds that they would exceed. @returns whether it was
    template <class Stages>
    bool begin(const Stages& stages, Mesh& mesh, const B& beam, const Vector& state) {
        if constexpr (M::has_rate)
            for (const auto& stage : stages)
                core::require(stage.duration > 0.0, "Stage.duration of stage " + stage.name, stage.duration,
                              "> 0: the law of the section has a rate");
        if (settled_) return false;
        for_elements(mesh, [&](Index f, Index e, typename B::Rest& rest) { beam.accept(rest, mesh.element(state, f, e)); });
        return settled_ = true;
    }
    void drive(Mesh& mesh, const std::vector<double>& amplitudes, const beam::Drive& drive) const {
        for_elements(mesh, [&](Index f, Index, typename B::Rest& rest) {
            const Index channel = channel_[core::at(f)];
            B::drive(rest, {drive.duration, channel < 0 ? 0.0 : amplitudes[core::at(channel)], drive.share});
        });
    }
    /// Why a state that has converged is not accepted; empty if it is.
    std::string refusal([[maybe_unused]] const Mesh& mesh, [[maybe_unused]] const B& beam,
                        [[maybe_unused]] const Vector& state) const {
        if constexpr (beam::Breakable<M>) {
            if (again_) return {};
            const Weakest most = weakest(mesh, beam, state);
            if (most.use > 1.0 + overshoot)
                return mesh.element_label(most.fibre, most.element) + ": stress over strength = " + core::text(most.use) +
                       ", more than " + core::text(1.0 + overshoot) + " at once";
        }
        return {};
    }
    /// Books what points have lost, and what has driven them has done, on the way to a state that has converged.
    static void book(Mesh& mesh, const B& beam, const Vector& state, EnergyAccount& energy) {
        beam::LawFigures sum;
        for_elements(mesh, [&](Index f, Index e, typename B::Rest& rest) {
            const beam::LawFigures own = beam.figures(rest, mesh.element(state, f, e));
            sum.dissipated += own.dissipated, sum.driven += own.driven;
        });
        energy.book_laws(sum.dissipated, sum.driven);
    }
    /// Keeps what points remember of an accepted state, breaks the weakest one if its time has come, and books that.
    void accept(Mesh& mesh, const B& beam, const Vector& state, EnergyAccount& energy) {
        for_elements(mesh, [&](Index f, Index e, typename B::Rest& rest) {
            beam.accept(rest, mesh.element(state, f, e));
            B::drive(rest, {0.0, rest.memory.drive.amplitude, 1.0});  // it stands there, and no time passes
        });
        again_ = false;
        if constexpr (beam::Breakable<M>) {
            const Weakest most = weakest(mesh, beam, state);
            if (most.use < 1.0) return;
            typename B::Rest& rest = mesh.rests()[core::at(mesh.element_index(most.fibre, most.element))];
            const double before = beam.energy(rest, mesh.element(state, most.fibre, most.element));
            beam.break_point(rest, most.point);
            energy.release(energy.balance().elastic - before + beam.energy(rest, mesh.element(state, most.fibre, most.element)));
            again_ = true;
        }
    }
    /// All that a checkpoint needs: whether a point has just broken, and what all points remember.
    Vector numbers(Mesh& mesh) const {
        Vector all(count(mesh));
        Index k = 0;
        all[k++] = (again_ ? 1.0 : 0.0) + (settled_ ? 0.0 : from_other_mesh);
        for_elements(
            mesh, [&](Index, Index, typename B::Rest& rest) { B::visit(rest, [&](const double& value) { all[k++] = value; }); });
        return all;
    }
    void take(Mesh& mesh, const Vector& all) {
        Index k = 0;
        settled_ = all[k] < from_other_mesh;
        again_ = std::fmod(all[k++], from_other_mesh) != 0.0;
        for_elements(mesh,
                     [&](Index, Index, typename B::Rest& rest) { B::visit(rest, [&](double& value) { value = all[k++]; }); });
    }
    static Index count(Mesh& mesh) {
        Index sum = 1;
        for_elements(mesh, [&](Index, Index, typename B::Rest& rest) { B::visit(rest, [&](const double&) { ++sum; }); });
        return sum;
    }
    /// The same on a mesh whose elements are parts of those of another one.
    static Vector refined(Mesh mesh, const Vector& all, Mesh finer, Index parts) {
        SectionLaws laws;
        laws.take(mesh, all);
        for_elements(finer, [&](Index f, Index e, typename B::Rest& part) {
            auto xi = B::point_places;
            for (double& place : xi)
                place = (2.0 * static_cast<double>(e % parts) + 1.0 + place) / static_cast<double>(parts) - 1.0;
            B::take_part(part, mesh.rest(f, e / parts), xi, B::point_places);
        });
        laws.settled_ = false;
        return laws.numbers(finer);
    }
    /// Memory of another run of the same fibres, where its beam obeys the same law.
    template <class Other>
    static void go_on_from(Mesh& mesh, const Other& other) {
        if constexpr (std::same_as<Other, Mesh>)
            for (std::size_t k = 0; k < mesh.rests().size(); ++k)
                mesh.rests()[k].memory.accepted = other.rests()[k].memory.accepted;
    }

private:
    SectionLaws() = default;
    struct Weakest {
        double use = 0.0;
        Index fibre = 0, element = 0;
        std::size_t point = 0;
    };
    static Weakest weakest(const Mesh& mesh, const B& beam, const Vector& state) {
        Weakest most;
        for (Index f = 0; f < mesh.fibre_count(); ++f)
            for (Index e = 0; e < mesh.fibre(f).elements; ++e)
                if (const auto [use, point] = beam.weakest(mesh.rest(f, e), mesh.element(state, f, e)); use > most.use)
                    most = {use, f, e, point};
        return most;
    }
    template <class Body>
    static void for_elements(Mesh& mesh, const Body& body) {
        for (Index f = 0; f < mesh.fibre_count(); ++f)
            for (Index e = 0; e < mesh.fibre(f).elements; ++e) body(f, e, mesh.rests()[core::at(mesh.element_index(f, e))]);
    }
    std::vector<Index> channel_;  ///< of each fibre, or -1
    bool again_ = false, settled_ = true;
    static constexpr double from_other_mesh = 2.0;  ///< in the first of the numbers
};

}  // namespace fibrant::simulation
