#include "palpate/viewer/pane.h"

#include <algorithm>

namespace palpate {
namespace {

std::vector<uvec2> edges_of(const std::vector<uvec3>& triangles) {
    std::vector<uvec2> edges;
    for (uvec3 t : triangles)
        for (uvec2 edge : {uvec2(t.x, t.y), uvec2(t.y, t.z), uvec2(t.z, t.x)})
            edges.push_back({std::min(edge.x, edge.y), std::max(edge.x, edge.y)});
    auto before = [](uvec2 a, uvec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; };
    std::sort(edges.begin(), edges.end(), before);
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

}  // namespace

void Pane::resize(ivec2 size) {
    if (size == size_) return;
    size_ = size;
    renderer_.resize({size.x, size.y});
}

void Pane::set(const Quality& quality) {
    if (quality == quality_) return;
    quality_ = quality;
    renderer_.set(quality);
}

void Pane::draw(const Camera& camera) {
    picture_.camera = camera;
    renderer_.draw(picture_);
}

void Pane::look(const Experiment& experiment, const Camera& camera, const Look3d& look,
                const Traces& traces) {
    if (experiment.shapes() != shapes_) {
        renderer_.clear();
        scenery_.emplace(experiment.scene(), experiment.models(), renderer_, Scenery::Mapped::either);
        edges_.clear();
        shapes_ = experiment.shapes();
    }
    scenery_->now_of(experiment.scene(), experiment.models());
    Picture& picture = picture_;
    picture = scenery_->picture(experiment.time(), experiment.play(), camera, look.springs);
    picture.culls = look.culling;
    const std::size_t skins = experiment.play().skins().size();
    for (std::size_t s = 0; s < skins; ++s) {
        Surface& surface = picture.surfaces[s];
        surface.look.shows_normals |= look.normals;
        if (!look.normal_maps) surface.look.normal_map = -1;
    }
    dents_.assign(skins, {});
    for (std::size_t s = 0; s < traces.dents.size() && s < skins; ++s) {
        if (traces.dents[s].empty()) continue;
        dents_[s].assign(picture.surfaces[s].dents.begin(), picture.surfaces[s].dents.end());
        dents_[s].insert(dents_[s].end(), traces.dents[s].begin(), traces.dents[s].end());
        picture.surfaces[s].dents = dents_[s];
    }
    picture.balls.insert(picture.balls.end(), traces.balls.begin(), traces.balls.end());
    traces_ = traces;
    if (!traces_.lines.empty()) picture.wires.push_back({traces_.points, traces_.lines, {}});
    if (look.wireframe) add_wireframe(experiment);
    copy_all();
}

void Pane::copy_all() {
    std::size_t copies = 0;
    auto copy = [&](std::span<const vec3>& list) {
        copies_[copies].assign(list.begin(), list.end());
        list = copies_[copies++];
    };
    copies_.resize(std::max(copies_.size(), 4 * picture_.surfaces.size() + picture_.wires.size()));
    for (Surface& surface : picture_.surfaces)
        for (auto* list :
             {&surface.positions, &surface.normals, &surface.nodes.positions, &surface.nodes.normals})
            copy(*list);
    for (Wires& wires : picture_.wires) copy(wires.points);
}

void Pane::add_wireframe(const Experiment& experiment) {
    const std::vector<Skin>& skins = experiment.play().skins();
    if (edges_.empty())
        for (const Skin& skin : skins) edges_.push_back(edges_of(*skin.triangles));
    for (std::size_t s = 0; s < skins.size(); ++s)
        picture_.wires.push_back({skins[s].positions, edges_[s], vec3(0.02f)});
}

}  // namespace palpate
