#include "palpate/base/isolated.h"

#include "palpate/base/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <memory>
#include <new>

namespace palpate {
namespace {

// The exit statuses of the copy; any other is a crash.
constexpr int done = 0, failed = 43, out_of_memory = 44;

// Bytes for an error message, however little output is allowed.
constexpr std::size_t complaint = 1 << 16;

[[noreturn]] void cannot(const std::string& what, const std::string& file) {
    throw Error("cannot " + what + " (" + std::strerror(errno) + ")", file, "free some memory and try again");
}

// A descriptor that closes itself.
struct Descriptor {
    int number;
    explicit Descriptor(int n) : number(n) {}
    ~Descriptor() { close(); }
    Descriptor(const Descriptor&) = delete;
    void close() {
        if (number >= 0) ::close(number);
        number = -1;
    }
};

void limit(int resource, rlim_t value) {
    const rlimit both{value, value};
    setrlimit(__rlimit_resource_t(resource), &both);
}

// The address sanitizer maps terabytes for itself, so a limit on memory would be meaningless.
void limit_memory([[maybe_unused]] std::size_t bytes) {
#ifndef __SANITIZE_ADDRESS__
    long pages = 0;
    if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
        if (std::fscanf(file, "%ld", &pages) != 1) pages = 0;
        std::fclose(file);
    }
    if (pages > 0) limit(RLIMIT_AS, rlim_t(pages) * rlim_t(sysconf(_SC_PAGESIZE)) + bytes);
#endif
}

void keep_quiet() {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
}

// All that the copy does.
[[noreturn]] void live(int output, const Allowance& allowance, const std::function<void(std::FILE*)>& work) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (int signal : {SIGINT, SIGTERM, SIGHUP, SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGXFSZ})
        std::signal(signal, SIG_DFL);
    keep_quiet();
    limit(RLIMIT_CORE, 0);
    limit_memory(allowance.bytes);
    limit(RLIMIT_FSIZE, allowance.output + complaint);
    std::FILE* stream = fdopen(output, "wb");
    int status = failed;
    try {
        if (!stream) throw std::bad_alloc();
        work(stream);
        status = std::fflush(stream) == 0 ? done : out_of_memory;
    } catch (const std::bad_alloc&) {
        status = out_of_memory;
    } catch (const std::exception& error) {  // the error message replaces what it wrote until then
        std::fflush(stream);
        if (ftruncate(output, 0) == 0 && lseek(output, 0, SEEK_SET) == 0) std::fputs(error.what(), stream);
        std::fflush(stream);
    }
    _exit(status);  // so that destructors and exit handlers run in the parent only
}

// The processor time that another process has used, s.
double seconds_of(pid_t process) {
    clockid_t clock;
    timespec time{};
    if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &time) != 0) return 0;
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

// Why waiting for the copy was given up.
enum class Late { no, busy, idle };

// Waits until the copy closes its end of the pipe by ending. Only its own processor time counts: the file is
// not to blame if this process was paused as well, or if the machine was busy.
Late wait_for(pid_t copy, int watched, const Allowance& allowance) {
    constexpr double look = 0.02;  // s, between two looks at it
    double idle = 0, before = 0;
    for (;;) {
        pollfd waiting{watched, 0, 0};
        const int found = poll(&waiting, 1, int(1000 * look));
        if (found > 0) return Late::no;
        if (found < 0) continue;  // a signal
        const double spent = seconds_of(copy);
        if (spent >= allowance.seconds) return Late::busy;
        idle = spent > before ? 0 : idle + look;
        before = spent;
        if (idle >= allowance.idle) return Late::idle;
    }
}

Written mapped(int descriptor, const std::string& file) {
    const off_t size = lseek(descriptor, 0, SEEK_END);
    if (size <= 0) return {nullptr, 0};
    void* bytes = mmap(nullptr, std::size_t(size), PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (bytes == MAP_FAILED) cannot("map memory", file);
    return {static_cast<const char*>(bytes), std::size_t(size)};
}

}  // namespace

Written::~Written() {
    if (count_ > 0) munmap(const_cast<char*>(bytes_), count_);
}

Written isolated(const std::string& library, const std::string& file, const Allowance& allowance,
                 const std::function<void(std::FILE*)>& work) {
    Descriptor output(memfd_create("palpate", MFD_CLOEXEC));
    int ends[2];
    if (output.number < 0 || pipe2(ends, O_CLOEXEC) != 0) cannot("start a process", file);
    Descriptor watched(ends[0]), held(ends[1]);
    std::fflush(nullptr);
    const pid_t copy = fork();
    if (copy < 0) cannot("start a process", file);
    if (copy == 0) live(output.number, allowance, work);
    held.close();

    const Late late = wait_for(copy, watched.number, allowance);
    if (late != Late::no) kill(copy, SIGKILL);
    int status = 0;
    while (waitpid(copy, &status, 0) < 0 && errno == EINTR) {}

    const std::string remedy = "convert it with another program";
    if (late == Late::busy)
        throw Error(fmt::format("{} took more than {:.3g} s for what is", library, allowance.seconds), file,
                    remedy);
    if (late == Late::idle)
        throw Error(fmt::format("{} hung for {:.3g} s on what is", library, allowance.idle), file, remedy);
    const int how = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    if (how == out_of_memory)
        throw Error(fmt::format("{} needs more than {} MB for what is", library, allowance.bytes >> 20), file,
                    remedy);
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXFSZ)
        throw Error(fmt::format("{} makes more than {} MB of what is", library, allowance.output >> 20), file,
                    remedy);
    if (how != done && how != failed) throw Error(library + " crashed on what is", file, remedy);
    Written written = mapped(output.number, file);
    if (how == failed) throw Error(std::string(written.bytes().begin(), written.bytes().end()));
    return written;
}

}  // namespace palpate
