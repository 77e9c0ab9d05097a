// SPDX-License-Identifier: MIT
// Fibres of a tow, one above the other, are pressed between two plates: carbon is fifteen times as soft across as along, so that
// sections flatten where isotropic ones would not. Prints the load a unit of length, and that of the closed form.
//   tow SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume | --overwrite] [--quiet]
#include "../support/example.hpp"
#include "../support/program.hpp"
#include "../support/report_page.hpp"
#include "../support/usual_keys.hpp"
#include "stack.hpp"

#include <fibrant/beam/with_law.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/material/elastic.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/simulator.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>

#include <cmath>
#include <numbers>
#include <string>

using namespace fibrant;

namespace {

struct Tow {
    using Beam = beam::With<beam::DirectorBeam<>, material::Elastic>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::FloatBlockCholesky;
    using Tools = contact::RigidTools;
};

bool solve(example::SceneReader& file, example::Output& output) {
    Index fibres = 4, elements = 2, increments = 5;
    double radius = core::unset, length = core::unset, compression = 0.02, mu = 0.2, depth = core::unset;
    scene::ElasticMaterial material;
    std::string kind = "isotropic";
    file.read("tow", "fibres", fibres, example::between(1, 1000), "fibres, one above the other");
    file.require("tow", "radius", radius, example::positive(), "length", "radius of a fibre");
    file.require("tow", "length", length, example::positive(), "length", "length of the fibres");
    file.read("tow", "elements", elements, example::between(1, 10000), "elements along a fibre");
    file.require("material", "young_modulus", material.young_modulus, example::positive(), "force/length^2",
                 "Young's modulus along the fibres");
    file.require("material", "poisson_ratio", material.poisson_ratio, example::inside(-10.0, 10.0), "1",
                 "contraction across under tension along");
    example::read_transverse(file, "material", kind, material.transverse);
    example::read_friction(file, mu, "coefficient of friction of fibres on each other and on the plates");
    const bool given = file.read("contact", "allowed_penetration_over_radius", depth, example::depth_over_radius(), "1",
                                 "how deep a contact may be, over the radius; left out: a twentieth of loading.compression");
    file.read("loading", "compression", compression, {.low = 1e-6, .high = 0.2, .below = true}, "1",
              "compression at the end, over the height at the start");
    file.read("loading", "increments", increments, example::increments(), "increments of the pressing");
    file.complete();
    example::check_transverse(file, "material", kind);
    file.names({{"ElasticMaterial.poisson_ratio", "material.poisson_ratio"}});
    material.validate();
    // What contacts give way, sections do not: each fibre is to be flattened by 2 r compression.
    if (!given) depth = 0.05 * compression;
    constexpr double deepest = 0.1, shallowest = 1e-3;  // of the compression
    file.check(
        depth <= deepest * compression, "contact", "allowed_penetration_over_radius",
        "<= a tenth of loading.compression = " + core::text(deepest * compression) + ", or contacts give way and not the fibres");
    file.check(
        depth >= shallowest * compression, "contact", "allowed_penetration_over_radius",
        ">= a thousandth of loading.compression = " + core::text(shallowest * compression) + ": no contact is stiffer than that");
    file.check(length <= 1e5 * radius, "tow", "length", "<= 100000 tow.radius = " + core::text(1e5 * radius));
    example::require_element(file, "tow", elements, length, radius);
    // In longer elements a fibre swells at its nodes where the next one shrinks, and neither is flattened where its strains are
    // taken: only shear resists, less the longer they are. Found at 13.8 radii for a compression of 0.02, and at 22 for carbon:
    // 3.1 of this root.
    constexpr double longest = 3.0;
    const double most = longest * radius * std::sqrt(material.shear_modulus() / (material.section_modulus() * compression)),
                 fewest = std::ceil(length / most);
    file.check(fibres == 1 || static_cast<double>(elements) >= fewest, "tow", "elements",
               ">= " + core::text(fewest) + ", or elements are longer than " + core::text(most) +
                   " and swell in turn where they ought to be flattened");
    example::require_room(file, "tow", "fibres", example::unknowns_of(fibres, elements), 6000.0);

    simulation::ModelParameters<Tow> model;
    model.normal.regularisation_depth = 0.5 * depth * radius;
    model.friction = {.friction_coefficient = mu, .reversible_displacement = 0.02 * radius};
    model.contact.stiffness.allowed_penetration = depth * radius;
    model.contact.stiffness.cap_fraction = 1e3;  // so stiff that what gives way is the sections
    simulation::Simulator<Tow> simulator(
        example::stacked(fibres, radius, length, elements, material, compression * 2.0 * radius * static_cast<double>(fibres)),
        model);
    output.open(file);
    const auto line_load = [&] { return simulator.contacts().tools().reaction(1).force.y() / length; };
    // q 2 r = A S_22 for opposite line loads on a section that stays an ellipse.
    const auto closed = [&](double progress) {
        return 0.5 * std::numbers::pi * material.section_modulus() * radius * compression * progress;
    };
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        const double progress = simulator.amplitude("press");
        return {{"compression", compression * progress}, {"line_load", line_load()}, {"line_load_of_sections", closed(progress)}};
    });
    simulation::Loading<Tow> loading;
    simulation::Stage<Tow> stage;
    stage.name = "press", stage.increments = increments, stage.most_increments = 20 * increments, stage.ramps = {{"press", 1.0}};
    // What nothing touches yet is held by its own section's stiffness, a thousandth of it.
    stage.damping = 1e-3 * material.section_modulus() * length / static_cast<double>(elements), stage.damping_decay = 0.1;
    loading.stages = {stage};
    output.tell(loading);
    const simulation::Report report = simulator.run(loading, recorder);
    example::write_pictures(output, simulator.snapshot(), -60.0, 25.0);
    const simulation::Audit audit = example::audit(output, simulator, radius);
    const observe::JsonObject summary = example::write_summary(output, report, audit, radius,
                                                               {{"line_load", line_load()},
                                                                {"line_load_of_sections", closed(1.0)},
                                                                {"section_modulus", material.section_modulus()},
                                                                {"energy_error", report.energy.error()},
                                                                {"external_work", report.energy.external}});
    example::write_report(output, "tow", summary, simulator.snapshot());
    return report.converged && audit.clean();
}

}  // namespace

example::Program tow_program() { return {"tow", "Presses a stack of fibres that are softer across than along.", solve}; }
