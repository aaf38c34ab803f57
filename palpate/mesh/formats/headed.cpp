#include "palpate/mesh/formats/volumes.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>

// NRRD and MetaImage are a text of fields, one a line, and then the voxels, in the same file or in one of
// their own. What is looked at here are the few fields that say how much there should be.

namespace palpate {
namespace {

constexpr std::size_t longest_header = 1 << 20;

// Each field by its name in small letters; the first line; and how many bytes all of it takes.
struct Header {
    std::string first;
    std::map<std::string, std::string> fields;
    std::size_t length = 0;

    std::string operator[](const std::string& name) const {
        const auto found = fields.find(name);
        return found == fields.end() ? "" : found->second;
    }
};

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
    return first == std::string::npos ? "" : text.substr(first, last + 1 - first);
}

std::string small_letters(std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::ifstream opened(const std::filesystem::path& path) {
    if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path))
        refuse("no ordinary file", path, "name a file");
    std::ifstream file(path, std::ios::binary);
    if (!file) refuse("cannot open", path, "check the name and that it may be read");
    return file;
}

// Reads as far as the field `last`, or an empty line if that is "", or the end of the file.
Header read_header(const std::filesystem::path& path, char separator, const std::string& last) {
    std::ifstream file = opened(path);
    Header header;
    std::string line;
    while (std::getline(file, line)) {
        if (header.length == 0) header.first = line;
        header.length += line.size() + (file.eof() ? 0 : 1);
        if (header.length > longest_header) refuse("a header without an end", path);
        line = trimmed(line);
        if (line.empty() && last.empty()) break;
        const std::size_t at = line.find(separator);
        if (line.starts_with('#') || at == std::string::npos) continue;
        const std::string name = small_letters(trimmed(line.substr(0, at)));
        header.fields[name] = trimmed(line.substr(at + 1));
        if (name == last) break;
    }
    return header;
}

double count_voxels(const std::string& text, const std::filesystem::path& path) {
    std::vector<double> sizes;
    std::istringstream words(text);
    for (double size; words >> size;) sizes.push_back(size);
    check_sizes(sizes, path);
    return sizes[0] * sizes[1] * sizes[2];
}

// How many bytes a gzip or zlib stream unpacks to; no more than `most` are counted, and none is kept.
double unpacked(std::istream& file, double most, const std::filesystem::path& path) {
    struct End {
        void operator()(z_stream* stream) const { inflateEnd(stream); }
    };
    z_stream stream{};
    constexpr int either = 32 + 15;
    if (inflateInit2(&stream, either) != Z_OK) throw std::bad_alloc();
    const std::unique_ptr<z_stream, End> end(&stream);
    std::vector<char> packed(1 << 16), block(1 << 16);
    double total = 0;
    for (int status = Z_OK; status != Z_STREAM_END && total <= most;) {
        if (stream.avail_in == 0) {
            file.read(packed.data(), std::streamsize(packed.size()));
            stream.next_in = reinterpret_cast<Bytef*>(packed.data());
            stream.avail_in = uInt(file.gcount());
        }
        stream.next_out = reinterpret_cast<Bytef*>(block.data());
        stream.avail_out = uInt(block.size());
        status = inflate(&stream, Z_NO_FLUSH);
        if (status != Z_OK && status != Z_STREAM_END)
            refuse("a truncated or damaged gzip", path, "get the file again");
        total += double(block.size() - stream.avail_out);
    }
    return total;
}

enum class Packing { none, text, gzip };

// How many bytes the voxels may take once unpacked. `data`: the file they are in; "" where they come after
// the header. `most`: more are not counted.
double bytes_there(const std::filesystem::path& path, const Header& header, const std::string& data,
                   Packing packing, double most) {
    if (small_letters(data).starts_with("list") || data.find('%') != std::string::npos)
        refuse("voxels in more than one file", path, "join them to one file");
    const auto place = data.empty() ? path : path.parent_path() / data;
    const std::size_t start = data.empty() ? header.length : 0;
    std::ifstream file = opened(place);
    if (packing == Packing::gzip) return unpacked(file.seekg(std::streamoff(start)), most, place);
    const double there = double(std::filesystem::file_size(place)) - double(start);
    return std::min(packing == Packing::text ? sizeof(double) * there : there,
                    most);  // a digit may be a double
}

}  // namespace

Found look_through_nrrd(const std::filesystem::path& path) {
    const Header header = read_header(path, ':', "");
    if (!header.first.starts_with("NRRD")) refuse("no NRRD header", path);
    const double voxels = count_voxels(header["sizes"], path);
    const std::string encoding = small_letters(header["encoding"]), space = small_letters(header["space"]);
    const bool gzip = encoding == "gzip" || encoding == "gz";
    const bool text = encoding == "ascii" || encoding == "text" || encoding == "txt";
    const Packing packing = gzip ? Packing::gzip : text ? Packing::text : Packing::none;
    const std::string data = header["data file"] + header["datafile"];
    const bool las = space == "las" || space == "left-anterior-superior";
    return {.bytes = bytes_there(path, header, data, packing, sizeof(double) * voxels),
            .turn = las ? dvec3(-1, -1, 1) : dvec3(1)};
}

Found look_through_metaimage(const std::filesystem::path& path) {
    const Header header = read_header(path, '=', "elementdatafile");
    const std::string data = header["elementdatafile"];
    if (data.empty() || header["dimsize"].empty()) refuse("no MetaImage header", path);
    const double voxels = count_voxels(header["dimsize"], path);
    auto says = [&](const char* field, std::string_view letters) {
        return header[field].find_first_of(letters) == 0;
    };
    const Packing packing = says("compresseddata", "Tt1") ? Packing::gzip
                            : says("binarydata", "Ff0")   ? Packing::text
                                                          : Packing::none;
    const bool here = small_letters(data) == "local";
    return {.bytes = bytes_there(path, header, here ? "" : data, packing, sizeof(double) * voxels)};
}

}  // namespace palpate
