// assimp knows some fifty formats, and believes what a file of them claims: it may allocate what a list
// promises, run without end, or crash. So it works in a process of its own, and what it returns is checked
// like any draft.
#include "palpate/base/error.h"
#include "palpate/base/isolated.h"
#include "palpate/mesh/formats/formats.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/scene.h>

#include <cstdio>
#include <cstring>
#include <new>
#include <numeric>
#include <span>

namespace palpate {
namespace {

// All that assimp can open: the file, and files in the same folder.
class Beside : public Assimp::DefaultIOSystem {
 public:
    Beside(std::string_view bytes, std::string name, std::filesystem::path folder)
        : bytes_(bytes), name_(std::move(name)), folder_(std::move(folder)) {}

    bool Exists(const char* name) const override {
        return name == name_ || (may_open(name) && DefaultIOSystem::Exists(in_folder(name).c_str()));
    }

    Assimp::IOStream* Open(const char* name, const char* mode) override {
        if (name == name_)
            return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes_.data()),
                                              bytes_.size());
        return may_open(name) ? DefaultIOSystem::Open(in_folder(name).c_str(), mode) : nullptr;
    }

 private:
    bool may_open(const std::filesystem::path& name) const {
        return !folder_.empty() && name.lexically_normal() == name.filename() && name != "..";
    }
    std::filesystem::path in_folder(const char* name) const { return folder_ / name; }

    std::string_view bytes_;
    std::string name_;
    std::filesystem::path folder_;
};

dvec3 vector(aiVector3D v) { return {v.x, v.y, v.z}; }

dvec3 unit(dvec3 v) {
    const double length = glm::length(v);
    return length > 0 ? v / length : dvec3(0, 0, 1);
}

// A mesh may hang on several nodes, each of which places it.
void add(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above, Draft& draft) {
    const aiMatrix4x4 m = above * node.mTransformation;
    const dmat3 turn(m.a1, m.b1, m.c1, m.a2, m.b2, m.c2, m.a3, m.b3, m.c3);
    const dvec3 move(m.a4, m.b4, m.c4);
    const bool mirrors = glm::determinant(turn) < 0;
    // Normals turn with planes: by the cofactors, which cross products of the columns are.
    const dmat3 tilt(glm::cross(turn[1], turn[2]), glm::cross(turn[2], turn[0]),
                     glm::cross(turn[0], turn[1]));
    for (unsigned number : std::span(node.mMeshes, node.mNumMeshes)) {
        const aiMesh& mesh = *scene.mMeshes[number];
        const std::size_t first = draft.positions.size();
        if (first + mesh.mNumVertices > ~Index(0)) throw std::bad_alloc();
        for (aiVector3D v : std::span(mesh.mVertices, mesh.mNumVertices))
            draft.positions.push_back(turn * vector(v) + move);
        if (mesh.HasNormals())
            for (aiVector3D v : std::span(mesh.mNormals, mesh.mNumVertices))
                draft.normals.push_back(unit((mirrors ? -1.0 : 1.0) * (tilt * vector(v))));
        if (mesh.HasTextureCoords(0))  // whose v assimp has turned up where a format has it down
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
        if (child) add(scene, *child, m, draft);  // some readers leave holes
}

template <class T>
void put(std::FILE* to, const std::vector<T>& list) {
    const std::size_t count = list.size();
    std::fwrite(&count, sizeof count, 1, to);
    if (count > 0) std::fwrite(list.data(), sizeof(T), count, to);
}

// False if the bytes end before the list does.
template <class T>
bool take(std::span<const char>& from, std::vector<T>& list) {
    std::size_t count;
    if (from.size() < sizeof count) return false;
    std::memcpy(&count, from.data(), sizeof count);
    from = from.subspan(sizeof count);
    if (count > from.size() / sizeof(T)) return false;
    list.resize(count);
    if (count > 0) std::memcpy(list.data(), from.data(), count * sizeof(T));
    from = from.subspan(count * sizeof(T));
    return true;
}

}  // namespace

bool assimp_knows(const std::string& ending) {
    return ending.size() > 1 && Assimp::Importer().IsExtensionSupported(ending);
}

Draft read_with_assimp(const Source& source, const std::filesystem::path& folder) {
    const Allowance allowance{.seconds = 15, .bytes = (std::size_t(256) << 20) + 64 * source.whole().size()};
    const std::string unreadable = "something that assimp cannot read",
                      remedy = "convert it with another program";
    std::filesystem::path name = std::filesystem::path(source.name()).filename();
    if (name.extension() == ".gz") name.replace_extension();
    const Written written = isolated("assimp", source.name(), allowance, [&](std::FILE* to) {
        Assimp::Importer importer;
        importer.SetIOHandler(new Beside(source.whole(), name.string(), folder));
        importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
        const aiScene* scene = importer.ReadFile(name.string(), 0);
        const std::string_view error = importer.GetErrorString();
        if (error == "std::bad_alloc") throw std::bad_alloc();
        if (!scene || !scene->mRootNode)
            source.broken(error.empty() ? unreadable : unreadable + " (" + in_quotes(error, 200) + ")",
                          remedy);
        Draft draft;
        add(*scene, *scene->mRootNode, aiMatrix4x4(), draft);
        if (draft.normals.size() != draft.positions.size()) draft.normals.clear();  // a part has none
        if (draft.uvs.size() != draft.positions.size()) draft.uvs.clear();
        put(to, draft.positions);
        put(to, draft.normals);
        put(to, draft.uvs);
        put(to, draft.corners);
        put(to, draft.sizes);
    });
    Draft draft;
    draft.single = true;
    std::span<const char> bytes = written.bytes();
    if (!take(bytes, draft.positions) || !take(bytes, draft.normals) || !take(bytes, draft.uvs) ||
        !take(bytes, draft.corners) || !take(bytes, draft.sizes) ||
        std::accumulate(draft.sizes.begin(), draft.sizes.end(), std::size_t(0)) != draft.corners.size())
        source.broken(unreadable, remedy);
    return draft;
}

}  // namespace palpate
