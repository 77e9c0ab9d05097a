// SPDX-License-Identifier: MIT
#pragma once
/// @file Reads a scene file: each key is told once, with its bound, its unit and a sentence, and from that come reading,
/// refusing, help and echo.

#include "bound.hpp"
#include "nearest_name.hpp"
#include "scene_text.hpp"

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>

#include <toml++/toml.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace example {

using fibrant::Index;

/// Of a text that is free.
inline std::vector<std::string> any_text() { return {}; }

/// Thrown by `SceneReader::complete` where there is no file: all keys have been told.
struct Described {};

/// A file of sections of keys, with values replaced from the command line. Whatever is wrong throws std::invalid_argument, "file:
/// section.key = value, but it must be bound". What must be given and is not is told by `complete`, after keys that nobody knows:
/// one of those is often it.
class SceneReader {
public:
    using Names = std::vector<std::pair<std::string, std::string>>;

    /// @param overrides  "section.key=value", the value as in the file (quotes of a text may be left out); later ones win
    SceneReader(std::string file, const std::vector<std::string>& overrides) : SceneReader(file, scene_text(file), overrides) {}
    /// A text in the place of a file.
    /// @param name  that messages give it; relative paths in the scene are as from a file of this name
    SceneReader(std::string name, const std::string& text, const std::vector<std::string>& overrides) : file_{std::move(name)} {
        try {
            table_ = toml::parse(text);
        } catch (const toml::parse_error& error) {
            std::ostringstream place;
            place << file_ << ":";
            if (error.source().begin.line > 0) place << error.source().begin.line << ":" << error.source().begin.column << ":";
            place << " " << error.description();
            throw std::invalid_argument(place.str());
        }
        for (const std::string& replacement : overrides) replace(replacement);
    }
    /// A reader without a file, that takes down what it is asked for.
    static SceneReader of_keys() {
        SceneReader reader;
        reader.describes_ = true;
        return reader;
    }
    /// There is no file: all values are those taken otherwise.
    bool describes() const noexcept { return describes_; }
    const std::string& file() const noexcept { return file_; }

    bool given(const std::string& section, const std::string& key) const { return find(section, key) != nullptr; }
    bool has_section(const std::string& section) const { return table_[section].is_table(); }
    /// Sections of the file in which the key is given.
    std::vector<std::string> sections_with(const std::string& key) const {
        std::vector<std::string> names;
        for (const auto& [title, section] : table_)
            if (section.is_table() && section.as_table()->contains(key)) names.emplace_back(title.str());
        return names;
    }

    /// Leaves `value` alone where the key is not given. @return whether it is
    bool read(const std::string& section, const std::string& key, double& value, const Bound& bound, const char* unit,
              const char* sentence) {
        Entry& entry = tell(section, key, "number", bound.text(), unit, sentence,
                            std::isnan(value) ? "" : fibrant::observe::shortest(value));
        const toml::node* found = find(section, key);
        if (found == nullptr) return false;
        if (!found->is_number()) refuse(section, key, *found, "a number " + bound.text() + written(*found, "0.5 or 5e-1"));
        value = as_double(*found);
        if (!bound.holds(value)) refuse(section, key, *found, bound.text());
        entry.value = fibrant::observe::shortest(value);
        return entry.given = true;
    }
    bool read(const std::string& section, const std::string& key, Index& value, const Bound& bound, const char* sentence) {
        Entry& entry = tell(section, key, "whole number", bound.text(), "", sentence, std::to_string(value));
        const toml::node* found = find(section, key);
        if (found == nullptr) return false;
        if (!found->is_integer())
            refuse(section, key, *found,
                   "a whole number " + bound.text() + (found->is_number() ? ", without a point or an exponent" : "") +
                       written(*found, "1000"));
        value = static_cast<Index>(found->as_integer()->get());
        if (!bound.holds(static_cast<double>(value))) refuse(section, key, *found, bound.text());
        entry.value = std::to_string(value);
        return entry.given = true;
    }
    bool read(const std::string& section, const std::string& key, bool& value, const char* sentence) {
        Entry& entry = tell(section, key, "true or false", "", "", sentence, value ? "true" : "false");
        const toml::node* found = find(section, key);
        if (found == nullptr) return false;
        if (!found->is_boolean()) refuse(section, key, *found, "true or false");
        value = found->as_boolean()->get();
        entry.value = value ? "true" : "false";
        return entry.given = true;
    }
    /// @param allowed  texts it may be; empty: any of up to 4096 characters
    bool read(const std::string& section, const std::string& key, std::string& value, const std::vector<std::string>& allowed,
              const char* sentence) {
        Entry& entry =
            tell(section, key, "text", allowed.empty() ? "" : "one of " + joined(allowed), "", sentence, quoted(value));
        const toml::node* found = find(section, key);
        if (found == nullptr) return false;
        if (!found->is_string()) refuse(section, key, *found, "a text");
        value = found->as_string()->get();
        if (!allowed.empty() && std::find(allowed.begin(), allowed.end(), value) == allowed.end())
            refuse(section, key, *found, "one of " + joined(allowed) + meant(nearest_name(value, allowed)));
        if (value.size() > longest_text || value.find('\0') != std::string::npos)
            refuse(section, key, *found, "a text of at most 4096 characters, none of them 0");
        entry.value = quoted(value);
        return entry.given = true;
    }
    /// A list of texts, which may be empty.
    bool read(const std::string& section, const std::string& key, std::vector<std::string>& value, const char* sentence) {
        Entry& entry = tell(section, key, "list of texts", "", "", sentence, listed(value));
        const toml::node* found = find(section, key);
        if (found == nullptr) return false;
        const toml::array* list = found->as_array();
        if (list == nullptr || (!list->empty() && !list->is_homogeneous(toml::node_type::string)))
            refuse(section, key, *found, "a list of texts");
        if (list->size() > longest_list) refuse(section, key, *found, "a list of at most 1000 texts");
        value.clear();
        for (const toml::node& row : *list) {
            value.push_back(row.as_string()->get());
            if (value.back().size() > longest_text) refuse(section, key, *found, "a list of texts of at most 4096 characters");
        }
        entry.value = listed(value);
        return entry.given = true;
    }
    bool is_list(const std::string& section, const std::string& key) const {
        const toml::node* found = find(section, key);
        return found != nullptr && found->is_array();
    }
    /// The same as `read`, but the key must be given.
    template <class... Told>
    void require(const std::string& section, const std::string& key, Told&&... told) {
        const bool found = read(section, key, std::forward<Told>(told)...);
        entry(section, key)->required = true;
        if (!found) missing_.emplace_back(section, key);
    }
    /// One of several ways to say the same: it is no part of the echo unless it is given.
    void is_one_of_several_ways(const std::string& section, const std::string& key) { entry(section, key)->way = true; }
    /// It says where something is, and not what the scene is.
    void is_a_place(const std::string& section, const std::string& key) { entry(section, key)->place = true; }

    /// Refuses keys that nobody asked for, then what is missing. To be called before values are used.
    void complete() const {
        refuse_unknown();
        if (describes_) throw Described{};
        refuse_missing();
        if (const auto tell = std::exchange(when_read_, nullptr)) tell();
    }
    /// Calls what is given once the file has been read and its keys are those of the program: what is left to check may take a
    /// while, and a long silence looks like an end.
    void when_read(std::function<void()> tell) { when_read_ = std::move(tell); }

    /// Refuses a value that has been read, be it given or taken otherwise.
    [[noreturn]] void refuse(const std::string& section, const std::string& key, const std::string& bound) const {
        if (const toml::node* found = find(section, key); found != nullptr) refuse(section, key, *found, bound);
        const Entry* told = entry(section, key);
        fibrant::core::refuse(file_ + ": " + section + "." + key,
                              told == nullptr || told->value.empty() ? "(not given)" : told->value + " (not given)", bound);
    }
    void check(bool holds, const std::string& section, const std::string& key, const std::string& bound) const {
        if (!holds) refuse(section, key, bound);
    }

    /// Fields of structures that are read from a key: what a check says of them is told by it. The first that fits the beginning
    /// of a message holds.
    void names(const Names& more) { names_.insert(names_.end(), more.begin(), more.end()); }
    /// What a check refused, by file and key.
    std::string told(const std::string& message) const {
        if (message.compare(0, file_.size() + 1, file_ + ":") == 0) return message;
        for (const auto& [field, key] : names_)
            if (message.compare(0, field.size(), field) == 0) return file_ + ": " + key + message.substr(field.size());
        return file_ + ": " + message;
    }

    /// The keys of a program, section by section.
    std::string help() const {
        std::string text;
        for (const std::string& title : sections()) {
            text += "[" + title + "]\n";
            for (const Entry& told : entries_)
                if (told.section == title)
                    text += "  " + told.key +
                            (told.required        ? ": must be given"
                             : told.value.empty() ? ""
                                                  : " = " + told.value) +
                            "  (" + told.kind + (told.bound.empty() ? "" : " " + told.bound) +
                            (told.unit.empty() ? "" : "; [" + told.unit + "]") + ")\n      " + told.sentence + "\n";
        }
        return text;
    }
    /// All values, given or not, as a scene file that says the same.
    std::string echo() const {
        std::string text;
        for (const std::string& title : sections()) {
            text += (text.empty() ? "[" : "\n[") + title + "]\n";
            for (const Entry& told : entries_)
                if (told.section == title && !told.value.empty() && (told.given || !told.way))
                    text += told.key + " = " + told.value + "\n";
        }
        return text;
    }
    /// What the scene is: a line a key, but for what says how it is solved and what is written, and where things are.
    /// @param only  sections; empty: all
    std::string scene(const std::vector<std::string>& only = {}) const {
        std::string text;
        for (const Entry& told : entries_) {
            if (told.section == "solver" || told.section == "output" || told.place) continue;
            if (!only.empty() && std::find(only.begin(), only.end(), told.section) == only.end()) continue;
            text += told.section + "." + told.key + " = " + (told.value.empty() || (told.way && !told.given) ? "-" : told.value) +
                    "\n";
        }
        return text;
    }

private:
    /// Of a node that is a number. toml++ gives no whole number as a double that it does not hold to the last digit.
    static double as_double(const toml::node& number) {
        return number.is_integer() ? static_cast<double>(number.as_integer()->get()) : number.as_floating_point()->get();
    }
    void refuse_unknown() const { refuse_unknown(table_, ""); }
    /// @param above  the section that a table is in, with a dot
    void refuse_unknown(const toml::table& table, const std::string& above) const {
        for (const auto& [name, section] : table) {
            const std::string title = above + std::string(name.str());
            if (!above.empty() && !section.is_table()) continue;
            const bool known = std::any_of(entries_.begin(), entries_.end(),
                                           [&, &wanted = title](const Entry& entry) { return entry.section == wanted; });
            if (!known || !section.is_table())
                throw std::invalid_argument(file_ + ": " + clipped(title) + (section.is_table() ? " = [section]" : "") +
                                            ", but it must be one of the sections " + joined(sections()) +
                                            meant(nearest_name(title, sections())));
            for (const auto& [name_in, value] : *section.as_table()) {
                const std::string key{name_in.str()};
                if (value.is_table() && is_section(title + "." + key)) continue;
                if (entry(title, key) == nullptr)
                    refuse(title, clipped(key), value, "one of the keys " + joined(keys(title)) + meant_by(title, key));
            }
            refuse_unknown(*section.as_table(), title + ".");
        }
    }
    static std::string meant(const std::string& name) { return name.empty() ? name : ": perhaps " + name + " is meant"; }
    /// What a key that nobody knows may stand for: one of its section that is like it, or one of its name elsewhere.
    std::string meant_by(const std::string& section, const std::string& key) const {
        if (const std::string near = nearest_name(key, keys(section)); !near.empty()) return meant(near);
        for (const Entry& told : entries_)
            if (told.key == key) return ": perhaps it belongs to [" + told.section + "]";
        return "";
    }
    bool is_section(const std::string& title) const {
        return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& told) { return told.section == title; });
    }
    void refuse_missing() const {
        if (missing_.empty()) return;
        const Entry& first = *entry(missing_.front().first, missing_.front().second);
        std::string others;
        for (std::size_t k = 1; k < missing_.size() && k < 12; ++k)
            others += (k == 1 ? "; so must " : ", ") + missing_[k].first + "." + missing_[k].second;
        throw std::invalid_argument(file_ + ": " + first.section + "." + first.key +
                                    " is missing, but it must be given: " + first.sentence + ", a " + first.kind +
                                    (first.bound.empty() ? "" : " " + first.bound) + others);
    }

    struct Entry {
        std::string section, key, kind, bound, unit, sentence, value;
        bool required = false, given = false, way = false, place = false;
    };
    static constexpr std::size_t longest_text = 4096, longest_list = 1000;

    SceneReader() : file_{"scene"} {}

    /// The first who asks for a key tells of it.
    Entry& tell(const std::string& section, const std::string& key, std::string kind, std::string bound, const char* unit,
                const char* sentence, std::string value) {
        for (Entry& known : entries_)
            if (known.section == section && known.key == key) return known;
        return entries_.emplace_back(Entry{section, key, std::move(kind), std::move(bound), unit, sentence, std::move(value)});
    }
    Entry* entry(const std::string& section, const std::string& key) {
        for (Entry& known : entries_)
            if (known.section == section && known.key == key) return &known;
        return nullptr;
    }
    const Entry* entry(const std::string& section, const std::string& key) const {
        return const_cast<SceneReader*>(this)->entry(section, key);
    }

    [[noreturn]] void refuse(const std::string& section, const std::string& key, const toml::node& value,
                             const std::string& bound) const {
        std::ostringstream text;
        if (value.is_table() && !value.as_table()->is_inline())
            text << "[section]";
        else if (value.is_floating_point())
            text << plain_text(value.as_floating_point()->get());
        else
            text << toml::node_view<const toml::node>{value};
        fibrant::core::refuse(file_ + ": " + section + "." + key, clipped(text.str()), bound);
    }
    const toml::node* find(const std::string& section, const std::string& key) const {
        const toml::table* table = &table_;
        for (std::size_t from = 0; from <= section.size();) {  // [a.b] is a table in a table
            const std::size_t dot = std::min(section.find('.', from), section.size());
            const toml::node* titled = table->get(section.substr(from, dot - from));
            if (titled == nullptr) return nullptr;
            if (!titled->is_table())
                throw std::invalid_argument(file_ + ": " + section.substr(0, dot) + " is a " +
                                            (titled->is_array() ? "list" : "value") + ", but it must be a section, [" +
                                            section.substr(0, dot) + "]");
            table = titled->as_table(), from = dot + 1;
        }
        return table->get(key);
    }
    void replace(const std::string& text) {
        const std::size_t equals = text.find('='), dot = text.substr(0, equals).rfind('.');
        if (equals == std::string::npos || dot == std::string::npos || dot > equals || dot == 0 || dot + 1 == equals)
            fibrant::core::refuse("--set", clipped(text), "section.key=value");
        const std::string section = trimmed(text.substr(0, dot)), key = trimmed(text.substr(dot + 1, equals - dot - 1));
        if (section.empty() || key.empty() || section.front() == '.' || section.back() == '.' ||
            section.find("..") != std::string::npos)
            fibrant::core::refuse("--set", clipped(text), "section.key=value");
        const std::string value = trimmed(text.substr(equals + 1));
        if (value.empty()) fibrant::core::refuse("--set", clipped(text), "section.key=value, and the value is missing");
        if (value.find_first_of("\r\n") != std::string::npos)
            fibrant::core::refuse("--set", clipped(text), "section.key=value in one line");
        require_readable(value, "--set " + clipped(section + "." + key));
        find(section, key);  // refuses what is no section
        toml::table* inner = &table_;
        for (std::size_t from = 0; from <= section.size();) {
            const std::size_t end = std::min(section.find('.', from), section.size());
            const std::string name = section.substr(from, end - from);
            if (inner->get(name) == nullptr) inner->insert(name, toml::table{});
            inner = inner->get(name)->as_table(), from = end + 1;
        }
        toml::table& table = *inner;
        try {
            const toml::table parsed = toml::parse("value = " + value);
            if (parsed.size() == 1)
                return parsed.get("value")->visit([&](const auto& known) { table.insert_or_assign(key, known); });
        } catch (const toml::parse_error& error) {  // a text without quotes, or what is begun and not ended
            if (std::string_view("\"'[{").find(value.front()) != std::string_view::npos)
                fibrant::core::refuse("--set " + clipped(section + "." + key), clipped(value),
                                      "a value of TOML: " + std::string(error.description()));
        }
        table.insert_or_assign(key, value);
    }

    static std::string trimmed(const std::string& text) {
        const std::size_t first = text.find_first_not_of(' ');
        return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
    }
    std::vector<std::string> sections() const {
        std::vector<std::string> answer;
        for (const Entry& told : entries_)
            if (std::find(answer.begin(), answer.end(), told.section) == answer.end()) answer.push_back(told.section);
        return answer;
    }
    std::vector<std::string> keys(const std::string& section) const {
        std::vector<std::string> answer;
        for (const Entry& told : entries_)
            if (told.section == section) answer.push_back(told.key);
        return answer;
    }
    /// How a number is written, where a text stands for one: in quotes, with a comma, or with a point at its end.
    static std::string written(const toml::node& node, const char* example) {
        const auto* text = node.as_string();
        const bool meant = text != nullptr && text->get().find_first_of("0123456789") != std::string::npos &&
                           text->get().find_first_not_of("0123456789+-.,_eE ") == std::string::npos;
        return meant ? std::string(", written as ") + example + " without quotes" : "";
    }
    static std::string joined(const std::vector<std::string>& names) {
        std::string text;
        for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
        return text;
    }
    static std::string quoted(const std::string& text) {
        std::ostringstream out;
        const toml::value<std::string> value{text};
        const toml::node& node = value;
        out << toml::node_view<const toml::node>{node};
        return out.str();
    }
    static std::string listed(const std::vector<std::string>& texts) {
        std::string text;
        for (const std::string& one : texts) text += (text.empty() ? "" : ", ") + quoted(one);
        return "[" + text + "]";
    }

    std::string file_;
    toml::table table_;
    std::vector<Entry> entries_;  ///< in the order of reading, which is that of the documentation
    std::vector<std::pair<std::string, std::string>> missing_;
    Names names_;
    mutable std::function<void()> when_read_;
    bool describes_ = false;
};

}  // namespace example
