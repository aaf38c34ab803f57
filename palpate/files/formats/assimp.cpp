// assimp reads some fifty formats, but trusts what a file claims: it may allocate as much as a list
// announces, run without end, or crash. So it runs in a process of its own, and what it returns is checked
// like any draft.
#include "palpate/base/error.h"
#include "palpate/base/isolated.h"
#include "palpate/files/extension.h"
#include "palpate/files/formats/budget.h"
#include "palpate/files/formats/formats.h"
#include "palpate/files/formats/lists.h"
#include "palpate/files/formats/transform.h"
#include "palpate/files/formats/units.h"
#include "palpate/files/formats/xml.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <new>
#include <numeric>
#include <span>

namespace palpate {
namespace {

// The files that assimp can open: this one, and files in the same folder or below.
class Beside : public Assimp::DefaultIOSystem {
 public:
    Beside(const Source& source, std::string_view bytes, std::string name)
        : source_(source), bytes_(bytes), name_(std::move(name)) {}

    bool Exists(const char* name) const override { return name == name_ || source_.beside(name); }

    Assimp::IOStream* Open(const char* name, const char* mode) override {
        if (name == name_)
            return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes_.data()),
                                              bytes_.size());
        const auto other = source_.beside(name);
        return other ? DefaultIOSystem::Open(other->c_str(), mode) : nullptr;
    }

 private:
    const Source& source_;
    std::string_view bytes_;  // the file's, perhaps corrected
    std::string name_;
};

dvec3 vector(aiVector3D v) { return {v.x, v.y, v.z}; }

Transform transform_of(const aiMatrix4x4& m) {
    return {dmat3(m.a1, m.b1, m.c1, m.a2, m.b2, m.c2, m.a3, m.b3, m.c3), dvec3(m.a4, m.b4, m.c4)};
}

Transform world_of(const aiNode& node) {
    Transform transform = transform_of(node.mTransformation);
    for (const aiNode* above = node.mParent; above; above = above->mParent)
        transform = transform_of(above->mTransformation) * transform;
    return transform;
}

// Skinning: the weighted transform of each vertex by its bones; a vertex without bones stays with the node.
// Empty if the mesh has no bones, or one that is not a node.
std::vector<Transform> skinned(const aiScene& scene, const aiMesh& mesh, const Transform& node) {
    if (!mesh.HasBones()) return {};
    MeanTransforms transforms(mesh.mNumVertices);
    for (const aiBone* bone : std::span(mesh.mBones, mesh.mNumBones)) {
        const aiNode* const joint = scene.mRootNode->FindNode(bone->mName);
        if (!joint) return {};
        const Transform transform = world_of(*joint) * transform_of(bone->mOffsetMatrix);
        for (const aiVertexWeight& w : std::span(bone->mWeights, bone->mNumWeights))
            if (w.mVertexId < mesh.mNumVertices) transforms.add(w.mVertexId, transform, double(w.mWeight));
    }
    return std::move(transforms).take(node);
}

// A mesh may be instanced by several nodes.
void add(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above, Draft& draft) {
    const aiMatrix4x4 m = above * node.mTransformation;
    const Transform node_transform = transform_of(m);
    for (unsigned number : std::span(node.mMeshes, node.mNumMeshes)) {
        const aiMesh& mesh = *scene.mMeshes[number];
        const std::size_t first = draft.positions.size();
        if (first + mesh.mNumVertices > ~Index(0)) throw std::bad_alloc();
        const std::vector<Transform> by_bones = skinned(scene, mesh, node_transform);
        const auto transform = [&](unsigned i) -> const Transform& {
            return by_bones.empty() ? node_transform : by_bones[i];
        };
        const bool mirrors = by_bones.empty() ? node_transform.mirrors() : mostly_mirror(by_bones);
        for (unsigned i = 0; i < mesh.mNumVertices; ++i)
            draft.positions.push_back(transform(i).of(vector(mesh.mVertices[i])));
        if (mesh.HasNormals())
            for (unsigned i = 0; i < mesh.mNumVertices; ++i)
                draft.normals.push_back(transform(i).normal(vector(mesh.mNormals[i])));
        if (mesh.HasTextureCoords(0))  // assimp has flipped v if the format's points down
            for (aiVector3D v : std::span(mesh.mTextureCoords[0], mesh.mNumVertices))
                draft.uvs.push_back({v.x, v.y});
        for (const aiFace& face : std::span(mesh.mFaces, mesh.mNumFaces)) {
            const unsigned size = face.mNumIndices;
            for (unsigned k = 0; k < size; ++k) {
                const unsigned corner = face.mIndices[mirrors ? size - 1 - k : k];
                draft.corners.push_back(corner < mesh.mNumVertices ? Index(first) + corner : ~Index(0));
            }
            draft.sizes.push_back(size);
        }
    }
    for (const aiNode* child : std::span(node.mChildren, node.mNumChildren))
        if (child) add(scene, *child, m, draft);  // some of assimp's readers leave null pointers
}

// ---- corrections before assimp reads ----

// Collada with rotation axes made unit, since assimp would shear otherwise. <rotate ...>x y z angle</rotate>
std::string with_unit_axes(std::string_view text) {
    std::string corrected;
    for (std::size_t at; (at = text.find("<rotate")) != std::string_view::npos;) {
        const std::size_t start = std::min(text.find('>', at), text.size() - 1) + 1,
                          end = text.find('<', start);
        std::string_view numbers = text.substr(start, end - start);
        corrected += text.substr(0, start);
        text.remove_prefix(std::min(end, text.size()));
        dvec3 axis(0);
        std::string_view left = numbers;
        for (int k = 0; k < 3; ++k) axis[k] = parse_number(word(left)).value_or(0);
        const double length = glm::length(axis);
        if (length > 0 && std::isfinite(length) && std::abs(length - 1) > 1e-6)
            corrected += fmt::format("{:.9f} {:.9f} {:.9f}{}", axis.x / length, axis.y / length,
                                     axis.z / length, left);
        else
            corrected += numbers;
    }
    return corrected += text;
}

// ---- units ----

// An attribute of the first such element of an XML file.
std::optional<std::string> in_xml(const Source& source, std::string_view element,
                                  std::string_view attribute) {
    std::optional<std::string> found;
    read_xml(source, [&](const XmlElement& e) {
        if (e.name == element) found = e.find(attribute);
        return e.name != element;
    });
    return found;
}

// $INSUNITS in the header of a DXF: a code, two lines below.
double dxf_unit(std::string_view text) {
    constexpr double metres[] = {0,       0.0254, 0.3048, 1609.344, 1e-3, 1e-2, 1,  1e3, 2.54e-8,
                                 2.54e-5, 0.9144, 1e-10,  1e-9,     1e-6, 0.1,  10, 100, 1e9};
    const std::size_t at = text.find("$INSUNITS");
    if (at == std::string_view::npos) return 0;
    text.remove_prefix(at);
    word(text), word(text);
    const double code = parse_number(word(text)).value_or(0);
    return is_whole(code, 0, double(std::size(metres)) - 1) ? metres[std::size_t(code)] : 0;
}

// The unit that the file states, in metres; 0 if it states none. assimp itself applies only that of Collada.
double stated_unit(const Source& source, const std::string& format, const aiScene& scene) {
    float centimetres = 0;
    if (format == ".fbx" && scene.mMetaData && scene.mMetaData->Get("UnitScaleFactor", centimetres))
        return centimetres > 0 ? 0.01 * double(centimetres) : 0;
    if (format == ".amf") {
        const std::string name = in_xml(source, "amf", "unit").value_or("millimeter");
        const auto unit = metres_of(name);
        if (!unit) source.broken("the unknown unit " + in_quotes(name));
        return *unit;
    }
    if (format == ".dae") {
        const double meter = parse_number(in_xml(source, "unit", "meter").value_or("1")).value_or(1);
        return meter > 0 && std::isfinite(meter) ? meter : 1;
    }
    return format == ".dxf" ? dxf_unit(source.whole()) : 0;
}

// ---- what would move vertices but is not read ----

void note_skins_and_targets(const aiScene& scene, std::vector<std::string>& notes) {
    const std::span meshes(scene.mMeshes, scene.mNumMeshes);
    const auto lacks_bones = [&](const aiMesh* mesh) {
        const std::span bones(mesh->mBones, mesh->mNumBones);
        return std::ranges::any_of(bones,
                                   [&](const aiBone* b) { return !scene.mRootNode->FindNode(b->mName); });
    };
    if (const auto skins = std::ranges::count_if(meshes, lacks_bones))
        notes.push_back(
            fmt::format("left out the skins of {} meshes, because some of their bones are not nodes", skins));
    const auto has_targets = [](const aiMesh* mesh) { return mesh->mNumAnimMeshes > 0; };
    if (const auto targets = std::ranges::count_if(meshes, has_targets))
        notes.push_back(fmt::format("left out the morph targets of {} meshes", targets));
}

// ---- from one process to the other ----

std::vector<char> as_lines(const std::vector<std::string>& texts) {
    std::vector<char> lines;
    for (const std::string& text : texts) {
        lines.insert(lines.end(), text.begin(), text.end());
        lines.push_back('\n');
    }
    return lines;
}

}  // namespace

bool assimp_knows(const std::string& extension) {
    return extension.size() > 1 && Assimp::Importer().IsExtensionSupported(extension);
}

Draft read_with_assimp(const Source& source) {
    const std::size_t most = warranted(source.whole().size());
    const Allowance allowance{.seconds = 15, .bytes = most, .output = most};
    const std::string unreadable = "something that assimp cannot read",
                      remedy = "convert it with another program";
    std::filesystem::path name = std::filesystem::path(source.name()).filename();
    if (name.extension() == ".gz") name.replace_extension();
    const std::string format = extension(name);
    const std::string corrected = format == ".dae" ? with_unit_axes(source.whole()) : "";
    const Written written = isolated("assimp", source.name(), allowance, [&](std::FILE* to) {
        Assimp::Importer importer;
        importer.SetIOHandler(
            new Beside(source, corrected.empty() ? source.whole() : corrected, name.string()));
        importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
        const aiScene* scene = importer.ReadFile(name.string(), 0);
        const std::string_view error = importer.GetErrorString();
        if (error == "std::bad_alloc") throw std::bad_alloc();
        if (!scene || !scene->mRootNode)
            source.broken(error.empty() ? unreadable : unreadable + " (" + in_quotes(error, 200) + ")",
                          remedy);
        Draft draft;
        draft.unit = stated_unit(source, format, *scene);
        add(*scene, *scene->mRootNode, aiMatrix4x4(), draft);
        if (format == ".dae")  // assimp has scaled it to metres
            for (dvec3& p : draft.positions) p /= draft.unit;
        note_skins_and_targets(*scene, draft.notes);
        if (draft.normals.size() != draft.positions.size()) draft.normals.clear();  // a part has none
        if (draft.uvs.size() != draft.positions.size()) draft.uvs.clear();
        put(to, std::vector{draft.unit});
        put(to, as_lines(draft.notes));
        put(to, draft.positions);
        put(to, draft.normals);
        put(to, draft.uvs);
        put(to, draft.corners);
        put(to, draft.sizes);
    });
    Draft draft;
    draft.single = true;
    std::span<const char> bytes = written.bytes();
    std::vector<double> unit;
    std::vector<char> notes;
    if (!take(bytes, unit) || unit.size() != 1 || !take(bytes, notes) || !take(bytes, draft.positions) ||
        !take(bytes, draft.normals) || !take(bytes, draft.uvs) || !take(bytes, draft.corners) ||
        !take(bytes, draft.sizes) ||
        std::accumulate(draft.sizes.begin(), draft.sizes.end(), std::size_t(0)) != draft.corners.size())
        source.broken(unreadable, remedy);
    draft.unit = unit[0];
    for (std::string_view lines(notes.data(), notes.size()); !lines.empty();)
        draft.notes.emplace_back(until('\n', lines));
    return draft;
}

}  // namespace palpate
