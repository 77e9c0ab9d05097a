// SPDX-License-Identifier: MIT
#pragma once
/// @file Lines of progress of a long run.

#include <fibrant/core/parameters.hpp>
#include <fibrant/observe/csv_writer.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ostream>
#include <span>
#include <string>

namespace fibrant::observe {

/// Seconds as "1:02:03" or "2:03"; negative ones as none.
inline std::string clock_text(double seconds) {
    const long whole = std::lround(std::max(0.0, seconds));
    char text[48];
    if (whole >= 3600)
        std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
    else
        std::snprintf(text, sizeof text, "%ld:%02ld", whole / 60, whole % 60);
    return text;
}

/// An observer that prints a line after each increment, under a heading, and one for each attempt that was given up.
///
/// depth/r is the greatest penetration; left is the time that the rest of the programme takes at the pace of this process'
/// increments so far, from the second on. A + behind it says that the present stage takes some time more: it goes on until fibres
/// have parted or are at rest, and nothing says when that is.
class ProgressPrinter {
public:
    struct Parameters {
        double radius = core::unset;  ///< in which penetrations are told, the thinnest fibre's [length], > 0
        Index figures = 0;            ///< at most, of those that `reported` is given beside the increment, >= 0
        Index heading_every = 40;     ///< lines, > 0
        void validate() const {
            core::require_positive("ProgressPrinter.radius", radius);
            core::require(figures >= 0, "ProgressPrinter.figures", static_cast<double>(figures), ">= 0");
            core::require(heading_every > 0, "ProgressPrinter.heading_every", static_cast<double>(heading_every), "> 0");
        }
    };
    /// @param out  outlives the printer
    ProgressPrinter(const Parameters& parameters, std::ostream& out) : parameters_{core::validated(parameters)}, out_{&out} {}

    /// @param increment  a `simulation::IncrementReport`
    /// @param figures    named values, such as a force: the first of them end the line. A name that is too wide for its column is
    /// cut.
    template <class IncrementReport>
    void reported(const IncrementReport& increment, std::span<const Column> figures = {}) {
        figures = figures.first(std::min(figures.size(), static_cast<std::size_t>(parameters_.figures)));
        const auto& counts = increment.counts;
        if (lines_++ % parameters_.heading_every == 0) {
            print("%4s %-10s %6s %6s %6s %6s %8s %9s %9s %7s %4s %8s", "inc", "stage", "done", "passes", "newton", "linear",
                  "residual", "elements", "active", "depth/r", "cuts", "left");
            for (const Column& figure : figures) print("  %12.12s", figure.name.c_str());
            *out_ << '\n';
        }
        // A resumed run starts in the middle, with an increment of which nothing says how much of the programme it was.
        if (lines_ == 1)
            first_ = increment.progress;
        else
            seconds_ += increment.seconds;
        const double done = increment.progress - first_;
        const std::string left =
            done > 0.0 ? clock_text(seconds_ * (1.0 - increment.progress) / done) + (increment.waits ? "+" : "") : "?";
        print("%4td %-10.10s %5.1f%% %6td %6td %6td %8.1e %9td %9td %7.4f %4td %8s", increment.number, increment.stage.c_str(),
              100.0 * increment.progress, counts.contact_passes, counts.newton, counts.linear_iterations, increment.residual,
              increment.contact.elements, increment.contact.active, increment.contact.greatest_penetration / parameters_.radius,
              increment.cuts, left.c_str());
        for (const Column& figure : figures) print("  %12.5g", std::strtod(figure.value.c_str(), nullptr));
        *out_ << std::endl;
    }

    /// What has come to nothing: where fibres snap a large scene spends minutes on such attempts.
    /// @param attempt  a `simulation::FailedAttempt`
    template <class FailedAttempt>
    void gave_up(const FailedAttempt& attempt) const {
        print("%4td %-10.10s attempt %td given up after %td Newton iterations, %s since the increment began: ", attempt.number,
              attempt.stage.c_str(), attempt.attempts, attempt.newton, clock_text(attempt.seconds).c_str());
        *out_ << attempt.reason << std::endl;
    }

private:
    template <class... Values>
    void print(const char* format, Values... values) const {
        char text[256];
        std::snprintf(text, sizeof text, format, values...);
        *out_ << text;
    }

    Parameters parameters_;
    std::ostream* out_;
    Index lines_ = 0;
    double first_ = 0.0, seconds_ = 0.0;
};

}  // namespace fibrant::observe
