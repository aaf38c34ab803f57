#pragma once
#include "palpate/files/formats/source.h"

#include <cstddef>

namespace palpate {

/// How many bytes may be made of a file of `size` bytes, by unpacking and by parts that are repeated. A small
/// file could fill the memory otherwise.
constexpr std::size_t warranted(std::size_t size) { return (std::size_t(256) << 20) + 64 * size; }

/// What is left of that. Whatever is made of a file is spent here, before it is made; what costs time alone
/// is spent as if it were bytes.
class Budget {
 public:
    explicit Budget(const Source& source) : source_(source), left_(warranted(source.whole().size())) {}

    std::size_t left() const { return left_; }

    /// Throws Error if there is less left.
    void spend(std::size_t count, std::size_t bytes_each = 1) {
        if (count > left_ / bytes_each)
            source_.broken("more than the file's size warrants, by parts that are repeated",
                           "export a part of it");
        left_ -= count * bytes_each;
    }

    /// For another file, of `size` bytes, that belongs to the one being read.
    void add_file(std::size_t size) { left_ += warranted(size) - warranted(0); }

 private:
    const Source& source_;
    std::size_t left_;
};

}  // namespace palpate
