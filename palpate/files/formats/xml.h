#pragma once
#include "palpate/files/formats/source.h"

#include <functional>
#include <string_view>

namespace palpate {

/// An element of an XML file as it begins; only valid until the next one.
struct XmlElement {
    std::string_view name;          // without the prefix of its namespace
    const char* const* attributes;  // names and values in turn, and a null
    std::size_t line;

    /// An attribute's value, by its name with or without a prefix; nothing if there is none.
    std::optional<std::string_view> find(std::string_view attribute) const;
    /// The same; empty if there is none.
    std::string_view operator[](std::string_view attribute) const { return find(attribute).value_or(""); }
};

/// Goes through an XML file from its beginning: `begins` is told of each element, and `ends` the name of each
/// that is over. `begins` may return false to leave off. Throws Error if the text is no XML, if it is not
/// whole, or if it defines entities or defaults of attributes, by which a small file can be a large one; and
/// whatever the two throw.
void read_xml(
    const Source& source, const std::function<bool(const XmlElement&)>& begins,
    const std::function<void(std::string_view)>& ends = [](std::string_view) {});

}  // namespace palpate
