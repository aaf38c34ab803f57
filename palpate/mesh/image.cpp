#include "palpate/mesh/image.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include "palpate/base/error.h"
#include "palpate/base/files.h"

#include <stb/stb_image_write.h>

#include <cassert>
#include <cstdio>

namespace palpate {

void write_png(const Image& image, const std::filesystem::path& path) {
    assert(image.width > 0 && image.height > 0);
    assert(image.pixels.size() == 4u * image.width * image.height);
    // A short write is noticed by write_file, which asks the file.
    auto append = [](void* file, void* bytes, int count) {
        std::fwrite(bytes, 1, static_cast<std::size_t>(count), static_cast<std::FILE*>(file));
    };
    write_file(path, [&](std::FILE* file) {
        if (!stbi_write_png_to_func(append, file, image.width, image.height, 4, image.pixels.data(),
                                    4 * image.width))
            throw Error("cannot compress the image", path.string(), "make it smaller");
    });
}

}  // namespace palpate
