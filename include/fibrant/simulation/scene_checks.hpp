// SPDX-License-Identifier: MIT
#pragma once
/// @file What is looked at before a run: holds that agree and have a place all along the loading, and that something is held.

#include <fibrant/connection/prescribed_motion.hpp>
#include <fibrant/contact/overlaps.hpp>
#include <fibrant/core/symmetric_eigen.hpp>
#include <fibrant/simulation/position.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace fibrant::simulation {

/// Throws std::invalid_argument where a scene has what the model has no part for, or no fibre.
template <Model M>
void require_parts(const scene::Assembly& assembly) {
    const auto refuse_if = [](std::size_t present, const char* field, const char* bound) {
        if (present > 0) core::refuse(field, std::to_string(present), bound);
    };
    if (assembly.fibres().empty()) core::refuse("assembly.fibres", "none", "at least one fibre");
    if (!HasTools<M>) refuse_if(assembly.tools().size(), "assembly.tools", "none, for a model without a part Tools");
    if constexpr (HasTools<M>)
        if (!requires { M::Tools::carried; })
            for (const scene::Tool& tool : assembly.tools())
                if (tool.carried())
                    core::refuse("Tool.carrier", "given", "left out, for a model whose part Tools is not CarriedTools");
    if (!HasConnections<M>)
        refuse_if(assembly.bodies().size() + assembly.cells().size(), "assembly.bodies",
                  "none, for a model without a part Connections");
    if (!HasSolid<M>) refuse_if(assembly.solids().size(), "assembly.solids", "none, for a model without a part Solid");
}

/// Throws std::invalid_argument where holds of a nodal vector contradict each other, at rest or as one channel goes to 1.
template <beam::BeamElement B>
void require_agreement(const connection::PrescribedMotion<B>& motion, const beam::Mesh<B>& mesh,
                       const connection::Channels& channels) {
    std::vector<double> amplitudes(channels.names().size(), 0.0);
    motion.check(amplitudes, mesh, true);
    for (double& amplitude : amplitudes) {
        amplitude = 1.0;
        motion.check(amplitudes, mesh, false);
        amplitude = 0.0;
    }
}

/// The same at what the stages of a loading come by, where paths must be finite too.
/// @param amplitudes  at its start
template <Model M, beam::BeamElement B>
void require_paths(const std::vector<Stage<M>>& stages, const connection::PrescribedMotion<B>& motion, const beam::Mesh<B>& mesh,
                   const connection::Channels& channels, std::vector<double> amplitudes) {
    constexpr Index most_looks = 64;  // at a stage
    for (const Stage<M>& stage : stages) {
        if (stage.ramps.empty()) continue;
        Position position;
        position.from = amplitudes;
        const Index looks = std::min(stage.increments, most_looks);
        for (Index k = 1; k <= looks; ++k) {
            amplitudes =
                amplitudes_at(stage, static_cast<double>(k) / static_cast<double>(looks), position, channels, amplitudes);
            core::with_place([&] { return "stage '" + stage.name + "'"; }, [&] { motion.check(amplitudes, mesh, true); });
        }
    }
}

/// A direction in which the scene as a whole can move with nothing against it, if there is one: no hold, tie to a body that is
/// not loose or hold of a solid has a part along it. Tools count as holding.
template <beam::BeamElement B>
std::optional<Vec3> loose_direction(const scene::Assembly& assembly, const beam::Mesh<B>& mesh) {
    if (!assembly.tools().empty()) return {};
    Mat3 held = Mat3::Zero();
    for (const scene::Hold& hold : assembly.holds()) {
        if (hold.vector != scene::NodeVector::position) continue;
        Mat3 axes = Mat3::Identity();
        if (hold.axes == scene::Axes::section) axes = mesh.frame(hold.at.fibre, mesh.node_at(hold.at)).basis();
        held += axes * hold.directions * axes.transpose();
    }
    for (const scene::SolidHold& hold : assembly.solid_holds()) held += hold.directions;
    for (const scene::AverageConnection& average : assembly.averages())
        for (Index body = average.body; body >= 0; body = assembly.bodies()[core::at(body)].parent)
            for (const scene::Coordinate& coordinate : assembly.bodies()[core::at(body)].translation)
                if (!coordinate.free) return {};  // which directions that leaves is a matter of the tree of bodies
    const core::SymmetricEigen<3> solver(held);
    constexpr double nothing = 1e-9;  // of a projector
    if (solver.values()[0] > nothing) return {};
    if (solver.values()[2] <= nothing) return Vec3(Vec3::Zero());
    return Vec3(solver.vectors().col(0));
}

/// What is said of a stage without damping of a scene that can move as a whole; empty if there is none. A scene may be good but
/// for what its loading leaves out, so it is a reason to stop and no exception.
template <Model M>
std::string unheld(const std::vector<Stage<M>>& stages, const std::optional<Vec3>& loose) {
    if (!loose) return {};
    for (const Stage<M>& stage : stages)
        if (stage.damping == 0.0)
            return "stage " + stage.name + ": assembly.holds = none" +
                   (loose->isZero(0.0) ? "" : " along " + scene::text(*loose)) +
                   ", but it must be such that the scene cannot move as a whole: hold a station, tie it to a body, or give the "
                   "stage a damping";
    return {};
}

/// Overlap of the sections of two fibres where a run begins, over the radius of the thinner one, beyond which it is not begun
/// without a limited gap [1]: the axis of one is in the other, and by which side they are to part is a guess.
inline constexpr double deepest_start = 1.0;

/// look(contacts) at the contacts of a simulator as they would be made now; the last accepted ones stay.
/// @param forced  keep forced orders
template <class Simulator, class Look>
auto look_at_contacts(Simulator& simulator, bool forced, const Look& look) {
    auto& contacts = simulator.contacts();
    contacts.detect(simulator.state(), simulator.state(), 0.0, forced);
    const auto seen = look(contacts);
    contacts.restore();
    return seen;
}

/// Fibres that are in each other where a run begins, deeper than allowed.
struct StartOverlap {
    std::string said;  ///< empty: none are
    bool too_deep = false;

    /// @param first   stage of the run; one that limits the gap may begin anywhere
    /// @param begins  the run, and does not go on
    template <class Simulator, Model M>
    StartOverlap(Simulator& simulator, const Stage<M>& first, bool begins) {
        constexpr bool limits = law::GapLimiting<typename M::Normal>;
        if (!begins || (limits && first.gap_limit)) return;
        const contact::Overlap deepest = look_at_contacts(simulator, false, [&](const auto& contacts) {
            return contact::deepest_overlap(contacts, simulator.mesh(), simulator.state(), true);
        });
        if (deepest.depth <= simulator.contacts().parameters().stiffness.allowed_penetration) return;
        too_deep = deepest.depth > deepest_start * deepest.radius;
        said = "where the scene begins, " + contact::text(deepest, simulator.mesh()) +
               ": simulation::part_overlaps parts them, or stages with a gap_limit of a law that has one";
    }
    /// What it adds to the reason why a first increment has failed.
    std::string remark() const { return said.empty() ? said : "; " + said; }
};

}  // namespace fibrant::simulation
