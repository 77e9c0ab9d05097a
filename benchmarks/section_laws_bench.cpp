// SPDX-License-Identifier: MIT
// What does an element cost in an iteration of Newton (prediction, force and tangent) with each law of its section, over the
// elastic one?
// usage: benchmark_section_laws_bench; prints law,nanoseconds,over_elastic
#include "timing.hpp"

#include <fibrant/beam/mesh.hpp>
#include <fibrant/beam/with_law.hpp>
#include <fibrant/material/brittle.hpp>
#include <fibrant/material/composed.hpp>
#include <fibrant/material/eigenstrain.hpp>
#include <fibrant/material/viscoelastic.hpp>
#include <fibrant/material/wire.hpp>

#include <cmath>
#include <cstdio>

using namespace fibrant;

namespace {

double elastic = 0.0;  // nanoseconds

/// @param size  of the displacements of nodes [length]
template <class Material>
void measure(const char* name, const auto& parameters, double size) {
    using B = beam::With<beam::DirectorBeam<>, Material>;
    constexpr Index elements = 256;
    scene::Assembly assembly;
    assembly.add({.from = {0, 0, 0},
                  .to = {25.6, 0, 0},
                  .section = scene::circular(0.0201),
                  .material = {7300.0, 0.3},
                  .elements = elements});
    const B beam(parameters);
    const beam::Mesh<B> mesh(assembly, beam);
    Vector state = mesh.start_state(), step = Vector::Zero(state.size());
    for (Index k = 0; k < state.size(); ++k) {
        state[k] += size * std::sin(0.7 * static_cast<double>(k));
        step[k] = 1e-3 * size * std::cos(0.3 * static_cast<double>(k));
    }
    std::vector<typename B::Stresses> stresses(core::at(elements));
    double sum = 0.0;
    std::vector<double> times;
    for (int repeat = 0; repeat < 21; ++repeat) {
        const double start = benchmarks::processor_time();
        for (Index e = 0; e < elements; ++e) {
            auto& s = stresses[core::at(e)] =
                beam.predicted_stresses(mesh.rest(0, e), mesh.element(state, 0, e), mesh.element(step, 0, e));
            if constexpr (beam::IteratedStrains<B>)
                sum += beam.internal_force(mesh.rest(0, e), mesh.element(state, 0, e), s)[0];
            else
                sum += beam.internal_force(mesh.rest(0, e), mesh.element(state, 0, e))[0];
            sum += beam.tangent_stiffness(mesh.rest(0, e), mesh.element(state, 0, e), s)(0, 0);
        }
        times.push_back((benchmarks::processor_time() - start) / elements);
    }
    const double nanoseconds = 1e9 * benchmarks::median(times);
    if (elastic == 0.0) elastic = nanoseconds;
    std::printf("%s,%.0f,%.2f%s\n", name, nanoseconds, nanoseconds / elastic, std::isfinite(sum) ? "" : ",not finite");
}
template <class Material>
auto with(const typename Material::Parameters& law) {
    typename beam::With<beam::DirectorBeam<>, Material>::Parameters parameters;
    parameters.laws = {law};
    return parameters;
}

}  // namespace

int main() {
    std::printf("law,nanoseconds,over_elastic\n");
    measure<beam::Isotropic>("isotropic", beam::DirectorBeam<>::Parameters{}, 1e-4);
    measure<material::Elastic>("elastic or transversely isotropic", with<material::Elastic>({}), 1e-4);
    measure<material::Eigenstrain<material::Elastic>>(
        "eigenstrain", with<material::Eigenstrain<material::Elastic>>({.base = {}, .along = 0.01}), 1e-4);
    measure<material::Viscoelastic<2>>("viscoelastic of two branches",
                                       with<material::Viscoelastic<2>>({.share = {0.3, 0.2}, .time = {1.0, 10.0}}), 1e-4);
    measure<material::Brittle>("brittle", with<material::Brittle>({.strength = 1e9, .modulus = 5.0, .reference_length = 1.0}),
                               1e-4);
    using Stops = material::Composed<material::NoCompression, material::BendingStops<8>>;
    Stops::Parameters stops;
    for (std::size_t k = 0; k < 8; ++k) {
        stops.bending.share[k] = 0.1;
        stops.bending.curvature[k] = 0.01 * static_cast<double>(k + 1);
    }
    measure<Stops>("no compression and eight stops", with<Stops>(stops), 1e-4);
    measure<material::Wire>("wire, elastic", with<material::Wire>({.yield_stress = 1e9}), 1e-4);
    measure<material::Wire>("wire, all points flow", with<material::Wire>({.yield_stress = 1e-3, .hardening = 100.0}), 1e-3);
    return 0;
}
