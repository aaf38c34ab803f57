#pragma once
#include <cstddef>

/// How often the calling thread has asked for memory so far, by any operator new. Its .cpp puts itself in the
/// place of those operators in the whole program.
std::size_t allocations();
