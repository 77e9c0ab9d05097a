// SPDX-License-Identifier: MIT
// What yarns are loaded by: a bundle of brittle fibres that is drawn until it breaks, fibre by fibre, and a fibre that is drawn
// over a pin, with friction that grows by a power of the pressure. Prints closed forms beside.
//   yarn SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume | --overwrite] [--quiet]
#include "../support/example.hpp"
#include "../support/program.hpp"
#include "../support/report_page.hpp"
#include "../support/table.hpp"
#include "../support/usual_keys.hpp"

#include <fibrant/beam/with_law.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/law/shaped_friction.hpp>
#include <fibrant/material/brittle.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/simulator.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

using namespace fibrant;

namespace {

const double pi = std::numbers::pi;
constexpr const char* drive = "draw";

struct Yarn {
    using Beam = beam::With<beam::RigidSectionRod, material::Brittle>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::ShapedFriction;
    using Solver = solver::SparseCholesky;
    using Tools = contact::RigidTools;
};

struct Asked {
    Index fibres = 1, elements = 1, increments = 40, seed = 1;
    double radius = core::unset, length = core::unset, strain = 0.01, pin = core::unset, travel = 0.0, mu = 0.0, depth = 1e-2,
           reversible = 0.02;
    scene::ElasticMaterial material;
    material::Brittle::Parameters strength;
    law::FrictionShape friction;

    double area() const { return pi * radius * radius; }
};

/// Fibres side by side, none of which touches another, between two plates that go apart.
scene::Assembly bundle(const Asked& asked) {
    scene::Assembly assembly;
    const auto row = static_cast<Index>(std::ceil(std::sqrt(static_cast<double>(asked.fibres))));
    for (Index f = 0; f < asked.fibres; ++f) {
        const Vec3 at = 10.0 * asked.radius * Vec3(static_cast<double>(f % row), static_cast<double>(f / row), 0.0);
        assembly.add({.from = at,
                      .to = at + asked.length * Vec3::UnitZ(),
                      .section = scene::circular(asked.radius),
                      .material = asked.material,
                      .elements = asked.elements,
                      .director = Vec3::UnitX()});
        assembly.clamp(scene::first_end(f)), assembly.hold_rotation(scene::last_end(f));
        scene::Hold end;
        end.at = scene::last_end(f), end.channel = drive, end.displacement = asked.strain * asked.length * Vec3::UnitZ();
        assembly.hold(end);
    }
    return assembly;
}

/// A fibre along x on top of a pin along z (tool 0), in the plane of both. To amplitude 1 it is wound on by half a turn,
/// stretched by `strain` from the start on; to 2 it is drawn on by `travel`.
scene::Assembly over_a_pin(const Asked& asked) {
    scene::Assembly assembly;
    const double half = 0.5 * asked.length, rho = asked.pin + asked.radius;
    assembly.add({.from = {-half, rho, 0},
                  .to = {half, rho, 0},
                  .section = scene::circular(asked.radius),
                  .material = asked.material,
                  .elements = asked.elements,
                  .director = Vec3::UnitZ()});
    scene::Tool pin;
    pin.shape = scene::ToolShape::cylinder, pin.radius = asked.pin, pin.channel = drive;
    assembly.add(pin);
    for (const double side : {-1.0, 1.0}) {
        scene::Hold end;
        end.at = side < 0.0 ? scene::first_end(0) : scene::last_end(0), end.channel = drive;
        end.path = [=](double amplitude) {
            const double angle = 0.5 * pi * std::min(amplitude, 1.0), on = side * asked.travel * std::max(0.0, amplitude - 1.0),
                         free = half * (1.0 + asked.strain * std::min(1.0, 20.0 * amplitude)) - rho * angle;
            return Vec3(side * (rho * std::sin(angle) + free * std::cos(angle) - half),
                        rho * std::cos(angle) - free * std::sin(angle) - rho - on, 0.0);
        };
        assembly.hold(end);
    }
    const Mat3 across = Vec3(0, 0, 1).asDiagonal();
    for (Index k = 1; k < asked.elements; ++k)
        assembly.hold_position({0, static_cast<double>(k) / static_cast<double>(asked.elements)}, across);
    assembly.hold_axial_rotation(scene::first_end(0));
    return assembly;
}

simulation::ModelParameters<Yarn> model_of(const Asked& asked) {
    simulation::ModelParameters<Yarn> model;
    model.beam.laws = {asked.strength};
    model.normal.regularisation_depth = 0.1 * asked.depth * asked.radius;
    model.friction = {
        .friction_coefficient = 0.0, .reversible_displacement = asked.reversible * asked.radius, .shape = asked.friction};
    model.contact.stiffness.allowed_penetration = asked.depth * asked.radius;
    model.iteration.contact_tolerance = 0.1 * asked.reversible * asked.radius;
    model.iteration.margin = 2.0, model.iteration.largest_margin = 20.0;  // ends swing far
    return model;
}

bool draw_bundle(const Asked& asked, const example::SceneReader& file, example::Output& output) {
    simulation::Simulator<Yarn> simulator(bundle(asked), model_of(asked));
    output.open(file);
    const auto stress = [&] {
        double force = 0.0;
        for (Index f = 0; f < asked.fibres; ++f) force += simulator.reaction(scene::last_end(f)).z();
        return force / (static_cast<double>(asked.fibres) * asked.area());
    };
    const auto strain = [&] { return asked.strain * simulator.amplitude(drive); };
    example::Recorder recorder(output, asked.radius, [&]() -> std::vector<observe::Column> {
        return {{"strain", strain()}, {"stress", stress()}, {"stress_over_strength", stress() / asked.strength.strength}};
    });
    simulation::Loading<Yarn> loading;
    simulation::Stage<Yarn> stage;
    stage.name = "draw", stage.increments = asked.increments;
    stage.most_increments = 100 * asked.increments + asked.fibres * asked.elements * 4;
    stage.ramps = {{drive, 1.0}};
    loading.stages = {stage}, loading.smallest_fraction = 1e-6, loading.most_rejected = 1000 + 20 * asked.fibres;
    output.tell(loading);
    const simulation::Report report = simulator.run(loading, recorder);
    example::write_pictures(output, simulator.snapshot(), -60.0, 20.0);
    const simulation::Audit audit = example::audit(output, simulator, asked.radius);
    // Of the table, which a run that was resumed has whole.
    double most = 0.0, at = 0.0;
    const example::Table table(output.folder / "increments.csv");
    for (const auto& [drawn, borne] : table.line("", table.column("strain"), table.column("stress")).points)
        if (borne > most) most = borne, at = drawn;
    // Daniels (1945): fibres of a length L without friction carry (m e)^(-1/m) s at most, s = s0 (L0/L)^(1/m).
    const double m = asked.strength.modulus,
                 own = asked.strength.strength * std::pow(asked.strength.reference_length / asked.length, 1.0 / m);
    const observe::JsonObject summary = example::write_summary(
        output, report, audit, asked.radius,
        {{"greatest_stress_over_strength", most / own},
         {"of_a_large_bundle", std::pow(m * std::exp(1.0), -1.0 / m)},
         {"strain_at_it_over_that_of_a_large_bundle", at / (own / asked.material.young_modulus * std::pow(m, -1.0 / m))},
         {"released", report.energy.released},
         {"external_work", report.energy.external},
         {"energy_error", report.energy.error()}});
    example::write_report(output, "yarn", summary, simulator.snapshot());
    return report.converged && audit.clean();
}

bool draw_over_pin(const Asked& asked, const example::SceneReader& file, example::Output& output) {
    simulation::ModelParameters<Yarn> model = model_of(asked);
    simulation::Simulator<Yarn> simulator(over_a_pin(asked), model);
    output.open(file);
    const auto tension = [&](const scene::Station& end) { return simulator.reaction(end).norm(); };
    // Of T = a N^n on the fibre's axis: the slack side has T_0, the other [1 + (1 - n) mu_0 theta]^(1/(1 - n)) of it.
    const auto closed = [&] {
        const double n = asked.friction.exponent, rho = asked.pin + asked.radius, slack = tension(scene::first_end(0)),
                     turn = std::min(1.0, simulator.amplitude(drive)) * pi;
        if (n == 1.0) return std::exp(asked.mu * asked.pin / rho * turn);
        const double mu = asked.mu * std::pow(asked.friction.line_load * rho / slack, 1.0 - n) * asked.pin / rho;
        return std::pow(1.0 + (1.0 - n) * mu * turn, 1.0 / (1.0 - n));
    };
    const auto ratio = [&] { return tension(scene::last_end(0)) / tension(scene::first_end(0)); };
    example::Recorder recorder(output, asked.radius, [&]() -> std::vector<observe::Column> {
        return {{"drawn", asked.travel * std::max(0.0, simulator.amplitude(drive) - 1.0)},
                {"slack", tension(scene::first_end(0))},
                {"ratio", ratio()},
                {"ratio_of_closed_form", closed()}};
    });
    simulation::Loading<Yarn> loading;
    simulation::Stage<Yarn> stage;
    stage.name = "wind", stage.increments = asked.increments, stage.most_increments = 20 * asked.increments;
    stage.ramps = {{drive, 1.0}};
    loading.stages.push_back(stage);
    stage.name = "draw", stage.ramps = {{drive, 2.0}};
    model.friction.friction_coefficient = asked.mu;
    stage.friction.emplace(model.friction);
    loading.stages.push_back(stage);
    output.tell(loading);
    const simulation::Report report = simulator.run(loading, recorder);
    example::write_pictures(output, simulator.snapshot(), -90.0, 0.0);
    const simulation::Audit audit = example::audit(output, simulator, asked.radius);
    const observe::JsonObject summary = example::write_summary(output, report, audit, asked.radius,
                                                               {{"ratio", ratio()},
                                                                {"ratio_of_closed_form", closed()},
                                                                {"dissipated", report.energy.dissipated},
                                                                {"external_work", report.energy.external},
                                                                {"energy_error", report.energy.error()}});
    example::write_report(output, "yarn", summary, simulator.snapshot());
    return report.converged && audit.clean();
}

bool solve(example::SceneReader& file, example::Output& output) {
    Asked asked;
    std::string kind = "bundle", flaws = "surface";
    file.read("yarn", "kind", kind, {"bundle", "pin"},
              "a bundle that is drawn until it breaks, or a fibre that is drawn over a pin");
    file.read("yarn", "fibres", asked.fibres, example::between(1, 10000), "fibres of the bundle");
    file.require("yarn", "radius", asked.radius, example::positive(), "length", "radius of a fibre");
    file.require("yarn", "length", asked.length, example::positive(), "length", "length of the fibres");
    file.read("yarn", "elements", asked.elements, example::between(1, 10000), "elements along a fibre");
    example::read_material(file, "material", asked.material);
    file.require("material", "strength", asked.strength.strength, example::positive(), "force/length^2",
                 "stress that 1/e of pieces of the reference length bear (Weibull)");
    file.require("material", "weibull_modulus", asked.strength.modulus, example::between(0.1, 1000.0), "1",
                 "m: the larger, the less strength varies");
    file.require("material", "reference_length", asked.strength.reference_length, example::positive(), "length",
                 "length of the pieces whose strength that is");
    file.read("material", "flaws", flaws, {"surface", "volume"}, "where fibres have the flaws that they break from");
    file.read("material", "seed", asked.seed, example::between(0, 1e15), "seed of the lots");
    const bool pinned = file.read("pin", "radius", asked.pin, example::positive(), "length", "radius of the pin");
    file.read("pin", "travel", asked.travel, example::not_negative(), "length",
              "way that the fibre is drawn over it, once it is wound on by half a turn");
    example::read_friction(file, asked.mu, "coefficient of friction on the pin");
    example::read_friction_shape(file, asked.friction);
    example::read_reversible_displacement(file, asked.reversible);
    example::read_allowed_penetration(file, asked.depth);
    file.read("loading", "strain", asked.strain, example::inside(0.0, 1.0), "1",
              "strain of the bundle at the end, or of the fibre that is wound on");
    file.read("loading", "increments", asked.increments, example::increments(),
              "increments of the drawing, and of the winding, if none is cut");
    file.complete();
    example::check_friction_shape(file, asked.friction);
    const bool over = kind == "pin";
    file.check(pinned == over, "pin", "radius", over ? "given, for kind = \"pin\"" : "left out, for kind = \"bundle\"");
    file.check(!over || asked.fibres == 1, "yarn", "fibres", "1, for kind = \"pin\"");
    file.check(!over || asked.travel > 0.0, "pin", "travel", "> 0: nothing would be drawn");
    file.check(over || asked.travel == 0.0, "pin", "travel", "left out, for kind = \"bundle\"");
    file.check(over || asked.mu == 0.0, "contact", "friction_coefficient",
               "0, for kind = \"bundle\", whose fibres do not touch each other");
    if (over) {
        const double around = 1.2 * pi * (asked.pin + asked.radius);
        file.check(asked.length >= around, "yarn", "length", ">= " + core::text(around) + ", to go round the pin by half a turn");
        file.check(asked.travel <= 0.25 * asked.length, "pin", "travel", "<= a quarter of yarn.length");
        const double fine = std::ceil(asked.length / (0.2 * asked.pin));
        file.check(static_cast<double>(asked.elements) >= fine, "yarn", "elements",
                   ">= " + core::text(fine) + ", or an element turns by more than a fifth of a radian on the pin");
    }
    example::require_element(file, "yarn", asked.elements, asked.length, asked.radius);
    example::require_room(file, "yarn", "fibres", example::unknowns_of(asked.fibres, asked.elements), 6000.0);
    asked.strength.flaws = flaws == "surface" ? material::Flaws::surface : material::Flaws::volume;
    asked.strength.seed = static_cast<std::uint64_t>(asked.seed);
    return over ? draw_over_pin(asked, file, output) : draw_bundle(asked, file, output);
}

}  // namespace

example::Program yarn_program() {
    return {"yarn", "Draws a bundle of brittle fibres until it breaks, or a fibre over a pin.", solve};
}
