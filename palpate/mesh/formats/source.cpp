#include "palpate/mesh/formats/source.h"

#include "palpate/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

namespace palpate {

Source::Source(std::string_view bytes, std::string name)
    : rest(bytes),
      whole_(bytes),
      end_of_line_(bytes.find('\n') == std::string_view::npos ? '\r' : '\n'),
      name_(std::move(name)) {}

std::string_view Source::line() { return until(end_of_line_, rest); }

void Source::skip_mark() {
    if (rest.starts_with("\xff\xfe") || rest.starts_with("\xfe\xff"))
        broken("text in UTF-16", "save it as UTF-8");
    if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);
}

void Source::broken(std::string_view what, std::string_view remedy) const {
    throw Error(what, name_, remedy);
}

void Source::broken_here(std::string_view what) const {
    const auto read = whole_.substr(0, whole_.size() - rest.size());
    const auto lines =
        std::count(read.begin(), read.end(), end_of_line_) + (read.ends_with(end_of_line_) ? 0 : 1);
    broken(fmt::format("{} in line {}", what, lines));
}

void Source::misspelled(std::string_view word) const {
    std::string point(word);
    std::replace(point.begin(), point.end(), ',', '.');
    if (point != word && spelled(point))
        broken("a decimal comma, " + in_quotes(word) + ",", "export it with decimal points");
    broken_here(word.empty() ? "too few numbers" : in_quotes(word) + " for a number");
}

double Source::number(std::string_view word) const {
    if (const auto value = spelled(word)) return *value;
    misspelled(word);
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

std::optional<double> spelled(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = std::numeric_limits<double>::infinity();  // stays so where the number is out of range
    auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::invalid_argument || end != word.data() + word.size()) return {};
    return value;
}

std::string in_quotes(std::string_view text, std::size_t most) {
    std::string plain(text.substr(0, most));
    for (char& c : plain)
        if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
    return '"' + plain + (text.size() > most ? "...\"" : "\"");
}

}  // namespace palpate
