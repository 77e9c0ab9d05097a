// SPDX-License-Identifier: MIT
#include "assembly/pressed_fibres.hpp"
#include "support/threads.hpp"

#include <fibrant/assembly/term_assembly.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <vector>

using namespace fibrant;

namespace chain_system_test {

using Rough = test::PressedFibres<law::RegularisedCoulomb>;
using Smooth = test::PressedFibres<law::Frictionless>;
using Centred = test::PressedFibres<law::Frictionless, beam::OnCentreline<beam::DirectorBeam<3>>>;

// Sums of some tens of entries, the largest of which are axial stiffnesses: relative to the whole.
constexpr double rounding = 1e-13;

TEST_CASE_TEMPLATE("the product is that of the matrix of all terms, held components included", Pressed, Smooth, Rough, Centred) {
    const Pressed fibres(true);
    REQUIRE(fibres.active() > 5);
    const auto& system = fibres.equilibrium.system();
    SparseMatrix a;
    assembly::assemble_from_terms(system, a);
    CHECK((Matrix(a) - Matrix(a).transpose()).norm() < rounding * a.norm());
    for (unsigned seed = 1; seed < 6; ++seed) {
        const Vector x = fibres.random_step(seed);
        Vector y(x.size()), generic(x.size());
        system.apply(x, y);
        assembly::apply_terms(system, x, generic);
        CHECK((y - a * x).norm() < rounding * a.norm() * x.norm());
        CHECK((y - generic).norm() < rounding * a.norm() * x.norm());
    }
}

/// Each band is what the terms couple within its reach.
void check_bands(const auto& system) {
    std::vector<Matrix> expected;
    assembly::chain_bands_from_terms(system, expected);
    for (Index f = 0; f < 3; ++f) {
        Matrix band, blocks;
        system.chain_band(f, band);
        REQUIRE(band.rows() == expected[core::at(f)].rows());
        CHECK((band - expected[core::at(f)]).norm() < rounding * band.norm());
        system.node_blocks(f, blocks);
        CHECK(blocks == band.leftCols(9));
    }
}

TEST_CASE_TEMPLATE("bands of fibres are those of their terms, with their own part of every contact", Pressed, Smooth, Rough,
                   Centred) {
    const Pressed fibres(true);
    check_bands(fibres.equilibrium.system());
}

TEST_CASE_TEMPLATE("and of every crossing whose place slides: else what couples two fibres would count without what each resists",
                   Pressed, Smooth, Centred) {
    const Pressed fibres(true, Vec3::Zero(), true);
    assembly::ChainSystem<typename Pressed::Beam> system(fibres.mesh);
    for (Index k = 0; k < core::count(fibres.contacts.elements()); ++k)
        if (fibres.contacts.slides(k)) system.slides().push_back(fibres.contacts.sliding(k, false));
    REQUIRE(system.slides().size() == 2);
    system.slides_in_bands_beyond = 0;
    system.index_points();
    check_bands(system);
}

TEST_CASE("stiffness that is added to a complete system acts at once; a fibre that is set to zero acts once all is indexed") {
    const Smooth fibres(false);
    assembly::ChainSystem<Smooth::Beam> system(fibres.mesh);
    Vector x = fibres.random_step(1), y(x.size());
    system.index_points();
    system.apply(x, y);
    CHECK(y.norm() == 0.0);
    const Mat3 spring = Vec3(3.0, 2.0, 1.0).asDiagonal();
    std::vector<Index> sprung;
    for (Index f = 0; f < 3; ++f) {
        const Index first = system.layout().chains[core::at(f)].first_vector;
        sprung.push_back(first + 5), sprung.push_back(first + 2 * 3 + 1);
        system.add_diagonal(first + 5, spring);
        system.add_to_row(f, 2, 3, 2 * 9 + 3, spring);  // of the second vector of a node with itself
    }
    const auto check = [&] {
        system.apply(x, y);
        for (Index v = 0; v < x.size() / 3; ++v) {
            Vec3 expected = Vec3::Zero();
            if (std::ranges::find(sprung, v) != sprung.end()) expected = spring * x.segment<3>(3 * v);
            CHECK(Vec3(y.segment<3>(3 * v)) == expected);
        }
        check_bands(system);
    };
    check();
    system.clear(2);
    Matrix band;
    CHECK_THROWS_AS(system.apply(x, y), std::logic_error);
    CHECK_THROWS_AS(system.chain_band(2, band), std::logic_error);
    system.index_points();
    system.add_diagonal(sprung[4], spring);
    system.add_to_row(2, 2, 3, 2 * 9 + 3, spring);
    check();
}

TEST_CASE("held components answer with a stiffness of the scene, and take nothing from the rest") {
    const Smooth fibres(true);
    const auto& system = fibres.equilibrium.system();
    REQUIRE(system.layout().held.size() == 6);  // three of the clamp, two of the axial rotation, the slanted one
    Vector x = fibres.random_step(1), y(x.size()), z(x.size());
    system.apply(x, y);
    for (const scene::HeldVector& held : system.layout().held) {
        const double own = system.layout().held_stiffness(held.vector);
        const Vec3 change = y.segment<3>(3 * held.vector) / own - x.segment<3>(3 * held.vector);
        CHECK((change - held.free * change).norm() < rounding * x.norm());
        const Vec3 other = Vec3(3, -1, 2) * x.norm();
        x.segment<3>(3 * held.vector) += other - held.free * other;
    }
    system.apply(x, z);
    for (const scene::HeldVector& held : system.layout().held) {
        const Vec3 change = held.free * (z - y).segment<3>(3 * held.vector);
        y.segment<3>(3 * held.vector) = z.segment<3>(3 * held.vector);
        CHECK(change.norm() < rounding * y.norm());
    }
    CHECK((z - y).norm() < rounding * y.norm());
}

TEST_CASE("a product without held components is the sum of all terms") {
    const Smooth held(true), free(false);
    const Vector x = held.random_step(3);
    Vector y(x.size()), z(x.size());
    held.equilibrium.system().apply_unheld(x, y);
    free.equilibrium.system().apply(x, z);
    CHECK((y - z).norm() < rounding * z.norm());
}

TEST_CASE("a product has the same bits on one thread and on two") {
    const Rough fibres(true);
    const Vector x = fibres.random_step(2);
    const auto product = [&] {
        Vector y(x.size());
        fibres.equilibrium.system().apply(x, y);
        return y;
    };
    const Vector one = test::with_threads(1, product), two = test::with_threads(2, product);
    CHECK(std::memcmp(one.data(), two.data(), static_cast<std::size_t>(one.size()) * sizeof(double)) == 0);
}

TEST_CASE("a direct solver follows contacts that come to carry force after its analysis") {
    Smooth fibres(true);
    solver::SparseCholesky solver;
    Vector apart = fibres.state;  // the crossing fibre and the second one lifted off
    for (Index v = 0; v < apart.size() / 3; v += 3)
        if (v >= apart.size() / 9) apart[3 * v + 2] += 3.0 * Smooth::radius;
    fibres.linearise(apart);
    const std::size_t before = fibres.equilibrium.system().points().size();
    solver.analyse(fibres.equilibrium.system());
    fibres.linearise(fibres.state);
    REQUIRE(fibres.equilibrium.system().points().size() > before);
    // Three rigid fibres on one clamp are not stable without more: a spring on everything makes the tangent definite.
    fibres.equilibrium.linearise(fibres.state, true, 1.0);
    REQUIRE(solver.prepare(fibres.equilibrium.system()) == solver::SolveStatus::converged);
    const Vector b = fibres.random_step(7);
    Vector x, y(b.size());
    CHECK(solver.solve(fibres.equilibrium.system(), b, 1e-10, x).status == solver::SolveStatus::converged);
    fibres.equilibrium.system().apply(x, y);
    CHECK(solver::scaled_norm(fibres.equilibrium.system().layout(), y - b) <
          1e-10 * solver::scaled_norm(fibres.equilibrium.system().layout(), b));
}

}  // namespace chain_system_test
