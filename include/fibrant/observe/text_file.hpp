// SPDX-License-Identifier: MIT
#pragma once
/// @file Files that are never seen half written, and numbers as text that do not depend on the locale.

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace fibrant::observe {

/// Shortest text that reads back to the same double; "nan", "inf" or "-inf" for what is not finite.
inline std::string shortest(double value) {
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    return {buffer.data(), end};
}

/// With at most `decimals` digits after the point, without trailing zeros.
inline std::string rounded(double value, int decimals) {
    std::array<char, 400> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, decimals).ptr;
    std::string text{buffer.data(), end};
    if (text.find('.') != std::string::npos) {
        text.erase(text.find_last_not_of('0') + 1);
        if (text.back() == '.') text.pop_back();
    }
    return text == "-0" ? "0" : text;
}

/// The folder itself, made if need be.
inline const std::filesystem::path& made_folder(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    return folder;
}

/// Text with the characters that XML reserves written as entities.
inline std::string xml_escaped(std::string_view text) {
    std::string answer;
    for (const char c : text) {
        switch (c) {
            case '&':
                answer += "&amp;";
                break;
            case '<':
                answer += "&lt;";
                break;
            case '>':
                answer += "&gt;";
                break;
            case '"':
                answer += "&quot;";
                break;
            default:
                answer += c;
        }
    }
    return answer;
}

/// Writes a whole file beside its place, then renames it: a reader or an interruption sees the old file or the new one.
/// Throws std::runtime_error if that fails.
/// @param pieces  pieces(put) calls put(std::string_view) with each piece of the content in its turn
template <class Pieces>
void write_pieces(const std::filesystem::path& path, const Pieces& pieces) {
    std::filesystem::path partial = path;
    partial += ".partial";
    errno = 0;
    std::ofstream file(partial, std::ios::binary | std::ios::trunc);
    pieces([&](std::string_view piece) { file.write(piece.data(), static_cast<std::streamsize>(piece.size())); });
    file.close();
    std::error_code error(file ? 0 : errno, std::generic_category());
    if (file) std::filesystem::rename(partial, path, error);
    if (!file || error)
        throw std::runtime_error("cannot write the file " + path.string() + (error ? ": " + error.message() : std::string()));
}

/// The same of a content that is in memory as a whole.
inline void write_file(const std::filesystem::path& path, std::string_view content) {
    write_pieces(path, [&](const auto& put) { put(content); });
}

/// Whole content of a file; empty if there is none.
inline std::string read_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream content;
    if (file) content << file.rdbuf();
    return content.str();
}

}  // namespace fibrant::observe
