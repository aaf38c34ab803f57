// X3D is VRML with more kinds of nodes, as XML or in VRML's syntax. So XML is translated into VRML's syntax,
// with each element on its original line, and read as such. Only what concerns surfaces is translated.
#include "palpate/files/formats/formats.h"
#include "palpate/files/formats/xml.h"

#include <fmt/format.h>

#include <cctype>
#include <map>

namespace palpate {
namespace {

// The fields that hold numbers, words or lists of them, and that the reader of VRML knows.
constexpr std::string_view number_fields[] = {
    "point",      "coordIndex",   "index",       "texCoordIndex", "stripCount",       "fanCount",
    "center",     "rotation",     "scale",       "height",        "translation",      "size",
    "xDimension", "zDimension",   "radius",      "bottomRadius",  "xSpacing",         "zSpacing",
    "spine",      "crossSection", "orientation", "whichChoice",   "scaleOrientation", "visible"};
constexpr std::string_view truth_fields[] = {"ccw", "side", "top", "bottom", "beginCap", "endCap"};

// The default containerField of a node: the field of its parent in which it is.
std::string_view field_of(std::string_view node, std::string_view parent) {
    if (node.starts_with("Metadata")) return "metadata";
    if (node == "Coordinate" || node == "CoordinateDouble" || node == "GeoCoordinate") return "coord";
    if (node.ends_with("TextureCoordinate") || node.starts_with("TextureCoordinate")) return "texCoord";
    if (parent == "Shape") return node == "Appearance" ? "appearance" : "geometry";
    return "children";
}

class X3d {
 public:
    explicit X3d(Source source) : source_(std::move(source)) {}

    std::string translated() {
        read_xml(
            source_, [&](const XmlElement& element) { return begin(element); }, [&](auto) { end(); });
        if (!is_x3d_) source_.broken("XML that is not X3D");
        return std::move(text_);
    }

 private:
    bool begin(const XmlElement& element) {
        is_x3d_ = is_x3d_ || element.name == "X3D";
        open_.push_back({std::string(element.name), false});
        for (; line_ < element.line; ++line_) text_ += '\n';
        if (skipped_ > 0) {
            ++skipped_;
        } else if (element.name == "unit") {
            text_ +=
                "UNIT " + plain(element["category"]) + " unit " + plain(element["conversionFactor"]) + ' ';
        } else if (element.name == "ProtoDeclare" || element.name == "ExternProtoDeclare" ||
                   element.name == "ProtoInstance") {
            source_.broken("a PROTO, a user-defined node,", "convert it with another program");
        } else if (element.name == "Script" || element.name == "ROUTE") {
            skipped_ = 1;
        } else if (element.name != "X3D" && element.name != "Scene" && !element.name.empty() &&
                   std::isupper(static_cast<unsigned char>(element.name[0]))) {
            node(element);  // names of nodes begin with a capital
        }
        return true;
    }

    void end() {
        if (skipped_ > 0) --skipped_;
        if (open_.back().node) text_ += "} ";
        open_.pop_back();
    }

    void node(const XmlElement& element) {
        const std::string_view parent =
            open_.size() > 1 ? std::string_view(open_[open_.size() - 2].name) : "";
        if (open_.size() > 1 && open_[open_.size() - 2].node) {
            const std::string_view field = element["containerField"];
            text_ += plain(field.empty() ? field_of(element.name, parent) : field) + ' ';
        }
        if (const auto use = element.find("USE")) {
            text_ += "USE " + name(*use) + ' ';
            skipped_ = 1;
            return;
        }
        if (const auto def = element.find("DEF")) text_ += "DEF " + name(*def) + ' ';
        text_ += plain(element.name) + " { ";
        open_.back().node = true;
        for (std::string_view field : number_fields)
            if (const auto value = element.find(field))
                text_ += fmt::format("{} [ {} ] ", field, plain(*value));
        for (std::string_view field : truth_fields)
            if (const auto value = element.find(field))
                text_ +=
                    fmt::format("{} {} ", field, *value == "false" || *value == "FALSE" ? "FALSE" : "TRUE");
    }

    // Refuses text with delimiters of VRML, which must not get into a name or into numbers.
    std::string plain(std::string_view text) const {
        if (text.find_first_of("{}[]\"#") != std::string_view::npos)
            source_.broken(fmt::format("{} for a name or numbers in line {}", in_quotes(text), line_));
        return std::string(text);
    }

    // Names may have any characters in X3D, so they are replaced by numbers.
    std::string name(std::string_view text) {
        return fmt::format("n{}", names_.try_emplace(std::string(text), names_.size()).first->second);
    }

    struct Open {
        std::string name;
        bool node;  // was translated as a node
    };

    Source source_;
    std::string text_;
    std::size_t line_ = 1, skipped_ = 0;  // skipped: the depth inside an element that is left out
    std::vector<Open> open_;
    std::map<std::string, std::size_t> names_;
    bool is_x3d_ = false;
};

}  // namespace

Draft read_x3d(Source source) {
    if (source.whole().starts_with(std::string_view("\xe0\0\0\1", 4)))
        source.broken("binary X3D (Fast Infoset), which is not read,", "export it as plain .x3d");
    const std::string text = X3d(source).translated();
    return read_vrml_nodes(Source(text, source.name()));
}

}  // namespace palpate
