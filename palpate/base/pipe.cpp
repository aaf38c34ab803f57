#include "palpate/base/pipe.h"

#include "palpate/base/error.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

extern char** environ;

namespace palpate {

bool has_program(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (access((std::filesystem::path(folder) / name).c_str(), X_OK) == 0) return true;
    return false;
}

Pipe::Pipe(std::vector<std::string> words) : program_(words.at(0)) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);

    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw Error("cannot open a pipe", program_, std::strerror(errno));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    complaints_ = std::tmpfile();
    if (complaints_) posix_spawn_file_actions_adddup2(&actions, fileno(complaints_), STDERR_FILENO);
    int error = posix_spawnp(&process_, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[0]);
    input_ = ends[1];
    if (error != 0) {
        close(input_);
        if (complaints_) std::fclose(complaints_);
        throw Error("cannot start the program", program_, "install it, or do without what it writes");
    }
}

Pipe::~Pipe() {
    close_and_wait();
    if (complaints_) std::fclose(complaints_);
}

void Pipe::write(const void* bytes, std::size_t count) {
    // A program that ends early must not kill this one: SIGPIPE is blocked while writing, and then discarded.
    sigset_t broken, before;
    sigemptyset(&broken);
    sigaddset(&broken, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &broken, &before);
    const char* at = static_cast<const char*>(bytes);
    int error = 0;
    while (count > 0 && error == 0) {
        ssize_t n = ::write(input_, at, count);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            error = errno;
        } else {
            at += n;
            count -= static_cast<std::size_t>(n);
        }
    }
    if (error == EPIPE) {
        timespec at_once{};
        sigtimedwait(&broken, nullptr, &at_once);
    }
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    if (error == 0) return;
    close_and_wait();
    throw Error("the program stopped reading" + complaint(), program_,
                "see to that, or do without what it writes");
}

void Pipe::finish() {
    close_and_wait();
    if (status_ != 0)
        throw Error("the program failed" + complaint(), program_,
                    "see to that, or do without what it writes");
}

// The last line that the program wrote to its standard error, in brackets.
std::string Pipe::complaint() const {
    if (!complaints_) return {};
    std::rewind(complaints_);
    std::string last;
    char line[1024];
    while (std::fgets(line, sizeof line, complaints_))
        if (line[0] != '\n') last = line;
    while (!last.empty() && (last.back() == '\n' || last.back() == '\r')) last.pop_back();
    return last.empty() ? last : " (" + last + ")";
}

void Pipe::close_and_wait() {
    if (input_ >= 0) close(input_);
    input_ = -1;
    if (process_ > 0)
        while (waitpid(process_, &status_, 0) < 0 && errno == EINTR) {}
    process_ = -1;
}

}  // namespace palpate
