#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace palpate {

/// An enumeration's value and what people call it in scenes and on the command line. Each enumeration E has
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

}  // namespace palpate
