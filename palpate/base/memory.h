#pragma once
#include <cstddef>

namespace palpate {

/// The most memory, in bytes, that this process has had at once so far, and as much again as the largest of
/// the processes that it started and that have ended.
std::size_t peak_memory();

}  // namespace palpate
