// SPDX-License-Identifier: MIT
// Two crossed layers of eight fibres with friction, pressed into each other by a radius and then dragged across each other by
// 0.56: forces on the upper layer's ends at rest and CPU time, with ours and with Yade's beams (Debian's yade; yade_layers.py
// beside this file), side by side. Prints CSV, times counted from the start of the press. Without a program `yade` in the path,
// ours alone. usage: benchmark_accuracy_yade_bench [path of yade_layers.py [elements of Yade]]; default
// benchmarks/accuracy/yade_layers.py and 25
#include "rods.hpp"

#include <fibrant/beam/rigid_section_rod.hpp>

#include <cstdio>
#include <cstdlib>
#include <string>

using namespace fibrant;
using namespace fibrant::benchmarks;

namespace {

constexpr double pressed = 1.0, dragged_x = 0.5, dragged_y = 0.25, friction = 0.2;  // ways in radii
constexpr Index layer = 8;

/// An odd number of elements puts no node on a crossing.
scene::Assembly layers(Index elements) {
    scene::Assembly assembly;
    const double length = 1.2, pitch = 0.12;
    for (const bool upper : {false, true})
        for (Index k = 0; k < layer; ++k) {
            const double aside = (static_cast<double>(k) - 3.5) * pitch, z = upper ? 2.0 * r : 0.0;
            scene::FibreSpecification fibre = along_z(1.0, elements);
            fibre.from = upper ? Vec3(-0.5 * length, aside, z) : Vec3(aside, -0.5 * length, z),
            fibre.to = upper ? Vec3(0.5 * length, aside, z) : Vec3(aside, 0.5 * length, z);
            fibre.director = Vec3::UnitZ();
            const Index f = assembly.add(fibre);
            for (const double end : {0.0, 1.0}) {
                if (upper) {  // what a hold leaves free the clamp takes
                    scene::Hold drag;
                    drag.at = {f, end}, drag.directions = Vec3(1, 1, 0).asDiagonal(),
                    drag.displacement = Vec3(dragged_x * r, dragged_y * r, 0), drag.channel = "drag";
                    assembly.hold(drag);
                }
                assembly.clamp({f, end}, upper ? Vec3(0, 0, -pressed * r) : Vec3(Vec3::Zero()), Vec3::Zero(), Vec3::Zero(),
                               "press");
            }
        }
    return assembly;
}

template <class B>
void ours(const char* policy, Index elements, Index increments) {
    using M = Policy<B, law::RegularisedCoulomb>;
    simulation::ModelParameters<M> all = parameters<M>();
    all.normal.regularisation_depth = 1e-4 * r, all.contact.stiffness.allowed_penetration = 1e-3 * r;
    all.friction = {.friction_coefficient = friction, .reversible_displacement = 1e-3 * r};
    const double start = processor_time();
    simulation::Simulator<M> simulator(layers(elements), all);
    for (const bool drag : {false, true}) {
        simulation::Stage<M> stage;
        stage.ramps = {{drag ? "drag" : "press", 1.0}}, stage.increments = increments;
        simulation::Loading<M> loading;
        loading.stages = {stage};
        const simulation::Report report = simulator.run(loading);
        Vec3 sum = Vec3::Zero();
        for (Index f = layer; f < 2 * layer; ++f)
            sum += simulator.reaction(scene::first_end(f)) + simulator.reaction(scene::last_end(f));
        if (!report.converged) std::printf("# %s: %s\n", policy, report.reason.c_str());
        std::printf("%s,%s,%ld,%ld,%.6e,%.6e,%.6e,%ld,%.6e,%.2e,%.1e,%.3f\n", report.converged ? policy : "stopped",
                    drag ? "dragged" : "pressed", static_cast<long>(elements), static_cast<long>(increments), sum.x(), sum.y(),
                    -sum.z(), static_cast<long>(report.contact.active), report.contact.reaction_sum,
                    report.contact.greatest_penetration / r, report.residual, processor_time() - start);
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::string script = argc > 1 ? argv[1] : "benchmarks/accuracy/yade_layers.py", elements = argc > 2 ? argv[2] : "25";
    std::printf(
        "code,stage,elements,increments or periods,drag x,drag y,press,active,reactions,deepest over r,residual or "
        "swing,seconds\n");
    ours<beam::RigidSectionRod>("rod", 75, 16);
    ours<beam::RigidSectionRod>("rod", 151, 16);
    for (const Index increments : {4, 16}) ours<beam::DirectorBeam<3>>("director", 25, increments);
    ours<beam::DirectorBeam<3>>("director", 51, 16);
    if (std::system("command -v yade > /dev/null 2>&1") != 0) return 0;
    for (const int periods : {2, 4, 8}) {
        const std::string command = "OMP_NUM_THREADS=1 yade -n -x -j1 " + script + " " + elements + " " +
                                    std::to_string(periods) + " " + std::to_string(pressed) + " " + std::to_string(dragged_x) +
                                    " " + std::to_string(dragged_y) + " " + std::to_string(friction) +
                                    " 2> /dev/null | grep ^layers | sed s/layers/yade/";
        if (std::system(command.c_str()) != 0) return 1;
    }
    return 0;
}
