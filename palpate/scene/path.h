#pragma once
#include "palpate/base/vectors.h"

#include <filesystem>
#include <string>
#include <vector>

namespace palpate {

/// A place at a time.
struct Waypoint {
    double time;    // s
    vec3 position;  // m
};

/// Waypoints in the order of time; between them the motion is straight and even. Outside its times there is
/// none.
using Path = std::vector<Waypoint>;

bool within(const Path& path, double time);
vec3 position(const Path& path, double time);

/// Reads rows of t, x, y, z in s and m, separated by commas; a first line of words is skipped.
/// Throws Error with the line's number if a row is not four finite numbers or time does not rise.
Path read_path(const std::filesystem::path& file);

}  // namespace palpate
