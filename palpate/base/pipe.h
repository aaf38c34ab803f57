#pragma once
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

namespace palpate {

/// True if a program of this name is on the PATH.
bool has_program(const std::string& name);

/// A pipe into the standard input of another program, which runs beside ours. Its output is discarded; if it
/// fails, the Error quotes the last line of its standard error.
class Pipe {
 public:
    /// Starts `words[0]` with the other words as its arguments; no shell is involved. Throws Error.
    explicit Pipe(std::vector<std::string> words);
    ~Pipe();
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;

    /// Throws Error if the program has stopped reading.
    void write(const void* bytes, std::size_t count);

    /// Closes the pipe and waits for the program to end. Throws Error if it failed.
    void finish();

 private:
    void close_and_wait();
    std::string complaint() const;
    std::string program_;
    std::FILE* complaints_ = nullptr;  // the program's standard error
    int input_ = -1;
    int process_ = -1;
    int status_ = 0;
};

}  // namespace palpate
