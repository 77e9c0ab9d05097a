// SPDX-License-Identifier: MIT
// The command line of a program that ranks of MPI run together. FIBRANT_PROGRAM is the function that tells which.
#include "program.hpp"

#include <fibrant/distributed/mpi_exchange.hpp>

#ifdef FIBRANT_WITH_PETSC
#include <fibrant/distributed/petsc_krylov.hpp>
#endif

#include <cstdio>

example::Program FIBRANT_PROGRAM();

int main(int argc, char** argv) {
    const fibrant::distributed::MpiSession session(argc, argv);
    if (fibrant::distributed::MpiExchange().rank() > 0) {  // all would say the same
        static_cast<void>(std::freopen("/dev/null", "w", stdout));
        static_cast<void>(std::freopen("/dev/null", "w", stderr));
    }
#ifdef FIBRANT_WITH_PETSC
    const fibrant::distributed::PetscSession petsc;
    return session.end(example::run(argc, argv, FIBRANT_PROGRAM()), 5.0, fibrant::distributed::PetscSession::end);
#else
    return session.end(example::run(argc, argv, FIBRANT_PROGRAM()));
#endif
}
