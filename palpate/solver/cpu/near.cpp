#include "palpate/solver/cpu/kernel.h"

#include <algorithm>

namespace palpate::cpu {
namespace {

// Where the nodes of a block may be: its box at rest, grown by how far they have come.
Bounds place(const BodyView& body, int block, const Bounds& moved) {
    const Bounds& rest = body.rest_bounds[block];
    return {rest.low + moved.low, rest.high + moved.high};
}

// NaN fails every comparison, and counts as near: then the nodes themselves are tested.

bool may_touch(const Bounds& box, vec3 centre, float reach) {
    const vec3 nearest = glm::clamp(centre, box.low, box.high);
    return !(glm::dot(centre - nearest, centre - nearest) > reach * reach);
}

bool may_touch(const Bounds& box, const Obstacle& o, const BodyView& body) {
    const vec3 half = 0.5f * box.size(), middle = box.centre();
    const vec3 rows[] = {vec3(o.x), vec3(o.y), vec3(o.z)};
    const float shift[] = {o.x.w, o.y.w, o.z.w};
    Bounds in_frame;
    for (int k = 0; k < 3; ++k) {
        const float at = glm::dot(rows[k], middle) + shift[k], reach = glm::dot(glm::abs(rows[k]), half);
        in_frame.low[k] = at - reach, in_frame.high[k] = at + reach;
    }
    const float hair = 1e-5f * (glm::length(middle) + glm::length(half) + glm::length(vec3(o.place)));
    const float margin = o.place.w + hair;
    auto apart = [&](vec3 low, vec3 high) {
        for (int k = 0; k < 3; ++k)
            if (in_frame.low[k] > high[k] + margin || in_frame.high[k] < low[k] - margin) return true;
        return false;
    };
    if (o.kind.x == half_space) return !(in_frame.low.y > margin);
    if (o.kind.x == round_box) return !apart(-vec3(o.size) - o.size.w, vec3(o.size) + o.size.w);
    if (o.kind.x == field) {
        const DistanceField& f = *body.fields[o.kind.y];
        // Beyond its grid a field says what it says at the rim, a few spacings.
        return !(o.place.w < f.spacing && apart(f.origin, f.origin + f.spacing * vec3(f.dims - 1)));
    }
    return true;  // polygons stop what crosses them, however far it has gone
}

// Where nodes are on their way, as an obstacle sees it: it has moved as well.
Bounds way_past(const Obstacle& o, const Bounds& before, const Bounds& now, float duration) {
    const vec3 shift = duration * vec3(o.velocity);
    const float reach = glm::distance(before.centre(), vec3(o.place)) + glm::length(before.size()),
                turned = duration * glm::length(vec3(o.spin)) * reach;
    return {glm::min(now.low, before.low + shift - turned), glm::max(now.high, before.high + shift + turned)};
}

}  // namespace

bool touched(const Task& task, int block, const Bounds& moved) {
    const Block& of = task.body.blocks[block];
    if (task.pass.pushes > 0) {
        const auto& slots = task.pushes->slots;
        const auto next = std::ranges::lower_bound(slots, of.first_slot);
        if (next != slots.end() && *next < of.end_slot) return true;
    }
    const Bounds box = place(task.body, block, moved);
    for (int t = 0; t < task.pass.tips; ++t) {
        const vec4 tip = task.plan.tips[std::size_t(t)].place;
        if (may_touch(box, vec3(tip), 1.00001f * (tip.w + task.body.furthest_cover[block]))) return true;
    }
    return false;
}

bool near_obstacles(const Task& task, int block, const Bounds& was, const Bounds& moved) {
    const Bounds before = place(task.body, block, was), now = place(task.body, block, moved);
    for (int i = 0; i < task.pass.obstacles; ++i) {
        const Obstacle& o = task.pass.obstacle[i];
        if (may_touch(way_past(o, before, now, task.pass.duration), o, task.body)) return true;
    }
    return false;
}

}  // namespace palpate::cpu
