#include "palpate/scene/thin_walls.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
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
    constexpr int most_rows = 16;                    // of cells in a triangle
    const float inward = volume(mesh) < 0 ? 1 : -1;  // some files have all faces inside out
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
                    samples.push_back({a + u * (b - a) + v * (c - a), inward * glm::normalize(across),
                                       area / float(rows * rows)});
                }
    }
    return samples;
}

double area_of(const std::vector<WallSample>& samples) {
    double sum = 0;
    for (const WallSample& sample : samples) sum += sample.area;
    return sum;
}

// Where a line leaves a mesh.
struct Opposite {
    float distance;  // m
    vec3 normal;     // unit, either way
};

// The first face along the unit vector `along`; nothing if the ray misses all.
std::optional<Opposite> opposite(const Mesh& mesh, dvec3 from, dvec3 along) {
    double nearest = std::numeric_limits<double>::infinity();
    dvec3 normal(0);
    for (uvec3 t : mesh.triangles) {
        const dvec3 a = mesh.positions[t.x], ab = dvec3(mesh.positions[t.y]) - a,
                    ac = dvec3(mesh.positions[t.z]) - a;
        const dvec3 across = glm::cross(along, ac);
        const double area = glm::dot(ab, across);
        if (area == 0) continue;  // parallel to the triangle
        const double u = glm::dot(from - a, across) / area;
        const double v = glm::dot(along, glm::cross(from - a, ab)) / area;
        const double way = glm::dot(ac, glm::cross(from - a, ab)) / area;
        if (u >= 0 && v >= 0 && u + v <= 1 && way > 0 && way < nearest) {
            nearest = way;
            normal = glm::cross(ab, ac);
        }
    }
    if (std::isinf(nearest)) return std::nullopt;
    return Opposite{float(nearest), vec3(glm::normalize(normal))};
}

// Some of the samples, evenly: what looking from them through the mesh takes is about a second at most.
std::vector<WallSample> some_of(const std::vector<WallSample>& samples, const Mesh& mesh) {
    constexpr std::size_t most_tests = 20'000'000;  // of lines across and triangles
    const std::size_t lines =
        std::clamp<std::size_t>(most_tests / std::max<std::size_t>(mesh.triangles.size(), 1), 10, 200);
    std::vector<WallSample> some;
    for (std::size_t i = 0; i < samples.size(); i += samples.size() / lines + 1) some.push_back(samples[i]);
    return some;
}

// The face opposite to a sample. `slack`: so that the ray misses the sample's own triangle, m.
std::optional<Opposite> opposite(const Mesh& mesh, const WallSample& sample, float slack) {
    std::optional<Opposite> there = opposite(mesh, sample.from + slack * sample.inward, sample.inward);
    if (there) there->distance += slack;
    return there;
}

}  // namespace

float wall_thickness(const Mesh& mesh) {
    constexpr float parallel = 0.98f;  // the cosine of 11 degrees
    constexpr double thin_share = 0.05;
    const float size = glm::length(bounds(mesh).size());
    const std::vector<WallSample> samples = some_of(samples_on(mesh, size / 64), mesh);
    std::vector<std::pair<float, float>> walls;  // thickness and area
    for (const WallSample& sample : samples) {
        const auto there = opposite(mesh, sample, 1e-6f * size);
        if (there && std::abs(glm::dot(there->normal, sample.inward)) > parallel)
            walls.push_back({there->distance, sample.area});
    }
    std::ranges::sort(walls);
    double left = thin_share * area_of(samples);
    for (const auto& [thickness, area] : walls)
        if ((left -= area) < 0) return thickness;
    return std::numeric_limits<float>::infinity();
}

std::optional<ThinWalls> thin_walls(const Mesh& mesh, const DistanceField& field) {
    constexpr float needed = 2;  // spacings from side to side, for a node to find the nearer one
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
    for (const WallSample& sample : some_of(samples, mesh)) {
        const auto there = opposite(mesh, sample, 1e-3f * spacing);
        looked_at += sample.area;
        if (!there || there->distance > needed * spacing) continue;
        thin += sample.area;
        thinnest = std::min(thinnest, there->distance);
    }
    const double share = looked_at > 0 ? area_of(samples) / all * thin / looked_at : 0;
    if (!(share > 0.01)) return std::nullopt;
    return ThinWalls{float(share), thinnest, thinnest / 4};
}

}  // namespace palpate
