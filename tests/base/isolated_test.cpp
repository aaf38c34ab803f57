#include "palpate/base/isolated.h"

#include "palpate/base/error.h"
#include "tests/refusal.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <thread>
#include <vector>

namespace palpate {
namespace {

std::string refusal(const Allowance& allowance, const std::function<void(std::FILE*)>& work) {
    return palpate::refusal([&] { isolated("the library", "a file", allowance, work); });
}

TEST(Isolated, HandsOnWhatWasWritten) {
    std::string text;
    for (unsigned i = 0; i < 300'007; ++i) text += char(i * i % 251);
    const Written written = isolated("the library", "a file", {},
                                     [&](std::FILE* out) { std::fwrite(text.data(), 1, text.size(), out); });
    EXPECT_EQ(std::string(written.bytes().begin(), written.bytes().end()), text);
    EXPECT_TRUE(isolated("the library", "a file", {}, [](std::FILE*) {}).bytes().empty());
}

TEST(Isolated, AnErrorComesThroughAsItIs) {
    const std::string said = refusal({}, [](std::FILE* out) {
        std::fputs("half of the work, longer than the complaint that follows it", out);
        throw Error("no faces", "x.ply", "export it again");
    });
    EXPECT_EQ(said, "no faces in x.ply; export it again");
}

TEST(Isolated, ACrashAHangAndGreedEndOnlyTheCopy) {
    EXPECT_EQ(refusal({}, [](std::FILE*) { std::raise(SIGKILL); }),
              "the library crashed on what is in a file; convert it with another program");
    EXPECT_EQ(refusal({.seconds = 0.1},
                      [](std::FILE*) {
                          volatile bool ends = false;
                          while (!ends) {}
                      }),
              "the library took more than 0.1 s for what is in a file; convert it with another program");
    EXPECT_EQ(refusal({.idle = 0.1},
                      [](std::FILE*) {
                          for (;;) pause();
                      }),
              "the library hung for 0.1 s on what is in a file; convert it with another program");
    EXPECT_EQ(refusal({.output = 1 << 20},
                      [](std::FILE* out) {
                          for (int i = 0; i < 3 << 20; ++i) std::fputc('x', out);
                      }),
              "the library makes more than 1 MB of what is in a file; convert it with another program");
    EXPECT_EQ(refusal({.output = 0}, [](std::FILE*) { throw Error("no faces", "x.ply", "export it again"); }),
              "no faces in x.ply; export it again");
#ifndef __SANITIZE_ADDRESS__
    EXPECT_EQ(refusal({.bytes = 64 << 20},
                      [](std::FILE* out) {
                          std::vector<std::vector<char>> all;
                          for (;;) std::fputc(all.emplace_back(1 << 20, 'x')[7], out);
                      }),
              "the library needs more than 64 MB for what is in a file; convert it with another program");
#endif
}

TEST(Isolated, WaitingForAnotherIsNoFault) {
    // What a machine with much else to do is like: long on the clock, and little of it the copy's.
    const Written written = isolated("the library", "a file", {.seconds = 0.2}, [](std::FILE* out) {
        for (int i = 0; i < 5; ++i) {
            usleep(100'000);
            for (volatile int work = 0; work < 1'000'000;) work = work + 1;
        }
        std::fputs("done", out);
    });
    EXPECT_EQ(std::string(written.bytes().begin(), written.bytes().end()), "done");
}

TEST(Isolated, OtherThreadsMayBeBusy) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "not available: the address sanitizer's own locks do not outlive a fork";
#endif
    std::vector<std::jthread> busy;
    for (int i = 0; i < 3; ++i)
        busy.emplace_back([](const std::stop_token& stop) {
            while (!stop.stop_requested()) delete[] new char[100'000];
        });
    for (int i = 0; i < 100; ++i) {
        const Written written = isolated("the library", "a file", {}, [](std::FILE* out) {
            std::fputs(std::string(100'000, 'x').c_str(), out);
        });
        EXPECT_EQ(written.bytes().size(), 100'000u);
    }
}

TEST(Isolated, LeavesNoProcessAndSharesNoState) {
    int touched = 0;
    isolated("the library", "a file", {}, [&](std::FILE*) { touched = 1; });
    EXPECT_EQ(touched, 0);
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
}

}  // namespace
}  // namespace palpate
