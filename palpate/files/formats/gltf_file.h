#pragma once
#include "palpate/files/formats/budget.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// A field of an object, or null.
const nlohmann::json& field(const nlohmann::json& object, std::string_view name);

/// The data of an extension in an object, or null.
const nlohmann::json& extension(const nlohmann::json& object, std::string_view name);

/// A glTF file: its JSON, and the numbers of its accessors, decompressed and dequantised. gltf.cpp makes a
/// surface of them. All functions throw Error if the file is damaged or truncated.
class GltfFile {
 public:
    using Json = nlohmann::json;

    explicit GltfFile(Source source);

    const Source& source() const { return source_; }
    [[noreturn]] void broken(std::string_view what) const { source_.broken(what); }

    /// Whether it is of version 1, for which the functions below do not work. Throws Error if it is of
    /// neither version 1 nor 2.
    bool is_of_version_1() const;

    // --- the JSON ---

    const Json& json() const { return json_; }

    /// A list of the file, or of an object in it; empty if there is none.
    const Json& list(std::string_view name) const { return list_of(json_, name); }
    const Json& list_of(const Json& object, std::string_view name) const;

    /// The entry of a list with an index, and that index.
    const Json& entry(std::string_view name, const Json& number) const {
        return list(name)[number_in(name, number)];
    }
    std::size_t number_in(std::string_view name, const Json& number) const;

    /// A non-negative integer; `fallback` if it is missing.
    std::size_t whole(const Json& value, std::string_view what, std::size_t fallback) const;

    // --- numbers ---

    /// The extensions that compress numbers.
    static constexpr std::string_view draco = "KHR_draco_mesh_compression",
                                      meshopt = "EXT_meshopt_compression";

    /// Decompresses Draco meshes, for which accessors have no bytes of their own. Call it before numbers().
    void unpack_draco();

    /// The corners of a primitive's triangles, if it is compressed by Draco.
    const std::vector<double>* draco_corners(const Json& primitive) const;

    /// All numbers of an accessor, which must have this shape ("SCALAR", "MAT4"); none for null.
    std::vector<double> numbers_of(const Json& accessor, std::string_view shape);

    /// The same as dvec2, dvec3 or dvec4.
    template <class T>
    std::vector<T> vectors_of(const Json& accessor);

    /// Charges the budget of the file (budget.h).
    void spend(std::size_t count, std::size_t bytes_each = 1) { budget_.spend(count, bytes_each); }

 private:
    struct Kind;  // of numbers
    struct View {
        std::string_view bytes;
        std::size_t stride;  // the distance of its entries; 0: they are packed
    };

    std::string_view open_glb(std::string_view file);
    std::string_view buffer(std::size_t number);
    std::string outside(std::string_view uri);
    std::string_view cut(const Json& of);
    View view(const Json& which);
    std::string unpack(const Json& packing, std::size_t stride);
    const Kind& kind_of(const Json& number) const;
    std::vector<double> numbers_in(const Json& where, const Kind& kind, std::size_t count,
                                   std::size_t components);
    void replace(std::vector<double>& numbers, const Json& sparse, const Kind& kind, std::size_t components);

    Source source_;
    Budget budget_;
    Json json_;
    std::optional<std::string_view> binary_;                    // the binary chunk of a GLB
    std::set<std::filesystem::path> files_;                     // other files that buffers refer to
    std::map<std::size_t, std::string> buffers_, unpacked_;     // by index, read on first use
    std::map<std::size_t, std::vector<double>> draco_numbers_;  // of accessors
    std::map<const Json*, std::vector<double>> draco_corners_;  // of primitives
};

}  // namespace palpate
