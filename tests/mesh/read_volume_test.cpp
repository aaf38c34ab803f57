#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/mesh/read.h"
#include "tests/mesh/reading.h"
#include "tests/mesh/shapes.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>
#include <zlib.h>

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

std::string gzip(const std::string& text) {
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
    std::string packed(deflateBound(&stream, text.size()) + 32, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = uInt(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = uInt(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

std::string volume_error(const std::filesystem::path& path, const std::string& bytes) {
    put(path, bytes);
    return error_of(path, [&] { read_volume(path); });
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
        EXPECT_NE(volume_error(scratch / "a.nii", whole.substr(0, length)), "no error") << length;
    for (std::size_t length = 0; length < packed.size(); ++length)
        EXPECT_NE(volume_error(scratch / "a.nii.gz", packed.substr(0, length)), "no error") << length;
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
    EXPECT_HAS(volume_error(path, small().set<std::int16_t>(40, 4).set<std::int16_t>(48, 7).bytes()),
               "7 time points");
    EXPECT_HAS(volume_error(path, small().set<std::int16_t>(40, 5).set<std::int16_t>(50, 3).bytes()),
               "several values");
    for (float width : {0.0f, -1.0f, NAN, INFINITY, 1e30f})
        EXPECT_HAS(volume_error(path, small().set<float>(84, width).bytes()), "wide");
    for (float offset : {1e9f, NAN, INFINITY})
        EXPECT_NE(volume_error(path, small().set<float>(108, offset).bytes()), "no error") << offset;
    for (int datatype : {0, 1, 32, 128, 1536, 1792, 2304, 77})
        EXPECT_HAS(volume_error(path, small().set<std::int16_t>(70, std::int16_t(datatype)).bytes()), "type");
    EXPECT_HAS(volume_error(path, small().matrix({{1, NAN, 0, 0}, {0, 2, 0, 0}, {0, 0, 3, 0}}).bytes()),
               "orientation");
    EXPECT_HAS(volume_error(path, small().matrix({{1, 1, 0, 0}, {0, 2, 0, 0}, {0, 0, 3, 0}}).bytes()),
               "orthonormal");
    EXPECT_HAS(volume_error(path, small().set<std::int32_t>(0, 540).bytes()), "NIfTI-2");
    EXPECT_HAS(volume_error(path, small().set<char>(345, 'i').set<char>(344, 'n').bytes()), "NIfTI");
    EXPECT_HAS(volume_error(path, std::string(1000, 'x')), "NIfTI");
}

TEST(ReadVolume, RefusesWhatIsNotFinite) {
    Scratch scratch;
    for (float bad : {NAN, INFINITY, -INFINITY}) {
        std::vector<float> numbers = count_up(24);
        numbers[17] = bad;
        EXPECT_HAS(volume_error(scratch / "a.nii", small().values(16, numbers).bytes()), "voxel 17");
    }
    EXPECT_HAS(volume_error(scratch / "a.nii", small().values(64, std::vector<double>(24, 1e300)).bytes()),
               "voxel 0");
}

TEST(ReadVolume, RefusesMissingAndOtherFiles) {
    Scratch scratch;
    EXPECT_HAS(error_of(scratch / "a.nii", [&] { read_volume(scratch / "a.nii"); }), "cannot open");
    EXPECT_HAS(volume_error(scratch / "a.mha", small().bytes()), "no MetaImage header");
    EXPECT_HAS(volume_error(scratch / "a.gz", small().bytes()), "use .nii, .nii.gz");
    std::filesystem::create_directory(scratch / "folder.nii");
    EXPECT_HAS(error_of(scratch / "folder.nii", [&] { read_volume(scratch / "folder.nii"); }), "folder");
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
