#include "palpate/files/formats/formats.h"

#include <fmt/format.h>

#include <algorithm>

namespace palpate {
namespace {

class Off {
 public:
    explicit Off(Source source) : source_(std::move(source)) {}

    Draft read() {
        source_.skip_mark();
        if (!parse_number(peek())) read_header();  // to begin with the counts is allowed
        const double vertices = count("vertices"), faces = count("faces");
        read_edges(vertices, vertices + faces);
        for (double i = 0; i < vertices; ++i) {
            draft_.positions.push_back(vector());
            if (normals_) draft_.normals.push_back(vector());
            end_row(more_);
        }
        // Vertices may share lines where faces do not.
        rows_are_lines_ = rows_are_lines_ || source_.lines_with_words(faces) >= faces;
        for (double i = 0; i < faces; ++i) {
            const double size = number();
            if (!is_whole(size, 0, 0x7fffffffp0))
                source_.broken_here(fmt::format("a face of {} corners", size));
            for (double k = 0; k < size; ++k) {
                const double corner = number();
                if (!is_whole(corner, 0, vertices - 1))
                    source_.broken_here(
                        fmt::format("a face naming vertex {} of {}, counted from 0,", corner, vertices));
                draft_.corners.push_back(Index(corner));
            }
            draft_.sizes.push_back(Index(size));
            end_row(0);
        }
        if (!rows_are_lines_ && !next().empty()) source_.broken("more numbers than the counts promise");
        return std::move(draft_);
    }

 private:
    // [ST][C][N][4][n]OFF, with what each vertex has besides; the counts may follow without a space.
    void read_header() {
        const std::string_view text = source_.rest, first = next();
        const std::size_t off = std::min({first.find("OFF"), first.find("off"), first.find("Off")});
        if (off == std::string_view::npos) source_.broken("no OFF header");
        std::string_view has = first.substr(0, off);
        source_.rest = text.substr(std::size_t(first.data() - text.data()) + off + 3);
        auto takes = [&](std::string_view prefix) {
            const bool found = has.starts_with(prefix);
            if (found) has.remove_prefix(prefix.size());
            return found;
        };
        if (takes("ST")) more_ += 2;
        if (takes("C")) more_ += 4;
        normals_ = takes("N");
        if (!has.empty())
            source_.broken("the header " + in_quotes(first) + ", which is not of three dimensions,",
                           "export it as plain OFF");
        if (peek() == "BINARY") source_.broken("a binary OFF, which is not read,", "export it as text");
    }

    // The number of edges, which is often wrong or missing: after the other counts, or on a line of its own.
    // If there are enough lines, each row is a line, and may end with colours; otherwise rows are read word
    // by word.
    void read_edges(double vertices, double rows) {
        Source ahead = source_;
        std::string_view here = before_comment(ahead.line());
        const bool with_counts = !word(here).empty();
        rows_are_lines_ = ahead.lines_with_words(rows) >= rows && each_line_has_a_vertex(ahead, vertices);
        if (with_counts) {
            next();
            if (rows_are_lines_) source_.line();
        } else if (next_line_has_one_word()) {
            next();
        }
    }

    // Whether so many lines have the numbers of a vertex each.
    bool each_line_has_a_vertex(Source ahead, double vertices) const {
        const int least = normals_ ? 6 : 3;
        for (double i = 0; i < vertices && !ahead.rest.empty();) {
            std::string_view line = before_comment(ahead.line());
            int words = 0;
            while (words < least && !word(line).empty()) ++words;
            if (words > 0 && words < least) return false;
            if (words > 0) ++i;
        }
        return true;
    }

    bool next_line_has_one_word() const {
        for (Source ahead = source_; !ahead.rest.empty();) {
            std::string_view line = before_comment(ahead.line());
            if (!word(line).empty()) return word(line).empty();
        }
        return false;
    }

    void end_row(int words) {
        if (rows_are_lines_)
            source_.line();
        else
            for (int k = 0; k < words; ++k) next();
    }

    std::string_view peek() {
        const std::string_view here = source_.rest, found = next();
        source_.rest = here;
        return found;
    }

    // The next word that is not in a comment.
    std::string_view next() {
        for (;;) {
            const std::string_view text = source_.rest, found = word(source_.rest),
                                   plain = before_comment(found);
            if (plain.size() == found.size()) return found;
            source_.rest = text.substr(std::size_t(found.data() - text.data()) + plain.size());
            source_.line();
            if (!plain.empty()) return plain;
        }
    }

    double number() {
        const std::string_view found = next();
        if (found.empty()) source_.broken("fewer vertices or faces than promised: truncated");
        return source_.number(found);
    }

    dvec3 vector() {
        const double x = number(), y = number(), z = number();
        return {x, y, z};
    }

    double count(std::string_view what) {
        const auto number = parse_number(next());
        if (!number || !is_whole(*number, 0, 0xfffffffep0))
            source_.broken(fmt::format("no number of {}", what));
        return *number;
    }

    Source source_;
    bool normals_ = false, rows_are_lines_ = false;
    int more_ = 0;  // numbers that each vertex has besides
    Draft draft_;
};

}  // namespace

Draft read_off(Source source) { return Off(std::move(source)).read(); }

}  // namespace palpate
