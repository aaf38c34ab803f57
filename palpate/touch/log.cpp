#include "palpate/touch/log.h"

#include "palpate/base/error.h"
#include "palpate/base/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace palpate {
namespace {

constexpr std::string_view version = "# palpate log ";
constexpr std::string_view device = "# device ";
constexpr std::string_view rate = "# rate ";
// The columns of version 2; and of version 1, which had no orientations.
constexpr std::string_view columns = "now,time,x,y,z,qw,qx,qy,qz,buttons,placed,fx,fy,fz,tx,ty,tz";
constexpr std::string_view columns_without_turns = "now,time,x,y,z,buttons,placed,fx,fy,fz";

// Parses a text line by line, and a line number by number.
class LogLines {
 public:
    LogLines(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

    // False at the end.
    bool next() {
        if (rest_.empty()) return false;
        ++number_;
        const std::size_t end = rest_.find('\n');
        line_ = rest_.substr(0, end);
        rest_.remove_prefix(end == rest_.npos ? rest_.size() : end + 1);
        if (line_.ends_with('\r')) line_.remove_suffix(1);
        return true;
    }

    bool blank() const { return line_.find_first_not_of(" \t") == line_.npos; }

    // Reads the next line, which must be `text`.
    void exactly(std::string_view text) {
        if (!heading(text).empty()) fail(fmt::format("is not \"{}\"", text));
    }

    // The rest of the next line, which must begin like this.
    std::string_view heading(std::string_view begin) {
        if (!next()) ++number_, line_ = {};
        if (!line_.starts_with(begin)) fail(fmt::format("is not \"{}\"", begin));
        line_.remove_prefix(begin.size());
        return line_;
    }

    // Numbers separated by commas, up to the end of the line.
    template <class... Number>
    void numbers(Number&... values) {
        std::size_t left = sizeof...(values);
        const bool all = (number(values, --left == 0) && ...);
        if (!all)
            fail(sizeof...(values) == 1
                     ? "is not a number"
                     : fmt::format("is not {} numbers separated by commas", sizeof...(values)));
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw Error(fmt::format("line {} {}", number_, what), name_,
                    "give it a log as docs/devices.md describes it");
    }

 private:
    // False if there is none, or if it is not followed by a comma or, after the last, by the end of the line.
    template <class Number>
    bool number(Number& value, bool last) {
        const char* const end = line_.data() + line_.size();
        const auto [stop, error] = std::from_chars(line_.data(), end, value);
        if (error != std::errc() || (last ? stop != end : stop == end || *stop != ',')) return false;
        line_.remove_prefix(std::size_t(stop - line_.data()) + !last);
        return true;
    }

    std::string_view rest_, line_;
    int number_ = 0;
    const std::string& name_;
};

}  // namespace

void write_log(const std::filesystem::path& file, const Log& log) {
    std::string name = log.device;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    write_file(file, [&](std::FILE* out) {
        fmt::print(out, "{}2\n{}{}\n{}{}\n{}\n", version, device, name, rate, log.rate, columns);
        for (const Tick& t : log.ticks) {
            const auto& [place, turn] = t.state.pose;
            const auto& [force, torque] = t.wrench;
            fmt::print(out, "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", t.now, t.state.time,
                       place.x, place.y, place.z, turn.w, turn.x, turn.y, turn.z, t.state.buttons,
                       t.state.placed, force.x, force.y, force.z, torque.x, torque.y, torque.z);
        }
    });
}

namespace {

Tick numbers(LogLines& lines) {
    Tick t;
    auto& [place, turn] = t.state.pose;
    auto& [force, torque] = t.wrench;
    lines.numbers(t.now, t.state.time, place.x, place.y, place.z, turn.w, turn.x, turn.y, turn.z,
                  t.state.buttons, t.state.placed, force.x, force.y, force.z, torque.x, torque.y, torque.z);
    return t;
}

// Positions were in single precision then.
Tick numbers_without_turns(LogLines& lines) {
    Tick t;
    vec3 place, &force = t.wrench.force;
    lines.numbers(t.now, t.state.time, place.x, place.y, place.z, t.state.buttons, t.state.placed, force.x,
                  force.y, force.z);
    t.state.pose.place = dvec3(place);
    return t;
}

}  // namespace

Log parse_log(std::string_view text, const std::string& name) {
    LogLines lines(text, name);
    const std::string_view number = lines.heading(version);
    if (number != "1" && number != "2") lines.fail("is a version that is not 1 or 2");
    const bool turns = number == "2";
    Log log;
    log.device = lines.heading(device);
    lines.heading(rate);
    lines.numbers(log.rate);
    if (!(log.rate > 0 && std::isfinite(log.rate))) lines.fail("has a rate that is not above 0");
    lines.exactly(turns ? columns : columns_without_turns);
    while (lines.next()) {
        if (lines.blank()) continue;
        const Tick t = turns ? numbers(lines) : numbers_without_turns(lines);
        if (!std::isfinite(t.now) || !std::isfinite(t.state.time))
            lines.fail("has a time that is not a number");
        if (!log.ticks.empty() && t.now < log.ticks.back().now) lines.fail("goes back in time");
        log.ticks.push_back(t);
    }
    return log;
}

Log read_log(const std::filesystem::path& file) { return parse_log(read_text(file), file.string()); }

}  // namespace palpate
