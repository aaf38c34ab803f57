#pragma once
#include "palpate/gl/program.h"

#include <compare>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace palpate {

/// Whether a surface has dents, and in which shader they turn its normals.
enum class Dented { no, at_vertices, at_fragments };

/// What only some surfaces have. Each combination has shaders of its own, since a software driver runs both
/// sides of every branch.
struct Features {
    Dented dented = Dented::no;
    bool images = false;  // a colour map or a normal map, or normals shown as colours

    auto operator<=>(const Features&) const = default;
};

/// The programs that draw surfaces. `map_vertex` is the text of a shader that defines a function of that
/// name, which places the vertices; the GpuDents bound to `dents_binding` then move them. `key_light` is the
/// text that defines key_share(): how much of the key light reaches a place.
struct SurfacePrograms {
    static constexpr GLuint dents_binding = 1;

    gl::Program shown;  // for a picture
    gl::Program depth;  // for a shadow map

    SurfacePrograms(std::string_view map_vertex, std::string_view key_light, Features features = {});
};

/// The map_vertex() of surfaces that were mapped on the host, and of balls.
extern const char* const placed_glsl;

/// The programs that draw the parts of a picture. Each has the name of its shader files, which list their
/// uniforms.
class Programs {
 public:
    /// Whether things cast shadows.
    explicit Programs(bool shadows);

    /// Compiled when it is first asked for.
    const SurfacePrograms& surface(const std::string& map_vertex, Features features);

    gl::Program background;
    SurfacePrograms placed;  // with placed_glsl, without features
    gl::Program ground;
    gl::Program wires;

 private:
    std::map<std::pair<std::string, Features>, SurfacePrograms> others_;
    bool shadows_;
};

}  // namespace palpate
