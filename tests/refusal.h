#pragma once
// What tests ask of what must be refused.
#include "palpate/base/error.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace palpate {

/// What the Error says, in one line; empty if none was thrown.
inline std::string refusal(const std::function<void()>& act) {
    try {
        act();
    } catch (const Error& error) {
        const std::string said = error.what();
        EXPECT_EQ(said.find('\n'), said.npos) << said;
        return said;
    }
    return {};
}

/// An Error is thrown that says this word.
inline void expect_refused(const std::string& word, const std::function<void()>& act) {
    const std::string said = refusal(act);
    if (said.empty())
        ADD_FAILURE() << word << ": it was taken";
    else
        EXPECT_NE(said.find(word), said.npos) << word << ": " << said;
}

}  // namespace palpate
