#include "palpate/run/scenery.h"

#include "palpate/render/shapes.h"
#include "palpate/run/run.h"

#include <algorithm>
#include <array>

namespace palpate {
namespace {

constexpr float collider_shine = 0.4f;

// The shaft behind a tip at the origin; empty if it has none.
Collider shaft_of(const ToolRecipe& tool) {
    if (!(tool.shaft > 0)) return {Sphere{}};
    return {Capsule{vec3(0), -tool.shaft * glm::normalize(tool.along), tool.radius}};
}

// The colours of pressures: from pale, where there is none, over yellow and red to nearly black.
Image scale_of_pressure() {
    constexpr std::array<vec3, 5> stops = {vec3(230, 226, 220), vec3(252, 208, 74), vec3(237, 105, 37),
                                           vec3(159, 42, 99), vec3(20, 11, 52)};
    constexpr int parts = 64;
    Image image{.width = parts * int(stops.size() - 1), .height = 1, .pixels = {}};
    for (int x = 0; x < image.width; ++x) {
        const auto from = std::size_t(x / parts);
        const vec3 colour = glm::mix(stops[from], stops[from + 1], float(x % parts) / parts);
        for (int k = 0; k < 3; ++k) image.pixels.push_back(std::uint8_t(colour[k] + 0.5f));
        image.pixels.push_back(255);
    }
    return image;
}

// Where vertices of these pressures are in that image, which repeats beyond its middle pixels.
std::vector<vec2> places_in_scale(const std::vector<float>& pressures, float most) {
    std::vector<vec2> places;
    for (float pressure : pressures) places.emplace_back(std::clamp(pressure / most, 0.01f, 0.99f), 0.5f);
    return places;
}

Look look_of(const BodyRecipe& recipe, const Model& model, Renderer& renderer) {
    Look look{recipe.colour, recipe.shine};
    if (model.colour_map.width > 0) look.colour_map = renderer.add(model.colour_map, Texels::colours);
    if (model.normal_map.width > 0) look.normal_map = renderer.add(model.normal_map, Texels::normals);
    look.shows_normals = recipe.shade == Shade::normals;
    if (recipe.shade == Shade::pressure) {
        look.colour = vec3(1);
        look.colour_map = renderer.add(scale_of_pressure(), Texels::colours);
    }
    return look;
}

}  // namespace

Scenery::Scenery(const Scene& scene, const Models& made, Renderer& renderer, Mapped mapped)
    : scene_(&scene), made_(&made), mapped_(mapped) {
    for (std::size_t m = 0; m < made.models.size(); ++m) {
        const Model& model = made.models[m];
        const bool hangs = mapped == Mapped::either || mapped_where_drawn(m);
        meshes_.push_back(hangs ? renderer.add(model.surface, model.embedding) : renderer.add(model.surface));
        looks_.push_back(look_of(scene.bodies[m], model, renderer));
    }
    for (std::size_t s = 0; s < made.static_surfaces.size(); ++s) {
        const BodyRecipe& recipe = scene.surfaces[s];
        meshes_.push_back(renderer.add(made.static_surfaces[s].surface));
        looks_.push_back({.colour = recipe.colour,
                          .shine = recipe.shine,
                          .shows_normals = recipe.shade == Shade::normals});
    }
    for (const Collider& collider : made.simulation.colliders)
        shapes_.push_back(shape_of(collider, renderer));
    for (const ToolRecipe& tool : scene.tools) shafts_.push_back(shape_of(shaft_of(tool), renderer));
    dents_.resize(meshes_.size());
}

Scenery::Shape Scenery::shape_of(const Collider& collider, Renderer& renderer) const {
    Shape shape;
    shape.rest = shape.now = shape_mesh(collider);
    if (!shape.rest.triangles.empty()) shape.mesh = renderer.add(shape.rest);
    return shape;
}

// If the GPU moves the nodes, it maps the surfaces, too; normal maps need tangents, which only the GPU maps.
// The pressure is found on the host.
bool Scenery::mapped_where_drawn(std::size_t body) const {
    if (scene_->bodies[body].shade == Shade::pressure) return false;
    return on_gpu(made_->simulation.backend) || made_->models[body].normal_map.width > 0;
}

Picture Scenery::picture(double time, const Play& play, const Camera& camera, bool springs) {
    Picture picture;
    picture.camera = camera;
    picture.light = scene_->light;
    add_bodies(play, springs, picture);
    for (std::size_t s = made_->models.size(); s < meshes_.size(); ++s) {
        const Skin& skin = play.skins()[s];
        picture.surfaces.push_back(
            {.mesh = meshes_[s], .positions = skin.positions, .normals = skin.normals, .look = looks_[s]});
    }
    for (std::size_t s = 0; s < meshes_.size(); ++s) {
        dents_[s] = play.dents(s);
        picture.surfaces[s].dents = dents_[s];
    }
    add_shafts(play, picture);
    add_tools(play, picture);
    add_colliders(play.colliders(time, frame_seconds), picture);
    return picture;
}

namespace {

// A body's springs, or where it is tissue the edges of its cells.
std::vector<uvec2> lines_of(const Body& body) {
    std::vector<uvec2> lines = spring_ends(body);
    if (!tissue_of(body)) return lines;
    for (const std::array<int, 8>& cell : body.cells)
        for (int bit : {1, 2, 4})
            for (int k = 0; k < 8; ++k)
                if ((k & bit) == 0)
                    lines.push_back({unsigned(cell[std::size_t(k)]), unsigned(cell[std::size_t(k + bit)])});
    auto in_order = [](uvec2 a, uvec2 b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); };
    std::ranges::sort(lines, in_order);
    lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
    return lines;
}

}  // namespace

void Scenery::add_bodies(const Play& play, bool springs, Picture& picture) {
    if (springs && springs_.empty())
        for (const Model& model : made_->models) springs_.push_back(lines_of(model.body));
    pressed_.resize(made_->models.size());
    for (std::size_t m = 0; m < made_->models.size(); ++m) {
        Surface& surface = picture.surfaces.emplace_back();
        surface.mesh = meshes_[m];
        surface.look = looks_[m];
        const bool by_pressure = scene_->bodies[m].shade == Shade::pressure;
        if (!by_pressure) surface.gpu_nodes = play.gpu_nodes(m);
        if (surface.gpu_nodes.positions == 0 && mapped_where_drawn(m)) {
            surface.nodes = play.nodes(m);
        } else if (surface.gpu_nodes.positions == 0) {
            surface.positions = play.skins()[m].positions;
            surface.normals = play.skins()[m].normals;
        }
        if (by_pressure) {
            pressed_[m] = places_in_scale(play.pressures(m), scene_->bodies[m].pressure_scale);
            surface.uvs = pressed_[m];
        }
        if (springs) picture.wires.push_back({play.nodes(m).positions, springs_[m], {}});
    }
}

// What is pressed lies within the tip, which would hide how hard.
bool Scenery::is_hidden(const ToolRecipe& tool) const {
    return presses_bodies(tool.kind) && std::ranges::any_of(scene_->bodies, [](const BodyRecipe& body) {
               return body.shade == Shade::pressure;
           });
}

void Scenery::add_shafts(const Play& play, Picture& picture) {
    for (std::size_t t = 0; t < play.tools().size(); ++t) {
        const auto& tool = play.tools()[t];
        auto& [rest, now, mesh] = shafts_[t];
        if (!tool || rest.triangles.empty() || is_hidden(scene_->tools[t])) continue;
        for (std::size_t i = 0; i < rest.positions.size(); ++i)
            now.positions[i] = tool->centre + rest.positions[i];
        picture.surfaces.push_back(
            {mesh, now.positions, now.normals, {scene_->tools[t].colour, collider_shine}});
    }
}

void Scenery::add_tools(const Play& play, Picture& picture) {
    drag_points_.clear();
    drag_lines_.clear();
    for (std::size_t t = 0; t < play.tools().size(); ++t) {
        const auto& tool = play.tools()[t];
        if (!tool || is_hidden(scene_->tools[t])) continue;
        picture.balls.push_back({tool->centre, scene_->tools[t].radius, scene_->tools[t].colour});
        if (!tool->held) continue;
        drag_lines_.push_back(uvec2(drag_points_.size(), drag_points_.size() + 1));
        drag_points_.insert(drag_points_.end(), {*tool->held, tool->centre});
    }
    if (!drag_lines_.empty()) picture.wires.push_back({drag_points_, drag_lines_, {}});
}

void Scenery::add_colliders(const std::vector<Motion>& motions, Picture& picture) {
    for (std::size_t c = 0; c < motions.size(); ++c) {
        const Motion& motion = motions[c];
        const auto& shape = made_->simulation.colliders[c].shape;
        const vec3 colour = scene_->colliders[c].colour;
        if (const auto* plane = std::get_if<Plane>(&shape)) {
            const vec3 normal = motion.rotation * plane->normal;
            picture.grounds.push_back({normal, plane->offset + glm::dot(normal, motion.position)});
        } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
            const vec3 centre = motion.position + motion.rotation * sphere->centre;
            picture.balls.push_back({centre, sphere->radius, colour});
        } else if (auto& [rest, now, mesh] = shapes_[c]; !rest.triangles.empty()) {
            for (std::size_t i = 0; i < rest.positions.size(); ++i) {
                now.positions[i] = motion.position + motion.rotation * rest.positions[i];
                now.normals[i] = motion.rotation * rest.normals[i];
            }
            picture.surfaces.push_back({mesh, now.positions, now.normals, {colour, collider_shine}});
        }
    }
}

}  // namespace palpate
