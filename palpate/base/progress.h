#pragma once
#include <functional>
#include <string_view>

namespace palpate {

/// A callback for the progress of long work: what is being done, and which fraction of it is done, 0 to 1. It
/// is called on the working thread; an empty function is allowed and costs nothing.
using Progress = std::function<void(std::string_view doing, double fraction)>;

}  // namespace palpate
