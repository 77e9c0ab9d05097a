// SPDX-License-Identifier: MIT
#pragma once
/// @file Conjugate gradients shared by ranks.

#include <fibrant/distributed/subdomain_levels.hpp>

#include <cmath>
#include <limits>

namespace fibrant::distributed {

/// Conjugate gradients on A x = b by all ranks of an exchange, preconditioned by SubdomainLevels, from x = Q b. All ranks know
/// the whole system and the whole b, and get the whole x; the work of a solve is divided.
///
/// The bits of x depend on the system and on the number of subdomains, not on ranks and threads. A system that is not symmetric
/// is taken as its symmetric part.
template <Exchange E = OneRank>
class SubdomainPcg {
    using Levels = SubdomainLevels<E>;

public:
    static constexpr bool reads_whole_bands = true;
    struct Parameters {
        typename SubdomainLevels<E>::Parameters levels{};  ///< of the preconditioner
        int iteration_limit = 2000;                        ///< > 0
        void validate() const {
            levels.validate();
            core::require_at_least("SubdomainPcg.iteration_limit", iteration_limit, 1);
        }
    };
    SubdomainPcg() : SubdomainPcg(Parameters{}) {}
    explicit SubdomainPcg(const Parameters& parameters) : parameters_{core::validated(parameters)}, levels_{parameters.levels} {}

    /// @throws std::invalid_argument for closed chains and images of periodic cells, which are not shared among ranks yet
    template <assembly::LinearSystem System>
    void analyse(const System& system) {
        levels_.analyse(system);
    }
    template <assembly::LinearSystem System>
    solver::SolveStatus prepare(const System& system) {
        return levels_.prepare(system);
    }
    template <assembly::LinearSystem System>
    solver::SolveReport solve(const System& system, const Vector& b, double tolerance, Vector& x) {
        return levels_.solve(system.layout(), b, x,
                             [&](const Vector& free, double norm) { return iterate(system.layout(), free, norm, tolerance, x); });
    }

    const RankUse& use() const noexcept { return levels_.use(); }
    const Subdomains& cut() const noexcept { return levels_.cut(); }
    const E& exchange() const noexcept { return levels_.exchange(); }

private:
    struct Work {
        Vector r, z, p, product_of_p;
    };
    solver::SolveReport iterate(const scene::DofLayout& layout, const Vector& free, double norm, double tolerance, Vector& x);

    Parameters parameters_;
    Levels levels_;
    solver::Workspace<Work> work_;
};

/// @param free  part of b that nothing holds   @param norm  of b
template <Exchange E>
solver::SolveReport SubdomainPcg<E>::iterate(const scene::DofLayout& layout, const Vector& free, double norm, double tolerance,
                                             Vector& x) {
    using solver::SolveStatus;
    Work& work = *work_;
    for (Vector* own : {&work.z, &work.p, &work.product_of_p}) own->setZero(free.size());
    Vector& r = work.r;
    Vector& z = work.z;
    Vector& p = work.p;
    Vector& product = work.product_of_p;
    r = free;
    levels_.start(layout, free, x, r);
    solver::SolveReport report{SolveStatus::iteration_limit, 0, levels_.scaled_norm(layout, r) / norm, core::unset};
    double before = 0.0, weight = 0.0;                         // r.z of the iteration before, and p.M p
    bool exact = true;                                         // whether the residual is that of x, not the recursive one
    double reached = std::numeric_limits<double>::infinity();  // true residual at the last restart
    while (report.iterations < parameters_.iteration_limit) {
        if (report.residual <= tolerance) {
            if (!exact) {
                levels_.find_residual(free, x, r);
                report.residual = levels_.scaled_norm(layout, r) / norm;
            }
            if (report.residual <= tolerance) {
                report.status = SolveStatus::converged;
                break;
            }
            if (report.residual > 0.5 * reached) break;  // rounding allows no less
            reached = report.residual;
            levels_.start(layout, free, x, r);
            exact = true;
            before = 0.0;
        }
        levels_.precondition(layout, r, z);
        const double rz = levels_.dot(r, z);
        const double beta = before > 0.0 ? rz / before : 0.0;
        levels_.for_owned([&](Index k) { p.segment<3>(k) = z.segment<3>(k) + beta * p.segment<3>(k); });
        weight = rz + beta * beta * weight;  // r is orthogonal to the directions before
        levels_.refresh(p);
        levels_.apply(p, product);
        const double curvature = levels_.dot(p, product);
        if (!std::isfinite(curvature) || !std::isfinite(rz)) {
            report.status = SolveStatus::not_finite;
            break;
        }
        if (!(report.curvature <= curvature / weight)) report.curvature = curvature / weight;
        if (curvature <= 0.0 || rz <= 0.0) {
            if (rz <= 0.0 && report.curvature > 0.0) report.curvature = 0.0;
            report.status = SolveStatus::indefinite;
            if (report.iterations == 0) levels_.descend(layout, free, x);
            break;
        }
        const double alpha = rz / curvature;
        levels_.for_owned([&](Index k) {
            x.segment<3>(k) += alpha * p.segment<3>(k);
            r.segment<3>(k) -= alpha * product.segment<3>(k);
        });
        report.residual = levels_.scaled_norm(layout, r) / norm;
        exact = false;
        before = rz;
        ++report.iterations;
    }
    if (report.status != SolveStatus::converged && report.status != SolveStatus::not_finite) {
        levels_.find_residual(free, x, r);
        report.residual = levels_.scaled_norm(layout, r) / norm;
        if (report.status == SolveStatus::iteration_limit && report.residual <= tolerance) report.status = SolveStatus::converged;
        if (!std::isfinite(report.residual)) report.status = SolveStatus::not_finite;
    }
    return report;
}

}  // namespace fibrant::distributed
