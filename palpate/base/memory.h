#pragma once
#include <cstddef>

namespace palpate {

/// The peak memory of this process so far, in bytes, plus that of the largest of its child processes that
/// have ended.
std::size_t peak_memory();

}  // namespace palpate
