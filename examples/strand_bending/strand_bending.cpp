// SPDX-License-Identifier: MIT
// A strand of 7 to 91 wires with friction is bent to an arc, and back if asked for; prints the moment between its bounds, and the
// time. The wires may yield: [material.law] kind = "wire".
//   strand_bending SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume | --overwrite] [--quiet]
#include "../support/example.hpp"
#include "../support/program.hpp"
#include "../support/report_page.hpp"
#include "../support/usual_keys.hpp"

#include <fibrant/beam/with_law.hpp>
#include <fibrant/compositions/strand/bending.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/material/wire.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

using namespace fibrant;
namespace strand = compositions::strand;

namespace {

/// @tparam Law  of the section of the wires
template <class Law>
struct Strand {
    using Beam = beam::With<beam::DirectorBeam<>, Law>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::FloatBlockCholesky;
};

/// What the scene file asks for.
struct Asked {
    strand::StrandParameters strand;
    strand::Bending bending;
    double radius, mu, depth, reversible, angle, back;  ///< angles in degrees
    Index increments;
};

template <class Law>
bool bend(const Asked& asked, const std::vector<typename beam::With<beam::DirectorBeam<>, Law>::Parameters>& beams,
          example::SceneReader& file, example::Output& output) {
    using Model = Strand<Law>;
    const strand::StrandParameters& parameters = asked.strand;
    const double radius = asked.radius, angle = asked.angle;
    simulation::ModelParameters<Model> model;
    for (const auto& beam : beams) model.beam = beam;
    model.normal.regularisation_depth = 0.5 * asked.depth * radius;
    model.friction = {.friction_coefficient = asked.mu, .reversible_displacement = asked.reversible * radius};
    model.contact.stiffness.allowed_penetration = asked.depth * radius;
    model.iteration.newton_limit = 30;
    model.iteration.margin = 1.0;  // an increment moves the ends of a long strand by more than a radius
    simulation::Simulator<Model> simulator(strand::bent_strand(parameters, asked.bending), model);
    output.open(file);
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        const strand::BendingState state = strand::measure_bending(simulator, parameters, asked.bending);
        return {{"angle_deg", state.angle * 180.0 / std::numbers::pi},
                {"moment", state.moment},
                {"moment_at_plate", state.at_plate},
                {"tension", state.tension},
                {"furthest_from_layer_over_radius", strand::furthest_from_layer(simulator, parameters) / radius},
                {"processor_seconds", example::cpu_seconds()}};
    });
    simulation::Loading<Model> loading;
    const double full = angle * std::numbers::pi / 180.0;
    const auto bend_to = [&](const char* name, double to) {
        simulation::Stage<Model>& stage = loading.stages.emplace_back();
        stage.name = name;
        stage.ramps = {{strand::bend, to}};
        stage.increments = asked.increments, stage.most_increments = 20 * asked.increments;
    };
    if (asked.bending.drawn_at > 0.0) {
        bend_to("drawing", std::copysign(asked.bending.drawn_at, full));
    } else if (asked.bending.strain != 0.0) {
        loading.stages.emplace_back();
        loading.stages.back().name = "drawing";
    }
    bend_to("loading", full);
    if (!std::isnan(asked.back)) bend_to("back", asked.back * std::numbers::pi / 180.0);
    output.tell(loading);
    const simulation::Report report = simulator.run(loading, recorder);
    const strand::BendingState state = strand::measure_bending(simulator, parameters, asked.bending);
    example::write_pictures(output, simulator.snapshot(), -90.0, 10.0);
    const simulation::Audit audit = example::audit(output, simulator, radius);
    const observe::JsonObject summary =
        example::write_summary(output, report, audit, radius,
                               {{"wires", static_cast<double>(parameters.wires())},
                                {"dofs", static_cast<double>(simulator.mesh().layout().unknowns())},
                                {"length_over_radius", parameters.length / radius},
                                {"angle_deg", state.angle * 180.0 / std::numbers::pi},
                                {"moment", state.moment},
                                {"moment_at_plate", state.at_plate},
                                {"tension", state.tension},
                                {"moment_of_loose_wires", strand::loose_stiffness(parameters) * state.angle / parameters.length},
                                {"moment_of_a_solid", strand::solid_stiffness(parameters) * state.angle / parameters.length},
                                {"furthest_from_layer_over_radius", strand::furthest_from_layer(simulator, parameters) / radius},
                                {"lost_in_the_wires", report.energy.lost},
                                {"dissipated", report.energy.dissipated},
                                {"external_work", report.energy.external},
                                {"energy_error", report.energy.error()}});
    example::write_report(output, "strand_bending", summary, simulator.snapshot());
    return report.converged && audit.clean();
}

bool solve(example::SceneReader& file, example::Output& output) {
    Index wires = 7, elements = 0, increments = 30;
    double radius = core::unset, lay_angle = core::unset, turns = 1.0, length = 0.0, angle = 90.0, mu = 0.1, depth = 0.02,
           reversible = 0.1;
    Index inner_layers = -1;
    scene::ElasticMaterial material, inner;
    bool alternate = true;
    std::string anchor = "both_plates", lay = "equal_pitch";
    strand::Bending bending;
    std::string kind = "elastic";
    double back = core::unset, drawn_at = 0.0;
    material::Wire::Parameters yielding;
    example::read_wires(file, wires, radius, lay_angle, "angle of the outer wires to the axis; positive is right-handed");
    file.read("strand", "lay", lay, {"equal_pitch", "equal_angle"},
              "all layers go round once on the same length, or at the same angle");
    file.read("strand", "alternate", alternate, "every other layer has the other hand");
    file.read("strand", "turns", turns, example::between(0.05, 100.0), "1",
              "turns of the outer layer, which give the length of the strand unless `length` says it");
    file.read("strand", "length", length, example::not_negative(), "length", "length of the strand; 0: as `turns` says");
    file.read("strand", "elements", elements, example::between(0, 10000),
              "elements along a wire; 0: sixteen a turn, and none longer than seven radii");
    example::read_material(file, "material", material);
    file.read("inner", "layers", inner_layers, example::between(-1, 5),
              "layers around the core that are of another material, and the core with them; -1: none, nor the core");
    file.read("inner", "young_modulus", inner.young_modulus, example::positive(), "force/length^2", "Young's modulus of these");
    file.read("inner", "poisson_ratio", inner.poisson_ratio, example::poisson_ratio(), "1", "Poisson's ratio of these");
    file.read("material.law", "kind", kind, {"elastic", "wire"}, "how the wires behave");
    file.read("material.law", "yield_stress", yielding.yield_stress, example::positive(), "force/length^2",
              "stress at which a wire yields");
    file.read("material.law", "hardening", yielding.hardening, example::not_negative(), "force/length^2",
              "slope of the yield stress over the plastic strain, kinematic");
    example::read_friction(file, mu, "coefficient of friction of wires on each other");
    example::read_reversible_displacement(file, reversible);
    example::read_allowed_penetration(file, depth);
    file.read("loading", "anchor", anchor, {"both_plates", "near_plate"},
              "which plates hold every wire; elsewhere wires slide through");
    file.read("loading", "strain", bending.strain, example::inside(-0.5, 1.0), "1",
              "strain by which the strand is drawn before it is bent");
    file.read("loading", "drawn_at_deg", drawn_at, example::between(0.0, 3600.0), "degree",
              "angle up to which the strain grows in proportion, in as many increments; 0: it is drawn in one");
    file.read(
        "loading", "guided", bending.guided,
        "the core is led along the arc: an even curvature, where tension would draw the strand straight between its plates");
    file.read("loading", "angle_deg", angle, example::inside(-3600.0, 3600.0), "degree", "angle between the plates at the end");
    file.read("loading", "back_to_deg", back, example::inside(-3600.0, 3600.0), "degree",
              "angle to which it is bent back; left out: not at all");
    file.read("loading", "increments", increments, example::increments(), "increments of the bending");
    file.complete();
    file.check(kind == "elastic" || !std::isnan(yielding.yield_stress), "material.law", "yield_stress",
               "given, for kind = \"wire\"");
    for (const char* key : {"young_modulus", "poisson_ratio"})
        file.check(file.given("inner", key) == (inner_layers >= 0), "inner", key,
                   inner_layers >= 0 ? "given, as inner.layers is" : "left out, for inner.layers = -1");
    file.check(kind == "wire" || !file.given("material.law", "yield_stress"), "material.law", "yield_stress",
               "left out, for kind = \"elastic\"");
    file.check(kind == "wire" || !file.given("material.law", "hardening"), "material.law", "hardening",
               "left out, for kind = \"elastic\"");
    file.check(lay_angle != 0.0, "strand", "lay_angle_deg", "other than 0: straight wires have no turns");
    file.check(elements != 1, "strand", "elements", "0 or >= 2");
    file.check(angle != 0.0, "loading", "angle_deg", "other than 0: nothing would be bent");
    file.check(drawn_at == 0.0 || bending.strain != 0.0, "loading", "drawn_at_deg", "0, as loading.strain is");
    file.check(drawn_at < std::abs(angle), "loading", "drawn_at_deg",
               "< the size of loading.angle_deg = " + core::text(std::abs(angle)));
    file.check(drawn_at == 0.0 || std::isnan(back) || std::copysign(1.0, angle) * back >= drawn_at, "loading", "back_to_deg",
               "on the side of loading.angle_deg and at least loading.drawn_at_deg = " + core::text(drawn_at) +
                   " from 0: nearer to 0 the strand is not drawn");
    bending.drawn_at = drawn_at * std::numbers::pi / 180.0;
    file.check(length == 0.0 || length >= 4.0 * radius, "strand", "length",
               "0 or >= 4 strand.radius = " + core::text(4.0 * radius));
    file.check(length <= 1e5 * radius, "strand", "length", "<= 100000 strand.radius = " + core::text(1e5 * radius));
    file.names(
        {{"StrandParameters.layers[0]: gap between neighbours", "strand.lay_angle_deg is too large: gap between neighbours"},
         {"StrandParameters.", "strand."},
         {"regular_strand.", "strand."},
         {"Layer.", "strand."},
         {"Bending.", "loading."}});
    bending.anchor = anchor == "near_plate" ? strand::Anchor::near_plate : strand::Anchor::both_plates;
    strand::StrandParameters parameters = strand::regular_strand(
        wires, radius, lay_angle, alternate, lay == "equal_angle" ? strand::Lay::equal_angle : strand::Lay::equal_pitch);
    const double pitch = parameters.pitch(parameters.layers.size() - 1);
    file.check(pitch <= 1e5 * radius, "strand", "lay_angle_deg",
               "larger: the outer layer goes round once on " + core::text(pitch) +
                   ", and may on <= 100000 strand.radius = " + core::text(1e5 * radius));
    parameters.material = material;
    if (inner_layers >= 0) {
        file.check(inner_layers <= core::count(parameters.layers), "inner", "layers",
                   "<= " + std::to_string(parameters.layers.size()) + ", the layers that strand.wires has");
        for (std::size_t k = core::at(inner_layers); k < parameters.layers.size(); ++k) parameters.layers[k].material = material;
        parameters.material = inner;
    }
    parameters.length = length > 0.0 ? length : turns * pitch;
    // The wires on the inner side of the arc would have no length left.
    const std::size_t outermost = parameters.layers.size() - 1;
    const double thick = parameters.helix_radius(outermost) + parameters.layers[outermost].radius,
                 sharpest = parameters.length / thick * 180.0 / std::numbers::pi;
    for (const auto& [key, to] : {std::pair{"angle_deg", angle}, std::pair{"back_to_deg", back}})
        file.check(std::isnan(to) || std::abs(to) < sharpest, "loading", key,
                   "less than " + core::text(sharpest) + " either way, at which the radius of the arc is that of the strand");
    // Sixteen a turn follow a helix; wires of opposite hands cross each other every two diameters, and hardly bend in between.
    const double round = length > 0.0 ? length / pitch : turns, sixteen = 16.0 * std::max(turns, round);
    parameters.elements =
        elements > 0 ? elements : static_cast<Index>(std::ceil(std::max({2.0, sixteen, parameters.length / (7.0 * radius)})));
    file.check(static_cast<double>(parameters.elements) >= 4.0 * round, "strand", "elements",
               ">= " + core::text(std::ceil(4.0 * round)) + ", for wires go around " + core::text(round) +
                   " times: an element may not turn by more than 90 degrees");
    example::require_element(file, "strand", parameters.elements, parameters.length, radius);
    example::require_room(file, "strand",
                          elements > 0   ? "elements"
                          : length > 0.0 ? "length"
                                         : "turns",
                          example::unknowns_of(wires, parameters.elements), 6000.0);

    const Asked asked{parameters, bending, radius, mu, depth, reversible, angle, back, increments};
    if (kind == "elastic") return bend<beam::Isotropic>(asked, {}, file, output);
    beam::With<beam::DirectorBeam<>, material::Wire>::Parameters beam;
    beam.laws = {yielding};
    return bend<material::Wire>(asked, {beam}, file, output);
}

}  // namespace

example::Program strand_bending_program() {
    return {"strand_bending", "Bends a strand of helical wires with friction to an arc.", solve};
}
