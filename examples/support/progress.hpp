// SPDX-License-Identifier: MIT
#pragma once
/// @file Lines of progress.

#include <fibrant/simulation/report.hpp>

#include <cstdio>

namespace example {

/// What has come to nothing: where fibres snap a large scene spends minutes on such attempts.
inline void print(const fibrant::simulation::FailedAttempt& attempt) {
    std::printf("%4td %-10s attempt %td given up after %td Newton iterations, %.0f s since the increment began: %s\n", attempt.number, attempt.stage.c_str(),
                attempt.attempts, attempt.newton, attempt.seconds, attempt.reason.c_str());
    std::fflush(stdout);
}

}  // namespace example
