#pragma once
#include <functional>
#include <string_view>

namespace palpate {

/// Told how far a long piece of work has come: what is being done, and the fraction done from 0 to 1.
/// Called on the thread that works; an empty function is allowed and costs nothing.
using Progress = std::function<void(std::string_view doing, double fraction)>;

}  // namespace palpate
