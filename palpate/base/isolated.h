#pragma once
#include <cstddef>
#include <cstdio>
#include <functional>
#include <span>
#include <string>

namespace palpate {

/// What a piece of work in a process of its own may use.
struct Allowance {
    double seconds = 20;                       // of the processor's time, however busy the machine is
    std::size_t bytes = std::size_t(1) << 30;  // of memory, beyond what this process has already
    std::size_t output = std::size_t(1)
                         << 30;  // bytes that it writes to its stream, which also lie in memory
    double idle = 30;            // s in a row in which it gets nothing done: it waits for what never comes
};

/// What isolated work wrote; unmapped again with the last of it.
class Written {
 public:
    Written(const char* bytes, std::size_t count) : bytes_(bytes), count_(count) {}
    ~Written();
    Written(Written&& other) noexcept : bytes_(other.bytes_), count_(other.count_) { other.count_ = 0; }
    Written& operator=(Written&&) = delete;

    std::span<const char> bytes() const { return {bytes_, count_}; }

 private:
    const char* bytes_;
    std::size_t count_;
};

/// Runs `work` in a process of its own, a copy of this one, and returns what it wrote to its stream. For
/// libraries that believe what a file claims: if one of them crashes, hangs or asks for memory without end,
/// only the copy ends. Then Error is thrown, "LIBRARY crashed on what is in FILE; ...", as is an Error that
/// `work` throws. The copy prints nothing, and dies with this process. `library` and `file` are for messages.
/// Other threads may go on, and may allocate; but the copy has none of them, so for a lock of their own that
/// one holds just then it would wait until that is noticed.
Written isolated(const std::string& library, const std::string& file, const Allowance& allowance,
                 const std::function<void(std::FILE*)>& work);

}  // namespace palpate
