#include "palpate/base/files.h"
#include "palpate/files/read.h"
#include "palpate/voxels/isosurface.h"
#include "tests/files/itk_files.h"
#include "tests/files/reading.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

namespace palpate {
namespace {

std::string dicom_error(const std::filesystem::path& path) {
    return refusal(path, [&] { read_volume(path); });
}

void expect_same(const Volume& a, const Volume& b) {
    EXPECT_EQ(a.dims, b.dims);
    EXPECT_EQ(a.values, b.values);
    EXPECT_LE(glm::distance(a.origin, b.origin), 1e-6f);
    EXPECT_LE(glm::distance(a.spacing, b.spacing), 1e-8f);
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_LE(glm::distance(a.direction[axis], b.direction[axis]), 1e-6f);
}

class ReadDicom : public testing::Test {
 protected:
    Scratch scratch;
    std::filesystem::path folder = scratch / "series";
    std::filesystem::path file(int number) const { return folder / ("IM" + std::to_string(number) + ".dcm"); }
};

TEST_F(ReadDicom, ReadsWhatWasWrittenInAnyOrder) {
    for (unsigned seed = 0; seed < 4; ++seed) {
        const Volume volume = oblique(ivec3(5 + seed, 9 - seed, 3 + 4 * seed), seed);
        std::filesystem::remove_all(folder);
        write_series(volume, folder, {.intercept = seed % 2 ? -1024.0 : 0.0});
        EXPECT_TRUE(is_volume(folder));
        expect_same(read_volume(folder), volume);
    }
}

TEST_F(ReadDicom, SkipsOtherFiles) {
    const Volume volume = oblique({4, 5, 6}, 1);
    write_series(volume, folder);
    put(folder / "README.txt", "not a slice");
    put(folder / "empty", "");
    std::filesystem::create_directories(folder / "more");
    expect_same(read_volume(folder), volume);
    EXPECT_FALSE(is_volume(folder / "README.txt"));
    EXPECT_TRUE(is_volume(folder / "more")) << "a folder is no mesh";
    EXPECT_FALSE(is_volume(folder / "nowhere"));
}

TEST_F(ReadDicom, ListsSeveralSeriesAndTakesTheOneThatAFileNames) {
    const Volume head = oblique({4, 5, 6}, 1), heart = oblique({5, 3, 4}, 2), scout = oblique({9, 9, 1}, 3);
    write_series(head, folder);
    write_slice(scout, 0, folder / "scout", {.uid = "1.2.9"});
    expect_same(read_volume(folder), head);
    write_slice(heart, 0, folder / "A0", {.uid = "1.2.4", .description = "heart"});
    for (int z = 1; z < 4; ++z)
        write_slice(heart, z, folder / ("A" + std::to_string(z)), {.uid = "1.2.4", .description = "heart"});
    const std::string error = dicom_error(folder);
    EXPECT_HAS(error, "2 DICOM series");
    EXPECT_HAS(error, "IM0.dcm (6 slices, head)");
    EXPECT_HAS(error, "A0 (4 slices, heart)");
    EXPECT_TRUE(is_volume(folder / "A2"));
    expect_same(read_volume(folder / "A2"), heart);
    expect_same(read_volume(file(3)), head);
    EXPECT_HAS(dicom_error(folder / "scout"), "a single slice");
}

TEST_F(ReadDicom, RefusesWhatIsNoStackOfSlices) {
    const Volume volume = oblique({4, 5, 8}, 1);
    write_series(volume, folder);
    auto replaced = [&](auto change) {
        Volume other = volume;
        change(other);
        write_slice(other, 4, folder / "last.dcm");
        const std::string error = dicom_error(folder);
        std::filesystem::remove(folder / "last.dcm");
        return error;
    };
    EXPECT_EQ(replaced([](Volume&) {}), "") << "a copy";
    EXPECT_EQ(replaced([](Volume& v) { v.dims = {5, 4, 8}; }), "") << "a scout";
    EXPECT_HAS(replaced([](Volume& v) { v.origin += 4.5f * v.spacing.z * v.direction[2]; }), "a distance of");
}

TEST_F(ReadDicom, NamesTheSlicesBetweenWhichOneIsMissing) {
    Volume volume = oblique({4, 5, 9}, 1);
    volume.spacing.z = 1.5e-3f;
    std::filesystem::create_directories(folder);
    for (int z = 0; z < 9; ++z)
        if (z != 4) write_slice(volume, z, file(z));
    const std::string error = dicom_error(folder);
    EXPECT_HAS(error, "a distance of 3 mm between IM3.dcm and IM5.dcm where others have 1.5 mm");
    EXPECT_HAS(error, "missing");
}

TEST_F(ReadDicom, RefusesATiltedGantry) {
    const Volume volume = oblique({4, 5, 9}, 1);
    std::filesystem::create_directories(folder);
    for (int z = 0; z < 9; ++z) {
        Volume shifted = volume;
        shifted.origin += float(z) * 0.2f * volume.spacing.z * volume.direction[1];
        write_slice(shifted, z, file(z));
    }
    EXPECT_HAS(dicom_error(folder), "tilted gantry");
}

TEST_F(ReadDicom, RefusesFilesCutAnywhere) {
    const Volume volume = oblique({16, 16, 3}, 1);
    std::filesystem::create_directories(folder);
    for (int z = 0; z < 3; ++z) write_slice(volume, z, file(z));
    const std::string whole = read_text(file(2));
    // Where it no longer says of which series it is, the others are read, and it is said to be left out.
    for (std::size_t length = 132; length < whole.size(); length += 1 + length / 20) {
        put(file(2), whole.substr(0, length));
        std::vector<std::string> notes;
        try {
            EXPECT_EQ(read_volume(folder, {}, &notes).dims.z, 2);
            ASSERT_EQ(notes.size(), 1u);
            EXPECT_HAS(notes[0], "1 file left out (IM2.dcm): ");
        } catch (const Error& error) {
            EXPECT_HAS(error.what(), file(2).string() + "; ");
        }
    }
    put(file(2), whole.substr(0, whole.size() - 1));
    EXPECT_HAS(refusal(file(2), [&] { read_volume(folder); }), "truncated");
    put(file(2), std::string(128, 'x') + "DICM" + std::string(1000, 'x'));
    EXPECT_HAS(refusal(file(2), [&] { read_volume(file(2)); }), "damaged");
    put(file(2), "no DICOM");
    EXPECT_HAS(dicom_error(file(2)), "no DICOM header");
    EXPECT_HAS(dicom_error("gone.dcm"), "cannot open");
    EXPECT_HAS(dicom_error(folder / "gone" / "gone.dcm"), "cannot open");
    put(file(1), "no DICOM");
    EXPECT_HAS(dicom_error(folder), "no DICOM series of more than one slice");
    put(file(0), "no DICOM");
    EXPECT_HAS(dicom_error(folder), "no DICOM file");
}

// Rows the other way round, and the grid with them.
Volume with_rows_turned(const Volume& volume) {
    Volume turned = volume;
    for (int z = 0; z < volume.dims.z; ++z)
        for (int y = 0; y < volume.dims.y; ++y)
            for (int x = 0; x < volume.dims.x; ++x)
                turned.values[(std::size_t(z) * volume.dims.y + y) * volume.dims.x + x] =
                    volume.at(x, volume.dims.y - 1 - y, z);
    turned.origin += volume.spacing.y * float(volume.dims.y - 1) * volume.direction[1];
    turned.direction[1] = -volume.direction[1];
    return turned;
}

TEST_F(ReadDicom, AHeadHasTheSameSurfaceInEveryFormat) {
    const char* data = std::getenv("PALPATE_DATA");
    const auto path = std::filesystem::path(data ? data : "") / "cranium.mhd";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "cranium.mhd is not available";
    const Volume raw = read_volume(path);
    EXPECT_LT(glm::determinant(raw.direction), 0) << "its rows run forward, which DICOM's cannot";
    const Volume head = with_rows_turned(raw);
    const float skin = -200.5f;
    const Mesh surface = isosurface(head, skin);
    const Mesh mirror = isosurface(raw, skin);
    EXPECT_LE(std::abs(volume(mirror) / volume(surface) - 1), 1e-6);
    EXPECT_LE(glm::distance(bounds(mirror).low, bounds(surface).low), 1e-6f);

    write_series(head, folder);
    write_with_itk(head, scratch / "a.nrrd", true);
    write_with_itk(head, scratch / "a.mha", false);
    for (const auto& file : {folder, scratch / "a.nrrd", scratch / "a.mha"}) {
        const Volume read = read_volume(file);
        expect_same(read, head);
        const Mesh same = isosurface(read, skin);
        EXPECT_EQ(same.triangles.size(), surface.triangles.size()) << file;  // of two like diagonals either
        ASSERT_EQ(same.positions.size(), surface.positions.size());
        float farthest = 0;
        for (std::size_t i = 0; i < same.positions.size(); ++i)
            farthest = std::max(farthest, glm::distance(same.positions[i], surface.positions[i]));
        EXPECT_LE(farthest, 1e-6f) << file;
    }
}

// A packed slice's length tells nothing; it must unpack.
TEST_F(ReadDicom, ReadsPackedSlicesAndRefusesThemCut) {
    const Volume volume = oblique({32, 24, 2}, 1);
    std::filesystem::create_directories(folder);
    for (int z = 0; z < 2; ++z) write_slice(volume, z, file(z), {.packed = true});
    expect_same(read_volume(folder), volume);
    const std::string whole = read_text(file(1));
    for (std::size_t length = whole.size() / 2; length < whole.size(); length += 1 + whole.size() / 40) {
        put(file(1), whole.substr(0, length));
        EXPECT_THROW(read_volume(folder), Error) << length << " of " << whole.size();
    }
}

TEST_F(ReadDicom, SurvivesDamage) {
    const Volume volume = oblique({6, 5, 3}, 1);
    write_series(volume, folder);
    const std::string whole = read_text(file(1));
    std::mt19937 random(5);
    for (int i = 0; i < 60; ++i) {
        std::string bytes = whole;
        for (int flips = 1 + i % 3; flips > 0; --flips) bytes[132 + random() % 600] = char(random());
        put(file(1), bytes);
        try {
            const Volume read = read_volume(folder);  // without the slice, where it now is of another series
            EXPECT_EQ(read.values.size(), read.count());
            EXPECT_EQ(read.dims.x, 6);
        } catch (const Error&) {}
    }
}

}  // namespace
}  // namespace palpate
