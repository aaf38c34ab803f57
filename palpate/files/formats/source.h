#pragma once
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace palpate {

/// A file's bytes, as far as they are not yet read, the name under which to complain about them, and the
/// folder where other files that it names may lie; empty: nowhere.
class Source {
 public:
    Source(std::string_view bytes, std::string name, std::filesystem::path folder = {});

    std::string_view rest;  // readers take from its front

    std::string_view whole() const { return whole_; }
    const std::string& name() const { return name_; }

    /// The other file that the one being read names by `uri`: percent-encoded or not, in the same folder or
    /// one below. Nothing if there is no such file, or if it would lie elsewhere.
    std::optional<std::filesystem::path> beside(std::string_view uri) const;

    /// Skips the mark with which an UTF-8 text may begin. Throws Error if the text is UTF-16.
    void skip_mark();

    /// Takes off the next line, or what is left of one, with its end: \n, \r\n or \r.
    std::string_view line();

    /// How many of the lines to come have a word that is no comment (#). Stops counting at `most`.
    double lines_with_words(double most) const;

    [[noreturn]] void broken(std::string_view what, std::string_view remedy = "export it again") const;

    /// The same, with the line up to which the text is read.
    [[noreturn]] void broken_here(std::string_view what) const;

    /// For a word that should be a number, and is none.
    [[noreturn]] void misspelled(std::string_view word) const;

    /// The finite or infinite number that a word spells. Throws Error if it spells none.
    double number(std::string_view word) const;

 private:
    std::string_view whole_;
    std::string name_;
    std::filesystem::path folder_;
};

/// Takes the next word off the text; empty at its end.
std::string_view word(std::string_view& text, std::string_view space = " \t\r\n\v\f");

/// Takes off what comes before the next `end`, and the end itself.
std::string_view until(char end, std::string_view& text);

/// A text without the comment that # begins; but "-1.#IND" is how some programs write what is no number.
std::string_view before_comment(std::string_view text);

/// What stands behind the %XX of a URI.
std::string percent_decoded(std::string_view uri);

/// The number that a whole word spells, also as Fortran (1D-3) and Microsoft (-1.#IND) do; infinite if it is
/// out of range.
std::optional<double> spelled(std::string_view word);

inline bool is_whole(double number, double least, double most) {
    return number >= least && number <= most && number == std::floor(number);
}

/// A text from a file as a message can bear it: short, and in quotes.
std::string in_quotes(std::string_view text, std::size_t most = 60);

}  // namespace palpate
