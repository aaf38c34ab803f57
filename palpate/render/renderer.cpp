#include "palpate/render/renderer.h"

#include "palpate/base/error.h"
#include "palpate/gl/buffer.h"
#include "palpate/gl/context.h"
#include "palpate/gl/visit.h"
#include "palpate/render/ambient_occlusion.h"
#include "palpate/render/culling.h"
#include "palpate/render/gpu_dents.h"
#include "palpate/render/gpu_embedding.h"
#include "palpate/render/lighting.h"
#include "palpate/render/programs.h"
#include "palpate/render/reach.h"
#include "palpate/render/shadow_map.h"
#include "palpate/render/target.h"
#include "palpate/render/unit_ball.h"
#include "palpate/render/view.h"
#include "palpate/voxels/thinned.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace palpate {
namespace {

constexpr int shadow_size = 1024;    // pixels
constexpr float wire_width = 1.3f;   // pixels
constexpr float wire_lift = 0.005f;  // in radii of the scene; see wires.vert
constexpr float ball_shine = 0.4f;
constexpr std::size_t few_triangles = 24'000, few_of_ball = 1'280;
constexpr std::size_t cluster_vertices = 64, cluster_faces = 124;
constexpr GLuint colour_map_unit = 4, normal_map_unit = 5;  // as in surface.frag

// The attributes of placed.glsl and surface.vert.
enum Attribute : GLuint {
    position_attribute,
    normal_attribute,
    ambient_occlusion_attribute = GpuEmbedding::free_attribute,
    uv_attribute
};

struct Triangles {
    gl::Buffer corners;
    GLsizei count = 0;  // of indices
};

// What is constant of a mesh.
struct DrawnMesh {
    Triangles triangles;
    Triangles few;  // the level of detail for Quality::every_triangle = false
    gl::Buffer ambient_occlusion, uvs;
    bool has_uvs = false;
    std::size_t vertices = 0;
    bool closed = false;  // then its back faces are never seen
    // If it was added with an embedding:
    std::optional<GpuEmbedding> embedding;
    std::optional<Culling> culling;
    Reach reach;
};

// What moves of it, for one surface of the picture: its vertices, or the nodes that they follow.
struct Moving {
    gl::Buffer positions;
    gl::Buffer normals;
    gl::Buffer uvs;
    bool has_uvs = false;  // of its own
    GpuNodes nodes = {};   // if it follows nodes: these buffers, or the picture's
    GpuDents dents;
};

// One pass over the surfaces, for the picture or for a shadow map.
struct SurfacePass {
    View view;
    std::function<const gl::Program&(const SurfacePrograms&)> begin;  // sets the uniforms of the program
    bool culls;
};

// Whether the mesh is closed, with two triangles at every edge, and its triangles face outwards.
bool closed(const Mesh& mesh) {
    std::vector<std::pair<unsigned, unsigned>> there, back;
    for (uvec3 t : mesh.triangles)
        for (auto [a, b] : {std::pair(t.x, t.y), std::pair(t.y, t.z), std::pair(t.z, t.x)}) {
            there.emplace_back(a, b);
            back.emplace_back(b, a);
        }
    std::sort(there.begin(), there.end());
    std::sort(back.begin(), back.end());
    return there == back && volume(mesh) > 0;
}

Triangles buffered(const std::vector<uvec3>& list) {
    return {gl::Buffer(list), static_cast<GLsizei>(3 * list.size())};
}

DrawnMesh model(const Mesh& mesh, gl::Buffer ambient_occlusion, std::size_t few = few_triangles) {
    DrawnMesh made;
    made.triangles = buffered(mesh.triangles);
    made.few = buffered(thinned(mesh, few));
    made.ambient_occlusion = std::move(ambient_occlusion);
    made.has_uvs = !mesh.uvs.empty();
    made.uvs = gl::Buffer(mesh.uvs);
    made.vertices = mesh.positions.size();
    made.closed = closed(mesh);
    return made;
}

gl::Buffer wide_open(std::size_t vertices) {
    const std::vector<float> ones(vertices, 1.0f);
    return gl::Buffer(ones);
}

// An attribute from a buffer of its own, whose binding has the attribute's number.
void enable(GLuint corners, Attribute number, int numbers) {
    glEnableVertexArrayAttrib(corners, number);
    glVertexArrayAttribFormat(corners, number, numbers, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(corners, number, number);
}

gl::VertexArray corners_of_surfaces() {
    gl::VertexArray corners;
    enable(corners.name(), position_attribute, 3);
    enable(corners.name(), normal_attribute, 3);
    enable(corners.name(), ambient_occlusion_attribute, 1);
    enable(corners.name(), uv_attribute, 2);
    return corners;
}

void attach_uvs(const gl::Buffer& uvs, bool has_uvs, GLuint corners) {
    glVertexArrayVertexBuffer(corners, uv_attribute, uvs.name(), 0, sizeof(vec2));
    (has_uvs ? glEnableVertexArrayAttrib : glDisableVertexArrayAttrib)(corners, uv_attribute);
}

// Attaches the constant attributes of a model to the vertex array `corners`.
void attach(const DrawnMesh& model, GLuint corners) {
    glVertexArrayVertexBuffer(corners, ambient_occlusion_attribute, model.ambient_occlusion.name(), 0,
                              sizeof(float));
    attach_uvs(model.uvs, model.has_uvs, corners);
}

gl::Sampler sampler_of_maps() {
    gl::Sampler sampler;
    glSamplerParameteri(sampler.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glSamplerParameteri(sampler.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    if (epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic")) {
        GLfloat most = 1;
        glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &most);
        glSamplerParameterf(sampler.name(), GL_TEXTURE_MAX_ANISOTROPY_EXT, std::min(most, 8.0f));
    }
    return sampler;
}

// OpenGL's rows go from bottom to top.
gl::Texture texture_of(const Image& image, Texels texels) {
    check_size(image.width, image.height);
    if (image.pixels.size() != 4 * std::size_t(image.width) * std::size_t(image.height))
        throw Error("an image whose number of pixels differs from its width times height", "Renderer",
                    "give it four bytes for each pixel");
    std::vector<std::uint8_t> rows;
    rows.reserve(image.pixels.size());
    const std::ptrdiff_t bytes = 4 * std::ptrdiff_t(image.width);
    for (auto end = image.pixels.end(); end != image.pixels.begin(); end -= bytes)
        rows.insert(rows.end(), end - bytes, end);
    return gl::Texture::with_mipmaps(texels == Texels::colours ? GL_SRGB8_ALPHA8 : GL_RGBA8, image.width,
                                     image.height, rows.data());
}

std::vector<vec4> with_room(std::span<const vec3> vectors) {
    std::vector<vec4> list;
    list.reserve(vectors.size());
    for (vec3 v : vectors) list.emplace_back(v, 0.0f);
    return list;
}

Bounds box_around(const Surface& surface, const Reach& reach) {
    if (!surface.positions.empty()) return bounds_of(surface.positions);
    const vec3 corners[] = {surface.gpu_nodes.bounds.low, surface.gpu_nodes.bounds.high};
    return reach.around(surface.gpu_nodes.positions != 0 ? bounds_of(corners)
                                                         : bounds_of(surface.nodes.positions));
}

// The square of ground that is drawn. Its centre is below the things.
struct Square {
    vec3 upright;
    vec3 middle;
    float half;  // m; half its width
};

Square square(const Ground& ground, const Extent& things) {
    const vec3 upright = unit(ground.normal, vec3(0, 1, 0));
    const float away = ground.offset - dot(upright, things.centre);
    return {upright, things.centre + away * upright, 3.5f * things.radius + 2 * std::abs(away)};
}

// The bounding sphere of things and grounds: the near and far planes must cut neither.
Extent with_grounds(const Picture& picture, const Extent& things) {
    Extent all = things;
    for (const Ground& ground : picture.grounds) {
        const Square part = square(ground, things);
        const float corner = distance(part.middle, things.centre) + 1.5f * part.half;
        all.radius = std::max(all.radius, corner);
    }
    return all;
}

void check(const Quality& quality) {
    if (quality.samples != 1 && quality.samples != 2 && quality.samples != 4 && quality.samples != 8)
        throw Error(fmt::format("{} samples per pixel cannot be drawn", quality.samples), "Quality",
                    "choose 1, 2, 4 or 8");
    if (!(quality.scale >= 0.25f && quality.scale <= 1))
        throw Error(fmt::format("a scale of {} for the number of pixels is out of range", quality.scale),
                    "Quality", "choose 0.25 to 1");
}

Target target(Offscreen size, const Quality& quality) {
    check_size(size.width, size.height);
    auto scaled = [&](int pixels) {
        return std::max(1, static_cast<int>(std::lround(quality.scale * static_cast<float>(pixels))));
    };
    return Target(scaled(size.width), scaled(size.height), quality.samples);
}

}  // namespace

struct Renderer::Parts {
    std::optional<gl::Context> own;  // first, because everything else lives in it
    const gl::Context& context;
    Offscreen size;
    Quality quality;
    Target target;
    ShadowMap shadow{shadow_size};
    AmbientOcclusion ambient_occlusion;
    std::map<bool, Programs> all_programs;  // with shadows and without

    gl::VertexArray surface_corners = corners_of_surfaces();
    gl::VertexArray no_corners;  // for shaders that make their own vertices
    std::vector<gl::Texture> maps;
    gl::Sampler map_sampler = sampler_of_maps();
    std::vector<DrawnMesh> models;
    std::vector<Moving> moving;
    DrawnMesh ball_model;
    Moving ball_shape;
    gl::Buffer wire_points, wire_lines;

    Parts(Offscreen wanted, const gl::Context* given);
    ~Parts() { context.make_current_or_not(); }

    Programs& programs() { return all_programs.try_emplace(quality.shadows, quality.shadows).first->second; }
    const Triangles& triangles(const DrawnMesh& model) const {
        return quality.every_triangle ? model.triangles : model.few;
    }
    void check(const Picture& picture) const;
    void draw(const Picture& picture);
    std::vector<Bounds> boxes(const std::vector<Surface>& surfaces) const;
    void upload(const std::vector<Surface>& surfaces);
    void upload(const Surface& surface, Moving& to) const;
    void cast_shadows(const Picture& picture, const Lighting& light);
    void draw_background();
    const SurfacePrograms& programs_for(const DrawnMesh& model, const Moving& shape, const Look& look);
    void draw_surfaces(const std::vector<Surface>& surfaces, const SurfacePass& pass);
    void draw_balls(const std::vector<Ball>& balls, const SurfacePass& pass);
    void bind(const DrawnMesh& model, const Moving& shape) const;
    void set_look(const gl::Program& program, const Look& look, const DrawnMesh& model,
                  const Moving& shape) const;
    void draw_triangles(const DrawnMesh& model) const;
    void draw_wires(const Wires& some, const View& seen, const Extent& things);
    void draw_ground(const Ground& one, const View& seen, const Extent& things);
};

// The members made after the context need it current.
const gl::Context& current(std::optional<gl::Context>& own, const gl::Context* given) {
    const gl::Context& context = given ? *given : own.emplace();
    context.make_current();
    return context;
}

Renderer::Parts::Parts(Offscreen wanted, const gl::Context* given)
    : context(current(own, given)), size(wanted), target(palpate::target(size, quality)) {
    programs();  // compiles them here, so that a driver that cannot do so fails early
    const Mesh mesh = unit_ball();
    ball_model = model(mesh, wide_open(mesh.positions.size()), few_of_ball);
    ball_shape.positions = gl::Buffer(mesh.positions);
    ball_shape.normals = gl::Buffer(mesh.normals);
}

void Renderer::Parts::check(const Picture& picture) const {
    auto require = [](bool holds, std::string_view what, std::string_view remedy) {
        if (!holds) throw Error(what, "a picture", remedy);
    };
    for (const Surface& surface : picture.surfaces) {
        require(surface.mesh >= 0 && std::size_t(surface.mesh) < models.size(),
                "a surface of a mesh that was not added", "use the numbers that Renderer::add gave");
        for (int map : {surface.look.colour_map, surface.look.normal_map})
            require(map < int(maps.size()), "a map that was not added",
                    "use the numbers that Renderer::add gave, or -1 for none");
        const DrawnMesh& model = models[std::size_t(surface.mesh)];
        require(surface.uvs.empty() ||
                    (surface.uvs.size() == model.vertices && surface.positions.size() == model.vertices),
                "texture coordinates of another number than the mesh's vertices, or without positions",
                "give every vertex one of each");
        if (!surface.positions.empty() || !model.embedding) {
            require(surface.positions.size() == model.vertices && surface.normals.size() == model.vertices,
                    "a surface whose number of positions or normals differs from the number of its mesh's "
                    "vertices",
                    "give every vertex one of each, or add the mesh with an embedding and give it nodes");
        } else if (surface.gpu_nodes.positions == 0) {
            const std::size_t count = model.embedding->nodes();
            require(surface.nodes.positions.size() >= count, "fewer nodes than the surface follows",
                    "hand in all nodes of its body");
            require(!model.embedding->needs_normals() || surface.nodes.normals.size() >= count,
                    "the approximate normals of the nodes are missing, which the surface's mapping needs",
                    "hand in Solver::nodes(), or approximate_normals()");
        }
    }
    for (const Wires& some : picture.wires)
        for (uvec2 line : some.lines)
            require(std::max(line.x, line.y) < some.points.size(), "a line that refers to a missing point",
                    "count points from 0");
}

void Renderer::Parts::draw(const Picture& picture) {
    const std::vector<Bounds> around = boxes(picture.surfaces);
    const Extent things = extent(picture, around);
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    const View seen = view(picture.camera, aspect, with_grounds(picture, things));
    const Lighting light = lighting(picture, around, shadow_size);
    auto begin = [&](const SurfacePrograms& some) -> const gl::Program& {
        set_uniforms(some.shown, seen, light, picture.balls.size());
        return some.shown;
    };
    const SurfacePass shown{seen, begin, picture.culls};
    set_uniforms(programs().ground, seen, light, light.round.size());

    upload(picture.surfaces);
    if (quality.shadows) cast_shadows(picture, light);
    target.begin();
    draw_surfaces(picture.surfaces, shown);
    draw_background();
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    for (const Wires& some : picture.wires) draw_wires(some, seen, things);
    // After the wires, as they shine through surfaces but not through tools.
    draw_balls(picture.balls, shown);
    for (const Ground& one : picture.grounds) draw_ground(one, seen, things);
    glDisable(GL_BLEND);
    target.end();
}

std::vector<Bounds> Renderer::Parts::boxes(const std::vector<Surface>& surfaces) const {
    std::vector<Bounds> list;
    for (const Surface& surface : surfaces)
        list.push_back(box_around(surface, models[std::size_t(surface.mesh)].reach));
    return list;
}

void Renderer::Parts::upload(const std::vector<Surface>& surfaces) {
    while (moving.size() < surfaces.size()) moving.emplace_back();
    for (std::size_t i = 0; i < surfaces.size(); ++i) upload(surfaces[i], moving[i]);
}

void Renderer::Parts::upload(const Surface& surface, Moving& to) const {
    const DrawnMesh& model = models[std::size_t(surface.mesh)];
    to.nodes = {};
    to.has_uvs = !surface.uvs.empty();
    if (to.has_uvs) to.uvs.upload(surface.uvs);
    if (to.dents.count() > 0 || !surface.dents.empty()) to.dents.set(surface.dents);
    if (surface.positions.size() == model.vertices) {
        to.positions.upload(surface.positions);
        to.normals.upload(surface.normals);
        return;
    }
    to.nodes = surface.gpu_nodes;
    if (to.nodes.positions != 0) return;
    to.positions.upload(with_room(surface.nodes.positions));
    to.nodes.positions = to.positions.name();
    if (!model.embedding->needs_normals()) return;
    to.normals.upload(with_room(surface.nodes.normals));
    to.nodes.normals = to.normals.name();
}

void Renderer::Parts::cast_shadows(const Picture& picture, const Lighting& light) {
    auto begin = [&](const SurfacePrograms& some) -> const gl::Program& {
        some.depth.set("to_clip", light.to_clip);
        return some.depth;
    };
    const View from_light{light.to_clip, vec4(light.to_light, 0), vec3(0)};
    const SurfacePass depth{from_light, begin, picture.culls};
    shadow.begin();
    draw_surfaces(picture.surfaces, depth);
    draw_balls(picture.balls, depth);
    shadow.bind();
}

void Renderer::Parts::draw_background() {
    const gl::Program& background = programs().background;
    background.use();
    background.set("picture", vec2(target.width(), target.height()));
    glDepthFunc(GL_LEQUAL);  // only where nothing is drawn yet: the background lies on the far plane
    glBindVertexArray(no_corners.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthFunc(GL_LESS);
}

const SurfacePrograms& Renderer::Parts::programs_for(const DrawnMesh& model, const Moving& shape,
                                                     const Look& look) {
    Features features{.images = look.colour_map >= 0 || look.normal_map >= 0 || look.shows_normals};
    if (shape.dents.count() > 0)
        features.dented = look.coarse_dents ? Dented::at_vertices : Dented::at_fragments;
    if (shape.nodes.positions == 0) return programs().surface(placed_glsl, features);
    return programs().surface("#version 450 core\n" + model.embedding->shader(shape.nodes.width > 0),
                              features);
}

void Renderer::Parts::draw_surfaces(const std::vector<Surface>& surfaces, const SurfacePass& pass) {
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const DrawnMesh& model = models[surfaces[i].mesh];
        const gl::Program& program = pass.begin(programs_for(model, moving[i], surfaces[i].look));
        bind(model, moving[i]);
        const bool dented = moving[i].dents.count() > 0;
        if (dented) moving[i].dents.bind(SurfacePrograms::dents_binding);
        const bool culls = pass.culls && quality.every_triangle && moving[i].nodes.positions != 0;
        // A dent may turn triangles arbitrarily, but moves them no farther than this.
        if (culls)
            model.culling->find(pass.view, model.closed && !dented, moving[i].nodes.width > 0,
                                largest_displacement(surfaces[i].dents));
        program.use();
        program.set("centre", vec3(0));
        program.set("size", 1.0f);
        set_look(program, surfaces[i].look, model, moving[i]);
        // Back-face culling saves half of the fragments, which are what costs most.
        if (model.closed) glEnable(GL_CULL_FACE);
        if (culls)
            model.culling->draw();
        else
            draw_triangles(model);
        glDisable(GL_CULL_FACE);
    }
}

void Renderer::Parts::draw_balls(const std::vector<Ball>& balls, const SurfacePass& pass) {
    const gl::Program& program = pass.begin(programs().placed);
    bind(ball_model, ball_shape);
    program.use();
    set_look(program, {.shine = ball_shine}, ball_model, ball_shape);
    for (const Ball& ball : balls) {
        program.set("centre", ball.centre);
        program.set("size", ball.radius);
        program.set("albedo", ball.colour);
        draw_triangles(ball_model);
    }
}

void Renderer::Parts::bind(const DrawnMesh& model, const Moving& shape) const {
    const bool placed = shape.nodes.positions == 0;
    const GLuint corners = placed ? surface_corners.name() : model.embedding->vertex_array();
    glVertexArrayElementBuffer(corners, triangles(model).corners.name());
    if (!placed) return model.embedding->bind(shape.nodes);
    glVertexArrayVertexBuffer(corners, position_attribute, shape.positions.name(), 0, sizeof(vec3));
    glVertexArrayVertexBuffer(corners, normal_attribute, shape.normals.name(), 0, sizeof(vec3));
    attach(model, corners);
    if (shape.has_uvs) attach_uvs(shape.uvs, true, corners);
    glBindVertexArray(corners);
}

void Renderer::Parts::set_look(const gl::Program& program, const Look& look, const DrawnMesh& model,
                               const Moving& shape) const {
    const bool has_tangents = shape.nodes.positions != 0 && model.embedding->has_tangents();
    const bool coloured = look.colour_map >= 0 && (model.has_uvs || shape.has_uvs);
    const bool bumpy = look.normal_map >= 0 && model.has_uvs && has_tangents;
    program.set("albedo", look.colour);
    program.set("shine", look.shine);
    program.set("coloured", coloured);
    program.set("bumpy", bumpy);
    program.set("shows_normals", look.shows_normals);
    auto lay = [&](GLuint unit, int map) {
        glBindTextureUnit(unit, maps.at(map).name());
        glBindSampler(unit, map_sampler.name());
    };
    if (coloured) lay(colour_map_unit, look.colour_map);
    if (bumpy) lay(normal_map_unit, look.normal_map);
}

void Renderer::Parts::draw_triangles(const DrawnMesh& model) const {
    glDrawElements(GL_TRIANGLES, triangles(model).count, GL_UNSIGNED_INT, nullptr);
}

// Draws them twice: where nothing hides them, and faintly where something does.
void Renderer::Parts::draw_wires(const Wires& some, const View& seen, const Extent& things) {
    if (some.lines.empty()) return;
    wire_points.upload(some.points);
    wire_lines.upload(some.lines);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, wire_points.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, wire_lines.name());
    const gl::Program& wires = programs().wires;
    wires.use();
    wires.set("to_clip", seen.to_clip);
    wires.set("eye", seen.eye);
    wires.set("lift", wire_lift * things.radius);
    wires.set("middle", things.centre);
    wires.set("radius", things.radius);
    wires.set("picture", vec2(target.width(), target.height()));
    wires.set("width", wire_width);
    wires.set("albedo", some.colour);
    glBindVertexArray(no_corners.name());

    const auto lines = static_cast<GLsizei>(some.lines.size());
    wires.set("near", 1.0f);
    wires.set("far", 0.1f);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, lines);

    wires.set("near", 0.35f);
    wires.set("far", -0.9f);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_FALSE);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, lines);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
}

void Renderer::Parts::draw_ground(const Ground& one, const View& seen, const Extent& things) {
    const Square part = square(one, things);
    const bool from_above = dot(vec3(seen.eye) - seen.eye.w * part.middle, part.upright) > 0;
    if (!from_above) return;
    const mat3 frame = axes(part.upright, seen.up);
    const gl::Program& ground = programs().ground;
    ground.use();
    ground.set("upright", part.upright);
    ground.set("middle", part.middle);
    ground.set("along", part.half * frame[0]);
    ground.set("across", part.half * frame[1]);
    glBindVertexArray(no_corners.name());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

Renderer::Renderer(Offscreen size, const gl::Context* context)
    : parts_(std::make_unique<Parts>(size, context)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::resize(Offscreen size) {
    parts_->context.make_current();
    parts_->target = target(size, parts_->quality);
    parts_->size = size;
}

void Renderer::set(const Quality& quality) {
    check(quality);
    parts_->context.make_current();
    parts_->target = target(parts_->size, quality);
    parts_->quality = quality;
}

void Renderer::clear() {
    parts_->context.make_current();
    parts_->models.clear();
    parts_->moving.clear();
    parts_->maps.clear();
}

int Renderer::add(const Mesh& mesh) {
    check(mesh, "a mesh that is added to a Renderer");
    parts_->context.make_current();
    const gl::Visit visit;
    parts_->models.push_back(
        model(mesh, parts_->ambient_occlusion.measure(mesh, parts_->programs().placed.depth)));
    return static_cast<int>(parts_->models.size()) - 1;
}

int Renderer::add(const Mesh& mesh, const Embedding& embedding) {
    const int number = add(mesh);
    DrawnMesh& model = parts_->models.back();
    const Clusters groups = clusters(mesh, cluster_vertices, cluster_faces);
    model.triangles = buffered(groups.triangles);
    model.embedding.emplace(embedding);
    model.culling.emplace(groups, mesh, embedding);
    model.reach = palpate::reach(mesh, embedding);
    const GLuint corners = model.embedding->vertex_array();
    enable(corners, ambient_occlusion_attribute, 1);
    enable(corners, uv_attribute, 2);
    attach(model, corners);
    return number;
}

int Renderer::add(const Image& image, Texels texels) {
    parts_->context.make_current();
    const gl::Visit visit;
    parts_->maps.push_back(texture_of(image, texels));
    return static_cast<int>(parts_->maps.size()) - 1;
}

void Renderer::draw(const Picture& picture) {
    parts_->check(picture);
    parts_->context.make_current();
    const gl::Visit visit;
    parts_->draw(picture);
}

void Renderer::show(ivec2 corner) const {
    parts_->context.make_current();
    const gl::Visit visit;
    parts_->target.show(corner, corner + ivec2(parts_->size.width, parts_->size.height));
}

Image Renderer::image() const {
    parts_->context.make_current();
    return parts_->target.read(parts_->context);
}

Culled Renderer::culled(int mesh) const {
    if (mesh < 0 || std::size_t(mesh) >= parts_->models.size())
        throw Error("no mesh has the number " + std::to_string(mesh), "the Renderer",
                    "use what Renderer::add gave");
    const DrawnMesh& model = parts_->models[std::size_t(mesh)];
    return model.culling ? model.culling->count(parts_->context) : Culled{};
}

const gl::Context& Renderer::context() const { return parts_->context; }

}  // namespace palpate
