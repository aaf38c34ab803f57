#pragma once
// Runs the palpate command as its users do.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <initializer_list>
#include <string>

namespace palpate {

struct Outcome {
    int status;
    std::string said;  // both streams
};

inline Outcome shell(const std::string& command) {
    std::FILE* pipe = popen(("exec 2>&1; " + command).c_str(), "r");
    Outcome outcome{-1, {}};
    std::array<char, 4096> block;
    while (const std::size_t n = std::fread(block.data(), 1, block.size(), pipe))
        outcome.said.append(block.data(), n);
    const int ended = pclose(pipe);
    outcome.status = WIFEXITED(ended) ? WEXITSTATUS(ended) : 128 + WTERMSIG(ended);
    return outcome;
}

inline Outcome palpate(const std::string& arguments) {
    return shell(std::string(PALPATE_COMMAND) + " " + arguments);
}

// Failed with exactly one line, which says these words.
inline void expect_one_line(const Outcome& outcome, std::initializer_list<std::string> words) {
    EXPECT_EQ(outcome.status, 1) << outcome.said;
    EXPECT_TRUE(outcome.said.starts_with("palpate: error: ")) << outcome.said;
    EXPECT_EQ(std::count(outcome.said.begin(), outcome.said.end(), '\n'), 1) << outcome.said;
    for (const std::string& word : words)
        EXPECT_NE(outcome.said.find(word), std::string::npos) << outcome.said;
}

}  // namespace palpate
