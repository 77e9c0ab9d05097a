// SPDX-License-Identifier: MIT
// Moment against curvature of an overhead conductor of 61 wires ("Cardinal", 1 + 6 of steel, 12 + 18 + 24 of aluminium) under a tension of
// 40 kN, against the measured curve of Foti and Martinelli (2018; data/conductor_bending.csv says where its points come from). One lay of the
// conductor between two plates that hold every wire: over a whole lay nothing slides along the ends of an endless one either.
// Nothing is fitted. Not known of the test: friction (0.3 to 0.9 is tried) and the lay, 500 mm here for all layers, whose hands are
// opposite in turn.
// usage: benchmark_validation_conductor DATA.csv [friction [elements [penetration [reversible]]]] > curve.csv; the last two over a wire's radius
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/strand/bending.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/observe/svg_curves.hpp>
#include <fibrant/observe/text_file.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/audit.hpp>
#include <fibrant/simulation/simulator.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

using namespace fibrant;
namespace strand = compositions::strand;

namespace {

struct Conductor {
    using Beam = beam::DirectorBeam<>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::FloatBlockCholesky;
};

constexpr double lay = 500.0, tension = 40e3;  // mm, N
constexpr double most_curvature = 0.5;         // 1/m

/// Lengths in mm, forces in N.
strand::StrandParameters cardinal(Index elements) {
    const scene::ElasticMaterial steel{207e3, 0.3}, aluminium{68e3, 0.33};
    strand::StrandParameters conductor;
    conductor.core_radius = 1.67, conductor.material = steel, conductor.length = lay, conductor.elements = elements;
    for (Index k = 0; k < 4; ++k) {
        strand::Layer layer;
        layer.wires = 6 * (k + 1), layer.radius = k == 0 ? 1.67 : 1.66;
        if (k > 0) layer.material = aluminium;
        conductor.layers.push_back(layer);
        const std::size_t own = conductor.layers.size() - 1;
        const auto turn = [&] {
            const double angle = std::atan(2.0 * std::numbers::pi * conductor.helix_radius(own) / lay) * 180.0 / std::numbers::pi;
            conductor.layers[own].lay_angle_deg = k % 2 == 0 ? angle : -angle;
        };
        // Six wires of one radius around a seventh need a little more room once they are laid.
        for (turn(); conductor.neighbour_gap(own) < 0.0; turn()) conductor.layers[own].clearance += 1e-4 * layer.radius;
    }
    return conductor;
}

/// Moment of a curve at a curvature, between its points.
double moment_at(const std::vector<std::pair<double, double>>& curve, double curvature) {
    for (std::size_t k = 1; k < curve.size(); ++k)
        if (curvature <= curve[k].first) {
            const double share = (curvature - curve[k - 1].first) / (curve[k].first - curve[k - 1].first);
            return curve[k - 1].second + share * (curve[k].second - curve[k - 1].second);
        }
    return curve.empty() ? core::unset : curve.back().second;
}

std::vector<std::pair<double, double>> read_curve(const std::string& path) {
    std::istringstream lines(observe::read_file(path));
    std::vector<std::pair<double, double>> curve;
    for (std::string line; std::getline(lines, line);) {
        double curvature = 0.0, moment = 0.0;
        if (std::sscanf(line.c_str(), "%lf,%lf", &curvature, &moment) == 2) curve.emplace_back(curvature, moment);
    }
    return curve;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) return std::fprintf(stderr, "usage: %s DATA.csv [friction [elements [penetration [reversible]]]]\n", argv[0]), 2;
    const auto given = [&](int place, double otherwise) { return argc > place ? std::atof(argv[place]) : otherwise; };
    const double friction = given(2, 0.7), depth = given(4, 2e-3), reversible = given(5, 1e-3), radius = 1.66;
    const strand::StrandParameters conductor = cardinal(static_cast<Index>(given(3, 48)));
    std::vector<std::pair<double, double>> measured = read_curve(argv[1]), computed;

    double cosines = conductor.material.young_modulus * std::pow(conductor.core_radius, 2);
    for (const strand::Layer& layer : conductor.layers)
        cosines += conductor.material_of(layer).young_modulus * static_cast<double>(layer.wires) * layer.radius * layer.radius *
                   std::pow(std::cos(layer.lay_angle_deg * std::numbers::pi / 180.0), 3);
    const strand::Bending bending{.strain = tension / (std::numbers::pi * cosines)};

    simulation::ModelParameters<Conductor> model;
    model.normal.regularisation_depth = 0.5 * depth * radius;
    model.friction = {.friction_coefficient = friction, .reversible_displacement = reversible * radius};
    model.contact.stiffness.allowed_penetration = depth * radius;
    model.iteration.newton_limit = 30;
    model.iteration.margin = 1.0;
    simulation::Simulator<Conductor> simulator(strand::bent_strand(conductor, bending), model);
    simulation::Loading<Conductor> loading;
    loading.stages.resize(2);
    loading.stages[0].name = "drawing", loading.stages[0].increments = 4;
    loading.stages[1].name = "bending", loading.stages[1].increments = 40, loading.stages[1].most_increments = 400;
    loading.stages[1].ramps = {{strand::bend, 1e-3 * most_curvature * lay}};
    struct Follow {
        const simulation::Simulator<Conductor>& simulator;
        const strand::StrandParameters& conductor;
        const strand::Bending& bending;
        const std::vector<std::pair<double, double>>& measured;
        std::vector<std::pair<double, double>>& computed;
        void accepted(const observe::Snapshot& snapshot) {
            const strand::BendingState state = strand::measure_bending(simulator, conductor, bending);
            const double curvature = 1e3 * state.angle / lay, moment = 1e-3 * state.moment;  // 1/m, N m
            if (snapshot.stage == "bending") computed.emplace_back(curvature, moment);
            std::printf("%s,%.6g,%.6g,%.6g,%.6g\n", snapshot.stage.c_str(), curvature, moment,
                        curvature > 0.0 ? moment_at(measured, curvature) : 0.0, state.tension);
            std::fflush(stdout);
        }
        void gave_up(const simulation::FailedAttempt& attempt) const {
            std::fprintf(stderr, "increment %td of %s, %g of it, %td iterations, %.0f s: %s\n", attempt.number, attempt.stage.c_str(), attempt.fraction,
                         attempt.newton, attempt.seconds, attempt.reason.c_str());
        }
    } follow{simulator, conductor, bending, measured, computed};
    std::printf("# friction %g, %td elements, penetration %g and reversible displacement %g radii; all stuck %.0f N m^2, all loose %.1f N m^2\n",
                friction, conductor.elements, depth, reversible, 1e-6 * strand::solid_stiffness(conductor), 1e-6 * strand::loose_stiffness(conductor));
    std::printf("stage,curvature_1_per_m,moment_N_m,measured_N_m,tension_N\n");
    const simulation::Report report = simulator.run(loading, follow);
    std::printf("# converged %d %s; audit clean %d; %td increments, %td Newton iterations, %.0f s\n", report.converged, report.reason.c_str(),
                simulation::audit(simulator).clean(), core::count(report.increments), report.counts.newton, report.wall_seconds);
    observe::CurvePlot plot{.title = "Cardinal conductor, 40 kN", .x_label = "curvature [1/m]", .y_label = "moment [N m]", .lines = {}};
    plot.lines = {{"measured", measured}, {"computed, friction " + core::text(friction), computed}};
    observe::write_file("conductor_bending.svg", observe::curves_svg(plot));
    return report.converged ? 0 : 1;
}
