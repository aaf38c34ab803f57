#pragma once
#include "palpate/base/names.h"

#include <span>
#include <string>
#include <string_view>

namespace palpate {

/// The one of these words that another was perhaps meant to be; empty if none is as near as two letters.
inline std::string nearest(std::string_view word, std::span<const std::string> all) {
    std::string best;
    int changes = int(std::min<std::size_t>(word.size(), 3));  // so many make another word
    for (const std::string& one : all)
        if (const int some = edits(one, word); some < changes) {
            best = one;
            changes = some;
        }
    return best;
}

}  // namespace palpate
