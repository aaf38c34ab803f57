#pragma once
// Reads TOML into plain structs, with messages that name the file, the line, the key, its unit and the most
// similar known key. It includes toml++, so only read_scene.cpp includes it.
#include "palpate/base/error.h"
#include "palpate/base/names.h"
#include "palpate/base/vectors.h"
#include "palpate/scene/check.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace palpate {

/// 0: it came with a change, not from the file.
inline int line_of(const toml::node& node) { return int(node.source().begin.line); }

/// The valid and the usual range of a number. A number outside the valid range is refused; an unusual one is
/// accepted, with a note that asks whether its unit is right.
struct NumberRange {
    double least = -std::numeric_limits<double>::infinity(), most = -least;
    bool above = false;                           // whether `least` itself is excluded
    std::string_view unit = "";                   // "Pa"
    std::string_view example = "";                // "brain is about 1e4 Pa"
    double usual_least = 0, usual_most = -least;  // for its absolute value; 0 is never unusual

    NumberRange usual(double low, double high) const {
        NumberRange range = *this;
        range.usual_least = low;
        range.usual_most = high;
        return range;
    }
    bool holds(double value) const { return (above ? value > least : value >= least) && value <= most; }
    bool is_usual(double value) const {
        const double size = std::abs(value);
        return size == 0 || (size >= usual_least && size <= usual_most);
    }
    /// What is wrong with a number outside the range: "not above 0", "negative", "not from 0 to 1".
    std::string complaint(double value) const {
        const bool no_end = std::isinf(most);
        if (value < 0 && least == 0 && !above) return "negative";
        if (no_end && least == 0) return "not above 0";
        if (no_end) return fmt::format("less than {}", least);
        return fmt::format("not {} {} {} {}", above ? "above" : "from", least, above ? "and at most" : "to",
                           most);
    }
};

inline NumberRange any_number(std::string_view unit, std::string_view example = "") {
    NumberRange range;
    range.unit = unit;
    range.example = example;
    return range;
}
inline NumberRange zero_or_more(std::string_view unit, std::string_view example = "") {
    NumberRange range = any_number(unit, example);
    range.least = 0;
    return range;
}
inline NumberRange above_zero(std::string_view unit, std::string_view example = "") {
    NumberRange range = zero_or_more(unit, example);
    range.above = true;
    return range;
}
inline NumberRange between(double least, double most, std::string_view unit = "",
                           std::string_view example = "") {
    NumberRange range = any_number(unit, example);
    range.least = least;
    range.most = most;
    return range;
}

/// Shared by all tables of a scene while they are read.
struct SceneReading {
    const SceneSource& source;
    std::vector<std::string> notes = {};  // warnings
    std::map<std::string, std::set<std::string>> keys =
        {};                                 // the known keys of each table, by its path: "body.cube"
    std::map<int, std::string> units = {};  // of the numbers on each line
};

/// Suggests a decimal point for a number with a comma. A comma before three digits may separate thousands:
/// "20,000" gives "20.000, or 20000 if the comma separates thousands".
inline std::string with_point(const std::string& number) {
    const auto comma = number.find(',');
    std::string decimal = number, whole = number;
    if (comma == number.npos) return number;
    decimal[comma] = '.';
    whole.erase(comma, 1);
    const auto first = number.find_first_not_of("+-");
    const bool thousands = number.size() - comma == 4 && comma - first <= 3 && number[first] != '0' &&
                           number.find_first_not_of("0123456789", comma + 1) == number.npos;
    return thousands ? fmt::format("{}, or {} if the comma separates thousands", decimal, whole) : decimal;
}

/// An integer or a float as a number; NaN for other values.
inline double number_of(const toml::node& node) {
    if (const auto whole = node.value_exact<std::int64_t>()) return double(*whole);
    return node.value_exact<double>().value_or(std::numeric_limits<double>::quiet_NaN());
}

/// A value for messages: "many" in quotes, or "a list of 3".
inline std::string in_words(const toml::node& node) {
    if (const auto text = node.value_exact<std::string>()) return '"' + *text + '"';
    if (const auto truth = node.value_exact<bool>()) return *truth ? "true" : "false";
    if (const auto whole = node.value_exact<std::int64_t>()) return std::to_string(*whole);
    if (node.is_number()) return fmt::format("{:.6g}", number_of(node));
    if (const toml::array* array = node.as_array()) return fmt::format("a list of {}", array->size());
    return node.is_table() ? "a table" : "a date or a time";
}

/// Reads one table into a struct: it is called with each key and the destination of its value. Keys with
/// which it was never called are errors, found by finish().
class Reader {
 public:
    /// `path`: the path of the table in its scene, as in a change: "body.cube.pin"; empty for the whole
    /// scene.
    Reader(const toml::table& table, SceneReading& reading, std::string path)
        : table_(table), reading_(reading), path_(std::move(path)) {}

    template <class T>
    void operator()(const char* key, T& value) {
        if (const toml::node* node = get(key)) read(key, *node, value);
    }

    /// A number, or a vector of numbers, that must be in a range.
    template <class T>
    void operator()(const char* key, T& value, const NumberRange& range) {
        const toml::node* node = get(key);
        if (!node) return;
        reading_.units[line_of(*node)] = range.unit;
        read(key, *node, value);
        check(key, *node, range);
    }

    /// A direction of any length above zero.
    template <class Vector>
    void direction(const char* key, Vector& value, const char* example) {
        const toml::node* node = get(key);
        if (!node) return;
        vec3 read_one(0);
        read(key, *node, read_one);
        if (!(glm::length(read_one) > 0))
            fail(*node, full(key) + " is zero", fmt::format("give it a direction, such as {}", example));
        value = read_one;
    }

    /// A colour: linear light from 0 to `most`.
    void colour(const char* key, vec3& value, float most = 1) {
        const toml::node* node = get(key);
        if (!node) return;
        read(key, *node, value);
        if (std::min({value.x, value.y, value.z}) >= 0 && std::max({value.x, value.y, value.z}) <= most)
            return;
        if (std::min({value.x, value.y, value.z}) < 0)
            fail(*node, full(key) + " is negative",
                 fmt::format("give red, green and blue from 0 to {}", most));
        auto linear = [](float byte) {  // from sRGB
            const double part = std::clamp(byte / 255.0, 0.0, 1.0);
            return part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4);
        };
        fail(*node, fmt::format("{} is not from 0 to {}", full(key), most),
             fmt::format(
                 "for sRGB values from 0 to 255, write [{:.2g}, {:.2g}, {:.2g}], which is linear light",
                 linear(value.x), linear(value.y), linear(value.z)));
    }

    /// The tables of `[[key]]`, each read by read_one(reader).
    template <class ReadOne>
    void each(const char* key, ReadOne read_one) {
        const toml::node* node = get(key);
        if (!node) return;
        const toml::array* array = node->as_array();
        if (!array || !array->is_array_of_tables())
            wrong(key, *node, "a list of tables", fmt::format("write [[{}]]", key));
        for (std::size_t i = 0; i < array->size(); ++i) {
            const toml::table& one = *array->get(i)->as_table();
            const auto* name = one.get_as<std::string>("name");
            Reader reader(one, reading_, full(key) + "." + (name ? name->get() : std::to_string(i + 1)));
            read_one(reader);
            reader.finish();
        }
    }

    /// A table inside this one, read by read_inside(reader) if it is there.
    template <class ReadInside>
    void table(const char* key, ReadInside read_inside) {
        const toml::node* node = get(key);
        if (!node) return;
        if (!node->is_table()) wrong(key, *node, "a table", fmt::format("write {} = {{ … }}", key));
        Reader reader(*node->as_table(), reading_, full(key));
        read_inside(reader);
        reader.finish();
    }

    /// The same; if the table is missing, as if it were empty.
    template <class ReadInside>
    void table_or_none(const char* key, ReadInside read_inside) {
        if (get(key)) return table(key, read_inside);
        const toml::table none;
        Reader reader(none, reading_, full(key));
        read_inside(reader);
        reader.finish();
    }

    bool has(const char* key) const { return table_.contains(key); }
    const toml::node* get(const char* key) {
        known_.insert(key);
        return table_.get(key);
    }

    /// The lines of the table and its keys, and of those of the tables in it.
    Lines lines() const {
        Lines lines{line_of(table_), {}};
        for (const auto& [key, node] : table_) {
            lines.keys[std::string(key.str())] = line_of(node);
            if (const toml::table* inside = node.as_table())
                for (const auto& [inner, value] : *inside)
                    lines.keys[std::string(key.str()) + "." + std::string(inner.str())] = line_of(value);
        }
        return lines;
    }

    /// The place of a value, for messages.
    std::string where(const toml::node& node) const {
        const int line = line_of(node);
        return line > 0 ? fmt::format("{}, line {}", reading_.source.file, line) : "--set";
    }
    [[noreturn]] void fail(const toml::node& node, const std::string& what, const std::string& remedy) const {
        throw Error(what, where(node), remedy);
    }
    /// About the table itself.
    [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
        const int line = line_of(table_);
        (line > 0 ? reading_.source : SceneSource{"--set"}).fail(line, path_ + ": " + what, remedy);
    }
    [[noreturn]] void wrong(std::string_view key, const toml::node& node, std::string_view wanted,
                            const std::string& remedy = "correct its value") const {
        fail(node, fmt::format("{} is {}, not {}", full(key), in_words(node), wanted), remedy);
    }

    void finish() {
        reading_.keys[path_].insert(known_.begin(), known_.end());
        for (const auto& [key, node] : table_) {
            const std::string name(key.str());
            if (known_.contains(name)) continue;
            fail(node, fmt::format("unknown key \"{}\" of {}", name, path_.empty() ? "a scene" : path_),
                 advice(name));
        }
    }

    // ---- one overload for each kind of value ----

    void read(std::string_view key, const toml::node& node, std::string& value) const {
        const auto text = node.value_exact<std::string>();
        if (!text) wrong(key, node, "a string", "write it in quotes");
        if (text->empty()) fail(node, full(key) + " is empty", "write something there, or remove it");
        value = *text;
    }
    void read(std::string_view key, const toml::node& node, bool& value) const {
        const auto truth = node.value_exact<bool>();
        if (!truth) wrong(key, node, "true or false", "write one of them, without quotes");
        value = *truth;
    }
    void read(std::string_view key, const toml::node& node, int& value) const {
        double number = 0;
        read_number(key, node, number, "a whole number");
        constexpr double least = std::numeric_limits<int>::min(), most = std::numeric_limits<int>::max();
        if (number != std::round(number)) wrong(key, node, "a whole number");
        if (number < least || number > most) wrong(key, node, "a whole number of a valid size");
        value = int(number);
    }
    void read(std::string_view key, const toml::node& node, double& value) const {
        read_number(key, node, value, "a number");
    }
    void read(std::string_view key, const toml::node& node, float& value) const {
        double wide = 0;
        read(key, node, wide);
        value = float(wide);
        if (!std::isfinite(value)) wrong(key, node, "a number of a valid size");
    }
    template <int L, class T>
    void read(std::string_view key, const toml::node& node, glm::vec<L, T>& value) const {
        const toml::array* array = node.as_array();
        const char* const wanted = L == 2 ? "two numbers in brackets" : "three numbers in brackets";
        if (!array || array->size() != L)
            wrong(key, node, wanted,
                  array && array->size() > L
                      ? "write them as [0.5, 1], with points in numbers and commas between them"
                      : fmt::format("write {}", L == 2 ? "[…, …]" : "[…, …, …]"));
        for (int i = 0; i < L; ++i) read(key, (*array)[std::size_t(i)], value[i]);
    }
    template <class T>
    void read(std::string_view key, const toml::node& node, std::vector<T>& value) const {
        const toml::array* array = node.as_array();
        if (!array) wrong(key, node, "a list", "write it in brackets");
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
            fail(node, fmt::format("{} is \"{}\", which is not one of its values", full(key), name),
                 "choose from " + all_names<E>());
        value = *known;
    }

 private:
    std::string full(std::string_view key) const {
        return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
    }

    void read_number(std::string_view key, const toml::node& node, double& value, const char* wanted) const {
        value = number_of(node);
        if (!std::isfinite(value)) wrong(key, node, wanted, how_to_write(node));
    }

    // The remedy for a value that is not a number, also for one in quotes or with a decimal comma.
    static std::string how_to_write(const toml::node& node) {
        const std::string given = node.value_exact<std::string>().value_or("");
        std::string text = given;
        std::replace(text.begin(), text.end(), ',', '.');
        double number = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        const bool is_number = !text.empty() && error == std::errc() && end == text.data() + text.size();
        return is_number ? fmt::format("write {}: with a point, and without quotes", with_point(given))
                         : "write a number";
    }

    // Checks a number, or each of several.
    void check(std::string_view key, const toml::node& node, const NumberRange& range) {
        const std::string unit = range.unit.empty() ? "" : " " + std::string(range.unit);
        auto look_at = [&](double value) {
            const std::string is = fmt::format("{} is {:.6g}{}", full(key), value, unit);
            if (!range.holds(value))
                fail(node, is + ", which is " + range.complaint(value),
                     range.example.empty() ? "correct its value" : std::string(range.example));
            if (range.is_usual(value)) return;
            const int line = line_of(node);
            reading_.notes.push_back(fmt::format("{}{}: is its unit right?{}{}", is,
                                                 line > 0 ? fmt::format(" (line {})", line) : "",
                                                 range.example.empty() ? "" : " ", range.example));
        };
        for_each_number(node, look_at);
    }
    static void for_each_number(const toml::node& node, const std::function<void(double)>& look_at) {
        if (const toml::array* array = node.as_array())
            for (const toml::node& one : *array) for_each_number(one, look_at);
        else
            look_at(number_of(node));
    }

    // Common names of our keys in other programs.
    static constexpr std::pair<std::string_view, const char*> other_words[] = {{"mesh", "surface"},
                                                                               {"file", "surface"},
                                                                               {"model", "surface"},
                                                                               {"scale", "size"},
                                                                               {"position", "move"},
                                                                               {"translate", "move"},
                                                                               {"translation", "move"},
                                                                               {"fixed", "pin"},
                                                                               {"E", "youngs_modulus"},
                                                                               {"young", "youngs_modulus"},
                                                                               {"material", "tissue"},
                                                                               {"nu", "poisson"},
                                                                               {"poisson_ratio", "poisson"},
                                                                               {"poissons_ratio", "poisson"},
                                                                               {"rho", "density"},
                                                                               {"k", "stiffness"},
                                                                               {"viscosity", "damping"},
                                                                               {"fov", "angle"},
                                                                               {"target", "look_at"},
                                                                               {"dt", "step"},
                                                                               {"g", "gravity"},
                                                                               {"end", "duration"},
                                                                               {"solver", "integrator"}};

    // The remedy for a key that this table does not have.
    std::string advice(const std::string& name) const {
        for (const auto& [word, key] : other_words)
            if (name == word && known_.contains(key)) return fmt::format("did you mean \"{}\"?", key);
        if (const std::string table = table_with(name); !table.empty())
            return fmt::format("did you mean {}.{}?", table, name);
        for (const auto& [path, keys] : reading_.keys)
            if (path.ends_with("." + name)) return fmt::format("did you mean {}?", path);
        auto holds = [](std::string_view a, std::string_view b) {
            return b.size() > 2 && a.find(b) != a.npos;
        };
        auto far = [&](const std::string& known) {
            return holds(known, name) || holds(name, known) ? 0 : edits(known, name);
        };
        const auto nearest = std::min_element(known_.begin(), known_.end(),
                                              [&](const auto& a, const auto& b) { return far(a) < far(b); });
        if (nearest != known_.end() && 2 * far(*nearest) <= int(std::max(nearest->size(), name.size())))
            return fmt::format("did you mean \"{}\"?", *nearest);
        std::string list;
        for (const std::string& known : known_) list += (list.empty() ? "" : ", ") + known;
        return "its keys are " + list;
    }

    // The path of the table to which a key belongs: one inside this one, or one that a scene has once; for a
    // key of the scene itself, any. The outermost of several; empty if there is none.
    std::string table_with(const std::string& name) const {
        std::string best;
        auto depth = [](const std::string& path) { return std::ranges::count(path, '.'); };
        for (const auto& [path, keys] : reading_.keys) {
            const bool near = path_.empty() || path.starts_with(path_ + ".") || depth(path) == 0;
            if (!near || path.empty() || path == path_ || !keys.contains(name)) continue;
            if (best.empty() || depth(path) < depth(best)) best = path;
        }
        return best;
    }

    const toml::table& table_;
    SceneReading& reading_;
    std::string path_;
    std::set<std::string> known_;
};

}  // namespace palpate
