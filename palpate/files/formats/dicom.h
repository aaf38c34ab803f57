#pragma once
#include "palpate/files/formats/volumes.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpate {

// DICOM in two parts: finding a volume among slices (dicom.cpp), and reading a file with GDCM (gdcm.cpp).
// Lengths are in millimetres.

/// One image of a DICOM file, as its header describes it.
struct Slice {
    std::filesystem::path file;
    int frame = 0;  // of a file with several
    /// Why it cannot be a slice of a volume, and what to do about it; otherwise empty.
    std::string trouble, remedy;
    bool damaged = false;  // it is an incomplete slice

    std::string series;       // the identifier of its series
    std::string study;        // the identifier of its examination, and of the patient
    std::string description;  // of the series
    int number = 0;           // the scanner's numbering
    /// What may distinguish volumes in one place: time, echo, ..., each with its name, in order of
    /// preference.
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
    std::optional<dvec2> padding;     // the range of the values that mark pixels outside the image
    std::vector<std::string> doubts;  // the attributes of its header that are malformed
    std::size_t pixels_at = 0;        // the offset of its pixels in the file, bytes
};

/// Reads the headers of these files with GDCM: one slice for each image, or one with `trouble`.
std::vector<Slice> scan(const std::vector<std::filesystem::path>& files);

/// The values of these slices, one after the other; slope and intercept, or a table, are applied. `path`: for
/// messages.
/// Throws Error if one is truncated, damaged, or compressed in a way that GDCM does not know.
std::vector<float> read_pixels(const std::vector<Slice>& slices, const std::filesystem::path& path);

/// The slices of one volume, from the lowest to the highest, and their grid.
struct Stack {
    std::vector<Slice> slices;
    Grid grid;
};

/// Finds the volume among slices: that of the file `named` or, if that is empty, the largest of the only
/// series. `notes` gets a line on what was skipped and assumed. Throws Error if there are several series,
/// with a list, or if the slices are not evenly spaced and aligned.
Stack stack(const std::vector<Slice>& all, const std::filesystem::path& named,
            const std::filesystem::path& path, std::vector<std::string>& notes);

}  // namespace palpate
