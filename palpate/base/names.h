#pragma once
#include <algorithm>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// A value of an enumeration, with its name in scenes and on the command line. Each enumeration E has
/// `std::span<const Named<E>> names(E)`, found by argument-dependent lookup; its argument only picks the
/// overload.
template <class E>
struct Named {
    E value;
    std::string_view name;
};

template <class E>
std::string_view name_of(E value) {
    for (const auto& n : names(E{}))
        if (n.value == value) return n.name;
    return "?";
}

template <class E>
std::optional<E> value_of(std::string_view name) {
    for (const auto& n : names(E{}))
        if (n.name == name) return n.value;
    return std::nullopt;
}

/// All names, for a message: "a, b, c".
template <class E>
std::string all_names() {
    std::string list;
    for (const auto& n : names(E{})) list += (list.empty() ? "" : ", ") + std::string(n.name);
    return list;
}

/// The edit distance (Levenshtein): how many letters must be changed, added or removed to turn one word into
/// the other.
inline int edits(std::string_view a, std::string_view b) {
    std::vector<int> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        int corner = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const int kept = corner + (a[i] != b[j]);
            corner = row[j + 1];
            row[j + 1] = std::min({kept, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

/// The name that is most like a word: what was perhaps meant.
template <class E>
std::string_view nearest_name(std::string_view word) {
    const auto all = names(E{});
    return std::min_element(
               all.begin(), all.end(),
               [&](const auto& a, const auto& b) { return edits(a.name, word) < edits(b.name, word); })
        ->name;
}

}  // namespace palpate
