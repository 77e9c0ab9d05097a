// SPDX-License-Identifier: MIT
#pragma once
/// @file Equilibrium of a mesh with its contacts, terms and prescribed motion: residual, tangent, energies.

#include <fibrant/assembly/residual_figures.hpp>
#include <fibrant/assembly/solid_system.hpp>
#include <fibrant/assembly/stiffness_sink.hpp>
#include <fibrant/assembly/vector_measures.hpp>
#include <fibrant/connection/connections.hpp>
#include <fibrant/connection/prescribed_motion.hpp>
#include <fibrant/contact/contact_set.hpp>
#include <fibrant/contact/learned_contacts.hpp>
#include <fibrant/damping/place_springs.hpp>
#include <fibrant/load/applied_load.hpp>
#include <fibrant/term/list.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace fibrant::assembly {

/// The mechanical problem of one increment.
/// @tparam Connections  of ends of fibres to rigid bodies
/// @tparam Solid        that the fibres are bonded to; its unknowns come after theirs
/// @tparam Acts         what else pushes: term::List<...>
template <beam::BeamElement B, class Contacts, class Connections = connection::NoConnections, class Solid = solid::NoSolid,
          class Acts = term::List<>>
class Equilibrium;

template <beam::BeamElement B, class Contacts, class Connections, class Solid, class... T>
class Equilibrium<B, Contacts, Connections, Solid, term::List<T...>> {
public:
    using Terms = term::Terms<B, load::Applied, damping::PlaceSprings, T...>;
    using Parameters = typename term::List<T...>::Parameters;
    using System = typename SystemOf<B, Solid>::Type;
    using Ties = typename Connections::template Of<B>;
    static constexpr bool has_solid = core::Active<Solid>;
    static_assert(connection::Connection<Ties, B>);
    /// The force of an element in an iteration depends on the strains that it predicts.
    static constexpr bool iterated_strains = beam::IteratedStrains<B>;
    /// A term makes it move in time.
    static constexpr bool moves = Terms::moves;
    static_assert(!moves || !has_solid, "solids have no inertia yet: a model that moves has no part Solid");
    static constexpr Index element_unknowns = beam::Mesh<B>::element_unknowns;

    Equilibrium(const scene::Assembly& assembly, const beam::Mesh<B>& mesh, const B& beam, Contacts& contacts,
                const connection::Channels& channels, const Solid& solid = Solid(), const Parameters& terms = {})
        : mesh_{&mesh},
          beam_{beam},
          contacts_{&contacts},
          motion_{assembly, mesh, channels},
          ties_{assembly, mesh, channels},
          solid_{taken(solid, assembly, mesh, channels)},
          system_{system(mesh, solid_)},
          terms_{term::SiteOf<B>(assembly, mesh, channels, std::as_const(system_).layout()), terms},
          stresses_(core::at(mesh.element_count())) {
        const double extent = scene::extent_of(mesh.layout(), mesh.rest_state());
        double solid_scale = 0.0;
        if constexpr (has_solid) solid_scale = solid_.rounding_scale(extent);
        rounding_ = rounding_of(mesh, extent, solid_scale);
    }

    /// That which rounding leaves where nothing acts: its forces, over the digits of places [force length].
    double rounding_energy() const {
        return std::numeric_limits<double>::epsilon() * scene::extent_of(mesh_->layout(), mesh_->rest_state()) * rounding_;
    }

    Equilibrium(const Equilibrium&) = delete;  // its terms look at its layout
    Equilibrium& operator=(const Equilibrium&) = delete;

    const System& system() const noexcept { return system_; }
    /// Bands of chains are to have all that lies within them, however small the system.
    void fill_bands() noexcept { system_.fill_bands(); }
    const std::vector<Vec3>& targets() const noexcept { return targets_; }
    const beam::Mesh<B>& mesh() const noexcept { return *mesh_; }
    const connection::PrescribedMotion<B>& motion() const noexcept { return motion_; }
    /// Of what holds turn: what forces do beyond what a trapezium takes [force * length].
    double beyond_chords(const connection::Way& way) const {
        double sum = motion_.beyond_chords(way);
        if constexpr (has_solid) sum += solid_.beyond_chords(way);
        return sum;
    }
    const Ties& ties() const noexcept { return ties_; }
    Ties& ties() noexcept { return ties_; }
    const Solid& solid() const noexcept { return solid_; }
    Solid& solid() noexcept { return solid_; }
    Terms& terms() noexcept { return terms_; }
    const Terms& terms() const noexcept { return terms_; }

    /// Sets what is imposed, and the state from which the increment starts.
    /// @param damping  of a spring from every centre to its place in `state`, >= 0 [force / length]; directors count at the
    ///                 surface. It holds what nothing else holds, and leaves no force once nothing moves.
    /// @param holding  factor on it of each fibre, >= 1; none: 1
    void begin(std::span<const double> amplitudes, const Vector& state, double damping = 0.0,
               std::span<const double> holding = {}) {
        terms_.template get<damping::PlaceSprings>().set(damping, holding);
        terms_.each([&](auto& term) { term.begin(amplitudes, state); });
        motion_.at(amplitudes, state, system_.layout().held, targets_);
        ties_.begin(amplitudes);
        if constexpr (has_solid) solid_.hold(amplitudes, system_.layout().held, targets_);
        ties_.hold(system_.layout(), targets_);
        scene::hold_images(system_.layout(), targets_);
        if constexpr (has_solid) system_.share_held();
        reset_stresses(state);
    }

    /// Springs of the damping have their places in this state instead.
    void carry(const Vector& place) { terms_.template get<damping::PlaceSprings>().move_to(place); }

    // The loops of an increment, of all terms; contacts have theirs beside.
    void detect(const Vector& state, const Vector& accepted, double reach) {
        terms_.each([&](auto& term) { term.detect(state, accepted, reach); });
    }
    /// @returns the largest turn of a normal [radian], at least `turn`
    double refresh(const Vector& state, const Vector& accepted, double turn) {
        terms_.each([&](auto& term) { turn = std::max(turn, term.refresh(state, accepted)); });
        return turn;
    }
    void evaluate(const Vector& state) {
        terms_.each([&](auto& term) { term.evaluate(state); });
    }
    /// Of a step, so that nothing approaches by more than `length`; at most `part`.
    double largest_part(const Vector& step, double length, double part) const {
        terms_.each([&](const auto& term) { part = std::min(part, term.largest_part(step, length)); });
        return part;
    }
    void accept(const Vector& state) {
        terms_.each([&](auto& term) { term.accept(state); });
    }
    void restore() {
        terms_.each([&](auto& term) { term.restore(); });
    }

    /// Point stresses that belong to a state: the start of an increment, or the fallback of the mixed iteration.
    void reset_stresses(const Vector& state) {
        for_elements([&](Index f, Index e) { stress(f, e) = beam_.stresses(mesh_->rest(f, e), mesh_->element(state, f, e)); });
    }
    /// Point stresses predicted for state + step, as independent unknowns: only the geometric stiffness sees them.
    void predict_stresses(const Vector& state, const Vector& step) {
        for_elements([&](Index f, Index e) {
            stress(f, e) = beam_.predicted_stresses(mesh_->rest(f, e), mesh_->element(state, f, e), mesh_->element(step, f, e));
        });
    }

    /// What contacts turned out to be over a step that went too far: tangents have it until the next step begins.
    contact::LearnedContacts& learned() noexcept { return learned_; }
    /// Adds to the right side of the next step what goes with it.
    void add_learned(Vector& right) const {
        if (learned_.empty()) return;
        const auto& elements = contacts_->elements();
        for (Index k = 0; k < core::count(elements); ++k) {
            const Vec3 force = learned_.force(*contacts_, k);
            if (force.isZero(0.0)) continue;
            beam::spread(elements[core::at(k)].weights_j, Vec3(-force), elements[core::at(k)].first_j, right);
            beam::spread(elements[core::at(k)].weights_i, force, elements[core::at(k)].first_i, right);
        }
        scene::fold_images(system_.layout(), right);
        scene::project_free(system_.layout(), right);
    }

    /// Part of a step that moves held components to their targets.
    void prescribed_step(const Vector& state, Vector& step) const {
        step.setZero(state.size());
        const auto& held = system_.layout().held;
        for (std::size_t k = 0; k < held.size(); ++k) {
            const Vec3 value = state.segment<3>(3 * held[k].vector);
            step.segment<3>(3 * held[k].vector) = targets_[k] - (value - held[k].free * value);
        }
        ties_.add_closing(system_.layout(), step);
        close_chains(step, state);
    }

    /// Last nodes of closed fibres go where the first ones do, and images beside a cell with their fibres.
    void close_chains(Vector& step, const Vector& state) const {
        scene::copy_to_images(system_.layout(), step);
        scene::add_image_misses(system_.layout(), state, step);
    }

    /// Moves tied vectors of a state whose residual is known onto their conditions: where a body turns freely, a step leaves
    /// these missed by the square of what it turned, and how far is not in the residual.
    void close_ties([[maybe_unused]] Vector& state) {
        if constexpr (core::Active<Ties>) {
            for (int pass = 0; pass < 3 && !ties_.met(); ++pass) {
                Vector step = Vector::Zero(state.size());
                ties_.add_closing(system_.layout(), step);
                close_chains(step, state);
                state += step;
                ties_.place(state, system_.layout());
            }
        }
    }

    /// Adds the forces of fibres and solids in a state.
    /// @param iterated  as the iteration has them, whose strains are those of the state once it has converged
    void add_internal_forces(const Vector& state, Vector& forces, bool iterated = false) {
        add_fibre_forces(state, forces, iterated);
        if constexpr (has_solid) solid_.add_forces(state, forces);
        terms_.template of<term::Role::structure>([&](const auto& term) { term.add_forces(state, forces); });
    }
    void add_fibre_forces(const Vector& state, Vector& forces, [[maybe_unused]] bool iterated) {
        core::parallel_for(
            mesh_->fibre_count(),
            [&](Index f) {
                for (Index e = 0; e < mesh_->fibre(f).elements; ++e) {
                    if constexpr (iterated_strains)
                        if (iterated) {
                            forces.template segment<element_unknowns>(mesh_->first_unknown(f, e)) +=
                                beam_.internal_force(mesh_->rest(f, e), mesh_->element(state, f, e), stress(f, e));
                            continue;
                        }
                    forces.template segment<element_unknowns>(mesh_->first_unknown(f, e)) +=
                        beam_.internal_force(mesh_->rest(f, e), mesh_->element(state, f, e));
                }
            },
            mesh_->grain());
    }

    /// Residual of a state whose contacts have been evaluated.
    ResidualFigures residual(const Vector& state, Vector& residual) {
        ties_.place(state, system_.layout());
        residual.setZero(state.size());
        const auto add = [&](const auto& term) { term.add_forces(state, residual); };
        contacts_->add_forces(residual);
        terms_.template of<term::Role::interaction>(add);
        ties_.see_images(system_.layout(), residual);
        scene::fold_images(system_.layout(), residual);
        const double contact = norm(residual);
        if constexpr (!moves) add_internal_forces(state, residual, true);
        terms_.template of<term::Role::aid>(add);
        scene::fold_images(system_.layout(), residual);
        external_.setZero(state.size());
        terms_.template of<term::Role::external>([&](const auto& term) { term.add_forces(state, external_); });
        scene::fold_images(system_.layout(), external_);
        if constexpr (moves)
            terms_.moving([&](auto& term) {  // fibres and loads act by a mean over the step
                terms_.template of<term::Role::structure>(add);
                fibres_.setZero(state.size());
                add_fibre_forces(state, fibres_, true);
                fibres_ -= external_;
                scene::fold_images(system_.layout(), fibres_);
                term.add_averaged(state, fibres_, residual);
                residual += external_;
                scene::fold_images(system_.layout(), residual);
            });
        if constexpr (core::Active<Ties>) {
            ties_.hold_forces(system_.layout(), residual - external_);
            ties_.add_forces(system_.layout(), external_);
        }
        residual -= external_;
        const double load = norm(external_);
        const double all = norm(residual);
        reaction_ = residual;
        scene::project_free(system_.layout(), residual);
        reaction_ -= residual;
        if constexpr (moves) add_left(state);
        ResidualFigures figures;
        figures.residual = norm(residual);
        figures.rounding = rounding_;
        const double reaction = std::sqrt(std::max(0.0, all * all - figures.residual * figures.residual));
        figures.scale = std::sqrt(contact * contact + load * load + reaction * reaction);
        if constexpr (moves)
            terms_.moving([&](const auto& term) {
                figures.scale = std::hypot(figures.scale, norm(fibres_)), figures.rounding += term.rounding();
            });
        return figures;
    }

    /// Tangent of a state whose contacts have been evaluated.
    /// @param tension_only  leave compression out of the geometric stiffness: positive semidefinite
    /// @param shift         added on every vector, as a spring on positions [force / length]
    void linearise(const Vector& state, bool tension_only, double shift) {
        system_.place(state);
        [[maybe_unused]] double share = 1.0;
        if constexpr (moves) terms_.moving([&](const auto& term) { share = term.share(); });
        core::parallel_for(
            mesh_->line_count(),
            [&](Index f) {
                system_.clear(f);
                const bool own = f < mesh_->fibre_count();
                for (Index e = 0; own && e < mesh_->fibre(f).elements; ++e) {
                    const typename B::Stresses geometric = tension_only ? B::without_compression(stress(f, e)) : stress(f, e);
                    if constexpr (moves)
                        system_.add(
                            f, e,
                            beam::ElementMatrix<B>(
                                share * beam_.tangent_stiffness(mesh_->rest(f, e), mesh_->element(state, f, e), geometric)));
                    else
                        system_.add(f, e, beam_.tangent_stiffness(mesh_->rest(f, e), mesh_->element(state, f, e), geometric));
                }
                contacts_->section_stiffness_terms(f, state, [&](Index first, const auto& weights, const Mat3& stiffness) {
                    system_.add_rank_one(f, first, weights, stiffness);
                });
                if (const double springs = own ? spring(f, shift) : 0.0; springs > 0.0)
                    scene::for_own_vectors(system_.layout(), f, [&](Index v, double length) {
                        system_.add_diagonal(v, springs * length * length * Mat3::Identity());
                    });
                system_.close(f);
            },
            mesh_->grain());
        StiffnessSink<System, B, moves> sink{system_, *mesh_, state};
        term::Bands bands(sink);
        terms_.each([&]<class One>(const One& term) {
            if constexpr (moves) sink.factor = One::role == term::Role::external ? share : 1.0;
            term.add_bands(state, bands);
        });
        ties_.stiffen(system_.layout(), !tension_only);
        if constexpr (has_solid) {
            solid_.add_to_fibres([&](Index vector, const Mat3& stiffness) { system_.add_diagonal(vector, stiffness); });
            solid_.linearise(state, tension_only, spring(-1, shift));
        }
        gather_points(state);
        gather_slides(tension_only);
        system_.index_points();
    }

    /// What couples what, for a solver's analysis: the points of a state whose contacts have been evaluated. Bands keep the
    /// values of an earlier state, and products wait for `linearise`.
    void outline(const Vector& state) {
        ties_.place(state, system_.layout());
        system_.place(state);
        gather_points(state);
        gather_slides(false);
    }

    double elastic_energy(const Vector& state) const {
        std::vector<double> part(core::at(mesh_->fibre_count()));
        core::parallel_for(
            mesh_->fibre_count(),
            [&](Index f) {
                for (Index e = 0; e < mesh_->fibre(f).elements; ++e)
                    part[core::at(f)] += beam_.energy(mesh_->rest(f, e), mesh_->element(state, f, e));
            },
            mesh_->grain());
        double sum = 0.0;
        for (const double value : part) sum += value;
        if constexpr (has_solid) sum += solid_.energy(state);
        terms_.each([&](const auto& term) { sum += term.stored(state); });
        return sum;
    }
    /// What terms dissipate from the last accepted state to this one [force * length].
    double dissipated(const Vector& state) const {
        double sum = 0.0;
        terms_.each([&](const auto& term) { sum += term.dissipated(state); });
        return sum;
    }
    /// Force of the damping on the fibres' supports in a state: what it takes is work of this force [force].
    Vector damping_force(const Vector& state) const { return terms_.template get<damping::PlaceSprings>().force(state); }
    /// External forces, and forces on held components, of the last residual.
    const Vector& external() const noexcept { return external_; }
    const Vector& reaction() const noexcept { return reaction_; }
    Vector& reaction() noexcept { return reaction_; }

    /// Norm with forces on directors divided by the radius [force].
    double norm(const Vector& forces) const { return norm_of(system_.layout(), forces); }
    /// Greatest displacement of a step, directors counted at the surface [length].
    double greatest(const Vector& step) const { return greatest_of(system_.layout(), step); }
    /// Scalar product of the displacements of two steps, directors counted at the surface [length^2].
    double product(const Vector& a, const Vector& b) const { return product_of(system_.layout(), a, b); }

    /// Of each fibre the greatest displacement of a step, directors counted at the surface [length]; empty if the step is not
    /// finite.
    std::vector<double> greatest_by_fibre(const Vector& step) const {
        return greatest_of_chains(system_.layout(), mesh_->fibre_count(), step);
    }
    /// The fibre that moves most in a step, and where.
    MovesMost moves_most(const Vector& step) const { return assembly::moves_most(system_.layout(), mesh_->fibre_count(), step); }

private:
    /// Supports carry forces of the end of a step.
    void add_left(const Vector& state) {
        terms_.moving([&](const auto& term) {
            const Vector left = term.left(state);
            Vector free = left;
            scene::project_free(system_.layout(), free);
            reaction_ += left - free;
        });
    }
    static Solid taken(Solid solid, [[maybe_unused]] const scene::Assembly& assembly, [[maybe_unused]] const beam::Mesh<B>& mesh,
                       [[maybe_unused]] const connection::Channels& channels) {
        if constexpr (has_solid) solid.take(assembly, mesh, channels);
        return solid;
    }
    static System system(const beam::Mesh<B>& mesh, [[maybe_unused]] const Solid& solid) {
        if constexpr (has_solid)
            return System(mesh, solid);
        else
            return System(mesh);
    }
    void gather_points([[maybe_unused]] const Vector& state) {
        auto& points = system_.points();
        points.clear();
        system_.skews().clear();
        const auto& elements = contacts_->elements();
        for (Index k = 0; k < core::count(elements); ++k) {
            const bool carries = contacts_->carries(k);
            if (!carries && learned_.empty()) continue;
            Mat3 tangent = contacts_->point_tangent(k);
            if (!learned_.empty()) {
                const Mat3 learned = learned_.stiffness(*contacts_, k);
                if (!carries && learned.isZero(0.0)) continue;
                tangent += learned;
            }
            const auto& element = elements[core::at(k)];
            core::reserve_for(points, points.size() + 1);
            points.push_back({element.first_i, element.first_j, element.fibre_i, element.fibre_j, element.weights_i,
                              element.weights_j, tangent});
            if (!contacts_->follows()) continue;
            const Vec3 column = contacts_->friction_by_gap(k);
            if (!column.isZero(0.0))
                system_.skews().push_back({static_cast<std::int32_t>(points.size() - 1), column, element.normal});
        }
        StiffnessSink<System, B, moves> sink{system_, *mesh_, state};
        term::Couplings couplings(sink);
        terms_.each([&](const auto& term) { term.add_couplings(state, couplings); });
        contacts_->bores().add_points(*mesh_, state, *contacts_, points);
        if constexpr (requires { contacts_->tools().add_points(points); }) contacts_->tools().add_points(points);
    }
    /// @param positive  without negative parts
    void gather_slides(bool positive) {
        system_.slides().clear();
        if (contacts_->places().none()) return;
        for (Index k = 0; k < core::count(contacts_->elements()); ++k)
            if (contacts_->slides(k) && contacts_->responses()[core::at(k)].slope != 0.0)
                system_.slides().push_back(contacts_->sliding(k, positive));
    }
    /// Springs on all vectors of a fibre, -1: on those of what is none, beside a shift [force / length].
    double spring(Index f, double shift) const {
        terms_.each([&](const auto& term) { shift += term.spring(f); });
        return shift;
    }
    typename B::Stresses& stress(Index f, Index e) noexcept { return stresses_[core::at(mesh_->element_index(f, e))]; }
    template <class Body>
    void for_elements(const Body& body) {
        core::parallel_for(
            mesh_->fibre_count(),
            [&](Index f) {
                for (Index e = 0; e < mesh_->fibre(f).elements; ++e) body(f, e);
            },
            mesh_->grain());
    }

    const beam::Mesh<B>* mesh_;
    B beam_;
    Contacts* contacts_;
    connection::PrescribedMotion<B> motion_;
    [[no_unique_address]] Ties ties_;
    [[no_unique_address]] Solid solid_;
    System system_;
    Terms terms_;
    std::vector<typename B::Stresses> stresses_;
    contact::LearnedContacts learned_;
    std::vector<Vec3> targets_;
    Vector external_, reaction_;
    [[no_unique_address]] std::conditional_t<moves, Vector, core::Inactive> fibres_;  // forces of the fibres
    double rounding_ = 0.0;
};

}  // namespace fibrant::assembly
