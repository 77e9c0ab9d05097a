// SPDX-License-Identifier: MIT
#pragma once
/// @file Any solver, which writes some of the systems it is given to files.

#include <fibrant/solver/linear_solver.hpp>
#include <fibrant/solver/saved_system.hpp>

#include <filesystem>
#include <string>
#include <utility>

namespace fibrant::solver {

/// Solves as Base does, and writes each n-th system to `folder`/system_<number of the solve, from 1>.bin.
template <class Base>
class RecordingSolver {
public:
    struct Parameters {
        typename Base::Parameters base{};
        std::string folder;  ///< made if it is not there
        Index every = 10;    ///< solves, > 0
        void validate() const {
            if (folder.empty()) core::refuse("RecordingSolver.folder", "\"\"", "the name of a folder");
            core::require_at_least("RecordingSolver.every", every, 1);
        }
    };
    explicit RecordingSolver(const Parameters& parameters) : parameters_{core::validated(parameters)}, base_{parameters.base} {}

    template <class System>
    void analyse(const System& system) {
        base_.analyse(system);
    }
    template <class System>
    SolveStatus prepare(const System& system) {
        return base_.prepare(system);
    }
    /// @throws std::runtime_error if the system cannot be written
    template <class System>
    SolveReport solve(const System& system, const Vector& b, double tolerance, Vector& x) {
        if (++solves_ % parameters_.every == 0) {
            const std::string number = std::to_string(solves_);
            std::filesystem::create_directories(parameters_.folder);
            const std::string name = "system_" + std::string(number.size() < 6 ? 6 - number.size() : 0, '0') + number + ".bin";
            write_system(std::filesystem::path(parameters_.folder) / name, system, b);
        }
        return base_.solve(system, b, tolerance, x);
    }

    const Base& base() const noexcept { return base_; }

private:
    Parameters parameters_;
    Base base_;
    Index solves_ = 0;
};

}  // namespace fibrant::solver
