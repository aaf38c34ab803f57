#pragma once
// DICOM as its standard describes it, element by element.
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace palpate {

class DicomFile {
 public:
    static constexpr const char* explicit_little = "1.2.840.10008.1.2.1";

    /// A text or numbers as text, "1.5\\2".
    DicomFile& text(std::uint32_t tag, const std::string& kind, std::string value) {
        if (value.size() % 2 == 1) value += kind == "UI" ? '\0' : ' ';
        elements_[tag] = {kind, value};
        return *this;
    }
    template <class T>
    DicomFile& binary(std::uint32_t tag, const std::string& kind, const std::vector<T>& numbers) {
        std::string bytes(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T));
        if (bytes.size() % 2 == 1) bytes += '\0';
        elements_[tag] = {kind, bytes};
        return *this;
    }
    DicomFile& number(std::uint32_t tag, std::uint16_t value) {
        return binary(tag, "US", std::vector<std::uint16_t>{value});
    }
    /// A sequence.
    DicomFile& items(std::uint32_t tag, const std::vector<DicomFile>& all) {
        std::string bytes;
        for (const DicomFile& item : all) {
            const std::string inner = item.data_set();
            bytes += raw<std::uint16_t>(0xfffe) + raw<std::uint16_t>(0xe000) +
                     raw(std::uint32_t(inner.size())) + inner;
        }
        elements_[tag] = {"SQ", bytes};
        return *this;
    }
    DicomFile& without(std::uint32_t tag) {
        elements_.erase(tag);
        return *this;
    }

    /// Without the mark and the head before it.
    std::string data_set() const {
        std::string bytes;
        for (const auto& [tag, element] : elements_) bytes += written(tag, element);
        return bytes;
    }
    std::string bytes(const std::string& syntax = explicit_little) const {
        const auto kind = elements_.find(0x00080016);
        DicomFile head;
        if (kind != elements_.end()) head.text(0x00020002, "UI", kind->second.second);
        head.text(0x00020010, "UI", syntax);
        const std::string inner = head.data_set();
        return std::string(128, '\0') + "DICM" + raw<std::uint16_t>(2) + raw<std::uint16_t>(0) + "UL" +
               raw<std::uint16_t>(4) + raw(std::uint32_t(inner.size())) + inner + data_set();
    }

 private:
    template <class T>
    static std::string raw(T number) {
        std::string bytes(sizeof number, '\0');
        std::memcpy(bytes.data(), &number, sizeof number);
        return bytes;
    }
    static std::string written(std::uint32_t tag, const std::pair<std::string, std::string>& element) {
        const auto& [kind, value] = element;
        const bool wide = kind == "OB" || kind == "OW" || kind == "SQ" || kind == "UN" || kind == "OF";
        return raw(std::uint16_t(tag >> 16)) + raw(std::uint16_t(tag)) + kind +
               (wide ? std::string(2, '\0') + raw(std::uint32_t(value.size()))
                     : raw(std::uint16_t(value.size()))) +
               value;
    }

    std::map<std::uint32_t, std::pair<std::string, std::string>> elements_;
};

}  // namespace palpate
