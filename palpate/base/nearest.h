#pragma once
#include "palpate/base/names.h"

#include <span>
#include <string>
#include <string_view>

namespace palpate {

/// The one of these words that is most like another, by edit distance: what was perhaps meant. Empty if all
/// differ by more than two letters.
inline std::string nearest(std::string_view word, std::span<const std::string> all) {
    std::string best;
    int changes = int(std::min<std::size_t>(word.size(), 3));  // with so many it is another word
    for (const std::string& one : all)
        if (const int some = edits(one, word); some < changes) {
            best = one;
            changes = some;
        }
    return best;
}

}  // namespace palpate
