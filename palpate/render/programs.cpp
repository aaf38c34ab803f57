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
const char* screen_vert =
#include "embedded/screen.vert.h"
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

std::string before_vertices(Dented dented) {
    if (dented == Dented::no) return version;
    return version + (dented == Dented::at_vertices ? "#define TURNED_HERE\n" : "") +
           GpuDents::shader(SurfacePrograms::dents_binding);
}

std::string before_fragments(Dented dented) {
    if (dented != Dented::at_fragments) return version;
    return version + GpuDents::shader(SurfacePrograms::dents_binding);
}

}  // namespace

const char* const placed_glsl =
#include "embedded/placed.glsl.h"
    ;

SurfacePrograms::SurfacePrograms(std::string_view map_vertex, Dented dented)
    : shown({{GL_VERTEX_SHADER, "surface.vert", before_vertices(dented) + surface_vert},
             {GL_VERTEX_SHADER, "map_vertex()", map_vertex},
             {GL_VERTEX_SHADER, "sky.glsl", sky_glsl},
             {GL_FRAGMENT_SHADER, "surface.frag", before_fragments(dented) + surface_frag},
             {GL_FRAGMENT_SHADER, "light.frag", light_frag},
             {GL_FRAGMENT_SHADER, "tone.frag", tone_frag}}),
      depth({{GL_VERTEX_SHADER, "depth.vert", before_vertices(dented) + depth_vert},
             {GL_VERTEX_SHADER, "map_vertex()", map_vertex}}) {}

Programs::Programs()
    : background({{GL_VERTEX_SHADER, "screen.vert", screen_vert},
                  {GL_FRAGMENT_SHADER, "background.frag", background_frag},
                  {GL_FRAGMENT_SHADER, "tone.frag", tone_frag}}),
      placed(placed_glsl),
      ground({{GL_VERTEX_SHADER, "ground.vert", ground_vert},
              {GL_FRAGMENT_SHADER, "ground.frag", ground_frag},
              {GL_FRAGMENT_SHADER, "sky.glsl", sky_glsl},
              {GL_FRAGMENT_SHADER, "light.frag", light_frag},
              {GL_FRAGMENT_SHADER, "tone.frag", tone_frag}}),
      wires({{GL_VERTEX_SHADER, "wires.vert", wires_vert},
             {GL_FRAGMENT_SHADER, "wires.frag", wires_frag},
             {GL_FRAGMENT_SHADER, "tone.frag", tone_frag}}) {}

}  // namespace palpate
