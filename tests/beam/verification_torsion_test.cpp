// SPDX-License-Identifier: MIT
// A rod that is twisted far, against M = G J t, t the turn of its sections per length at rest, and against what each variant
// comes to.
#include <support/rod.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

using namespace fibrant;

namespace verification_torsion_test {

using beam::DirectorBeamOptions;
using beam::QuadraticStrain;
using beam::TwistStrain;

constexpr double r = 0.0201, young = 7300.0, poisson = 0.25, length = 40.0 * r;
constexpr double shear = young / (2.0 * (1.0 + poisson));
double stiffness() { return shear * 0.5 * std::numbers::pi * std::pow(r, 4); }

/// M / (G J t) - 1 of the far end, which turns about the axis and slides along it unless the length is held.
template <class B>
double error(double rt, int elements, bool held) {
    test::Rod<B> rod(B{}, beam::section_constants(scene::circular(r)), {young, poisson}, elements * B::reach, length,
                     test::straight);
    rod.place(0, test::straight(0.0), false);
    const int last = elements * B::reach;
    const double angle = rt / r * length;
    const auto turn = [&](double part) {
        const double a = part * angle;
        rod.place(last, {Vec3(0, 0, length), Vec3(std::cos(a), std::sin(a), 0), Vec3(-std::sin(a), std::cos(a), 0)}, false);
        if (!held) rod.hold(last, 0, Vec3(1, 1, 0).asDiagonal(), Vec3::Zero());
    };
    REQUIRE(rod.follow(std::max(8, static_cast<int>(angle / 0.4)), turn, 1e-9, false).converged);
    return rod.reaction_moment(last).z() / (stiffness() * rt / r) - 1.0;
}
template <QuadraticStrain Quadratic, TwistStrain Twist>
using Beam = beam::DirectorBeam<3, DirectorBeamOptions{.quadratic = Quadratic, .twist = Twist}>;

TEST_CASE("torsion by the turn of sections is G J t, by Green's strain short of it by (r t)^2 (1 - nu)/(1 + nu)") {
    std::printf("r t: M / (G J t) - 1 of metric, turn\n");
    for (const double rt : {0.1, 0.2, 0.3}) {
        const double metric = error<Beam<QuadraticStrain::none, TwistStrain::metric>>(rt, 32, false);
        const double turn = error<Beam<QuadraticStrain::none, TwistStrain::turn>>(rt, 32, false);
        std::printf("%.1f: %+.4f %%, %+.4f %%\n", rt, 100.0 * metric, 100.0 * turn);
        // The next term is of the fourth order.
        CHECK(std::abs(metric + rt * rt * (1.0 - poisson) / (1.0 + poisson)) < std::pow(rt, 4));
        CHECK(std::abs(turn) < 2e-3 * rt);  // the mesh: sections turn by 0.06 of r t / r per element
    }
    CHECK(std::abs(error<Beam<QuadraticStrain::none, TwistStrain::turn>>(0.3, 32, true)) < 1e-3);  // nor does it pull at its ends
}

TEST_CASE("the quadratic part of the axial strain stiffens a rod of given length, as long fibres on its surface do") {
    // Mean of E_33: (r t)^2 / 4 of every section, E A (r t)^2 / 4 of tension where the length is held, and its work.
    const double rt = 0.2, turn = error<Beam<QuadraticStrain::mean, TwistStrain::turn>>(rt, 32, true);
    std::printf("length held, mean: %+.4f %%\n", 100.0 * turn);
    CHECK(std::abs(turn - 0.5 * (1.0 + poisson) * rt * rt) < rt * rt * rt * rt);
    CHECK(std::abs(error<Beam<QuadraticStrain::mean, TwistStrain::turn>>(rt, 32, false)) < 1e-3);
}

TEST_CASE("the mesh of a twisted rod converges with the fourth order") {
    using B = Beam<QuadraticStrain::none, TwistStrain::turn>;
    const double coarse = error<B>(0.3, 16, false), fine = error<B>(0.3, 32, false), order = std::log2(coarse / fine);
    std::printf("turn, r t = 0.3: 16 elements %.2e, 32 %.2e, order %.2f\n", coarse, fine, order);
    CHECK(order > 3.5);
}

}  // namespace verification_torsion_test
