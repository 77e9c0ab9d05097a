// SPDX-License-Identifier: MIT
#pragma once
/// @file Fibres bonded to blocks of hexahedra, and their equilibrium solved exactly.

#include <fibrant/assembly/equilibrium.hpp>
#include <fibrant/assembly/term_assembly.hpp>
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/brute_search.hpp>

#include <Eigen/SparseCholesky>

#include <functional>
#include <vector>

namespace fibrant::test {

/// Cells of a box, each direction cut at the given places.
inline scene::Solid block(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z,
                          scene::ElasticMaterial material) {
    scene::Solid solid;
    solid.material = material;
    const Index nx = core::count(x), ny = core::count(y);
    for (const double c : z)
        for (const double b : y)
            for (const double a : x) solid.nodes.push_back({a, b, c});
    const auto node = [&](Index i, Index j, Index k) { return (k * ny + j) * nx + i; };
    for (Index k = 0; k + 1 < core::count(z); ++k)
        for (Index j = 0; j + 1 < ny; ++j)
            for (Index i = 0; i + 1 < nx; ++i)
                solid.cells.push_back({node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k),
                                       node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1),
                                       node(i, j + 1, k + 1)});
    return solid;
}
inline std::vector<double> cuts(double from, double to, Index cells) {
    std::vector<double> places;
    for (Index k = 0; k <= cells; ++k) places.push_back(from + (to - from) * static_cast<double>(k) / static_cast<double>(cells));
    return places;
}
/// Nodes of a solid where `where` holds.
inline std::vector<Index> nodes_where(const scene::Solid& solid, const std::function<bool(const Vec3&)>& where) {
    std::vector<Index> nodes;
    for (Index n = 0; n < core::count(solid.nodes); ++n)
        if (where(solid.nodes[core::at(n)])) nodes.push_back(n);
    return nodes;
}

/// A scene without contact, whose equilibria a direct solver finds.
template <class SolidPart>
struct BondedScene {
    using Beam = beam::DirectorBeam<3>;
    using Mesh = beam::Mesh<Beam>;
    using Contacts = contact::ContactSet<Beam, proximity::BruteSearch, law::RegularisedPenalty, law::Frictionless>;
    using Equilibrium = assembly::Equilibrium<Beam, Contacts, connection::NoConnections, SolidPart>;

    explicit BondedScene(const scene::Assembly& assembly, const typename SolidPart::Parameters& parameters = {})
        : mesh{assembly, beam},
          channels{assembly},
          contacts{assembly,
                   mesh,
                   contact_parameters(),
                   proximity::BruteSearch(),
                   law::RegularisedPenalty({.regularisation_depth = 1e-3}),
                   law::Frictionless()},
          equilibrium{assembly, mesh, beam, contacts, channels, SolidPart(parameters)},
          state{equilibrium.solid().with_rest(mesh.start_state())} {
        Vector none;
        contacts.detect(state, state, 1e-9, false);
        contacts.evaluate(state);
    }
    static contact::ContactParameters contact_parameters() {
        contact::ContactParameters parameters;
        parameters.stiffness.allowed_penetration = 1e-3;
        return parameters;
    }
    const SolidPart& solid() const { return equilibrium.solid(); }

    /// Newton's method to the end; all channels at `amplitude`. @returns size of the last step
    double solve(double amplitude = 1.0, int iterations = 8) {
        const std::vector<double> amplitudes(channels.names().size(), amplitude);
        equilibrium.begin(amplitudes, state);
        Vector prescribed, residual, right(state.size());
        double last = 0.0;
        for (int k = 0; k < iterations; ++k) {
            equilibrium.reset_stresses(state);
            equilibrium.residual(state, residual);
            equilibrium.linearise(state, false, 0.0);
            equilibrium.prescribed_step(state, prescribed);
            right.setZero();
            equilibrium.system().apply_unheld(prescribed, right);
            right = (-residual - right).eval();
            for (const scene::HeldVector& held : equilibrium.system().layout().held)
                right.segment<3>(3 * held.vector) = (held.free * right.segment<3>(3 * held.vector)).eval();
            SparseMatrix a;
            assembly::assemble_from_terms(equilibrium.system(), a);
            const Vector step = Eigen::SimplicialLDLT<SparseMatrix>(a).solve(right) + prescribed;
            state += step;
            last = equilibrium.greatest(step);
        }
        equilibrium.residual(state, residual);
        return last;
    }
    /// Sum of what holds the nodes of a solid, and the ends of fibres, where `where` holds at the start [force].
    Vec3 reaction(const std::function<bool(const Vec3&)>& where) const {
        Vec3 sum = Vec3::Zero();
        for (Index n = 0; n < solid().nodes(); ++n)
            if (where(solid().start(n))) sum += equilibrium.reaction().template segment<3>(3 * (solid().first_vector() + n));
        for (Index f = 0; f < mesh.fibre_count(); ++f)
            for (Index a = 0; a < mesh.node_count(f); ++a) {
                const Index v = mesh.node_vector(f, a);
                if (where(mesh.start_state().template segment<3>(3 * v)))
                    sum += equilibrium.reaction().template segment<3>(3 * v);
            }
        return sum;
    }

    Beam beam{};
    Mesh mesh;
    connection::Channels channels;
    Contacts contacts;
    Equilibrium equilibrium;
    Vector state;
};

}  // namespace fibrant::test
