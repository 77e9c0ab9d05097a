// SPDX-License-Identifier: MIT
// What does a weave pay for friction, and what does it save without? The same small fabric, settled with the law of
// Coulomb and with the empty law, in one run. Prints CSV: bytes of each part, then medians of time per contact element.
// usage: benchmark_null_policy_bench [fibres a tow [repeats]]; default 7 and 7
#include "timing.hpp"

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/weave/measures.hpp>
#include <fibrant/compositions/weave/settle.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

#include <cstdio>
#include <cstdlib>
#include <vector>

using namespace fibrant;
using namespace fibrant::benchmarks;
namespace cloth = compositions::weave;

namespace {

template <law::FrictionLaw Law>
struct Weave {
    using Beam = beam::DirectorBeam<>;
    using Proximity = proximity::GridSearch;
    using Normal = law::LimitedGap<law::RegularisedPenalty>;
    using Friction = Law;
    using Solver = solver::TwoLevelPcg;
};

struct Figures {
    double element_bytes, response_bytes, record_bytes, regenerate, refresh, evaluate, forces, settle;
    Index elements, newton;
    double crimp;
};

template <law::FrictionLaw Law>
Figures measure(const cloth::FabricParameters& fabric, const cloth::SettleParameters& settle, int repeats) {
    using M = Weave<Law>;
    using Contacts = typename simulation::Simulator<M>::Contacts;
    const auto parameters = cloth::model_parameters<M>(fabric, settle);
    const scene::Assembly assembly = cloth::flat_fabric(fabric, settle.tension_strain);
    simulation::Simulator<M> simulator(assembly, parameters);
    Figures figures{};
    const simulation::Report report = simulator.run(cloth::settling<M>(fabric, settle));
    figures.settle = report.wall_seconds;
    figures.newton = report.counts.newton;
    figures.crimp = cloth::crimp_measures(simulator.snapshot(), fabric).warp;
    Contacts contacts = simulator.contacts();
    const Vector& state = simulator.state();
    figures.elements = core::count(contacts.elements());
    const double each = 1e9 / static_cast<double>(figures.elements);
    figures.regenerate = each * median_seconds(repeats, [&] { contacts.regenerate(state, state); });
    figures.refresh = each * median_seconds(repeats, [&] { contacts.refresh(state, state); });
    figures.evaluate = each * median_seconds(repeats, [&] { contacts.evaluate(state); });
    Vector residual = Vector::Zero(state.size());
    figures.forces = each * median_seconds(repeats, [&] { contacts.add_forces(residual); });
    figures.element_bytes = sizeof(typename Contacts::Element);
    figures.response_bytes =
        sizeof(contact::ContactResponse) + (core::Active<Law> ? sizeof(law::FrictionResponse<typename Law::History>) : 0);
    figures.record_bytes = sizeof(contact::ContactRecord<law::RegularisedPenalty, Law>);
    return figures;
}

}  // namespace

int main(int argc, char** argv) {
    cloth::FabricParameters fabric;
    fabric.pattern = cloth::Pattern();
    fabric.warp_tows = fabric.weft_tows = 2;
    fabric.warp.fibres = argc > 1 ? std::atol(argv[1]) : 7;
    fabric.warp.fibre_radius = 0.04, fabric.warp.inertia_factor = 0.05, fabric.warp.aspect = 1.5;
    fabric.warp.material = {7300.0, 0.3};
    fabric.weft = fabric.warp;
    fabric.warp_spacing = fabric.weft_spacing = fabric.overhang = 0.88;
    fabric.elements = 20;
    const int repeats = argc > 2 ? std::atoi(argv[2]) : 7;
    const cloth::SettleParameters settle;
    const Figures with = measure<law::RegularisedCoulomb>(fabric, settle, repeats);
    const Figures without = measure<law::Frictionless>(fabric, settle, repeats);
    std::printf("figure,regularised_coulomb,frictionless,ratio\n");
    const auto row = [](const char* name, double a, double b) { std::printf("%s,%.6g,%.6g,%.3f\n", name, a, b, b / a); };
    row("bytes of a contact element", with.element_bytes, without.element_bytes);
    row("bytes of its response", with.response_bytes, without.response_bytes);
    row("bytes of its record", with.record_bytes, without.record_bytes);
    row("ns to generate a contact element", with.regenerate, without.regenerate);
    row("ns to turn it to a new normal", with.refresh, without.refresh);
    row("ns to evaluate it", with.evaluate, without.evaluate);
    row("ns to add its force", with.forces, without.forces);
    row("contact elements", static_cast<double>(with.elements), static_cast<double>(without.elements));
    row("Newton iterations to settle", static_cast<double>(with.newton), static_cast<double>(without.newton));
    row("s to settle", with.settle, without.settle);
    row("crimp", with.crimp, without.crimp);
    return 0;
}
