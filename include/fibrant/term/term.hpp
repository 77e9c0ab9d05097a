// SPDX-License-Identifier: MIT
#pragma once
/// @file The contract of a term of the equilibrium: something that pushes on fibres. What it lacks it says by name.

#include <fibrant/core/parameters.hpp>
#include <fibrant/term/stiffness.hpp>

#include <concepts>
#include <span>
#include <string>
#include <vector>

namespace fibrant::observe {
struct Snapshot;  // plain data that observers are shown
}  // namespace fibrant::observe

namespace fibrant::term {

/// What a term is to the balance of forces. Sums are taken role by role, within a role in the order of the model's list.
enum class Role {
    interaction,  ///< between fibres, or with what touches them: its size is a part of what residuals are measured by
    structure,    ///< internal forces beside those of the beams
    aid,          ///< that leaves no force at rest
    external,     ///< loads
};

// What a term does not have, it says by name. A verb that is misspelt is then one that is missing.
/// Nothing scales it.
struct NoDrive {
    static std::vector<std::string> channels(const auto&) { return {}; }
    void begin(std::span<const double>, const Vector&) const noexcept {}
};
/// It looks for nothing.
struct NoSearch {
    void detect(const Vector&, const Vector&, double) const noexcept {}
    double refresh(const Vector&, const Vector&) const noexcept { return 0.0; }
    void evaluate(const Vector&) const noexcept {}
    double largest_part(const Vector&, double) const noexcept { return 1.0; }
};
/// Nothing of its stiffness lies within elements.
struct NoBands {
    void add_bands(const Vector&, Bands&) const noexcept {}
};
/// It is no spring on all vectors of a fibre.
struct NoSpring {
    double spring(Index) const noexcept { return 0.0; }
};
/// It couples nothing beyond an element.
struct NoCouplings {
    void add_couplings(const Vector&, Couplings&) const noexcept {}
};
/// Its forces do not depend on the state, or so little that Newton's method may do without.
struct NoStiffness : NoBands, NoSpring, NoCouplings {};
/// It stores nothing and dissipates nothing: external, or an aid, whose work is booked by its forces.
struct NoEnergy {
    double stored(const Vector&) const noexcept { return 0.0; }
    double dissipated(const Vector&) const noexcept { return 0.0; }
};
/// It keeps nothing from one increment to the next.
struct NoMemory {
    void accept(const Vector&) const noexcept {}
    void restore() const noexcept {}
    void each(const auto&) const noexcept {}
};
/// It is not in pictures and files.
struct NoPicture {
    void show(const Vector&, observe::Snapshot&) const noexcept {}
};

/// What a term keeps is seen number by number or vector by vector.
struct SeeNumber {
    void operator()(double&) const noexcept {}
    void operator()(Index&) const noexcept {}
    void operator()(Vector&) const noexcept {}
};

// One concept a group of verbs: the compiler names the verb that is missing.

/// Built from a site and its parameters, which `Slot`, a struct with one member, gives a name among those of a model.
template <class T>
concept Named = requires {
    { T::role } -> std::convertible_to<Role>;
    typename T::Parameters;
    typename T::Slot;
};
/// Scaled by channels, or begun anew with each increment.
template <class T>
concept Driven = requires(T term, const typename T::Parameters& parameters, std::span<const double> amplitudes,
                          const Vector& accepted) {
    { T::channels(parameters) } -> std::same_as<std::vector<std::string>>;  // names that it uses
    term.begin(amplitudes, accepted);                                       // of all channels; of an attempt at an increment
};
/// Looks for what it acts on.
template <class T>
concept Searched = requires(T term, const Vector& state, const Vector& accepted, const Vector& step, double length) {
    term.detect(state, accepted, length);                       // outer loop; how far from touching what matters is [length]
    { term.refresh(state, accepted) } -> std::same_as<double>;  // middle loop: largest turn of a normal [radian]
    term.evaluate(state);                                       // inner loop, before forces
    {
        term.largest_part(step, length)
        } -> std::same_as<double>;  // of a step, in (0, 1], so that nothing approaches by more than `length`
};
/// Pushes. An external term adds its forces; all others add internal ones, which resist.
template <class T>
concept Pushing = requires(const T term, const Vector& state, Vector& forces, Index fibre, Bands& bands) {
    term.add_forces(state, forces);
    term.add_bands(state, bands);
    { term.spring(fibre) } -> std::same_as<double>;  // on all nodal vectors of a fibre, -1: of what is no fibre [force / length]
};
template <class T>
concept Coupling = requires(const T term, const Vector& state, Couplings& couplings) {
    term.add_couplings(state, couplings);
};
/// Energies, of a state and of the increment since the last accepted one [force * length].
template <class T>
concept Storing = requires(const T term, const Vector& state) {
    { term.stored(state) } -> std::same_as<double>;
    { term.dissipated(state) } -> std::same_as<double>;
};
/// Remembers.
template <class T>
concept Remembering = requires(T term, const Vector& state, const SeeNumber& see) {
    term.accept(state);
    term.restore();  // what was accepted: an attempt has failed
    term.each(see);  // every number of what was accepted: a checkpoint
};
/// Adds to what observers are shown.
template <class T>
concept Shown = requires(const T term, const Vector& state, observe::Snapshot& shot) {
    term.show(state, shot);
};

/// What a step of time has done to the energy of all [force * length].
struct StepEnergy {
    double missed = 0.0;  ///< what its balance misses
    double turned = 0.0;  ///< what has become of another kind, >= 0
    double held = 0.0;    ///< there is at its end: moving, or stored
    double part = 0.0;    ///< of the stage's duration that it lasts [1]
    double left = 0.0;    ///< of that, after it [1]
};

/// A term that makes a model move in time. Forces of the fibres are then those that it averages over a step; it is told how long
/// that lasts, and refuses a step that errs too much.
template <class T>
concept Moving = requires(T term, const T seen, const Vector& state, Vector& sum, double number, const StepEnergy& energy) {
    term.last(number);                                // duration of the next increments; before `begin` [time]
    term.add_averaged(state, state, sum);             // state, forces of the fibres in it
    { seen.share() } -> std::same_as<double>;         // of those in that average, known once `last` is: factor on their stiffness
    { seen.left(state) } -> std::same_as<Vector>;     // of them, what the average has not
    { seen.rounding() } -> std::same_as<double>;      // norm of what rounding makes of its forces [force]
    { seen.begins() } -> std::same_as<bool>;          // the motion, with this step
    { seen.kinetic(state) } -> std::same_as<double>;  // [force length]
    { term.refusal(state) } -> std::same_as<std::string>;   // empty: none
    { term.refusal(energy) } -> std::same_as<std::string>;  // the same once energy is booked
    { seen.may_grow(number) } -> std::same_as<bool>;        // the next step, by a factor
};

/// Something that pushes on fibres.
/// Owed beyond the syntax, and checked by tests/term/term_contract.hpp: internal forces are the derivative of what is stored,
/// stiffness is that of forces, `restore` gives back what was accepted, `each` has all of it, and `largest_part` is in (0, 1].
template <class T>
concept Term = Named<T> && Driven<T> && Searched<T> && Pushing<T> && Coupling<T> && Storing<T> && Remembering<T> && Shown<T>;

namespace detail {
template <class T, class B>
struct MadeFor {
    using Type = T;
    using Seen = Site;
};
template <class T, class B>
    requires requires { typename T::template Of<B>; }
struct MadeFor<T, B> {
    using Type = typename T::template Of<B>;
    using Seen = SiteOf<B>;
};
}  // namespace detail

/// A term as a model of a beam has it: itself, or what it is `Of` that beam.
template <class T, class B>
using For = typename detail::MadeFor<T, B>::Type;

/// A term, or one that is made for each beam, that can be built from a site and its parameters.
template <class T, class B>
concept TermFor = Term<For<T, B>> && std::constructible_from < For<T, B>,
const typename detail::MadeFor<T, B>::Seen&, const typename For<T, B>::Parameters& > ;

}  // namespace fibrant::term
