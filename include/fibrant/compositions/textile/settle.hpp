// SPDX-License-Identifier: MIT
#pragma once
/// @file The programme that settles any textile: yarns part, are pulled, rub on each other, and come to rest.

#include <fibrant/compositions/textile/assemble.hpp>
#include <fibrant/law/limited_gap.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/simulation/settling.hpp>

#include <algorithm>
#include <vector>

namespace fibrant::compositions::textile {

/// How a textile is settled: pulled in ten increments, after its yarns have parted.
struct SettleParameters : simulation::SettleParameters {
    SettleParameters() { tension_increments = 10; }
};

/// Parameters of a model whose normal law is a limited, regularised penalty.
template <simulation::Model M>
simulation::ModelParameters<M> model_parameters(const Textile& textile, const SettleParameters& settle) {
    return simulation::settling_parameters<M>(textile.smallest_radius(), settle);
}

/// What a textile's settling goes by: the softest yarn under its tension, and in bending over the mean distance of crossings.
inline simulation::SettlingScales scales_of(const Textile& textile, const Assembled& assembled) {
    std::vector<simulation::SettledFibre> fibres;
    for (std::size_t f = 0; f < assembled.path_of.size(); ++f) {
        const Path& path = textile.paths[core::at(assembled.path_of[f])];
        const scene::FibreSpecification& fibre = assembled.assembly.fibres()[f];
        const bool pulled = path.kind == PathKind::periodic || (path.kind == PathKind::open && path.ends == Ends::pulled);
        const double pull = pulled ? path.tension_strain * fibre.material.young_modulus * fibre.section.area() : 0.0;
        fibres.push_back(simulation::settled_fibre(fibre, scene::length_of(path.curve, 64), assembled.longest_spacing, pull));
    }
    simulation::SettlingScales scales = simulation::scales_of(fibres, false);
    scales.ordered = !assembled.assembly.orders().empty();
    // Rings that are at rest as drawn only push each other apart.
    scales.driven = std::any_of(textile.paths.begin(), textile.paths.end(), [](const Path& path) {
        const bool ends_hold = path.kind == PathKind::periodic || (path.kind == PathKind::open && path.ends != Ends::free);
        return ends_hold || !path.guides.empty() || path.straight;
    });
    return scales;
}

/// The stages of settling. Drawn paths part first, without tension, and are pulled then: pulled first they may go straight
/// through each other.
/// @param assembled  of the textile
template <simulation::Model M>
simulation::Loading<M> settling(const Textile& textile, const Assembled& assembled, const SettleParameters& settle) {
    const bool pulled = std::any_of(textile.paths.begin(), textile.paths.end(), [](const Path& path) {
        return path.kind == PathKind::open ? path.ends == Ends::pulled
                                           : path.kind == PathKind::periodic && path.tension_strain > 0.0;
    });
    return simulation::settling<M>(scales_of(textile, assembled), settle, {pulled ? tension_channel : "", false});
}

}  // namespace fibrant::compositions::textile
