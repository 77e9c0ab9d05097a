// SPDX-License-Identifier: MIT
#pragma once
/// @file What benchmarks of contact share: how deep surfaces may be in each other, a strand that is stretched, and a policy that
/// is run over a range of values.

#include "rods.hpp"

#include <fibrant/compositions/strand/strand.hpp>
#include <fibrant/law/augmented.hpp>
#include <fibrant/observe/svg_plot.hpp>

#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::benchmarks {

/// Multipliers in the place of a penalty alone.
template <beam::BeamElement B>
struct Held : Policy<B> {
    using Normal = law::Augmented<law::RegularisedPenalty>;
};

struct Sample {
    double error = 0.0, seconds = 0.0;
    simulation::Report report;
};

/// What the law may leave between surfaces that touch: the penalty is adapted to it, or is a soft one that multipliers complete.
template <simulation::Model M>
simulation::ModelParameters<M> sinking_by(double penetration) {
    simulation::ModelParameters<M> all;
    if constexpr (law::Augmenting<typename M::Normal>) {
        all.normal = {.law = {.regularisation_depth = 1e-3 * r}, .largest_penetration = penetration};
        all.contact.stiffness.allowed_penetration = 1e-2 * r, all.contact.stiffness.initial_fraction = 0.2;
        all.iteration.multiplier_limit = 40;
    } else {
        all.normal = {.regularisation_depth = 0.1 * penetration};
        all.contact.stiffness.allowed_penetration = penetration;
    }
    return all;
}

/// The same, solved until nothing but the law and the mesh is left of the error.
template <simulation::Model M>
simulation::ModelParameters<M> allowing(double penetration) {
    simulation::ModelParameters<M> all = sinking_by<M>(penetration);
    all.iteration.step_tolerance = 1e-6, all.iteration.residual_tolerance = 1e-6, all.iteration.linear_tolerance = 1e-8;
    all.iteration.normal_tolerance = 1e-4, all.iteration.normal_step_tolerance = 1e-4, all.iteration.contact_tolerance = 1e-4;
    all.iteration.newton_limit = 40;
    return all;
}

/// Lay of 10 degrees, stretched by 0.002 between ends that do not turn (strand_1_6.json, director).
/// @param penalty  that stays as it is, over the stiffness of a section; 0: adapted
template <simulation::Model M>
Sample stretched_strand(double penetration, Index elements, double penalty = 0.0) {
    namespace strand = compositions::strand;
    strand::StrandParameters parameters;
    parameters.core_radius = 0.0215, parameters.layers = {{.wires = 6, .radius = r, .lay_angle_deg = 10.0}};
    parameters.material = {young, 0.3};
    parameters.length = 1.48236252744, parameters.elements = elements;
    Sample sample;
    const double start = processor_time();
    simulation::ModelParameters<M> all = allowing<M>(penetration);
    if (penalty > 0.0) {
        contact::StiffnessAdaptation& stiffness = all.contact.stiffness;
        stiffness.initial_fraction = stiffness.floor_fraction = stiffness.cap_fraction = penalty;
        if constexpr (law::Augmenting<typename M::Normal>) all.iteration.multiplier_limit = 1000;
    }
    simulation::Simulator<M> simulator(strand::straight_strand(parameters), all);
    simulation::Loading<M> loading;
    loading.stages.emplace_back();
    loading.stages.back().ramps = {{strand::stretch, 0.002}, {strand::twist, 0.0}};
    loading.stages.back().increments = 2;
    sample.report = simulator.run(loading);
    sample.seconds = processor_time() - start;
    sample.error = std::abs(strand::measure(simulator, parameters).force / 0.12578578517 - 1.0);
    return sample;
}

inline void print_sweep_header() {
    std::printf("scene,policy,value,error,seconds,penetration_over_radius,newton,contact_passes,converged\n");
}

/// Prints a line of CSV a value, the time a median of repeats, and one with the slopes of log error over log value and over log
/// time.
/// @param run  run(value) gives a Sample; value is a penetration over the radius, a number of elements or another thing that is
/// refined
template <class Run, class Values>
void sweep(const char* scene, const char* policy, const Values& values, const Run& run, int repeats, observe::LogLogPlot& plot) {
    std::vector<std::pair<double, double>> by_time, by_value;
    for (const auto value : values) {
        std::vector<double> times;
        Sample sample;
        for (int k = 0; k < repeats; ++k) {
            sample = run(value);
            times.push_back(sample.seconds);
        }
        const double seconds = median(times);
        std::printf("%s,%s,%g,%.3e,%.3e,%.2e,%ld,%ld,%d\n", scene, policy, static_cast<double>(value), sample.error, seconds,
                    sample.report.contact.greatest_penetration / r, static_cast<long>(sample.report.counts.newton),
                    static_cast<long>(sample.report.counts.contact_passes), sample.report.converged ? 1 : 0);
        std::fflush(stdout);
        if (!sample.report.converged) continue;
        by_time.emplace_back(seconds, sample.error);
        by_value.emplace_back(static_cast<double>(value), sample.error);
    }
    std::printf("%s,%s,order by value and by time,%.2f,%.2f,,,,\n", scene, policy, observe::fitted_order(by_value),
                observe::fitted_order(by_time));
    plot.x_label = "CPU time [s]";
    plot.lines.push_back({policy, by_time});
}

}  // namespace fibrant::benchmarks
