// SPDX-License-Identifier: MIT
#pragma once
/// @file A JSON object, written in the order in which its values were added.

#include <fibrant/core/parameters.hpp>
#include <fibrant/observe/text_file.hpp>

#include <cmath>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fibrant::observe {

/// Text as a JSON string, quotes included. Bytes that are not UTF-8 become the replacement character.
inline std::string json_quoted(std::string_view text) {
    static constexpr char digits[] = "0123456789abcdef";
    std::string answer = "\"";
    for (std::size_t k = 0; k < text.size(); ++k) {
        const auto byte = static_cast<unsigned char>(text[k]);
        if (byte == '"' || byte == '\\') {
            answer += '\\';
            answer += text[k];
        } else if (byte == '\n') {
            answer += "\\n";
        } else if (byte == '\t') {
            answer += "\\t";
        } else if (byte < 0x20 || byte == 0x7f) {
            answer += std::string("\\u00") + digits[byte >> 4] + digits[byte & 15];
        } else if (byte < 0x80) {
            answer += text[k];
        } else {
            // Length by the first byte; the least value of the second excludes overlong forms and surrogates.
            const std::size_t more = byte >= 0xc2 && byte <= 0xdf   ? 1
                                     : byte >= 0xe0 && byte <= 0xef ? 2
                                     : byte >= 0xf0 && byte <= 0xf4 ? 3
                                                                    : 0;
            bool valid = more > 0 && k + more < text.size();
            for (std::size_t n = 1; valid && n <= more; ++n) {
                const auto next = static_cast<unsigned char>(text[k + n]);
                unsigned low = 0x80, high = 0xbf;
                if (n == 1 && byte == 0xe0) low = 0xa0;
                if (n == 1 && byte == 0xed) high = 0x9f;
                if (n == 1 && byte == 0xf0) low = 0x90;
                if (n == 1 && byte == 0xf4) high = 0x8f;
                valid = next >= low && next <= high;
            }
            answer += valid ? std::string(text.substr(k, more + 1)) : std::string("\\ufffd");
            if (valid) k += more;
        }
    }
    return answer + "\"";
}

/// Object of ordered keys. Numbers are written with the digits that identify them; one that is not finite becomes null.
class JsonObject {
public:
    JsonObject& add(std::string_view key, double value) { return put(key, number(value)); }
    JsonObject& add(std::string_view key, bool value) { return put(key, value ? "true" : "false"); }
    template <std::integral Integer>
    JsonObject& add(std::string_view key, Integer value) {
        return put(key, std::to_string(value));
    }
    JsonObject& add(std::string_view key, std::string_view value) { return put(key, json_quoted(value)); }
    // Without this one a literal would be taken for a bool.
    JsonObject& add(std::string_view key, const char* value) { return add(key, std::string_view{value}); }
    JsonObject& add(std::string_view key, const std::string& value) { return add(key, std::string_view{value}); }
    JsonObject& add(std::string_view key, const JsonObject& value) { return put(key, value.text()); }
    JsonObject& add(std::string_view key, const std::vector<double>& values) {
        std::string list;
        for (const double value : values) list += (list.empty() ? "" : ", ") + number(value);
        return put(key, "[" + list + "]");
    }
    JsonObject& add(std::string_view key, const std::vector<JsonObject>& values) {
        std::string list;
        for (const JsonObject& value : values) list += (list.empty() ? "\n  " : ",\n  ") + indented(value.text());
        return put(key, values.empty() ? "[]" : "[" + list + "\n]");
    }

    /// Keys with their values as text, in the order in which they were added.
    const std::vector<std::pair<std::string, std::string>>& members() const noexcept { return members_; }

    /// Indented by two blanks a level, without a line end after the last brace.
    std::string text() const {
        std::string answer = "{";
        for (const auto& member : members_) {
            if (&member != members_.data()) answer += ",";
            answer += "\n  " + json_quoted(member.first) + ": " + indented(member.second);
        }
        return answer + (members_.empty() ? "}" : "\n}");
    }

private:
    static std::string number(double value) { return std::isfinite(value) ? shortest(value) : "null"; }
    // Strings hold no line end, so every one in a value is between its members.
    static std::string indented(const std::string& text) {
        std::string answer;
        for (const char c : text) answer += c == '\n' ? std::string("\n  ") : std::string(1, c);
        return answer;
    }
    JsonObject& put(std::string_view key, std::string value) {
        for (const auto& member : members_)
            if (member.first == key) core::refuse("JsonObject.key", std::string{key}, "new in the object");
        members_.emplace_back(std::string{key}, std::move(value));
        return *this;
    }

    std::vector<std::pair<std::string, std::string>> members_;  ///< key, value as text
};

}  // namespace fibrant::observe
