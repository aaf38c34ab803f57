#include "palpate/base/files.h"
#include "palpate/mesh/isosurface.h"
#include "palpate/mesh/read.h"
#include "tests/mesh/itk_files.h"
#include "tests/mesh/reading.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace palpate {
namespace {

std::string volume_error(const std::filesystem::path& path, const std::string& bytes) {
    put(path, bytes);
    return error_of(path, [&] { read_volume(path); });
}

template <class T>
std::string bytes_of(const std::vector<float>& values, bool swap = false) {
    std::string bytes;
    for (float value : values) {
        const T number = T(value);
        char raw[sizeof(T)];
        std::memcpy(raw, &number, sizeof raw);
        if (swap) std::reverse(raw, raw + sizeof raw);
        bytes.append(raw, sizeof raw);
    }
    return bytes;
}

std::vector<float> count_up() {
    std::vector<float> numbers(24);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = float(i);
    return numbers;
}

std::string ascii() {
    std::string text;
    for (float value : count_up()) text += std::to_string(int(value)) + (value == 11 ? "\r\n" : " ");
    return text;
}

// 2 x 3 x 4 voxels that count up.
std::string nrrd(const std::string& type, const std::string& encoding, const std::string& more = "") {
    return "NRRD0004\n# one\ntype: " + type + "\ndimension: 3\nsizes: 2 3 4\nencoding: " + encoding +
           "\nendian: little\n" + more + "\n";
}
std::string metaimage(const std::string& more, const std::string& data = "LOCAL") {
    return "ObjectType = Image\nNDims = 3\nDimSize = 2 3 4\n" + more + "\nElementDataFile = " + data + "\n";
}

std::string changed(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

TEST(ReadHeaded, ReadsWhatItkWrites) {
    Scratch scratch;
    for (unsigned seed = 0; seed < 3; ++seed) {
        Volume volume = oblique(ivec3(5 + 2 * seed, 9 - seed, 3 + 4 * seed), seed);
        if (seed == 1) volume.direction[0] *= -1;  // mirrored
        for (const char* name : {"a.nrrd", "a.nhdr", "a.mha", "a.mhd"})
            for (bool compressed : {false, true}) {
                const auto path = scratch / (std::to_string(compressed) + name);
                write_with_itk(volume, path, compressed);
                EXPECT_TRUE(is_volume(path));
                const Volume read = read_volume(path);
                EXPECT_EQ(read.dims, volume.dims);
                EXPECT_EQ(read.values, volume.values);
                EXPECT_LE(glm::distance(read.origin, volume.origin), 1e-6f) << path;
                EXPECT_LE(glm::distance(read.spacing, volume.spacing), 1e-8f) << path;
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_LE(glm::distance(read.direction[axis], volume.direction[axis]), 1e-6f) << path;
            }
    }
}

TEST(ReadHeaded, TakesEveryKindOfNumberInEitherOrder) {
    Scratch scratch;
    const auto read = [&](const std::string& name, const std::string& bytes) {
        put(scratch / name, bytes);
        return read_volume(scratch / name).values;
    };
    const std::string big = changed(nrrd("short", "raw"), "little", "big");
    EXPECT_EQ(read("a.nrrd", nrrd("uchar", "raw") + bytes_of<std::uint8_t>(count_up())), count_up());
    EXPECT_EQ(read("a.nrrd", nrrd("short", "raw") + bytes_of<std::int16_t>(count_up())), count_up());
    EXPECT_EQ(read("a.nrrd", big + bytes_of<std::int16_t>(count_up(), true)), count_up());
    EXPECT_EQ(read("a.nrrd", nrrd("double", "raw") + bytes_of<double>(count_up())), count_up());
    EXPECT_EQ(read("a.nrrd", nrrd("float", "ascii") + ascii()), count_up());
    EXPECT_EQ(read("a.nrrd", nrrd("uint8", "text") + ascii()), count_up());
    EXPECT_EQ(read("a.mha", metaimage("ElementType = MET_FLOAT\nBinaryData = True\nBinaryDataByteOrderMSB = "
                                      "True") +
                                bytes_of<float>(count_up(), true)),
              count_up());
    EXPECT_EQ(read("a.mha", metaimage("ElementType = MET_USHORT\nBinaryData = False") + ascii()), count_up());
}

TEST(ReadHeaded, TurnsEverySpaceToOurAxes) {
    Scratch scratch;
    const std::string space = "space directions: (0,2,0) (-3,0,0) (0,0,4)\nspace origin: (10,20,30)\n";
    struct {
        const char* name;
        vec3 turn;
    } spaces[] = {{"left-posterior-superior", vec3(1, 1, 1)},   {"LPS", vec3(1, 1, 1)},
                  {"right-anterior-superior", vec3(-1, -1, 1)}, {"RAS", vec3(-1, -1, 1)},
                  {"left-anterior-superior", vec3(1, -1, 1)},   {"LAS", vec3(1, -1, 1)}};
    for (auto [name, turn] : spaces) {
        put(scratch / "a.nrrd", nrrd("uchar", "raw", "space: " + std::string(name) + "\n" + space) +
                                    bytes_of<std::uint8_t>(count_up()));
        const Volume v = read_volume(scratch / "a.nrrd", Units::metres);
        EXPECT_LE(glm::distance(v.origin, turn * vec3(10, 20, 30)), 1e-5f) << name;
        EXPECT_LE(glm::distance(v.spacing, vec3(2, 3, 4)), 1e-6f) << name;
        EXPECT_LE(glm::distance(v.direction[0], turn * vec3(0, 1, 0)), 1e-6f) << name;
        EXPECT_LE(glm::distance(v.direction[1], turn * vec3(-1, 0, 0)), 1e-6f) << name;
        EXPECT_LE(glm::distance(v.direction[2], turn * vec3(0, 0, 1)), 1e-6f) << name;
    }
}

TEST(ReadHeaded, FindsVoxelsInAFileOfTheirOwn) {
    Scratch scratch;
    put(scratch / "voxels.raw", bytes_of<std::int16_t>(count_up()));
    const std::string header = nrrd("short", "raw", "data file: voxels.raw\n");
    put(scratch / "a.nhdr", header);
    put(scratch / "a.mhd", metaimage("ElementType = MET_SHORT", "voxels.raw"));
    EXPECT_EQ(read_volume(scratch / "a.nhdr").values, count_up());
    EXPECT_EQ(read_volume(scratch / "a.mhd").values, count_up());
    for (const char* other : {"gone.raw", "/dev/zero", "."}) {
        put(scratch / "a.nhdr", changed(header, "voxels.raw", other));
        EXPECT_THROW(read_volume(scratch / "a.nhdr"), Error) << other;
    }
    EXPECT_HAS(volume_error(scratch / "a.nhdr", changed(header, "voxels.raw", "LIST")), "more than one file");
    put(scratch / "voxels.raw", bytes_of<std::int16_t>(count_up()).substr(0, 47));
    for (const char* name : {"a.nhdr", "a.mhd"}) {
        put(scratch / "a.nhdr", header);
        EXPECT_HAS(error_of(scratch / name, [&] { read_volume(scratch / name); }), "truncated") << name;
    }
}

TEST(ReadHeaded, RefusesFilesCutAnywhere) {
    Scratch scratch;
    const Volume volume = oblique({5, 7, 4}, 1);
    for (const char* name : {"a.nrrd", "a.mha"})
        for (bool compressed : {false, true}) {
            write_with_itk(volume, scratch / name, compressed);
            const std::string whole = read_text(scratch / name);
            for (std::size_t length = 0; length < whole.size(); length += 1 + length / 30)
                EXPECT_NE(volume_error(scratch / name, whole.substr(0, length)), "no error") << length;
            EXPECT_NE(volume_error(scratch / name, whole.substr(0, whole.size() - 1)), "no error");
        }
}

TEST(ReadHeaded, RefusesLies) {
    Scratch scratch;
    const auto path = scratch / "a.nrrd";
    const std::string whole = nrrd("uchar", "raw") + bytes_of<std::uint8_t>(count_up());
    auto sizes = [&](const char* numbers) { return volume_error(path, changed(whole, "2 3 4", numbers)); };
    EXPECT_HAS(sizes("65536 65536 256"), "more than 2^30");
    EXPECT_HAS(sizes("1000 1000 1000"), "truncated");
    EXPECT_HAS(sizes("2 3 5"), "truncated");
    for (const char* numbers : {"0 3 4", "-2 3 4"}) EXPECT_HAS(sizes(numbers), "voxels wide");
    for (const char* numbers : {"2 3", "2 3 4 1", "", "nan 3 4", "1e9999 3 4", "2,5 3 4"})
        EXPECT_NE(sizes(numbers), "no error") << numbers;
    EXPECT_NE(volume_error(path, changed(whole, "uchar", "block")), "no error");
    EXPECT_NE(volume_error(path, changed(whole, "raw", "bzip2")), "no error");
    EXPECT_HAS(volume_error(path, std::string(1000, 'x')), "no NRRD header");
    EXPECT_HAS(volume_error(path, std::string(1000, '\0')), "no NRRD header");
    EXPECT_HAS(volume_error(path, ""), "no NRRD header");
    EXPECT_NE(volume_error(path, changed(nrrd("uchar", "raw"), "\n\n", "")), "no error");
    EXPECT_HAS(volume_error(path, "NRRD0004\n" + std::string(2 << 20, 'x')), "without an end");

    const auto meta = scratch / "a.mha";
    const std::string image = metaimage("ElementType = MET_UCHAR") + bytes_of<std::uint8_t>(count_up());
    EXPECT_HAS(volume_error(meta, changed(image, "2 3 4", "65536 65536 256")), "more than 2^30");
    EXPECT_HAS(volume_error(meta, changed(image, "2 3 4", "1000 1000 1000")), "truncated");
    EXPECT_HAS(volume_error(meta, changed(image, "2 3 4", "2 12")), "2 dimensions");
    EXPECT_NE(volume_error(meta, changed(image, "NDims = 3", "NDims = 7")), "no error");
    EXPECT_HAS(volume_error(meta, changed(image, "MET_UCHAR", "MET_UCHAR\nElementNumberOfChannels = 3")),
               "numbers a voxel");
    EXPECT_HAS(volume_error(meta, ""), "no MetaImage header");
    EXPECT_HAS(volume_error(meta, std::string(1000, '\0')), "no MetaImage header");
}

TEST(ReadHeaded, RefusesGeometryThatIsNone) {
    Scratch scratch;
    auto with = [&](const std::string& directions) {
        return volume_error(scratch / "a.nrrd", nrrd("uchar", "raw",
                                                     "space: LPS\nspace directions: " + directions +
                                                         "\nspace origin: (0,0,0)\n") +
                                                    bytes_of<std::uint8_t>(count_up()));
    };
    EXPECT_EQ(with("(1,0,0) (0,1,0) (0,0,1)"), "no error");
    EXPECT_HAS(with("(1,0.2,0) (0,1,0) (0,0,1)"), "right angles");
    for (const char* directions : {"(0,0,0) (0,1,0) (0,0,1)", "(nan,0,0) (0,1,0) (0,0,1)",
                                   "(inf,0,0) (0,1,0) (0,0,1)", "(1e30,0,0) (0,1,0) (0,0,1)"})
        EXPECT_NE(with(directions), "no error") << directions;
    for (const char* spacing : {"0 1 1", "-1 1 1", "nan 1 1", "1e30 1 1"})
        EXPECT_NE(volume_error(scratch / "a.mha", metaimage("ElementType = MET_UCHAR\nElementSpacing = " +
                                                            std::string(spacing)) +
                                                      bytes_of<std::uint8_t>(count_up())),
                  "no error")
            << spacing;
}

TEST(ReadHeaded, RefusesWhatIsNotFinite) {
    Scratch scratch;
    for (float bad : {NAN, INFINITY}) {
        std::vector<float> values = count_up();
        values[17] = bad;
        EXPECT_HAS(volume_error(scratch / "a.nrrd", nrrd("float", "raw") + bytes_of<float>(values)),
                   "voxel 17");
        EXPECT_HAS(
            volume_error(scratch / "a.mha", metaimage("ElementType = MET_FLOAT") + bytes_of<float>(values)),
            "voxel 17");
    }
}

}  // namespace
}  // namespace palpate
