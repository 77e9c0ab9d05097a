// SPDX-License-Identifier: MIT
#pragma once
/// @file A program that ranks of MPI run together: one of them writes and speaks, all stop together, and share linear systems.

#include "example.hpp"
#include "usual_keys.hpp"

#include <fibrant/distributed/mpi_exchange.hpp>
#include <fibrant/distributed/subdomain_pcg.hpp>
#include <fibrant/solver/confirmed.hpp>
#include <fibrant/solver/one_of.hpp>
#ifdef FIBRANT_WITH_PETSC
#include <fibrant/distributed/petsc_krylov.hpp>
#endif

#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <string>
#include <system_error>
#include <variant>
#include <vector>

namespace example {

/// Whether any rank says so; all have to ask.
inline bool any_rank(bool own) {
    const fibrant::distributed::MpiExchange exchange;
    const double said = own ? 1.0 : 0.0;
    std::vector<double> all(static_cast<std::size_t>(exchange.ranks()));
    exchange.gather({&said, 1}, std::vector<fibrant::Index>(all.size(), 1), all);
    return std::find(all.begin(), all.end(), 1.0) != all.end();
}

/// Where the results of a rank go: those of the first to the folder that was named, those of the others, which are the same, to
/// one of their own that is gone at the end. A run that is resumed has to find the named folder on all ranks.
class RankFolder {
public:
    explicit RankFolder(Output& output) {
        const fibrant::distributed::MpiExchange exchange;
        if (exchange.rank() > 0) {
            own_ = std::filesystem::temp_directory_path() /
                   ("fibrant_rank_" + std::to_string(exchange.rank()) + "_" + std::to_string(getpid()));
            std::filesystem::create_directories(own_);
            if (output.resume && std::filesystem::is_directory(output.folder))
                for (const auto& file : std::filesystem::directory_iterator(output.folder))
                    if (file.is_regular_file() && file.path().filename() != ".lock")
                        std::filesystem::copy_file(file.path(), own_ / file.path().filename());
            output.folder = own_;
            output.paraview = output.pictures = false;
        }
        any_rank(false);  // nobody writes before all have read
    }
    ~RankFolder() {
        std::error_code ignored;
        if (!own_.empty()) std::filesystem::remove_all(own_, ignored);
    }
    RankFolder(const RankFolder&) = delete;
    RankFolder& operator=(const RankFolder&) = delete;
    /// The results are for others to see.
    bool shown() const noexcept { return own_.empty(); }

private:
    std::filesystem::path own_;
};

/// One rank that is told to stop stops all of them, after the same increment.
inline bool stopped_together() {
    const bool all = any_rank(stopped());
    if (all && !stopped()) detail::stop_signal = SIGTERM;
    return all;
}

using RankGradients = fibrant::solver::Confirmed<fibrant::distributed::SubdomainPcg<fibrant::distributed::MpiExchange>>;
#ifdef FIBRANT_WITH_PETSC
using RankKrylov = fibrant::solver::Confirmed<fibrant::distributed::PetscKrylov>;
using RankStrategies = fibrant::solver::OneOf<RankGradients, RankKrylov>;
#else
using RankStrategies = fibrant::solver::OneOf<RankGradients>;
#endif

/// How ranks solve a linear system together, by name; what is automatic in a program of one rank is the first here.
class RankSolver : public RankStrategies {
public:
    struct Parameters {
        std::string strategy = "two_level_pcg";  ///< one of `linear_solvers`
        int subdomains = 64;                     ///< in [1, 4096]
        std::string petsc_options{};             ///< of "petsc"
        void validate() const {
            if (std::find(linear_solvers().begin(), linear_solvers().end(), strategy) == linear_solvers().end())
                fibrant::core::refuse("RankSolver.strategy", "\"" + strategy + "\"", "one that ranks can share");
        }
    };
    RankSolver() : RankSolver(Parameters{}) {}
    explicit RankSolver(const Parameters& parameters) : RankStrategies{make(fibrant::core::validated(parameters))} {}

    /// Which strategy it is.
    std::string account() const { return strategy_.index() == 0 ? "two_level_pcg" : "petsc"; }

private:
    static Strategy make(const Parameters& parameters) {
#ifdef FIBRANT_WITH_PETSC
        if (parameters.strategy == "petsc") {
            RankKrylov::Parameters own;
            own.iterative.levels.cut.parts = parameters.subdomains, own.iterative.options = parameters.petsc_options;
            return RankKrylov(own);
        }
#endif
        RankGradients::Parameters own;
        own.iterative.levels.cut.parts = parameters.subdomains;
        return RankGradients(own);
    }
};

}  // namespace example
