// SPDX-License-Identifier: MIT
// A small mat between plates: what both plates feel, where fibres are, and what became of the work.
#include <compositions/bundle_model.hpp>
#include <fibrant/compositions/mat/compaction.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

using namespace fibrant;

namespace compaction_test {

namespace mat = compositions::mat;

using Mat = test::Bundle;

TEST_CASE("a mat that is pressed carries more and more, feels both plates alike, and stays in its box") {
    mat::MatParameters parameters{.radius = 0.02,
                                  .length = 0.5,
                                  .width = 0.62,
                                  .height = 0.3,
                                  .fibres = 24,
                                  .tilt_deg = 20.0,
                                  .material = {7300.0, 0.2},
                                  .elements = 5};
    const double r = parameters.radius, last = 0.17;
    const mat::PressParameters press{.height = last, .increments = 30};
    auto model = mat::model_parameters<Mat>(parameters, press);
    model.solver.strategy = test::bundle_solver;
    simulation::Simulator<Mat> simulator(mat::boxed_mat(parameters, mat::random_fibres(parameters)), model);
    const simulation::Loading<Mat> loading = mat::pressing<Mat>(parameters, press);
    std::vector<mat::MatState> states;
    struct Observer {
        const simulation::Simulator<Mat>& simulator;
        const mat::MatParameters& parameters;
        std::vector<mat::MatState>& states;
        void reported(const simulation::IncrementReport&) const { states.push_back(mat::measure(simulator, parameters)); }
    } observer{simulator, parameters, states};
    const simulation::Report report = simulator.run(loading, observer);
    REQUIRE_MESSAGE(report.converged, report.reason);
    const mat::MatState end = states.back();
    const mat::MatState& middle = *std::find_if(states.begin(), states.end(), [&](const mat::MatState& state) {
        return state.volume_fraction > 0.6 * end.volume_fraction;
    });
    std::printf(
        "mat: %zu increments, fraction %.3f, pressure %.3e and %.3e of the modulus, %.2f contacts a fibre (%.2f without bulk)\n",
        states.size(), end.volume_fraction, end.pressure / 7300.0, end.lower_pressure / 7300.0, end.contacts_per_fibre,
        end.contacts_without_bulk);
    CHECK(end.volume_fraction == test::near(24.0 * std::numbers::pi * r * r * 0.5 / (0.62 * 0.62 * last), 1e-12));
    std::printf("pressure at %.3f: %.3e\n", middle.volume_fraction, middle.pressure / 7300.0);
    CHECK(end.pressure > std::pow(1.0 / 0.6, 3) * middle.pressure);  // van Wyk's cube; a threshold makes it steeper
    CHECK(middle.pressure >= 0.0);
    // Walls are smooth, so what the plates feel differs by what damping takes, springs to where fibres were, in full:
    CHECK(end.pressure > end.lower_pressure);
    CHECK(end.pressure - end.lower_pressure < 0.25 * end.pressure);
    // Bulk keeps fibres from crossing wherever they would; four contacts hold a fibre that friction holds, about (Maxwell: more
    // without).
    CHECK(end.contacts_per_fibre > 2.0);
    CHECK(end.contacts_per_fibre < end.contacts_without_bulk);
    double outside = -1e300, nearest = 1e300;
    const auto& mesh = simulator.mesh();
    std::vector<std::vector<Vec3>> lines;
    for (Index f = 0; f < mesh.fibre_count(); ++f) {
        std::vector<Vec3> line;
        for (Index k = 0; k <= 80; ++k) line.push_back(mesh.position(simulator.state(), f, static_cast<double>(k) / 16.0));
        for (const Vec3& x : line)
            outside = std::max({outside, r - x.minCoeff(), x.head<2>().maxCoeff() + r - 0.62, x.z() + r - last});
        lines.emplace_back(line.begin() + 4, line.end() - 4);  // ends are flat, and have no cap: a radius less at either
    }
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            for (std::size_t a = 1; a < lines[i].size(); ++a)
                for (std::size_t b = 1; b < lines[j].size(); ++b)
                    nearest = std::min(nearest, proximity::segment_distance(lines[i][a - 1], lines[i][a] - lines[i][a - 1],
                                                                            lines[j][b - 1], lines[j][b] - lines[j][b - 1])
                                                    .squared);
    std::printf("deepest in a wall %.4f radii, in each other %.4f, contact says %.4f\n", outside / r,
                2.0 - std::sqrt(nearest) / r, report.contact.greatest_penetration / r);
    // Depths are those that contact knows of, which may be more than allowed while the stiffness has yet to grow, and what
    // sections give way.
    CHECK(report.contact.greatest_penetration < 0.2 * r);
    CHECK(outside <
          report.contact.greatest_penetration + 0.05 * r);  // an end that is slanted by less than 0.3 is a disc to a plate
    CHECK(2.0 * r - std::sqrt(nearest) < report.contact.greatest_penetration + 0.02 * r);
    CHECK(report.energy.dissipated > 0.0);
    CHECK(end.elastic_energy > 0.0);
    CHECK(end.elastic_energy < report.energy.external);
}

}  // namespace compaction_test
