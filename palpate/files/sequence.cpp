#include "palpate/files/sequence.h"

#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/files/bytes.h"
#include "palpate/files/extension.h"
#include "palpate/files/gltf.h"
#include "palpate/files/write.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace palpate {
namespace {

// ---- numbered files ----

std::string for_xml(const std::string& text) {
    std::string safe;
    for (char c : text)
        if (std::strchr("&<>\"", c))
            safe += fmt::format("&#{};", int(c));
        else
            safe += c;
    return safe;
}

class Numbered : public Sequence {
 public:
    Numbered(const Mesh& mesh, const std::filesystem::path& path, std::size_t pictures)
        : mesh_(mesh), path_(path), digits_(std::max<std::size_t>(4, std::to_string(pictures).size())) {}

    void add(double time, std::span<const vec3> positions, std::span<const vec3> normals,
             const VertexValues& values) override {
        mesh_.positions.assign(positions.begin(), positions.end());
        mesh_.normals.assign(normals.begin(), normals.end());
        const std::filesystem::path file =
            path_.parent_path() /
            fmt::format("{}-{:0{}}{}", path_.stem().string(), ++count_, digits_, path_.extension().string());
        write_mesh(mesh_, file, values);
        list_ += fmt::format("<DataSet timestep=\"{:.9g}\" file=\"{}\"/>\n", time,
                             for_xml(file.filename().string()));
    }

    void finish() override {
        if (extension(path_) != ".vtp") return;
        write_text(std::filesystem::path(path_).replace_extension(".pvd"),
                   "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n" +
                       list_ + "</Collection>\n</VTKFile>\n");
    }

 private:
    Mesh mesh_;
    std::filesystem::path path_;
    std::size_t digits_, count_ = 0;
    std::string list_;  // the files and their times
};

// ---- one file ----

// A file whose header is known only at the end: until then its body is in a temporary file.
class HeaderLast {
 public:
    explicit HeaderLast(const std::filesystem::path& path)
        : path_(path),
          waiting_(path.string() + ".body"),
          stream_(std::fopen(waiting_.name().c_str(), "w+b")) {
        if (!stream_)
            throw Error("cannot write", path.string(), "check that the folder exists and may be written to");
    }

    void write(const void* bytes, std::size_t count) {
        if (std::fwrite(bytes, 1, count, stream_.get()) != count)
            throw Error("cannot write", path_.string(), "make room on the disk");
    }
    void write(const std::string& bytes) { write(bytes.data(), bytes.size()); }
    template <class T>
    void write(std::span<const T> values) {
        write(values.data(), values.size_bytes());
    }

    void finish(const std::string& head) {
        write_file(path_, [&](std::FILE* file) {
            std::fwrite(head.data(), 1, head.size(), file);
            if (std::fflush(stream_.get()) != 0)
                throw Error("cannot write", path_.string(), "make room on the disk");
            std::rewind(stream_.get());
            std::vector<char> block(1 << 20);
            while (const std::size_t n = std::fread(block.data(), 1, block.size(), stream_.get()))
                std::fwrite(block.data(), 1, n, file);
            if (std::ferror(stream_.get())) throw Error("cannot read back", path_.string(), "check the disk");
        });
    }

 private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::filesystem::path path_;
    Unfinished waiting_;  // never finished, so it is removed in the end
    std::unique_ptr<std::FILE, Close> stream_;
};

// ---- caches of positions, with the mesh in a file of its own ----

std::uint32_t big_endian(float number) { return __builtin_bswap32(std::bit_cast<std::uint32_t>(number)); }
std::uint32_t big_endian(std::size_t number) { return __builtin_bswap32(std::uint32_t(number)); }

class Cache : public Sequence {
 public:
    Cache(const Mesh& mesh, const std::filesystem::path& path) : mesh_(mesh), path_(path), file_(path) {}

    void add(double time, std::span<const vec3> positions, std::span<const vec3>,
             const VertexValues&) override {
        times_.push_back(float(time));
        if (is_mdd()) {
            std::vector<std::uint32_t> words;
            for (vec3 p : positions)
                words.insert(words.end(), {big_endian(p.x), big_endian(p.y), big_endian(p.z)});
            file_.write(std::span<const std::uint32_t>(words));
        } else {
            file_.write(positions);
        }
    }

    void finish() override {
        write_mesh(mesh_, std::filesystem::path(path_).replace_extension(".obj"));
        file_.finish(is_mdd() ? mdd_head() : pc2_head());
    }

 private:
    bool is_mdd() const { return extension(path_) == ".mdd"; }

    // The format of LightWave: all numbers are big-endian, and the times come before the positions.
    std::string mdd_head() const {
        std::string head;
        append(head, big_endian(times_.size()));
        append(head, big_endian(mesh_.positions.size()));
        for (float time : times_) append(head, big_endian(time));
        return head;
    }

    // PointCache2: no times, but a first frame and the number of frames per sample.
    std::string pc2_head() const {
        std::string head("POINTCACHE2\0", 12);
        append(head, std::int32_t{1});  // its version
        append(head, std::int32_t(mesh_.positions.size()));
        append(head, 0.0f);
        append(head, 1.0f);
        append(head, std::int32_t(times_.size()));
        return head;
    }

    Mesh mesh_;
    std::filesystem::path path_;
    HeaderLast file_;
    std::vector<float> times_;
};

// ---- morph targets ----

class Morphs : public Sequence {
 public:
    Morphs(const Mesh& mesh, const std::filesystem::path& path, std::size_t pictures)
        : path_(path), contents_(gltf_contents(mesh, path.string())), rest_(mesh), file_(path) {
        check_room_for(pictures);
        for (vec3& n : rest_.normals) n = gltf_normal(n);
        file_.write(gltf_binary(rest_));
    }

    void add(double time, std::span<const vec3> positions, std::span<const vec3> normals,
             const VertexValues&) override {
        check_room_for(contents_.times.size() + 1);
        contents_.times.push_back(float(time));
        std::vector<vec3> ways(positions.begin(), positions.end());
        for (std::size_t i = 0; i < ways.size(); ++i) ways[i] -= rest_.positions[i];
        contents_.moves.push_back(bounds(ways));
        file_.write(std::span<const vec3>(ways));
        if (!contents_.normals) return;
        for (std::size_t i = 0; i < ways.size(); ++i) ways[i] = gltf_normal(normals[i]) - rest_.normals[i];
        file_.write(std::span<const vec3>(ways));
    }

    void finish() override {
        const std::size_t pictures = contents_.times.size();
        file_.write(std::span<const float>(contents_.times));
        std::vector<float> weights(pictures, 0.0f);
        for (float& own : weights) {
            own = 1;
            file_.write(std::span<const float>(weights));
            own = 0;
        }
        file_.finish(glb_head(contents_));
    }

 private:
    void check_room_for(std::size_t pictures) const {
        if (contents_.bytes(pictures) > gltf_limit)
            throw Error(
                fmt::format("{} pictures of {} vertices, which exceed 2 GB", pictures, contents_.vertices),
                path_.string(), "write fewer pictures, simplify the surface, or use .vtp, .pc2 or .mdd");
    }

    std::filesystem::path path_;
    GltfContents contents_;
    Mesh rest_;
    HeaderLast file_;
};

// Checks the pictures for any of the formats.
class Checked : public Sequence {
 public:
    Checked(const Mesh& mesh, bool keeps_normals, const std::filesystem::path& path,
            std::unique_ptr<Sequence> sequence)
        : vertices_(mesh.positions.size()),
          wants_normals_(keeps_normals && !mesh.normals.empty()),
          path_(path),
          sequence_(std::move(sequence)) {}

    void add(double time, std::span<const vec3> positions, std::span<const vec3> normals,
             const VertexValues& values) override {
        const bool lacks_normals = normals.empty() ? wants_normals_ : normals.size() != vertices_;
        if (positions.size() != vertices_ || lacks_normals)
            throw Error("a picture whose number of vertices differs from that of the sequence",
                        path_.string(),
                        "give every vertex of the mesh a position, and a normal if the mesh has them");
        if (!(std::isfinite(time) && time > last_))
            throw Error(fmt::format("a picture at {} s after one at {} s", time, last_), path_.string(),
                        "add them in order");
        last_ = time;
        sequence_->add(time, positions, normals, values);
    }
    void finish() override { sequence_->finish(); }

 private:
    std::size_t vertices_;
    bool wants_normals_;
    std::filesystem::path path_;
    std::unique_ptr<Sequence> sequence_;
    double last_ = -std::numeric_limits<double>::infinity();  // s
};

enum class Kind { numbered, cache, morphs };

Kind kind_of(const std::filesystem::path& path) {
    const std::string wanted = extension(path);
    if (wanted == ".ply" || wanted == ".obj" || wanted == ".stl" || wanted == ".vtp") return Kind::numbered;
    if (wanted == ".pc2" || wanted == ".mdd") return Kind::cache;
    if (wanted == ".glb") return Kind::morphs;
    throw Error("cannot write a sequence of the format \"" + wanted + "\"", path.string(),
                "use .ply, .obj, .stl, .vtp, .pc2, .mdd or .glb");
}

}  // namespace

void check_sequence_name(const std::filesystem::path& path) { kind_of(path); }

std::unique_ptr<Sequence> make_sequence(const Mesh& mesh, const std::filesystem::path& path,
                                        std::size_t pictures) {
    check(mesh, path.string());
    const Kind kind = kind_of(path);
    std::unique_ptr<Sequence> sequence;
    if (kind == Kind::numbered) sequence = std::make_unique<Numbered>(mesh, path, pictures);
    if (kind == Kind::cache) sequence = std::make_unique<Cache>(mesh, path);
    if (kind == Kind::morphs) sequence = std::make_unique<Morphs>(mesh, path, pictures);
    return std::make_unique<Checked>(mesh, kind != Kind::cache, path, std::move(sequence));
}

}  // namespace palpate
