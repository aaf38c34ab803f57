#pragma once
#include <bit>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace palpate {

constexpr std::string_view base64_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

static_assert(std::endian::native == std::endian::little, "files are written as numbers lie in memory");

/// Appends the bytes of a plain value, little-endian, to a file's contents.
template <class T>
void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
void append_all(std::string& bytes, std::span<const T> values) {
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

}  // namespace palpate
