// What is done before a process ends, however it ends: seen in a copy of this one.
#include "palpate/base/halt.h"

#include "tests/copy_of_process.h"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <thread>

namespace palpate {
namespace {

// What copies of this process write down for it.
struct Notes {
    std::atomic<int> ended = 0, paused = 0, own = 0, ready = 0, after = 0;
};
Notes* notes = nullptr;

void note(Halt halt) noexcept { ++(halt == Halt::ended ? notes->ended : notes->paused); }

class OnHalt : public testing::Test {
 protected:
    void SetUp() override { notes = &*notes_; }

    // The status of a copy that lives so.
    static int status_of(const std::function<void()>& life) { return wait_for(start_copy(life)); }

    WithCopies<Notes> notes_;
};

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool sanitized = true;  // whose own handlers end a process another way
#else
constexpr bool sanitized = false;
#endif

// Not null: a sanitizer would end the process before the store that is meant to crash.
volatile int* nowhere = reinterpret_cast<volatile int*>(4096);

int deeper(int n) {
    volatile char room[4096] = {};
    return n > 0 ? deeper(n + 1) + room[n % 4096] : 0;
}

TEST_F(OnHalt, IsCalledOnceHoweverTheProcessEnds) {
    struct Case {
        const char* name;
        std::function<void()> end;
        int signal;  // 0: it exits
    };
    const Case cases[] = {
        {"told to end", [] { raise(SIGTERM); }, SIGTERM},
        {"Ctrl+C", [] { raise(SIGINT); }, SIGINT},
        {"the terminal is closed", [] { raise(SIGHUP); }, SIGHUP},
        {"too much time at real-time priority", [] { raise(SIGXCPU); }, SIGXCPU},
        {"a broken pipe", [] { raise(SIGPIPE); }, SIGPIPE},
        {"a wild pointer", [] { *nowhere = 1; }, SIGSEGV},
        {"a stack without end", [] { notes->after += deeper(1); }, SIGSEGV},
        {"abort", [] { std::abort(); }, SIGABRT},
        {"nobody catches it", [] { std::thread([] { throw std::runtime_error("so"); }).join(); }, SIGABRT},
        {"on another thread", [] { std::thread([] { *nowhere = 1; }).join(); }, SIGSEGV},
        {"exit", [] { std::exit(0); }, 0},
        {"quick_exit", [] { std::quick_exit(0); }, 0},
    };
    for (const Case& one : cases) {
        notes->ended = 0;
        const int status = status_of([&] {
            on_halt(note);
            on_halt(note);
            one.end();
        });
        EXPECT_EQ(notes->ended, 1) << one.name;
        if (sanitized) continue;
        EXPECT_EQ(WIFSIGNALED(status) ? WTERMSIG(status) : 0, one.signal) << one.name;
    }
}

// A second signal on the same thread, as when a terminal closes while a service is told to end.
TEST_F(OnHalt, ASecondSignalWaitsForWhatTheFirstBegan) {
    const int status = status_of([] {
        on_halt([](Halt) noexcept {
            raise(SIGHUP);
            ++notes->ended;
        });
        raise(SIGTERM);
    });
    EXPECT_EQ(notes->ended, 1);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM);
}

TEST_F(OnHalt, HandlersOfTheApplicationAreCalledAsBefore) {
    const int status = status_of([] {
        struct sigaction own {};
        own.sa_handler = [](int) { ++notes->own; };
        sigaction(SIGINT, &own, nullptr);
        own.sa_flags = int(SA_RESETHAND);
        sigaction(SIGTERM, &own, nullptr);
        std::signal(SIGHUP, SIG_IGN);
        on_halt(note);
        raise(SIGHUP);
        notes->after = notes->ended.load();
        raise(SIGINT);
        raise(SIGINT);
        raise(SIGTERM);  // handled once
        raise(SIGTERM);
    });
    EXPECT_EQ(notes->after, 0);  // what was ignored still is
    EXPECT_EQ(notes->own, 3);
    EXPECT_EQ(notes->ended, 4);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM);
}

TEST_F(OnHalt, IsCalledBeforeAPauseToo) {
    const pid_t copy = start_copy([] {
        setpgid(0, 0);
        on_halt(note);
        notes->ready = 1;
        raise(SIGTSTP);
        notes->after = notes->paused.load();
        raise(SIGTSTP);
    });
    wait_until([] { return notes->ready == 1; });
    for (int pause = 1; pause <= 2; ++pause) {
        const int paused = wait_for(copy, WUNTRACED);
        ASSERT_TRUE(WIFSTOPPED(paused));
        EXPECT_EQ(notes->paused, pause);
        kill(copy, SIGCONT);
    }
    const int status = wait_for(copy);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == lived);
    EXPECT_EQ(notes->after, 1);
    EXPECT_EQ(notes->ended, 0);  // it went by _exit()
}

TEST_F(OnHalt, ACopyOfTheProcessIsNotMeant) {
    status_of([] {
        on_halt(note);
        const pid_t copy = fork();
        if (copy == 0) raise(SIGTERM);
        const int status = wait_for(copy);
        notes->after = notes->ended.load();
        notes->own = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
        raise(SIGTERM);
    });
    EXPECT_EQ(notes->after, 0);
    EXPECT_EQ(notes->own, SIGTERM);
    EXPECT_EQ(notes->ended, 1);
}

TEST_F(OnHalt, AnActThatCrashesEndsTheProcessAllTheSame) {
    const int status = status_of([] {
        on_halt([](Halt) noexcept { *nowhere = 1; });
        raise(SIGTERM);
    });
    EXPECT_TRUE(WIFSIGNALED(status) || sanitized);
}

}  // namespace
}  // namespace palpate
