// SPDX-License-Identifier: MIT
#include <fibrant/solid/hexahedron.hpp>

#include <near.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

using namespace fibrant;

namespace hexahedron_test {

using solid::CellMatrix;
using solid::CellNodes;
using solid::CellVector;

using Law = solid::SaintVenantKirchhoff;
using Plain = solid::Hexahedron<solid::PlainStrains, Law>;
using Enhanced = solid::Hexahedron<solid::EnhancedStrains, Law>;
using EnhancedNeoHookean = solid::Hexahedron<solid::EnhancedStrains, solid::NeoHookean>;

const scene::ElasticMaterial material{1000.0, 0.3};

CellNodes distorted(std::mt19937& generator, double size) {
    std::uniform_real_distribution<double> draw(-size, size);
    CellNodes nodes;
    for (int k = 0; k < 8; ++k) {
        const Vec3 c = solid::corner(k);
        nodes.row(k) << 1.3 * c.x() + draw(generator), 0.9 * c.y() + draw(generator), 0.6 * c.z() + draw(generator);
    }
    return nodes;
}
CellNodes moved(const CellNodes& nodes, const CellVector& step) {
    CellNodes out = nodes;
    for (int k = 0; k < 8; ++k) out.row(k) += step.segment<3>(3 * k).transpose();
    return out;
}
CellVector random_step(std::mt19937& generator, double size) {
    std::uniform_real_distribution<double> draw(-size, size);
    CellVector step;
    for (int k = 0; k < 24; ++k) step[k] = draw(generator);
    return step;
}

TEST_CASE_TEMPLATE("force and tangent are derivatives of the energy, and the tangent is symmetric", Element, Plain, Enhanced,
                   EnhancedNeoHookean) {
    const Element element;
    std::mt19937 generator(1);
    for (int sample = 0; sample < 5; ++sample) {
        const CellNodes nodes = distorted(generator, 0.15), now = moved(nodes, random_step(generator, 0.1));
        const typename Element::Rest rest = Element::rest(nodes);
        CellVector force;
        CellMatrix tangent;
        element.force_and_tangent(rest, material, now, force, tangent);
        CHECK((force - element.force(rest, material, now)).norm() <= 1e-13 * force.norm());
        CHECK((tangent - tangent.transpose()).norm() <= 1e-13 * tangent.norm());
        const double step = 1e-5;  // truncation of the order step^2, rounding 1e-16 / step
        for (int k = 0; k < 24; ++k) {
            const CellVector one = step * CellVector::Unit(k);
            const CellNodes more = moved(now, one), less = moved(now, -one);
            CHECK(std::abs((element.energy(rest, material, more) - element.energy(rest, material, less)) / (2.0 * step) -
                           force[k]) <= 1e-7 * tangent.norm());
            CHECK(((element.force(rest, material, more) - element.force(rest, material, less)) / (2.0 * step) - tangent.col(k))
                      .norm() <= 1e-7 * tangent.norm());
        }
    }
}

TEST_CASE_TEMPLATE("a cell has six motions without energy, and no other", Element, Plain, Enhanced, EnhancedNeoHookean) {
    const Element element;
    std::mt19937 generator(2);
    const CellNodes nodes = distorted(generator, 0.15);
    CellVector force;
    CellMatrix tangent;
    element.force_and_tangent(Element::rest(nodes), material, nodes, force, tangent);
    CHECK(force.norm() <= 1e-12 * tangent.norm());
    const Vector values = Eigen::SelfAdjointEigenSolver<CellMatrix>(tangent).eigenvalues();
    CHECK(std::abs(values[5]) <= 1e-12 * values[23]);
    CHECK(values[6] >= 1e-3 * values[23]);
}

TEST_CASE_TEMPLATE("a rigid motion leaves the energy, and turns the forces with it", Element, Plain, Enhanced,
                   EnhancedNeoHookean) {
    const Element element;
    std::mt19937 generator(3);
    const CellNodes nodes = distorted(generator, 0.15), now = moved(nodes, random_step(generator, 0.1));
    const typename Element::Rest rest = Element::rest(nodes);
    const Mat3 turn = Eigen::AngleAxisd(2.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
    const Eigen::RowVector3d shift(0.3, -4.0, 2.0);
    const CellNodes rigid = (nodes * turn.transpose()).rowwise() + shift, turned = (now * turn.transpose()).rowwise() + shift;
    const double energy = element.energy(rest, material, now);
    CHECK(element.energy(rest, material, rigid) <= 1e-26 * material.young_modulus);
    CHECK(element.force(rest, material, rigid).norm() <= 1e-11 * material.young_modulus);  // the digits of 4 lengths
    CHECK(element.energy(rest, material, turned) == test::near(energy, 1e-12));
    const CellVector force = element.force(rest, material, now), after = element.force(rest, material, turned);
    for (int k = 0; k < 8; ++k) CHECK((turn * force.segment<3>(3 * k) - after.segment<3>(3 * k)).norm() <= 1e-11 * force.norm());
}

TEST_CASE_TEMPLATE("distorted cells meet a uniform finite strain exactly", Element, Plain, Enhanced, EnhancedNeoHookean) {
    const Element element;
    std::mt19937 generator(4);
    Mat3 f;
    f << 1.1, 0.2, -0.05, 0.0, 0.93, 0.1, 0.07, 0.0, 1.05;
    const Mat3 strain = 0.5 * (f.transpose() * f - Mat3::Identity());
    for (int sample = 0; sample < 10; ++sample) {
        const CellNodes nodes = distorted(generator, 0.2), now = nodes * f.transpose();
        const typename Element::Rest rest = Element::rest(nodes);
        const auto states = element.states(rest, material, now);
        for (const auto& state : states) {
            CHECK((state.strain - strain).norm() <= 1e-13);
            CHECK((state.stress - states[0].stress).norm() <= 1e-12 * states[0].stress.norm());
        }
        // Forces are those of the uniform nominal stress: sum of f (x) X = V P, whatever the cell's shape.
        const CellVector force = element.force(rest, material, now);
        Mat3 sum = Mat3::Zero();
        for (int k = 0; k < 8; ++k) sum += force.segment<3>(3 * k) * nodes.row(k);
        const Mat3 nominal = f.determinant() * states[0].stress * f.inverse().transpose();
        CHECK((sum - rest.size() * nominal).norm() <= 1e-12 * sum.norm());
    }
}

TEST_CASE("without compression the geometric stiffness adds nothing negative") {
    const Enhanced element;
    std::mt19937 generator(6);
    const CellNodes nodes = distorted(generator, 0.1);
    CellNodes now = nodes;
    now.col(0) *= 0.85;
    CellVector force;
    CellMatrix all, kept;
    const auto rest = Enhanced::rest(nodes);
    element.force_and_tangent(rest, material, now, force, all);
    element.force_and_tangent(rest, material, now, force, kept, true);
    CHECK(Eigen::SelfAdjointEigenSolver<CellMatrix>(all).eigenvalues()[0] < -1e-3 * all.norm());
    CHECK(Eigen::SelfAdjointEigenSolver<CellMatrix>(kept).eigenvalues()[0] >= -1e-12 * kept.norm());
}

/// Deflection of the end of a clamped plate strip under an end force, small loads, over that of plate theory (cylindrical
/// bending: the sides are held, so D = E h^3 / (12 (1 - nu^2)) a unit of width), with the shear deformation of thick ones added.
template <class Element>
double plate_deflection(Index along, Index through, double length, double thickness, double skew = 0.0) {
    const Element element;
    const double width = length / static_cast<double>(along);
    std::vector<Vec3> nodes;
    const auto node = [&](Index i, Index j, Index k) { return (i * 2 + j) * (through + 1) + k; };
    for (Index i = 0; i <= along; ++i)
        for (Index j = 0; j < 2; ++j)
            for (Index k = 0; k <= through; ++k) {
                const double z = thickness * (static_cast<double>(k) / static_cast<double>(through) - 0.5);
                nodes.push_back(
                    {length * static_cast<double>(i) / static_cast<double>(along), width * static_cast<double>(j), z});
                if (i > 0 && i < along) nodes.back().x() += skew * (i % 2 == 0 ? 1.0 : -1.0) * width * (j == 0 ? 1.0 : -1.0);
            }
    std::vector<Eigen::Triplet<double, int>> entries;
    const Index n = 3 * core::count(nodes);
    const auto held = [&](Index unknown) {  // the clamp leaves the thickness free; the sides keep their planes
        const Index at = unknown / 3, axis = unknown % 3;
        if (axis == 1) return true;
        if (at >= 2 * (through + 1)) return false;
        return axis == 0 || at % (through + 1) == through / 2;
    };
    for (Index i = 0; i < along; ++i)
        for (Index k = 0; k < through; ++k) {
            const std::array<Index, 8> list{node(i, 0, k),     node(i + 1, 0, k),     node(i + 1, 1, k),     node(i, 1, k),
                                            node(i, 0, k + 1), node(i + 1, 0, k + 1), node(i + 1, 1, k + 1), node(i, 1, k + 1)};
            CellNodes cell;
            for (int a = 0; a < 8; ++a) cell.row(a) = nodes[core::at(list[core::at(a)])].transpose();
            CellVector force;
            CellMatrix tangent;
            element.force_and_tangent(Element::rest(cell), material, cell, force, tangent);
            for (int a = 0; a < 24; ++a)
                for (int b = 0; b < 24; ++b) {
                    const Index row = 3 * list[core::at(a / 3)] + a % 3, column = 3 * list[core::at(b / 3)] + b % 3;
                    if (held(row) || held(column)) continue;
                    entries.emplace_back(static_cast<int>(row), static_cast<int>(column), tangent(a, b));
                }
        }
    Vector load = Vector::Zero(n);
    for (Index u = 0; u < n; ++u)
        if (held(u)) entries.emplace_back(static_cast<int>(u), static_cast<int>(u), 1.0);
    for (Index j = 0; j < 2; ++j)
        for (Index k = 0; k <= through; ++k)
            load[3 * node(along, j, k) + 2] = (k == 0 || k == through ? 0.25 : 0.5) / static_cast<double>(through);  // sum 1
    SparseMatrix a(n, n);
    a.setFromTriplets(entries.begin(), entries.end());
    const Vector x = Eigen::SimplicialLDLT<SparseMatrix>(a).solve(load);
    const double tip = x[3 * node(along, 0, through / 2) + 2];
    const double nu = material.poisson_ratio, e = material.young_modulus / (1.0 - nu * nu), h = thickness;
    const double bending = length * length * length * 12.0 / (3.0 * e * width * h * h * h);
    const double shear = length / (5.0 / 6.0 * material.shear_modulus() * width * h);
    return tip / (bending + shear);
}

TEST_CASE("a plate bends as plate theory says with one enhanced element through the thickness; plain strains lock") {
    // One element of the length 1 for a thickness of 0.2: L/h = 50.
    for (const Index through : {1, 2, 4}) {
        const double enhanced = plate_deflection<Enhanced>(10, through, 10.0, 0.2);
        MESSAGE("elements through the thickness " << through << ": enhanced " << enhanced << ", plain "
                                                  << plate_deflection<Plain>(10, through, 10.0, 0.2));
        // Under an end force the error of elements whose curvature is constant is 1/(4 n^2) of the deflection: 0.0025 for n = 10.
        CHECK(enhanced == test::near(1.0 - 0.0025, 5e-4));
    }
    CHECK(plate_deflection<Plain>(10, 1, 10.0, 0.2) < 0.12);
    CHECK(plate_deflection<Plain>(10, 4, 10.0, 0.2) < 0.12);  // more of them through the thickness do not help
    // Finer along the plate the error falls as 1/n^2.
    const double coarse = 1.0 - plate_deflection<Enhanced>(5, 1, 10.0, 0.2),
                 fine = 1.0 - plate_deflection<Enhanced>(20, 1, 10.0, 0.2);
    CHECK(coarse / fine == test::near(16.0, 0.1));
    // Trapezoids in the plane of the plate are a limit of the modes: bent, such thin cells shear. Grids that are regular in plan
    // have none.
    const double trapezoids = plate_deflection<Enhanced>(10, 1, 10.0, 0.2, 0.1);
    MESSAGE("trapezoids in plan: " << trapezoids << ", plain " << plate_deflection<Plain>(10, 1, 10.0, 0.2, 0.1));
    CHECK(trapezoids > 0.5);
    CHECK(trapezoids < 1.0);
}

}  // namespace hexahedron_test
