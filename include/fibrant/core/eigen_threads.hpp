// SPDX-License-Identifier: MIT
#pragma once
/// @file Eigen's own threads, and how to be without them.

#include <fibrant/core/parallel.hpp>

#include <mutex>

namespace fibrant::core {

/// While one lives, in any thread, Eigen's dense products run on the thread that calls them. Left to itself Eigen cuts long
/// sums where the number of threads says, and the bits with them. The first sets Eigen's number, which all threads share, and the
/// last sets it back.
class EigenOnOneThread {
public:
    EigenOnOneThread() {
        const std::lock_guard lock(guard_);
        if (living_++ > 0) return;
        before_ = Eigen::nbThreads();
        Eigen::setNbThreads(1);
    }
    ~EigenOnOneThread() {
        const std::lock_guard lock(guard_);
        if (--living_ == 0) Eigen::setNbThreads(before_ == threads() ? 0 : before_);  // 0: as OpenMP says, Eigen's beginning
    }
    EigenOnOneThread(const EigenOnOneThread&) = delete;
    EigenOnOneThread& operator=(const EigenOnOneThread&) = delete;

private:
    static inline std::mutex guard_;
    static inline int living_ = 0, before_ = 0;
};

}  // namespace fibrant::core
