#include "palpate/mesh/formats/formats.h"

#include <fmt/format.h>

namespace palpate {
namespace {

class Off {
 public:
    explicit Off(Source source) : source_(std::move(source)) {}

    Draft read() {
        source_.skip_mark();
        std::string_view first = next();
        const bool headed = first.ends_with("OFF"), normals = headed && read_header(first);
        if (headed) first = next();
        if (!headed && !spelled(first)) source_.broken("no OFF header");  // to begin with numbers is allowed
        const double vertices = count(first, "vertices"), faces = count(next(), "faces");
        source_.line();  // where the number of edges is, which nobody keeps right
        for (double i = 0; i < vertices; ++i) {
            draft_.positions.push_back(vector());
            if (normals) draft_.normals.push_back(vector());
            source_.line();  // colours, places in a texture
        }
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
            source_.line();  // its colour
        }
        return std::move(draft_);
    }

 private:
    // [ST][C][N][4][n]OFF, with what each vertex has besides. Returns whether that is a normal.
    bool read_header(std::string_view header) {
        std::string_view has = header.substr(0, header.size() - 3);
        auto takes = [&](std::string_view prefix) {
            const bool found = has.starts_with(prefix);
            if (found) has.remove_prefix(prefix.size());
            return found;
        };
        takes("ST"), takes("C");
        const bool normals = takes("N");
        if (!has.empty())
            source_.broken("the header " + in_quotes(header) + ", which is not of three dimensions,",
                           "export it as plain OFF");
        std::string_view ahead = source_.rest;
        if (word(ahead) == "BINARY") source_.broken("a binary OFF", "export it as text");
        return normals;
    }

    // The next word that is not in a comment.
    std::string_view next() {
        for (;;) {
            const std::string_view text = source_.rest, found = word(source_.rest);
            const std::size_t comment = found.find('#');
            if (comment == std::string_view::npos) return found;
            source_.rest = text.substr(std::size_t(found.data() - text.data()) + comment);
            source_.line();
            if (comment > 0) return found.substr(0, comment);
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

    double count(std::string_view found, std::string_view what) const {
        const auto number = spelled(found);
        if (!number || !is_whole(*number, 0, 0xfffffffep0))
            source_.broken(fmt::format("no number of {}", what));
        return *number;
    }

    Source source_;
    Draft draft_;
};

}  // namespace

Draft read_off(Source source) { return Off(std::move(source)).read(); }

}  // namespace palpate
