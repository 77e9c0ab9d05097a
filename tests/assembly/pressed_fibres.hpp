// SPDX-License-Identifier: MIT
#pragma once
/// @file Fibres pressed into each other, with everything that adds to an equilibrium's tangent.

#include "../support/random_vector.hpp"

#include <fibrant/assembly/equilibrium.hpp>
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/beam/on_centreline.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/brute_search.hpp>

#include <random>
#include <vector>

namespace fibrant::test {

/// Two parallel fibres and one that crosses both, overlapping by some percent of a radius; sections are ellipses where contact
/// sees them.
template <law::FrictionLaw Friction, beam::BeamElement B = beam::DirectorBeam<3>>
struct PressedFibres {
    using Beam = B;
    static constexpr double flatness = beam::TouchedOnCentreline<B> ? 1.0 : 0.8;
    using Contacts = contact::ContactSet<Beam, proximity::BruteSearch, law::RegularisedPenalty, Friction>;
    using Equilibrium = assembly::Equilibrium<Beam, Contacts>;
    static constexpr double radius = 0.02;

    /// @param followed  the places where they cross slide with them
    explicit PressedFibres(bool held, const Vec3& moment = Vec3::Zero(), bool followed = false) : assembly_{scene(held, moment)} {
        amplitudes.assign(channels.names().size(), 1.0);
        accepted = mesh.rest_state();
        state = accepted;
        std::mt19937 random(5);
        std::uniform_real_distribution<double> any(-1.0, 1.0);
        for (Index v = 0; v < state.size() / 3; ++v) {  // a few per cent of a radius, and as much at the surface
            const Vec3 step = test::random_vector(any, random);
            state.segment<3>(3 * v) += 0.01 * (v % 3 == 0 ? radius : 1.0) * step;
        }
        equilibrium.begin(amplitudes, accepted);
        contacts.places().follow(followed);
        contacts.detect(state, accepted, 0.5 * radius, false);
        linearise(state);
    }
    void linearise(const Vector& at) {
        contacts.evaluate(at);
        equilibrium.reset_stresses(at);
        equilibrium.linearise(at, false, 0.0);
    }
    Vector residual(const Vector& at) {
        Vector r;
        contacts.evaluate(at);
        equilibrium.residual(at, r);
        return r;
    }
    Vector random_step(unsigned seed) const {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> any(-1.0, 1.0);
        Vector x(state.size());
        for (Index k = 0; k < x.size(); ++k) x[k] = any(random) * ((k / 3) % 3 == 0 ? radius : 1.0);
        return x;
    }
    Index active() const { return contacts.figures(state).active; }

private:
    static scene::Assembly scene(bool held, const Vec3& moment) {
        scene::Assembly assembly;
        const scene::CrossSection section = scene::elliptical(radius, flatness * radius);
        const scene::ElasticMaterial material{7300.0, 0.3};
        const double depth = 0.04 * radius;
        const auto add = [&](const Vec3& from, const Vec3& to) {
            assembly.add(
                {.from = from, .to = to, .section = section, .material = material, .elements = 4, .director = Vec3::UnitZ()});
        };
        add({-0.4, 0, 0}, {0.4, 0, 0});
        const double apart = 2.0 * flatness * radius - depth;
        add({-0.4, apart, 0}, {0.4, apart, 0.002});
        add({0.03, -0.4, 2.0 * radius - depth}, {-0.02, 0.4, 2.0 * radius - depth});
        if (held) {
            assembly.clamp(scene::first_end(0));
            assembly.hold_axial_rotation(scene::last_end(1));
            scene::Hold slanted;
            slanted.at = scene::last_end(2);
            slanted.directions = Vec3(1, 2, 3).normalized() * Vec3(1, 2, 3).normalized().transpose();
            assembly.hold(slanted);
        }
        if (moment.norm() > 0.0) assembly.apply(scene::Moment{scene::last_end(0), scene::NodeVector::director_1, moment, "load"});
        return assembly;
    }
    static law::RegularisedPenalty normal_law() { return law::RegularisedPenalty({.regularisation_depth = 1e-3 * radius}); }
    static Friction friction_law() {
        if constexpr (core::Active<Friction>)
            return Friction({0.3, 0.01 * radius});
        else
            return Friction();
    }
    static contact::ContactParameters contact_parameters() {
        contact::ContactParameters parameters;
        parameters.stiffness.allowed_penetration = 1e-2 * radius;
        return parameters;
    }

    scene::Assembly assembly_;
    Beam beam_{};

public:
    beam::Mesh<Beam> mesh{assembly_, beam_};
    connection::Channels channels{assembly_};
    Contacts contacts{assembly_, mesh, contact_parameters(), proximity::BruteSearch{}, normal_law(), friction_law()};
    Equilibrium equilibrium{assembly_, mesh, beam_, contacts, channels};
    std::vector<double> amplitudes;
    Vector accepted, state;
};

}  // namespace fibrant::test
