#include "palpate/render/programs.h"

#include "palpate/render/gpu_dents.h"

#include <string>

namespace palpate {
namespace {

const char* background_frag =
#include "embedded/background.frag.h"
    ;
const char* depth_vert =
#include "embedded/depth.vert.h"
    ;
const char* ground_frag =
#include "embedded/ground.frag.h"
    ;
const char* ground_vert =
#include "embedded/ground.vert.h"
    ;
const char* light_frag =
#include "embedded/light.frag.h"
    ;
const char* no_shadows_frag =
#include "embedded/no_shadows.frag.h"
    ;
const char* screen_vert =
#include "embedded/screen.vert.h"
    ;
const char* shadows_frag =
#include "embedded/shadows.frag.h"
    ;
const char* sky_glsl =
#include "embedded/sky.glsl.h"
    ;
const char* surface_frag =
#include "embedded/surface.frag.h"
    ;
const char* surface_vert =
#include "embedded/surface.vert.h"
    ;
const char* tone_frag =
#include "embedded/tone.frag.h"
    ;
const char* wires_frag =
#include "embedded/wires.frag.h"
    ;
const char* wires_vert =
#include "embedded/wires.vert.h"
    ;

const std::string version = "#version 450 core\n";

std::string beginning(Features features) { return version + (features.images ? "#define IMAGES\n" : ""); }

std::string before_vertices(Features features) {
    if (features.dented == Dented::no) return beginning(features);
    return beginning(features) + (features.dented == Dented::at_vertices ? "#define TURNED_HERE\n" : "") +
           GpuDents::shader(SurfacePrograms::dents_binding);
}

std::string before_fragments(Features features) {
    if (features.dented != Dented::at_fragments) return beginning(features);
    return beginning(features) + GpuDents::shader(SurfacePrograms::dents_binding);
}

const char* key_light(bool shadows) { return shadows ? shadows_frag : no_shadows_frag; }

}  // namespace

const char* const placed_glsl =
#include "embedded/placed.glsl.h"
    ;

SurfacePrograms::SurfacePrograms(std::string_view map_vertex, std::string_view key_light, Features features)
    : shown({{GL_VERTEX_SHADER, "surface.vert", before_vertices(features) + surface_vert},
             {GL_VERTEX_SHADER, "map_vertex()", map_vertex},
             {GL_VERTEX_SHADER, "sky.glsl", sky_glsl},
             {GL_FRAGMENT_SHADER, "surface.frag", before_fragments(features) + surface_frag},
             {GL_FRAGMENT_SHADER, "light.frag", light_frag},
             {GL_FRAGMENT_SHADER, "key_share()", key_light},
             {GL_FRAGMENT_SHADER, "tone.frag", tone_frag}}),
      depth({{GL_VERTEX_SHADER, "depth.vert", before_vertices(features) + depth_vert},
             {GL_VERTEX_SHADER, "map_vertex()", map_vertex}}) {}

Programs::Programs(bool shadows)
    : background({{GL_VERTEX_SHADER, "screen.vert", screen_vert},
                  {GL_FRAGMENT_SHADER, "background.frag", background_frag},
                  {GL_FRAGMENT_SHADER, "tone.frag", tone_frag}}),
      placed(placed_glsl, key_light(shadows)),
      ground({{GL_VERTEX_SHADER, "ground.vert", ground_vert},
              {GL_FRAGMENT_SHADER, "ground.frag", ground_frag},
              {GL_FRAGMENT_SHADER, "sky.glsl", sky_glsl},
              {GL_FRAGMENT_SHADER, "light.frag", light_frag},
              {GL_FRAGMENT_SHADER, "key_share()", key_light(shadows)},
              {GL_FRAGMENT_SHADER, "tone.frag", tone_frag}}),
      wires({{GL_VERTEX_SHADER, "wires.vert", wires_vert},
             {GL_FRAGMENT_SHADER, "wires.frag", wires_frag},
             {GL_FRAGMENT_SHADER, "tone.frag", tone_frag}}),
      shadows_(shadows) {}

const SurfacePrograms& Programs::surface(const std::string& map_vertex, Features features) {
    if (map_vertex == placed_glsl && features == Features{}) return placed;
    return others_.try_emplace({map_vertex, features}, map_vertex, key_light(shadows_), features)
        .first->second;
}

}  // namespace palpate
