// SPDX-License-Identifier: MIT
#pragma once
/// @file The programme that settles a fabric: tows pulled, parted, handed over to ordinary contact, released, at rest.

#include <fibrant/compositions/weave/fabric.hpp>
#include <fibrant/law/limited_gap.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/simulation/settling.hpp>

#include <algorithm>
#include <vector>

namespace fibrant::compositions::weave {

/// A fibre of a family, as a settling sees it.
inline simulation::SettledFibre settled_fibre(const FabricParameters& fabric, Family family, double tension_strain) {
    const TowParameters& tow = fabric.tow(family);
    const double young_modulus = tow.material.young_modulus, pull = tension_strain * young_modulus * tow.section().area();
    const double element = fabric.fibre_length(family) / static_cast<double>(fabric.elements_of(family));
    const double span = family == Family::warp ? fabric.weft_spacing : fabric.warp_spacing;
    return {tow.fibre_radius, pull, element, young_modulus * tow.section().second_moment_1(), span};
}

/// The lesser of what is measured on a fibre of each family.
template <class Measure>
double least_of_families(const FabricParameters& fabric, double tension_strain, const Measure& measure) {
    return std::min(measure(settled_fibre(fabric, Family::warp, tension_strain)),
                    measure(settled_fibre(fabric, Family::weft, tension_strain)));
}

/// Stiffness of a node of the softer family against moving aside alone [force / length].
inline double node_stiffness(const FabricParameters& fabric, double tension_strain) {
    return least_of_families(fabric, tension_strain, [](const simulation::SettledFibre& fibre) {
        return simulation::node_stiffness(fibre.pull, fibre.element, fibre.bending, fibre.span);
    });
}

/// Part of the tension that was asked for at which tows part, in (0, 1]: that of `simulation::parting_part`.
inline double parting_tension(const FabricParameters& fabric, double tension_strain) {
    return least_of_families(fabric, tension_strain, [](const simulation::SettledFibre& fibre) {
        return simulation::parting_part(fibre.pull, fibre.element, fibre.bending);
    });
}

/// Parameters of a model whose normal law is a limited, regularised penalty.
template <simulation::Model M>
simulation::ModelParameters<M> model_parameters(const FabricParameters& fabric, const SettleParameters& settle) {
    settle.validate();
    return simulation::settling_parameters<M>(smallest_radius(fabric), settle);
}

/// The stages of settling a flat fabric: tension, separation, handover, release, relaxation, stiffening and rest.
/// @param waved  the fabric begins waved: tows are pulled while they part
template <simulation::Model M>
simulation::Loading<M> settling(const FabricParameters& fabric, const SettleParameters& settle, bool waved = false) {
    settle.validate();
    std::vector<simulation::SettledFibre> fibres;
    for (Index f = 0; f < fabric.fibres(); ++f)
        fibres.push_back(settled_fibre(fabric, fabric.place(f).family, settle.tension_strain));
    simulation::SettlingScales scales = simulation::scales_of(fibres, true);
    scales.driven = scales.ordered = true;
    return simulation::settling<M>(scales, settle, {tension_channel, true, waved});
}

}  // namespace fibrant::compositions::weave
