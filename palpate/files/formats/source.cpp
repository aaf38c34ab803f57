#include "palpate/files/formats/source.h"

#include "palpate/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

namespace palpate {

namespace {

// Whether a relative path stays within its folder.
bool stays_below(const std::filesystem::path& path) {
    const std::filesystem::path plain = path.lexically_normal();
    return plain.is_relative() && plain.has_filename() && *plain.begin() != ".." && plain != ".";
}

std::optional<double> spelled_by_microsoft(std::string_view word) {
    const bool negative = word.starts_with('-');
    if (negative) word.remove_prefix(1);
    if (!word.starts_with("1.#")) return {};
    word.remove_prefix(3);
    const double infinity = std::numeric_limits<double>::infinity();
    if (word.starts_with("INF")) return negative ? -infinity : infinity;
    for (std::string_view name : {"IND", "QNAN", "SNAN"})
        if (word.starts_with(name)) return std::numeric_limits<double>::quiet_NaN();
    return {};
}

}  // namespace

Source::Source(std::string_view bytes, std::string name, std::filesystem::path folder)
    : rest(bytes), whole_(bytes), name_(std::move(name)), folder_(std::move(folder)) {}

std::optional<std::filesystem::path> Source::beside(std::string_view uri) const {
    if (folder_.empty()) return {};
    std::string slashed(uri);  // with slashes instead of Windows' backslashes
    std::replace(slashed.begin(), slashed.end(), '\\', '/');
    for (const std::string& name : {percent_decoded(uri), std::string(uri), percent_decoded(slashed)}) {
        if (name.empty() || name.find('\0') != std::string::npos || !stays_below(name)) continue;
        std::error_code none;
        if (std::filesystem::is_regular_file(folder_ / name, none)) return folder_ / name;
    }
    return {};
}

double Source::lines_with_words(double most) const {
    Source ahead = *this;
    double count = 0;
    while (count < most && !ahead.rest.empty()) {
        std::string_view line = before_comment(ahead.line());
        if (!word(line).empty()) ++count;
    }
    return count;
}

std::string_view Source::line() {
    const auto end = std::ranges::find_if(rest, [](char c) { return c == '\n' || c == '\r'; });
    const std::string_view taken = rest.substr(0, std::size_t(end - rest.begin()));
    rest.remove_prefix(taken.size());
    rest.remove_prefix(rest.starts_with("\r\n") ? 2 : rest.empty() ? 0 : 1);
    return taken;
}

void Source::skip_mark() {
    if (rest.starts_with("\xff\xfe") || rest.starts_with("\xfe\xff"))
        broken("text in UTF-16", "save it as UTF-8");
    if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);
}

void Source::broken(std::string_view what, std::string_view remedy) const {
    throw Error(what, name_, remedy);
}

void Source::broken_here(std::string_view what) const {
    Source read(whole_.substr(0, whole_.size() - rest.size()), name_);
    std::size_t lines = 0;
    for (; !read.rest.empty(); read.line()) ++lines;
    broken(fmt::format("{} in line {}", what, lines));
}

void Source::not_a_number(std::string_view word) const {
    std::string point(word);
    std::replace(point.begin(), point.end(), ',', '.');
    if (point != word && parse_number(point))
        broken("a decimal comma, " + in_quotes(word) + ",", "export it with decimal points");
    broken_here(word.empty() ? "too few numbers" : in_quotes(word) + " instead of a number");
}

double Source::number(std::string_view word) const {
    if (const auto value = parse_number(word)) return *value;
    not_a_number(word);
}

std::string_view word(std::string_view& text, std::string_view space) {
    text.remove_prefix(std::min(text.find_first_not_of(space), text.size()));
    std::string_view taken = text.substr(0, text.find_first_of(space));
    text.remove_prefix(taken.size());
    return taken;
}

std::string_view until(char end, std::string_view& text) {
    std::string_view taken = text.substr(0, text.find(end));
    text.remove_prefix(std::min(taken.size() + 1, text.size()));
    return taken;
}

std::string_view before_comment(std::string_view text) {
    std::size_t mark = text.find('#');
    while (mark != std::string_view::npos && mark > 0 && text[mark - 1] == '.')
        mark = text.find('#', mark + 1);
    return text.substr(0, mark);
}

std::string percent_decoded(std::string_view uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned byte = 0;
        const char* const digits = uri.data() + i + 1;
        const bool encoded = uri[i] == '%' && i + 2 < uri.size() &&
                             std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2;
        text += encoded ? char(byte) : uri[i];
        if (encoded) i += 2;
    }
    return text;
}

std::optional<double> parse_number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = std::numeric_limits<double>::infinity();  // stays infinite if the number is out of range
    const char* const last = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data(), last, value);
    if (error == std::errc::invalid_argument) return {};
    if (end == last) return value;
    if (*end != 'd' && *end != 'D') return spelled_by_microsoft(word);
    std::string with_e(word);
    with_e[std::size_t(end - word.data())] = 'e';
    return with_e.find_first_of("dD") == std::string::npos ? parse_number(with_e) : std::nullopt;
}

std::string in_quotes(std::string_view text, std::size_t most) {
    std::string plain(text.substr(0, most));
    for (char& c : plain)
        if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
    return '"' + plain + (text.size() > most ? "...\"" : "\"");
}

}  // namespace palpate
