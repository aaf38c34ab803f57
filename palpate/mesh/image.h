#pragma once
#include <cstdint>
#include <vector>

namespace palpate {

/// An image: eight bits each of red, green, blue and alpha (sRGB), rows from the top down.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> pixels;  // 4 · width · height bytes

    bool empty() const { return pixels.empty(); }
};

}  // namespace palpate
