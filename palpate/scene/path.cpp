#include "palpate/scene/path.h"

#include "palpate/base/error.h"
#include "palpate/base/files.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

namespace palpate {
namespace {

// The numbers of a row; empty if any of its words is not a finite number. Between semicolons or tabs, as many
// European spreadsheets write them, a comma is a decimal point.
std::vector<double> numbers(std::string row) {
    const char between = row.find(';') != row.npos ? ';' : row.find('\t') != row.npos ? '\t' : ',';
    if (between != ',') std::replace(row.begin(), row.end(), ',', '.');
    std::vector<double> values;
    std::istringstream words(row);
    for (std::string word; std::getline(words, word, between);) {
        const auto from = word.find_first_not_of(" \t"), to = word.find_last_not_of(" \t\r");
        if (from == std::string::npos) return {};
        double value = 0;
        const char *first = word.data() + from, *last = word.data() + to + 1;
        const auto [end, error] = std::from_chars(first, last, value);
        if (error != std::errc() || end != last || !std::isfinite(value)) return {};
        values.push_back(value);
    }
    return values;
}

}  // namespace

void check(const Path& path, const std::string& whose) {
    if (path.empty()) throw Error("no waypoint", whose, "give it a path with at least one");
    for (std::size_t i = 0; i < path.size(); ++i) {
        const vec3 p = path[i].position, r = path[i].rotation;
        if (!std::isfinite(path[i].time) || !std::isfinite(p.x + p.y + p.z + r.x + r.y + r.z))
            throw Error(fmt::format("waypoint {} is not a number", i + 1), whose, "give finite ones");
        if (i > 0 && !(path[i].time > path[i - 1].time))
            throw Error(fmt::format("waypoint {} is not later than the one before", i + 1), whose,
                        "give them in the order of time");
    }
}

bool within(const Path& path, double time) {
    return !path.empty() && time >= path.front().time && time <= path.back().time;
}

namespace {

dmat3 turned(vec3 degrees) {
    const dvec3 angle = glm::radians(dvec3(degrees));
    glm::dmat4 turned(1);
    for (int axis : {2, 1, 0}) {
        dvec3 about(0);
        about[axis] = 1;
        turned = glm::rotate(turned, angle[axis], about);
    }
    return dmat3(turned);
}

// The waypoint at a time, with its rotation in degrees.
Waypoint at(const Path& path, double time) {
    const auto next = std::upper_bound(path.begin(), path.end(), time,
                                       [](double t, const Waypoint& w) { return t < w.time; });
    if (next == path.begin()) return path.front();
    if (next == path.end()) return path.back();
    const auto last = next - 1;
    const float part = float((time - last->time) / (next->time - last->time));
    return {time, glm::mix(last->position, next->position, part),
            glm::mix(last->rotation, next->rotation, part)};
}

}  // namespace

vec3 position(const Path& path, double time) { return at(path, time).position; }

Pose pose(const Path& path, double time) { return pose(at(path, time)); }

Pose pose(const Waypoint& point) { return {dvec3(point.position), glm::quat_cast(turned(point.rotation))}; }

mat3 turn(vec3 degrees) { return mat3(turned(degrees)); }

Path make_path(const std::vector<std::vector<double>>& rows, Rows kind, const RowFails& fail) {
    const bool poses = kind == Rows::poses;
    Path path;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::vector<double>& v = rows[i];
        if (v.size() == 7 && !poses)
            fail(i, "has a rotation, which has no effect there", "keep four numbers");
        if (v.size() != 4 && v.size() != 7)
            fail(i, poses ? "is not four or seven numbers" : "is not four numbers",
                 poses ? "write t, x, y, z and, if it turns, rx, ry, rz" : "write t, x, y, z");
        if (v.size() != rows[0].size())
            fail(i, "is not as long as the first", "give all rows a rotation, or none");
        if (!path.empty() && v[0] == path.back().time)
            fail(i, "repeats the time of the row before", "give each row a time of its own");
        if (!path.empty() && v[0] < path.back().time) fail(i, "goes back in time", "sort the rows by time");
        Waypoint point{v[0], vec3(v[1], v[2], v[3])};
        if (v.size() == 7) point.rotation = vec3(v[4], v[5], v[6]);
        if (!(glm::length(point.position) < 1e6f && glm::length(point.rotation) < 1e6f))
            fail(i, "is out of range", "keep it within 1000 km and a million degrees");
        path.push_back(point);
    }
    return path;
}

Path read_path(const std::filesystem::path& file, Rows kind) {
    std::vector<std::vector<double>> rows;
    std::vector<int> lines;  // the line of each row
    std::istringstream text(read_text(file));
    int line = 0;
    for (std::string row; std::getline(text, row);) {
        if (++line == 1 && row.starts_with("\xef\xbb\xbf")) row.erase(0, 3);  // a byte-order mark
        if (row.find_first_not_of(" \t\r,;") == std::string::npos) continue;
        if (line == 1 && row.find_first_of("0123456789") == std::string::npos) continue;  // a heading
        rows.push_back(numbers(row));
        lines.push_back(line);
    }
    if (rows.empty()) throw Error("no waypoint", file.string(), "write rows of t, x, y, z in s and m");
    return make_path(rows, kind, [&](std::size_t row, const std::string& what, const std::string& remedy) {
        const bool commas = rows[row].size() > 4;  // some may be decimal commas
        throw Error(fmt::format("line {} {}", lines[row], what), file.string(),
                    remedy + (commas ? ", with decimal points, or with semicolons between numbers" : ""));
    });
}

}  // namespace palpate
