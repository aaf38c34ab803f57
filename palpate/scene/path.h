#pragma once
#include "palpate/base/pose.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace palpate {

/// A pose at a time (a keyframe).
struct Waypoint {
    double time;              // s
    vec3 position;            // m
    vec3 rotation = vec3(0);  // degrees about x, then y, then z

    bool operator==(const Waypoint&) const = default;
};

/// Waypoints in order of time, with linear interpolation of positions and of rotation angles. Before the
/// first and after the last the path stands still.
using Path = std::vector<Waypoint>;

/// Throws Error if there is no waypoint, if one is not finite, or if times do not increase; `whose` is for
/// the message.
void check(const Path& path, const std::string& whose);

bool within(const Path& path, double time);
vec3 position(const Path& path, double time);

/// The rigid motion of a thing that was at the origin.
Pose pose(const Path& path, double time);
Pose pose(const Waypoint& point);

/// The rotation by degrees about x, then y, then z.
mat3 turn(vec3 degrees);

/// The columns of a path's rows.
enum class Rows {
    places,  // t, x, y, z
    poses,   // the same, or with a rotation: t, x, y, z, rx, ry, rz
};

/// Called with the index of a row, what is wrong with it, and what to do; must not return.
using RowFails = std::function<void(std::size_t row, const std::string& what, const std::string& remedy)>;

/// Makes a path of rows of finite numbers: times increase, and all rows are as long as the first.
Path make_path(const std::vector<std::vector<double>>& rows, Rows kind, const RowFails& fail);

/// Reads such rows in s, m and degrees from a CSV file: separated by commas, or by semicolons or tabs, and
/// then with decimal points or commas. A heading is skipped. Throws an Error with the line number of an
/// invalid row.
Path read_path(const std::filesystem::path& file, Rows kind = Rows::places);

}  // namespace palpate
