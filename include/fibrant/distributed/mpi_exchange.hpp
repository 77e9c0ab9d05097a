// SPDX-License-Identifier: MIT
#pragma once
/// @file Ranks that are processes, by MPI, for those who link it. Only this header includes it.
///
/// Three calls of MPI are all that is needed (MPI: A Message-Passing Interface Standard, version 3.1, chapters 3 and 5): a
/// library of distributed vectors above it would keep a numbering of its own, and its sums have the order that it likes.

#if !__has_include(<mpi.h>)
#error "fibrant/distributed/mpi_exchange.hpp needs <mpi.h>: install MPI and compile with its wrapper, or link fibrant::mpi"
#endif

#ifndef OMPI_SKIP_MPICXX
#define OMPI_SKIP_MPICXX 1
#endif
#ifndef MPICH_SKIP_MPICXX
#define MPICH_SKIP_MPICXX 1
#endif

#include <fibrant/distributed/exchange.hpp>

#include <mpi.h>

#include <climits>
#include <span>
#include <stdexcept>
#include <vector>

namespace fibrant::distributed {

/// The ranks of MPI_COMM_WORLD. MPI has to be begun when one is made; an error of MPI ends all ranks, as its default is.
class MpiExchange {
public:
    using Parameters = core::NoParameters;
    MpiExchange() : MpiExchange(Parameters{}) {}
    explicit MpiExchange(const Parameters&) {
        MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
        MPI_Comm_size(MPI_COMM_WORLD, &ranks_);
    }
    int rank() const noexcept { return rank_; }
    int ranks() const noexcept { return ranks_; }

    /// @throws std::length_error beyond the 2^31 - 1 numbers that MPI counts
    void gather(std::span<const double> own, std::span<const Index> counts, std::span<double> all) const {
        std::vector<int> count, first{0};
        for (const Index n : counts) count.push_back(checked(n)), first.push_back(checked(first.back() + n));
        const bool in_place = own.data() == all.data() + first[core::at(rank_)];
        MPI_Allgatherv(in_place ? MPI_IN_PLACE : static_cast<const void*>(own.data()), checked(core::count(own)), MPI_DOUBLE,
                       all.data(), count.data(), first.data(), MPI_DOUBLE, MPI_COMM_WORLD);
    }
    /// @throws std::length_error beyond the 2^31 - 1 numbers that MPI counts
    void swap(const Partners& partners, std::span<const double> out, std::span<double> in) const {
        std::vector<MPI_Request> open(2 * partners.ranks.size());
        for (std::size_t k = 0; k < partners.ranks.size(); ++k) {
            MPI_Irecv(in.data() + partners.first_received[k],
                      checked(partners.first_received[k + 1] - partners.first_received[k]), MPI_DOUBLE, partners.ranks[k], 0,
                      MPI_COMM_WORLD, &open[2 * k]);
            MPI_Isend(out.data() + partners.first_sent[k], checked(partners.first_sent[k + 1] - partners.first_sent[k]),
                      MPI_DOUBLE, partners.ranks[k], 0, MPI_COMM_WORLD, &open[2 * k + 1]);
        }
        MPI_Waitall(static_cast<int>(open.size()), open.data(), MPI_STATUSES_IGNORE);
    }

private:
    static int checked(Index n) {
        if (n > INT_MAX) throw std::length_error("MpiExchange: more numbers in a message than MPI counts");
        return static_cast<int>(n);
    }
    int rank_ = 0, ranks_ = 1;
};
static_assert(Exchange<MpiExchange>);

/// MPI from the begin of a program to its end. A rank that leaves with an error while others go on ends them all.
class MpiSession {
public:
    MpiSession(int& argc, char**& argv) {
        int provided = 0;
        MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
    }
    /// Waits for the others, not longer than `seconds` where this rank has failed: then they are ended, and the program too.
    /// @param status  of the program, returned
    /// @param last    what has to end before MPI does, by all ranks
    int end(int status, double seconds = 5.0, void (*last)() = nullptr) const {
        MPI_Request all_here = MPI_REQUEST_NULL;
        MPI_Ibarrier(MPI_COMM_WORLD, &all_here);
        const double start = MPI_Wtime();
        int done = 0;
        while (true) {
            MPI_Test(&all_here, &done, MPI_STATUS_IGNORE);
            if (done != 0) break;
            if (status > 1 && MPI_Wtime() - start > seconds) MPI_Abort(MPI_COMM_WORLD, status);
        }
        if (last != nullptr) last();
        MPI_Finalize();
        return status;
    }
};

}  // namespace fibrant::distributed
