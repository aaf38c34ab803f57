#pragma once
#include "palpate/files/formats/source.h"

#include <functional>
#include <string_view>

namespace palpate {

/// The start tag of an XML element; only valid until the next one.
struct XmlElement {
    std::string_view name;          // without the prefix of its namespace
    const char* const* attributes;  // alternating names and values, and a null
    std::size_t line;

    /// An attribute's value, by its name with or without a prefix; nothing if there is none.
    std::optional<std::string_view> find(std::string_view attribute) const;
    /// The same; empty if there is none.
    std::string_view operator[](std::string_view attribute) const { return find(attribute).value_or(""); }
};

/// Parses an XML file: calls `begins` for each start tag and `ends` with the name at each end tag. `begins`
/// may return false to stop. Throws Error if the text is not XML, if it is incomplete, or if it defines
/// entities or default attributes, with which a small file can expand to a large one; and whatever the two
/// throw.
void read_xml(
    const Source& source, const std::function<bool(const XmlElement&)>& begins,
    const std::function<void(std::string_view)>& ends = [](std::string_view) {});

}  // namespace palpate
