#pragma once
#include <filesystem>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace palpate {

/// The header of an NRRD or a MetaImage file: one field per line.
struct Fields {
    std::string first;                       // the first line
    std::map<std::string, std::string> all;  // by name, in small letters and without spaces
    std::vector<std::string> files;          // the lines after a field that is a LIST

    bool has(const std::string& name) const { return all.contains(name); }
    /// The value of a field; "" if it is missing.
    std::string operator[](const std::string& name) const;
    /// Its numbers, with NaN for an unknown one. Throws Error for a word that is not a number, or if there
    /// are fewer than `least`; empty if the field is missing.
    std::vector<double> numbers(const std::string& name, std::size_t least,
                                const std::filesystem::path& path) const;
};

/// Reads up to the field `last`, or an empty line if that is "", or the end of the file; if a field is
/// `LIST`, to the end. Throws Error if that is longer than a header can be.
Fields read_fields(std::istream& in, char separator, const std::string& last,
                   const std::filesystem::path& path);

/// The files with a header's voxels: one, those of a list, or those of a numbered pattern ("slice%03d.raw 1
/// 90 1"). Relative names are in the header's folder.
std::vector<std::filesystem::path> data_files(const Fields& fields, const std::string& data,
                                              const std::filesystem::path& path);

}  // namespace palpate
