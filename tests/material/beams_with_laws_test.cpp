// SPDX-License-Identifier: MIT
// Beams whose sections obey laws: the elastic law is that of the beam itself, and with any law force and tangent are derivatives.
#include <beam/beam_element_contract.hpp>
#include <beam/elements.hpp>
#include <near.hpp>
#include <refusal.hpp>

#include <fibrant/beam/with_law.hpp>
#include <fibrant/material/composed.hpp>
#include <fibrant/material/wire.hpp>

#include <cstdio>

using namespace fibrant;

namespace beams_with_laws_test {

using namespace fibrant::test;
using beam::RigidSectionRod;
using Metric = beam::DirectorBeam<3>;
using Turn = beam::DirectorBeam<3, beam::DirectorBeamOptions{.twist = beam::TwistStrain::turn}>;
using Wire = material::Wire;

static_assert(std::same_as<beam::With<Metric, beam::Isotropic>, Metric>);  // not a byte, not an instruction
static_assert(sizeof(beam::ElementMemory<material::Elastic, 2>::accepted) <= 2);
static_assert(beam::Remembering<beam::With<Turn, Wire>> && !beam::Remembering<Metric>);

const double radius = 0.0201, length = 6.0 * radius;
const scene::ElasticMaterial isotropic{7300.0, 0.3}, carbon{7300.0, 0.2, {480.0, 0.3, 480.0}};
const scene::CrossSection round_section = scene::circular(radius), flat_section = scene::elliptical(radius, 0.6 * radius, 0.5);

beam::ElementVector<RigidSectionRod> rod_element(double angle) {
    beam::ElementVector<RigidSectionRod> y = beam::ElementVector<RigidSectionRod>::Zero();
    y.segment<3>(6) = length * Vec3(std::sin(0.5 * angle), 0.0, std::cos(0.5 * angle));
    y.segment<3>(9) = Vec3(0.0, angle, 0.1);
    return y;
}
template <class B>
beam::ElementVector<B> at_rest_of() {
    if constexpr (B::nodes == 3)
        return curved_element<B>(length, 0.8);
    else
        return rod_element(0.6);
}
template <class B>
beam::ElementVector<B> moved_by(double size, unsigned seed) {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    beam::ElementVector<B> u;
    for (double& c : u) c = size * normal(generator);
    return u.cwiseProduct(unknown_scale<B>(length));
}

TEST_CASE_TEMPLATE("with the elastic law a beam is what it is by itself", B, Metric, Turn, RigidSectionRod) {
    using L = beam::With<B, material::Elastic>;
    const B beam{{.shear_factor = 0.9}};
    typename L::Parameters parameters;
    parameters.shear_factor = 0.9;
    const L with(parameters);
    const auto y0 = at_rest_of<B>();
    const auto rest = beam.rest(flat_section, isotropic, y0);
    const auto own = with.rest(flat_section, isotropic, y0);
    const beam::ElementVector<B> y = y0 + moved_by<B>(0.1, 3), step = moved_by<B>(0.01, 4), scale = unknown_scale<B>(length);
    const auto scaled = [&](const auto& v) { return v.cwiseProduct(scale).eval(); };
    // The same sums in another order.
    CHECK(with.energy(own, y) / beam.energy(rest, y) == test::near(1.0, 1e-13));
    CHECK(scaled(with.internal_force(own, y) - beam.internal_force(rest, y)).norm() <
          1e-13 * scaled(beam.internal_force(rest, y)).norm());
    const auto difference = (scale.asDiagonal() *
                             (with.tangent_stiffness(own, y, with.predicted_stresses(own, y, step)) -
                              beam.tangent_stiffness(rest, y, beam.predicted_stresses(rest, y, step))) *
                             scale.asDiagonal())
                                .eval();
    CHECK(difference.norm() < 1e-13 * (scale.asDiagonal() * beam.tangent_stiffness(rest, y) * scale.asDiagonal()).norm());
}

TEST_CASE_TEMPLATE("transversely isotropic elements derive from an energy that rigid motions leave alone", B, Metric, Turn,
                   RigidSectionRod) {
    using L = beam::With<B, material::Elastic>;
    const L with;
    const auto y0 = at_rest_of<L>();
    const ElementErrors e = check_beam_element(with, with.rest(flat_section, carbon, y0), y0, length, radius, 10);
    std::printf("force %.1e, tangent %.1e\n", e.force, e.tangent);
    CHECK(refusal([&] { B{}.rest(flat_section, carbon, y0); }).find("is isotropic") != std::string::npos);
}

template <class B, class M>
void check_path(const typename M::Parameters& law, double size, const scene::CrossSection& section) {
    using L = beam::With<B, M>;
    typename L::Parameters parameters;
    parameters.laws = {law};
    const L with(parameters);
    const auto y0 = at_rest_of<L>();
    auto rest = with.rest(section, isotropic, y0);
    const beam::ElementVector<L> scale = unknown_scale<L>(length);
    double dissipated = 0.0;
    for (unsigned increment = 0; increment < 6; ++increment) {
        const beam::ElementVector<L> y = y0 + moved_by<L>(size, increment);
        const beam::LawFigures figures = with.figures(rest, y);
        CHECK(figures.dissipated >= 0.0);
        dissipated += figures.dissipated;
        const beam::ElementVector<L> force = scale.cwiseProduct(with.internal_force(rest, y));
        const beam::ElementMatrix<L> K = scale.asDiagonal() * with.tangent_stiffness(rest, y) * scale.asDiagonal();
        beam::ElementMatrix<L> slope;
        beam::ElementVector<L> by_energy;
        const double h = 1e-6;
        for (Index k = 0; k < y.size(); ++k) {
            beam::ElementVector<L> ahead = y, behind = y;
            ahead[k] += h * scale[k], behind[k] -= h * scale[k];
            slope.col(k) = scale.cwiseProduct(with.internal_force(rest, ahead) - with.internal_force(rest, behind)) / (2.0 * h);
            const auto a = with.figures(rest, ahead), b = with.figures(rest, behind);
            by_energy[k] = (a.stored + a.dissipated - b.stored - b.dissipated) / (2.0 * h);
        }
        // Differences at 1e-6 of strains of `size`; a point of the section that yields within the step is a kink.
        CHECK((by_energy - force).norm() < 1e-6 * force.norm());
        CHECK((slope - K).norm() < 2e-6 * K.norm());
        CHECK((K - K.transpose()).norm() < 1e-13 * K.norm());
        with.accept(rest, y);
    }
    CHECK(dissipated > 0.0);
}

TEST_CASE_TEMPLATE("elements that yield, and that bend with a loop, have the force and the tangent of what they store and lose",
                   B, Metric, Turn, RigidSectionRod) {
    check_path<B, Wire>({.yield_stress = 40.0, .hardening = 500.0}, 0.02, round_section);
    using Hysteretic = material::Composed<material::NoCompression, material::BendingStops<4>>;
    check_path<B, Hysteretic>({.axial = {}, .bending = {.share = {0.3, 0.2, 0.2, 0.1}, .curvature = {0.05, 0.1, 0.2, 0.4}}}, 0.02,
                              flat_section);
}

}  // namespace beams_with_laws_test
