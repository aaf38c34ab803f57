#include "palpate/mesh/image.h"

#include "palpate/base/error.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

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
    }
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(Image, WhereItCannotBeWrittenItLeavesNothing) {
    Scratch folder;
    try {
        write_png(colourful(8, 8), folder / "no such folder" / "picture.png");
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("picture.png"), std::string::npos);
    }
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
