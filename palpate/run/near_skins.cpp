#include "palpate/run/near_skins.h"

#include "palpate/body/patch.h"
#include "palpate/run/play.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace palpate {
namespace {

constexpr float spare = 0.015f;  // m, by which parts reach farther than they must

// m; infinite if a position is not finite.
float farthest_move(std::span<const vec3> from, std::span<const vec3> to) {
    float squared = 0;
    for (std::size_t i = 0; i < to.size(); ++i) {
        const vec3 move = to[i] - from[i];
        const float one = glm::dot(move, move);
        if (!std::isfinite(one)) return std::numeric_limits<float>::infinity();
        squared = std::max(squared, one);
    }
    return std::sqrt(squared);
}

// The vertices of some triangles, and these triangles with their own numbers of vertices.
std::pair<std::vector<unsigned>, std::vector<uvec3>> cut_out(const std::vector<uvec3>& triangles,
                                                             const std::vector<int>& some,
                                                             std::size_t count) {
    constexpr unsigned none = ~0u;
    std::vector<unsigned> vertices, number(count, none);
    std::vector<uvec3> cut;
    for (int t : some) {
        uvec3 triangle = triangles[std::size_t(t)];
        for (int k = 0; k < 3; ++k) {
            unsigned& at = number[triangle[k]];
            if (at == none) {
                at = unsigned(vertices.size());
                vertices.push_back(triangle[k]);
            }
            triangle[k] = at;
        }
        cut.push_back(triangle);
    }
    return {std::move(vertices), std::move(cut)};
}

}  // namespace

const std::vector<Skin>& NearSkins::at(const Play& play, const Models& models, vec3 centre, float reach) {
    chose_ = !suffice(play, centre, reach);
    if (chose_) choose(play, models, centre, reach);
    const std::size_t bodies = models.models.size();
    last_nodes_.resize(bodies);
    for (std::size_t m = 0; m < bodies; ++m) {
        const Nodes nodes = play.nodes(m);
        deform(parts_[m].embedding, nodes, skins_[m].positions);
        last_nodes_[m].assign(nodes.positions.begin(), nodes.positions.end());
    }
    return skins_;
}

bool NearSkins::suffice(const Play& play, vec3 centre, float reach) const {
    if (parts_.empty()) return false;
    float move = 0;
    for (std::size_t m = 0; m < chosen_nodes_.size(); ++m)
        move = std::max(move, farthest_move(chosen_nodes_[m], play.nodes(m).positions));
    return glm::distance(centre, centre_) + move + reach <= reach_;
}

void NearSkins::choose(const Play& play, const Models& models, vec3 centre, float reach) {
    const std::vector<Skin>& all = play.touchable();
    const std::size_t bodies = models.models.size();
    const bool knows_before = !parts_.empty();
    centre_ = centre;
    reach_ = reach + spare;
    parts_.assign(all.size(), {});
    skins_.assign(all.size(), {});
    before_.assign(all.size(), {});
    chosen_nodes_.resize(bodies);
    for (std::size_t s = 0; s < all.size(); ++s) {
        Part& part = parts_[s];
        part.numbers = Patch::near({all[s].positions, *all[s].triangles}, centre, reach_);
        auto [vertices, triangles] = cut_out(*all[s].triangles, part.numbers, all[s].positions.size());
        part.triangles = std::move(triangles);
        skins_[s] = {{}, {}, &part.triangles, all[s].is_sheet, part.numbers};
        if (s >= bodies) {
            for (unsigned v : vertices) skins_[s].positions.push_back(all[s].positions[v]);
            before_[s] = skins_[s].positions;
            continue;
        }
        part.embedding = part_of(models.models[s].embedding, vertices);
        const Nodes nodes = play.nodes(s);
        chosen_nodes_[s].assign(nodes.positions.begin(), nodes.positions.end());
        if (knows_before) deform(part.embedding, {last_nodes_[s], nodes.normals}, before_[s]);
    }
}

}  // namespace palpate
