#pragma once
#include "palpate/touch/device.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// One tick of the loop: what was read from the device, and what was written to it.
struct Tick {
    double now = 0;  // s, on the loop's clock
    DeviceState state;
    Wrench wrench;
};

/// A record of the traffic between a loop and a device; docs/devices.md describes the file.
struct Log {
    std::string device = "a device";
    double rate = 1000;       // Hz, the loop's nominal rate
    std::vector<Tick> ticks;  // in order of time
};

/// Writes it atomically, with enough digits to read back the same bits. Throws Error.
void write_log(const std::filesystem::path& file, const Log& log);

/// Throws an Error with the line number if the file is not valid.
Log read_log(const std::filesystem::path& file);

/// The same from a text; `name` is for messages.
Log parse_log(std::string_view text, const std::string& name);

}  // namespace palpate
