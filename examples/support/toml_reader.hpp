// SPDX-License-Identifier: MIT
#pragma once
/// @file Strict reading of a TOML file of sections: every key is known, every value has the right type.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>

#include <toml++/toml.h>

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace example {

using fibrant::Index;

/// A file of sections of keys, with values replaced from the command line. Whatever is wrong throws
/// std::invalid_argument, "file: section.key = value, but it must be bound".
class TomlReader {
public:
    /// @param overrides  "section.key=value", the value as in the file (quotes of a text may be left out); later ones
    /// win
    TomlReader(std::string file, const std::vector<std::string>& overrides) : file_{std::move(file)} {
        try {
            table_ = toml::parse_file(file_);
        } catch (const toml::parse_error& error) {
            std::ostringstream place;
            place << file_ << ":";
            if (error.source().begin.line > 0)
                place << error.source().begin.line << ":" << error.source().begin.column << ":";
            place << " " << error.description();
            throw std::invalid_argument(place.str());
        }
        for (const std::string& text : overrides) replace(text);
    }

    bool has(const std::string& section, const std::string& key) { return node(section, key) != nullptr; }
    /// Sections of the file in which the key is given.
    std::vector<std::string> sections_with(const std::string& key) const {
        std::vector<std::string> names;
        for (const auto& [title, section] : table_)
            if (section.is_table() && section.as_table()->contains(key)) names.emplace_back(title.str());
        return names;
    }

    /// Leaves `value` alone where the key is not given. @return whether it is
    bool read(const std::string& section, const std::string& key, double& value) {
        const toml::node* found = node(section, key);
        if (found == nullptr) return false;
        if (!found->is_number()) refuse(section, key, *found, "a number");
        value = found->value<double>().value();
        return true;
    }
    bool read(const std::string& section, const std::string& key, Index& value) {
        const toml::node* found = node(section, key);
        if (found == nullptr) return false;
        if (!found->is_integer()) refuse(section, key, *found, "a whole number");
        value = static_cast<Index>(found->as_integer()->get());
        return true;
    }
    bool read(const std::string& section, const std::string& key, bool& value) {
        const toml::node* found = node(section, key);
        if (found == nullptr) return false;
        if (!found->is_boolean()) refuse(section, key, *found, "true or false");
        value = found->as_boolean()->get();
        return true;
    }
    /// @param allowed  texts it may be; empty: any
    bool read(const std::string& section, const std::string& key, std::string& value,
              const std::vector<std::string>& allowed = {}) {
        const toml::node* found = node(section, key);
        if (found == nullptr) return false;
        if (!found->is_string()) refuse(section, key, *found, "a text");
        value = found->as_string()->get();
        if (!allowed.empty() && std::find(allowed.begin(), allowed.end(), value) == allowed.end())
            refuse(section, key, *found, "one of " + joined(allowed));
        return true;
    }
    /// A list of texts, which may be empty.
    bool read(const std::string& section, const std::string& key, std::vector<std::string>& value) {
        const toml::node* found = node(section, key);
        if (found == nullptr) return false;
        const toml::array* list = found->as_array();
        if (list == nullptr || (!list->empty() && !list->is_homogeneous(toml::node_type::string)))
            refuse(section, key, *found, "a list of texts");
        value.clear();
        for (const toml::node& row : *list) value.push_back(row.as_string()->get());
        return true;
    }
    bool is_list(const std::string& section, const std::string& key) {
        const toml::node* found = node(section, key);
        return found != nullptr && found->is_array();
    }

    /// The same, but the key must be given.
    template <class Value>
    void require(const std::string& section, const std::string& key, Value& value) {
        if (!read(section, key, value))
            throw std::invalid_argument(file_ + ": " + section + "." + key + " is missing, but it must be given");
    }

    /// Refuses what was never asked for. To be called before the values are used.
    void refuse_unknown() const {
        for (const auto& [name, section] : table_) {
            const std::string title{name.str()};
            const bool known = std::any_of(asked_.begin(), asked_.end(), [&, &section_name = title](const Key& key) {
                return key.first == section_name;
            });
            if (!known || !section.is_table())
                throw std::invalid_argument(file_ + ": " + title + (section.is_table() ? " = [section]" : "") +
                                            ", but it must be one of the sections " + joined(sections()));
            for (const auto& entry : *section.as_table()) {
                const std::string key{entry.first.str()};
                if (std::find(asked_.begin(), asked_.end(), Key{title, key}) == asked_.end())
                    refuse(title, key, entry.second, "one of the keys " + joined(keys(title)));
            }
        }
    }

    /// Throws again what a check refused, with the name of the file and the key that the field was read from.
    /// @param names  field of a structure -> section.key, the first that fits the beginning of the message
    [[noreturn]] void rethrow(const std::invalid_argument& error,
                              const std::vector<std::pair<std::string, std::string>>& names) const {
        std::string message = error.what();
        for (const auto& name : names) {
            if (message.compare(0, name.first.size(), name.first) != 0) continue;
            message.replace(0, name.first.size(), name.second);
            break;
        }
        throw std::invalid_argument(file_ + ": " + message);
    }

    [[noreturn]] void refuse(const std::string& section, const std::string& key, const std::string& bound) {
        refuse(section, key, *node(section, key), bound);
    }

private:
    using Key = std::pair<std::string, std::string>;

    [[noreturn]] void refuse(const std::string& section, const std::string& key, const toml::node& value,
                             const std::string& bound) const {
        std::ostringstream text;
        text << toml::node_view<const toml::node>{value};
        fibrant::core::refuse(file_ + ": " + section + "." + key, text.str(), bound);
    }

    const toml::node* node(const std::string& section, const std::string& key) {
        if (std::find(asked_.begin(), asked_.end(), Key{section, key}) == asked_.end())
            asked_.emplace_back(section, key);
        const toml::table* table = table_[section].as_table();
        return table == nullptr ? nullptr : table->get(key);
    }

    void replace(const std::string& text) {
        const std::size_t equals = text.find('='), dot = text.find('.');
        if (equals == std::string::npos || dot == std::string::npos || dot > equals || dot == 0 || dot + 1 == equals)
            fibrant::core::refuse("--set", text, "section.key=value");
        const std::string section = trimmed(text.substr(0, dot)), key = trimmed(text.substr(dot + 1, equals - dot - 1));
        const std::string value = trimmed(text.substr(equals + 1));
        if (table_[section].as_table() == nullptr) table_.insert_or_assign(section, toml::table{});
        toml::table& table = *table_[section].as_table();
        try {
            toml::table parsed = toml::parse("value = " + value);
            parsed.get("value")->visit([&](auto& known) { table.insert_or_assign(key, known); });
        } catch (const toml::parse_error&) {
            table.insert_or_assign(key, value);  // a text without quotes
        }
    }

    static std::string trimmed(const std::string& text) {
        const std::size_t first = text.find_first_not_of(' ');
        return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
    }

    std::vector<std::string> sections() const {
        std::vector<std::string> names;
        for (const Key& key : asked_)
            if (std::find(names.begin(), names.end(), key.first) == names.end()) names.push_back(key.first);
        return names;
    }
    std::vector<std::string> keys(const std::string& section) const {
        std::vector<std::string> names;
        for (const Key& key : asked_)
            if (key.first == section) names.push_back(key.second);
        return names;
    }
    static std::string joined(const std::vector<std::string>& names) {
        std::string text;
        for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
        return text;
    }

    std::string file_;
    toml::table table_;
    std::vector<Key> asked_;  ///< in the order of reading, which is that of the documentation
};

}  // namespace example
