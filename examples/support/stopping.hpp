// SPDX-License-Identifier: MIT
#pragma once
/// @file A run that is told to stop (SIGINT, SIGTERM) ends after the increment that it is in, with a checkpoint.

#include <array>
#include <csignal>
#include <cstddef>

namespace example {

namespace detail {
inline volatile std::sig_atomic_t stop_signal = 0;
extern "C" inline void note_stop(int signal) { stop_signal = signal; }
}  // namespace detail

/// As long as it lives these signals are taken down, and the second ends the program at once. A file that may not grow any more
/// is a write that failed, and not the end of the program.
class ListeningForStops {
public:
    ListeningForStops() {
        detail::stop_signal = 0;
        struct sigaction act {};
        act.sa_handler = detail::note_stop;
        act.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
        sigemptyset(&act.sa_mask);
        for (std::size_t k = 0; k < signals.size(); ++k) sigaction(signals[k], &act, &before_[k]);
        file_size_before_ = std::signal(SIGXFSZ, SIG_IGN);
    }
    ~ListeningForStops() {
        for (std::size_t k = 0; k < signals.size(); ++k) sigaction(signals[k], &before_[k], nullptr);
        std::signal(SIGXFSZ, file_size_before_);
    }
    ListeningForStops(const ListeningForStops&) = delete;
    ListeningForStops& operator=(const ListeningForStops&) = delete;

private:
    static constexpr std::array<int, 2> signals{SIGINT, SIGTERM};
    std::array<struct sigaction, 2> before_{};
    void (*file_size_before_)(int) = nullptr;
};
/// Number of the signal that asked the run to stop; 0: none.
inline int stop_signal() noexcept { return static_cast<int>(detail::stop_signal); }
inline bool stopped() noexcept { return stop_signal() != 0; }

}  // namespace example
