#include "palpate/scene/thin_walls.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace palpate {
namespace {

// A sample of a surface, with its share of the area.
struct WallSample {
    vec3 from, inward;
    float area;  // m²
};

// Samples all over a surface, about a spacing apart.
std::vector<WallSample> samples_on(const Mesh& mesh, float spacing) {
    constexpr int most_rows = 16;  // of cells in a triangle
    std::vector<WallSample> samples;
    for (uvec3 t : mesh.triangles) {
        const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const vec3 across = glm::cross(b - a, c - a);
        const float area = 0.5f * glm::length(across);
        if (!(area > 0)) continue;
        const int rows = std::clamp(int(std::sqrt(area) / spacing), 1, most_rows);
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < rows - i; ++j)
                for (float corner : {1 / 3.0f, 2 / 3.0f}) {  // the middles of a cell's two halves
                    const float u = (float(i) + corner) / float(rows), v = (float(j) + corner) / float(rows);
                    if (u + v >= 1) continue;
                    samples.push_back(
                        {a + u * (b - a) + v * (c - a), -glm::normalize(across), area / float(rows * rows)});
                }
    }
    return samples;
}

double area_of(const std::vector<WallSample>& samples) {
    double sum = 0;
    for (const WallSample& sample : samples) sum += sample.area;
    return sum;
}

// The distance from `from` along the unit vector `along` to a mesh, m; nothing if the ray misses it.
std::optional<float> distance_along(const Mesh& mesh, dvec3 from, dvec3 along) {
    double nearest = std::numeric_limits<double>::infinity();
    for (uvec3 t : mesh.triangles) {
        const dvec3 a = mesh.positions[t.x], ab = dvec3(mesh.positions[t.y]) - a,
                    ac = dvec3(mesh.positions[t.z]) - a;
        const dvec3 across = glm::cross(along, ac);
        const double area = glm::dot(ab, across);
        if (area == 0) continue;  // parallel to the triangle
        const double u = glm::dot(from - a, across) / area;
        const double v = glm::dot(along, glm::cross(from - a, ab)) / area;
        const double way = glm::dot(ac, glm::cross(from - a, ab)) / area;
        if (u >= 0 && v >= 0 && u + v <= 1 && way > 0) nearest = std::min(nearest, way);
    }
    return std::isinf(nearest) ? std::nullopt : std::optional(float(nearest));
}

}  // namespace

std::optional<ThinWalls> thin_walls(const Mesh& mesh, const DistanceField& field) {
    constexpr std::size_t most_tests = 20'000'000;  // of lines across and triangles: about a second
    const float spacing = field.spacing;
    std::vector<WallSample> samples = samples_on(mesh, spacing);
    const double all = area_of(samples);
    // Thick walls are where the field is correct half a spacing inside.
    std::erase_if(samples, [&](const WallSample& sample) {
        return field.at(sample.from + 0.5f * spacing * sample.inward) < -0.25f * spacing;
    });
    // Near its edges a thick body fails that test, too; the distance to the opposite wall decides.
    float thinnest = std::numeric_limits<float>::infinity();
    double looked_at = 0, thin = 0;
    const std::size_t lines =
        std::clamp<std::size_t>(most_tests / std::max<std::size_t>(mesh.triangles.size(), 1), 10, 200);
    for (std::size_t i = 0; i < samples.size(); i += samples.size() / lines + 1) {
        const auto& [from, inward, area] = samples[i];
        const float slack = 1e-3f * spacing;  // so that the ray misses the sample's own triangle
        const auto way = distance_along(mesh, from + slack * inward, inward);
        looked_at += area;
        if (!way || *way + slack > 1.5f * spacing) continue;
        thin += area;
        thinnest = std::min(thinnest, *way + slack);
    }
    const double share = looked_at > 0 ? area_of(samples) / all * thin / looked_at : 0;
    if (!(share > 0.01)) return std::nullopt;
    return ThinWalls{float(share), thinnest, thinnest / 4};
}

}  // namespace palpate
