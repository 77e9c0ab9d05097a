// SPDX-License-Identifier: MIT
#include <fibrant/assembly/chain_rows.hpp>

#include <doctest/doctest.h>

#include <random>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

using namespace fibrant;

namespace chain_rows_test {

constexpr int block = 6, reach = 2;
using Rows = assembly::ChainRows<block, reach>;
using Element = Eigen::Matrix<double, 3 * block, 3 * block>;

/// Ten equal chains, which share packs, one of another length, and one of a single element.
scene::DofLayout chains() {
    scene::DofLayout layout;
    Index vectors = 0;
    for (Index c = 0; c < 12; ++c) {
        const Index nodes = c < 10 ? 7 : c == 10 ? 9 : 3;
        layout.chains.push_back({vectors, nodes, block / 3, reach, -1, false});
        vectors += nodes * (block / 3);
    }
    layout.kind.assign(core::at(vectors), scene::VectorKind::position);
    layout.length.assign(core::at(vectors), 1.0);
    layout.value.assign(core::at(vectors), Vec3::Zero());
    return layout;
}

/// Adds an element's lower blocks, as systems do.
void add(Rows& rows, Index chain, Index element, const Element& stiffness) {
    for (Index a = 0; a < 3; ++a)
        for (Index b = 0; b <= a; ++b)
            rows.add(chain, 2 * element + a, 0, (reach - (a - b)) * block, stiffness.block<block, block>(a * block, b * block));
}

TEST_CASE("a chain's band has the same bits whether it was open for all that was added, for a part of it, or not at all") {
    const scene::DofLayout layout = chains();
    Rows open(layout), half(layout), closed(layout);
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Matrix whole = Matrix::Zero(layout.unknowns(), layout.unknowns());
    for (Index c = 0; c < core::count(layout.chains); ++c) {
        const Index elements = (layout.chains[core::at(c)].nodes - 1) / 2, first = 3 * layout.chains[core::at(c)].first_vector;
        open.open(c), half.open(c);
        for (Index e = 0; e < elements; ++e) {
            Element stiffness;
            for (Index k = 0; k < stiffness.size(); ++k) stiffness.data()[k] = uniform(generator);
            stiffness = (stiffness + stiffness.transpose()).eval();
            for (Rows* rows : {&open, &half, &closed}) add(*rows, c, e, stiffness);
            if (e == elements / 2) half.close(c);
            whole.block<3 * block, 3 * block>(first + 2 * e * block, first + 2 * e * block) += stiffness;
        }
        open.close(c);
    }
    Vector x(layout.unknowns()), y(layout.unknowns());
    for (double& value : x) value = uniform(generator);
    for (Index p = 0; p < open.product().packs(); ++p) open.product().apply(p, x, y);
    CHECK((y - whole * x).norm() < 1e-14 * whole.norm() * x.norm());
    for (Index c = 0; c < core::count(layout.chains); ++c) {
        const Index nodes = layout.chains[core::at(c)].nodes, first = 3 * layout.chains[core::at(c)].first_vector;
        Matrix band = Matrix::Zero(nodes * block, (reach + 1) * block);
        open.add_to(c, band);
        for (Index a = 0; a < nodes; ++a) {
            CHECK(open.row(c, a) == half.row(c, a));
            CHECK(open.row(c, a) == closed.row(c, a));
            for (Index d = 0; d <= std::min<Index>(a, reach); ++d) {
                const Matrix expected = whole.block<block, block>(first + a * block, first + (a - d) * block);
                CHECK(open.row(c, a).middleCols<block>((reach - d) * block) == expected);
                CHECK(band.block<block, block>(a * block, d * block) == expected);
            }
        }
    }
}

TEST_CASE("a chain that is opened again begins at zero, and others keep what they have") {
    const scene::DofLayout layout = chains();
    Rows rows(layout);
    for (Index c = 0; c < 10; ++c) add(rows, c, 0, static_cast<double>(c + 1) * Element::Identity());
    rows.open(4);
    rows.close(4);
    for (Index c = 0; c < 10; ++c) CHECK(rows.row(c, 1)(0, reach * block) == (c == 4 ? 0.0 : static_cast<double>(c + 1)));
}

TEST_CASE("what was added to an open chain is not read by halves, and rows are copies that nothing is written to") {
    static_assert(!std::is_assignable_v<decltype(std::declval<Rows&>().row(0, 0)), Rows::Row>);
    Rows rows(chains());
    rows.open(5);
    add(rows, 5, 0, Element::Identity());
    Matrix band = Matrix::Zero(7 * block, (reach + 1) * block);
    CHECK_THROWS_WITH_AS(rows.row(5, 0), doctest::Contains("chain 5 is read, but a chain must be closed first"),
                         std::logic_error);
    CHECK_THROWS_AS(rows.add_to(5, band), std::logic_error);
    CHECK_THROWS_AS(rows.require_closed(), std::logic_error);
    rows.add_to(4, band);
    CHECK(band.norm() == 0.0);
    rows.close(5);
    rows.require_closed();
    rows.add_to(5, band);
    CHECK(band.sum() == 3.0 * block);
}

}  // namespace chain_rows_test
