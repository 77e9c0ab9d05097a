// SPDX-License-Identifier: MIT
#include <fibrant/observe/progress_printer.hpp>
#include <fibrant/simulation/report.hpp>

#include <refusal.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

using namespace fibrant;

namespace progress_printer_test {

simulation::IncrementReport increment(Index number, double progress, double seconds) {
    simulation::IncrementReport report;
    report.number = number, report.stage = "separation", report.progress = progress, report.seconds = seconds;
    report.counts.newton = 7, report.counts.linear_iterations = 93, report.contact.greatest_penetration = 0.005,
    report.contact.elements = 1234567;
    return report;
}

std::vector<std::string> lines_of(const std::ostringstream& text) {
    std::vector<std::string> lines;
    std::istringstream in(text.str());
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

TEST_CASE("seconds are told as a clock does") {
    CHECK(observe::clock_text(-3.0) == "0:00");
    CHECK(observe::clock_text(59.4) == "0:59");
    CHECK(observe::clock_text(59.6) == "1:00");
    CHECK(observe::clock_text(3599.6) == "1:00:00");
    CHECK(observe::clock_text(36000.0 + 23 * 60 + 4) == "10:23:04");
}

TEST_CASE("a heading stands above lines of its width, with the time left at the pace of the increments that this process made") {
    std::ostringstream out;
    observe::ProgressPrinter printer({.radius = 0.05, .figures = 1, .heading_every = 3}, out);
    const std::vector<observe::Column> figures{{"force", 1.25}, {"moment", 2.0}};
    // resumed at 40 %: the first increment took long, but nothing says from where it came
    printer.reported(increment(11, 0.4, 1000.0), figures);
    printer.reported(increment(12, 0.5, 20.0), figures);
    printer.reported(increment(13, 0.6, 40.0), figures);
    printer.reported(increment(14, 1.0, 40.0), figures);
    const std::vector<std::string> lines = lines_of(out);
    REQUIRE(lines.size() == 6);  // two headings
    CHECK(lines[0] == lines[4]);
    CHECK(std::all_of(lines.begin(), lines.end(), [&](const std::string& line) { return line.size() == lines[0].size(); }));
    const auto column = [&](std::size_t line, const std::string& name) {  // right under the name's last letter
        const std::size_t end = lines[0].find(name) + name.size();
        const std::string text = lines[line].substr(0, end);
        return text.substr(text.find_last_of(' ') + 1);
    };
    CHECK(column(1, "left") == "?");
    CHECK(column(2, "left") == "1:40");  // 20 s for a tenth, and a half to go
    CHECK(column(3, "left") == "2:00");  // 60 s for a fifth, and two fifths to go
    CHECK(column(5, "left") == "0:00");
    CHECK(column(2, "done") == "50.0%");
    CHECK(column(2, "newton") == "7");
    CHECK(column(2, "linear") == "93");
    CHECK(column(2, "elements") == "1234567");
    CHECK(column(2, "depth/r") == "0.1000");
    CHECK(column(2, "force") == "1.25");
    CHECK(lines[0].find("moment") == std::string::npos);
}

TEST_CASE("a stage that waits for rest takes some time more than what is said to be left, and its last increment none") {
    std::ostringstream out;
    observe::ProgressPrinter printer({.radius = 0.05}, out);
    printer.reported(increment(1, 0.5, 20.0));
    for (const bool waits : {true, true, false}) {
        simulation::IncrementReport rest = increment(2, 1.0, 20.0);
        rest.waits = waits;
        printer.reported(rest);
    }
    const std::vector<std::string> lines = lines_of(out);
    REQUIRE(lines.size() == 5);
    CHECK(lines[2].ends_with(" 0:00+"));
    CHECK(lines[3].ends_with(" 0:00+"));
    CHECK(lines[4].ends_with(" 0:00"));
    CHECK(lines[2].size() == lines[0].size());
}

TEST_CASE("an attempt that was given up says why") {
    std::ostringstream out;
    const observe::ProgressPrinter printer({.radius = 1.0}, out);
    simulation::FailedAttempt attempt;
    attempt.number = 3, attempt.stage = "stretch", attempt.attempts = 2, attempt.newton = 30, attempt.seconds = 75.0,
    attempt.reason = "the residual stands still";
    printer.gave_up(attempt);
    CHECK(out.str() ==
          "   3 stretch    attempt 2 given up after 30 Newton iterations, 1:15 since the increment began: the residual stands "
          "still\n");
}

TEST_CASE("a printer without a radius is refused by name") {
    std::ostringstream out;
    CHECK(test::refusal([&] { observe::ProgressPrinter({}, out); }).find("ProgressPrinter.radius") != std::string::npos);
    CHECK(test::refusal([&] {
              observe::ProgressPrinter({.radius = 1.0, .heading_every = 0}, out);
          }).find("ProgressPrinter.heading_every") != std::string::npos);
}

}  // namespace progress_printer_test
