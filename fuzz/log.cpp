// Any text as a log of a device: an Error of one line, or ticks in chronological order.
#include "palpate/touch/log.h"

#include "palpate/base/error.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        const palpate::Log log = palpate::parse_log(text, "fuzz.csv");
        if (!(log.rate > 0)) std::abort();
        double last = -INFINITY;
        for (const palpate::Tick& tick : log.ticks) {
            if (!(tick.now >= last) || !std::isfinite(tick.state.time)) std::abort();
            last = tick.now;
        }
    } catch (const palpate::Error& error) {
        if (std::string_view(error.what()).find_first_of("\n\r") != std::string_view::npos) std::abort();
    }
    return 0;
}
