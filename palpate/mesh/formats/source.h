#pragma once
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace palpate {

/// A file's bytes, as far as they are not yet read, and the name under which to complain about them.
class Source {
 public:
    Source(std::string_view bytes, std::string name);

    std::string_view rest;  // readers take from its front

    std::string_view whole() const { return whole_; }
    const std::string& name() const { return name_; }

    /// Skips the mark with which an UTF-8 text may begin. Throws Error if the text is UTF-16.
    void skip_mark();

    /// Takes off the next line, or what is left of one, with its end.
    std::string_view line();

    [[noreturn]] void broken(std::string_view what, std::string_view remedy = "export it again") const;

    /// The same, with the line up to which the text is read.
    [[noreturn]] void broken_here(std::string_view what) const;

    /// For a word that should be a number, and is none.
    [[noreturn]] void misspelled(std::string_view word) const;

    /// The finite or infinite number that a word spells. Throws Error if it spells none.
    double number(std::string_view word) const;

 private:
    std::string_view whole_;
    char end_of_line_;
    std::string name_;
};

/// Takes the next word off the text; empty at its end.
std::string_view word(std::string_view& text, std::string_view space = " \t\r\n\v\f");

/// Takes off what comes before the next `end`, and the end itself.
std::string_view until(char end, std::string_view& text);

/// The number that a whole word spells; infinite if it is out of range.
std::optional<double> spelled(std::string_view word);

inline bool is_whole(double number, double least, double most) {
    return number >= least && number <= most && number == std::floor(number);
}

/// A text from a file as a message can bear it: short, and in quotes.
std::string in_quotes(std::string_view text, std::size_t most = 60);

}  // namespace palpate
