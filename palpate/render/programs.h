#pragma once
#include "palpate/gl/program.h"

#include <compare>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace palpate {

/// Whether a surface has dents, and where its normals are then turned.
enum class Dented { no, at_vertices, at_fragments };

/// What not every surface has. One without it gets programs without it, since a software driver runs both
/// sides of every branch.
struct Features {
    Dented dented = Dented::no;
    bool images = false;  // laid over it, or one of its normals as colours

    auto operator<=>(const Features&) const = default;
};

/// What draws surfaces whose vertices lie where `map_vertex`, the text of a shader that defines a function of
/// that name, says; moved and turned by the GpuDents that are bound to `dents_binding`. `key_light`: the text
/// that says how much of it gets to a place.
struct SurfacePrograms {
    static constexpr GLuint dents_binding = 1;

    gl::Program shown;  // for a picture
    gl::Program depth;  // for a shadow map

    SurfacePrograms(std::string_view map_vertex, std::string_view key_light, Features features = {});
};

/// The map_vertex of surfaces that were mapped on the host, and of balls.
extern const char* const placed_glsl;

/// What draws the parts of a picture. Each name is also that of its shader files, which say what they take.
class Programs {
 public:
    /// Whether things cast shadows.
    explicit Programs(bool shadows);

    /// Compiled when it is first asked for.
    const SurfacePrograms& surface(const std::string& map_vertex, Features features);

    gl::Program background;
    SurfacePrograms placed;  // by placed_glsl, without features
    gl::Program ground;
    gl::Program wires;

 private:
    std::map<std::pair<std::string, Features>, SurfacePrograms> others_;
    bool shadows_;
};

}  // namespace palpate
