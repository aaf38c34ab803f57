#pragma once
#include <cstddef>
#include <cstdio>
#include <functional>
#include <span>
#include <string>

namespace palpate {

/// The limits on work in a process of its own.
struct Allowance {
    double seconds = 20;                       // of the processor's time, however busy the machine is
    std::size_t bytes = std::size_t(1) << 30;  // of memory, beyond what this process has already
    std::size_t output = std::size_t(1)
                         << 30;  // bytes that it writes to its stream, which are in memory, too
    double idle = 30;            // s without progress, in a row: it hangs
};

/// What isolated work wrote. It unmaps the memory at its end.
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

/// Runs `work` in a process of its own, a fork of this one (a sandbox), and returns what it wrote to its
/// stream. For libraries that trust what a file claims: if one of them crashes, hangs or allocates without
/// end, only the copy ends. Then this throws an Error, "LIBRARY crashed on what is in FILE; ...". It also
/// throws any Error that `work` throws. The copy prints nothing, and dies with this process. `library` and
/// `file` are for messages. Other threads may continue and may allocate. But the copy has none of them: if
/// one of them holds another lock at the fork, `work` waits for it until that is noticed as a hang.
Written isolated(const std::string& library, const std::string& file, const Allowance& allowance,
                 const std::function<void(std::FILE*)>& work);

}  // namespace palpate
