#include "palpate/run/show.h"

#include "palpate/base/clock.h"
#include "palpate/base/files.h"
#include "palpate/gl/context.h"
#include "palpate/render/shapes.h"

#include <fmt/format.h>

namespace palpate {
namespace {

constexpr int frames_per_picture = 2;  // of a film: 30 pictures a second
constexpr float collider_shine = 0.4f;

vec3 middle(const Model& model) {
    Bounds box;
    for (vec3 p : model.surface.positions) box.include(p);
    if (box.empty())
        for (vec3 p : model.body.positions) box.include(p);
    return box.centre();
}

// Behind a tip at the origin; nothing to see if it has none.
Collider shaft_of(const ToolRecipe& tool) {
    if (!(tool.shaft > 0)) return {Sphere{}};
    return {Capsule{vec3(0), -tool.shaft * glm::normalize(tool.along), tool.radius}};
}

}  // namespace

Show::Show(const Scene& scene, const Models& made, const RunSettings& settings, const gl::Context* context)
    : scene_(scene), made_(made), settings_(settings), renderer_({settings.width, settings.height}, context) {
    for (std::size_t m = 0; m < made.models.size(); ++m) {
        const Model& model = made.models[m];
        meshes_.push_back(mapped_where_drawn(m) ? renderer_.add(model.surface, model.embedding)
                                                : renderer_.add(model.surface));
        looks_.push_back(look(scene.bodies[m], model));
    }
    for (std::size_t s = 0; s < made.stills.size(); ++s) {
        const BodyRecipe& recipe = scene.surfaces[s];
        meshes_.push_back(renderer_.add(made.stills[s].surface));
        looks_.push_back({.colour = recipe.colour,
                          .shine = recipe.shine,
                          .shows_normals = recipe.shade == Shade::normals});
    }
    for (const Collider& collider : made.simulation.colliders) shapes_.push_back(shape_of(collider));
    for (const ToolRecipe& tool : scene.tools) shafts_.push_back(shape_of(shaft_of(tool)));
    dents_.resize(meshes_.size());
    if (!settings.video.empty())
        film_ =
            std::make_unique<Film>(settings.video, settings.width, settings.height, 60 / frames_per_picture);
    if (!settings.images.empty()) make_folder(settings.images);
    if (settings.lattice)
        for (const Model& model : made.models) springs_.push_back(spring_ends(model.body));
    camera_ = scene.camera;
    camera_.look_at = looked_at();
}

Show::Shape Show::shape_of(const Collider& collider) {
    Shape shape;
    shape.rest = shape.now = shape_mesh(collider);
    if (!shape.rest.triangles.empty()) shape.mesh = renderer_.add(shape.rest);
    return shape;
}

Look Show::look(const BodyRecipe& recipe, const Model& model) {
    Look look{recipe.colour, recipe.shine};
    if (model.colour_map.width > 0) look.colour_map = renderer_.add(model.colour_map, Texels::colours);
    if (model.normal_map.width > 0) look.normal_map = renderer_.add(model.normal_map, Texels::normals);
    look.shows_normals = recipe.shade == Shade::normals;
    return look;
}

// Where a GPU moves the nodes, surfaces follow them there; normal maps want tangents, which go that way too.
bool Show::mapped_where_drawn(std::size_t body) const {
    return on_gpu(made_.simulation.backend) || made_.models[body].normal_map.width > 0;
}

const std::string& Show::renderer() const { return renderer_.context().renderer(); }

bool Show::frame_done(int number, const Play& play, Report::Seconds& seconds) {
    const double time = number * frame_seconds;
    const bool film_wants = film_ && number % frames_per_picture == 0;
    const bool images_want = !settings_.images.empty() && time >= next_image_ - 1e-9;
    if (!film_wants && !images_want) return false;
    Image image;
    {
        Timed timed(seconds.render);
        renderer_.draw(picture(time, play));
        image = renderer_.image();
    }
    Timed timed(seconds.write);
    if (film_wants) film_->add(image);
    if (images_want) {
        write_png(image, settings_.images / fmt::format("{}-{:05.2f}s.png", scene_.name, time));
        next_image_ += settings_.image_every;
    }
    return true;
}

void Show::finish() {
    if (film_) film_->finish();
}

vec3 Show::looked_at() const {
    if (const auto* point = std::get_if<vec3>(&scene_.look_at)) return *point;
    for (const Model& model : made_.models)
        if (model.body.name == std::get<std::string>(scene_.look_at)) return middle(model);
    for (const Still& still : made_.stills)
        if (still.name == std::get<std::string>(scene_.look_at)) return bounds(still.surface).centre();
    return vec3(0);
}

Picture Show::picture(double time, const Play& play) {
    Picture picture;
    picture.camera = camera_;
    picture.light = scene_.light;
    for (std::size_t m = 0; m < made_.models.size(); ++m) {
        Surface& surface = picture.surfaces.emplace_back();
        surface.mesh = meshes_[m];
        surface.look = looks_[m];
        if (mapped_where_drawn(m)) {
            surface.gpu_nodes = play.gpu_nodes(m);
            if (surface.gpu_nodes.positions == 0) surface.nodes = play.nodes(m);
        } else {
            surface.positions = play.skins()[m].positions;
            surface.normals = play.skins()[m].normals;
        }
        if (settings_.lattice) picture.wires.push_back({play.nodes(m).positions, springs_[m], {}});
    }
    for (std::size_t s = made_.models.size(); s < meshes_.size(); ++s) {
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

void Show::add_shafts(const Play& play, Picture& picture) {
    for (std::size_t t = 0; t < play.tools().size(); ++t) {
        const auto& tool = play.tools()[t];
        auto& [rest, now, mesh] = shafts_[t];
        if (!tool || rest.triangles.empty()) continue;
        for (std::size_t i = 0; i < rest.positions.size(); ++i)
            now.positions[i] = tool->centre + rest.positions[i];
        picture.surfaces.push_back(
            {mesh, now.positions, now.normals, {scene_.tools[t].colour, collider_shine}});
    }
}

void Show::add_tools(const Play& play, Picture& picture) {
    drag_points_.clear();
    drag_lines_.clear();
    for (std::size_t t = 0; t < play.tools().size(); ++t) {
        const auto& tool = play.tools()[t];
        if (!tool) continue;
        picture.balls.push_back({tool->centre, scene_.tools[t].radius, scene_.tools[t].colour});
        if (!tool->held) continue;
        drag_lines_.push_back(uvec2(drag_points_.size(), drag_points_.size() + 1));
        drag_points_.insert(drag_points_.end(), {*tool->held, tool->centre});
    }
    if (!drag_lines_.empty()) picture.wires.push_back({drag_points_, drag_lines_, {}});
}

void Show::add_colliders(const std::vector<Motion>& motions, Picture& picture) {
    for (std::size_t c = 0; c < motions.size(); ++c) {
        const Motion& motion = motions[c];
        const auto& shape = made_.simulation.colliders[c].shape;
        const vec3 colour = scene_.colliders[c].colour;
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
