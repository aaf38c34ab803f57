#pragma once
#include "palpate/files/formats/source.h"

#include <cstddef>

namespace palpate {

/// How many bytes a file of `size` bytes may expand to, by decompression and by repeated parts. Otherwise a
/// small file could fill the memory (a decompression bomb).
constexpr std::size_t warranted(std::size_t size) { return (std::size_t(256) << 20) + 64 * size; }

/// The remaining budget. Every allocation is charged here before it is made; work that costs only time is
/// charged as if it were bytes.
class Budget {
 public:
    explicit Budget(const Source& source) : source_(source), left_(warranted(source.whole().size())) {}

    std::size_t left() const { return left_; }

    /// Throws Error if too little is left.
    void spend(std::size_t count, std::size_t bytes_each = 1) {
        if (count > left_ / bytes_each)
            source_.broken("more than the file's size warrants, by parts that are repeated",
                           "export a part of it");
        left_ -= count * bytes_each;
    }

    /// Adds the budget of another file, of `size` bytes, that belongs to the one being read.
    void add_file(std::size_t size) { left_ += warranted(size) - warranted(0); }

 private:
    const Source& source_;
    std::size_t left_;
};

}  // namespace palpate
