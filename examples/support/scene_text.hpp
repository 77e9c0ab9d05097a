// SPDX-License-Identifier: MIT
#pragma once
/// @file The text of a scene file, looked at before it is taken apart: what is no scene is told by its own message.

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace example {

/// A text as it stands in a message: of at most 80 characters, none of them unseen.
inline std::string clipped(std::string_view text) {
    std::string answer;
    for (const char c : text.substr(0, 80)) answer += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    return text.size() > 80 ? answer + "..." : answer;
}

/// Refuses what is nested so deep that taking it apart would run out of stack: keys of more than 8 parts, brackets within
/// brackets.
/// @param name  of the text, in the message
inline void require_readable(std::string_view text, const std::string& name) {
    constexpr int most_dots = 8, most_brackets = 32;
    int dots = 0, brackets = 0, line = 1;
    const auto fail = [&](const std::string& what) {
        throw std::invalid_argument(name + ":" + std::to_string(line) + ": " + what);
    };
    for (std::size_t k = 0; k < text.size(); ++k) {
        const char c = text[k];
        if (c == '#') {
            while (k + 1 < text.size() && text[k + 1] != '\n') ++k;
        } else if (c == '"' || c == '\'') {
            const bool three = text.substr(k, 3) == std::string(3, c);
            k += three ? 3 : 1;
            for (; k < text.size() && !(three ? text.substr(k, 3) == std::string(3, c) : text[k] == c || text[k] == '\n'); ++k) {
                if (text[k] == '\n') ++line;
                if (text[k] == '\\' && c == '"') ++k;
            }
            if (three)
                k += 2;
            else if (k < text.size() && text[k] == '\n')
                --k;
        } else if (c == '.') {
            if (++dots > most_dots) fail("a key of more than 8 parts, but it must be section.key");
        } else if (c == '[' || c == '{') {
            if (++brackets > most_brackets)
                fail("brackets are nested by more than 32, but values must be numbers, texts, true or false, or lists of texts");
            dots = 0;
        } else if (c == ']' || c == '}') {
            if (brackets > 0) --brackets;
            dots = 0;
        } else if (c == '=' || c == ',' || c == '\n') {
            if (c == '\n') ++line;
            dots = 0;
        }
    }
}

/// The text of a scene file.
/// @throws std::invalid_argument where it is none: a folder, not to be read, far too large
inline std::string scene_text(const std::string& path) {
    constexpr std::size_t most = 1'000'000;
    std::error_code error;
    if (std::filesystem::is_directory(path, error))
        throw std::invalid_argument(path + ": is a folder, but it must be a scene file (TOML)");
    const auto close = [](std::FILE* file) { std::fclose(file); };
    const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "rb"), close);
    if (!file) throw std::invalid_argument(path + ": cannot be read as a scene file: " + std::strerror(errno));
    std::string text;
    std::array<char, 65536> part;
    for (std::size_t size = 1; size > 0 && text.size() <= most;) {
        size = std::fread(part.data(), 1, part.size(), file.get());
        text.append(part.data(), size);
    }
    if (std::ferror(file.get()) != 0)
        throw std::invalid_argument(path + ": cannot be read as a scene file: " + std::strerror(errno));
    if (text.size() > most)
        throw std::invalid_argument(path + ": has more than 1,000,000 characters, but it must be a scene file (TOML) of fewer");
    require_readable(text, path);
    return text;
}

}  // namespace example
