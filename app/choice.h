#pragma once
#include "palpate/base/names.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>

/// The enumerator that an option names; nothing if the option was not given. An unknown name is wrong usage.
template <class E>
std::optional<E> chosen(const std::string& option, const std::string& name) {
    if (name.empty()) return std::nullopt;
    const auto value = palpate::value_of<E>(name);
    if (!value)
        throw CLI::ValidationError(
            option, fmt::format("\"{}\" is not one of {}; did you mean {}?", name, palpate::all_names<E>(),
                                palpate::nearest_name<E>(name)));
    return value;
}

/// Checks that an option is a finite number for which `holds` is true; CLI11's own checks accept NaN.
template <class Holds>
CLI::Validator number_that(const std::string& is, Holds holds) {
    return CLI::Validator(
        [=](std::string& text) {
            double value = 0;
            const bool read = CLI::detail::lexical_cast(text, value);
            return read && std::isfinite(value) && holds(value) ? std::string()
                                                                : fmt::format("{} is not {}", text, is);
        },
        "");
}
inline CLI::Validator above_zero() {
    return number_that("a number above 0", [](double value) { return value > 0; });
}
inline CLI::Validator zero_or_more() {
    return number_that("a number of 0 or more", [](double value) { return value >= 0; });
}
inline CLI::Validator from_to(double least, double most) {
    return number_that(fmt::format("a number from {} to {}", least, most),
                       [=](double value) { return value >= least && value <= most; });
}
