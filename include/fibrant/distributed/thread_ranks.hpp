// SPDX-License-Identifier: MIT
#pragma once
/// @file Ranks that are threads of one process: for tests, and for machines without MPI.

#include <fibrant/core/eigen_threads.hpp>
#include <fibrant/distributed/exchange.hpp>

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <span>
#include <stdexcept>
#include <thread>
#include <vector>

namespace fibrant::distributed {

/// What threads that are ranks have in common.
class ThreadMeeting {
public:
    explicit ThreadMeeting(int ranks) : shown_(core::at(ranks)) {}
    int ranks() const noexcept { return static_cast<int>(shown_.size()); }

    struct Shown {
        std::span<const double> out;
        const Partners* partners = nullptr;
    };
    /// Shows the others what one has, calls look(shown, of all ranks) once all have come, and lets nobody go before all have
    /// looked.
    /// @throws std::runtime_error if a rank has failed: there is nothing to wait for
    template <class Look>
    void meet(int rank, const Shown& own, const Look& look) {
        shown_[core::at(rank)] = own;
        wait();
        look(shown_);
        wait();
    }
    /// To be called by a rank that will not come again.
    void fail() {
        const std::lock_guard lock(mutex_);
        failed_ = true;
        changed_.notify_all();
    }

private:
    void wait() {
        std::unique_lock lock(mutex_);
        if (failed_) throw std::runtime_error("another rank has failed");
        const Index own = turn_;
        if (++waiting_ == ranks()) {
            waiting_ = 0, ++turn_;
            changed_.notify_all();
            return;
        }
        changed_.wait(lock, [&] { return turn_ != own || failed_; });
        if (turn_ == own) throw std::runtime_error("another rank has failed");
    }
    std::vector<Shown> shown_;
    std::mutex mutex_;
    std::condition_variable changed_;
    int waiting_ = 0;
    Index turn_ = 0;
    bool failed_ = false;
};

/// One of several ranks that are threads. One that is made by default is alone.
class ThreadRank {
public:
    struct Parameters {
        ThreadMeeting* meeting = nullptr;  ///< of all ranks, outlives them; null: alone
        int rank = 0;                      ///< own number, >= 0
        void validate() const { core::require_at_least("ThreadRank.rank", rank, 0); }
    };
    ThreadRank() : ThreadRank(Parameters{}) {}
    explicit ThreadRank(const Parameters& parameters) : parameters_{core::validated(parameters)} {}
    int rank() const noexcept { return parameters_.rank; }
    int ranks() const noexcept { return parameters_.meeting == nullptr ? 1 : parameters_.meeting->ranks(); }

    void gather(std::span<const double> own, std::span<const Index> counts, std::span<double> all) const {
        if (parameters_.meeting == nullptr) return OneRank().gather(own, counts, all);
        parameters_.meeting->meet(rank(), {own, nullptr}, [&](const auto& shown) {
            auto to = all.begin();
            for (const auto& of : shown) {
                if (of.out.data() != &*to) std::copy(of.out.begin(), of.out.end(), to);
                to += static_cast<std::ptrdiff_t>(of.out.size());
            }
        });
    }
    void swap(const Partners& partners, std::span<const double> out, std::span<double> in) const {
        if (parameters_.meeting == nullptr) return;
        parameters_.meeting->meet(rank(), {out, &partners}, [&](const auto& shown) {
            for (std::size_t k = 0; k < partners.ranks.size(); ++k) {
                const auto& from = shown[core::at(partners.ranks[k])];
                const auto place = std::lower_bound(from.partners->ranks.begin(), from.partners->ranks.end(), rank());
                const auto own = static_cast<std::size_t>(place - from.partners->ranks.begin());
                const auto part = from.out.subspan(core::at(from.partners->first_sent[own]),
                                                   core::at(from.partners->first_sent[own + 1] - from.partners->first_sent[own]));
                std::copy(part.begin(), part.end(), in.begin() + partners.first_received[k]);
            }
        });
    }

private:
    Parameters parameters_;
};
static_assert(Exchange<ThreadRank>);

/// Calls body(parameters of a ThreadRank) on a thread for each rank, and waits for all. What the first of them throws is thrown
/// here.
/// @param ranks  > 0
template <class Body>
void run_on_threads(int ranks, const Body& body) {
    core::require_at_least("run_on_threads.ranks", ranks, 1);
    const core::EigenOnOneThread products;  // what one rank sets, all would have
    ThreadMeeting meeting(ranks);
    std::exception_ptr failure;
    std::mutex guard;
    std::vector<std::thread> threads;
    for (int r = 0; r < ranks; ++r)
        threads.emplace_back([&, r] {
            try {
                body(ThreadRank::Parameters{&meeting, r});
            } catch (...) {
                {
                    const std::lock_guard lock(guard);
                    if (!failure) failure = std::current_exception();
                }
                meeting.fail();
            }
        });
    for (std::thread& thread : threads) thread.join();
    if (failure) std::rethrow_exception(failure);
}

}  // namespace fibrant::distributed
