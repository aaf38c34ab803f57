#pragma once
#include "palpate/base/pose.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace palpate {

/// A place at a time, and how a thing is turned there.
struct Waypoint {
    double time;              // s
    vec3 position;            // m
    vec3 rotation = vec3(0);  // degrees about x, then y, then z

    bool operator==(const Waypoint&) const = default;
};

/// Waypoints in the order of time; between them the motion is straight and even, and rotations go evenly in
/// degrees. Before the first and after the last it stands still.
using Path = std::vector<Waypoint>;

/// Throws Error if there is no waypoint, if one is not finite, or if time does not rise; `whose` is for the
/// message.
void check(const Path& path, const std::string& whose);

bool within(const Path& path, double time);
vec3 position(const Path& path, double time);

/// Where a thing is then that was at the origin.
Pose pose(const Path& path, double time);
Pose pose(const Waypoint& point);

/// Turns by degrees about x, then y, then z.
mat3 turn(vec3 degrees);

/// What the rows of a path may hold.
enum class Rows {
    places,  // t, x, y, z
    poses,   // the same, or with a rotation: t, x, y, z, rx, ry, rz
};

/// Called with the number of a row from 0, what is wrong with it, and what to do; does not return.
using RowFails = std::function<void(std::size_t row, const std::string& what, const std::string& remedy)>;

/// A path of rows of finite numbers: time rises, and all rows are as long as the first.
Path make_path(const std::vector<std::vector<double>>& rows, Rows kind, const RowFails& fail);

/// Reads such rows in s, m and degrees, separated by commas, or by semicolons or tabs, and then numbers may
/// have decimal commas; a first line of words is skipped. Throws Error with the line's number where one does
/// not fit.
Path read_path(const std::filesystem::path& file, Rows kind = Rows::places);

}  // namespace palpate
