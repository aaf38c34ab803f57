#pragma once
#include "palpate/files/formats/volumes.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpate {

// DICOM in two parts: what is a volume among the slices that lie about (dicom.cpp), and what GDCM knows of a
// file (gdcm.cpp). Lengths are in millimetres.

/// One picture of a DICOM file, as far as its header tells.
struct Slice {
    std::filesystem::path file;
    int frame = 0;  // of a file with several
    /// Why it is no slice of any volume, and what to do with it; else empty.
    std::string trouble, remedy;
    bool damaged = false;  // it would be one, were it whole

    std::string series;       // what slices of one series share
    std::string study;        // what series of one examination share, with the patient
    std::string description;  // of the series
    int number = 0;           // the scanner's own count
    /// What may part volumes in one place: time, echo, ..., each with its name, in the order of preference.
    std::vector<std::pair<std::string, std::string>> marks;

    ivec2 size = ivec2(0);
    dvec2 spacing = dvec2(1);    // from column to column, from row to row
    std::string spacing_source;  // the attribute that states it; empty: none does
    std::optional<dmat3> direction;
    std::optional<dvec3> position;
    double rounding = 0;                // of the position: its last decimal place
    std::optional<double> location;     // along the stack, where there is no position
    double thickness = 0, between = 0;  // of slices; 0: not stated

    double slope = 1, intercept = 0;
    std::optional<dvec2> padding;     // the least and the most of what is outside the picture, as values
    std::vector<std::string> doubts;  // what its header says in a way that cannot be taken as it stands
    std::size_t pixels_at = 0;        // byte of the file at which its pixels begin
};

/// What GDCM finds in the headers of these files: one slice a picture, or one with `trouble`.
std::vector<Slice> scan(const std::vector<std::filesystem::path>& files);

/// The values of these slices, one after the other; slope and intercept, or a table, are applied. `path`: for
/// messages.
/// Throws Error if one is truncated, damaged, or packed in a way that GDCM does not know.
std::vector<float> read_pixels(const std::vector<Slice>& slices, const std::filesystem::path& path);

/// Slices of one volume, from the lowest to the highest, and where they lie.
struct Stack {
    std::vector<Slice> slices;
    Grid grid;
};

/// The volume among slices: that of `named`, a file, or if it is empty the only series' largest. `notes` gets
/// a line on what is left out and what was assumed. Throws Error, with a list of the series, if there are
/// several; or if the slices do not lie evenly and straight above each other.
Stack stack(const std::vector<Slice>& all, const std::filesystem::path& named,
            const std::filesystem::path& path, std::vector<std::string>& notes);

}  // namespace palpate
