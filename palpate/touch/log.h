#pragma once
#include "palpate/touch/device.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// What a device said at one tick of the loop, and what it was told then.
struct Tick {
    double now = 0;  // s, on the loop's clock
    DeviceState state;
    Wrench wrench;
};

/// What went to and fro between a loop and a device; docs/devices.md describes the file.
struct Log {
    std::string device = "a device";
    double rate = 1000;       // Hz, that the loop was to have
    std::vector<Tick> ticks;  // in the order of time
};

/// Writes it whole or not at all, with as many digits as read back to the bit. Throws Error.
void write_log(const std::filesystem::path& file, const Log& log);

/// Throws Error with the line's number where something does not fit.
Log read_log(const std::filesystem::path& file);

/// The same from a text; `name` is used in messages.
Log parse_log(std::string_view text, const std::string& name);

}  // namespace palpate
