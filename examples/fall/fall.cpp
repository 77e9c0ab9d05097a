// SPDX-License-Identifier: MIT
// A nest of fibres falls into a drum under its weight, and may be pressed there by a lid: one that is driven, or one that falls
// onto it and is pressed by a force. Prints where its energy went.
//   fall SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume | --overwrite] [--quiet]
#include "../support/example.hpp"
#include "../support/program.hpp"
#include "../support/report_page.hpp"
#include "../support/usual_keys.hpp"

#include <fibrant/beam/with_law.hpp>
#include <fibrant/contact/carried_tools.hpp>
#include <fibrant/inertia/bodies.hpp>
#include <fibrant/law/impact.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/load/gravity.hpp>
#include <fibrant/material/damped.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/simulator.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>

using namespace fibrant;

namespace {

struct Nest {
    using Beam = beam::With<beam::RigidSectionRod, material::Damped<material::Elastic>>;
    using Proximity = proximity::GridSearch;
    using Normal = law::Impact<law::PowerNormal>;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::SparseCholesky;
    using Tools = contact::CarriedTools;
    using Motion = inertia::WithBodies<inertia::Midpoint>;
    using Acts = term::List<Motion, load::Gravity>;
};

struct Shape {
    Index fibres = 10, elements = 6;
    double radius = core::unset, length = core::unset, spacing = 2.5, turn_deg = 137.5, height = core::unset, drum = core::unset,
           pressed = 0.0;
    double lid_mass = 0.0, lid_height = 0.0, lid_weight = 0.0, lid_force = 0.0;  // of a lid that falls, beside its ram
    bool lid_falls() const { return lid_mass > 0.0; }
    double ram_length() const { return 10.0 * radius; }
    double lid_start() const { return start(fibres - 1) + radius + lid_height; }
    double start(Index fibre) const { return radius + height + spacing * radius * static_cast<double>(fibre); }
};

/// Level fibres above each other, each turned against the one below; a floor (tool 0), a drum around them (tool 1), and a lid
/// above that comes down (tool 2). One that falls is on the lower end of a ram, an upright fibre behind the others.
scene::Assembly nest(const Shape& shape, const scene::ElasticMaterial& material) {
    scene::Assembly assembly;
    for (Index f = 0; f < shape.fibres; ++f) {
        const double angle = static_cast<double>(f) * shape.turn_deg * std::numbers::pi / 180.0;
        const Vec3 half = 0.5 * shape.length * Vec3(std::cos(angle), std::sin(angle), 0.0);
        const Vec3 middle(0, 0, shape.start(f));
        assembly.add({.from = middle - half,
                      .to = middle + half,
                      .section = scene::circular(shape.radius),
                      .material = material,
                      .elements = shape.elements,
                      .director = Vec3::UnitZ()});
    }
    scene::Tool floor, drum;
    drum.shape = scene::ToolShape::cylinder, drum.radius = shape.drum, drum.hollow = true;
    assembly.add(floor), assembly.add(drum);
    if (shape.pressed > 0.0) {
        scene::Tool lid;
        lid.origin = Vec3(0, 0, shape.start(shape.fibres)), lid.axis = -Vec3::UnitZ(), lid.channel = "lid";
        lid.displacement = Vec3(0, 0, shape.pressed - lid.origin.z());
        assembly.add(lid);
    }
    if (shape.lid_falls()) {
        const double below = shape.lid_start() + 2.0 * shape.radius;
        const Index ram = assembly.add({.from = {0, 0, below},
                                        .to = {0, 0, below + shape.ram_length()},
                                        .section = scene::circular(shape.radius),
                                        .material = material,
                                        .elements = 1,
                                        .director = Vec3::UnitX()});
        for (const double end : {0.0, 1.0}) {
            assembly.hold_position({ram, end}, Vec3(1, 1, 0).asDiagonal());
            assembly.hold_rotation({ram, end});
        }
        scene::Tool lid;
        lid.origin = Vec3(0, 0, shape.lid_start()), lid.axis = -Vec3::UnitZ(), lid.carrier = scene::first_end(ram);
        assembly.add(lid);
        assembly.apply(scene::DeadForce{.at = scene::first_end(ram), .force = {0, 0, -shape.lid_weight}, .channel = "gravity"});
        assembly.apply(scene::DeadForce{.at = scene::first_end(ram), .force = {0, 0, -shape.lid_force}, .channel = "lid"});
    }
    return assembly;
}

bool solve(example::SceneReader& file, example::Output& output) {
    Shape shape;
    scene::ElasticMaterial material;
    double density = core::unset, damping = 0.0, mu = 0.2, reversible = 0.02, depth = 0.1, line = core::unset,
           crossing = core::unset, gravity = core::unset, duration = core::unset, error = 0.02, restraint = 0.0, missing = 1e-3,
           loss = core::unset, pressing = core::unset;
    Index steps = 100;
    file.read("nest", "fibres", shape.fibres, example::between(1, 1000), "fibres, one above the other");
    file.require("nest", "radius", shape.radius, example::positive(), "length", "radius of a fibre");
    file.require("nest", "length", shape.length, example::positive(), "length", "length of the fibres");
    file.read("nest", "elements", shape.elements, example::between(1, 10000), "elements along a fibre");
    file.read("nest", "spacing_over_radius", shape.spacing, example::inside(2.0, 1000.0), "1",
              "height of a fibre above the next one, centre to centre, over the radius");
    file.read("nest", "turn_deg", shape.turn_deg, example::between(-180.0, 180.0), "degree",
              "angle of a fibre to the one below it");
    file.require("nest", "height", shape.height, example::not_negative(), "length", "height of the lowest fibre above the floor");
    file.require("drum", "radius", shape.drum, example::positive(), "length", "radius of the drum, inside");
    example::read_material(file, "material", material);
    file.require("material", "density", density, example::positive(), "mass/length^3", "density of the fibres");
    file.read("material", "damping", damping, example::not_negative(), "time",
              "time over which strains resist their rate; a mode of angular frequency w is damped by w/2 of it");
    example::read_friction(file, mu, "coefficient of friction of fibres on each other, on the floor and on the drum");
    example::read_reversible_displacement(file, reversible);
    file.require("contact", "line_stiffness", line, example::positive(), "force/length^2",
                 "reaction over depth of fibres along each other, on the floor and on the drum, a unit of length");
    file.require("contact", "crossing_stiffness", crossing, example::positive(), "force/length",
                 "reaction over depth of fibres that cross, and of ends");
    file.read("contact", "damping", restraint, example::not_negative(), "time/length",
              "d: what closes at the speed v pushes 1 + d v times as hard, and what opens less; 0: no impact loses anything");
    example::read_allowed_penetration(file, depth, "how deep fibres may be in each other at the end, over the radius");
    file.require("motion", "gravity", gravity, example::not_negative(), "length/time^2", "acceleration of gravity, downwards");
    file.require("motion", "duration", duration, example::positive(), "time", "how long the fibres move");
    file.read("motion", "steps", steps, example::increments(), "steps of time of the fall, and of the press, if none is cut");
    file.read("motion", "allowed_error_over_radius", error, example::above(0.0, 1.0), "1",
              "local error of a step beyond which it is cut, over the radius");
    file.read(
        "motion", "allowed_loss", loss, example::above(0.0, 1.0), "1",
        "part that the balance of energy of a step may miss beyond which it is cut: of what the step turns from one kind into "
        "another, and of all there is by the step's part of the stage; left out: none is cut for that");
    file.read("motion", "missing_energy", missing, example::above(0.0, 1.0), "1",
              "part of the work that the balance of energy may miss at the end; more fails the run");
    file.read("lid", "mass", shape.lid_mass, example::not_negative(), "mass",
              "mass of a lid that falls onto the nest, with its ram, and stays level; 0: there is none");
    const bool above = file.read("lid", "height", shape.lid_height, example::not_negative(), "length",
                                 "height at which it begins, above the uppermost fibre");
    file.read("press", "force", shape.lid_force, example::not_negative(), "force",
              "force that presses a lid that has fallen, more and more; 0: none does");
    file.read("press", "height", shape.pressed, example::not_negative(), "length",
              "height above the floor to which a lid comes down after the fall; 0: none does");
    const bool timed = file.read("press", "duration", pressing, example::positive(), "time", "how long it takes");
    file.complete();
    material.validate();
    const double ram = density * std::numbers::pi * shape.radius * shape.radius * shape.ram_length();
    file.check(!shape.lid_falls() || shape.lid_mass > ram, "lid", "mass", "> " + core::text(ram) + ", that of its ram, or 0");
    file.check(!above || shape.lid_falls(), "lid", "height", "left out, for no lid.mass");
    file.check(shape.lid_force == 0.0 || shape.lid_falls(), "press", "force", "0, for no lid.mass");
    file.check(shape.pressed == 0.0 || !shape.lid_falls(), "press", "height", "0, for a lid that falls");
    if (shape.pressed > 0.0) {
        file.check(shape.pressed > 2.0 * shape.radius, "press", "height",
                   "> 2 nest.radius = " + core::text(2.0 * shape.radius) + ", or no fibre has room below the lid");
        const double top = gravity > 0.0 ? shape.start(shape.fibres) : shape.start(shape.fibres - 1) + shape.radius;
        file.check(shape.pressed < top, "press", "height",
                   "< " + core::text(top) +
                       (gravity > 0.0 ? ", where the lid begins" : ", the top of the nest, or without gravity nothing moves"));
    }
    shape.lid_weight = shape.lid_falls() ? (shape.lid_mass - ram) * gravity : 0.0;
    const bool presses = shape.pressed > 0.0 || shape.lid_force > 0.0;
    file.check(timed == presses, "press", "duration",
               timed ? "left out, for no lid that presses" : "given, for a lid that presses");
    const double reach = 0.5 * shape.length + shape.radius;  // ends have the radius of the fibre around them
    file.check(shape.drum > reach, "drum", "radius", "> " + core::text(reach) + ", or the fibres are not in it");
    constexpr double widest = 1e6;  // radii of a fibre: of the gap to the wall, and to the floor, ten digits are left
    file.check(shape.drum <= widest * shape.radius, "drum", "radius",
               "<= " + core::text(widest * shape.radius) + ", 1e6 radii of a fibre");
    for (const auto& [section, height] : {std::pair{"nest", shape.height}, std::pair{"lid", shape.lid_height}})
        file.check(height <= widest * shape.radius, section, "height",
                   "<= " + core::text(widest * shape.radius) + ", 1e6 radii of a fibre");
    file.check(gravity > 0.0 || presses, "motion", "gravity", "> 0, or nothing moves");
    file.check(gravity > 0.0 || shape.pressed == 0.0 || std::isnan(loss), "motion", "allowed_loss",
               "left out where a lid comes down without gravity: where it first touches there is no energy to measure a loss by");
    file.check(damping <= duration, "material", "damping", "<= motion.duration = " + core::text(duration));
    if (gravity > 0.0) {
        const double fewest = std::ceil(duration / std::sqrt(2.0 * shape.radius / gravity));
        file.check(static_cast<double>(steps) >= fewest, "motion", "steps",
                   ">= " + core::text(fewest) + ", or a fibre falls from rest by more than its radius in a step");
    }
    // All of what presses, borne by the fibres side by side on the floor.
    const double presses_by = static_cast<double>(shape.fibres) * density * gravity * std::numbers::pi * shape.radius *
                                  shape.radius * shape.length +
                              shape.lid_mass * gravity + shape.lid_force,
                 sudden = 2.0,  // what falls sinks twice as far as what rests, or further
        softest = sudden * presses_by / (static_cast<double>(shape.fibres) * shape.length * shape.radius);
    file.check(line >= softest, "contact", "line_stiffness",
               ">= " + core::text(softest) + ", or weight, lid and press sink fibres into the floor by more than a radius");
    example::require_element(file, "nest", shape.elements, shape.length, shape.radius);
    example::require_room(file, "nest", "fibres", example::unknowns_of(shape.fibres, shape.elements), 6000.0);

    simulation::ModelParameters<Nest> model;
    model.beam.laws = {{.stretch = damping, .bending = damping, .turning = damping}};
    model.normal.law = {.line_stiffness = line, .line_exponent = 1.0, .crossing_stiffness = crossing, .crossing_exponent = 1.0};
    model.normal.damping = restraint;
    model.friction = {.friction_coefficient = mu, .reversible_displacement = reversible * shape.radius};
    model.contact.stiffness.allowed_penetration = depth * shape.radius;
    model.acts.inertia.density = density, model.acts.inertia.allowed_error = error * shape.radius;
    model.acts.inertia.allowed_loss = loss;
    if (shape.lid_falls()) model.acts.inertia.bodies = {{.at = scene::first_end(shape.fibres), .mass = shape.lid_mass - ram}};
    model.acts.gravity.weight = Vec3(0, 0, -density * gravity);
    simulation::Simulator<Nest> simulator(nest(shape, material), model);
    output.open(file);
    simulation::Loading<Nest> loading;
    simulation::Stage<Nest> stage;
    stage.name = "fall", stage.increments = steps, stage.duration = duration;
    // Steps are cut to follow impacts, however few there are of free flight.
    constexpr Index fewest = 2000;
    stage.most_increments = std::max(fewest, 20 * steps);
    loading.most_rejected = std::max(fewest, 10 * steps), loading.smallest_fraction = 0x1p-20;
    stage.ramps = {{.channel = "gravity", .to = 1.0, .at_once = true}};
    loading.stages = {stage};
    if (presses) {
        stage.name = "press", stage.duration = pressing, stage.ramps = {{.channel = "lid", .to = 1.0}};
        loading.stages.push_back(stage);
    }
    output.tell(loading);
    const auto top = [&] {
        double most = 0.0;
        for (Index f = 0; f < shape.fibres; ++f)
            for (const double at : {0.0, 0.5, 1.0}) most = std::max(most, simulator.value({f, at}).z());
        return most;
    };
    const auto& moving = simulator.equilibrium().terms().get<Nest::Motion>();
    const auto motion = [&] { return moving.motion(simulator.state()); };
    const auto lid_height = [&] { return simulator.value(scene::first_end(shape.fibres)).z() - 2.0 * shape.radius; };
    const auto lid_force = [&] { return simulator.contacts().tools().reaction(2).force.z(); };
    example::Recorder recorder(output, shape.radius, [&]() -> std::vector<observe::Column> {
        std::vector<observe::Column> columns{
            {"top", top()}, {"kinetic", motion().kinetic}, {"floor_force", simulator.contacts().tools().reaction(0).force.z()}};
        if (shape.lid_falls()) columns.push_back({"lid_height", lid_height()}), columns.push_back({"lid_force", lid_force()});
        return columns;
    });
    const simulation::Report report = simulator.run(loading, recorder);
    example::write_pictures(output, simulator.snapshot(), -60.0, 25.0);
    const simulation::Audit audit = example::audit(output, simulator, shape.radius);
    const simulation::EnergyBalance& energy = report.energy;
    const double off = energy.error() == 0.0 ? 0.0 : std::abs(energy.error() / energy.external);  // infinite for no work
    const double weight =
        density * gravity * std::numbers::pi * shape.radius * shape.radius * shape.length * static_cast<double>(shape.fibres) +
        shape.lid_mass * gravity;
    const observe::JsonObject summary = example::write_summary(output, report, audit, shape.radius,
                                                               {{"top", top()},
                                                                {"kinetic_energy", motion().kinetic},
                                                                {"weight", weight},
                                                                {"work_of_gravity", energy.external},
                                                                {"lost_in_the_fibres", energy.lost},
                                                                {"dissipated", energy.dissipated},
                                                                {"energy_error", energy.error()},
                                                                {"missed_by_steps", moving.missed()},
                                                                {"allowed_to_miss", moving.may_miss()},
                                                                {"energy_error_over_work", off}});
    example::write_report(output, "fall", summary, simulator.snapshot());
    const bool balanced = off <= missing;
    if (!balanced)
        std::fprintf(stderr,
                     "fall: the balance of energy misses %.1e of the work, more than motion.missing_energy = %g: take "
                     "smaller motion.allowed_error_over_radius\n",
                     off, missing);
    return report.converged && audit.clean() && balanced;
}

}  // namespace

example::Program fall_program() { return {"fall", "Lets a nest of fibres fall into a drum.", solve}; }
