#include "tests/files/itk_files.h"

#include <gdcmTrace.h>
#include <glm/gtc/quaternion.hpp>
#include <itkGDCMImageIO.h>
#include <itkImage.h>
#include <itkImageFileWriter.h>
#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkNrrdImageIO.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace palpate {
namespace {

using Image = itk::Image<short, 3>;

// The layers of a volume from one to another.
Image::Pointer image_of(const Volume& volume, int from, int to) {
    const ivec3 dims(volume.dims.x, volume.dims.y, to - from);
    auto image = Image::New();
    Image::SizeType size;
    Image::SpacingType spacing;
    Image::PointType origin;
    Image::DirectionType direction;
    const dvec3 first =
        dvec3(volume.origin) + dmat3(volume.direction) * (dvec3(volume.spacing) * dvec3(0, 0, from));
    for (unsigned i = 0; i < 3; ++i) {
        size[i] = std::size_t(dims[int(i)]);
        spacing[i] = 1000.0 * double(volume.spacing[int(i)]);
        origin[i] = 1000 * first[int(i)];
        for (unsigned row = 0; row < 3; ++row) direction[row][i] = double(volume.direction[int(i)][int(row)]);
    }
    image->SetRegions(size);
    image->SetSpacing(spacing);
    image->SetOrigin(origin);
    image->SetDirection(direction);
    image->Allocate();
    const std::size_t layer = std::size_t(dims.x) * dims.y;
    std::copy(volume.values.begin() + std::ptrdiff_t(layer * from),
              volume.values.begin() + std::ptrdiff_t(layer * to), image->GetBufferPointer());
    return image;
}

void write(const Image::Pointer& image, itk::ImageIOBase& io, const std::filesystem::path& path,
           bool compressed) {
    auto writer = itk::ImageFileWriter<Image>::New();
    writer->SetImageIO(&io);
    writer->SetInput(image);
    writer->SetFileName(path.string());
    writer->SetUseCompression(compressed);
    writer->Update();
}

}  // namespace

void write_with_itk(const Volume& volume, const std::filesystem::path& path, bool compressed) {
    itk::ImageIOBase::Pointer io = itk::NrrdImageIO::New().GetPointer();
    if (path.extension().string().starts_with(".m")) io = itk::MetaImageIO::New().GetPointer();
    write(image_of(volume, 0, volume.dims.z), *io, path, compressed);
}

void write_slice(const Volume& volume, int z, const std::filesystem::path& path, const Series& series) {
    gdcm::Trace::WarningOff();  // of what it itself leaves out
    auto image = image_of(volume, z, z + 1);
    auto& dictionary = image->GetMetaDataDictionary();
    auto set = [&](const char* tag, const std::string& value) {
        itk::EncapsulateMetaData<std::string>(dictionary, tag, value);
    };
    set("0020|000d", "1.2");
    set("0020|000e", series.uid);
    set("0008|103e", series.description);
    set("0008|0060", "CT");
    set("0028|1052", std::to_string(series.intercept));
    set("0028|1053", "1");
    auto io = itk::GDCMImageIO::New();
    io->KeepOriginalUIDOn();
    io->SetCompressionType(itk::GDCMImageIO::JPEG2000);
    write(image, *io, path, series.packed);
}

void write_series(const Volume& volume, const std::filesystem::path& folder, const Series& series) {
    std::filesystem::create_directories(folder);
    std::vector<int> order(std::size_t(volume.dims.z));
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(7));
    for (int z = 0; z < volume.dims.z; ++z)
        write_slice(volume, z, folder / ("IM" + std::to_string(order[std::size_t(z)]) + ".dcm"), series);
}

Volume oblique(ivec3 dims, unsigned seed) {
    std::mt19937 random(seed);
    auto between = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    Volume volume;
    volume.dims = dims;
    volume.spacing = vec3(between(0.3e-3f, 2e-3f), between(0.3e-3f, 2e-3f), between(0.3e-3f, 2e-3f));
    volume.origin = vec3(between(-0.2f, 0.2f), between(-0.2f, 0.2f), between(-0.2f, 0.2f));
    volume.direction = glm::mat3_cast(
        glm::normalize(glm::quat(between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1))));
    for (std::size_t i = 0; i < volume.count(); ++i)
        volume.values.push_back(std::round(between(-1024, 3000)));
    return volume;
}

}  // namespace palpate
