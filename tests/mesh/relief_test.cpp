#include "palpate/mesh/relief.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace palpate {
namespace {

vec3 normal_at(const Image& image, int x, int y) {
    const std::uint8_t* p = &image.pixels[4 * std::size_t(y * image.width + x)];
    EXPECT_EQ(p[3], 255);
    return vec3(p[0], p[1], p[2]) / 127.5f - 1.0f;
}

// Waves of whole numbers of periods, along both axes: central differences of a sine are its slope times
// sin(k)/k.
TEST(Relief, OfWavesIsAsItsSlopes) {
    const int width = 30, height = 21;
    const double pi = std::numbers::pi, kx = 2 * pi * 2 / width, ky = 2 * pi * 3 / height;
    std::vector<float> heights;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) heights.push_back(float(2 * std::sin(kx * x) + std::cos(ky * y)));
    const Image image = normal_map(heights, width);
    ASSERT_EQ(image.width, width);
    ASSERT_EQ(image.height, height);
    ASSERT_EQ(image.pixels.size(), 4u * width * height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double along_u = 2 * std::cos(kx * x) * std::sin(kx),
                         down = -std::sin(ky * y) * std::sin(ky);
            const vec3 exact = glm::normalize(vec3(-along_u, down, 1));  // v runs up
            EXPECT_LE(glm::distance(normal_at(image, x, y), exact), 0.01f) << x << ' ' << y;
        }
}

TEST(Relief, AWeaveRepeatsEveryTwoThreadsAndLiesFlat) {
    const Image image = weave({6, 4});
    ASSERT_EQ(image.width, 96);
    ASSERT_EQ(image.height, 64);
    dvec3 sum(0);
    float steepest = 1;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const vec3 n = normal_at(image, x, y);
            EXPECT_LE(std::abs(glm::length(n) - 1), 0.01f);
            EXPECT_LE(glm::distance(n, normal_at(image, (x + 32) % 96, y)), 0.01f);
            EXPECT_LE(glm::distance(n, normal_at(image, x, (y + 32) % 64)), 0.01f);
            // The next thread lies under where this one lies over, and the other way on.
            EXPECT_LE(glm::distance(n, normal_at(image, (x + 16) % 96, (y + 16) % 64)), 0.01f);
            steepest = std::min(steepest, n.z);
            sum += dvec3(n);
        }
    sum /= double(image.width * image.height);
    EXPECT_LE(std::abs(sum.x) + std::abs(sum.y), 0.02);
    EXPECT_LE(steepest, 0.9f);
    EXPECT_GE(steepest, 0.3f);
    // Over and under: the two threads at a crossing do not look alike.
    EXPECT_GE(glm::distance(normal_at(image, 4, 8), normal_at(image, 20, 8)), 0.1f);
}

}  // namespace
}  // namespace palpate
