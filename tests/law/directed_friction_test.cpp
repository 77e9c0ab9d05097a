// SPDX-License-Identifier: MIT
#include <fibrant/law/directed_friction.hpp>
#include <fibrant/law/physical_normal.hpp>
#include <fibrant/law/shaped_friction.hpp>
#include <near.hpp>

#include <refusal.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <type_traits>

using namespace fibrant;

namespace directed_friction_test {

using law::AdhesiveFriction;
using law::DirectedFriction;
using law::SlipWeakeningFriction;
using law::Touch;
using Lubricated = law::Lubricated<AdhesiveFriction>;
const double degree = std::numbers::pi / 180.0;

DirectedFriction crossed(double along, double across) {
    return DirectedFriction({.along = along, .across = across, .reversible_displacement = 1e-3});
}
template <class L>
L sample();
template <>
DirectedFriction sample<DirectedFriction>() {
    return DirectedFriction({.along = 0.2,
                             .across = 0.4,
                             .exponent = 0.8,
                             .crossing_along = 0.15,
                             .crossing_across = 0.3,
                             .reversible_displacement = 1e-3});
}
template <>
AdhesiveFriction sample<AdhesiveFriction>() {
    return AdhesiveFriction(
        {.friction_coefficient = 0.3, .line_adhesion = 5.0, .crossing_adhesion = 0.7, .reversible_displacement = 1e-3});
}
template <>
SlipWeakeningFriction sample<SlipWeakeningFriction>() {
    return SlipWeakeningFriction(
        {.static_coefficient = 0.5, .kinetic_coefficient = 0.2, .weakening_length = 0.01, .reversible_displacement = 1e-3});
}
template <>
law::ShapedFriction sample<law::ShapedFriction>() {
    return law::ShapedFriction({.friction_coefficient = 0.2,
                                .reversible_displacement = 1e-3,
                                .shape = {.across = 2.0,
                                          .exponent = 0.8,
                                          .line_load = 30.0,
                                          .line_adhesion = 5.0,
                                          .crossing_adhesion = 0.7,
                                          .static_over_kinetic = 2.5,
                                          .weakening_length = 0.01}});
}
template <>
Lubricated sample<Lubricated>() {
    Lubricated law(
        {.law = {.friction_coefficient = 0.3, .line_adhesion = 5.0, .crossing_adhesion = 0.7, .reversible_displacement = 1e-3},
         .viscosity = 40.0,
         .crossing_viscosity = 3.0});
    law.last(0.1);
    return law;
}

TEST_CASE_TEMPLATE("a law that sees has its derivatives, a potential, no direction of its own, and no element's size", L,
                   DirectedFriction, AdhesiveFriction, SlipWeakeningFriction, law::ShapedFriction, Lubricated) {
    const L law = sample<L>();
    std::mt19937_64 generator(5);
    std::normal_distribution<double> normal;
    const auto flat = [&](double size) { return Vec3(size * normal(generator), size * normal(generator), 0.0); };
    typename L::History memory;
    const bool rate = law::FrictionWithRate<L>;
    for (int k = 0; k < 40; ++k) {
        Touch touch{flat(k % 3 == 0 ? 2e-4 : 2e-3), flat(1.0).normalized(), flat(1.0).normalized(), Vec3::UnitZ(),
                    std::exp(normal(generator)),    k % 2 == 0 ? 0.02 : 0.0};
        const auto now = law.response(touch, memory);
        CHECK(now.dissipated >= 0.0);
        const double h = 1e-9;
        Vec3 by_energy = Vec3::Zero();
        Mat3 slope = Mat3::Zero();
        for (int c = 0; c < 2; ++c) {
            Touch ahead = touch, behind = touch;
            ahead.slip[c] += h, behind.slip[c] -= h;
            const auto a = law.response(ahead, memory), b = law.response(behind, memory);
            slope.col(c) = (a.force - b.force) / (2.0 * h);
            by_energy[c] = (a.stored + a.dissipated - b.stored - b.dissipated) / (2.0 * h);
        }
        CHECK(Mat3((slope - now.tangent) * Vec3(1, 1, 0).asDiagonal()).norm() < 1e-5 * now.tangent.norm());
        if (!rate) CHECK((by_energy - now.force).norm() < 1e-5 * now.force.norm());
        Touch more = touch, less = touch;
        more.reaction *= 1.0 + 1e-6, less.reaction *= 1.0 - 1e-6;
        const Vec3 by_reaction = (law.response(more, memory).force - law.response(less, memory).force) / (2e-6 * touch.reaction);
        CHECK((by_reaction - now.by_reaction).norm() < 1e-7 * now.force.norm() / touch.reaction);
        // Two elements of half the length and half the reaction. A crossing stands for itself.
        if (touch.length > 0.0) {
            Touch half = touch;
            half.length *= 0.5, half.reaction *= 0.5;
            const auto part = law.response(half, memory);
            CHECK((2.0 * part.force - now.force).norm() < 1e-13 * now.force.norm());
            CHECK(std::abs(2.0 * part.dissipated - now.dissipated) <= 1e-12 * now.dissipated);
            CHECK((part.history.reversible - now.history.reversible).norm() < 1e-13 * 1e-3);
        }
        const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(1, 2, -1).normalized()).toRotationMatrix();
        Touch turned = touch;
        for (Vec3* v : {&turned.slip, &turned.along_i, &turned.along_j, &turned.normal}) *v = turn * *v;
        typename L::History turned_memory = memory;
        turned_memory.reversible = turn * memory.reversible;
        CHECK((law.response(turned, turned_memory).force - turn * now.force).norm() < 1e-12 * now.force.norm());
        memory = now.history;
    }
    Touch open{flat(1.0), Vec3::UnitX(), Vec3::UnitX(), Vec3::UnitZ(), 0.0, 0.02};
    CHECK(law.response(open, memory).force.isZero(0.0));
}

/// Force after sliding far enough along an angle, over the reaction.
Vec3 sliding(const DirectedFriction& law, double angle, double of_j) {
    Touch touch{50.0 * Vec3(std::cos(angle), std::sin(angle), 0.0),
                Vec3::UnitX(),
                Vec3(std::cos(of_j), std::sin(of_j), 0.0),
                Vec3::UnitZ(),
                3.0,
                0.0};
    return law.response(touch, {}).force / 3.0;
}

TEST_CASE("friction along and across a fibre: resistance, side force, and a block on an incline") {
    const DirectedFriction law = crossed(0.2, 0.4);
    const double psi[] = {0, 30, 45, 60, 90}, resistance[] = {0.2, 0.264575, 0.316228, 0.360555, 0.4},
                 size[] = {0.2, 0.329502, 0.368782, 0.388290, 0.4};
    for (int k = 0; k < 5; ++k) {
        const Vec3 way(std::cos(psi[k] * degree), std::sin(psi[k] * degree), 0.0), force = sliding(law, psi[k] * degree, 0.0);
        CHECK(force.dot(way) == test::near(resistance[k], 1e-5));
        CHECK(force.norm() == test::near(size[k], 1e-5));
    }
    // Crossed fibres, slid along one of them: M is the mean of both ellipses.
    const double angle[] = {0, 30, 60, 90}, along[] = {0.2, 0.234521, 0.291548, 0.316228}, side[] = {0, -0.110782, -0.089113, 0};
    for (int k = 0; k < 4; ++k) {
        const Vec3 force = sliding(law, 0.0, angle[k] * degree);
        CHECK(force.x() == test::near(along[k], 1e-5));
        CHECK(std::abs(force.y() - side[k]) < 1e-6);  // the digits of the table
    }
    // An incline of the drive phi to the fibre, steepened until the block slides: the force that holds it leaves the ellipse.
    const double phi[] = {0, 15, 30, 45, 60, 75, 90},
                 alpha[] = {11.309932, 11.597313, 12.510125, 14.196947, 16.823825, 20.052189, 21.801409};
    const double first[] = {0, 3.832364, 8.213211, 14.036243, 23.413224, 43.015246, 90};
    for (int k = 0; k < 7; ++k) {
        const double c = std::cos(phi[k] * degree), s = std::sin(phi[k] * degree),
                     most = 1.0 / std::sqrt(c * c / 0.04 + s * s / 0.16);
        CHECK(std::atan(most) / degree == test::near(alpha[k], 1e-6));
        // It slides along M^-1 of the drive: there the law's force is that of the drive.
        const Vec3 force = sliding(law, first[k] * degree, 0.0);
        CHECK(force.norm() == test::near(most, 1e-6));
        CHECK(std::abs(std::atan2(force.y(), force.x()) / degree - phi[k]) < 1e-5 * std::max(phi[k], 1.0));
    }
    // Isotropic, it is Coulomb's law, also across an angle.
    CHECK(sliding(crossed(0.3, 0.3), 1.0, 0.4).norm() == test::near(0.3));
}

TEST_CASE("friction of a power of the pressure wraps a cylinder as the capstan of that law says, however the line is cut") {
    // q = T / R a unit of length carries a q^n: T1/T0 = [1 + (1-n) mu0 theta]^(1/(1-n)), mu0 = a (T0/R)^(n-1).
    const double R = 0.5, T0 = 1.0, mu0 = 0.15;
    struct Row {
        double n, half, twice;
    };
    for (const Row& row : {Row{2.0 / 3.0, 1.549137, 4.317358}, Row{0.8, 1.568839, 4.950576}, Row{0.9, 1.584823, 5.623098}}) {
        const double a = mu0 * std::pow(T0 / R, 1.0 - row.n);
        const DirectedFriction law({.along = a,
                                    .across = a,
                                    .exponent = row.n,
                                    .crossing_along = 0.1,
                                    .crossing_across = 0.1,
                                    .reversible_displacement = 1e-6});
        for (const int pieces : {400, 800}) {
            double T = T0;
            for (int k = 0; k < 4 * pieces; ++k) {
                const double angle = std::numbers::pi / pieces;
                // Midpoint rule: the tension in the middle of a piece presses it on.
                const auto force = [&](double tension) {
                    return law
                        .response({Vec3(1, 0, 0), Vec3::UnitX(), Vec3::UnitX(), Vec3::UnitZ(), tension * angle, R * angle}, {})
                        .force.x();
                };
                const double middle = T + 0.5 * force(T);
                T += force(middle);
                if (k + 1 == pieces) CHECK(T == test::near(row.half, 2e-6));
            }
            CHECK(T == test::near(row.twice, 2e-6));
        }
    }
    // Where the pressure vanishes the coefficient would grow without a bound.
    const DirectedFriction law({.along = 0.2,
                                .across = 0.4,
                                .exponent = 0.5,
                                .crossing_along = 0.1,
                                .crossing_across = 0.1,
                                .largest_coefficient = 1.5,
                                .reversible_displacement = 1e-3});
    CHECK(law.response({Vec3(1, 0, 0), Vec3::UnitX(), Vec3::UnitX(), Vec3::UnitZ(), 1e-9, 1.0}, {}).force.x() / 1.5e-9 ==
          test::near(1.0));
    CHECK(test::refusal([] {
              DirectedFriction({.along = 0.2, .across = 0.4, .exponent = 0.5, .reversible_displacement = 1.0});
          }).find("crossing_along") != std::string::npos);
}

TEST_CASE("a stuck pair resists without much load, a way slid weakens it, and a fluid resists by rate") {
    const AdhesiveFriction sticky = sample<AdhesiveFriction>();
    const auto far = [](const auto& law, double reaction, double length) {
        return law.response({Vec3(1, 0, 0), Vec3::UnitX(), Vec3::UnitX(), Vec3::UnitZ(), reaction, length}, {}).force.x();
    };
    CHECK(far(sticky, 1e-12, 2.0) == test::near(0.3 * 10.0));
    CHECK(far(sticky, 2.0, 0.0) == test::near(0.3 * 2.7));
    const SlipWeakeningFriction weak = sample<SlipWeakeningFriction>();
    SlipWeakeningFriction::History memory;
    double first = 0.0, last = 0.0;
    for (int k = 0; k < 200; ++k) {
        const auto now = weak.response({Vec3(1e-3, 0, 0), Vec3::UnitX(), Vec3::UnitX(), Vec3::UnitZ(), 2.0, 0.0}, memory);
        if (k == 1) first = now.force.x();
        last = now.force.x(), memory = now.history;
    }
    CHECK(first == test::near(1.0));  // static
    CHECK(last == test::near(0.4, 1e-6));
    CHECK(memory.numbers[0] == test::near(0.2 - 1e-3, 1e-9));
    Lubricated wet(
        {.law = {.friction_coefficient = 0.3, .line_adhesion = 0.0, .crossing_adhesion = 0.0, .reversible_displacement = 1e-3},
         .viscosity = 4.0,
         .crossing_viscosity = 0.0});
    wet.last(0.5);
    CHECK(far(wet, 2.0, 0.25) == test::near(0.6 + 4.0 * 0.25 / 0.5));
}

TEST_CASE(
    "friction by a coefficient and a shape is each of the laws that have one of its parts, and none at a coefficient of 0") {
    const double mu = 0.2, n = 0.8, q = 30.0, a = mu * std::pow(q, 1.0 - n), u = 1e-3;
    const auto shaped = [&](const law::FrictionShape& shape, double coefficient) {
        return law::ShapedFriction(law::friction_parameters<law::ShapedFriction>(coefficient, u, shape));
    };
    const auto same = [](const auto& one, const auto& other, double way) {
        for (const double length : {0.0, 0.02}) {
            Touch touch{Vec3(2e-3, 1e-3, 0), Vec3::UnitX(), Vec3(0.6, 0.8, 0), Vec3::UnitZ(), 1.7, length};
            typename std::decay_t<decltype(one)>::History mine;
            typename std::decay_t<decltype(other)>::History theirs;
            mine.numbers[0] = way;
            if constexpr (requires { theirs.numbers; }) theirs.numbers[0] = way;
            const auto here = one.response(touch, mine);
            const auto there = other.response(touch, theirs);
            CHECK((here.force - there.force).norm() < 1e-13 * there.force.norm());
            CHECK((here.by_reaction - there.by_reaction).norm() < 1e-13 * there.by_reaction.norm());
            CHECK(here.dissipated == test::near(there.dissipated, 1e-13));
            if constexpr (requires { theirs.numbers; })
                CHECK(here.history.numbers[0] == test::near(there.history.numbers[0], 1e-13));
        }
    };
    same(shaped({.across = 2.0, .exponent = n, .line_load = q}, mu),
         DirectedFriction({.along = a,
                           .across = 2.0 * a,
                           .exponent = n,
                           .crossing_along = mu,
                           .crossing_across = 2.0 * mu,
                           .reversible_displacement = u}),
         0.0);
    // Where pressure would make the coefficient larger than it may be, it depends on pressure no more.
    same(shaped({.exponent = n, .line_load = q, .largest_coefficient = 0.1}, mu),
         DirectedFriction({.along = 0.1,
                           .across = 0.1,
                           .exponent = 1.0,
                           .crossing_along = mu,
                           .crossing_across = mu,
                           .reversible_displacement = u}),
         0.0);
    same(shaped({.line_adhesion = 5.0, .crossing_adhesion = 0.7}, mu),
         AdhesiveFriction(
             {.friction_coefficient = mu, .line_adhesion = 5.0, .crossing_adhesion = 0.7, .reversible_displacement = u}),
         0.0);
    same(shaped({.static_over_kinetic = 2.5, .weakening_length = 0.01}, mu),
         SlipWeakeningFriction(
             {.static_coefficient = 0.5, .kinetic_coefficient = mu, .weakening_length = 0.01, .reversible_displacement = u}),
         0.004);
    const Touch touch{Vec3(2e-3, 1e-3, 0), Vec3::UnitX(), Vec3::UnitX(), Vec3::UnitZ(), 1.7, 0.02};
    CHECK(shaped({.line_adhesion = 5.0}, 0.0).response(touch, {}).force.isZero(0.0));
    CHECK(test::refusal([&] { shaped({.exponent = 0.5}, mu); }).find("FrictionShape.line_load = nan") != std::string::npos);
    CHECK(test::refusal([&] { shaped({.static_over_kinetic = 0.9}, mu); }).find("FrictionShape.static_over_kinetic = 0.9") !=
          std::string::npos);
}

TEST_CASE("physical normal laws push, by an energy, alike however a line is cut, and as Hertz says") {
    const law::PowerNormal power({.line_stiffness = 40.0, .line_exponent = 2.4, .crossing_stiffness = 7.0});
    const law::HardeningNormal hardening({.line_force = 3.0, .crossing_force = 0.2, .share = 0.6});
    const auto check = [](const auto& law) {
        for (const double length : {0.0, 0.3})
            for (const double p : {-0.01, 0.001, 0.02, 0.05, 0.059, 0.07}) {
                const law::Approach at{-p, length, 0.1};
                const auto moved = [&](double by) { return law::Approach{-p + by, length, 0.1}; };
                const double h = 1e-8;
                const law::NormalResponse now = law.response(at);
                CHECK(now.reaction >= 0.0);
                CHECK(std::abs((law.response(moved(h)).reaction - law.response(moved(-h)).reaction) / (2.0 * h) - now.slope) <=
                      1e-5 * std::abs(now.slope));
                CHECK(std::abs((law.energy(moved(-h)) - law.energy(moved(h))) / (2.0 * h) - now.reaction) <= 1e-5 * now.reaction);
                if (length > 0.0)
                    CHECK(std::abs(2.0 * law.response({-p, 0.5 * length, 0.1}).reaction - now.reaction) <= 1e-14 * now.reaction);
            }
    };
    check(power), check(hardening);
    CHECK(power.response({-0.04, 0.0, 0.1}).reaction / (7.0 * 0.008) == test::near(1.0));
}

}  // namespace directed_friction_test
