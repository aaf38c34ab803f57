#include "palpate/body/patch.h"

#include "palpate/base/error.h"
#include "palpate/mesh/mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

namespace palpate {
namespace {

constexpr float margin = 0.2f;     // by which a look goes beyond the radius, as a part of it
constexpr float rounding = 1e-6f;  // of lengths, relative; floats round less
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float unwatched = std::numeric_limits<float>::quiet_NaN();

// Four vectors are three SIMD registers. By itself the compiler makes little use of them.
using Register [[gnu::vector_size(16)]] = float;
using Bits [[gnu::vector_size(16)]] = std::int32_t;
using FourVectors = std::array<Register, 3>;

FourVectors load(const vec3* from) {
    FourVectors vectors;
    std::memcpy(&vectors, from, sizeof vectors);
    return vectors;
}

FourVectors four(vec3 v) {
    const std::array<vec3, 4> same = {v, v, v, v};
    return load(same.data());
}

// On which sides of a box a point lies, one bit for each: a triangle whose corners share one is outside.
// What is not a number lies on all of them.
std::uint8_t sides(vec3 p, vec3 low, vec3 high) {
    return std::uint8_t((p.x >= low.x ? 0 : 1) | (p.x <= high.x ? 0 : 2) | (p.y >= low.y ? 0 : 4) |
                        (p.y <= high.y ? 0 : 8) | (p.z >= low.z ? 0 : 16) | (p.z <= high.z ? 0 : 32));
}

std::vector<std::uint8_t> sides(std::span<const vec3> points, vec3 low, vec3 high) {
    std::vector<std::uint8_t> found(points.size());
    const FourVectors least = four(low), most = four(high);
    constexpr Bits below[] = {{1, 4, 16, 1}, {4, 16, 1, 4}, {16, 1, 4, 16}};
    const std::size_t whole = points.size() / 4 * 4;
    for (std::size_t i = 0; i < whole; i += 4) {
        const FourVectors now = load(&points[i]);
        std::array<std::int32_t, 12> bits;
        for (std::size_t k = 0; k < 3; ++k) {
            const Bits of =
                (~(now[k] >= least[k]) & below[k]) | (~(now[k] <= most[k]) & (below[k] + below[k]));
            std::memcpy(&bits[4 * k], &of, sizeof of);
        }
        for (std::size_t k = 0; k < 4; ++k)
            found[i + k] = std::uint8_t(bits[3 * k] | bits[3 * k + 1] | bits[3 * k + 2]);
    }
    for (std::size_t i = whole; i < points.size(); ++i) found[i] = sides(points[i], low, high);
    return found;
}

bool is_finite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

vec3 sane(vec3 velocity) {
    if (!is_finite(velocity)) return vec3(0);
    const float speed = glm::length(velocity);
    return speed > Patch::fastest_guess ? Patch::fastest_guess / speed * velocity : velocity;
}

// Whether the bounding sphere of a triangle comes within `radius` of `centre`.
bool comes_near(vec3 a, vec3 b, vec3 c, vec3 centre, float radius) {
    const vec3 middle = (a + b + c) / 3.0f, off = middle - centre;
    if (glm::dot(off, off) <= radius * radius) return true;
    const float size =
        std::max({glm::distance(a, middle), glm::distance(b, middle), glm::distance(c, middle)});
    return !(glm::distance(middle, centre) > radius + size);
}

constexpr std::size_t block = 64;  // triangles, and vertices, that are often ruled out together

// Calls act(number) for the triangles with finite corners that may come within `radius` of `centre`.
template <class Span, class Act>
void for_near(const Touchable& surface, const std::vector<Span>& spans, vec3 centre, float radius,
              const Act& act) {
    const std::vector<std::uint8_t> outside = sides(surface.positions, centre - radius, centre + radius);
    std::vector<std::uint8_t> all_outside;  // of each block: the sides on which all of its vertices lie
    for (std::size_t first = 0; first < outside.size(); first += block) {
        std::uint8_t shared = 0xff;
        for (std::uint8_t one : std::span(outside).subspan(first, std::min(block, outside.size() - first)))
            shared &= one;
        all_outside.push_back(shared);
    }
    for (std::size_t k = 0; k < spans.size(); ++k) {
        std::uint8_t shared = 0xff;
        for (std::size_t i = spans[k].first; i <= spans[k].last && shared; ++i) shared &= all_outside[i];
        if (shared) continue;
        const std::size_t end = std::min((k + 1) * block, surface.triangles.size());
        for (std::size_t i = k * block; i < end; ++i) {
            const uvec3 t = surface.triangles[i];
            if (outside[t.x] & outside[t.y] & outside[t.z]) continue;
            const vec3 a = surface.positions[t.x], b = surface.positions[t.y], c = surface.positions[t.z];
            if (is_finite(a) && is_finite(b) && is_finite(c) && comes_near(a, b, c, centre, radius))
                act(int(i));
        }
    }
}

// ---- a hierarchy along a Z curve ----

// The place of a triangle's middle along a Z curve (its Morton code), which keeps neighbours together.
struct OnCurve {
    std::uint64_t code;
    Index face;
};

constexpr int bits = 14, digit = 11;  // of a code: of each axis; at which codes are sorted at once

// Puts two zeros before each of a number's bits, of which there are 16 at most.
std::uint64_t spread(std::uint64_t number) {
    number = (number | number << 16) & 0xff00'00ff;
    number = (number | number << 8) & 0xf0'0f00'f00f;
    number = (number | number << 4) & 0xc30'c30c'30c3;
    return (number | number << 2) & 0x2492'4924'9249;
}

// Radix sort: its time grows no faster than the number of faces.
void sort(std::vector<OnCurve>& curve) {
    std::vector<OnCurve> other(curve.size());
    for (int shift = 0; shift < 3 * bits; shift += digit) {
        const auto key = [&](const OnCurve& one) { return one.code >> shift & ((1u << digit) - 1); };
        std::array<Index, (1 << digit) + 1> place = {};
        for (const OnCurve& one : curve) ++place[key(one) + 1];
        for (std::size_t i = 1; i < place.size(); ++i) place[i] += place[i - 1];
        for (const OnCurve& one : curve) other[place[key(one)]++] = one;
        curve.swap(other);
    }
}

std::vector<OnCurve> along_curve(const std::vector<vec3>& middles) {
    const Bounds box = bounds(middles);
    const vec3 size = box.size();
    constexpr float most = (1 << bits) - 1;
    const float scale = most / std::max({size.x, size.y, size.z, std::numeric_limits<float>::min()});
    std::vector<OnCurve> curve(middles.size());
    for (std::size_t i = 0; i < middles.size(); ++i) {
        std::uint64_t code = 0;
        for (int k = 0; k < 3; ++k) {
            const float cell =
                scale * (middles[i][k] - box.low[k]);  // not a number, if all is infinitely wide
            code = code << 1 | spread(std::uint64_t(std::min(std::max(0.0f, cell), most)));
        }
        curve[i] = {code, Index(i)};
    }
    sort(curve);
    return curve;
}

// Makes the node of a range of the curve and, after it, those below. A range is divided where the first bit
// changes that is not the same in all of its codes.
template <class Node>
void split(std::span<const OnCurve> curve, Index first, Index count, std::vector<Node>& nodes) {
    constexpr Index most_in_a_leaf = 4;
    const std::size_t here = nodes.size();
    nodes.push_back({first, count, 0});
    if (count <= most_in_a_leaf) return;
    const auto range = curve.subspan(first, count);
    Index half = count / 2;
    if (const std::uint64_t differ = range.front().code ^ range.back().code; differ != 0) {
        const std::uint64_t bit = std::bit_floor(differ);
        const auto has_none = [&](const OnCurve& one) { return (one.code & bit) == 0; };
        half = Index(std::partition_point(range.begin(), range.end(), has_none) - range.begin());
    }
    split(curve, first, half, nodes);
    nodes[here].second = Index(nodes.size());
    split(curve, first + half, count - half, nodes);
}

// A bound on how far any vertex has moved: the largest move along each axis, taken together. Where a position
// is not a number, it does not count.
float largest_move(std::span<const vec3> from, std::span<const vec3> to) {
    FourVectors most = {};
    const std::size_t whole = to.size() / 4 * 4;
    for (std::size_t i = 0; i < whole; i += 4) {
        const FourVectors before = load(&from[i]), now = load(&to[i]);
        for (std::size_t k = 0; k < 3; ++k) {
            const Register move = now[k] - before[k], squared = move * move;
            most[k] = squared > most[k] ? squared : most[k];
        }
    }
    vec3 squares(0);
    for (int k = 0; k < 12; ++k) squares[k % 3] = std::max(squares[k % 3], most[std::size_t(k / 4)][k % 4]);
    for (std::size_t i = whole; i < to.size(); ++i) {
        const vec3 move = to[i] - from[i];
        squares = glm::max(squares, move * move);
    }
    return std::sqrt(squares.x + squares.y + squares.z);
}

// m: of all boxes along all axes.
template <class Box>
double total_size(const std::vector<Box>& boxes) {
    decltype(Box::low) total = {};
    for (const Box& box : boxes) total += box.high - box.low;
    return double(total[0]) + total[1] + total[2];
}

}  // namespace

Patch::Patch(std::span<const Touchable> surfaces, vec3 centre, float radius, double time)
    : Patch(faces_near(surfaces, spans(surfaces), centre, radius), surfaces, centre, radius, time) {}

Patch::Patch(std::shared_ptr<const Faces> faces, std::span<const Touchable> surfaces, vec3 centre,
             float radius, double time)
    : centre_(centre),
      radius_(radius),
      time_(time),
      surfaces_(surfaces.size()),
      faces_(std::move(faces)),
      boxes_(faces_->nodes.size()),
      positions_(faces_->vertices.size()),
      velocities_(faces_->vertices.size()) {
    gather(surfaces);
    enclose();
}

std::vector<Patch::Spans> Patch::spans(std::span<const Touchable> surfaces) {
    std::vector<Spans> all;
    for (const Touchable& surface : surfaces) {
        Spans& spans = all.emplace_back();
        for (std::size_t first = 0; first < surface.triangles.size(); first += block) {
            unsigned low = none, high = 0;
            const std::size_t count = std::min(block, surface.triangles.size() - first);
            for (uvec3 t : surface.triangles.subspan(first, count)) {
                low = std::min({low, t.x, t.y, t.z});
                high = std::max({high, t.x, t.y, t.z});
            }
            if (high >= surface.positions.size())
                throw Error("a triangle that refers to missing vertices", "a surface to touch",
                            "use indices of its own positions");
            spans.push_back({Index(low / block), Index(high / block)});
        }
    }
    return all;
}

std::vector<int> Patch::near(const Touchable& surface, vec3 centre, float radius) {
    std::vector<int> found;
    for_near(surface, spans({&surface, 1}).front(), centre, radius, [&](int t) { found.push_back(t); });
    return found;
}

std::shared_ptr<const Patch::Faces> Patch::faces_near(std::span<const Touchable> surfaces,
                                                      const std::vector<Spans>& spans, vec3 centre,
                                                      float radius) {
    std::vector<From> from;
    std::vector<vec3> middles;
    std::vector<std::vector<Index>> place(surfaces.size());  // of a surface's vertices, in the patch
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
        const Touchable& surface = surfaces[s];
        place[s].assign(surface.positions.size(), none);
        for_near(surface, spans[s], centre, radius, [&](int t) {
            const uvec3 corners = surface.triangles[std::size_t(t)];
            from.push_back({int(s), t, surface.is_sheet});
            middles.push_back(surface.positions[corners.x] / 3.0f + surface.positions[corners.y] / 3.0f +
                              surface.positions[corners.z] / 3.0f);
        });
    }
    const std::vector<OnCurve> curve = along_curve(middles);
    Faces faces;
    if (!curve.empty()) split(curve, 0, Index(curve.size()), faces.nodes);
    faces.sorted.resize(curve.size());
    faces.from.reserve(curve.size());
    faces.triangles.reserve(curve.size());
    faces.vertices.reserve(curve.size());
    for (const OnCurve& one : curve) {
        const auto [s, t, is_sheet] = from[one.face];
        uvec3 triangle = surfaces[std::size_t(s)].triangles[std::size_t(t)];
        for (int k = 0; k < 3; ++k) {
            Index& at = place[std::size_t(s)][triangle[k]];
            if (at == none) {
                at = Index(faces.vertices.size());
                faces.vertices.push_back({s, triangle[k]});
            }
            triangle[k] = at;
        }
        faces.sorted[one.face] = Index(faces.from.size());
        const std::span<const int> numbers = surfaces[std::size_t(s)].numbers;
        faces.from.push_back({s, numbers.empty() ? t : numbers[std::size_t(t)], is_sheet});
        faces.triangles.push_back(triangle);
    }
    return std::make_shared<const Faces>(std::move(faces));
}

void Patch::gather(std::span<const Touchable> surfaces) {
    for (const Touchable& surface : surfaces)
        if (!surface.velocities.empty() && surface.velocities.size() != surface.positions.size())
            throw Error("a number of velocities that differs from that of the vertices", "a surface to touch",
                        "give one for each, or none");
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        const auto [s, vertex] = faces_->vertices[i];
        const Touchable& surface = surfaces[std::size_t(s)];
        positions_[i] = in_register(surface.positions[vertex]);
        if (surface.velocities.empty()) continue;
        const vec3 velocity = sane(surface.velocities[vertex]);
        velocities_[i] = in_register(velocity);
        fastest_ = std::max(fastest_, glm::length(velocity));
    }
}

void Patch::enclose() {
    const auto include = [](MovingBox& box, const Vector& low, const Vector& high, const Vector& low_speed,
                            const Vector& high_speed) {
        box = {low < box.low ? low : box.low, high > box.high ? high : box.high,
               low_speed < box.low_speed ? low_speed : box.low_speed,
               high_speed > box.high_speed ? high_speed : box.high_speed};
    };
    const std::vector<Node>& nodes = faces_->nodes;
    for (std::size_t i = nodes.size(); i-- > 0;) {  // children come after their parents
        const Node& node = nodes[i];
        if (node.second == 0) {
            const unsigned some = faces_->triangles[node.first].x;
            MovingBox box = {positions_[some], positions_[some], velocities_[some], velocities_[some]};
            for (Index face = node.first; face < node.first + node.count; ++face)
                for (int k = 0; k < 3; ++k) {
                    const unsigned corner = faces_->triangles[face][k];
                    const Vector place = positions_[corner], velocity = velocities_[corner];
                    include(box, place, place, velocity, velocity);
                }
            boxes_[i] = box;
        } else {
            const MovingBox& second = boxes_[node.second];
            boxes_[i] = boxes_[i + 1];
            include(boxes_[i], second.low, second.high, second.low_speed, second.high_speed);
        }
    }
}

double Patch::age_at(double time) const { return std::clamp(time - time_, 0.0, longest_guess); }

std::optional<Patch::Face> Patch::find(int surface, int triangle, double time) const {
    if (!faces_) return std::nullopt;
    const std::pair wanted(surface, triangle);
    const auto key = [&](Index face) {
        return std::pair(faces_->from[face].surface, faces_->from[face].triangle);
    };
    const auto found = std::lower_bound(faces_->sorted.begin(), faces_->sorted.end(), wanted,
                                        [&](Index face, auto other) { return key(face) < other; });
    if (found == faces_->sorted.end() || key(*found) != wanted) return std::nullopt;
    return face_at(*found, time);
}

Patch::Face Patch::face_at(Index face, double time) const {
    const From& from = faces_->from[face];
    const double age = age_at(time);
    const bool guesses = time - time_ <= longest_guess;  // whether it is extrapolated; after that it stands
                                                         // still
    Face found{{}, {}, from.surface, from.triangle, from.is_sheet};
    for (int k = 0; k < 3; ++k) {
        const unsigned corner = faces_->triangles[face][k];
        const auto vector = [](const Vector& v) { return dvec3(v[0], v[1], v[2]); };
        const dvec3 velocity = vector(velocities_[corner]);
        found.velocities[k] = guesses ? velocity : dvec3(0);
        found.corners[k] = vector(positions_[corner]) + age * velocity;
    }
    return found;
}

// ---- one after another ----

Patch PatchMaker::next(std::span<const Touchable> surfaces, vec3 centre, float radius, double time) {
    if (knows(surfaces, centre, radius)) {
        Patch patch(faces_, surfaces, centre, radius, time);
        if (is_sound(patch)) return patch;
    }
    look(surfaces, centre, radius);
    Patch patch(faces_, surfaces, centre, radius, time);
    size_ = total_size(patch.boxes_);
    return patch;
}

bool PatchMaker::is_same(std::span<const Touchable> surfaces) const {
    const auto same = [](const Seen& seen, const Touchable& surface) {
        return seen.triangles.data() == surface.triangles.data() &&
               seen.triangles.size() == surface.triangles.size() &&
               seen.watched.size() == surface.positions.size() && seen.is_sheet == surface.is_sheet;
    };
    return std::equal(seen_.begin(), seen_.end(), surfaces.begin(), surfaces.end(), same);
}

// Whether all triangles that come within `radius` of `centre` are among the faces: the points of all others
// were out of reach, and none of them has moved farther than a vertex.
bool PatchMaker::knows(std::span<const Touchable> surfaces, vec3 centre, float radius) const {
    if (!faces_ || !is_same(surfaces)) return false;
    float move = 0;
    for (std::size_t s = 0; s < seen_.size(); ++s)
        move = std::max(move, largest_move(seen_[s].watched, surfaces[s].positions));
    return std::isfinite(move) && glm::distance(centre, centre_) + move + radius <= reach_;
}

// Whether all positions are finite and the boxes are not much larger than they need be.
bool PatchMaker::is_sound(const Patch& patch) const {
    Patch::Vector zero = {};  // unless one is infinite or not a number
    for (const Patch::Vector& position : patch.positions_) zero += position - position;
    return zero[0] + zero[1] + zero[2] == 0 && total_size(patch.boxes_) <= 2 * size_;
}

void PatchMaker::look(std::span<const Touchable> surfaces, vec3 centre, float radius) {
    const float reach = (1 + margin) * radius;
    if (!faces_ || !is_same(surfaces)) spans_ = Patch::spans(surfaces);
    faces_ = Patch::faces_near(surfaces, spans_, centre, reach);
    centre_ = centre;
    reach_ = (1 - rounding) * reach - rounding * glm::length(centre);
    seen_.resize(surfaces.size());
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
        seen_[s].triangles = surfaces[s].triangles;
        seen_[s].is_sheet = surfaces[s].is_sheet;
        watch(surfaces[s].positions, seen_[s].watched);
    }
}

// All triangles of a vertex within reach are known, so that it may move as it likes. One that is not a number
// may come back anywhere, so that it counts as infinitely far away.
void PatchMaker::watch(std::span<const vec3> positions, std::vector<vec3>& watched) const {
    watched.resize(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const vec3 p = positions[i], off = p - centre_;
        const float squared = glm::dot(off, off);
        if (squared >= reach_ * reach_)  // nearly always
            watched[i] = p;
        else
            watched[i] =
                squared < reach_ * reach_ ? vec3(unwatched) : glm::mix(p, vec3(infinity), glm::isnan(p));
    }
}

}  // namespace palpate
