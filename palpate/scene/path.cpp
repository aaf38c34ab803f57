#include "palpate/scene/path.h"

#include "palpate/base/error.h"
#include "palpate/base/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

namespace palpate {
namespace {

// The numbers of a row; empty if any of its words is not a finite number.
std::vector<double> numbers(const std::string& row) {
    std::vector<double> values;
    std::istringstream words(row);
    for (std::string word; std::getline(words, word, ',');) {
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

bool within(const Path& path, double time) {
    return !path.empty() && time >= path.front().time && time <= path.back().time;
}

vec3 position(const Path& path, double time) {
    const auto next = std::upper_bound(path.begin(), path.end(), time,
                                       [](double t, const Waypoint& w) { return t < w.time; });
    if (next == path.begin()) return path.front().position;
    if (next == path.end()) return path.back().position;
    const auto last = next - 1;
    const double part = (time - last->time) / (next->time - last->time);
    return glm::mix(last->position, next->position, float(part));
}

Path read_path(const std::filesystem::path& file) {
    Path path;
    std::istringstream lines(read_text(file));
    int line = 0;
    for (std::string row; std::getline(lines, row);) {
        if (++line == 1 && row.starts_with("\xef\xbb\xbf")) row.erase(0, 3);  // a byte-order mark
        if (row.find_first_not_of(" \t\r,") == std::string::npos) continue;
        const std::vector<double> v = numbers(row);
        if (line == 1 && row.find_first_of("0123456789") == std::string::npos) continue;  // a heading
        if (v.size() != 4)
            throw Error(fmt::format("line {} is not four numbers", line), file.string(),
                        "write t, x, y, z in s and m");
        if (!path.empty() && v[0] <= path.back().time)
            throw Error(fmt::format("line {} goes back in time", line), file.string(),
                        "sort the rows by time");
        path.push_back({v[0], vec3(v[1], v[2], v[3])});
        if (!(glm::length(path.back().position) < 1e6f))
            throw Error(fmt::format("line {} leads out of the world", line), file.string(),
                        "keep it within 1000 km");
    }
    if (path.empty()) throw Error("no waypoint", file.string(), "write rows of t, x, y, z in s and m");
    return path;
}

}  // namespace palpate
