#include "palpate/base/files.h"
#include "palpate/files/read.h"
#include "palpate/voxels/isosurface.h"
#include "tests/files/itk_files.h"
#include "tests/files/packed.h"
#include "tests/files/reading.h"
#include "tests/scratch.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace palpate {
namespace {

std::string volume_error(const std::filesystem::path& path, const std::string& bytes) {
    put(path, bytes);
    return refusal(path, [&] { read_volume(path); });
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
        put(scratch / "a.nrrd", nrrd("uchar", "raw", fmt::format("space: {}\n{}", name, space)) +
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
    EXPECT_HAS(volume_error(scratch / "a.nhdr", changed(header, "voxels.raw", "LIST")), "an empty list");
    put(scratch / "voxels.raw", bytes_of<std::int16_t>(count_up()).substr(0, 47));
    for (const char* name : {"a.nhdr", "a.mhd"}) {
        put(scratch / "a.nhdr", header);
        EXPECT_HAS(refusal(scratch / "voxels.raw", [&] { read_volume(scratch / name); }), "truncated")
            << name;
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
                EXPECT_NE(volume_error(scratch / name, whole.substr(0, length)), "") << length;
            EXPECT_NE(volume_error(scratch / name, whole.substr(0, whole.size() - 1)), "");
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
    for (const char* numbers : {"2 3", "", "nan 3 4", "1e9999 3 4", "2,5 3 4", "2.5 3 4"})
        EXPECT_NE(sizes(numbers), "") << numbers;
    EXPECT_NE(volume_error(path, changed(whole, "uchar", "block")), "");
    EXPECT_NE(volume_error(path, changed(whole, "raw", "bzip2")), "");
    EXPECT_HAS(volume_error(path, std::string(1000, 'x')), "no NRRD header");
    EXPECT_HAS(volume_error(path, std::string(1000, '\0')), "no NRRD header");
    EXPECT_HAS(volume_error(path, ""), "an empty file");
    EXPECT_NE(volume_error(path, changed(nrrd("uchar", "raw"), "\n\n", "")), "");
    EXPECT_HAS(volume_error(path, "NRRD0004\n" + std::string(2 << 20, 'x')), "without an end");

    const auto meta = scratch / "a.mha";
    const std::string image = metaimage("ElementType = MET_UCHAR") + bytes_of<std::uint8_t>(count_up());
    EXPECT_HAS(volume_error(meta, changed(image, "2 3 4", "65536 65536 256")), "more than 2^30");
    EXPECT_HAS(volume_error(meta, changed(image, "2 3 4", "1000 1000 1000")), "truncated");
    EXPECT_HAS(volume_error(meta, changed(image, "2 3 4", "2 12")), "2 sizes for 3 dimensions");
    EXPECT_NE(volume_error(meta, changed(image, "NDims = 3", "NDims = 7")), "");
    EXPECT_HAS(volume_error(meta, changed(image, "MET_UCHAR", "MET_UCHAR\nElementNumberOfChannels = 3")),
               "numbers a voxel");
    EXPECT_HAS(volume_error(meta, ""), "an empty file");
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
    EXPECT_EQ(with("(1,0,0) (0,1,0) (0,0,1)"), "");
    EXPECT_HAS(with("(1,0.2,0) (0,1,0) (0,0,1)"), "right angles");
    for (const char* directions : {"(0,0,0) (0,1,0) (0,0,1)", "(nan,0,0) (0,1,0) (0,0,1)",
                                   "(inf,0,0) (0,1,0) (0,0,1)", "(1e30,0,0) (0,1,0) (0,0,1)"})
        EXPECT_NE(with(directions), "") << directions;
    for (const char* spacing : {"0 1 1", "nan 1 1", "1e30 1 1"})
        EXPECT_NE(
            volume_error(scratch / "a.mha",
                         metaimage(fmt::format("ElementType = MET_UCHAR\nElementSpacing = {}", spacing)) +
                             bytes_of<std::uint8_t>(count_up())),
            "")
            << spacing;
}

std::vector<float> count_to(int n) {
    std::vector<float> numbers;
    for (int i = 0; i < n; ++i) numbers.push_back(float(i));
    return numbers;
}

class ReadNoted : public testing::Test {
 protected:
    Scratch scratch;
    std::string notes;

    Volume read(const std::string& name, const std::string& bytes) {
        put(scratch / name, bytes);
        std::vector<std::string> all;
        const Volume volume = read_volume(scratch / name, {}, &all);
        notes.clear();
        for (const std::string& note : all) notes += note + "\n";
        return volume;
    }
    Volume read_nrrd(const std::string& more) {
        return read("a.nrrd", nrrd("uchar", "raw", more) + bytes_of<std::uint8_t>(count_up()));
    }
    Volume read_meta(const std::string& more) {
        return read("a.mha",
                    metaimage("ElementType = MET_UCHAR\n" + more) + bytes_of<std::uint8_t>(count_up()));
    }
};

const std::string space = "space: LPS\nspace directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (10,20,30)\n";

TEST_F(ReadNoted, BelievesTheUnitThatAFileNames) {
    const std::pair<const char*, float> units[] = {{"m", 1},      {"cm", 1e-2f},      {"mm", 1e-3f},
                                                   {"um", 1e-6f}, {"microns", 1e-6f}, {"\xc2\xb5m", 1e-6f},
                                                   {"nm", 1e-9f}, {"inch", 0.0254f},  {"Millimeters", 1e-3f},
                                                   {"", 1e-3f}};
    for (const auto& [name, metres] : units) {
        const std::string three = std::string("\"") + name + "\" \"" + name + "\" \"" + name + "\"\n";
        const Volume placed = read_nrrd(space + "space units: " + three);
        EXPECT_LE(glm::distance(placed.spacing / metres, vec3(2, 3, 4)), 1e-5f) << name;
        EXPECT_LE(glm::distance(placed.origin / metres, vec3(10, 20, 30)), 1e-4f) << name;
        EXPECT_EQ(notes, "");
        const Volume plain = read_nrrd("spacings: 2 3 4\nunits: " + three);
        EXPECT_LE(glm::distance(plain.spacing / metres, vec3(2, 3, 4)), 1e-5f) << name;
    }
    read_nrrd(space + "space units: \"furlong\" \"furlong\" \"furlong\"\n");
    EXPECT_HAS(notes, "\"furlong\", is unknown: millimetres are assumed");
    EXPECT_HAS(
        volume_error(scratch / "a.nrrd", nrrd("uchar", "raw", space + "space units: \"mm\" \"cm\" \"mm\"\n") +
                                             bytes_of<std::uint8_t>(count_up())),
        "different units");
    for (const auto& [name, metres] : {std::pair("cm", 1e-2f), {"um", 1e-6f}, {"mm", 1e-3f}, {"?", 1e-3f}})
        EXPECT_LE(
            glm::distance(
                read_meta(std::string("ElementSpacing = 2 3 4\nDistanceUnits = ") + name).spacing / metres,
                vec3(2, 3, 4)),
            1e-5f);
}

TEST_F(ReadNoted, SaysWhereNoSpacingIsStated) {
    for (const char* header : {"", "spacings: nan nan nan\n"}) {
        EXPECT_EQ(read_nrrd(header).spacing, vec3(0.001f)) << header;
        EXPECT_HAS(notes, "states no spacing: 1 mm is assumed");
    }
    EXPECT_EQ(read_meta("").spacing, vec3(0.001f));
    EXPECT_HAS(notes, "states no spacing: 1 mm is assumed");
    EXPECT_LE(glm::distance(read_meta("ElementSize = 2 3 4").spacing, vec3(0.002f, 0.003f, 0.004f)), 1e-8f);
    EXPECT_HAS(notes, "the size of a voxel is taken");
    EXPECT_LE(glm::distance(read_meta("ElementSize = 9 9 9\nElementSpacing = 2 3 4").spacing,
                            vec3(0.002f, 0.003f, 0.004f)),
              1e-8f);
    EXPECT_EQ(notes, "");
}

TEST_F(ReadNoted, FindsPlacesFromTheEndsOfAxes) {
    // From the first sample's centre, or from its edge.
    Volume v = read_nrrd("axis mins: 10 20 30\naxis maxs: 12 26 36\ncenters: node node node\n");
    EXPECT_LE(glm::distance(v.spacing, vec3(0.002f, 0.003f, 0.002f)), 1e-8f);
    EXPECT_LE(glm::distance(v.origin, vec3(0.010f, 0.020f, 0.030f)), 1e-8f);
    v = read_nrrd("axismins: 10 20 30\naxismaxs: 14 29 38\ncenterings: cell cell cell\n");
    EXPECT_LE(glm::distance(v.spacing, vec3(0.002f, 0.003f, 0.002f)), 1e-8f);
    EXPECT_LE(glm::distance(v.origin, vec3(0.011f, 0.0215f, 0.031f)), 1e-8f);
    v = read_nrrd("spacings: 2 -3 4\n");
    EXPECT_EQ(v.direction[1], vec3(0, -1, 0)) << "an axis the other way";
}

TEST_F(ReadNoted, UnpacksWhateverAnNrrdIsPackedIn) {
    const std::string raw = bytes_of<std::int16_t>(count_up()), zipped = gzip(raw),
                      zipped_later = gzip("12345" + raw), digits = ascii();
    auto numbers = [&](const std::string& encoding, const std::string& more, const std::string& data) {
        return read("a.nrrd", nrrd("short", encoding, space + more) + data).values;
    };
    EXPECT_EQ(numbers("bzip2", "", bzip2(raw)), count_up());
    EXPECT_EQ(numbers("bz2", "byte skip: 3\n", bzip2("xyz" + raw)), count_up());
    EXPECT_EQ(numbers("gzip", "line skip: 2\n", "two lines\nleft out\n" + zipped), count_up());
    EXPECT_EQ(numbers("gz", "line skip: 1\nbyte skip: 5\n", "one\n" + zipped_later), count_up());
    EXPECT_EQ(numbers("raw", "line skip: 1\nbyte skip: 5\n", "one\n12345" + raw), count_up());
    EXPECT_EQ(numbers("raw", "byte skip: -1\n", "whatever is before" + raw), count_up());
    EXPECT_EQ(numbers("raw", "", raw + "whatever is behind"), count_up());
    std::string hex;
    for (unsigned char c : raw)
        hex += hex.size() == 40 ? fmt::format("\n{:02x}", c) : fmt::format("{:02X}", c);
    EXPECT_EQ(numbers("hex", "", hex), count_up());
    EXPECT_EQ(numbers("text", "line skip: 1\n", "# a line\n" + digits), count_up());
    EXPECT_EQ(numbers("raw", "own key:=sizes: 9 9 9\nsizes:=9 9 9\n", raw), count_up());
    EXPECT_EQ(notes, "");
    EXPECT_EQ(read("b.nrrd.gz", gzip(nrrd("short", "raw", space) + raw)).values, count_up())
        << "the whole file";

    auto error = [&](const std::string& encoding, const std::string& data) {
        return volume_error(scratch / "a.nrrd", nrrd("short", encoding, space) + data);
    };
    EXPECT_HAS(error("bzip2", bzip2(raw).substr(0, 30)), "bzip2");
    EXPECT_HAS(error("bzip2", raw), "not bzip2 although the header says so");
    EXPECT_HAS(error("gzip", raw), "not gzip although the header says so");
    EXPECT_HAS(error("hex", "0g"), "hexadecimal");
    EXPECT_HAS(error("text", "1 2 three"), "\"three\" instead of a number");
    EXPECT_HAS(error("text", "1 2 3"), "3 numbers of voxels instead of 24");
    EXPECT_HAS(error("zrl", raw), "the encoding \"zrl\", which is not read");
    std::string damaged = gzip(raw);
    damaged[damaged.size() - 6] = char(damaged[damaged.size() - 6] ^ 1);  // the checksum
    EXPECT_HAS(error("gzip", damaged), "gzip");
}

TEST_F(ReadNoted, JoinsVoxelsFromSeveralFiles) {
    const std::vector<float> expected = count_up();
    for (int z = 0; z < 4; ++z) {
        const auto first = expected.begin() + 6 * z;
        const std::string part = bytes_of<std::uint8_t>({first, first + 6});
        put(scratch / fmt::format("z0{}", z + 1), "!" + part);
    }
    const std::string skip = space + "byte skip: 1\n", list = "z01\nz02\nz03\nz04\n";
    auto header = [&](const std::string& data) {
        std::string text = nrrd("uchar", "raw", skip + data);
        text.pop_back();  // the empty line
        return text;
    };
    EXPECT_EQ(read("a.nhdr", header("data file: LIST 2\n" + list)).values, expected);
    EXPECT_EQ(read("a.nhdr", header("data file: z%02d 1 4 1\n")).values, expected);
    EXPECT_EQ(read("a.nhdr", header("datafile: z%02d 1 4 1 2\n")).values, expected);
    EXPECT_HAS(volume_error(scratch / "a.nhdr", header("data file: z%02d 1 5 1\n")),
               "cannot share 24 voxels");
    EXPECT_HAS(volume_error(scratch / "a.nhdr", header("data file: z%n%s 1 4 1\n")),
               "an invalid pattern of file names");
    for (const char* range : {"1e300 1e300 1", "-1e300 -1e300 1", "0.5 3.5 1", "1 4 0.5", "1 4 0", "1 inf 1"})
        EXPECT_HAS(volume_error(scratch / "a.nhdr", header(fmt::format("data file: z%02d {}\n", range))),
                   "an invalid pattern of file names");
    put(scratch / "a.nhdr", header("data file: z%02d 3 6 1\n"));
    EXPECT_HAS(refusal(scratch / "a.nhdr", [&] { read_volume(scratch / "a.nhdr"); }), "z05\"");
    const std::string meta = "ElementType = MET_UCHAR\nElementSpacing = 1 1 1\nHeaderSize = 1";
    EXPECT_EQ(read("a.mhd", metaimage(meta, "LIST\n" + list)).values, expected);
    EXPECT_EQ(read("a.mhd", metaimage(meta, "z%02d 1 4 1")).values, expected);
    const std::string all = bytes_of<std::uint8_t>(expected);
    put(scratch / "end.raw", "whatever is before" + all);
    EXPECT_EQ(read("a.mhd", metaimage(changed(meta, "HeaderSize = 1", "HeaderSize = -1"), "end.raw")).values,
              expected);
    put(scratch / "packed.raw", gzip(bytes_of<std::uint8_t>(count_up())));
    EXPECT_EQ(
        read("a.mhd", metaimage("ElementType = MET_UCHAR\nElementSpacing = 1 1 1", "packed.raw")).values,
        expected)
        << "though it does not say that it is packed";
}

TEST_F(ReadNoted, FindsVoxelsUnderANameOfWindows) {
    std::filesystem::create_directories(scratch / "sub");
    put(scratch / "sub" / "a.raw", bytes_of<std::uint8_t>(count_up()));
    const std::string meta = "ElementType = MET_UCHAR\nElementSpacing = 1 1 1";
    EXPECT_EQ(read("a.mhd", metaimage(meta, "sub\\a.raw")).values, count_up());
    EXPECT_HAS(volume_error(scratch / "a.mhd", metaimage(meta, "C:\\a.raw")), "a.raw\", which is named in");
}

TEST_F(ReadNoted, SaysWhatItLeavesOutOfAMetaImage) {
    read_meta("ElementSpacing = 1 1 1\nCenterOfRotation = 0 0 0\n");
    EXPECT_EQ(notes, "");
    const Volume volume = read_meta("ElementSpacing = 1 1 1\nOffset = 1 2 3\nCenterOfRotation = 5 5 5\n");
    EXPECT_HAS(notes, "its CenterOfRotation is left out");
    EXPECT_LE(glm::distance(volume.origin, vec3(0.001f, 0.002f, 0.003f)), 1e-8f);
    EXPECT_HAS(
        volume_error(scratch / "a.mha", "ObjectType = Tube\nNDims = 3\nNPoints = 3\nPoints =\n1 2 3\n"),
        "not an image (its ObjectType is \"Tube\")");
    EXPECT_HAS(volume_error(scratch / "a.mha", ""), "an empty file");
}

TEST_F(ReadNoted, TakesTheFirstOfSeveralVolumes) {
    const std::string data = bytes_of<std::uint8_t>(count_to(72));
    auto four = [&](const std::string& sizes, const std::string& more) {
        return read("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 4\nsizes: " + sizes + "\nencoding: raw\n" +
                                  more + "\n" + data);
    };
    const std::string last = "space: LPS\nspace directions: (2,0,0) (0,3,0) (0,0,4) none\n",
                      first = "space: LPS\nspace directions: none (2,0,0) (0,3,0) (0,0,4)\n";
    std::vector<float> every_third;
    for (int i = 0; i < 24; ++i) every_third.push_back(float(3 * i));
    Volume v = four("2 3 4 3", last + "kinds: domain domain domain list\n");
    EXPECT_EQ(v.values, count_up());
    EXPECT_HAS(notes, "3 volumes in one file: the first is taken");
    EXPECT_EQ(four("2 3 4 3", "spacings: 2 3 4 nan\nkinds: domain domain domain time\n").values, count_up());
    v = four("3 2 3 4", first + "kinds: list domain domain domain\n");
    EXPECT_EQ(v.dims, ivec3(2, 3, 4));
    EXPECT_EQ(v.values, every_third);
    EXPECT_LE(glm::distance(v.spacing, vec3(0.002f, 0.003f, 0.004f)), 1e-8f);
    EXPECT_EQ(four("1 2 3 4", first).values, count_up());
    EXPECT_EQ(notes, "");
    EXPECT_EQ(four("2 3 4 1", "spacings: 2 3 4 1\n").values, count_up());
    for (const char* kind : {"vector", "RGB-color", "3-vector"})
        EXPECT_HAS(volume_error(scratch / "a.nrrd",
                                "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 3 2 3 4\nencoding: raw\n" +
                                    first + "kinds: " + kind + " domain domain domain\n\n" + data),
                   "3 numbers a voxel");
    EXPECT_HAS(volume_error(scratch / "a.nrrd",
                            "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 2 3 4 3\nencoding: raw\n\n" + data),
               "4 dimensions instead of three");

    v = read("a.mha",
             "NDims = 4\nDimSize = 2 3 4 3\nElementType = MET_UCHAR\nElementSpacing = 2 3 4 1\nOffset = 10 "
             "20 30 0\n"
             "TransformMatrix = 0 1 0 0 -1 0 0 0 0 0 1 0 0 0 0 1\nElementDataFile = LOCAL\n" +
                 data);
    EXPECT_EQ(v.values, count_up());
    EXPECT_HAS(notes, "3 volumes in one file: the first is taken");
    EXPECT_EQ(v.direction[0], vec3(0, 1, 0));
    EXPECT_EQ(v.direction[1], vec3(-1, 0, 0));
    EXPECT_LE(glm::distance(v.origin, vec3(0.01f, 0.02f, 0.03f)), 1e-8f);
}

TEST_F(ReadNoted, TakesEveryNameOfAKindOfNumber) {
    for (const char* type : {"short", "short int", "signed short", "signed short int", "int16", "int16_t"})
        EXPECT_EQ(read("a.nrrd", nrrd(type, "raw") + bytes_of<std::int16_t>(count_up())).values, count_up())
            << type;
    for (const char* type : {"unsigned long long int", "ulonglong", "uint64_t", "unsigned long long"})
        EXPECT_EQ(read("a.nrrd", nrrd(type, "raw") + bytes_of<std::uint64_t>(count_up())).values, count_up())
            << type;
    for (const char* type : {"int", "signed int", "int32"})
        EXPECT_EQ(read("a.nrrd", nrrd(type, "raw") + bytes_of<std::int32_t>(count_up())).values, count_up())
            << type;
    EXPECT_EQ(read("a.nrrd", nrrd("unsigned int", "raw") + bytes_of<std::uint32_t>(count_up())).values,
              count_up());
    EXPECT_EQ(read("a.mha", metaimage("ElementType = MET_LONG") + bytes_of<std::int32_t>(count_up())).values,
              count_up());
    EXPECT_EQ(
        read("a.mha", metaimage("ElementType = MET_ULONG_LONG") + bytes_of<std::uint64_t>(count_up())).values,
        count_up());
    read("a.nrrd",
         changed(nrrd("short", "raw"), "endian: little\n", "") + bytes_of<std::int16_t>(count_up()));
    EXPECT_HAS(notes, "byte order: little-endian is assumed");
    read_nrrd("spacings: 1 1 1\n");
    EXPECT_HAS(notes, "does not state its orientation");
    const Volume scaled =
        read_meta("ElementToIntensityFunctionSlope = 2\nElementToIntensityFunctionOffset = -3");
    EXPECT_EQ(scaled.values[5], 7);
}

}  // namespace
}  // namespace palpate
