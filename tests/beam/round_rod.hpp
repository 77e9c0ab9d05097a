// SPDX-License-Identifier: MIT
#pragma once
/// @file Round rods of the verification cases: stiffnesses, and what a table of errors owes.

#include <support/rod.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include <cstdio>
#include <numbers>
#include <vector>

namespace fibrant::test {

/// Inputs that all round rods share. Any consistent units.
struct RoundRod {
    double radius = 0.0201;
    double length = 2.01;
    double young = 7300.0;
    double poisson = 0.3;

    double EA() const { return young * std::numbers::pi * radius * radius; }
    double EI() const { return young * std::numbers::pi * std::pow(radius, 4) / 4.0; }
    double GA() const { return EA() / (2.0 * (1.0 + poisson)); }
    double GJ() const { return EI() / (1.0 + poisson); }
    scene::ElasticMaterial material() const { return {young, poisson}; }
    beam::SectionConstants section() const { return beam::section_constants(scene::circular(radius)); }

    /// Straight along +z unless another rest shape is given.
    template <class Beam = beam::DirectorBeam<3>>
    Rod<Beam> mesh(int intervals) const {
        return {Beam{}, section(), material(), intervals, length, straight};
    }
    template <class Shape>
    Rod<> mesh(int intervals, const Shape& shape) const {
        return {beam::DirectorBeam<3>{}, section(), material(), intervals, length, shape};
    }
};

/// Exponents p of error ~ n^-p between successive halvings.
inline double order(double coarse, double fine) { return std::log2(coarse / fine); }

/// Relative difference.
inline double off(double value, double reference) { return std::abs(value - reference) / std::abs(reference); }

/// Prints one line of a table of errors against node intervals.
inline void print_row(const char* what, const std::vector<double>& values) {
    std::printf("%-46s", what);
    for (const double v : values) std::printf(" %9.2e", v);
    std::printf("\n");
}

}  // namespace fibrant::test
