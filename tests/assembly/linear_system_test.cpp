// SPDX-License-Identifier: MIT
#include "support/synthetic_system.hpp"

#include <fibrant/assembly/term_assembly.hpp>

#include <doctest/doctest.h>

#include <Eigen/Cholesky>

using namespace fibrant;

namespace linear_system_test {

using test::SyntheticSystem;

// Director beams, cables, bars, a node of its own, held vectors of every kind.
SyntheticSystem mixed() {
    return test::random_system({.chains = {{.nodes = 7, .vectors_per_node = 3, .reach = 2},
                                           {.nodes = 5, .vectors_per_node = 2, .reach = 1},
                                           {.nodes = 4, .vectors_per_node = 1, .reach = 1},
                                           {.nodes = 1, .vectors_per_node = 4, .reach = 0}},
                                .points = 40,
                                .held = 6});
}

// A written out: F K F + (I - F), K summed from the terms as they are stored.
Matrix written_out(const SyntheticSystem& system) {
    const Index n = system.layout().unknowns();
    Matrix k = Matrix::Zero(n, n), f = Matrix::Identity(n, n);
    for (const auto& term : system.dense)
        for (Index i = 0; i < core::count(term.vectors); ++i)
            for (Index j = 0; j < core::count(term.vectors); ++j)
                k.block<3, 3>(3 * term.vectors[core::at(i)], 3 * term.vectors[core::at(j)]) +=
                    term.stiffness.block<3, 3>(3 * i, 3 * j);
    for (const auto& term : system.points) {
        Matrix w = Matrix::Zero(3, n);
        for (std::size_t i = 0; i < term.vectors.size(); ++i)
            w.middleCols<3>(3 * term.vectors[i]) += term.weights[i] * Mat3::Identity();
        k += w.transpose() * term.stiffness * w;
    }
    for (const auto& held : system.description.held) f.block<3, 3>(3 * held.vector, 3 * held.vector) = held.free;
    Matrix rest = Matrix::Identity(n, n) - f;  // as stiff as the chain is elsewhere
    for (const auto& held : system.description.held)
        rest.block<3, 3>(3 * held.vector, 3 * held.vector) *= system.description.held_stiffness(held.vector);
    return f * k * f + rest;
}

// Rounding of sums of some tens of entries of order 10.
constexpr double rounding = 1e-13;

TEST_CASE("a product visits every term once and leaves held components alone") {
    const SyntheticSystem system = mixed();
    const Matrix a = written_out(system);
    CHECK((test::dense_matrix(system) - a).norm() < rounding * a.norm());
    CHECK(a.isApprox(a.transpose(), rounding));
    Vector x = test::random_load(system.layout(), 3), y(x.size());
    system.apply(x, y);
    for (const scene::HeldVector& held : system.layout().held) {
        const Vec3 change =
            y.segment<3>(3 * held.vector) - system.layout().held_stiffness(held.vector) * x.segment<3>(3 * held.vector);
        CHECK((change - held.free * change).norm() < rounding);  // outside the free directions y is x times a stiffness
    }
}

TEST_CASE("the assembled matrix is the product's, both triangles, and is filled again in the same pattern") {
    SyntheticSystem system = mixed();
    assembly::TermAssembly terms;
    terms.analyse(system);
    SparseMatrix a;
    terms.fill(system, a);
    CHECK((Matrix(a) - written_out(system)).norm() < rounding * a.norm());
    const auto entries = a.nonZeros();
    for (auto& term : system.points) term.stiffness *= 3.0;
    terms.fill(system, a);
    CHECK(a.nonZeros() == entries);
    CHECK((Matrix(a) - written_out(system)).norm() < rounding * a.norm());
    for (Index k = 0; k < a.outerSize(); ++k)
        for (SparseMatrix::InnerIterator it(a, k), next(a, k); ++next; ++it) REQUIRE(it.row() < next.row());
}

TEST_CASE("bands and node blocks are the blocks of the matrix, and empty before a chain begins") {
    const SyntheticSystem system = mixed();
    const Matrix a = written_out(system);
    for (Index c = 0; c < core::count(system.layout().chains); ++c) {
        const scene::Chain& chain = system.layout().chains[core::at(c)];
        const Index m = 3 * chain.vectors_per_node, first = 3 * chain.first_vector;
        Matrix band, nodes;
        assembly::chain_band_from_terms(system, c, band);
        assembly::node_blocks_from_terms(system, c, nodes);
        REQUIRE(band.rows() == chain.nodes * m);
        REQUIRE(band.cols() == (chain.reach + 1) * m);
        REQUIRE(nodes.cols() == m);
        for (Index i = 0; i < chain.nodes; ++i)
            for (Index d = 0; d <= chain.reach; ++d) {
                const Matrix expected =
                    d <= i ? Matrix(a.block(first + i * m, first + (i - d) * m, m, m)) : Matrix(Matrix::Zero(m, m));
                CHECK((band.block(i * m, d * m, m, m) - expected).norm() <= rounding * a.norm());
                if (d == 0) CHECK((nodes.block(i * m, 0, m, m) - expected).norm() <= rounding * a.norm());
            }
    }
}

TEST_CASE("a projector projects vectors and blocks alike") {
    const SyntheticSystem system = mixed();
    const assembly::HeldProjector held(system.layout());
    const scene::HeldVector& some = system.layout().held[1];
    CHECK(held.free(some.vector) == &some.free);
    CHECK(held.free(some.vector + 1) == nullptr);
    Vector x = test::random_load(system.layout(), 3);
    Vector once = x;
    held.project(once);
    Vector twice = once;
    held.project(twice);
    CHECK((once - x).norm() > 0.1);
    CHECK((twice - once).norm() < rounding);
    Mat3 block = Mat3::Random();
    const Mat3 before = block;
    held.project(some.vector, some.vector + 1, block);
    CHECK((block - some.free * before).norm() < rounding);
}

}  // namespace linear_system_test
