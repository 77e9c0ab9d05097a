// SPDX-License-Identifier: MIT
// Methods of PETSc on ranks of MPI: what is solved, by whom, and what is told. Run as mpirun -n N test_petsc_krylov.
#define DOCTEST_CONFIG_IMPLEMENT
#include "refusal.hpp"
#include "support/fabric_system.hpp"

#include <fibrant/distributed/petsc_krylov.hpp>
#include <fibrant/distributed/subdomain_pcg.hpp>

#include <doctest/doctest.h>

#include <string>

using namespace fibrant;
using solver::SolveStatus;

namespace petsc_krylov_test {

const test::Fabric fabric{.bundles = 2, .fibres = 7, .elements = 16, .length = 2.2};
const int parts = 7;

distributed::PetscKrylov::Parameters by(const std::string& options) {
    distributed::PetscKrylov::Parameters parameters;
    parameters.levels.cut.parts = parts, parameters.options = options;
    return parameters;
}

TEST_CASE("what conjugate gradients of ours solve, methods of PETSc solve as well, in about as many iterations") {
    const test::FabricSystem system(fabric);
    const Vector b = test::pulled_middles(system.layout());
    distributed::SubdomainPcg<distributed::MpiExchange>::Parameters own;
    own.levels.cut.parts = parts;
    distributed::SubdomainPcg<distributed::MpiExchange> pcg(own);
    pcg.analyse(system);
    REQUIRE(pcg.prepare(system) == SolveStatus::converged);
    Vector x, y, left(b.size());
    const double tolerance = 1e-9;
    const solver::SolveReport expected = pcg.solve(system, b, tolerance, x);
    REQUIRE(expected.status == SolveStatus::converged);
    for (const std::string method : {"cg", "fgmres -ksp_gmres_restart 300", "cg"}) {
        CAPTURE(method);
        distributed::PetscKrylov krylov(by("-ksp_type " + method));
        krylov.analyse(system);
        REQUIRE(krylov.prepare(system) == SolveStatus::converged);
        const solver::SolveReport report = krylov.solve(system, b, tolerance, y);
        CHECK(report.status == SolveStatus::converged);
        system.apply(y, left);
        left = b - left;
        CHECK(solver::scaled_norm(system.layout(), left) <= 1.001 * tolerance * solver::scaled_norm(system.layout(), b));
        CHECK(report.iterations > 0);
        CHECK(report.iterations <= expected.iterations + 2);
        CHECK((y - x).norm() <= 1e-5 * x.norm());  // condition numbers of 1e4 and more
    }
}

TEST_CASE("a limit of iterations is told, and what it came to") {
    const test::FabricSystem system(fabric);
    const Vector b = test::pulled_middles(system.layout());
    distributed::PetscKrylov::Parameters parameters = by("-ksp_type cg");
    parameters.iteration_limit = 1;
    distributed::PetscKrylov krylov(parameters);
    krylov.analyse(system), krylov.prepare(system);
    Vector x, left(b.size());
    const solver::SolveReport report = krylov.solve(system, b, 1e-14, x);
    CHECK(report.status == SolveStatus::iteration_limit);
    CHECK(report.iterations == 1);
    system.apply(x, left);
    left = b - left;
    const double residual = solver::scaled_norm(system.layout(), left) / solver::scaled_norm(system.layout(), b);
    CHECK(std::abs(report.residual - residual) <= 1e-6 * residual);
}

/// A system whose chains, all or each third one, are minus what they were.
struct Turned {
    const test::FabricSystem* of;
    Index each;
    const scene::DofLayout& layout() const { return of->layout(); }
    void apply(const Vector& x, Vector& y) const { of->apply(x, y); }  // nobody here asks for it
    void node_blocks(Index c, Matrix& blocks) const {
        of->node_blocks(c, blocks);
        if (c % each == 0) blocks = -blocks;
    }
    void chain_band(Index c, Matrix& blocks) const {
        of->chain_band(c, blocks);
        if (c % each == 0) blocks = -blocks;
    }
    template <class Terms>
    void visit(Terms& terms) const {
        of->visit(terms);
    }
};

TEST_CASE(
    "a system that is not positive is told, what comes back descends, and one that is solved after it is not said to be so") {
    const test::FabricSystem system(fabric);
    const Vector b = test::pulled_middles(system.layout());
    for (const std::string method : {"fgmres -ksp_gmres_restart 300", "cg"})
        for (const Index each : {1, 3}) {
            CAPTURE(method);
            CAPTURE(each);
            const Turned turned{&system, each};
            distributed::PetscKrylov krylov(by("-ksp_type " + method));
            krylov.analyse(turned);
            CHECK(krylov.prepare(turned) == SolveStatus::indefinite);
            Vector x;
            const solver::SolveReport report = krylov.solve(turned, b, 1e-9, x);
            CHECK(report.status == SolveStatus::indefinite);
            CHECK(b.dot(x) > 0.0);
            krylov.analyse(system);
            CHECK(krylov.prepare(system) == SolveStatus::converged);
            CHECK(krylov.solve(system, b, 1e-9, x).status == SolveStatus::converged);
        }
}

TEST_CASE("a method that PETSc does not know is refused at once") {
    CHECK(test::refusal([] { distributed::PetscKrylov(by("-ksp_type nonsense")); }).starts_with("PetscKrylov.options"));
    distributed::PetscKrylov(by("-ksp_type cg"));  // what holds from now on
}

}  // namespace petsc_krylov_test

int main(int argc, char** argv) {
    const distributed::MpiSession session(argc, argv);
    const distributed::PetscSession petsc;
    doctest::Context context(argc, argv);
    return session.end(context.run(), 5.0, distributed::PetscSession::end);
}
