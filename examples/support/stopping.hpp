// SPDX-License-Identifier: MIT
#pragma once
/// @file A run that is told to stop (SIGINT, SIGTERM) ends after the increment that it is in, with a checkpoint.

#include <csignal>

namespace example {

namespace detail {
inline volatile std::sig_atomic_t stop_signal = 0;
extern "C" inline void note_stop(int signal) { stop_signal = signal; }
}  // namespace detail

/// From here on the first of these signals is taken down, and the second ends the program at once. A file that may not grow any
/// more is a write that failed, and not the end of the program.
inline void listen_for_stops() {
    struct sigaction act {};
    act.sa_handler = detail::note_stop;
    act.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
    sigemptyset(&act.sa_mask);
    for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &act, nullptr);
    std::signal(SIGXFSZ, SIG_IGN);
}
/// Number of the signal that asked the run to stop; 0: none.
inline int stop_signal() noexcept { return static_cast<int>(detail::stop_signal); }
inline bool stopped() noexcept { return stop_signal() != 0; }

}  // namespace example
