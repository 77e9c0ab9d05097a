// SPDX-License-Identifier: MIT
#pragma once
/// @file Krylov methods of PETSc on ranks of MPI, for those who link it. Only this header includes it.

#if !__has_include(<petscksp.h>)
#error "fibrant/distributed/petsc_krylov.hpp needs <petscksp.h>: install PETSc, and link fibrant::petsc"
#endif

#include <fibrant/distributed/mpi_exchange.hpp>
#include <fibrant/distributed/subdomain_levels.hpp>

#include <petscksp.h>

#include <cmath>
#include <exception>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace fibrant::distributed {

namespace detail {
inline void petsc_check(PetscErrorCode code) {
    if (code == 0) return;
    const char* text = nullptr;
    PetscErrorMessage(code, &text, nullptr);
    throw std::runtime_error("PETSc: " + std::string(text != nullptr ? text : "error " + std::to_string(code)));
}
}  // namespace detail

/// PETSc from here to `end`, inside of MPI. It reads the options of the environment (PETSC_OPTIONS), and leaves signals alone.
class PetscSession {
public:
    PetscSession() {
        detail::petsc_check(PetscOptionsSetValue(nullptr, "-no_signal_handler", "true"));
        detail::petsc_check(PetscInitializeNoArguments());
    }
    /// By all ranks, once all are here: what `-log_view` shows is written now.
    static void end() { PetscFinalize(); }
};

/// A x = b by a method of PETSc's KSP, which options name: the system as a MatShell, SubdomainLevels as a PCShell.
///
/// PETSc works on S A S (x / S) = S b, S one over the length of each unknown: its norm is then `solver::scaled_norm`. Its sums
/// have the order that it likes: **bits depend on the number of ranks**, to the tolerance of a solve. SubdomainPcg's do not.
/// Most methods do not ask whether a system is positive definite; here each vector p that is multiplied is: p.Ap < 0 is no.
class PetscKrylov {
public:
    using Levels = SubdomainLevels<MpiExchange>;
    static constexpr bool reads_whole_bands = true;
    struct Parameters {
        typename SubdomainLevels<MpiExchange>::Parameters levels{};  ///< of the preconditioner
        std::string options{};  ///< as "-ksp_type fgmres -ksp_monitor", for the whole process; tolerances are those of solves
        int iteration_limit = 2000;  ///< > 0
        void validate() const {
            levels.validate();
            core::require_at_least("PetscKrylov.iteration_limit", iteration_limit, 1);
        }
    };
    PetscKrylov() : PetscKrylov(Parameters{}) {}
    /// @throws std::runtime_error where PETSc has not been begun (PetscSession)
    /// @throws std::invalid_argument for options of which PETSc refuses one
    explicit PetscKrylov(const Parameters& parameters) : parameters_{core::validated(parameters)}, levels_{parameters.levels} {
        PetscBool begun = PETSC_FALSE;
        PetscInitialized(&begun);
        if (begun != PETSC_TRUE) throw std::runtime_error("PetscKrylov: PETSc has not been begun, by a PetscSession");
        // Tried at once, before any work, and told by us alone.
        KSP method = nullptr;
        PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
        PetscErrorCode code = PetscOptionsInsertString(nullptr, parameters_.options.c_str());
        if (code == 0) code = KSPCreate(PETSC_COMM_WORLD, &method);
        if (code == 0) code = KSPSetFromOptions(method);
        KSPDestroy(&method);
        PetscPopErrorHandler();
        if (code != 0) core::refuse("PetscKrylov.options", "\"" + parameters_.options + "\"", "options that PETSc takes");
    }

    /// @throws std::invalid_argument for closed chains and images of periodic cells, which are not shared among ranks yet
    /// @throws std::length_error for more unknowns than PETSc counts
    template <assembly::LinearSystem System>
    void analyse(const System& system) {
        levels_.analyse(system);
        const scene::DofLayout& layout = system.layout();
        if (layout.unknowns() > std::numeric_limits<PetscInt>::max())
            throw std::length_error("PetscKrylov: more unknowns than a PetscInt counts");
        Work& work = *work_;
        work.clear();
        work.vectors = levels_.own_vectors();
        work.whole.setZero(layout.unknowns()), work.result.setZero(layout.unknowns());
        const auto own = static_cast<PetscInt>(3 * work.vectors.size()), all = static_cast<PetscInt>(layout.unknowns());
        using detail::petsc_check;
        petsc_check(MatCreateShell(PETSC_COMM_WORLD, own, own, all, all, &work, &work.matrix));
        petsc_check(MatShellSetOperation(work.matrix, MATOP_MULT, reinterpret_cast<void (*)()>(&Work::multiply)));
        petsc_check(MatSetOption(work.matrix, MAT_SYMMETRIC, PETSC_TRUE));
        petsc_check(MatCreateVecs(work.matrix, &work.x, &work.b));
        petsc_check(KSPCreate(PETSC_COMM_WORLD, &work.method));
        petsc_check(KSPSetOperators(work.method, work.matrix, work.matrix));
        PC levels = nullptr;
        petsc_check(KSPGetPC(work.method, &levels));
        petsc_check(PCSetType(levels, PCSHELL));
        petsc_check(PCShellSetContext(levels, &work));
        petsc_check(PCShellSetApply(levels, &Work::precondition));
        petsc_check(PCShellSetName(levels, "subdomains and rigid motions"));
        petsc_check(KSPSetType(work.method, KSPCG));
        petsc_check(KSPSetNormType(work.method, KSP_NORM_UNPRECONDITIONED));
        petsc_check(KSPSetInitialGuessNonzero(work.method, PETSC_TRUE));
        petsc_check(KSPSetFromOptions(work.method));
    }
    template <assembly::LinearSystem System>
    solver::SolveStatus prepare(const System& system) {
        return levels_.prepare(system);
    }
    /// @throws std::runtime_error with what PETSc says
    template <assembly::LinearSystem System>
    solver::SolveReport solve(const System& system, const Vector& b, double tolerance, Vector& x) {
        return levels_.solve(system.layout(), b, x,
                             [&](const Vector& free, double norm) { return iterate(system.layout(), free, norm, tolerance, x); });
    }
    const RankUse& use() const noexcept { return levels_.use(); }

private:
    /// @param free  part of b that nothing holds   @param norm  of b
    solver::SolveReport iterate(const scene::DofLayout& layout, const Vector& free, double norm, double tolerance, Vector& x) {
        using detail::petsc_check;
        using solver::SolveStatus;
        Work& work = *work_;
        work.levels = &levels_, work.layout = &layout;
        Vector r = free;
        levels_.start(layout, free, x, r);
        solver::SolveReport report{SolveStatus::iteration_limit, 0, levels_.scaled_norm(layout, r) / norm, core::unset};
        double reached = std::numeric_limits<double>::infinity();  // true residual before the last start
        while (report.status == SolveStatus::iteration_limit && report.residual > tolerance && report.residual <= 0.5 * reached &&
               report.iterations < parameters_.iteration_limit) {  // rounding allows no less
            reached = report.residual;
            work.put(free, work.b, false), work.put(x, work.x, true);
            petsc_check(KSPSetTolerances(work.method, 0.0, tolerance * norm, PETSC_DEFAULT,
                                         static_cast<PetscInt>(parameters_.iteration_limit - report.iterations)));
            petsc_check(KSPSolve(work.method, work.b, work.x));
            work.get(work.x, x, true);
            PetscInt iterations = 0;
            KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
            petsc_check(KSPGetIterationNumber(work.method, &iterations));
            petsc_check(KSPGetConvergedReason(work.method, &reason));
            report.iterations += static_cast<int>(iterations);
            if (turned_back() || reason == KSP_DIVERGED_INDEFINITE_MAT || reason == KSP_DIVERGED_INDEFINITE_PC)
                report.status = SolveStatus::indefinite;
            levels_.find_residual(free, x, r);  // of x, not the recursive one
            report.residual = levels_.scaled_norm(layout, r) / norm;
            if (reason == KSP_DIVERGED_NANORINF || !std::isfinite(report.residual)) report.status = SolveStatus::not_finite;
        }
        if (report.status == SolveStatus::iteration_limit && report.residual <= tolerance) report.status = SolveStatus::converged;
        if (report.status == SolveStatus::indefinite && !(levels_.dot(free, x) > 0.0)) levels_.descend(layout, free, x);
        return report;
    }
    /// Whether a vector that was multiplied since the last call has p.Ap < 0; by all ranks.
    bool turned_back() {
        std::vector<double>& own = work_->curvatures;
        const auto ranks = core::at(levels_.exchange().ranks());
        std::vector<double> all(ranks * own.size());
        levels_.exchange().gather(own, std::vector<Index>(ranks, core::count(own)), all);
        bool negative = false;
        for (std::size_t k = 0; k < own.size(); ++k) {
            double sum = 0.0;
            for (std::size_t rank = 0; rank < ranks; ++rank) sum += all[rank * own.size() + k];
            negative = negative || sum < 0.0;
        }
        own.clear();
        return negative;
    }

    /// What PETSc calls back.
    struct Work {
        Levels* levels = nullptr;                  // of the present solve
        const scene::DofLayout* layout = nullptr;  // the same
        std::vector<Index> vectors;                // own ones, in the order of PETSc's numbers
        Vector whole, result;
        std::vector<double> curvatures;  // own part of p.Ap of each product
        Mat matrix = nullptr;
        Vec x = nullptr, b = nullptr;
        KSP method = nullptr;

        Work() = default;
        Work(const Work&) = delete;
        Work& operator=(const Work&) = delete;
        ~Work() { clear(); }
        void clear() noexcept { KSPDestroy(&method), VecDestroy(&x), VecDestroy(&b), MatDestroy(&matrix); }
        /// From the values of own vectors to PETSc's, which are them times (or over) their length.
        void put(const Vector& from, Vec to, bool times) const {
            double* values = nullptr;
            detail::petsc_check(VecGetArrayWrite(to, &values));
            for (const Index v : vectors) {
                const double length = layout->length[core::at(v)], factor = times ? length : 1.0 / length;
                for (Index i = 0; i < 3; ++i) *values++ = factor * from[3 * v + i];
            }
            values -= 3 * vectors.size();
            detail::petsc_check(VecRestoreArrayWrite(to, &values));
        }
        /// And back.
        void get(Vec from, Vector& to, bool times) const {
            const double* values = nullptr;
            detail::petsc_check(VecGetArrayRead(from, &values));
            const double* value = values;
            for (const Index v : vectors) {
                const double length = layout->length[core::at(v)], factor = times ? 1.0 / length : length;
                for (Index i = 0; i < 3; ++i) to[3 * v + i] = factor * *value++;
            }
            detail::petsc_check(VecRestoreArrayRead(from, &values));
        }
        /// What PETSc is told where a call back throws: it may not see exceptions.
        template <class Body>
        static PetscErrorCode guarded(const Body& body) noexcept {
            try {
                body();
            } catch (const std::exception&) {
                return PETSC_ERR_LIB;
            }
            return 0;
        }
        static PetscErrorCode multiply(Mat matrix, Vec x, Vec y) {
            void* context = nullptr;
            MatShellGetContext(matrix, &context);
            Work& work = *static_cast<Work*>(context);
            return guarded([&] {
                work.get(x, work.whole, true);
                work.levels->refresh(work.whole);
                work.levels->apply(work.whole, work.result);
                work.put(work.result, y, false);
                double curvature = 0.0;
                for (const Index v : work.vectors) curvature += work.whole.segment<3>(3 * v).dot(work.result.segment<3>(3 * v));
                work.curvatures.push_back(curvature);
            });
        }
        static PetscErrorCode precondition(PC levels, Vec r, Vec z) {
            void* context = nullptr;
            PCShellGetContext(levels, &context);
            Work& work = *static_cast<Work*>(context);
            return guarded([&] {
                work.get(r, work.whole, false);
                work.levels->precondition(*work.layout, work.whole, work.result);
                work.put(work.result, z, true);
            });
        }
    };
    Parameters parameters_;
    Levels levels_;
    solver::Workspace<Work> work_;
};
static_assert(std::is_same_v<PetscScalar, double>, "PETSc of real numbers in double precision");

}  // namespace fibrant::distributed
