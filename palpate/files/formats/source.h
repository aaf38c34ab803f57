#pragma once
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace palpate {

/// The unread bytes of a file, its name for messages, and the folder where the other files to which it refers
/// may be; empty: none.
class Source {
 public:
    Source(std::string_view bytes, std::string name, std::filesystem::path folder = {});

    std::string_view rest;  // readers consume it from the front

    std::string_view whole() const { return whole_; }
    const std::string& name() const { return name_; }

    /// The other file to which `uri` refers, percent-encoded or not, in the same folder or below. Nothing if
    /// there is no such file, or if it would be elsewhere.
    std::optional<std::filesystem::path> beside(std::string_view uri) const;

    /// Skips a UTF-8 byte order mark. Throws Error if the text is UTF-16.
    void skip_mark();

    /// Consumes the next line, or the rest of one, with its end: \n, \r\n or \r.
    std::string_view line();

    /// How many of the remaining lines have a word outside comments (#). Stops counting at `most`.
    double lines_with_words(double most) const;

    [[noreturn]] void broken(std::string_view what, std::string_view remedy = "export it again") const;

    /// The same, with the number of the present line.
    [[noreturn]] void broken_here(std::string_view what) const;

    /// For a word that should be a number but is not.
    [[noreturn]] void not_a_number(std::string_view word) const;

    /// The finite or infinite number that a word spells. Throws Error if it is not a number.
    double number(std::string_view word) const;

 private:
    std::string_view whole_;
    std::string name_;
    std::filesystem::path folder_;
};

/// Consumes the next word of the text; empty at its end.
std::string_view word(std::string_view& text, std::string_view space = " \t\r\n\v\f");

/// Consumes the text up to and including the next `end`; returns it without that.
std::string_view until(char end, std::string_view& text);

/// A text without the comment that # begins; but "-1.#IND" is NaN as some programs write it.
std::string_view before_comment(std::string_view text);

/// Decodes the %XX of a URI.
std::string percent_decoded(std::string_view uri);

/// Parses a whole word as a number, also in the styles of Fortran (1D-3) and Microsoft (-1.#IND); infinite if
/// it is out of range.
std::optional<double> parse_number(std::string_view word);

inline bool is_whole(double number, double least, double most) {
    return number >= least && number <= most && number == std::floor(number);
}

/// A text from a file for a message: shortened, and in quotes.
std::string in_quotes(std::string_view text, std::size_t most = 60);

}  // namespace palpate
