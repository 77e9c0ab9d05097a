// SPDX-License-Identifier: MIT
#include <fibrant/beam/section_law.hpp>
#include <fibrant/core/types.hpp>

#include <beam/beam_element_contract.hpp>
#include <near.hpp>

#include <doctest/doctest.h>

#include <numbers>
#include <random>

using namespace fibrant;

namespace section_law_test {

using namespace fibrant::beam;

const scene::ElasticMaterial material{7300.0, 0.3};

/// Energy of the 3-D law, integrated over an ellipse by a product rule that is exact for the degree 4 met here.
double integrated(const std::array<double, 15>& e, double a, double b) {
    const double lame = material.lame(), mu = material.shear_modulus(), pi = std::numbers::pi;
    // rho^2 at the Gauss points of [0, 1], 12 angles.
    const double t = std::sqrt(0.15), rho2[] = {0.5 - t, 0.5, 0.5 + t}, weight[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 12; ++k) {
            const double x = a * std::sqrt(rho2[i]) * std::cos(2 * pi * k / 12);
            const double y = b * std::sqrt(rho2[i]) * std::sin(2 * pi * k / 12);
            const double e33 = e[strain::e33] + x * e[strain::b1] + y * e[strain::b2] + x * x * e[strain::q11] +
                               x * y * e[strain::q12] + y * y * e[strain::q22];
            const double e13 = e[strain::e13] + x * e[strain::c11] + y * e[strain::c12];
            const double e23 = e[strain::e23] + x * e[strain::c21] + y * e[strain::c22];
            const double trace = e[strain::e11] + e[strain::e22] + e33;
            const double density = 0.5 * lame * trace * trace +
                                   mu * (e[strain::e11] * e[strain::e11] + e[strain::e22] * e[strain::e22] + e33 * e33) +
                                   0.5 * mu * (e[strain::e12] * e[strain::e12] + e13 * e13 + e23 * e23);
            sum += weight[i] / 12 * pi * a * b * density;
        }
    }
    return sum;
}

TEST_CASE("what warping takes away from torsion is taken from the twist: it counts by the root of the factor, shear as it is") {
    const SectionConstants flat = section_constants(scene::elliptical(0.03, 0.01));
    SectionConstants plane = flat;
    plane.torsion_factor = 1.0;
    const SectionLaw<ElasticLaw::split, QuadraticStrain::none> warped(flat, material, 1.0), stiff(plane, material, 1.0);
    const auto strained = [](double shear, double twist) {
        std::array<double, 12> e{};
        e[strain::c12] = shear - twist, e[strain::c21] = shear + twist;
        return e;
    };
    for (const double twist : {-0.7, 0.0, 0.4})
        CHECK(warped.energy(strained(0.3, twist)) ==
              test::near(stiff.energy(strained(0.3, std::sqrt(flat.torsion_factor) * twist))));
}

TEST_CASE("the full law is the three-dimensional law integrated over the section") {
    const double a = 0.03, b = 0.02;
    SectionConstants constants = section_constants(scene::elliptical(a, b));
    constants.torsion_factor = 1.0;  // a plane section; the factor is what warping takes away
    const SectionLaw<ElasticLaw::full, QuadraticStrain::none> plain(constants, material, 1.0);
    const SectionLaw<ElasticLaw::full, QuadraticStrain::complete> complete(constants, material, 1.0);
    std::mt19937_64 generator(7);
    std::normal_distribution<double> normal;
    for (int sample = 0; sample < 100; ++sample) {
        std::array<double, 15> e;
        for (std::size_t c = 0; c < 15; ++c) e[c] = normal(generator) / (c < 6 ? 1.0 : c < 12 ? a : a * a);
        // The law takes the mean of E_33, to which the element adds that of the quadratic part.
        std::array<double, 15> of_law = e;
        of_law[strain::e33] += complete.mean_1() * e[strain::q11] + complete.mean_2() * e[strain::q22];
        CHECK(complete.energy(of_law) == test::near(integrated(e, a, b), 1e-12));
        for (std::size_t c = 12; c < 15; ++c) e[c] = 0.0;
        std::array<double, 12> linear;
        std::copy_n(e.begin(), 12, linear.begin());
        CHECK(plain.energy(linear) == test::near(integrated(e, a, b), 1e-12));
    }
}

TEST_CASE("the split law bends with E, for any Poisson ratio, and is the full law otherwise") {
    for (const double poisson : {0.0, 0.2, 0.3, 0.45, 0.49}) {
        const scene::ElasticMaterial m{1.0, poisson};
        const SectionConstants constants{2.0, 0.3, 0.4};
        const SectionLaw<ElasticLaw::split, QuadraticStrain::none> split(constants, m, 1.0);
        const SectionLaw<ElasticLaw::full, QuadraticStrain::none> full(constants, m, 1.0);
        const double factor = (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
        CHECK(split.diagonal(strain::b1) == 0.3);
        CHECK(split.diagonal(strain::b2) == 0.4);
        CHECK(full.diagonal(strain::b1) == test::near(0.3 * factor, 1e-14));
        for (const int c : {0, 1, 2, 3, 4, 5, 8, 9, 10, 11}) CHECK(split.diagonal(c) == full.diagonal(c));
    }
}

TEST_CASE("the shear factor multiplies transverse shear, the torsion factor multiplies pure twist") {
    const SectionConstants plane{2.0, 0.3, 0.1}, warping{2.0, 0.3, 0.1, 0.75};
    using Law = SectionLaw<ElasticLaw::split, QuadraticStrain::none>;
    const Law a(plane, material, 1.0), b(warping, material, 0.8);
    CHECK(b.diagonal(strain::e13) == test::near(0.8 * a.diagonal(strain::e13), 1e-15));
    CHECK(b.diagonal(strain::e23) == test::near(0.8 * a.diagonal(strain::e23), 1e-15));
    Law::Strains twist{};
    twist[strain::c12] = -1.0;
    twist[strain::c21] = 1.0;
    CHECK(a.energy(twist) == test::near(0.5 * material.shear_modulus() * 0.4, 1e-14));
    CHECK(b.energy(twist) == test::near(0.75 * a.energy(twist), 1e-14));
    Law::Strains even{};  // the symmetric part is left alone
    even[strain::c12] = even[strain::c21] = 1.0;
    CHECK(b.energy(even) == test::near(a.energy(even), 1e-14));
}

TEST_CASE("no strain is free of energy, however flat the section") {
    for (const double b : {0.03, 0.01, 0.001}) {
        const SectionLaw<ElasticLaw::split, QuadraticStrain::complete> law(section_constants(scene::elliptical(0.03, b)),
                                                                           material, 1.0);
        Eigen::Matrix<double, 15, 15> C;
        for (std::size_t k = 0; k < 15; ++k) {
            std::array<double, 15> unit{};
            unit[k] = 1.0;
            const auto column = law.stress(unit);
            for (std::size_t i = 0; i < 15; ++i) C(Index(i), Index(k)) = column[i];
        }
        CHECK(C == C.transpose());
        const Eigen::Matrix<double, 15, 1> s = C.diagonal().cwiseSqrt().cwiseInverse();
        const Eigen::Matrix<double, 15, 15> scaled = s.asDiagonal() * C * s.asDiagonal();
        // Torsion vanishes as (b/a)^2, nothing else.
        CHECK(test::symmetric_eigenvalues<15>(scaled)[0] > 0.01 * b * b / (0.03 * 0.03));
    }
}

TEST_CASE("sections without size are refused by name") {
    using Law = SectionLaw<ElasticLaw::split, QuadraticStrain::none>;
    CHECK_THROWS_WITH_AS(Law(SectionConstants{-1.0, 1.0, 1.0}, material, 1.0),
                         "SectionConstants.area = -1, but it must be finite and > 0", std::invalid_argument);
    CHECK_THROWS_AS(Law(SectionConstants{}, material, 1.0), std::invalid_argument);
    CHECK_THROWS_AS(Law(SectionConstants{1.0, 1.0, 0.0}, material, 1.0), std::invalid_argument);
}

}  // namespace section_law_test
