// SPDX-License-Identifier: MIT
#include <fibrant/solid/solid_law.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace fibrant;

namespace solid_law_test {

using solid::Voigt;
using solid::VoigtMatrix;

const scene::ElasticMaterial material{1000.0, 0.3};

Voigt random_strain(std::mt19937& generator, double size) {
    std::uniform_real_distribution<double> draw(-size, size);
    Voigt e;
    for (int k = 0; k < 6; ++k) e[k] = draw(generator);
    return e;
}

TEST_CASE_TEMPLATE("stress and tangent are derivatives of the energy, and small strains meet Hooke's law", Law,
                   solid::SaintVenantKirchhoff, solid::NeoHookean) {
    const Law law;
    std::mt19937 generator(7);
    CHECK(law.response(material, Voigt::Zero()).energy == 0.0);
    CHECK(law.response(material, Voigt::Zero()).stress.norm() == 0.0);
    for (int sample = 0; sample < 100; ++sample) {
        const Voigt e = random_strain(generator, 0.15);
        const solid::SolidResponse here = law.response(material, e);
        CHECK((here.tangent - here.tangent.transpose()).norm() <= 1e-13 * here.tangent.norm());
        const double step = 1e-5;  // central differences err by step^2 and by 1e-16 / step
        for (int k = 0; k < 6; ++k) {
            Voigt more = e, less = e;
            more[k] += step, less[k] -= step;
            const solid::SolidResponse up = law.response(material, more), down = law.response(material, less);
            CHECK(std::abs((up.energy - down.energy) / (2.0 * step) - here.stress[k]) <= 1e-7 * material.young_modulus);
            CHECK(((up.stress - down.stress) / (2.0 * step) - here.tangent.col(k)).norm() <= 1e-7 * here.tangent.norm());
        }
    }
    // Hooke in the limit: uniaxial stress has E, and the side strains -nu.
    const double lame = material.lame(), mu = material.shear_modulus(), strain = 1e-7;
    Voigt uniaxial = Voigt::Zero();
    uniaxial[0] = strain, uniaxial[1] = uniaxial[2] = -material.poisson_ratio * strain;
    const Voigt stress = law.response(material, uniaxial).stress;
    CHECK(stress[0] == test::near(material.young_modulus * strain, 1e-6));  // the law's own second order
    CHECK(std::abs(stress[1]) <= 1e-6 * stress[0]);
    const VoigtMatrix tangent = law.response(material, Voigt::Zero()).tangent;
    CHECK(tangent(0, 1) == test::near(lame, 1e-14));
    CHECK(tangent(3, 3) == test::near(mu, 1e-14));
    CHECK(tangent(0, 0) == test::near(lame + 2.0 * mu, 1e-14));
}

TEST_CASE("the neo-Hookean law resists compression to nothing, and knows no negative volume") {
    const solid::NeoHookean law;
    double last = 0.0;
    for (const double stretch : {0.9, 0.5, 0.1, 0.01}) {
        Voigt e = Voigt::Zero();
        e[0] = 0.5 * (stretch * stretch - 1.0);
        const double nominal = stretch * law.response(material, e).stress[0];  // P = F S
        CHECK(nominal < last);
        last = nominal;
        // P = mu (f - 1/f) + lambda ln f / f
        CHECK(nominal ==
              test::near(material.shear_modulus() * (stretch - 1.0 / stretch) + material.lame() * std::log(stretch) / stretch,
                         1e-12));
    }
    Voigt inside_out = Voigt::Zero();
    inside_out[0] = -0.5;
    CHECK_FALSE(std::isfinite(law.response(material, inside_out).energy));
    inside_out << -0.6, -0.6, 0.0, 0.0, 0.0, 0.0;  // two axes through zero: the determinant alone would not tell
    CHECK_FALSE(std::isfinite(law.response(material, inside_out).energy));
}

}  // namespace solid_law_test
