// SPDX-License-Identifier: MIT
// A strand of helical wires around a core, or a rope of seven such strands, is stretched and turned between two plates; prints
// force and torque.
//   strand SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume | --overwrite] [--quiet]
#include "../support/example.hpp"
#include "../support/program.hpp"
#include "../support/report_page.hpp"
#include "../support/usual_keys.hpp"

#include <fibrant/beam/with_law.hpp>
#include <fibrant/compositions/strand/rope.hpp>
#include <fibrant/law/augmented.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/law/shaped_friction.hpp>
#include <fibrant/material/elastic.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

using namespace fibrant;
namespace strand = compositions::strand;

namespace {

/// @tparam Own  sections and friction obey laws of their own; else sections are isotropic and friction is Coulomb's
template <bool Own>
struct StrandOf {
    using Beam = beam::With<beam::DirectorBeam<>, std::conditional_t<Own, material::Elastic, beam::Isotropic>>;
    using Proximity = proximity::GridSearch;
    using Normal = law::Augmented<law::RegularisedPenalty>;
    using Friction = std::conditional_t<Own, law::ShapedFriction, law::RegularisedCoulomb>;
    using Solver = solver::FloatBlockCholesky;
};

/// What is the same for a strand and a rope.
struct Scene {
    double radius = core::unset, lay = core::unset, length = core::unset, strain = 0.0, rotation = 0.0, mu = 0.0, sinking = 1e-5,
           allowed = 1e-3, depth = 0.1, tolerance = 1e-4, reversible = 0.01;
    Index elements = 40, increments = 4;
    scene::ElasticMaterial material;
    law::FrictionShape friction;
    double step_tolerance() const { return std::min(0.01 * tolerance, 1e-5); }  ///< of Newton's method, over the radius
    bool own_laws() const { return material.transverse.given() || !friction.coulomb(); }
};

template <bool Own, class Parameters>
bool draw_with(const Scene& given, const scene::Assembly& assembly, const Parameters& parameters,
               const example::SceneReader& file, example::Output& output, std::vector<std::pair<std::string, double>> figures) {
    using Strand = StrandOf<Own>;
    const double radius = given.radius;
    simulation::ModelParameters<Strand> model;
    model.normal = {.law = {.regularisation_depth = given.depth * given.allowed * radius},
                    .largest_penetration = given.sinking * radius};
    model.friction = law::friction_parameters<typename Strand::Friction>(given.mu, given.reversible * radius, given.friction);
    model.contact.stiffness.allowed_penetration = given.allowed * radius;
    model.contact.stiffness.initial_fraction = 0.2;
    model.iteration.step_tolerance = model.iteration.residual_tolerance = given.step_tolerance();
    model.iteration.normal_step_tolerance = model.iteration.normal_tolerance = 0.1 * given.tolerance;
    model.iteration.contact_tolerance = given.tolerance, model.iteration.newton_limit = 30;
    simulation::Simulator<Strand> simulator(assembly, model);
    output.open(file);
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        const strand::StrandState state = strand::measure(simulator, parameters);
        return {{"strain", simulator.amplitude(strand::stretch)},
                {"rotation", simulator.amplitude(strand::twist)},
                {"force", state.force},
                {"torque", state.torque}};
    });
    simulation::Loading<Strand> loading;
    loading.stages.resize(1);
    loading.stages[0].ramps = {{strand::stretch, given.strain}, {strand::twist, given.rotation}};
    loading.stages[0].increments = given.increments, loading.stages[0].most_increments = 20 * given.increments;
    output.tell(loading);
    const simulation::Report report = simulator.run(loading, recorder);
    const strand::StrandState state = strand::measure(simulator, parameters);
    example::write_pictures(output, simulator.snapshot(), -60.0, 20.0, std::pair{Index{2}, 0.5 * given.length});
    figures.insert(figures.begin(),
                   {{"force", state.force}, {"torque", state.torque}, {"metal_stiffness", parameters.metal_stiffness()}});
    if (given.strain != 0.0)
        figures.emplace_back("force_over_metal_stiffness_and_strain",
                             state.force / (parameters.metal_stiffness() * given.strain));
    figures.insert(figures.end(), {{"external_work", report.energy.external},
                                   {"dissipated", report.energy.dissipated},
                                   {"energy_error", report.energy.error()}});
    const simulation::Audit audit = example::audit(output, simulator, radius);
    const observe::JsonObject summary = example::write_summary(output, report, audit, radius, figures);
    example::write_report(output, "strand", summary, simulator.snapshot());
    return report.converged && audit.clean();
}

template <class Parameters>
bool draw(const Scene& given, const scene::Assembly& assembly, const Parameters& parameters, const example::SceneReader& file,
          example::Output& output, std::vector<std::pair<std::string, double>> figures) {
    if constexpr (example::has_own_laws)
        if (given.own_laws()) return draw_with<true>(given, assembly, parameters, file, output, std::move(figures));
    return draw_with<false>(given, assembly, parameters, file, output, std::move(figures));
}

bool solve(example::SceneReader& file, example::Output& output) {
    Scene given;
    std::string kind = "isotropic";
    Index wires = 7;
    double core_radius = 0.0, rope_lay = 0.0, apart = 0.0, overlap = 0.0;
    bool alternate = true;
    example::read_wires(file, wires, given.radius, given.lay, "angle of the wires to the axis; positive is right-handed");
    file.require("strand", "length", given.length, example::positive(), "length", "length along the axis");
    file.read("strand", "alternate", alternate, "every other layer has the other hand");
    file.read("strand", "core_radius", core_radius, example::not_negative(), "length",
              "radius of the wire in the middle; 0: as thin as leaves the others room");
    file.read("strand", "elements", given.elements, example::between(2, 10000), "elements along a wire");
    file.read("rope", "lay_angle_deg", rope_lay, example::between(-45.0, 45.0), "degree",
              "angle of the strands to the axis; 0: one strand");
    file.read("rope", "apart_over_radius", apart, example::between(0.0, 1.0), "1",
              "distance between neighbouring strands, over the radius");
    file.read("rope", "overlap_over_radius", overlap, example::between(0.0, 0.5), "1",
              "how deep wires may be in each other at the start, over the radius");
    example::read_material(file, "material", given.material);
    example::read_transverse(file, "material", kind, given.material.transverse);
    example::read_friction(file, given.mu, "coefficient of friction of wires on each other");
    example::read_friction_shape(file, given.friction);
    example::read_reversible_displacement(file, given.reversible);
    file.read("contact", "largest_penetration_over_radius", given.sinking, example::depth_over_radius(), "1",
              "penetration that multipliers leave, over the radius");
    example::read_allowed_penetration(file, given.allowed);
    file.read("contact", "regularisation_over_allowed", given.depth, example::above(0.0, 1.0), "1",
              "depth up to which the penalty is quadratic, over the allowed penetration");
    file.read("contact", "tolerance_over_radius", given.tolerance, example::above(0.0, 0.1), "1",
              "of contact passes; a tenth of it of normals, a hundredth of Newton's steps");
    file.read("loading", "strain", given.strain, example::inside(-0.5, 1.0), "1", "strain at the end");
    file.read("loading", "rotation", given.rotation, example::any_number(), "radian/length",
              "turn at the end; positive tightens a right-handed lay");
    file.read("loading", "increments", given.increments, example::increments(), "increments of the load");
    file.complete();
    example::check_transverse(file, "material", kind);
    example::check_friction_shape(file, given.friction);
    file.check(example::has_own_laws || !given.material.transverse.given(), "material.law", "kind", example::no_own_laws);
    file.check(example::has_own_laws || given.friction.coulomb(), "contact.friction", example::told_shape(file),
               example::no_own_laws);
    file.check(given.sinking >= given.step_tolerance(), "contact", "largest_penetration_over_radius",
               ">= a hundredth of contact.tolerance_over_radius, " + core::text(given.step_tolerance()) +
                   ", to which Newton's steps are solved, or multipliers do not settle");
    const bool roped = rope_lay != 0.0;
    if (roped && wires != 7) file.refuse("strand", "wires", "7 in a rope");
    if (roped && core_radius > 0.0) file.refuse("strand", "core_radius", "left out in a rope, whose cores are found");
    for (const char* key : {"apart_over_radius", "overlap_over_radius"})
        file.check(roped || !file.given("rope", key), "rope", key, "left out, for rope.lay_angle_deg = 0: there is no rope");
    file.check(core_radius <= 4.0 * given.radius, "strand", "core_radius",
               "<= 4 strand.radius = " + core::text(4.0 * given.radius));
    file.check(given.length >= 4.0 * given.radius, "strand", "length", ">= 4 strand.radius = " + core::text(4.0 * given.radius));
    file.check(given.length <= 1e5 * given.radius, "strand", "length",
               "<= 100000 strand.radius = " + core::text(1e5 * given.radius));
    const double turns = given.length * (std::abs(std::tan(given.lay * std::numbers::pi / 180.0)) / (2.0 * given.radius)) /
                         (2.0 * std::numbers::pi);
    file.check(static_cast<double>(given.elements) >= 4.0 * turns, "strand", "elements",
               ">= " + core::text(std::ceil(4.0 * turns)) + ", for wires go around " + core::text(turns) +
                   " times: an element may not turn by more than 90 degrees");
    file.check(std::abs(given.rotation) * given.length <= 200.0 * std::numbers::pi, "loading", "rotation",
               "such that the ends turn by at most 100 turns against each other, <= " +
                   core::text(200.0 * std::numbers::pi / given.length));
    // By no more than loading.strain may do to a straight wire.
    const auto check_rotation = [&](double helix_radius, double turn_rate) {
        const double drawn = std::hypot(1.0 + given.strain, helix_radius * (turn_rate + given.rotation)) /
                             std::hypot(1.0, helix_radius * turn_rate);
        file.check(given.rotation == 0.0 || drawn < 2.0, "loading", "rotation",
                   "such that no wire is drawn to twice its length, and one is to " + core::text(drawn) + " times");
    };
    file.check(given.strain != 0.0 || given.rotation != 0.0, "loading", "strain",
               "other than 0 where loading.rotation is 0: nothing would be done");
    example::require_element(file, "strand", given.elements, given.length, given.radius);
    example::require_room(file, "strand", "elements", example::unknowns_of(roped ? 49 : wires, given.elements), 6000.0);
    file.names({{"RopeParameters: least gap", "rope.overlap_over_radius is too small: the least gap"},
                {"StrandParameters.layers[0]: gap between neighbours",
                 core_radius > 0.0 ? "strand.core_radius is too small: gap between neighbours"
                                   : "strand.lay_angle_deg is too large: gap between neighbours"},
                {"StrandParameters.", "strand."},
                {"RopeParameters.", "strand."},
                {"regular_strand.", "strand."},
                {"Layer.", "strand."}});
    if (rope_lay == 0.0) {
        strand::StrandParameters parameters = strand::regular_strand(wires, given.radius, given.lay, alternate);
        if (core_radius > 0.0) parameters.core_radius = core_radius;
        for (std::size_t k = 0; k < parameters.layers.size(); ++k)
            check_rotation(parameters.helix_radius(k), parameters.turn_rate(k));
        parameters.length = given.length, parameters.elements = given.elements, parameters.material = given.material;
        return draw(given, strand::straight_strand(parameters), parameters, file, output, {});
    }
    strand::RopeParameters rope =
        strand::rope_of_seven(given.radius, given.lay, rope_lay, given.length, apart * given.radius, overlap * given.radius);
    rope.elements = given.elements, rope.material = given.material;
    for (const strand::StrandLayer& layer : rope.layers)
        check_rotation(layer.helix_radius, std::tan(layer.lay()) / layer.helix_radius);
    const strand::RopeStiffness sliding = strand::stiffness_bound(rope), stuck = strand::stiffness_bound(rope, true);
    return draw(
        given, strand::straight_rope(rope), rope, file, output,
        {{"least_gap_at_the_start_over_radius", strand::least_gap(rope) / given.radius},
         {"helix_radius_over_radius", rope.layers[0].helix_radius / given.radius},
         {"core_strand_wires_over_radius", rope.core.layers[0].radius / given.radius},
         {"greatest_force", given.strain * sliding.force_by_strain + given.rotation * sliding.torque_by_strain},
         {"torque_of_sliding_wires", given.strain * sliding.torque_by_strain + given.rotation * sliding.torque_by_rotation},
         {"greatest_force_if_stuck", given.strain * stuck.force_by_strain + given.rotation * stuck.torque_by_strain},
         {"torque_of_stuck_wires", given.strain * stuck.torque_by_strain + given.rotation * stuck.torque_by_rotation}});
}

}  // namespace

example::Program strand_program() {
    return {"strand", "Stretches and turns a strand of helical wires around a core, or a rope of seven strands.", solve};
}
