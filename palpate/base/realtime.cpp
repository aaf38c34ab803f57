#include "palpate/base/realtime.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <ctime>

namespace palpate {
namespace {

// Below the kernel's own most urgent threads, above ordinary programs.
constexpr int wanted_priority = 80;
constexpr int wanted_niceness = -20;

bool become_fifo(int priority) {
    const sched_param wanted{priority};
    return priority > 0 && pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted) == 0;
}

// What an unprivileged process may get, too.
int allowed(decltype(RLIMIT_RTPRIO) which) {
    rlimit limit{};
    if (getrlimit(which, &limit) != 0) return 0;
    return int(std::min<rlim_t>(limit.rlim_cur, 1000));
}

std::string schedule(bool first) {
    for (int highest : {wanted_priority, std::min(allowed(RLIMIT_RTPRIO), wanted_priority)}) {
        const int priority = first ? highest : highest - 1;
        if (become_fifo(priority)) return fmt::format("FIFO {}", priority);
    }
    const auto thread = id_t(syscall(SYS_gettid));
    for (int nice : {wanted_niceness, 20 - allowed(RLIMIT_NICE)})
        if (nice < 0 && setpriority(PRIO_PROCESS, thread, nice) == 0) return fmt::format("nice {}", nice);
    return "as any other thread";
}

bool lock_memory() {
    rlimit limit{};
    const bool unlimited = getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
    return (unlimited || geteuid() == 0) && mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
}

}  // namespace

Granted keep_time(bool first) {
    constexpr unsigned long nanoseconds = 1;
    Granted granted;
    granted.wakes_exactly = prctl(PR_SET_TIMERSLACK, nanoseconds) == 0;
    granted.schedule = schedule(first);
    granted.memory_locked = lock_memory();
    return granted;
}

std::string kernel() {
    utsname name{};
    if (uname(&name) != 0) return "an unnamed kernel";
    return fmt::format("{} {} {}", name.sysname, name.release, name.version);
}

double thread_seconds() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

void sleep_until(double time) {
    const double whole = std::floor(time);
    const timespec until{time_t(whole), long(1e9 * (time - whole))};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {}
}

}  // namespace palpate
