#pragma once
#include "palpate/base/names.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

/// The value of an option that names one of an enumeration; nothing if it was not given. A name that is none
/// is wrong usage.
template <class E>
std::optional<E> chosen(const std::string& option, const std::string& name) {
    if (name.empty()) return std::nullopt;
    const auto value = palpate::value_of<E>(name);
    if (!value) throw CLI::ValidationError(option, "choose from " + palpate::all_names<E>());
    return value;
}
