// SPDX-License-Identifier: MIT
#pragma once
/// @file A settled fabric between two layers of matrix, held at the edges across its warp.

#include <fibrant/compositions/composite/edges.hpp>
#include <fibrant/compositions/weave/settle.hpp>
#include <fibrant/observe/snapshot.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fibrant::compositions::composite {

/// Sections of all fibres as the mesher wants them.
inline std::vector<std::vector<solid::SectionPlace>> sections_of(const observe::Snapshot& snapshot) {
    std::vector<std::vector<solid::SectionPlace>> fibres;
    for (const observe::FibreSnapshot& fibre : snapshot.fibres) {
        fibres.emplace_back();
        for (std::size_t k = 0; k < fibre.position.size(); ++k)
            fibres.back().push_back({fibre.position[k], fibre.section.semi_axis_1 * fibre.director_1[k],
                                     fibre.section.semi_axis_2 * fibre.director_2[k]});
    }
    return fibres;
}

/// Layers over the whole fabric, from the ends of its fibres to the opposite ones.
inline solid::Layers layers_of(const observe::Snapshot& snapshot, const FabricParameters& fabric,
                               const MatrixParameters& matrix) {
    matrix.validate();
    const double radius = std::min(fabric.warp.fibre_radius, fabric.weft.fibre_radius);
    solid::LayerParameters parameters;
    parameters.low = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    parameters.high = {-parameters.low[0], -parameters.low[1]};
    double top = parameters.high[0], bottom = parameters.low[0];
    for (Index f = 0; f < core::count(snapshot.fibres); ++f) {
        const observe::FibreSnapshot& fibre = snapshot.fibres[core::at(f)];
        const std::size_t axis = fabric.place(f).family == Family::warp ? 0 : 1;
        const auto [a, b] =
            std::minmax(fibre.position.front()[static_cast<Index>(axis)], fibre.position.back()[static_cast<Index>(axis)]);
        parameters.low[axis] = std::min(parameters.low[axis], a), parameters.high[axis] = std::max(parameters.high[axis], b);
        for (std::size_t k = 0; k < fibre.position.size(); ++k) {
            const double reach = fibre.section.extent(fibre.director_1[k], fibre.director_2[k], Vec3::UnitZ());
            top = std::max(top, fibre.position[k].z() + reach), bottom = std::min(bottom, fibre.position[k].z() - reach);
        }
    }
    parameters.cells = {matrix.cells_along, matrix.cells_across};
    parameters.through = matrix.through, parameters.grading = matrix.grading, parameters.smoothing = matrix.smoothing;
    parameters.upper_face = top + matrix.cover, parameters.lower_face = bottom - matrix.cover;
    parameters.penetration_depth = matrix.penetration_depth_over_radius * radius;
    parameters.clearance = matrix.clearance_over_radius * radius;
    parameters.least_thickness = matrix.least_thickness_over_cover * matrix.cover;
    parameters.sides = matrix.sides, parameters.crossing = matrix.crossing, parameters.material = matrix.material;
    return solid::mesh_layers(solid::FibreSurface(sections_of(snapshot)), parameters);
}

/// A settled fabric in its matrix: fibres where they lie, the solid, and what bonds them.
/// @param state  of the fabric's fibres where it has settled
inline Composite composite_of(const FabricParameters& fabric, const Vector& state, const scene::Assembly& flat,
                              const solid::Layers& layers, const MatrixParameters& matrix, const LoadParameters& load) {
    Composite composite;
    scene::Assembly& assembly = composite.assembly;
    for (const scene::Group& group : flat.groups()) assembly.add_group(group.name, group.parent);
    for (scene::FibreSpecification fibre : flat.fibres()) {
        if (matrix.lower_fibres) {
            core::require(fibre.material.young_modulus > matrix.material.young_modulus, "MatrixParameters.material.young_modulus",
                          matrix.material.young_modulus, "< that of the fibres, which is to be lowered by it");
            fibre.material.young_modulus -= matrix.material.young_modulus;
        }
        assembly.add(fibre);
    }
    assembly.begin_at(state);
    Vec3 low = layers.list.front().solid.nodes.front(), high = low;
    for (const solid::Layer& layer : layers.list) {
        for (const Vec3& node : layer.solid.nodes) low = low.cwiseMin(node), high = high.cwiseMax(node);
        assembly.add(layer.solid);
    }
    composite.length = high.x() - low.x(), composite.width = high.y() - low.y();
    if (load.driven)
        drive_edges(composite, fabric, layers, load);
    else
        tie_edges(composite, fabric, layers, load);
    return composite;
}

/// Two stages: the fabric comes to rest between the layers, where nothing holds the ends of its weft any more; then the load goes
/// from 0 to 1.
template <simulation::Model M>
simulation::Loading<M> loading_of(const FabricParameters& fabric, const weave::SettleParameters& settle,
                                  const LoadParameters& load) {
    const double r = weave::smallest_radius(fabric), node = weave::node_stiffness(fabric, settle.tension_strain);
    simulation::Loading<M> loading;
    loading.stages.resize(2);
    simulation::Stage<M>& rest = loading.stages[0];
    rest.name = "rest";
    rest.increments = 1, rest.most_increments = settle.rest_increments;
    rest.looseness = settle.looseness;
    rest.damping = load.rest_damping * node, rest.damping_decay = 0.5;
    rest.damping_share = load.rest_share;
    rest.until = simulation::until_settled(settle.rest_motion_over_radius * r, 2.0 * settle.allowed_penetration_over_radius * r,
                                           load.rest_share);
    simulation::Stage<M>& stage = loading.stages[1];
    stage.name = "load";
    stage.increments = load.increments, stage.most_increments = 50 * load.increments;
    stage.ramps = {{load_channel, 1.0}};
    stage.looseness = load.looseness;
    stage.damping = load.damping * node;
    return loading;
}

}  // namespace fibrant::compositions::composite
