#pragma once
// What tests of scenes share: a small one, and what is said of texts that are refused.
#include "palpate/scene/scene.h"
#include "tests/refusal.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

namespace palpate {

inline const std::string small = R"(
[[body]]
name = "cube"
dims = [4, 4, 4]
spacing = 0.01
youngs_modulus = 5000
density = 1000
)";

inline Scene parse(const std::string& text, const std::vector<Change>& changes = {}) {
    return parse_scene(text, "test.toml", ".", changes);
}

// The message that a text is refused with.
inline std::string refusal(const std::string& text, const std::vector<Change>& changes = {}) {
    return refusal([&] { parse(text, changes); });
}

inline void expect_words(const std::string& message, std::initializer_list<std::string> words) {
    for (const std::string& word : words)
        EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
}

}  // namespace palpate
