#include "palpate/mesh/relief.h"

#include "palpate/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

// The height of a weave, in widths of a thread, at a place counted in threads. Each thread is half round; it
// rises where it lies above the other, and sinks where it lies below.
float woven(vec2 p) {
    const ivec2 thread(glm::floor(p));
    const vec2 round = glm::cos(pi * (p - vec2(thread) - 0.5f));  // 1 in the middle, 0 at the edge
    const float upright_above = (thread.x + thread.y) % 2 == 0 ? 1.0f : -1.0f;
    const float way = 0.5f * upright_above;
    const float upright = round.x + way * round.y, level = round.y - way * round.x;
    return 0.2f * std::max(upright, level);
}

}  // namespace

Image normal_map(std::span<const float> heights, int width) {
    if (width < 1 || heights.empty() || heights.size() % std::size_t(width) != 0)
        throw Error(fmt::format("{} heights in rows of {}", heights.size(), width), "the normal map",
                    "give it whole rows");
    const int height = int(heights.size()) / width;
    Image image{width, height, {}};
    image.pixels.reserve(4 * heights.size());
    auto at = [&](int x, int y) {
        return heights[std::size_t((y + height) % height) * width + std::size_t((x + width) % width)];
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float along_u = 0.5f * (at(x + 1, y) - at(x - 1, y)),
                        along_v = 0.5f * (at(x, y - 1) - at(x, y + 1));
            const vec3 normal = glm::normalize(vec3(-along_u, -along_v, 1));
            for (int k = 0; k < 3; ++k)
                image.pixels.push_back(std::uint8_t(std::lround(127.5f * (normal[k] + 1))));
            image.pixels.push_back(255);
        }
    return image;
}

Image weave(ivec2 threads) {
    constexpr int pixels = 16;  // a thread
    if (std::min(threads.x, threads.y) < 1 || std::max(threads.x, threads.y) > 1024)
        throw Error(fmt::format("{} x {} threads", threads.x, threads.y), "the weave",
                    "use 1 to 1,024 each way");
    std::vector<float> heights;
    const ivec2 size = pixels * threads;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            heights.push_back(pixels * woven((vec2(x, y) + 0.5f) / float(pixels)));
    return normal_map(heights, size.x);
}

}  // namespace palpate
