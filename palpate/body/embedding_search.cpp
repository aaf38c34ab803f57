#include "palpate/body/embedding_parts.h"
#include "palpate/body/hull.h"

namespace palpate {
namespace {

// The most buckets per box, however unlike the sizes of the boxes.
constexpr double most_buckets = 16;

std::vector<Bounds> boxes_of(std::span<const Facet> facets, const Body& body) {
    std::vector<Bounds> boxes(facets.size());
    for (std::size_t i = 0; i < facets.size(); ++i)
        for (int node : facets[i].nodes) boxes[i].include(body.positions[node]);
    return boxes;
}

float mean_size(std::span<const Bounds> boxes) {
    double sum = 0;
    for (const Bounds& box : boxes) sum += std::max({box.size().x, box.size().y, box.size().z});
    return boxes.empty() ? 0 : float(sum / double(boxes.size()));
}

}  // namespace

std::vector<Facet> facets(const Body& body) {
    std::vector<Facet> list;
    if (!body.cells.empty()) {
        for (const HullTriangle& t : hull(body)) list.push_back({t.nodes, t.normal});
        return list;
    }
    for (const auto& nodes : body.faces) {
        const vec3 a = body.positions[nodes[0]], b = body.positions[nodes[1]], c = body.positions[nodes[2]];
        list.push_back({nodes, direction(glm::cross(b - a, c - a), vec3(0))});
    }
    return list;
}

template <class Visit>
void BoxGrid::for_each_bucket(const Bounds& box, Visit visit) const {
    const ivec3 low = bucket_of(box.low);
    // A box that ends on the border of a bucket is not in the next one.
    const ivec3 high = glm::max(low, ivec3(glm::ceil((box.high - origin_) / size_)) - 1);
    const ivec3 end = glm::min(high, dims_ - 1);
    for (int z = low.z; z <= end.z; ++z)
        for (int y = low.y; y <= end.y; ++y)
            for (int x = low.x; x <= end.x; ++x) visit(slot({x, y, z}));
}

BoxGrid::BoxGrid(std::span<const Bounds> boxes) {
    Bounds all;
    for (const Bounds& box : boxes) all.include(box.low), all.include(box.high);
    const double extent = std::max({all.size().x, all.size().y, all.size().z});
    size_ = std::max({mean_size(boxes), float(extent / 1024), 1e-20f});
    auto buckets = [&] {
        const glm::dvec3 counts = glm::floor(glm::dvec3(all.size()) / double(size_)) + 1.0;
        return counts.x * counts.y * counts.z;
    };
    while (buckets() > 64 + most_buckets * double(boxes.size())) size_ *= 1.25f;
    origin_ = boxes.empty() ? vec3(0) : all.low;
    dims_ = ivec3(glm::floor(all.size() / size_)) + 1;

    begins_.assign(std::size_t(dims_.x) * dims_.y * dims_.z + 1, 0);
    for (const Bounds& box : boxes) for_each_bucket(box, [&](std::size_t b) { ++begins_[b + 1]; });
    for (std::size_t b = 1; b < begins_.size(); ++b) begins_[b] += begins_[b - 1];
    items_.resize(begins_.back());
    std::vector<int> next(begins_.begin(), begins_.end() - 1);
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for_each_bucket(boxes[i], [&](std::size_t b) { items_[next[b]++] = int(i); });
}

Outside::Outside(const Body& body) : body_(body), facets_(facets(body)), box_grid_(boxes_of(facets_, body)) {}

const Facet& Outside::nearest(vec3 v, vec3 n) const {
    return best(v, n, [&](const Facet& f, float) { return distance(f, v); });
}

}  // namespace palpate
