// SPDX-License-Identifier: MIT
#include "refusal.hpp"

#include <fibrant/scene/cross_section.hpp>
#include <fibrant/scene/elastic_material.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

using namespace fibrant;

namespace cross_section_test {

using std::numbers::pi;
using test::refusal;

TEST_CASE("area and second moments are those of the ellipse") {
    const scene::CrossSection section = scene::elliptical(0.03, 0.01);
    // Summed over rings and angles, at the middles of n of each: the cubes of n radii are off by 1 / 2 n^2.
    const int n = 1000;
    double area = 0.0, first = 0.0, second = 0.0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double ring = (i + 0.5) / n, angle = 2.0 * pi * (j + 0.5) / n;
            const double x = 0.03 * ring * std::cos(angle), y = 0.01 * ring * std::sin(angle),
                         cell = 0.03 * 0.01 * ring / n * 2.0 * pi / n;
            area += cell, first += x * x * cell, second += y * y * cell;
        }
    CHECK(section.area() == test::near(area, 1e-6));
    CHECK(section.second_moment_1() == test::near(first, 1e-6));
    CHECK(section.second_moment_2() == test::near(second, 1e-6));
    CHECK(section.radius() == 0.03);
    // St Venant: pi a^3 b^3 / (a^2 + b^2) over the polar moment pi a b (a^2 + b^2) / 4.
    CHECK(section.torsion_factor() == test::near(pi * std::pow(3e-4, 3) / 1e-3 / (pi * 3e-4 * 1e-3 / 4.0), 1e-12));
    CHECK(scene::circular(0.02).torsion_factor() == test::near(1.0, 1e-12));
}

TEST_CASE("a hollow section has the area and the second moments of a ring") {
    const scene::CrossSection section = scene::hollow(0.03, 0.02, 0.5);
    CHECK(section.area() == test::near(pi * (9e-4 - 4e-4), 1e-14));
    CHECK(section.second_moment_1() == test::near(0.5 * pi / 4.0 * (81e-8 - 16e-8), 1e-14));
    CHECK(section.second_moment_2() == section.second_moment_1());
    CHECK(section.radius() == 0.03);
    CHECK(scene::hollow(0.03, 1e-300).area() == scene::circular(0.03).area());  // the same bits
    CHECK(refusal([] { scene::hollow(0.03, 0.03); }) == "CrossSection.bore = 0.03, but it must be < semi_axis_1 = 0.03");
    CHECK(refusal([] { scene::hollow(0.03, 0.0); }) == "hollow.bore = 0, but it must be finite and > 0");
    CHECK(refusal([] {
              scene::CrossSection{0.03, 0.02, 1.0, 0.01}.validate();
          }) == "CrossSection.bore = 0.01, but it must be 0, of a section that is not round");
}

TEST_CASE("the greatest extent of a section is the greatest of all directions, also where its directors are sheared") {
    const scene::CrossSection section = scene::elliptical(0.03, 0.02);
    for (const Vec3& g_2 : {Vec3(0, 1, 0), Vec3(0.6, 0.9, 0), Vec3(-0.5, 1.2, 0)}) {
        const Vec3 g_1(1.1, 0.1, 0);
        double most = 0.0;
        for (int k = 0; k < 10000; ++k) {
            const double angle = pi * k / 10000;
            most = std::max(most, section.extent(g_1, g_2, Vec3(std::cos(angle), std::sin(angle), 0)));
        }
        CHECK(section.greatest_extent(g_1, g_2) == test::near(most, 1e-7));  // square of half a step between directions
    }
}

TEST_CASE("macro-fibres have the area of the fibres they stand for, and the second moment of as many thin ones") {
    // The chapter's tow: 76 fibres of 40.2 um by 19 macro-fibres (eq. 3 and 4).
    const double d = 0.0402;
    const scene::CrossSection macro = scene::macro_fibre(76, d, 19);
    CHECK(macro.radius() == test::near(d, 1e-12));  // sqrt(76 / 19) = 2 diameters
    CHECK(19 * macro.area() == test::near(76 * pi * d * d / 4, 1e-14));
    CHECK(19 * macro.second_moment_1() == test::near(76 * pi * std::pow(d, 4) / 64, 1e-14));
    CHECK(macro.second_moment_1() == macro.second_moment_2());
    const scene::CrossSection one = scene::macro_fibre(19, d, 19);
    CHECK(one.radius() == test::near(0.5 * d, 1e-12));
    CHECK(one.inertia_factor == 1.0);
}

TEST_CASE("sections and materials that cannot be are refused by name") {
    CHECK(refusal([] { scene::circular(-0.02); }) == "circular.radius = -0.02, but it must be finite and > 0");
    CHECK(refusal([] { scene::elliptical(0.02, core::unset); }) ==
          "CrossSection.semi_axis_2 = nan, but it must be finite and > 0");
    CHECK(refusal([] { scene::CrossSection{}.validate(); }).starts_with("CrossSection.semi_axis_1 = nan,"));
    CHECK(refusal([] { scene::macro_fibre(19, 0.04, 20); }) == "macro_fibre.fibres = 19, but it must be >= macro_fibres = 20");
    CHECK(refusal([] { scene::macro_fibre(19, 0.04, 0.5); }).starts_with("macro_fibre.macro_fibres = 0.5,"));
    CHECK(refusal([] {
              scene::ElasticMaterial{7300.0, 0.5}.validate();
          }) == "ElasticMaterial.poisson_ratio = 0.5, but it must be > -1 and < 0.5");
    CHECK(refusal([] { scene::ElasticMaterial{-1.0, 0.3}.validate(); }).starts_with("ElasticMaterial.young_modulus = -1,"));
    CHECK(refusal([] { scene::ElasticMaterial{1.0, core::unset}.validate(); }).starts_with("ElasticMaterial.poisson_ratio"));
}

TEST_CASE("Lame constants give back Young's modulus and Poisson's ratio") {
    const scene::ElasticMaterial material{7300.0, 0.3};
    const double lambda = material.lame(), mu = material.shear_modulus();
    CHECK(mu * (3 * lambda + 2 * mu) / (lambda + mu) == test::near(7300.0, 1e-14));
    CHECK(lambda / (2 * (lambda + mu)) == test::near(0.3, 1e-14));
}

}  // namespace cross_section_test
