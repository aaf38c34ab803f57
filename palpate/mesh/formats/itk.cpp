#include "palpate/base/error.h"
#include "palpate/base/isolated.h"
#include "palpate/mesh/formats/volumes.h"

#include <fmt/format.h>
#include <gdcmImageHelper.h>
#include <gdcmMediaStorage.h>
#include <gdcmReader.h>
#include <itkGDCMImageIO.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>

// ITK and GDCM end the whole program, or want all memory, for some files. So they work in a process of its
// own, which writes down a Grid and then all values as floats.

namespace palpate {
namespace {

void write(const void* from, std::size_t bytes, std::FILE* out) {
    if (std::fwrite(from, 1, bytes, out) != bytes) throw std::bad_alloc();  // it is written to memory
}

template <class T>
void write_as_floats(const char* buffer, std::size_t count, std::FILE* out) {
    const T* values = reinterpret_cast<const T*>(buffer);
    std::array<float, 1 << 14> block;
    for (std::size_t first = 0; first < count; first += block.size()) {
        const std::size_t some = std::min(block.size(), count - first);
        std::transform(values + first, values + first + some, block.begin(), [](T v) { return float(v); });
        write(block.data(), some * sizeof(float), out);
    }
}

void write_as_floats(itk::IOComponentEnum type, const char* buffer, std::size_t count, std::FILE* out,
                     const std::filesystem::path& path) {
    using Type = itk::IOComponentEnum;
    switch (type) {
        case Type::UCHAR:
            return write_as_floats<unsigned char>(buffer, count, out);
        case Type::CHAR:
            return write_as_floats<signed char>(buffer, count, out);
        case Type::USHORT:
            return write_as_floats<unsigned short>(buffer, count, out);
        case Type::SHORT:
            return write_as_floats<short>(buffer, count, out);
        case Type::UINT:
            return write_as_floats<unsigned int>(buffer, count, out);
        case Type::INT:
            return write_as_floats<int>(buffer, count, out);
        case Type::ULONG:
            return write_as_floats<unsigned long>(buffer, count, out);
        case Type::LONG:
            return write_as_floats<long>(buffer, count, out);
        case Type::ULONGLONG:
            return write_as_floats<unsigned long long>(buffer, count, out);
        case Type::LONGLONG:
            return write_as_floats<long long>(buffer, count, out);
        case Type::FLOAT:
            return write_as_floats<float>(buffer, count, out);
        case Type::DOUBLE:
            return write_as_floats<double>(buffer, count, out);
        default:
            refuse("voxels of an unknown type", path, "convert them to numbers");
    }
}

Grid grid_of(const itk::ImageIOBase& io, const std::filesystem::path& path) {
    if (io.GetNumberOfComponents() != 1)
        refuse(fmt::format("{} numbers a voxel (colours or vectors)", io.GetNumberOfComponents()), path,
               "convert it to one number a voxel");
    std::vector<double> sizes;
    for (unsigned i = 0; i < io.GetNumberOfDimensions(); ++i) sizes.push_back(double(io.GetDimensions(i)));
    check_sizes(sizes, path);
    Grid grid;
    for (unsigned i = 0; i < 3; ++i) {
        grid.dims[int(i)] = int(io.GetDimensions(i));
        grid.spacing[int(i)] = io.GetSpacing(i);
        grid.origin[int(i)] = io.GetOrigin(i);
        for (unsigned row = 0; row < 3; ++row) grid.direction[int(i)][int(row)] = io.GetDirection(i)[row];
    }
    return grid;
}

void write_values(itk::ImageIOBase& io, const Grid& grid, std::FILE* out, const std::filesystem::path& path) {
    itk::ImageIORegion whole(3);
    for (unsigned i = 0; i < 3; ++i) whole.SetSize(i, std::size_t(grid.dims[int(i)]));
    io.SetIORegion(whole);
    const std::size_t count = std::size_t(grid.dims.x) * std::size_t(grid.dims.y) * std::size_t(grid.dims.z);
    const auto buffer = std::make_unique_for_overwrite<char[]>(count * io.GetComponentSize());
    io.Read(buffer.get());
    write_as_floats(io.GetComponentType(), buffer.get(), count, out, path);
}

itk::ImageIOBase::Pointer reader_of(const std::filesystem::path& path) {
    const std::string name = path.string();
    if (name.ends_with(".nrrd") || name.ends_with(".nhdr")) return itk::NrrdImageIO::New().GetPointer();
    if (name.ends_with(".mha") || name.ends_with(".mhd")) return itk::MetaImageIO::New().GetPointer();
    return itk::NiftiImageIO::New().GetPointer();
}

void read_file(const std::filesystem::path& path, const Found& found, std::FILE* out) {
    const auto io = reader_of(path);
    io->SetFileName(path.string());
    io->ReadImageInformation();
    Grid grid = grid_of(*io, path);
    grid.origin *= found.turn * found.origin_scale;
    for (int axis = 0; axis < 3; ++axis) grid.direction[axis] *= found.turn;
    const double promised = double(io->GetImageSizeInBytes());
    if (!(promised <= found.bytes)) refuse_truncated(found.bytes, promised, path);
    write(&grid, sizeof grid, out);
    write_values(*io, grid, out, path);
}

// A tag such as "0020|000e", without the blanks that pad it.
std::string tag(itk::GDCMImageIO& io, const char* name) {
    std::string value;
    io.GetValueFromTag(name, value);
    value.erase(std::find(value.begin(), value.end(), '\0'), value.end());
    value.erase(value.find_last_not_of(' ') + 1);
    return value;
}

// GDCM fills up what a file lacks, so its length is held against what its picture needs, unless that is
// packed.
void check_whole(gdcm::Reader& reader, const Grid& grid, const std::filesystem::path& file) {
    const auto& header = reader.GetFile().GetHeader();
    if (header.GetDataSetTransferSyntax().IsEncapsulated()) return;
    const double there = double(std::filesystem::file_size(file) - reader.GetStreamCurrentPosition());
    const double promised = double(grid.dims.x) * grid.dims.y * grid.dims.z *
                            gdcm::ImageHelper::GetPixelFormatValue(reader.GetFile()).GetPixelSize();
    if (!(promised <= there)) refuse_truncated(there, promised, file);
}

// None for what is no picture, such as a DICOMDIR.
std::vector<Slice> slice_of(const std::filesystem::path& file) {
    const gdcm::Tag pixels(0x7fe0, 0x0010);
    gdcm::Reader reader;
    reader.SetFileName(file.c_str());
    const bool readable = reader.ReadUpToTag(pixels, {pixels});
    gdcm::MediaStorage kind;
    kind.SetFromFile(reader.GetFile());
    if (readable && kind != gdcm::MediaStorage::MS_END && !gdcm::MediaStorage::IsImage(kind)) return {};
    if (!readable || reader.GetStreamCurrentPosition() >= std::filesystem::file_size(file))
        refuse("a truncated or damaged DICOM file", file, "get it again, or move it away");

    auto io = itk::GDCMImageIO::New();
    io->SetFileName(file.string());
    io->ReadImageInformation();
    Slice slice{file, tag(*io, "0020|000e"), tag(*io, "0008|103e"), grid_of(*io, file)};
    check_whole(reader, slice.grid, file);
    if (slice.grid.dims.z > 1)
        refuse(fmt::format("{} pictures in one file", slice.grid.dims.z), file, "export it with one a file");
    return {slice};
}

void read_series(const std::vector<std::filesystem::path>& files, const std::filesystem::path& path,
                 std::FILE* out) {
    std::vector<Slice> slices;
    for (const auto& file : files)
        for (const Slice& slice : slice_of(file)) slices.push_back(slice);
    slices = one_series(slices, path);
    const Grid grid = stack(slices, path);
    write(&grid, sizeof grid, out);
    for (const Slice& slice : slices) {
        auto io = itk::GDCMImageIO::New();
        io->SetFileName(slice.file.string());
        io->ReadImageInformation();
        write_values(*io, slice.grid, out, slice.file);
    }
}

// ITK's complaint without the place in its source that comes first.
std::string complaint(const itk::ExceptionObject& error) {
    const std::string text = error.GetDescription();
    const std::size_t label = text.find("ERROR: ");
    return label == std::string::npos ? text : text.substr(label + 7);
}

// False for what no scanner writes.
bool sensible(double number) { return std::abs(number) < 1e9; }

void check_geometry(const Grid& grid, const std::filesystem::path& path) {
    const dmat3 product = glm::transpose(grid.direction) * grid.direction;
    for (int i = 0; i < 3; ++i) {
        if (!(grid.spacing[i] > 1e-9 && sensible(grid.spacing[i])))
            refuse(fmt::format("voxels {} wide", grid.spacing[i]), path);
        if (!sensible(grid.origin[i])) refuse("an origin that is not finite", path);
        for (int j = 0; j < 3; ++j)
            if (!(std::abs(product[i][j] - (i == j)) <= 1e-3))
                refuse("axes that are not at right angles", path, "resample it to axes at right angles");
    }
}

// Runs `work` elsewhere and makes a volume of what it writes. It may take its time over so many bytes, and
// hold so many at once several times.
Volume volume_from(const std::filesystem::path& path, double bytes, double at_once,
                   const std::function<void(std::FILE*)>& work) {
    const Allowance allowance{15 + bytes / 20e6, (std::size_t(1) << 28) + std::size_t(4 * at_once)};
    const Written written = isolated("ITK", path.string(), allowance, [&](std::FILE* out) {
        try {
            work(out);
        } catch (const itk::ExceptionObject& error) {
            refuse("what ITK cannot read (" + complaint(error) + ")", path,
                   "convert it with another program");
        }
    });
    Grid grid;
    Volume volume;
    const auto values = written.bytes().subspan(sizeof grid);
    std::memcpy(&grid, written.bytes().data(), sizeof grid);
    check_geometry(grid, path);
    volume.dims = grid.dims;
    volume.spacing = grid.spacing;
    volume.origin = grid.origin;
    volume.direction = grid.direction;
    volume.values.resize(volume.count());
    std::memcpy(volume.values.data(), values.data(), values.size());
    return volume;
}

}  // namespace

Volume read_with_itk(const std::filesystem::path& path, const Found& found) {
    return volume_from(path, found.bytes, found.bytes, [&](std::FILE* out) { read_file(path, found, out); });
}

Volume read_dicom(const std::filesystem::path& path) {
    if (!std::filesystem::exists(path)) refuse("cannot open", path, "check the name and that it may be read");
    const auto files = dicom_files(std::filesystem::is_directory(path) ? path : path.parent_path() / ".");
    double all = 0, largest = 0;
    for (const auto& file : files) {
        const double size = double(std::filesystem::file_size(file));
        all += size;
        largest = std::max(largest, size);
    }
    constexpr double packed = 10;  // times smaller is a compressed slice
    return volume_from(path, packed * all, packed * largest,
                       [&](std::FILE* out) { read_series(files, path, out); });
}

}  // namespace palpate
