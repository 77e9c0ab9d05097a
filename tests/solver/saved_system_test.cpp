// SPDX-License-Identifier: MIT
#include "refusal.hpp"
#include "solver/linear_solver_contract.hpp"
#include "support/fabric_system.hpp"

#include <fibrant/solver/fibre_block_pcg.hpp>
#include <fibrant/solver/recording_solver.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>

using namespace fibrant;

namespace saved_system_test {

// A folder that is gone at the end of the test.
struct TemporaryFolder {
    std::filesystem::path path = std::filesystem::temp_directory_path() / "fibrant_saved_system_test";
    TemporaryFolder() {
        std::filesystem::remove_all(path);
        std::filesystem::create_directories(path);
    }
    ~TemporaryFolder() { std::filesystem::remove_all(path); }
};

std::string content(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST_CASE("a system that was written is read as the same system, whatever its chains and terms") {
    const TemporaryFolder folder;
    for (const test::SyntheticSystem& system : test::solvable_systems()) {
        const Vector b = test::random_load(system.layout(), 1);
        if (!system.layout().ties.empty()) {  // averages are no term of a file: said, and not left out
            CHECK_THROWS_WITH(solver::write_system(folder.path / "a.bin", system, b), doctest::Contains("write_system.ties = 3"));
            continue;
        }
        solver::write_system(folder.path / "a.bin", system, b);
        const solver::SavedSystem read(folder.path / "a.bin");
        CHECK(read.right_hand_side() == b);
        const scene::DofLayout &one = system.layout(), &two = read.layout();
        CHECK(one.kind == two.kind);
        CHECK(one.length == two.length);
        CHECK(one.value == two.value);
        REQUIRE(one.chains.size() == two.chains.size());
        for (std::size_t c = 0; c < one.chains.size(); ++c) {
            CHECK(one.chains[c].first_vector == two.chains[c].first_vector);
            CHECK(one.chains[c].nodes == two.chains[c].nodes);
            CHECK(one.chains[c].vectors_per_node == two.chains[c].vectors_per_node);
            CHECK(one.chains[c].reach == two.chains[c].reach);
            CHECK(one.chains[c].group == two.chains[c].group);
        }
        REQUIRE(one.held.size() == two.held.size());
        for (std::size_t k = 0; k < one.held.size(); ++k) {
            CHECK(one.held[k].vector == two.held[k].vector);
            CHECK(one.held[k].free == two.held[k].free);
        }
        // Dense terms are summed in bands, so products agree to rounding.
        Vector y(b.size()), z(b.size());
        system.apply(b, y), read.apply(b, z);
        CHECK((y - z).norm() < 1e-14 * y.norm() * static_cast<double>(b.size()));
        for (Index c = 0; c < core::count(one.chains); ++c) {
            Matrix band, other;
            system.chain_band(c, band), read.chain_band(c, other);
            CHECK((band - other).norm() < 1e-14 * band.norm());
        }
        solver::SavedSystem(system, b).write(folder.path / "b.bin");
        read.write(folder.path / "c.bin");
        CHECK(content(folder.path / "a.bin") == content(folder.path / "b.bin"));
        CHECK(content(folder.path / "a.bin") == content(folder.path / "c.bin"));
    }
}

TEST_CASE("a tangent of fibres in contact is the same after saving, and as a system of chains again") {
    const test::FabricSystem fabric(test::Fabric{.bundles = 1, .parallel = true, .fibres = 7, .elements = 4, .length = 0.55});
    const auto chains = test::chain_system(fabric);
    const Vector b = test::contact_load(fabric);
    const solver::SavedSystem saved(chains, b);
    const auto restored = test::chain_system(saved);
    CHECK(saved.points() == fabric.contacts());
    Vector y(b.size()), of_chains(b.size()), of_saved(b.size()), of_restored(b.size());
    fabric.apply(b, y), chains.apply(b, of_chains), saved.apply(b, of_saved), restored.apply(b, of_restored);
    for (const Vector* other : {&of_chains, &of_saved, &of_restored}) CHECK((y - *other).norm() < 1e-13 * y.norm());
}

TEST_CASE("a solver that records writes each n-th system it is given, and solves as ever") {
    const TemporaryFolder folder;
    const test::SyntheticSystem system = test::solvable_systems()[1];
    const Vector b = test::random_load(system.layout(), 1);
    Vector x, y;
    solver::RecordingSolver<solver::FibreBlockPcg> recording{{.folder = (folder.path / "new").string(), .every = 2}};
    solver::FibreBlockPcg plain;
    test::solve(plain, system, b, 1e-6, x);
    test::solve(recording, system, b, 1e-6, y);
    CHECK(x == y);
    CHECK(!std::filesystem::exists(folder.path / "new"));
    for (int k = 0; k < 3; ++k) recording.solve(system, 2.0 * b, 1e-6, y);
    CHECK(x == Vector(0.5 * y));
    CHECK(std::distance(std::filesystem::directory_iterator(folder.path / "new"), {}) == 2);
    const solver::SavedSystem read(folder.path / "new" / "system_000002.bin");
    CHECK(read.right_hand_side() == 2.0 * b);
    CHECK(std::filesystem::exists(folder.path / "new" / "system_000004.bin"));
    solver::SparseCholesky direct;
    direct.analyse(read), direct.prepare(read);
    CHECK(direct.solve(read, read.right_hand_side(), 1e-10, x).status == solver::SolveStatus::converged);
    CHECK(test::residual_of(system, 2.0 * b, x) < 1e-9);
}

TEST_CASE("files that are no whole system are refused, not half read") {
    const TemporaryFolder folder;
    const auto path = folder.path / "a.bin";
    const auto refused = [&] { return test::refusal([&] { solver::SavedSystem{path}; }); };
    CHECK(refused().ends_with("but it must be a file that can be read"));
    std::ofstream(path) << "something else";
    CHECK(refused().ends_with("but it must be a saved system"));
    const test::SyntheticSystem system = test::solvable_systems()[1];
    solver::write_system(path, system, test::random_load(system.layout(), 1));
    const std::string whole = content(path);
    for (const std::size_t length : {whole.size() - 1, whole.size() / 2, whole.size() / 50, std::size_t{20}}) {
        std::ofstream(path, std::ios::binary).write(whole.data(), static_cast<std::streamsize>(length));
        CHECK(refused().ends_with("but it must be a whole saved system"));
    }
    for (const std::size_t place : {17u, 25u, 33u, 41u}) {  // counts and chains made absurd
        std::string damaged = whole;
        damaged[place + 6] = 'x';
        std::ofstream(path, std::ios::binary).write(damaged.data(), static_cast<std::streamsize>(damaged.size()));
        CHECK(refused().ends_with("but it must be a whole saved system"));
    }
    CHECK(test::refusal([&] {
              solver::write_system(path, system, Vector::Zero(3));
          }).starts_with("SavedSystem.right_hand_side = 3 numbers"));
    CHECK_THROWS_AS(solver::write_system(folder.path / "none" / "a.bin", system, test::random_load(system.layout(), 1)),
                    std::runtime_error);
    using Recording = solver::RecordingSolver<solver::FibreBlockPcg>;
    CHECK(test::refusal([] { Recording{{}}; }).starts_with("RecordingSolver.folder = \"\""));
    CHECK(test::refusal([] { Recording{{.folder = "x", .every = 0}}; }).starts_with("RecordingSolver.every = 0"));
}

}  // namespace saved_system_test
