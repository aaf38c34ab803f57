#include "palpate/body/patch.h"

#include "palpate/base/error.h"
#include "palpate/mesh/triangle.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

// A conservative test: by bounding boxes, and then by the bounding sphere of the triangle.
bool comes_near(const Touchable& surface, uvec3 t, vec3 centre, float radius) {
    const vec3 a = surface.positions[t.x], b = surface.positions[t.y], c = surface.positions[t.z];
    const vec3 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
    if (!glm::all(glm::lessThanEqual(low, centre + radius)) ||
        !glm::all(glm::greaterThanEqual(high, centre - radius)))
        return false;
    const vec3 middle = (a + b + c) / 3.0f;
    const float size =
        std::max({glm::distance(a, middle), glm::distance(b, middle), glm::distance(c, middle)});
    return !(glm::distance(middle, centre) > radius + size);
}

void check(const Touchable& surface) {
    const std::size_t count = surface.positions.size();
    if (!surface.velocities.empty() && surface.velocities.size() != count)
        throw Error("a number of velocities that differs from that of the vertices", "a surface to touch",
                    "give one for each, or none");
    for (uvec3 t : surface.triangles)
        if (t.x >= count || t.y >= count || t.z >= count)
            throw Error("a triangle that refers to missing vertices", "a surface to touch",
                        "use indices of its own positions");
}

bool is_finite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

vec3 sane(vec3 velocity) {
    if (!is_finite(velocity)) return vec3(0);
    const float speed = glm::length(velocity);
    return speed > Patch::fastest_guess ? Patch::fastest_guess / speed * velocity : velocity;
}

}  // namespace

Patch::Patch(std::span<const Touchable> surfaces, vec3 centre, float radius, double time)
    : centre_(centre),
      radius_(radius),
      time_(time),
      surfaces_(surfaces.size()),
      mesh_(std::make_unique<Mesh>()) {
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
        const Touchable& surface = surfaces[s];
        check(surface);
        for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
            const uvec3 triangle = surface.triangles[t];
            if (!comes_near(surface, triangle, centre, radius)) continue;
            const bool whole = is_finite(surface.positions[triangle.x]) &&
                               is_finite(surface.positions[triangle.y]) &&
                               is_finite(surface.positions[triangle.z]);
            if (!whole) continue;
            const auto first = unsigned(mesh_->positions.size());
            for (int k = 0; k < 3; ++k) {
                mesh_->positions.push_back(surface.positions[triangle[k]]);
                const vec3 v = surface.velocities.empty() ? vec3(0) : surface.velocities[triangle[k]];
                velocities_.push_back(sane(v));
                fastest_ = std::max(fastest_, glm::length(velocities_.back()));
            }
            mesh_->triangles.emplace_back(first, first + 1, first + 2);
            from_.push_back({int(s), int(t), surface.is_sheet});
        }
    }
    if (!from_.empty()) tree_ = std::make_unique<Tree>(*mesh_);
}

double Patch::age_at(double time) const { return std::clamp(time - time_, 0.0, longest_guess); }

std::optional<Patch::Face> Patch::find(int surface, int triangle, double time) const {
    const auto before = [](const From& from, std::pair<int, int> wanted) {
        return std::pair(from.surface, from.triangle) < wanted;
    };
    const std::pair wanted(surface, triangle);
    const auto found = std::lower_bound(from_.begin(), from_.end(), wanted, before);
    if (found == from_.end() || std::pair(found->surface, found->triangle) != wanted) return std::nullopt;
    return face_at(Index(found - from_.begin()), time);
}

Patch::Face Patch::face_at(Index face, double time) const {
    const From& from = from_[face];
    const double age = age_at(time);
    const bool guesses = time - time_ <= longest_guess;  // whether it is extrapolated; after that it stands
                                                         // still
    Face found{{}, {}, from.surface, from.triangle, from.is_sheet};
    for (int k = 0; k < 3; ++k) {
        const unsigned corner = mesh_->triangles[face][k];
        const dvec3 velocity(velocities_[corner]);
        found.velocities[k] = guesses ? velocity : dvec3(0);
        found.corners[k] = dvec3(mesh_->positions[corner]) + age * velocity;
    }
    return found;
}

}  // namespace palpate
