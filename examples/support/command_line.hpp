// SPDX-License-Identifier: MIT
#pragma once
/// @file What is said of a command line that cannot be read.

#include <CLI/CLI.hpp>

#include <cstdio>
#include <string>

namespace example {

/// The message of a parser in the words of all others: which option, what it has, and what it must have.
inline std::string told(const CLI::ParseError& error) {
    std::string text = error.what();
    const std::size_t flag = text.find(" was given a disallowed flag override");
    if (flag != std::string::npos) return "--" + text.substr(0, flag) + " has a value, but it must have none";
    const std::size_t colon = text.find(": ");
    if (error.get_name() != "ArgumentMismatch" || colon == std::string::npos) return text;
    const std::string option = text.substr(0, colon), rest = text.substr(colon + 2);
    int wanted = 0, given = 0;
    if (std::sscanf(rest.c_str(), "At %*s %d required but received %d", &wanted, &given) == 2)
        return option + " has " + std::to_string(given) + (given == 1 ? " value" : " values") + ", but it must have " +
               (rest.compare(0, 7, "At Most") == 0 ? "at most " : "at least ") + std::to_string(wanted);
    if (std::sscanf(rest.c_str(), "%d required", &wanted) == 1)  // of a type, which is a word of the parser
        return option + " has too few values, but it must have " + std::to_string(wanted);
    return text;
}

/// Says what is wrong, or what was asked for, help or the version.
/// @returns the status of the process
inline int ends_by(const CLI::App& app, const CLI::ParseError& error, const char* program) {
    if (error.get_exit_code() == 0) return app.exit(error);
    std::fprintf(stderr, "%s: %s\nRun with --help for more information.\n", program, told(error).c_str());
    return 2;
}

}  // namespace example
