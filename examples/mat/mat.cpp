// SPDX-License-Identifier: MIT
// Random fibres in a box are compacted by a plate; prints pressure and contacts by volume fraction, beside those of theory.
//   mat SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume | --overwrite] [--quiet]
#include "../support/example.hpp"
#include "../support/program.hpp"
#include "../support/report_page.hpp"
#include "../support/usual_keys.hpp"

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/mat/compaction.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>

#include <cmath>

using namespace fibrant;
namespace mat = compositions::mat;

namespace {

struct Mat {
    using Beam = beam::DirectorBeam<>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::FloatBlockCholesky;
    using Tools = contact::RigidTools;
};

bool solve(example::SceneReader& file, example::Output& output) {
    mat::MatParameters parameters;
    mat::PressParameters press;
    Index seed = 1;
    file.require("mat", "radius", parameters.radius, example::positive(), "length", "radius of a fibre");
    file.require("mat", "length", parameters.length, example::positive(), "length", "length of a fibre");
    file.require("mat", "width", parameters.width, example::positive(), "length", "width of the box along x and y");
    file.require("mat", "height", parameters.height, example::positive(), "length", "height of the box at the start");
    file.require("mat", "fibres", parameters.fibres, example::between(1, 1000000), "fibres in the box");
    file.read("mat", "bend_deg", parameters.bend_deg, example::between(0.0, 180.0), "degree",
              "by which fibres turn from end to end, at rest");
    example::read_random_fibres(file, parameters.tilt_deg, parameters.elements, "elements along a fibre");
    example::read_seed(file, seed);
    example::read_material(file, "material", parameters.material);
    example::read_friction(file, press.friction_coefficient, "coefficient of friction of fibres on each other");
    example::read_allowed_penetration(file, press.allowed_penetration);
    file.require("loading", "height", press.height, example::positive(), "length", "height to which the mat is compacted");
    file.read("loading", "increments", press.increments, example::increments(), "increments of the pressing");
    file.read("loading", "damping", press.damping, example::above(0.0, 1e6), "1",
              "stiffness of the damping, over what bends a tenth of a fibre, or a diameter of it");
    file.read("loading", "looseness", press.looseness, example::looseness(), "1", "factor on the tolerances of passes");
    file.read("solver", "overshoot", press.overshoot, {.low = 0.0, .high = 1e6, .above = true, .endless = true}, "1",
              "Newton's step is cut where the energy rises at its end by more than this part of the slope at which it fell");
    file.complete();
    file.check(2.0 * parameters.radius < parameters.width, "mat", "width",
               "> 2 mat.radius = " + core::text(2.0 * parameters.radius));
    file.check(2.0 * parameters.radius < parameters.height, "mat", "height",
               "> 2 mat.radius = " + core::text(2.0 * parameters.radius));
    file.check(parameters.length >= 2.0 * parameters.radius, "mat", "length",
               ">= 2 mat.radius = " + core::text(2.0 * parameters.radius));
    const double across = parameters.width - 2.0 * parameters.radius, up = parameters.height - 2.0 * parameters.radius,
                 diagonal = std::hypot(across, across, up);
    file.check(parameters.bend_deg > 0.0 || parameters.length <= diagonal, "mat", "length",
               "<= " + core::text(diagonal) + ", the diagonal of the box, a radius from its sides");
    file.check(parameters.length <= 1e5 * parameters.radius, "mat", "length",
               "<= 100000 mat.radius = " + core::text(1e5 * parameters.radius));
    file.check(parameters.width <= 1e5 * parameters.radius, "mat", "width",
               "<= 100000 mat.radius = " + core::text(1e5 * parameters.radius));
    file.check(parameters.height <= 1e5 * parameters.radius, "mat", "height",
               "<= 100000 mat.radius = " + core::text(1e5 * parameters.radius));
    file.check(press.height < parameters.height, "loading", "height", "below mat.height = " + core::text(parameters.height));
    file.check(press.height > 2.0 * parameters.radius, "loading", "height",
               "> 2 mat.radius = " + core::text(2.0 * parameters.radius));
    file.check(static_cast<double>(parameters.elements) >= parameters.bend_deg / 90.0, "mat", "elements",
               ">= 2: an element may not turn by more than 90 degrees");
    const double filled = parameters.volume_fraction(parameters.height);
    file.check(filled < 0.9, "mat", "fibres",
               "< " + core::text(std::ceil(0.9 * static_cast<double>(parameters.fibres) / filled)) +
                   ", which fill nine tenths of the box");
    const double pressed = parameters.volume_fraction(press.height), least = parameters.height * filled / 0.9;
    file.check(pressed < 0.9, "loading", "height", "> " + core::text(least) + ", at which fibres fill nine tenths of the box");
    example::require_element(file, "mat", parameters.elements, parameters.length, parameters.radius);
    example::require_room(file, "mat", "fibres", example::unknowns_of(parameters.fibres, parameters.elements), 6000.0);
    file.names({{"MatParameters.", "mat."},
                {"PressParameters.allowed_penetration", "contact.allowed_penetration_over_radius"},
                {"PressParameters.friction_coefficient", "contact.friction_coefficient"},
                {"PressParameters.overshoot", "solver.overshoot"},
                {"PressParameters.", "loading."}});
    parameters.seed = static_cast<std::uint64_t>(seed);

    const double radius = parameters.radius;
    const auto model = mat::model_parameters<Mat>(parameters, press);
    simulation::Simulator<Mat> simulator(mat::boxed_mat(parameters, mat::random_fibres(parameters)), model);
    output.open(file);
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        const mat::MatState state = mat::measure(simulator, parameters);
        return {{"height", state.height},
                {"volume_fraction", state.volume_fraction},
                {"pressure_over_modulus", state.pressure / parameters.material.young_modulus},
                {"lower_pressure_over_modulus", state.lower_pressure / parameters.material.young_modulus},
                {"contacts_per_fibre", state.contacts_per_fibre},
                {"contacts_without_bulk", state.contacts_without_bulk},
                {"sine", state.sine}};
    });
    simulation::Loading<Mat> loading = mat::pressing<Mat>(parameters, press);
    output.tell(loading);
    const simulation::Report report = simulator.run(loading, recorder);
    const mat::MatState state = mat::measure(simulator, parameters);
    example::write_pictures(output, simulator.snapshot(), -60.0, 25.0);
    const simulation::Audit audit = example::audit(output, simulator, radius);
    const observe::JsonObject summary = example::write_summary(output, report, audit, radius,
                                                               {{"volume_fraction", state.volume_fraction},
                                                                {"pressure", state.pressure},
                                                                {"lower_pressure", state.lower_pressure},
                                                                {"contacts_per_fibre", state.contacts_per_fibre},
                                                                {"contacts_without_bulk", state.contacts_without_bulk}});
    example::write_report(output, "mat", summary, simulator.snapshot());
    return report.converged && audit.clean();
}

}  // namespace

example::Program mat_program() { return {"mat", "Compacts a mat of random fibres in a box.", solve}; }
