// What lies about in folders of DICOM, written element by element: foreign files, scouts, echoes, copies,
// what is rounded, missing or packed.
#include "palpate/files/read.h"
#include "tests/files/dicom_file.h"
#include "tests/files/reading.h"
#include "tests/scratch.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <tuple>

namespace palpate {
namespace {

constexpr std::uint32_t kind = 0x00080016, instance = 0x00080018, modality = 0x00080060,
                        image_type = 0x00080008, series_name = 0x0008103e, patient_name = 0x00100010,
                        patient = 0x00100020, thickness = 0x00180050, echo = 0x00180081, between = 0x00180088,
                        imager_spacing = 0x00181164, study = 0x0020000d, series = 0x0020000e,
                        acquisition = 0x00200012, instance_number = 0x00200013, position = 0x00200032,
                        orientation = 0x00200037, location = 0x00201041, samples = 0x00280002,
                        light = 0x00280004, frames = 0x00280008, rows = 0x00280010, columns = 0x00280011,
                        pixel_spacing = 0x00280030, bits = 0x00280100, stored = 0x00280101,
                        high_bit = 0x00280102, has_sign = 0x00280103, padding = 0x00280120,
                        padding_limit = 0x00280121, tables = 0x00283000, intercept = 0x00281052,
                        slope = 0x00281053, pixels = 0x7fe00010;

const std::string ct = "1.2.840.10008.5.1.4.1.1.2";

// 4 columns, 3 rows, 2 by 1.5 mm; 4 mm from slice to slice.
constexpr int wide = 4, high = 3, area = wide * high;

std::vector<std::uint16_t> picture(int z) {
    std::vector<std::uint16_t> values;
    for (int i = 0; i < area; ++i) values.push_back(std::uint16_t(100 * z + i));
    return values;
}

DicomFile slice(int z) {
    DicomFile file;
    file.text(kind, "UI", ct).text(instance, "UI", fmt::format("1.2.3.{}", z + 1)).text(modality, "CS", "CT");
    file.text(series, "UI", "1.2.9")
        .text(thickness, "DS", "4")
        .text(instance_number, "IS", fmt::format("{}", z));
    file.text(position, "DS", fmt::format("-10\\-20\\{}", 30 + 4 * z));
    file.text(orientation, "DS", "1\\0\\0\\0\\1\\0");
    file.number(samples, 1).text(light, "CS", "MONOCHROME2").number(rows, high).number(columns, wide);
    file.text(pixel_spacing, "DS", "1.5\\2");
    file.number(bits, 16).number(stored, 16).number(high_bit, 15).number(has_sign, 0);
    file.binary(pixels, "OW", picture(z));
    return file;
}

class ReadSeries : public testing::Test {
 protected:
    Scratch scratch;
    std::filesystem::path folder = scratch / "series";
    std::vector<std::string> notes;

    void SetUp() override { std::filesystem::create_directories(folder); }
    std::filesystem::path file(int z) const { return folder / fmt::format("IM{:03}", z); }

    void write(int count, const std::function<DicomFile(int)>& make = slice) {
        for (int z = 0; z < count; ++z) put(file(z), make(z).bytes());
    }
    Volume read(const std::filesystem::path& path) {
        notes.clear();
        return read_volume(path, {}, &notes);
    }
    std::string error(const std::filesystem::path& path) {
        return refusal([&] { read(path); });
    }
    std::string all_notes() const {
        std::string all;
        for (const std::string& note : notes) all += note + "\n";
        return all;
    }
    // The slices of `slice`, of the given numbers.
    void expect_slices(const Volume& volume, const std::vector<int>& numbers) {
        ASSERT_EQ(volume.dims, ivec3(wide, high, numbers.size()));
        for (std::size_t k = 0; k < numbers.size(); ++k)
            for (int i = 0; i < area; ++i)
                EXPECT_EQ(volume.values[k * area + std::size_t(i)], 100 * numbers[k] + i) << k;
        EXPECT_LE(glm::distance(volume.spacing, vec3(0.002f, 0.0015f, 0.004f)), 1e-7f);
        EXPECT_LE(glm::distance(volume.origin, vec3(-0.01f, -0.02f, 0.03f + 0.004f * float(numbers[0]))),
                  1e-7f);
    }
};

TEST_F(ReadSeries, ReadsAPlainOneWithoutANote) {
    write(5);
    expect_slices(read(folder), {0, 1, 2, 3, 4});
    EXPECT_EQ(all_notes(), "");
    expect_slices(read(file(2)), {0, 1, 2, 3, 4});
}

TEST_F(ReadSeries, LeavesOutWhatIsNoSliceAndSaysSo) {
    write(5);
    DicomFile report = slice(7), film = slice(8), outlines = slice(9), index = slice(10), mosaic = slice(11);
    report.text(series, "UI", "1.2.10").number(samples, 3).text(light, "CS", "RGB").number(bits, 8);
    report.number(stored, 8).number(high_bit, 7).binary(pixels, "OB", std::vector<char>(3 * area));
    film.text(series, "UI", "1.2.11").text(frames, "IS", "3");
    film.binary(pixels, "OW", std::vector<std::uint16_t>(3 * area));
    outlines.text(kind, "UI", "1.2.840.10008.5.1.4.1.1.481.3").without(pixels);
    index.text(kind, "UI", "1.2.840.10008.1.3.10").without(pixels);
    mosaic.text(image_type, "CS", "ORIGINAL\\PRIMARY\\M\\MOSAIC");
    std::string cut = slice(12).text(series, "UI", "1.2.12").bytes();
    cut.resize(cut.size() - 9);
    const struct {
        const char* name;
        std::string bytes, reason;
    } others[] = {{"report.dcm", report.bytes(), "colours (RGB)"},
                  {"film.dcm", film.bytes(), "3 pictures in one file"},
                  {"outlines.dcm", outlines.bytes(), "RT Structure Set"},
                  {"index.dcm", index.bytes(), "not an image"},
                  {"mosaic.dcm", mosaic.bytes(), "a Siemens mosaic"},
                  {"cut.dcm", cut, "truncated"},
                  {"noise.dcm", std::string(128, 'x') + "DICM" + std::string(1000, 'x'), "damaged"}};
    for (const auto& other : others) {
        put(folder / other.name, other.bytes);
        expect_slices(read(folder), {0, 1, 2, 3, 4});
        EXPECT_HAS(all_notes(), fmt::format("1 file left out ({}): ", other.name));
        EXPECT_HAS(all_notes(), other.reason);
        expect_slices(read(file(3)), {0, 1, 2, 3, 4});
        EXPECT_HAS(error(folder / other.name), other.reason);
        EXPECT_HAS(error(folder / other.name), (folder / other.name).string() + "; ");
        std::filesystem::remove(folder / other.name);
    }
    for (const auto& other : others) put(folder / other.name, other.bytes);
    expect_slices(read(folder), {0, 1, 2, 3, 4});
    EXPECT_EQ(notes.size(), 6u) << "cut and noise are one";
}

TEST_F(ReadSeries, NamesTheReasonWhereNothingElseIsThere) {
    write(3, [](int z) {
        return slice(z)
            .number(samples, 3)
            .text(light, "CS", "RGB")
            .binary(pixels, "OW", std::vector<std::uint16_t>(3 * area));
    });
    EXPECT_HAS(error(folder), "colours (RGB)");
}

TEST_F(ReadSeries, RefusesACutSliceOfItsOwn) {
    write(5);
    const std::string whole = slice(2).bytes();
    put(file(2), whole.substr(0, whole.size() - 3));
    EXPECT_HAS(error(folder), "truncated or damaged DICOM file in " + file(2).string());
    put(file(2), whole.substr(0, 200));  // before it says what series it is of
    EXPECT_HAS(error(folder), "a distance of 8 mm between IM001 and IM003 where others have 4 mm");
}

TEST_F(ReadSeries, PartsASeriesBySizeAngleAndSpacing) {
    write(5);
    DicomFile turned = slice(7), small = slice(8), coarse = slice(9), bare = slice(10);
    turned.text(orientation, "DS", "0\\1\\0\\0\\0\\-1");
    small.number(rows, 2);
    coarse.text(pixel_spacing, "DS", "3\\3");
    bare.without(position);
    const std::pair<DicomFile, const char*> scouts[] = {{turned, "at another angle"},
                                                        {small, "of another size"},
                                                        {coarse, "of another spacing"},
                                                        {bare, "without a position"}};
    for (const auto& [scout, reason] : scouts) {
        put(folder / "a-scout", scout.bytes());
        for (const auto& path : {folder, file(3)}) {
            expect_slices(read(path), {0, 1, 2, 3, 4});
            EXPECT_EQ(notes, std::vector<std::string>{
                                 std::string("1 slice of the same series left out (a-scout): ") + reason});
        }
        EXPECT_HAS(error(folder / "a-scout"), "a single slice");
    }
}

TEST_F(ReadSeries, TakesOneOfSeveralEchoes) {
    // Two echoes of two types each: two marks tell them apart.
    for (int z = 0; z < 4; ++z)
        for (int e = 0; e < 2; ++e)
            for (int t = 0; t < 2; ++t) {
                DicomFile one = slice(z);
                one.text(echo, "DS", e ? "9.2" : "4.6")
                    .text(image_type, "CS", t ? "ORIGINAL\\P" : "ORIGINAL\\M");
                std::vector<std::uint16_t> values = picture(z);
                for (auto& value : values) value = std::uint16_t(value + 1000 * e + 2000 * t);
                one.binary(pixels, "OW", values)
                    .text(instance_number, "IS", fmt::format("{}", 4 * z + 2 * e + t));
                put(folder / fmt::format("e{}t{}z{}", e, t, z), one.bytes());
            }
    const Volume first = read(folder);
    ASSERT_EQ(first.dims, ivec3(wide, high, 4));
    EXPECT_EQ(first.values[0], 0);
    EXPECT_HAS(all_notes(), "4 volumes in one place, distinguished by EchoTime and ImageType");
    const Volume named = read(folder / "e1t1z2");
    EXPECT_EQ(named.values[0], 3000);
    EXPECT_EQ(named.values.back(), 3000 + 300 + area - 1);

    for (int z = 0; z < 4; ++z)
        for (int e = 0; e < 2; ++e) std::filesystem::remove(folder / fmt::format("e{}t1z{}", e, z));
    EXPECT_EQ(read(folder / "e1t0z0").values[0], 1000);
    EXPECT_HAS(all_notes(), "distinguished by EchoTime:");
}

TEST_F(ReadSeries, TellsVolumesApartByTheirNumbersWhereNothingElseDoes) {
    write(4);
    for (int z = 0; z < 4; ++z) {
        DicomFile later = slice(z);
        later.binary(pixels, "OW", picture(z + 50)).text(instance_number, "IS", fmt::format("{}", z + 4));
        put(folder / fmt::format("A{}", z), later.bytes());
    }
    expect_slices(read(file(1)), {0, 1, 2, 3});
    EXPECT_HAS(all_notes(), "the order of their numbers alone");
    EXPECT_EQ(read(folder / "A2").values[0], 5000);
}

TEST_F(ReadSeries, LeavesOutCopies) {
    write(5);
    for (int z : {1, 3})
        put(folder / fmt::format("copy{}", z), slice(z).text(instance, "UI", "1.9.9").bytes());
    expect_slices(read(folder), {0, 1, 2, 3, 4});
    EXPECT_HAS(all_notes(), "2 files left out (");
    EXPECT_HAS(all_notes(), "copies of others");
    std::filesystem::create_symlink(file(0), folder / "link");
    expect_slices(read(folder), {0, 1, 2, 3, 4});
    EXPECT_HAS(all_notes(), "3 files left out (");
}

TEST_F(ReadSeries, PartsPatientsOfOneSeries) {
    write(4);
    for (int z = 0; z < 4; ++z)
        put(folder / fmt::format("B{}", z),
            slice(z).text(patient, "LO", "other").text(series_name, "LO", "knee").bytes());
    EXPECT_HAS(error(folder), "2 DICOM series");
    EXPECT_HAS(error(folder), "B0 (4 slices, knee)");
    expect_slices(read(file(0)), {0, 1, 2, 3});
}

TEST_F(ReadSeries, TakesTwoSpellingsOfANameAsOnePatient) {
    write(4, [](int z) { return slice(z).text(patient_name, "PN", z % 2 ? "Doe^J" : "DOE^J"); });
    expect_slices(read(folder), {0, 1, 2, 3});
    EXPECT_EQ(all_notes(), "");
    write(4, [](int z) { return slice(z).text(patient_name, "PN", z % 2 ? "Doe" : "Roe").without(series); });
    EXPECT_HAS(error(folder), "2 DICOM series");
}

TEST_F(ReadSeries, JoinsSlicesThatAreASeriesEach) {
    auto apart = [](int z) {
        return slice(z).text(series, "UI", fmt::format("1.2.9.{}", z)).text(study, "UI", "1.7");
    };
    write(4, apart);
    for (const auto& path : {folder, file(2)}) {
        expect_slices(read(path), {0, 1, 2, 3});
        EXPECT_HAS(all_notes(), "4 series of one slice each");
    }
    write(4, [&](int z) { return apart(z).text(study, "UI", fmt::format("1.7.{}", z)); });
    EXPECT_HAS(error(folder), "4 series of one slice each, which differ in study");
    EXPECT_HAS(error(folder), "export the slices of one volume as one series");
}

TEST_F(ReadSeries, TellsUnreadableNumbersFromMissingOnes) {
    write(4, [](int z) { return slice(z).text(position, "DS", fmt::format("-10\\-20\\{},0", 30 + 4 * z)); });
    expect_slices(read(folder), {0, 1, 2, 3});
    EXPECT_EQ(all_notes(), "its ImagePositionPatient has decimal commas: they are read as points\n");
    write(4, [](int z) { return slice(z).text(position, "DS", "here").text(slope, "DS", "one"); });
    read(folder);
    EXPECT_HAS(all_notes(), "its ImagePositionPatient cannot be read and is left out");
    EXPECT_HAS(all_notes(), "its RescaleSlope cannot be read and is left out");
    EXPECT_HAS(all_notes(), "without positions, slices are taken upwards");
    EXPECT_EQ(all_notes().find("it states no"), std::string::npos);
}

TEST_F(ReadSeries, TakesRoundedPositionsAsEven) {
    const std::tuple<double, int, bool> series[] = {
        {1.25, 1, true}, {1.25, 1, false}, {0.9375, 2, true}, {0.3, 1, false}, {1.25, 2, false}};
    for (const auto& [distance, decimals, stated] : series) {
        write(22, [&](int z) {
            DicomFile one = slice(z);
            one.text(position, "DS", fmt::format("-10\\-20\\{:.{}f}", -2.1 + distance * z, decimals));
            return stated ? one.text(thickness, "DS", fmt::format("{}", distance)) : one.without(thickness);
        });
        const Volume volume = read(folder);
        const double rounding = std::pow(10, -decimals);
        EXPECT_EQ(volume.dims.z, 22);
        EXPECT_LE(std::abs(1000 * double(volume.spacing.z) - distance), stated ? 1e-6 : rounding / 22);
        for (int z = 0; z < 22; ++z)
            EXPECT_LE(
                std::abs(1000.0 * double(volume.origin.z + float(z) * volume.spacing.z) + 2.1 - distance * z),
                0.5 * rounding + 1e-5)
                << distance << " " << decimals << " " << z;
    }
    EXPECT_EQ(all_notes(), "") << "hundredths of a millimetre are nothing here";
    std::filesystem::remove(file(11));
    EXPECT_HAS(error(folder), "between IM010 and IM012");
    EXPECT_HAS(error(folder), "missing");
}

TEST_F(ReadSeries, SaysHowUnevenSlicesLie) {
    auto uneven = [&](double by) {
        write(9, [&](int z) {
            return slice(z).text(position, "DS", fmt::format("-10\\-20\\{:.4f}", 4 * z + (z % 2 ? by : 0)));
        });
    };
    uneven(0.2);
    EXPECT_EQ(read(folder).dims.z, 9);
    EXPECT_HAS(all_notes(), "slices are taken as 4");
    EXPECT_HAS(all_notes(), "they lie up to 0.1");
    uneven(1.2);
    EXPECT_HAS(error(folder), "uneven distances");
}

TEST_F(ReadSeries, SaysWhereTheSpacingComesFrom) {
    write(4, [](int z) { return slice(z).without(pixel_spacing).text(imager_spacing, "DS", "1.5\\2"); });
    expect_slices(read(folder), {0, 1, 2, 3});
    EXPECT_EQ(all_notes(), "without PixelSpacing, ImagerPixelSpacing is taken, 2 x 1.5 mm\n");
    write(4, [](int z) { return slice(z).text(imager_spacing, "DS", "9\\9"); });
    expect_slices(read(folder), {0, 1, 2, 3});
    EXPECT_EQ(all_notes(), "");
    for (const char* nothing : {"", "0\\0", "-1\\2", "x\\y"}) {
        write(4, [&](int z) { return slice(z).text(pixel_spacing, "DS", nothing); });
        EXPECT_LE(glm::distance(read(folder).spacing, vec3(0.001f, 0.001f, 0.004f)), 1e-8f);
        EXPECT_HAS(all_notes(), "without PixelSpacing, 1 mm is assumed");
    }
}

TEST_F(ReadSeries, FindsPlacesWhereNoPositionIsStated) {
    // Written the other way round, so that the order counts.
    write(4, [](int z) {
        return slice(3 - z).without(position).text(location, "DS", fmt::format("{}", 2.5 * (3 - z)));
    });
    Volume volume = read(folder);
    EXPECT_EQ(volume.values[0], 0);
    EXPECT_LE(std::abs(volume.spacing.z - 0.0025f), 1e-8f);
    EXPECT_HAS(all_notes(), "SliceLocation is taken");
    write(4, [](int z) { return slice(3 - z).without(position).text(between, "DS", "-3"); });
    volume = read(folder);
    EXPECT_EQ(volume.values[0], 0);
    EXPECT_LE(std::abs(volume.spacing.z - 0.003f), 1e-8f);
    EXPECT_HAS(all_notes(), "in the order of their numbers, 3 mm apart (SpacingBetweenSlices)");
    write(4, [](int z) { return slice(z).without(position).without(orientation); });
    EXPECT_LE(std::abs(read(folder).spacing.z - 0.004f), 1e-8f);
    EXPECT_HAS(all_notes(), "4 mm apart (SliceThickness)");
    EXPECT_HAS(all_notes(), "without an orientation");
    write(4, [](int z) { return slice(z).without(position).without(thickness); });
    read(folder);
    EXPECT_HAS(all_notes(), "1 mm apart, which is a guess");
}

TEST_F(ReadSeries, KeepsValuesHoweverTheyAreShown) {
    write(3, [](int z) {
        return slice(z)
            .text(light, "CS", "MONOCHROME1")
            .text(slope, "DS", "2")
            .text(intercept, "DS", "-1000");
    });
    const Volume volume = read(folder);
    for (int i = 0; i < area; ++i) EXPECT_EQ(volume.values[std::size_t(2 * area + i)], 2 * (200 + i) - 1000);
}

TEST_F(ReadSeries, ScalesEachSliceAsItSays) {
    write(3, [](int z) {
        return slice(z).text(slope, "DS", fmt::format("{}", 0.5 * z)).text(intercept, "DS", "1");
    });
    const Volume volume = read(folder);
    EXPECT_EQ(volume.values[5], 5 + 1) << "a slope of 0 is none";
    EXPECT_EQ(volume.values[area + 5], 0.5f * 105 + 1);
    EXPECT_EQ(volume.values[2 * area + 5], 205 + 1);
}

TEST_F(ReadSeries, TakesTheBitsInUse) {
    // Twelve bits with a sign; above them lies a drawing.
    write(3, [](int z) {
        std::vector<std::uint16_t> values(area);
        for (int i = 0; i < area; ++i)
            values[std::size_t(i)] = std::uint16_t(((z - 6 - i) & 0x0fff) | 0x5000);
        return slice(z)
            .number(stored, 12)
            .number(high_bit, 11)
            .number(has_sign, 1)
            .binary(pixels, "OW", values);
    });
    const Volume volume = read(folder);
    for (int i = 0; i < area; ++i) EXPECT_EQ(volume.values[std::size_t(area + i)], 1 - 6 - i);
    write(3, [](int z) {
        std::vector<std::uint8_t> values(area, std::uint8_t(250 + z));
        return slice(z).number(bits, 8).number(stored, 8).number(high_bit, 7).binary(pixels, "OB", values);
    });
    EXPECT_EQ(read(folder).values[area], 251);
}

TEST_F(ReadSeries, ClearsPaddingThatWouldLookLikeTissue) {
    auto with = [&](std::uint16_t outside) {
        write(3, [&](int z) {
            std::vector<std::uint16_t> values = picture(z);
            values[0] = outside;
            for (auto& value : values) value = std::uint16_t(value + (value == outside ? 0 : 50));
            return slice(z).number(padding, outside).binary(pixels, "OW", values);
        });
        return read(folder);
    };
    EXPECT_EQ(with(60000).values[area], 0) << "no higher than the rest";
    EXPECT_HAS(all_notes(), "3 voxels");
    EXPECT_EQ(with(7).values[area], 7) << "as it is, where it is below the rest";
    EXPECT_EQ(all_notes(), "");
}

TEST_F(ReadSeries, ClearsARangeOfPadding) {
    // Either end may be the greater one.
    for (const auto& [one, limit] : {std::pair(60000, 60010), {60010, 60000}}) {
        write(3, [&](int z) {
            std::vector<std::uint16_t> values = picture(z);
            values[0] = 60000, values[1] = 60005, values[2] = 60010, values[3] = 60011;
            return slice(z)
                .number(padding, std::uint16_t(one))
                .number(padding_limit, std::uint16_t(limit))
                .binary(pixels, "OW", values);
        });
        const Volume volume = read(folder);
        for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(volume.values[area + i], 0);
        EXPECT_EQ(volume.values[area + 3], 60011);
        EXPECT_HAS(all_notes(), "9 voxels");
    }
}

TEST_F(ReadSeries, LooksValuesUpInATable) {
    const auto table = [](std::vector<std::uint16_t> head, const std::vector<std::uint16_t>& values) {
        return DicomFile().binary(0x00283002, "US", head).binary(0x00283006, "US", values);
    };
    const auto with = [&](const DicomFile& lut) {
        write(3, [&](int z) { return slice(z).items(tables, {lut}); });
    };
    with(table({4, 101, 16}, {7, 900, 30, 40}));
    Volume volume = read(folder);
    EXPECT_EQ(volume.values[0], 7) << "below the first";
    EXPECT_EQ(volume.values[area], 7);
    EXPECT_EQ(volume.values[area + 2], 900);
    EXPECT_EQ(volume.values[area + 4], 40);
    EXPECT_EQ(volume.values[area + 5], 40) << "above the last";
    with(table({3, 101, 8}, {0x0502, 9}));
    volume = read(folder);
    EXPECT_EQ(volume.values[area + 1], 2);
    EXPECT_EQ(volume.values[area + 2], 5);
    EXPECT_EQ(volume.values[area + 3], 9);
    with(table({4, 101, 16}, {7, 900}));
    EXPECT_HAS(error(folder), "an incomplete lookup table (ModalityLUTSequence)");
}

TEST_F(ReadSeries, SaysThatItReadsNoFloatPixels) {
    write(3, [](int z) {
        return slice(z).without(pixels).binary(0x7fe00008, "OF", std::vector<float>(area)).number(bits, 32);
    });
    EXPECT_HAS(error(folder), "float pixels (FloatPixelData), which are not read");
}

TEST_F(ReadSeries, ReadsANuclearMedicineTomogram) {
    const std::uint32_t order = 0x00540080, detectors = 0x00540022;
    DicomFile file = slice(0);
    std::vector<std::uint16_t> all, numbers;
    for (int z = 0; z < 4; ++z) {
        for (const auto value : picture(z)) all.push_back(value);
        numbers.push_back(std::uint16_t(z + 1));
    }
    file.text(kind, "UI", "1.2.840.10008.5.1.4.1.1.20").text(modality, "CS", "NM").text(between, "DS", "4");
    file.without(position).without(orientation).text(frames, "IS", "4").binary(pixels, "OW", all);
    file.items(
        detectors,
        {DicomFile().text(position, "DS", "-10\\-20\\30").text(orientation, "DS", "1\\0\\0\\0\\1\\0")});
    DicomFile tomogram = file;
    tomogram.binary(order, "US", numbers);
    put(folder / "nm.dcm", tomogram.bytes());
    expect_slices(read(folder / "nm.dcm"), {0, 1, 2, 3});
    EXPECT_EQ(all_notes(), "");
    put(folder / "nm.dcm", tomogram.text(between, "DS", "-4").bytes());
    const Volume down = read(folder / "nm.dcm");
    EXPECT_EQ(down.values[0], 300) << "the last lies lowest";
    EXPECT_LE(std::abs(down.origin.z - 0.018f), 1e-7f);
    put(folder / "nm.dcm", file.bytes());
    EXPECT_HAS(error(folder / "nm.dcm"), "4 nuclear medicine frames in one file that does not state");
    EXPECT_HAS(error(folder / "nm.dcm"), "dcm2niix");
}

// The slices of one file, as enhanced CT and MR have them.
DicomFile enhanced(int count, bool twice) {
    DicomFile file = slice(0), shared;
    const std::uint32_t own_items = 0x52009230, shared_items = 0x52009229, place = 0x00209113,
                        turn = 0x00209116, measures = 0x00289110, values = 0x00289145, content = 0x00209111;
    shared.items(turn, {DicomFile().text(orientation, "DS", "1\\0\\0\\0\\1\\0")});
    shared.items(measures, {DicomFile().text(thickness, "DS", "4").text(pixel_spacing, "DS", "1.5\\2")});
    std::vector<DicomFile> own;
    std::vector<std::uint16_t> all;
    for (int time = 0; time <= int(twice); ++time)
        for (int z = count; z-- > 0;) {  // from above
            DicomFile one;
            one.items(place, {DicomFile().text(position, "DS", fmt::format("-10\\-20\\{}", 30 + 4 * z))});
            one.items(
                values,
                {DicomFile().text(intercept, "DS", fmt::format("{}", 1000 * z)).text(slope, "DS", "1")});
            one.items(content, {DicomFile().binary(0x00209128, "UL",
                                                   std::vector<std::uint32_t>{std::uint32_t(time + 1)})});
            own.push_back(one);
            for (std::uint16_t value : picture(z)) all.push_back(std::uint16_t(value + 50 * time));
        }
    file.text(kind, "UI", "1.2.840.10008.5.1.4.1.1.2.1").without(position).without(orientation);
    file.without(pixel_spacing).without(thickness).text(frames, "IS", fmt::format("{}", own.size()));
    return file.items(shared_items, {shared}).items(own_items, own).binary(pixels, "OW", all);
}

TEST_F(ReadSeries, ReadsTheSlicesOfOneFile) {
    for (const bool twice : {false, true}) {
        put(folder / "all.dcm", enhanced(5, twice).bytes());
        for (const auto& path : {folder, folder / "all.dcm"}) {
            const Volume volume = read(path);
            ASSERT_EQ(volume.dims, ivec3(wide, high, 5));
            EXPECT_LE(glm::distance(volume.spacing, vec3(0.002f, 0.0015f, 0.004f)), 1e-8f);
            EXPECT_LE(glm::distance(volume.origin, vec3(-0.01f, -0.02f, 0.03f)), 1e-8f);
            for (int z = 0; z < 5; ++z) EXPECT_EQ(volume.at(1, 0, z), float(1000 * z + 100 * z + 1));
            EXPECT_EQ(notes.size(), std::size_t(twice)) << all_notes();
            if (twice)
                EXPECT_HAS(all_notes(), "2 volumes in one place, distinguished by TemporalPositionIndex");
        }
    }
}

TEST_F(ReadSeries, FindsASeriesInFoldersBelow) {
    const auto deep = scratch / "cd" / "DICOM" / "PA000" / "ST000" / "SE000";
    std::filesystem::create_directories(deep);
    put(scratch / "cd" / "README.TXT", "a CD");
    put(scratch / "cd" / "DICOMDIR",
        slice(9).text(kind, "UI", "1.2.840.10008.1.3.10").without(pixels).bytes());
    for (int z = 0; z < 4; ++z) put(deep / fmt::format("IM{:04}", z), slice(z).bytes());
    expect_slices(read(scratch / "cd"), {0, 1, 2, 3});
    expect_slices(read(scratch / "cd" / "DICOMDIR"), {0, 1, 2, 3});
    expect_slices(read(scratch / "cd" / "DICOM"), {0, 1, 2, 3});
    const auto other = deep.parent_path() / "SE001";
    std::filesystem::create_directories(other);
    for (int z = 0; z < 3; ++z)
        put(other / fmt::format("IM{:04}", z), slice(z).text(series, "UI", "1.2.8").bytes());
    EXPECT_HAS(error(scratch / "cd"), "2 DICOM series");
    EXPECT_HAS(error(scratch / "cd"), "DICOM/PA000/ST000/SE001/IM0000 (3 slices)");
    expect_slices(read(other / "IM0001"), {0, 1, 2});
    std::filesystem::create_directories(scratch / "empty" / "emptier");
    EXPECT_TRUE(is_volume(scratch / "empty")) << "no mesh at any rate";
    EXPECT_HAS(error(scratch / "empty"), "no DICOM file, here or in folders below");
}

TEST_F(ReadSeries, ReadsDataSetsWithoutTheMark) {
    for (int z = 0; z < 4; ++z) put(file(z), slice(z).data_set());
    EXPECT_TRUE(is_volume(file(0)));
    expect_slices(read(folder), {0, 1, 2, 3});
    expect_slices(read(file(1)), {0, 1, 2, 3});
}

// That this process has no more descriptors is no damage of the files.
TEST_F(ReadSeries, SaysWhenNoProcessCanBeStarted) {
    write(4);
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
    const int next = dup(STDERR_FILENO);
    ASSERT_GE(next, 0);
    close(next);
    const rlimit two_more{rlim_t(next) + 2, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &two_more), 0);
    const std::string said = error(folder);
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
    EXPECT_HAS(said, "cannot start a process (Too many open files)");
    expect_slices(read(folder), {0, 1, 2, 3});
}

TEST_F(ReadSeries, SaysThatAGantryIsTiltedAndHowFar) {
    write(6, [](int z) {
        return slice(z).text(position, "DS",
                             fmt::format("-10\\{:.3f}\\{}", -20 + 4 * z * std::tan(0.3), 30 + 4 * z));
    });
    EXPECT_HAS(error(folder), "(a tilted gantry, 17.2 degrees)");
    write(6, [](int z) {
        return slice(z).text(position, "DS", fmt::format("-10\\{}\\{}", z % 2 ? -20 : 20, 30 + 4 * z));
    });
    EXPECT_HAS(error(folder), "do not lie above each other");
}

TEST_F(ReadSeries, SaysHowPixelsArePackedThatCannotBeUnpacked) {
    // Named as High-Throughput JPEG 2000, and as one that nobody knows.
    for (const char* syntax : {"1.2.840.10008.1.2.4.201", "1.2.840.10008.1.2.4.999"}) {
        for (int z = 0; z < 3; ++z) put(file(z), slice(z).bytes(syntax));
        EXPECT_HAS(error(folder), syntax);
        EXPECT_HAS(error(folder), "export it uncompressed");
    }
}

}  // namespace
}  // namespace palpate
