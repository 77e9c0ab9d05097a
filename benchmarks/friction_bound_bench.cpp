// SPDX-License-Identifier: MIT
// What does it cost to keep the tangent of friction symmetric? Small weaves are settled at two coefficients with the reaction
// that bounds friction held within Newton (symmetric: conjugate gradients), and following it: with the symmetric part of
// that tangent only, and with all of it (BiCGStab). Prints CSV.
// usage: benchmark_friction_bound_bench [fibres a tow [looseness]]; default 19 and 1000, as weaves settle
//   looseness  of normal and contact passes on the way: 1 makes every increment settle what its friction is bounded by
#include "chapter_fabric.hpp"

#include <fibrant/compositions/weave/measures.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

#include <cstdio>
#include <cstdlib>

using namespace fibrant;
namespace cloth = compositions::weave;

int main(int argc, char** argv) {
    using Weave = benchmarks::SettledWeave<solver::TwoLevelPcg>;
    const Index fibres = argc > 1 ? std::atol(argv[1]) : 19;
    struct Variant {
        const char* name;
        contact::FrictionBound bound;
        bool unsymmetric;
    };
    std::printf(
        "friction_coefficient,bound,tangent,converged,increments,rejected,normal_passes,newton,linear_iterations,indefinite,"
        "seconds,crimp,why\n");
    for (const double coefficient : {0.15, 0.5}) {
        for (const Variant& variant : {Variant{"held,symmetric", contact::FrictionBound::held, false},
                                       Variant{"following,symmetric part", contact::FrictionBound::following, false},
                                       Variant{"following,whole", contact::FrictionBound::following, true}}) {
            const cloth::FabricParameters fabric = benchmarks::chapter_fabric("plain", 2, fibres);
            cloth::SettleParameters settle;
            settle.friction_coefficient = coefficient;
            if (argc > 2) settle.looseness = std::atof(argv[2]);
            auto parameters = cloth::model_parameters<Weave>(fabric, settle);
            parameters.contact.friction_bound = variant.bound;
            parameters.solver.unsymmetric = variant.unsymmetric;
            simulation::Simulator<Weave> simulator(cloth::flat_fabric(fabric, settle.tension_strain), parameters);
            const simulation::Report report = simulator.run(cloth::settling<Weave>(fabric, settle));
            std::printf("%g,%s,%d,%zu,%td,%td,%td,%td,%td,%.2f,%.5f,%s\n", coefficient, variant.name, report.converged ? 1 : 0,
                        report.increments.size(), report.rejected_increments, report.counts.normal_passes, report.counts.newton,
                        report.counts.linear_iterations, report.counts.indefinite, report.wall_seconds,
                        cloth::crimp_measures(simulator.snapshot(), fabric).warp, report.reason.c_str());
            std::fflush(stdout);
        }
    }
    return 0;
}
