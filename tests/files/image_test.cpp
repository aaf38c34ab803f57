#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/files/image_file.h"
#include "tests/files/reading.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#include <zlib.h>

namespace palpate {
namespace {

Image colourful(int width, int height) {
    Image image{width, height, std::vector<std::uint8_t>(4u * width * height)};
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = static_cast<std::uint8_t>(i * 37 + i / 256);
    return image;
}

Image read(const std::filesystem::path& path) {
    Image image;
    std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load(path.c_str(), &image.width, &image.height, nullptr, 4), stbi_image_free);
    if (pixels) image.pixels.assign(pixels.get(), pixels.get() + 4u * image.width * image.height);
    return image;
}

TEST(Image, APngReadsBackTheSame) {
    Scratch folder;
    for (auto [width, height] : {std::pair(1, 1), std::pair(3, 2), std::pair(640, 7)}) {
        const Image image = colourful(width, height);
        write_png(image, folder / "picture.png");
        const Image back = read(folder / "picture.png");
        EXPECT_EQ(back.width, width);
        EXPECT_EQ(back.height, height);
        EXPECT_EQ(back.pixels, image.pixels);
        const Image ours = read_image(folder / "picture.png");
        EXPECT_EQ(ours.width, width);
        EXPECT_EQ(ours.height, height);
        EXPECT_EQ(ours.pixels, image.pixels);
    }
    EXPECT_EQ(folder.entries(), 1u);
}

// The bytes of a smooth picture in grey, of one channel or three.
std::string jpeg(int width, int height, int channels) {
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c)
                pixels.push_back(std::uint8_t(128 + 100 * std::sin(0.1 * x) * std::cos(0.1 * y)));
    std::string bytes;
    auto append = [](void* to, void* data, int count) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(data), std::size_t(count));
    };
    EXPECT_TRUE(stbi_write_jpg_to_func(append, &bytes, width, height, channels, pixels.data(), 95));
    return bytes;
}

std::string refusal(const std::string& bytes) {
    return palpate::refusal("a picture", [&] { parse_image(bytes, "a picture"); });
}

TEST(Image, AJpegIsRead) {
    for (int channels : {1, 3}) {
        const Image image = parse_image(jpeg(61, 43, channels), "a picture");
        ASSERT_EQ(image.width, 61);
        ASSERT_EQ(image.height, 43);
        for (int y = 0; y < 43; ++y)
            for (int x = 0; x < 61; ++x) {
                const std::uint8_t* p = &image.pixels[4 * std::size_t(61 * y + x)];
                for (int c = 0; c < 3; ++c)
                    EXPECT_LE(std::abs(p[c] - (128 + 100 * std::sin(0.1 * x) * std::cos(0.1 * y))), 6);
                EXPECT_EQ(p[3], 255);
            }
    }
}

// A palette of colours, grey of 16 bits, colours without alpha.
TEST(Image, TheFuzzersSeedsAreRead) {
    int count = 0;
    for (const auto& seed : std::filesystem::directory_iterator(PALPATE_SOURCE_DIR "/fuzz/seeds/image")) {
        const Image image = read_image(seed.path());
        EXPECT_EQ(4 * image.height, 3 * image.width) << seed.path();
        EXPECT_GE(image.width, 8) << seed.path();
        for (std::size_t i = 3; i < image.pixels.size(); i += 4) EXPECT_EQ(image.pixels[i], 255);
        ++count;
    }
    EXPECT_GE(count, 4);
}

std::string png(int width, int height) {
    Scratch folder;
    write_png(colourful(width, height), folder / "picture.png");
    return read_text(folder / "picture.png");
}

TEST(Image, WhatIsCutShortIsRefused) {
    for (const std::string& whole : {png(17, 9), jpeg(33, 21, 3)}) {
        for (std::size_t length = 0; length < whole.size(); length += 1 + length / 16)
            EXPECT_NE(refusal(whole.substr(0, length)), "") << length << " of " << whole.size();
        for (std::size_t left : {1, 2, 3})
            EXPECT_HAS(refusal(whole.substr(0, whole.size() - left)), "truncated or damaged");
        EXPECT_EQ(refusal(whole + "more behind it"), "");
    }
    EXPECT_HAS(refusal(""), "neither a PNG nor a JPEG");
    EXPECT_HAS(refusal("GIF89a"), "neither a PNG nor a JPEG");
    EXPECT_HAS(palpate::refusal("none.png", [] { read_image("none.png"); }), "none.png");
}

TEST(Image, ABitTurnedInAPngIsNoticedInAJpegHarmless) {
    std::mt19937 random(5);
    const std::string flat = png(17, 9), photo = jpeg(33, 21, 3);
    for (int i = 0; i < 60; ++i) {
        std::string bytes = flat;
        bytes[random() % bytes.size()] ^= char(1 << random() % 8);
        EXPECT_NE(refusal(bytes), "") << i;
        bytes = photo;
        bytes[random() % bytes.size()] ^= char(1 << random() % 8);
        try {
            const Image image = parse_image(bytes, "a picture");
            EXPECT_EQ(image.pixels.size(), 4u * image.width * image.height);
        } catch (const Error&) {}
    }
}

// The PNG with another size in its head, and the checksum that goes with it.
std::string lying(std::string bytes, std::uint32_t width, std::uint32_t height) {
    auto put = [&](std::size_t at, std::uint32_t value) {
        for (int i = 0; i < 4; ++i) bytes[at + std::size_t(i)] = char(value >> (24 - 8 * i));
    };
    put(16, width);
    put(20, height);
    put(29, std::uint32_t(crc32(0, reinterpret_cast<const Bytef*>(&bytes[12]), 17)));
    return bytes;
}

TEST(Image, SizesThatLieAreRefused) {
    const std::string whole = png(17, 9);
    EXPECT_EQ(refusal(lying(whole, 17, 9)), "");
    EXPECT_HAS(refusal(lying(whole, 18, 9)), "damaged");
    EXPECT_HAS(refusal(lying(whole, 17, 8000)), "damaged");
    EXPECT_HAS(refusal(lying(whole, 8000, 8000)), "damaged");
    EXPECT_HAS(refusal(lying(whole, 12'000, 12'000)), "12000 x 12000 pixels");
    EXPECT_NE(refusal(lying(whole, 0x7fffffff, 0x7fffffff)), "");
    EXPECT_NE(refusal(lying(whole, 0xffffffff, 1)), "");
    EXPECT_NE(refusal(lying(whole, 0, 9)), "");
    std::string photo = jpeg(33, 21, 3);
    const std::size_t frame = photo.find("\xff\xc0");
    ASSERT_NE(frame, std::string::npos);
    for (std::size_t k = 5; k < 9; ++k) photo[frame + k] = '\xff';
    EXPECT_HAS(refusal(photo), "65535 x 65535 pixels");
}

TEST(Image, WhereItCannotBeWrittenItLeavesNothing) {
    Scratch folder;
    expect_refused("picture.png",
                   [&] { write_png(colourful(8, 8), folder / "no such folder" / "picture.png"); });
    EXPECT_EQ(folder.entries(), 0u);
}

TEST(Image, AFolderOfItsNameStaysAndNothingElseAppears) {
    Scratch folder;
    std::filesystem::create_directory(folder / "picture.png");
    EXPECT_THROW(write_png(colourful(8, 8), folder / "picture.png"), Error);
    EXPECT_TRUE(std::filesystem::is_directory(folder / "picture.png"));
    EXPECT_EQ(folder.entries(), 1u);
}

}  // namespace
}  // namespace palpate
