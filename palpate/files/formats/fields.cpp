#include "palpate/files/formats/fields.h"

#include "palpate/files/formats/source.h"
#include "palpate/files/formats/volumes.h"

#include <fmt/format.h>

#include <algorithm>
#include <istream>
#include <optional>
#include <sstream>

namespace palpate {
namespace {

constexpr std::size_t longest_header = 1 << 20;
constexpr double most_files = 1 << 16, largest_number = 1e9;

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
    return first == std::string::npos ? "" : text.substr(first, last + 1 - first);
}

// Nothing at the end of the file. `left`: how many more characters a header may have.
std::optional<std::string> next_line(std::istream& in, std::size_t& left, const std::filesystem::path& path) {
    std::string line;
    char c;
    while (in.get(c)) {
        if (left-- == 0) refuse("a header without an end", path);
        if (c == '\n') return line;
        line += c;
    }
    return line.empty() ? std::nullopt : std::optional(line);
}

bool is_list(const std::string& value) { return lower_case(value).starts_with("list"); }

// "slice%03d.raw" with a number in its place. Nothing if the pattern holds anything but one number.
std::optional<std::string> numbered(const std::string& pattern, int number) {
    const std::size_t at = pattern.find('%'), end = pattern.find_first_not_of("0123456789", at + 1);
    if (end == std::string::npos || pattern[end] != 'd' || pattern.find('%', end) != std::string::npos)
        return std::nullopt;
    const std::string width = pattern.substr(at + 1, end - at - 1);
    if (width.size() > 3) return std::nullopt;
    const int letters = width.empty() ? 0 : std::stoi(width);
    const std::string digits = width.starts_with('0') ? fmt::format("{:0{}}", number, letters)
                                                      : fmt::format("{:{}}", number, letters);
    return pattern.substr(0, at) + digits + pattern.substr(end + 1);
}

std::vector<std::string> of_pattern(const std::string& data, const std::filesystem::path& path) {
    std::string_view rest = data;
    const std::string pattern(word(rest));
    double range[3] = {0, 0, 1};  // from, to, step
    for (double& number : range)
        if (const auto value = parse_number(word(rest))) number = *value;
    const auto is_number = [](double n) { return is_whole(n, -largest_number, largest_number); };
    std::vector<std::string> names;
    const double count = (range[1] - range[0]) / range[2] + 1;
    if (std::ranges::all_of(range, is_number) && count >= 1 && count <= most_files)
        for (int i = 0; i < int(count); ++i)
            if (const auto name = numbered(pattern, int(range[0] + i * range[2]))) names.push_back(*name);
    if (names.empty()) refuse("an invalid pattern of file names, " + in_quotes(data) + ",", path);
    return names;
}

// The file of this name beside another. Windows writes "sub\slice.raw".
std::filesystem::path beside(const std::filesystem::path& path, const std::string& name) {
    const std::filesystem::path folder = path.parent_path();
    std::string slashed = name;
    std::ranges::replace(slashed, '\\', '/');
    const bool by_windows =
        !std::filesystem::exists(folder / name) && std::filesystem::exists(folder / slashed);
    return folder / (by_windows ? slashed : name);
}

}  // namespace

std::string Fields::operator[](const std::string& name) const {
    const auto found = all.find(name);
    return found == all.end() ? "" : found->second;
}

std::vector<double> Fields::numbers(const std::string& name, std::size_t least,
                                    const std::filesystem::path& path) const {
    std::vector<double> numbers;
    const std::string text = (*this)[name];
    std::string_view rest = text;
    for (std::string_view one = word(rest); !one.empty(); one = word(rest)) {
        const auto number = parse_number(one);
        if (!number) refuse(fmt::format("{} instead of a number in \"{}\"", in_quotes(one), name), path);
        numbers.push_back(*number);
    }
    if (has(name) && numbers.size() < least)
        refuse(fmt::format("{} numbers for \"{}\" instead of {}", numbers.size(), name, least), path);
    return numbers;
}

Fields read_fields(std::istream& in, char separator, const std::string& last,
                   const std::filesystem::path& path) try {
    Fields fields;
    std::size_t left = longest_header;
    bool list = false;
    for (auto line = next_line(in, left, path); line; line = next_line(in, left, path)) {
        const std::string text = trimmed(*line);
        if (fields.first.empty()) fields.first = text;
        if (list) {
            if (!text.empty()) fields.files.push_back(text);
            continue;
        }
        if (text.empty() && last.empty()) break;
        const std::size_t at = text.find(separator);
        if (text.starts_with('#') || at == std::string::npos) continue;
        if (separator == ':' && text.substr(at).starts_with(":=")) continue;  // the user's own
        std::string name = lower_case(text.substr(0, at));
        std::erase_if(name, [](char c) { return c == ' ' || c == '\t'; });
        fields.all[name] = trimmed(text.substr(at + 1));
        list = (name == "datafile" || name == "elementdatafile") && is_list(fields.all[name]);
        if (name == last && !list) break;
    }
    return fields;
} catch (const std::ios_base::failure&) {
    refuse("a truncated or damaged gzip", path, "get the file again");
}

std::vector<std::filesystem::path> data_files(const Fields& fields, const std::string& data,
                                              const std::filesystem::path& path) {
    std::vector<std::string> names = {data};
    if (is_list(data))
        names = fields.files;
    else if (data.find('%') != std::string::npos)
        names = of_pattern(data, path);
    if (names.empty()) refuse("an empty list of files", path);
    std::vector<std::filesystem::path> files;
    for (const std::string& name : names) files.push_back(beside(path, name));
    return files;
}

}  // namespace palpate
