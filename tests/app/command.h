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
    std::string output;  // of both streams
};

inline Outcome shell(const std::string& command) {
    std::FILE* pipe = popen(("exec 2>&1; " + command).c_str(), "r");
    Outcome outcome{-1, {}};
    std::array<char, 4096> block;
    while (const std::size_t n = std::fread(block.data(), 1, block.size(), pipe))
        outcome.output.append(block.data(), n);
    const int ended = pclose(pipe);
    outcome.status = WIFEXITED(ended) ? WEXITSTATUS(ended) : 128 + WTERMSIG(ended);
    return outcome;
}

inline Outcome palpate(const std::string& arguments) {
    return shell(std::string(PALPATE_COMMAND) + " " + arguments);
}

// Failed with exactly one line, which contains these words.
inline void expect_one_line(const Outcome& outcome, std::initializer_list<std::string> words) {
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_TRUE(outcome.output.starts_with("palpate: error: ")) << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    for (const std::string& word : words)
        EXPECT_NE(outcome.output.find(word), std::string::npos) << outcome.output;
}

}  // namespace palpate
