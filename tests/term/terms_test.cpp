// SPDX-License-Identifier: MIT
// Terms that a user writes: the contract, and a run with one that couples fibres, searches and remembers.
#include <term/term_contract.hpp>

#include "../../examples/own_parts/own_force.hpp"

#include <fibrant/beam/kirchhoff_cable.hpp>
#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/connection/fibre_bonds.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/observe/snapshot.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/simulator.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <filesystem>

using namespace fibrant;

namespace terms_test {

using Cable = beam::KirchhoffCable;

/// A spring between the middles of fibres 0 and 1, whose rest takes over half of what it carries at the end of each increment.
class Tether : public term::NoDrive, public term::NoBands, public term::NoSpring {
public:
    static constexpr auto role = term::Role::interaction;
    struct Parameters {
        double stiffness = 0.0;  // [force / length]
    };
    struct Slot {
        Parameters tether{};
    };
    Tether(const term::Site& site, const Parameters& parameters)
        : stiffness_{parameters.stiffness}, i_{site.point({0, 0.5})}, j_{site.point({1, 0.5})}, rest_{Vector::Zero(3)} {
        rest_ = between(site.rest_state());
    }
    void detect(const Vector&, const Vector&, double) { found_ = true; }
    double refresh(const Vector&, const Vector&) const noexcept { return 0.0; }
    void evaluate(const Vector& state) { force_ = stiffness_ * (between(state) - Vec3(rest_)); }
    double largest_part(const Vector&, double) const noexcept { return 1.0; }
    void add_forces(const Vector&, Vector& sum) const { j_.push(force_, sum), i_.push(-force_, sum); }
    void add_couplings(const Vector&, term::Couplings& couplings) const {
        couplings.between(i_, j_, stiffness_ * Mat3::Identity());
    }
    double stored(const Vector& state) const { return 0.5 * stiffness_ * (between(state) - Vec3(rest_)).squaredNorm(); }
    double dissipated(const Vector&) const noexcept { return 0.0; }
    void accept(const Vector& state) { rest_ += 0.5 * (between(state) - Vec3(rest_)); }
    void restore() const noexcept {}
    void each(const auto& see) { see(rest_); }
    void show(const Vector&, observe::Snapshot& shot) const {
        shot.contacts.emplace_back();
        shot.contacts.back().fibre_i = 0, shot.contacts.back().fibre_j = 1, shot.contacts.back().reaction = force_.norm();
    }
    Vec3 force() const { return force_; }
    bool found() const { return found_; }

private:
    Vec3 between(const Vector& state) const { return j_.place(state) - i_.place(state); }
    double stiffness_;
    term::CentrePoint i_, j_;
    Vector rest_;
    Vec3 force_ = Vec3::Zero();
    bool found_ = false;
};
static_assert(term::Term<Tether>);

scene::Assembly two_fibres() {
    scene::Assembly assembly;
    for (const double y : {0.0, 0.3}) {
        scene::FibreSpecification one;
        one.from = {0, y, 0}, one.to = {2, y, 0.1 * y}, one.section = scene::circular(0.01), one.material = {1000.0, 0.3},
        one.elements = 4;
        assembly.add(one);
    }
    return assembly;
}

TEST_CASE("terms of a user keep the contract, on cables and on rods whose sections turn") {
    const auto check = []<class B>(std::type_identity<B>) {
        const scene::Assembly assembly = two_fibres();
        const beam::Mesh<B> mesh(assembly, B());
        const Vector state =
            mesh.rest_state() + 0.05 * Vector::LinSpaced(mesh.rest_state().size(), -1.0, 1.0).array().sin().matrix();
        test::check_term<B, SoftBed>(assembly, {.stiffness = 3.0}, state);
        test::check_term<B, Tether>(assembly, {.stiffness = 0.7}, state);
        // Fibres that are drawn apart, so that nothing of a bond's stiffness is left out.
        Vector apart = state;
        for (Index k = 0; k < mesh.node_count(1); ++k) apart[3 * mesh.node_vector(1, k, 0) + 1] += 0.3;
        const connection::FibreBonds::Bond spring{.i = {0, 0.4}, .j = {1, 0.5}, .stiffness = 0.7};
        const connection::FibreBonds::Bond truss{.i = {0, 0.6}, .j = {1, 0.6}, .stiffness = 0.3, .span = 0.2};
        test::check_term<B, connection::FibreBonds>(assembly, {{spring, truss}}, apart);
    };
    check(std::type_identity<Cable>{});
    check(std::type_identity<beam::RigidSectionRod>{});
}

template <class List>
struct ModelWith {
    using Beam = Cable;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::Frictionless;
    using Solver = solver::SparseCholesky;
    using Acts = List;
};
using connection::FibreBonds;
using Tied = ModelWith<term::List<Tether, FibreBonds>>;
static_assert(simulation::Model<Tied>);
// An empty list is nothing.
static_assert(sizeof(simulation::Simulator<ModelWith<term::List<>>>::Equilibrium) + sizeof(Tether) + sizeof(FibreBonds) ==
              sizeof(simulation::Simulator<Tied>::Equilibrium));

struct Forces {
    std::vector<double> shown;
    void accepted(const observe::Snapshot& shot) { shown.push_back(shot.contacts.back().reaction); }
};

/// Both fibres are held at their ends; those of the second move away.
template <class Use>
simulation::Report run(const simulation::Loading<Tied>& loading, double stiffness, const Use& use,
                       const std::vector<FibreBonds::Bond>& bonds = {}) {
    scene::Assembly assembly = two_fibres();
    for (const Index f : {0, 1})
        for (const scene::Station at : {scene::first_end(f), scene::last_end(f)}) assembly.prescribe(at, f * Vec3(0, 0.2, 0));
    simulation::ModelParameters<Tied> parameters;
    parameters.normal.regularisation_depth = 1e-5;
    parameters.contact.stiffness.allowed_penetration = 1e-4;
    parameters.acts.tether.stiffness = stiffness;
    parameters.acts.bonds.bonds = bonds;
    simulation::Simulator<Tied> simulator(assembly, parameters);
    Forces forces;
    const simulation::Report report = simulator.run(loading, forces);
    use(simulator, forces);
    return report;
}

TEST_CASE("a tie of a user's own pulls two fibres alike, is shown, and goes through a checkpoint to the same bits") {
    const std::string file = (std::filesystem::temp_directory_path() / "fibrant_terms_test.bin").string();
    std::filesystem::remove(file);
    const double stiffness = 0.01;
    Vector whole;
    const simulation::Report report = run({.increments = 6}, stiffness, [&](const auto& simulator, const Forces& forces) {
        whole = simulator.state();
        const Tether& tether = simulator.equilibrium().terms().template get<Tether>();
        CHECK(tether.found());
        CHECK(forces.shown.size() == 6);
        CHECK(forces.shown.back() == tether.force().norm());
        CHECK(tether.force().y() > 0.0);
        const auto held = [&](Index f) {
            return Vec3(simulator.reaction(scene::first_end(f)) + simulator.reaction(scene::last_end(f)));
        };
        // The supports of either fibre carry what the tie pulls it by; residuals are converged to 1e-4 of that.
        CHECK((held(0) + tether.force()).norm() < 1e-3 * tether.force().norm());
        CHECK((held(1) - tether.force()).norm() < 1e-3 * tether.force().norm());
    });
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    // Stopped after two increments and gone on with: what it remembers comes from the file.
    int left = 2;
    simulation::Loading<Tied> part{.increments = 6, .checkpoint = file, .stop = [&] { return --left == 0; }};
    CHECK(!run(part, stiffness, [](const auto&, const auto&) {}).converged);
    simulation::Loading<Tied> rest{.increments = 6, .checkpoint = file, .resume = true};
    CHECK(run(rest, stiffness, [&](const auto& simulator, const auto&) { CHECK(simulator.state() == whole); }).converged);
    std::filesystem::remove(file);
}

TEST_CASE("bonds carry force until they break, one that is stronger holds, and the energy of both is told") {
    // The fibres, 48 EI/L^3 = 5e-5 stiff at their middles, move apart by 0.2.
    const double k = 1e-7;
    const std::vector<FibreBonds::Bond> bonds{{.i = {0, 0.5}, .j = {1, 0.5}, .stiffness = k, .strength = 0.55 * 0.2 * k},
                                              {.i = {0, 0.25}, .j = {1, 0.25}, .stiffness = 0.5 * k, .span = 0.1}};
    const simulation::Report report = run(
        {.increments = 20}, 1e-12,
        [&](const auto& simulator, const Forces&) {
            const FibreBonds& term = simulator.equilibrium().terms().template get<FibreBonds>();
            CHECK(term.broken(0));
            CHECK(!term.broken(1));
            const Vec3 force = term.force(1, simulator.state());
            CHECK(term.force(0, simulator.state()).norm() == 0.0);
            // The supports of the second fibre carry what its bond pulls it back by, residuals to 1e-4 of that.
            const Vec3 held = simulator.reaction(scene::first_end(1)) + simulator.reaction(scene::last_end(1));
            CHECK((held + force).norm() < 1e-3 * force.norm());
            CHECK(force.y() < 0.0);
        },
        bonds);
    REQUIRE_MESSAGE(report.converged, report.reason);
    // It breaks in the increment that takes it over its strength: 0.55 to 0.6 of the way; 0.5 k u^2 is lost then.
    const double least = 0.5 * k * std::pow(0.55 * 0.2, 2), most = 0.5 * k * std::pow(0.6 * 0.2, 2);
    CHECK(report.energy.dissipated > 0.95 * least);
    CHECK(report.energy.dissipated < 1.05 * most);
    // Supports work by trapezia: in the increment of the leap by half of the force that is gone, F du/2 against F u/2.
    CHECK(std::abs(report.energy.error()) < 0.1 * report.energy.dissipated);
    CHECK_THROWS_WITH_AS(run({.increments = 1}, 1.0, [](const auto&, const auto&) {}, {{.i = {0, 0.5}, .j = {1, 0.5}}}),
                         doctest::Contains("FibreBonds.Bond.stiffness = nan"), std::invalid_argument);
}

}  // namespace terms_test
