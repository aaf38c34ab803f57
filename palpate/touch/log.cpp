#include "palpate/touch/log.h"

#include "palpate/base/error.h"
#include "palpate/base/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace palpate {
namespace {

constexpr std::string_view version = "# palpate log 1";
constexpr std::string_view device = "# device ";
constexpr std::string_view rate = "# rate ";
constexpr std::string_view columns = "now,time,x,y,z,buttons,placed,fx,fy,fz";

// Takes a text apart line by line, and a line number by number.
class LogLines {
 public:
    LogLines(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

    // False if there is no more.
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

    // The rest of the next line, which has to begin so.
    std::string_view heading(std::string_view begin) {
        if (!next()) ++number_, line_ = {};
        if (!line_.starts_with(begin)) fail(fmt::format("is not \"{}\"", begin));
        line_.remove_prefix(begin.size());
        return line_;
    }

    // Numbers to the end of the line, with commas between.
    template <class... Number>
    void numbers(Number&... values) {
        std::size_t left = sizeof...(values);
        const bool all = (number(values, --left == 0) && ...);
        if (!all)
            fail(sizeof...(values) == 1
                     ? "is not a number"
                     : fmt::format("is not {} numbers with commas between", sizeof...(values)));
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw Error(fmt::format("line {} {}", number_, what), name_,
                    "give it a log as docs/devices.md describes it");
    }

 private:
    // False if there is none, or something else behind it than a comma or, after the last, the line's end.
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
        fmt::print(out, "{}\n{}{}\n{}{}\n{}\n", version, device, name, rate, log.rate, columns);
        for (const Tick& t : log.ticks)
            fmt::print(out, "{},{},{},{},{},{},{},{},{},{}\n", t.now, t.hand.time, t.hand.position.x,
                       t.hand.position.y, t.hand.position.z, t.hand.buttons, t.hand.placed, t.force.x,
                       t.force.y, t.force.z);
    });
}

Log parse_log(std::string_view text, const std::string& name) {
    LogLines lines(text, name);
    if (!lines.heading(version).empty()) lines.fail(fmt::format("is not \"{}\"", version));
    Log log;
    log.device = lines.heading(device);
    lines.heading(rate);
    lines.numbers(log.rate);
    if (!(log.rate > 0 && std::isfinite(log.rate))) lines.fail("has a rate that is not above 0");
    if (!lines.heading(columns).empty()) lines.fail(fmt::format("is not \"{}\"", columns));
    while (lines.next()) {
        if (lines.blank()) continue;
        Tick t;
        vec3 &at = t.hand.position, &force = t.force;
        lines.numbers(t.now, t.hand.time, at.x, at.y, at.z, t.hand.buttons, t.hand.placed, force.x, force.y,
                      force.z);
        if (!std::isfinite(t.now) || !std::isfinite(t.hand.time)) lines.fail("has a time that is no number");
        if (!log.ticks.empty() && t.now < log.ticks.back().now) lines.fail("goes back in time");
        log.ticks.push_back(t);
    }
    return log;
}

Log read_log(const std::filesystem::path& file) { return parse_log(read_text(file), file.string()); }

}  // namespace palpate
