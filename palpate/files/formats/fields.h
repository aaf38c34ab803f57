#pragma once
#include <filesystem>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace palpate {

/// The text that an NRRD or a MetaImage file begins with: fields, one a line.
struct Fields {
    std::string first;                       // the first line
    std::map<std::string, std::string> all;  // by name, in small letters and without blanks
    std::vector<std::string> files;          // the lines behind a field that is a LIST

    bool has(const std::string& name) const { return all.contains(name); }
    /// What a field says; "" where it is missing.
    std::string operator[](const std::string& name) const;
    /// The numbers in it, `nan` for one that is unknown. Throws Error on a word that is none, or if there are
    /// fewer than `least`; empty where the field is missing.
    std::vector<double> numbers(const std::string& name, std::size_t least,
                                const std::filesystem::path& path) const;
};

/// Reads as far as the field `last`, or an empty line if that is "", or the end of the file; if a field is
/// `LIST`, to the end. Throws Error if that is longer than any header.
Fields read_fields(std::istream& in, char separator, const std::string& last,
                   const std::filesystem::path& path);

/// The files that a header names for its voxels: one, those of a list, or those of a pattern with numbers
/// ("slice%03d.raw 1 90 1"). They lie in the header's folder unless they say otherwise.
std::vector<std::filesystem::path> data_files(const Fields& fields, const std::string& data,
                                              const std::filesystem::path& path);

}  // namespace palpate
