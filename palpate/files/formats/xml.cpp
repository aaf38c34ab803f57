#include "palpate/files/formats/xml.h"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <memory>

namespace palpate {
namespace {

std::string_view without_prefix(std::string_view name) { return name.substr(name.find(':') + 1); }

// The parser's callbacks. Exceptions must not pass through a C library, so they are stored.
struct XmlReading {
    XML_Parser parser;
    const std::function<bool(const XmlElement&)>& begins;
    const std::function<void(std::string_view)>& ends;
    bool left_off = false;
    const char* refused = nullptr;  // a construct with which a small file expands to a large one
    std::exception_ptr thrown{};

    template <class F>
    void call(F f) {
        if (thrown) return;
        try {
            f();
        } catch (...) {
            thrown = std::current_exception();
            XML_StopParser(parser, XML_FALSE);
        }
    }
};

void begin(void* reading, const char* name, const char** attributes) {
    auto& r = *static_cast<XmlReading*>(reading);
    r.call([&] {
        r.left_off =
            r.left_off || !r.begins({without_prefix(name), attributes, XML_GetCurrentLineNumber(r.parser)});
        if (r.left_off) XML_StopParser(r.parser, XML_FALSE);
    });
}

void end(void* reading, const char* name) {
    auto& r = *static_cast<XmlReading*>(reading);
    if (!r.left_off) r.call([&] { r.ends(without_prefix(name)); });
}

void refuse(void* reading, const char* what) {
    auto& r = *static_cast<XmlReading*>(reading);
    r.refused = what;
    XML_StopParser(r.parser, XML_FALSE);
}

void refuse_entity(void* reading, const char*, int, const char*, int, const char*, const char*, const char*,
                   const char*) {
    refuse(reading, "entities");
}

void refuse_default(void* reading, const char*, const char*, const char*, const char* value, int) {
    if (value) refuse(reading, "defaults");
}

}  // namespace

std::optional<std::string_view> XmlElement::find(std::string_view attribute) const {
    for (const char* const* at = attributes; *at; at += 2)
        if (attribute == at[0] || attribute == without_prefix(at[0])) return at[1];
    return {};
}

void read_xml(const Source& source, const std::function<bool(const XmlElement&)>& begins,
              const std::function<void(std::string_view)>& ends) {
    const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr),
                                                                              &XML_ParserFree);
    if (!parser) throw std::bad_alloc();
    XmlReading reading{parser.get(), begins, ends};
    XML_SetUserData(parser.get(), &reading);
    XML_SetElementHandler(parser.get(), begin, end);
    XML_SetEntityDeclHandler(parser.get(), refuse_entity);
    XML_SetAttlistDeclHandler(parser.get(), refuse_default);
    std::string_view text = source.whole();
    for (bool good = true, last = false; good && !last;) {
        const std::string_view block = text.substr(0, std::size_t(1) << 24);
        text.remove_prefix(block.size());
        last = text.empty();
        good = XML_Parse(parser.get(), block.data(), int(block.size()), last) == XML_STATUS_OK;
    }
    if (reading.thrown) std::rethrow_exception(reading.thrown);
    if (reading.left_off) return;
    if (reading.refused)
        source.broken(fmt::format("XML with {} of its own, which are not read,", reading.refused));
    const XML_Error error = XML_GetErrorCode(parser.get());
    if (error == XML_ERROR_NO_MEMORY) throw std::bad_alloc();
    if (error != XML_ERROR_NONE)
        source.broken(fmt::format("XML that is damaged or truncated ({}) in line {}", XML_ErrorString(error),
                                  XML_GetCurrentLineNumber(parser.get())));
}

}  // namespace palpate
