// SPDX-License-Identifier: MIT
#include "../support/random_vector.hpp"
#include "support/fabric_system.hpp"
#include "support/synthetic_system.hpp"

#include <fibrant/solver/rigid_coarse_space.hpp>

#include <doctest/doctest.h>

using namespace fibrant;

namespace rigid_coarse_space_test {

using test::SyntheticSystem;

// Chains of several kinds with everything that couples them: contact elements between chains and within one, near and
// far along it, an average over many nodes, and elements that several chains share.
SyntheticSystem coupled(int held) {
    SyntheticSystem system = test::random_system({.chains = {{.nodes = 9, .vectors_per_node = 3, .reach = 2, .group = 0},
                                                             {.nodes = 9, .vectors_per_node = 3, .reach = 2, .group = 0},
                                                             {.nodes = 6, .vectors_per_node = 3, .reach = 2, .group = 0},
                                                             {.nodes = 7, .vectors_per_node = 2, .reach = 1},
                                                             {.nodes = 5, .vectors_per_node = 1, .reach = 1},
                                                             {.nodes = 4, .vectors_per_node = 1, .reach = 0},
                                                             {.nodes = 1, .vectors_per_node = 3, .reach = 0}},
                                                  .points = 60,
                                                  .held = held,
                                                  .radius = 0.3,
                                                  .seed = 5});
    std::mt19937 generator(8);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (std::size_t c = 0; c < system.description.chains.size(); ++c) {
        const scene::Chain& chain = system.description.chains[c];
        for (Index k = 0; k < chain.nodes * chain.vectors_per_node; ++k) {
            Vec3 value = test::random_vector(uniform, generator);
            if (k % chain.vectors_per_node == 0)
                value = Vec3(static_cast<double>(k / chain.vectors_per_node), static_cast<double>(c), 0) + 0.1 * value;
            system.description.value[core::at(chain.first_vector + k)] = value;
        }
    }
    SyntheticSystem::Point average;  // over more nodes of one chain than its reach, and one of another
    for (const Index node : {0, 1, 2, 3, 5, 8}) average.vectors.push_back(3 * node), average.weights.push_back(1.0 / 6.0);
    average.vectors.push_back(60), average.weights.push_back(-1.0);
    average.stiffness = 4.0 * Mat3::Identity();
    system.points.push_back(average);
    SyntheticSystem::Dense shared;
    for (const Index vector : {0, 4, 30, 58, 75, 90, 95}) shared.vectors.push_back(vector);
    const Matrix root = Matrix::Random(21, 21);
    shared.stiffness = root.transpose() * root;
    system.dense.push_back(shared);
    system.finish();
    return system;
}

// A coarse space of the present values, ready for corrections.
template <class System, class Space>
void prepare(const System& system, Index size, Index elements, Space& space) {
    space.analyse(system, size, elements);
    space.begin(system.layout());
    const assembly::HeldProjector held(system.layout());
    Matrix band;
    for (Index c = 0; c < core::count(system.layout().chains); ++c) {
        system.chain_band(c, band);
        space.add_chain(system.layout(), held, c, band);
    }
    CHECK(space.finish(system) == solver::SolveStatus::converged);
}

// A system to those who can only visit all of it.
struct Whole {
    const assembly::ChainSystem<beam::DirectorBeam<>>& system;
    const scene::DofLayout& layout() const { return system.layout(); }
    void apply(const Vector& x, Vector& y) const { system.apply(x, y); }
    void node_blocks(Index chain, Matrix& blocks) const { system.node_blocks(chain, blocks); }
    void chain_band(Index chain, Matrix& blocks) const { system.chain_band(chain, blocks); }
    void visit(assembly::IgnoredTerms& terms) const { system.visit(terms); }
    template <class Terms>
    void visit(Terms& terms) const {
        system.visit(terms);
    }
};

// Velocities of one rigid motion of everything, free components only.
Vector rigid_motion(const scene::DofLayout& layout, const Vec3& translation, const Vec3& rotation) {
    Vector z(layout.unknowns());
    for (Index v = 0; v < layout.vectors(); ++v) {
        Vec3 move = rotation.cross(layout.value[core::at(v)]);
        if (layout.kind[core::at(v)] == scene::VectorKind::position) move += translation;
        z.segment<3>(3 * v) = move;
    }
    assembly::HeldProjector(layout).project(z);
    return z;
}

TEST_CASE("the coarse correction is the projection on rigid motions in the energy of the whole system") {
    for (const int held : {0, 7}) {
        const SyntheticSystem system = coupled(held);
        for (const Index size : {1, 2, 10}) {
            for (const Index elements : {1, 2, 50}) {
                CAPTURE(held);
                CAPTURE(size);
                CAPTURE(elements);
                solver::RigidCoarseSpace<double> space;
                prepare(system, size, elements, space);
                Vector r(system.layout().unknowns()), z = Vector::Zero(r.size());
                // A rigid motion of everything is in the space, whatever the clusters and stations: it comes back whole.
                // Only if every entry of P^T A P is right.
                const Vector motion = rigid_motion(system.layout(), {0.3, -0.2, 0.5}, {0.1, 0.4, -0.3});
                system.apply(motion, r);
                space.add_correction(system.layout(), r, z);
                const assembly::HeldProjector projector(system.layout());
                Vector inside = z;
                projector.project(inside);
                CHECK((inside - z).norm() < 1e-14 * z.norm());      // nothing moves where it is held
                CHECK((z - motion).norm() < 1e-8 * motion.norm());  // a condition number of some 1e5 and the shift
                // The correction of any error is the projection of it: made again, it changes nothing, and it is
                // orthogonal in energy to what is left.
                const Vector error = test::random_load(system.layout(), 3);
                Vector free = error, left(r.size()), again = Vector::Zero(r.size());
                projector.project(free);
                system.apply(free, r);
                z.setZero();
                space.add_correction(system.layout(), r, z);
                projector.project(z);
                system.apply(Vector(free - z), left);
                CHECK(std::abs(z.dot(left)) < 1e-8 * std::sqrt(z.dot(r) * free.dot(r)));
                projector.project(left);
                space.add_correction(system.layout(), left, again);
                CHECK(again.norm() < 1e-7 * z.norm());
            }
        }
    }
}

TEST_CASE("a motion that is linear between stations along a cluster is in the coarse space") {
    SyntheticSystem system =
        test::random_system({.chains = std::vector<scene::Chain>(4, {.nodes = 9, .vectors_per_node = 3, .reach = 2, .group = 0}),
                             .points = 60,
                             .seed = 3});
    Vector motion(system.layout().unknowns());
    for (std::size_t c = 0; c < 4; ++c)
        for (Index k = 0; k < 27; ++k) {
            const Index v = system.description.chains[c].first_vector + k,
                        node = c == 2 ? 8 - k / 3 : k / 3;  // one runs backwards
            if (k % 3 == 0) system.description.value[core::at(v)] = Vec3(static_cast<double>(node), static_cast<double>(c), 0);
            const double t = std::max(0.0, static_cast<double>(node) - 4.0);
            motion.segment<3>(3 * v) = k % 3 == 0 ? Vec3(t, 2.0 - t, 1.0) : Vec3(Vec3::Zero());
        }
    system.finish();
    for (const Index elements : {1, 2, 4}) {
        solver::RigidCoarseSpace<double> space;
        prepare(system, 19, elements, space);
        CHECK(space.clusters() == 1);
        CHECK(space.stations() == 4 / elements + 1);
        Vector r(motion.size()), z = Vector::Zero(motion.size());
        system.apply(motion, r);
        space.add_correction(system.layout(), r, z);
        const double error = (z - motion).norm() / motion.norm();
        if (elements <= 2) CHECK(error < 1e-8);
        if (elements == 4) CHECK(error > 0.1);  // the kink is between its stations
    }
}

TEST_CASE("a system in which chains float apart has a coarse correction that is finite") {
    SyntheticSystem system;
    for (int c = 0; c < 3; ++c) {
        system.add_chain(5, 1, 1, -1, 1.0);
        for (Index a = 0; a + 1 < 5; ++a) {  // axial springs: all rotations and most translations cost nothing
            Matrix k = Matrix::Zero(6, 6);
            k(0, 0) = k(3, 3) = 1.0, k(0, 3) = k(3, 0) = -1.0;
            system.dense.push_back({{5 * c + a, 5 * c + a + 1}, k});
        }
    }
    system.finish();
    solver::RigidCoarseSpace<double> space;
    prepare(system, 19, 1, space);
    Vector z = Vector::Zero(45);
    space.add_correction(system.layout(), test::random_load(system.layout(), 1), z);
    CHECK(z.allFinite());
}

TEST_CASE("a coarse matrix that is not positive definite is seen, and terms that were not analysed find their place") {
    SyntheticSystem system = coupled(3);
    solver::RigidCoarseSpace<double> space;
    prepare(system, 10, 2, space);
    system.points.push_back({{0, 95}, {1.0, -1.0}, 1e4 * Mat3::Identity()});
    system.finish();
    const assembly::HeldProjector held(system.layout());
    const auto refresh = [&] {
        space.begin(system.layout());
        Matrix band;
        for (Index c = 0; c < core::count(system.layout().chains); ++c) {
            system.chain_band(c, band);
            space.add_chain(system.layout(), held, c, band);
        }
        return space.finish(system);
    };
    CHECK(refresh() == solver::SolveStatus::converged);
    Vector motion = rigid_motion(system.layout(), {0.3, -0.2, 0.5}, {0.1, 0.4, -0.3}), r(motion.size()),
           z = Vector::Zero(motion.size());
    system.apply(motion, r);
    space.add_correction(system.layout(), r, z);
    held.project(z);
    CHECK((z - motion).norm() < 1e-7 * motion.norm());
    system.points.back().stiffness *= -1.0;
    system.finish();
    CHECK(refresh() == solver::SolveStatus::indefinite);
    z.setZero();
    space.add_correction(system.layout(), r, z);
    CHECK(z.dot(r) > 0.0);  // what is used instead is positive definite
}

TEST_CASE("a coarse matrix that is summed in several parts at once is the one that is summed in one go") {
    static_assert(assembly::DivisibleCouplings<assembly::ChainSystem<beam::DirectorBeam<>>> &&
                  !assembly::DivisibleCouplings<Whole>);
    const auto system = test::chain_system(test::FabricSystem({.bundles = 2, .fibres = 20, .elements = 16, .length = 2.2}));
    REQUIRE(system.couplings() > 4096);
    solver::RigidCoarseSpace<double> parts, whole;
    prepare(system, 10, 2, parts);
    prepare(Whole{system}, 10, 2, whole);
    const Vector r = test::random_load(system.layout(), 2);
    Vector z = Vector::Zero(r.size()), expected = z;
    parts.add_correction(system.layout(), r, z);
    whole.add_correction(system.layout(), r, expected);
    CHECK((z - expected).norm() < 1e-9 * expected.norm());  // sums in another order, times a condition number of some 1e5

    // Factored in float, the same but for what the condition number makes of its rounding; that is a preconditioner as good.
    solver::RigidCoarseSpace<float> coarse;
    prepare(system, 10, 2, coarse);
    z.setZero();
    coarse.add_correction(system.layout(), r, z);
    CHECK((z - expected).norm() < 1e-2 * expected.norm());
}

}  // namespace rigid_coarse_space_test
