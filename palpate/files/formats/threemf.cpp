// 3MF: a ZIP archive with one or more XML files of objects, each a mesh or composed of others, and of the
// items to build. We read meshes, components, transforms and the unit, also of objects in files of their own
// (the production extension); we skip colours and what concerns printing.
#include "palpate/base/error.h"
#include "palpate/files/formats/budget.h"
#include "palpate/files/formats/formats.h"
#include "palpate/files/formats/transform.h"
#include "palpate/files/formats/units.h"
#include "palpate/files/formats/xml.h"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <utility>

namespace palpate {
namespace {

constexpr int most_components_deep = 100;

// The charge for each use of an object, besides its vertices and triangles.
constexpr std::size_t bytes_an_object = 1000;

// Extensions that a file may require; others may change the shape in unknown ways.
constexpr std::string_view understood_namespaces[] = {
    "http://schemas.microsoft.com/3dmanufacturing/production/",
    "http://schemas.microsoft.com/3dmanufacturing/material/",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/"};

// The files in an archive, by name without a slash in front.
class Archive {
 public:
    explicit Archive(const Source& source) : source_(source) {
        zip_error_t error;
        zip_error_init(&error);
        zip_source_t* bytes =
            zip_source_buffer_create(source.whole().data(), source.whole().size(), 0, &error);
        if (!bytes) throw std::bad_alloc();
        zip_.reset(zip_open_from_source(bytes, ZIP_RDONLY, &error));
        if (!zip_) {
            zip_source_free(bytes);
            source.broken("a damaged or truncated ZIP archive", "get the file again");
        }
    }

    /// Decompresses a file. Throws Error if it has more than `most` bytes.
    std::string read(std::string_view name, std::size_t most) const {
        const std::string plain(name.starts_with('/') ? name.substr(1) : name);
        const zip_int64_t index = zip_name_locate(zip_.get(), plain.c_str(), ZIP_FL_NOCASE);
        if (index < 0) source_.broken("no " + in_quotes(plain) + " in the archive");
        const std::unique_ptr<zip_file_t, decltype(&zip_fclose)> file(
            zip_fopen_index(zip_.get(), zip_uint64_t(index), 0), &zip_fclose);
        std::string text;
        for (std::string block(1 << 16, '\0'); file;) {
            const zip_int64_t count = zip_fread(file.get(), block.data(), block.size());
            if (count == 0) return text;
            if (count < 0) break;
            text.append(block, 0, std::size_t(count));
            if (text.size() > most) source_.broken("more in the archive than its size warrants");
        }
        source_.broken("a damaged or encrypted " + in_quotes(plain) + " in the archive",
                       "get the file again");
    }

    bool has(std::string_view name) const {
        return zip_name_locate(zip_.get(), std::string(name).c_str(), ZIP_FL_NOCASE) >= 0;
    }

 private:
    const Source& source_;
    std::unique_ptr<zip_t, decltype(&zip_discard)> zip_{nullptr, &zip_discard};
};

// An object is identified by its file and its id there.
using Name = std::pair<std::string, std::string>;

struct Part {
    Name object;
    Transform transform;
};

struct Object {
    bool is_support = false;
    std::vector<dvec3> positions;
    std::vector<uvec3> triangles;
    std::vector<Part> parts;
};

class ThreeMf {
 public:
    explicit ThreeMf(Source source) : source_(std::move(source)), archive_(source_), budget_(source_) {}

    Draft read() {
        root_ = without_slash(find_root());
        read_model(root_);
        while (!named_.empty()) {  // files to which components or items refer
            const std::string next = *named_.begin();
            named_.erase(named_.begin());
            read_model(next);
        }
        note_modifiers();
        if (build_.empty()) build_all();
        for (const Part& item : build_) add(item.object, item.transform, 0);
        if (supports_ > 0) draft_.notes.push_back(fmt::format("left out {}", counted(supports_, "support")));
        if (beams_ > 0)
            draft_.notes.push_back(fmt::format("left out {} of a lattice", counted(beams_, "beam")));
        return std::move(draft_);
    }

 private:
    // The objects that are not part of another one.
    void build_all() {
        std::set<Name> parts;
        for (const auto& [name, object] : objects_)
            for (const Part& part : object.parts) parts.insert(part.object);
        for (const auto& [name, object] : objects_)
            if (!parts.contains(name)) build_.push_back({name, Transform()});
        draft_.notes.push_back("read all objects, because the file says of none that it is to be built");
    }

    std::string find_root() {
        std::string root = "3D/3dmodel.model";
        if (!archive_.has("_rels/.rels")) return root;
        const std::string relations = unpack("_rels/.rels");
        read_xml(Source(relations, source_.name()), [&](const XmlElement& element) {
            const bool found = element.name == "Relationship" && element["Type"].ends_with("/3dmodel");
            if (found) root = percent_decoded(element["Target"]);
            return !found;
        });
        return root;
    }

    std::string unpack(std::string_view name) {
        std::string text = archive_.read(name, budget_.left());
        budget_.spend(text.size());
        return text;
    }

    void read_model(const std::string& file) {
        if (!known_.insert(file).second) return;
        const std::string text = unpack(file);
        const Source source(text, source_.name());
        Object* object = nullptr;
        bool in_mesh = false;  // other extensions have vertices, too
        const auto begins = [&](const XmlElement& element) {
            const auto bad = [&](std::string_view what) {
                source_.broken(fmt::format("{} in line {} of {}", what, element.line, in_quotes(file)));
            };
            const auto number = [&](std::string_view name) {
                const auto value = parse_number(element[name]);
                if (!value) bad(fmt::format("{} = {}", name, in_quotes(element[name])));
                return *value;
            };
            const auto part = [&](std::string_view path, std::string_view id) {
                const std::string in = path.empty() ? file : without_slash(path);
                budget_.spend(sizeof(Part) + in.size() + id.size());
                if (!known_.contains(in)) named_.insert(in);
                return Part{{in, std::string(id)}, transform(element["transform"], bad)};
            };
            if (element.name == "model") {
                if (file == root_) read_unit(element);
                check_extensions(element);
            } else if (element.name == "object") {
                budget_.spend(sizeof(Object) + file.size());
                object = &objects_[{file, std::string(element["id"])}];
                object->is_support = element["type"] == "support" || element["type"] == "solidsupport";
            } else if (element.name == "item" && file == root_) {
                build_.push_back(part(element["path"], element["objectid"]));
            } else if (!object) {
                return true;
            } else if (element.name == "mesh") {
                in_mesh = true;
            } else if (element.name == "vertex" && in_mesh) {
                object->positions.push_back({number("x"), number("y"), number("z")});
            } else if (element.name == "triangle" && in_mesh) {
                dvec3 corners(number("v1"), number("v2"), number("v3"));
                for (int k = 0; k < 3; ++k)
                    if (!is_whole(corners[k], 0, double(object->positions.size()) - 1))
                        bad(fmt::format("a triangle naming vertex {} of {}, counted from 0,", corners[k],
                                        object->positions.size()));
                object->triangles.emplace_back(corners);
            } else if (element.name == "component") {
                object->parts.push_back(part(element["path"], element["objectid"]));
            } else if (element.name == "beam") {
                ++beams_;
            }
            return true;
        };
        read_xml(source, begins, [&](std::string_view name) {
            if (name == "object") object = nullptr;
            if (name == "mesh" || name == "object") in_mesh = false;
        });
    }

    // Slicers list in files of their own which parts only modify a body or its printing.
    void note_modifiers() {
        std::size_t modifiers = 0;
        for (const char* settings : {"Metadata/model_settings.config", "Metadata/Slic3r_PE_model.config"}) {
            if (!archive_.has(settings)) continue;
            const std::string text = unpack(settings);
            read_xml(Source(text, source_.name()), [&](const XmlElement& element) {
                const std::string_view type = element["key"] == "volume_type" ? element["value"] : "",
                                       part = element["subtype"];
                modifiers +=
                    (!part.empty() && part != "normal_part") || (!type.empty() && type != "ModelPart");
                return true;
            });
        }
        if (modifiers > 0)
            draft_.notes.push_back(fmt::format(
                "read {} parts like the others, which the slicer takes as negative or as modifiers",
                modifiers));
    }

    static std::string without_slash(std::string_view path) {
        return std::string(path.starts_with('/') ? path.substr(1) : path);
    }

    void read_unit(const XmlElement& model) {
        const std::string_view name = model.find("unit").value_or("millimeter");
        const auto unit = metres_of(name);
        if (!unit) source_.broken("the unknown unit " + in_quotes(name));
        draft_.unit = *unit;
    }

    void check_extensions(const XmlElement& model) const {
        std::string_view required = model["requiredextensions"];
        for (std::string_view prefix = word(required); !prefix.empty(); prefix = word(required)) {
            const std::string_view extension = model["xmlns:" + std::string(prefix)];
            const auto begins = [&](std::string_view start) { return extension.starts_with(start); };
            if (std::ranges::none_of(understood_namespaces, begins))
                source_.broken("a 3MF that requires the extension " +
                                   in_quotes(extension.empty() ? prefix : extension, 200) +
                                   ", which is not read,",
                               "export it without that, or as .stl");
        }
    }

    // A transform of twelve numbers: the images of the axes, and then of the origin.
    template <class Bad>
    static Transform transform(std::string_view text, Bad bad) {
        Transform transform;
        if (text.empty()) return transform;
        for (int k = 0; k < 12; ++k) {
            const auto value = parse_number(word(text));
            if (!value) bad("a transform that is not 12 numbers");
            (k < 9 ? transform.linear[k / 3] : transform.translation)[k % 3] = *value;
        }
        return transform;
    }

    void add(const Name& name, const Transform& transform, int depth) {
        if (depth > most_components_deep) source_.broken("an object that contains itself");
        budget_.spend(bytes_an_object);
        const auto found = objects_.find(name);
        if (found == objects_.end())
            source_.broken(fmt::format("an object {} that is missing", in_quotes(name.second)));
        const Object& object = found->second;
        if (object.is_support) {
            ++supports_;
            return;
        }
        const std::size_t first = draft_.positions.size();
        budget_.spend(object.positions.size(), sizeof(dvec3));
        budget_.spend(object.triangles.size(), 4 * sizeof(Index));
        if (first + object.positions.size() > ~Index(0)) source_.broken("more than 2^32 vertices");
        for (dvec3 p : object.positions) draft_.positions.push_back(transform.of(p));
        for (uvec3 t : object.triangles) {
            if (transform.mirrors()) std::swap(t.x, t.z);
            for (int k = 0; k < 3; ++k) draft_.corners.push_back(Index(first) + t[k]);
            draft_.sizes.push_back(3);
        }
        for (const Part& part : object.parts) add(part.object, transform * part.transform, depth + 1);
    }

    Source source_;
    Archive archive_;
    Budget budget_;
    std::string root_;
    std::set<std::string> known_, named_;  // files that were read, and that have to be
    std::map<Name, Object> objects_;
    std::vector<Part> build_;
    std::size_t supports_ = 0, beams_ = 0;
    Draft draft_;
};

}  // namespace

Draft read_3mf(Source source) { return ThreeMf(std::move(source)).read(); }

}  // namespace palpate
