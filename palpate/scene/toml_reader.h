#pragma once
// Reads TOML into plain structs, with messages that name the file, the line and the nearest known key. It
// brings in toml++, so only read_scene.cpp includes it.
#include "palpate/base/error.h"
#include "palpate/base/names.h"
#include "palpate/base/vectors.h"
#include "palpate/scene/check.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace palpate {

inline int line_of(const toml::node& node) { return int(node.source().begin.line); }

/// Reads one table into a struct: it is called with each key and where its value goes. Keys that it was never
/// called with are errors, found by finish().
class Reader {
 public:
    Reader(const toml::table& table, const SceneSource& source, std::string what)
        : table_(table), source_(source), what_(std::move(what)) {}

    template <class T>
    void operator()(const char* key, T& value) {
        known_.insert(key);
        if (const toml::node* node = table_.get(key)) read(key, *node, value);
    }

    /// The tables of `[[key]]`, each read by read_one(reader, line).
    template <class ReadOne>
    void each(const char* key, ReadOne read_one) {
        known_.insert(key);
        const toml::node* node = table_.get(key);
        if (!node) return;
        const toml::array* array = node->as_array();
        if (!array || !array->is_array_of_tables())
            wrong(key, *node, fmt::format("tables; write [[{}]]", key));
        for (const toml::node& one : *array) {
            Reader reader(*one.as_table(), source_, fmt::format("a {}", key));
            read_one(reader, line_of(one));
            reader.finish();
        }
    }

    /// A table inside this one, read by read_inside(reader) if it is there.
    template <class ReadInside>
    void table(const char* key, ReadInside read_inside) {
        known_.insert(key);
        const toml::node* node = table_.get(key);
        if (!node) return;
        if (!node->is_table()) wrong(key, *node, "a table");
        Reader reader(*node->as_table(), source_, key);
        read_inside(reader);
        reader.finish();
    }

    bool has(const char* key) const { return table_.contains(key); }
    int line() const { return line_of(table_); }
    const toml::node* get(const char* key) {
        known_.insert(key);
        return table_.get(key);
    }

    [[noreturn]] void wrong(std::string_view key, const toml::node& node, std::string_view wanted) const {
        source_.fail(line_of(node), fmt::format("\"{}\" is not {}", key, wanted), "correct its value");
    }

    void finish() const {
        for (const auto& [key, node] : table_) {
            const std::string name(key.str());
            if (known_.contains(name)) continue;
            const auto nearest = std::min_element(
                known_.begin(), known_.end(),
                [&](const auto& a, const auto& b) { return edits(a, name) < edits(b, name); });
            source_.fail(
                line_of(node), fmt::format("unknown key \"{}\" of {}", name, what_),
                nearest == known_.end() ? "remove it" : fmt::format("did you mean \"{}\"?", *nearest));
        }
    }

    // ---- one overload for each kind of value ----

    void read(std::string_view key, const toml::node& node, std::string& value) const {
        const auto text = node.value_exact<std::string>();
        if (!text) wrong(key, node, "a text in quotes");
        value = *text;
    }
    void read(std::string_view key, const toml::node& node, bool& value) const {
        const auto truth = node.value_exact<bool>();
        if (!truth) wrong(key, node, "true or false");
        value = *truth;
    }
    void read(std::string_view key, const toml::node& node, int& value) const {
        const auto number = node.value_exact<std::int64_t>();
        if (!number || *number < std::numeric_limits<int>::min() || *number > std::numeric_limits<int>::max())
            wrong(key, node, "a whole number");
        value = int(*number);
    }
    void read(std::string_view key, const toml::node& node, double& value) const {
        if (!node.is_number() || !std::isfinite(*node.value<double>())) wrong(key, node, "a number");
        value = *node.value<double>();
    }
    void read(std::string_view key, const toml::node& node, float& value) const {
        double wide = 0;
        read(key, node, wide);
        value = float(wide);
        if (!std::isfinite(value)) wrong(key, node, "a number of a sensible size");
    }
    template <int L, class T>
    void read(std::string_view key, const toml::node& node, glm::vec<L, T>& value) const {
        const toml::array* array = node.as_array();
        if (!array || array->size() != L)
            wrong(key, node, L == 2 ? "two numbers in brackets" : "three numbers in brackets");
        for (int i = 0; i < L; ++i) read(key, (*array)[std::size_t(i)], value[i]);
    }
    template <class T>
    void read(std::string_view key, const toml::node& node, std::vector<T>& value) const {
        const toml::array* array = node.as_array();
        if (!array) wrong(key, node, "a list in brackets");
        value.clear();
        for (const toml::node& one : *array) read(key, one, value.emplace_back());
    }
    template <class T>
    void read(std::string_view key, const toml::node& node, std::optional<T>& value) const {
        read(key, node, value.emplace());
    }
    template <class E>
    requires std::is_enum_v<E>
    void read(std::string_view key, const toml::node& node, E& value) const {
        std::string name;
        read(key, node, name);
        const auto known = value_of<E>(name);
        if (!known)
            source_.fail(line_of(node), fmt::format("\"{}\" is no {}", name, key),
                         "choose from " + all_names<E>());
        value = *known;
    }

 private:
    const toml::table& table_;
    const SceneSource& source_;
    std::string what_;
    std::set<std::string> known_;
};

}  // namespace palpate
