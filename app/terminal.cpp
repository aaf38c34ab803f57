#include "app/terminal.h"

#include "palpate/base/clock.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

palpate::Progress terminal_progress() {
    if (!isatty(STDERR_FILENO)) return {};
    return [last = 0.0](std::string_view doing, double fraction) mutable {
        if (palpate::now() - last < 0.1 && fraction < 1) return;
        last = palpate::now();
        fmt::print(stderr, "\r\033[K{:3.0f} %  {}", 100 * fraction, doing);
        std::fflush(stderr);
    };
}

void end_progress() {
    if (isatty(STDERR_FILENO)) fmt::print(stderr, "\r\033[K");
}

void print_table(const std::vector<std::pair<std::string, std::string>>& rows) {
    std::size_t widest = 0;
    for (const auto& [name, value] : rows) widest = std::max(widest, name.size());
    for (const auto& [name, value] : rows) fmt::print("  {:<{}}  {}\n", name, widest, value);
}

std::string grouped(long long number) {
    std::string digits = std::to_string(number);
    for (int at = int(digits.size()) - 3; at > (number < 0); at -= 3) digits.insert(std::size_t(at), 1, ',');
    return digits;
}
