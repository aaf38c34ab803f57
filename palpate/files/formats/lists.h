#pragma once
#include <cstdio>
#include <cstring>
#include <span>
#include <vector>

namespace palpate {

// Serialises lists of plain values for isolated work (isolated.h): the count, and then the values.

template <class T>
void put(std::FILE* to, const std::vector<T>& list) {
    const std::size_t count = list.size();
    std::fwrite(&count, sizeof count, 1, to);
    if (count > 0) std::fwrite(list.data(), sizeof(T), count, to);
}

/// False if the bytes end before the list does.
template <class T>
bool take(std::span<const char>& from, std::vector<T>& list) {
    std::size_t count;
    if (from.size() < sizeof count) return false;
    std::memcpy(&count, from.data(), sizeof count);
    from = from.subspan(sizeof count);
    if (count > from.size() / sizeof(T)) return false;
    list.resize(count);
    if (count > 0) std::memcpy(list.data(), from.data(), count * sizeof(T));
    from = from.subspan(count * sizeof(T));
    return true;
}

}  // namespace palpate
