// SPDX-License-Identifier: MIT
#pragma once
/// @file A table as comma-separated values, one row at a time.

#include <fibrant/core/parameters.hpp>
#include <fibrant/observe/observer.hpp>
#include <fibrant/observe/text_file.hpp>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace fibrant::observe {

/// A named value of a row.
struct Column {
    std::string name;
    std::string value;

    Column(std::string column, double number) : name{std::move(column)}, value{shortest(number)} {}
    Column(std::string column, bool flag) : name{std::move(column)}, value{flag ? "1" : "0"} {}
    template <std::integral Integer>
    Column(std::string column, Integer number) : name{std::move(column)}, value{std::to_string(number)} {}
    Column(std::string column, std::string_view text) : name{std::move(column)}, value{text} {}
    Column(std::string column, const char* text) : Column(std::move(column), std::string_view{text}) {}
    Column(std::string column, const std::string& text) : Column(std::move(column), std::string_view{text}) {}
};

/// Appends rows and flushes each; the names become the header of an empty file.
class CsvWriter {
public:
    /// @param start  resumed, the file keeps its rows whose first value is less than that of the first new row: the
    ///               others are from increments that the resumed run repeats
    explicit CsvWriter(std::filesystem::path path, Start start = Start::anew) : path_{std::move(path)}, start_{start} {}

    /// Every row has the columns of the first, whose names differ; otherwise std::invalid_argument is thrown, also where a
    /// resumed file has another header. Throws std::runtime_error if the file cannot be written.
    void row(const std::vector<Column>& columns) {
        std::string header, line;
        for (const Column& column : columns) {
            const bool first = &column == columns.data();
            header += (first ? "" : ",") + quoted(column.name);
            line += (first ? "" : ",") + quoted(column.value);
        }
        if (!file_.is_open()) {
            require_names_differ(columns);
            std::string content = start_ == Start::resumed ? earlier_rows(header, columns) : std::string{};
            if (content.empty()) content = header + "\n";
            write_file(path_, content + line + "\n");
            header_ = header;
            file_.open(path_, std::ios::binary | std::ios::app);
            if (!file_) throw std::runtime_error("cannot write the file " + path_.string());
            return;
        }
        if (header != header_) core::refuse("CsvWriter.columns", header, "those of the first row, " + header_);
        errno = 0;
        file_ << line << '\n';
        file_.flush();
        if (!file_)
            throw std::runtime_error("cannot write the file " + path_.string() +
                                     (errno != 0 ? ": " + std::generic_category().message(errno) : std::string()));
    }

private:
    static std::string quoted(const std::string& text) {
        if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
        std::string answer = "\"";
        for (const char c : text) answer += c == '"' ? std::string("\"\"") : std::string(1, c);
        return answer + "\"";
    }

    /// A reader finds a column by its name.
    static void require_names_differ(const std::vector<Column>& columns) {
        std::vector<std::string_view> names;
        for (const Column& column : columns) names.push_back(column.name);
        std::sort(names.begin(), names.end());
        if (const auto twice = std::adjacent_find(names.begin(), names.end()); twice != names.end())
            core::refuse("CsvWriter.columns", std::string(*twice), "a name that no other column has");
    }

    static double number(std::string_view text) {
        double value = core::unset;
        std::from_chars(text.data(), text.data() + text.size(), value);
        return value;
    }

    /// Header and rows of the file before the first new row; a last row that was cut off is left out.
    std::string earlier_rows(const std::string& header, const std::vector<Column>& columns) const {
        const std::string text = read_file(path_);
        std::string kept;
        for (std::size_t from = 0, end = text.find('\n'); end != std::string::npos; end = text.find('\n', from)) {
            const std::string_view line = std::string_view{text}.substr(from, end - from);
            if (from == 0 && line != header)
                core::refuse("CsvWriter.columns", header, "those of " + path_.string() + ", " + std::string{line});
            if (from == 0 || number(line) < number(columns.front().value)) kept += std::string{line} + "\n";
            from = end + 1;
        }
        return kept;
    }

    std::filesystem::path path_;
    Start start_;
    std::string header_;
    std::ofstream file_;
};

}  // namespace fibrant::observe
