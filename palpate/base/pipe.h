#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace palpate {

/// True if a program of this name is on the PATH.
bool has_program(const std::string& name);

/// The standard input of another program that runs beside ours. Its output goes nowhere; its complaints go to
/// our standard error. Move-free: make one where it is used.
class Pipe {
 public:
    /// Starts `words[0]` with the other words as its arguments; no shell is involved. Throws Error.
    explicit Pipe(std::vector<std::string> words);
    ~Pipe();
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;

    /// Throws Error if the program no longer listens.
    void write(const void* bytes, std::size_t count);

    /// Closes the pipe and waits for the program to end. Throws Error if it failed.
    void finish();

 private:
    void close_and_wait();
    std::string program_;
    int input_ = -1;
    int process_ = -1;
    int status_ = 0;
};

}  // namespace palpate
