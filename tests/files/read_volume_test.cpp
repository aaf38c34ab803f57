#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/files/read.h"
#include "tests/files/packed.h"
#include "tests/files/reading.h"
#include "tests/mesh/shapes.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

namespace palpate {
namespace {

// A NIfTI-1 file as its specification describes it, field by field.
class Nifti {
 public:
    Nifti(ivec3 dims, vec3 spacing) : bytes_(352, '\0') {
        set<std::int32_t>(0, 348);
        for (int i = 0; i < 8; ++i)
            set<std::int16_t>(40 + 2 * i, i == 0 ? 3 : i < 4 ? std::int16_t(dims[i - 1]) : 1);
        set<float>(76, 1);
        for (int i = 0; i < 3; ++i) set<float>(80 + 4 * i, spacing[i]);
        set<float>(108, 352);
        bytes_[123] = 2;  // millimetres
        bytes_.replace(344, 3, "n+1");
    }
    template <class T>
    Nifti& set(std::size_t offset, T value) {
        std::memcpy(&bytes_[offset], &value, sizeof value);
        return *this;
    }
    /// The matrix that takes a voxel's number to millimetres right, forward and up, row by row.
    Nifti& matrix(const float (&rows)[3][4]) {
        set<std::int16_t>(254, 1);
        for (int i = 0; i < 12; ++i) set<float>(280 + 4 * i, rows[i / 4][i % 4]);
        return *this;
    }
    template <class T>
    Nifti& values(int datatype, const std::vector<T>& numbers) {
        set<std::int16_t>(70, std::int16_t(datatype));
        set<std::int16_t>(72, 8 * sizeof(T));
        bytes_.resize(352);
        bytes_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T));
        return *this;
    }
    const std::string& bytes() const { return bytes_; }

 private:
    std::string bytes_;
};

std::vector<float> count_up(std::size_t n) {
    std::vector<float> numbers;
    for (std::size_t i = 0; i < n; ++i) numbers.push_back(float(i));
    return numbers;
}

std::string volume_error(const std::filesystem::path& path, const std::string& bytes) {
    put(path, bytes);
    return refusal(path, [&] { read_volume(path); });
}

Nifti small() { return Nifti({2, 3, 4}, {1, 2, 3}).values(16, count_up(24)); }

template <class T>
void expect_counting(const std::filesystem::path& path, int datatype) {
    put(path, Nifti({3, 5, 2}, {1, 1, 1}).values(datatype, std::vector<T>(30, T(100))).bytes());
    EXPECT_EQ(read_volume(path).values, std::vector<float>(30, 100)) << datatype;
}

TEST(ReadVolume, TakesEveryKindOfNumber) {
    Scratch scratch;
    expect_counting<std::uint8_t>(scratch / "a.nii", 2);
    expect_counting<std::int16_t>(scratch / "a.nii", 4);
    expect_counting<std::int32_t>(scratch / "a.nii", 8);
    expect_counting<float>(scratch / "a.nii", 16);
    expect_counting<double>(scratch / "a.nii", 64);
    expect_counting<std::int8_t>(scratch / "a.nii", 256);
    expect_counting<std::uint16_t>(scratch / "a.nii", 512);
    expect_counting<std::uint32_t>(scratch / "a.nii", 768);
    expect_counting<std::int64_t>(scratch / "a.nii", 1024);
    expect_counting<std::uint64_t>(scratch / "a.nii", 1280);
}

TEST(ReadVolume, KeepsOrderSpacingAndPlace) {
    Scratch scratch;
    // NIfTI's axes run right, forward, up; ITK's and ours left, back, up.
    Nifti file = small();
    file.matrix({{1, 0, 0, 10}, {0, 2, 0, 20}, {0, 0, 3, 30}});
    for (bool packed : {false, true}) {
        const auto path = scratch / (packed ? "a.nii.gz" : "a.nii");
        put(path, packed ? gzip(file.bytes()) : file.bytes());
        const Volume v = read_volume(path);
        EXPECT_EQ(v.dims, ivec3(2, 3, 4));
        EXPECT_EQ(v.values, count_up(24));
        EXPECT_EQ(v.at(1, 2, 3), 23);
        EXPECT_LE(glm::distance(v.spacing, vec3(0.001f, 0.002f, 0.003f)), 1e-9f);
        EXPECT_LE(glm::distance(v.origin, vec3(-0.01f, -0.02f, 0.03f)), 1e-8f);
        EXPECT_EQ(v.direction, mat3(-1, 0, 0, 0, -1, 0, 0, 0, 1));
    }
}

TEST(ReadVolume, KeepsObliqueAndReflectedAxes) {
    Scratch scratch;
    for (float mirror : {1.0f, -1.0f}) {
        Nifti file = small();
        file.matrix({{0.6f * mirror, -1.6f, 0, 1}, {0.8f * mirror, 1.2f, 0, 2}, {0, 0, 3, 3}});
        put(scratch / "a.nii", file.bytes());
        const Volume v = read_volume(scratch / "a.nii", Units::metres);
        EXPECT_LE(glm::distance(v.spacing, vec3(1, 2, 3)), 1e-6f);
        EXPECT_LE(glm::distance(v.origin, vec3(-1, -2, 3)), 1e-6f);
        EXPECT_LE(glm::distance(v.direction[0], vec3(-0.6f, -0.8f, 0) * mirror), 1e-6f);
        EXPECT_LE(glm::distance(v.direction[1], vec3(0.8f, -0.6f, 0)), 1e-6f);
        EXPECT_LE(std::abs(glm::determinant(v.direction) - mirror), 1e-5f);
    }
}

TEST(ReadVolume, BelievesTheFilesOwnUnits) {
    Scratch scratch;
    for (auto [code, scale] : {std::pair(1, 1.0f), {2, 1e-3f}, {3, 1e-6f}}) {
        Nifti file = small();
        file.matrix({{1, 0, 0, 10}, {0, 2, 0, 20}, {0, 0, 3, 30}}).set<char>(123, char(code));
        put(scratch / "a.nii", file.bytes());
        const Volume v = read_volume(scratch / "a.nii");
        EXPECT_LE(glm::distance(v.spacing / scale, vec3(1, 2, 3)), 1e-5f);
        EXPECT_LE(glm::distance(v.origin / scale, vec3(-10, -20, 30)), 1e-4f);
    }
}

TEST(ReadVolume, AppliesSlopeAndIntercept) {
    Scratch scratch;
    Nifti file({2, 2, 2}, vec3(1));
    file.values(4, std::vector<std::int16_t>{0, 1, 2, 3, 4, 5, 6, -7})
        .set<float>(112, 0.5f)
        .set<float>(116, 10);
    put(scratch / "a.nii", file.bytes());
    EXPECT_EQ(read_volume(scratch / "a.nii").values,
              (std::vector<float>{10, 10.5f, 11, 11.5f, 12, 12.5f, 13, 6.5f}));
}

TEST(ReadVolume, RefusesFilesCutAnywhere) {
    Scratch scratch;
    const std::string whole = small().bytes(), packed = gzip(whole);
    for (std::size_t length = 0; length < whole.size(); length += 1 + length / 100)
        EXPECT_NE(volume_error(scratch / "a.nii", whole.substr(0, length)), "") << length;
    for (std::size_t length = 0; length < packed.size(); ++length)
        EXPECT_NE(volume_error(scratch / "a.nii.gz", packed.substr(0, length)), "") << length;
    EXPECT_HAS(volume_error(scratch / "a.nii.gz", packed.substr(0, packed.size() / 2)), "gzip");
    EXPECT_HAS(volume_error(scratch / "a.nii.gz", gzip(whole.substr(0, whole.size() - 1))), "truncated");
    std::string damaged = packed;
    damaged[packed.size() - 6] ^= 1;  // the checksum
    EXPECT_HAS(volume_error(scratch / "a.nii.gz", damaged), "gzip");
}

TEST(ReadVolume, RefusesLies) {
    Scratch scratch;
    const auto path = scratch / "a.nii";
    auto dim = [](int i, int value) {
        return small().set<std::int16_t>(40 + 2 * i, std::int16_t(value)).bytes();
    };
    for (int i : {1, 2, 3})
        for (int width : {0, -1, -32768}) EXPECT_HAS(volume_error(path, dim(i, width)), "voxels wide");
    EXPECT_HAS(volume_error(path, dim(1, 32767)), "truncated");
    EXPECT_HAS(volume_error(path, Nifti(ivec3(32767), vec3(1)).values(2, std::vector<char>(64)).bytes()),
               "2^30");
    EXPECT_HAS(volume_error(path, dim(0, 2)), "2 dimensions");
    EXPECT_HAS(volume_error(path, dim(0, 0)), "0 dimensions");
    EXPECT_HAS(volume_error(path, dim(0, 8)), "8 dimensions");
    EXPECT_HAS(volume_error(path, small().set<std::int16_t>(40, 5).set<std::int16_t>(50, 3).bytes()),
               "3 numbers a voxel");
    for (float width : {NAN, INFINITY, 1e30f})
        EXPECT_NE(volume_error(path, small().set<float>(84, width).bytes()), "") << width;
    for (float offset : {1e9f, NAN, INFINITY})
        EXPECT_NE(volume_error(path, small().set<float>(108, offset).bytes()), "") << offset;
    for (auto [datatype, what] : {std::pair(0, "type 0"),
                                  {1, "type 1"},
                                  {77, "type 77"},
                                  {1536, "type 1536"},
                                  {128, "colours"},
                                  {2304, "colours"},
                                  {32, "complex"},
                                  {1792, "complex"}})
        EXPECT_HAS(volume_error(path, small().set<std::int16_t>(70, std::int16_t(datatype)).bytes()), what);
    for (float shear : {NAN, 1.0f})
        EXPECT_HAS(
            volume_error(path, small().matrix({{1, shear, 0, 0}, {0, 2, 0, 0}, {0, 0, 3, 0}}).bytes()),
            "a sform (code 1) that is not finite, has no width, or whose axes are not at right angles");
    EXPECT_HAS(volume_error(path, small().set<std::int32_t>(0, 540).bytes()), "no NIfTI header");
    EXPECT_HAS(volume_error(path, small().set<char>(344, 'x').bytes()), "no NIfTI header");
    EXPECT_HAS(volume_error(path, std::string("PK\3\4") + std::string(1000, 'x')), "an archive (zip)");
    EXPECT_HAS(volume_error(path, std::string(1000, 'x')), "NIfTI");
}

TEST(ReadVolume, TakesTheLowestWhereNoValueIs) {
    Scratch scratch;
    const auto path = scratch / "a.nii";
    for (float bad : {NAN, INFINITY, -INFINITY}) {
        std::vector<float> numbers = count_up(24), expected = count_up(24);
        numbers[17] = bad;
        for (float lowest : {-5.0f, 3.0f}) {  // never above 0
            numbers[0] = expected[0] = lowest;
            expected[17] = std::min(lowest, 0.0f);
            put(path, small().matrix({{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}).values(16, numbers).bytes());
            std::vector<std::string> notes;
            EXPECT_EQ(read_volume(path, Units::metres, &notes).values, expected);
            EXPECT_HAS(notes.at(0), "1 voxels (4.2 %) have no value");
        }
    }
    EXPECT_HAS(volume_error(path, small().values(16, std::vector<float>(24, NAN)).bytes()),
               "no voxel with a");
    EXPECT_HAS(volume_error(path, small().values(64, std::vector<double>(24, 1e300)).bytes()),
               "no voxel with a");
}

// What both read_volume and its notes say of bytes.
Volume read_noted(const std::filesystem::path& path, const std::string& bytes, std::string& notes) {
    put(path, bytes);
    std::vector<std::string> all;
    const Volume volume = read_volume(path, {}, &all);
    notes.clear();
    for (const std::string& note : all) notes += note + "\n";
    return volume;
}

constexpr float straight[3][4] = {{1, 0, 0, 10}, {0, 2, 0, 20}, {0, 0, 3, 30}};

// The same as its qform: turned by a quarter about z, and elsewhere.
Nifti& add_quaternion(Nifti& file, int code) {
    file.set<std::int16_t>(252, std::int16_t(code)).set<float>(264, std::sqrt(0.5f));  // d
    return file.set<float>(268, -1).set<float>(272, -2).set<float>(276, -3);
}

TEST(ReadVolume, TakesTheSformBeforeTheQform) {
    Scratch scratch;
    std::string notes;
    for (int code : {1, 2, 4}) {
        Nifti file = small();
        add_quaternion(file.matrix(straight).set<std::int16_t>(254, std::int16_t(code)), 1);
        const Volume v = read_noted(scratch / "a.nii", file.bytes(), notes);
        EXPECT_LE(glm::distance(v.origin, vec3(-0.01f, -0.02f, 0.03f)), 1e-8f) << code;
        EXPECT_EQ(v.direction, mat3(-1, 0, 0, 0, -1, 0, 0, 0, 1));
        EXPECT_HAS(notes, "it states two placements, up to 44.6 mm apart") << "(10, 24, 30) and (-5, -2, -3)";
        EXPECT_HAS(notes, "the sform (code " + std::to_string(code) + ") is taken, not the qform (code 1)");
    }
    Nifti file = small();
    const Volume v = read_noted(scratch / "a.nii", add_quaternion(file, 1).bytes(), notes);
    EXPECT_EQ(notes, "");
    EXPECT_LE(glm::distance(v.origin, vec3(0.001f, 0.002f, -0.003f)), 1e-8f);
    EXPECT_LE(glm::distance(v.direction[0], vec3(0, -1, 0)), 1e-6f) << "x forward";
    EXPECT_LE(glm::distance(v.direction[1], vec3(1, 0, 0)), 1e-6f) << "y left";
    EXPECT_LE(glm::distance(v.direction[2], vec3(0, 0, 1)), 1e-6f);
    file.set<float>(76, -1);  // its third axis the other way
    EXPECT_LE(glm::distance(read_noted(scratch / "a.nii", file.bytes(), notes).direction[2], vec3(0, 0, -1)),
              1e-6f);
}

TEST(ReadVolume, TakesTheQformWhereTheSformIsNone) {
    Scratch scratch;
    std::string notes;
    for (float shear : {1.0f, NAN}) {
        Nifti file = small();
        file.matrix({{1, shear, 0, 0}, {0, 2, 0, 0}, {0, 0, 3, 0}});
        const Volume v = read_noted(scratch / "a.nii", add_quaternion(file, 1).bytes(), notes);
        EXPECT_LE(glm::distance(v.origin, vec3(0.001f, 0.002f, -0.003f)), 1e-8f);
        EXPECT_HAS(notes, "its sform (code 1) is not finite, has no width, or is not at right angles");
    }
}

TEST(ReadVolume, LiesAroundTheOriginWhereNoPlaceIsStated) {
    Scratch scratch;
    std::string notes;
    const Volume v = read_noted(scratch / "a.nii", small().bytes(), notes);
    EXPECT_LE(glm::distance(v.origin, 1e-3f * vec3(-0.5f, 2, -4.5f)), 1e-8f);
    EXPECT_EQ(v.direction, mat3(1, 0, 0, 0, -1, 0, 0, 0, 1));
    EXPECT_HAS(notes, "it does not state its orientation");
    const Volume odd =
        read_noted(scratch / "a.nii", small().set<float>(80, 0).set<float>(84, -2).bytes(), notes);
    EXPECT_LE(glm::distance(odd.spacing, vec3(0.001f, 0.002f, 0.003f)), 1e-8f);
    EXPECT_HAS(notes, "no spacing along x: 1 is assumed");
    EXPECT_HAS(notes, "spacing along y is -2: taken without the sign");
}

TEST(ReadVolume, DoesWithoutASlope) {
    Scratch scratch;
    for (float slope : {0.0f, NAN, INFINITY}) {
        put(scratch / "a.nii", small().set<float>(112, slope).set<float>(116, 7).bytes());
        EXPECT_EQ(read_volume(scratch / "a.nii").values, count_up(24)) << slope;
    }
    put(scratch / "a.nii", small().set<float>(112, 2).set<float>(116, NAN).bytes());
    EXPECT_EQ(read_volume(scratch / "a.nii").values[5], 10);
}

TEST(ReadVolume, TakesTheFirstTimePoint) {
    Scratch scratch;
    std::string notes;
    Nifti file = small().values(16, count_up(72));
    file.set<std::int16_t>(40, 4).set<std::int16_t>(48, 3);
    EXPECT_EQ(read_noted(scratch / "a.nii.gz", gzip(file.bytes()), notes).values, count_up(24));
    EXPECT_HAS(notes, "3 time points: the first is taken");
}

TEST(ReadVolume, KnowsAGzipByItsContent) {
    Scratch scratch;
    std::string notes;
    EXPECT_EQ(read_noted(scratch / "plain.nii.gz", small().bytes(), notes).values, count_up(24));
    EXPECT_EQ(read_noted(scratch / "packed.nii", gzip(small().bytes()), notes).values, count_up(24));
    EXPECT_EQ(read_noted(scratch / "SHOUTED.NII.GZ", gzip(small().bytes()), notes).values, count_up(24));
    EXPECT_TRUE(is_volume(scratch / "SHOUTED.NII.GZ"));
}

// Every number of a header and of the voxels in the other byte order.
TEST(ReadVolume, ReadsEitherOrderOfBytes) {
    Scratch scratch;
    std::string bytes = small().matrix(straight).bytes();
    auto turn = [&](std::size_t from, std::size_t to, std::size_t size) {
        for (; from < to; from += size)
            std::reverse(bytes.begin() + std::ptrdiff_t(from), bytes.begin() + std::ptrdiff_t(from + size));
    };
    turn(0, 4, 4);
    turn(40, 56, 2);
    turn(70, 74, 2);
    turn(76, 120, 4);
    turn(252, 256, 2);
    turn(256, 328, 4);
    turn(352, bytes.size(), 4);
    std::string notes;
    const Volume v = read_noted(scratch / "a.nii", bytes, notes);
    EXPECT_EQ(v.values, count_up(24));
    EXPECT_LE(glm::distance(v.origin, vec3(-0.01f, -0.02f, 0.03f)), 1e-8f);
}

TEST(ReadVolume, ReadsNifti2) {
    std::string bytes(544, '\0');
    auto set = [&](std::size_t offset, auto value) { std::memcpy(&bytes[offset], &value, sizeof value); };
    set(0, std::int32_t(540));
    bytes.replace(4, 8, std::string("n+2\0\r\n\032\n", 8));
    set(12, std::int16_t(16));
    const std::int64_t dims[] = {3, 2, 3, 4};
    for (std::size_t i = 0; i < 4; ++i) set(16 + 8 * i, dims[i]);
    for (std::size_t i = 0; i < 4; ++i) set(104 + 8 * i, double(std::max<std::size_t>(i, 1)));
    set(168, std::int64_t(544));
    set(176, 2.0);
    set(348, std::int32_t(1));
    for (std::size_t i = 0; i < 12; ++i) set(400 + 8 * i, double(straight[i / 4][i % 4]));
    set(500, std::int32_t(2));
    const std::vector<float> values = count_up(24);
    bytes.append(reinterpret_cast<const char*>(values.data()), 4 * values.size());
    Scratch scratch;
    std::string notes;
    const Volume v = read_noted(scratch / "a.nii", bytes, notes);
    EXPECT_EQ(notes, "");
    EXPECT_EQ(v.dims, ivec3(2, 3, 4));
    for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(v.values[i], 2 * float(i));
    EXPECT_LE(glm::distance(v.spacing, vec3(0.001f, 0.002f, 0.003f)), 1e-8f);
    EXPECT_LE(glm::distance(v.origin, vec3(-0.01f, -0.02f, 0.03f)), 1e-8f);
}

TEST(ReadVolume, ReadsPairsAndAnalyze) {
    Scratch scratch;
    Nifti file = small().matrix(straight).set<char>(345, 'i').set<float>(108, 0);
    const std::string header = file.bytes().substr(0, 348), voxels = file.bytes().substr(352);
    for (const bool packed : {false, true}) {
        const std::string end = packed ? ".gz" : "";
        put(scratch / ("pair.hdr" + end), packed ? gzip(header) : header);
        put(scratch / ("pair.img" + end), packed ? gzip(voxels) : voxels);
        for (const char* name : {"pair.hdr", "pair.img"}) {
            EXPECT_TRUE(is_volume(scratch / (name + end)));
            const Volume v = read_volume(scratch / (name + end));
            EXPECT_EQ(v.values, count_up(24)) << name;
            EXPECT_LE(glm::distance(v.origin, vec3(-0.01f, -0.02f, 0.03f)), 1e-8f);
        }
    }
    std::string old = header, notes;
    old.replace(252, 96, 96, '\0');
    put(scratch / "OLD.IMG", voxels);
    const Volume v = read_noted(scratch / "OLD.HDR", old, notes);
    EXPECT_EQ(v.values, count_up(24));
    EXPECT_HAS(notes, "left and right may be swapped");
    std::filesystem::remove(scratch / "OLD.IMG");
    EXPECT_HAS(volume_error(scratch / "OLD.HDR", old), "no voxels (.img) beside it");
    put(scratch / "alone.img", voxels);
    EXPECT_HAS(refusal(scratch / "alone.img", [&] { read_volume(scratch / "alone.img"); }),
               "no header (.hdr)");
    EXPECT_HAS(volume_error(scratch / "picture.hdr", std::string("#?RADIANCE") + std::string(400, 'x')),
               "no NIfTI header");
}

TEST(ReadVolume, SaysWhenItTakesAnotherUnitThanTheFiles) {
    Scratch scratch;
    put(scratch / "a.nii", small().matrix(straight).set<char>(123, 3).bytes());
    std::vector<std::string> notes;
    EXPECT_LE(glm::distance(read_volume(scratch / "a.nii", {}, &notes).spacing / 1e-6f, vec3(1, 2, 3)),
              1e-5f);
    EXPECT_TRUE(notes.empty());
    EXPECT_LE(glm::distance(read_volume(scratch / "a.nii", Units::centimetres, &notes).spacing,
                            vec3(0.01f, 0.02f, 0.03f)),
              1e-7f);
    EXPECT_HAS(notes.at(0), "its lengths are in um, as it says, but are taken in cm");
}

TEST(ReadVolume, RefusesMissingAndOtherFiles) {
    Scratch scratch;
    EXPECT_HAS(refusal(scratch / "a.nii", [&] { read_volume(scratch / "a.nii"); }), "cannot open");
    EXPECT_HAS(volume_error(scratch / "a.mha", small().bytes()), "no MetaImage header");
    EXPECT_HAS(volume_error(scratch / "a.gz", small().bytes()), "use .nii, .hdr and .img");
    for (const char* name : {"a.nii", "a.nii.gz", "a.nrrd", "a.mhd"}) {
        EXPECT_HAS(volume_error(scratch / name, "<!DOCTYPE html><html>"), "a web page") << name;
        EXPECT_HAS(volume_error(scratch / name, "version https://git-lfs.github.com/spec/v1"),
                   "git lfs pull");
    }
    std::filesystem::create_directory(scratch / "folder.nii");
    EXPECT_HAS(refusal(scratch / "folder.nii", [&] { read_volume(scratch / "folder.nii"); }), "folder");
}

TEST(ReadVolume, SaysThatAFileIsEmptyOrCutOffInItsHeader) {
    Scratch scratch;
    EXPECT_HAS(volume_error(scratch / "a.nii", ""), "an empty file");
    for (const std::size_t size : {4, 100, 347})
        EXPECT_HAS(volume_error(scratch / "a.nii", small().bytes().substr(0, size)),
                   "a truncated NIfTI header");
    EXPECT_HAS(volume_error(scratch / "a.nii", "solid of another kind"), "no NIfTI header");
}

TEST(ReadVolume, TakesVoxelsBehindTheHeaderWhereTheyWouldOverlapIt) {
    Scratch scratch;
    std::string bytes = small().set<float>(108, 0).bytes();
    bytes.erase(348, 4);
    put(scratch / "a.nii", bytes);
    std::vector<std::string> notes;
    EXPECT_EQ(read_volume(scratch / "a.nii", {}, &notes).values, count_up(24));
    EXPECT_HAS(notes.at(1), "would begin at byte 0, within its header: they are taken from byte 348 on");
}

TEST(ReadVolume, SurvivesDamagedHeadersInSilence) {
    Scratch scratch;
    const std::string whole =
        small().matrix({{1, 0, 0, 10}, {0, 2, 0, 20}, {0, 0, 3, 30}}).set<std::int16_t>(252, 1).bytes();
    std::mt19937 random(5);
    testing::internal::CaptureStderr();
    for (int i = 0; i < 300; ++i) {
        std::string bytes = whole;
        for (int flips = 1 + i % 3; flips > 0; --flips) bytes[random() % 352] = char(random());
        put(scratch / "a.nii", bytes);
        try {
            const Volume v = read_volume(scratch / "a.nii");
            EXPECT_EQ(v.values.size(), v.count());
            EXPECT_LE(std::abs(std::abs(glm::determinant(v.direction)) - 1), 0.01f);
            EXPECT_GT(v.spacing.x * v.spacing.y * v.spacing.z, 0);
        } catch (const Error&) {}
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace palpate
