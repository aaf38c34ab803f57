#include "palpate/body/dent.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

using std::exp;

#define FN
#define select(c, a, b) ((c) ? (a) : (b))

// dent.inl for C++. Dents that do not act are given depth 0.
struct Text {
    using Real = float;
    using Real3 = vec3;

    std::span<const Dent> dents;
    int dent_count = int(dents.size());
    Dent dent(int i) const { return acts(dents[std::size_t(i)]) ? dents[std::size_t(i)] : Dent{}; }

#include "palpate/body/dent.inl"
};

#undef FN
#undef select

bool sane(float length) { return std::abs(length) < 1e9f; }

}  // namespace

bool acts(const Dent& dent) {
    return sane(dent.centre.x) && sane(dent.centre.y) && sane(dent.centre.z) && sane(dent.depth) &&
           sane(dent.facing.x) && sane(dent.facing.y) && sane(dent.facing.z) && sane(dent.width) &&
           dent.width >= 1e-9f && dent.depth != 0;
}

float depth_at(std::span<const Dent> dents, vec3 place, vec3 normal) {
    return Text{dents}.depth_at(place, normal);
}

vec3 dented(std::span<const Dent> dents, vec3 place, vec3 normal) {
    return Text{dents}.dented(place, normal);
}

vec3 dented_normal(std::span<const Dent> dents, vec3 place, vec3 normal) {
    return Text{dents}.dented_normal(place, normal);
}

double deepest_dent(double width) { return 1.2 * width; }

float largest_displacement(std::span<const Dent> dents) {
    float sum = 0;
    for (const Dent& dent : dents) sum += acts(dent) ? std::abs(dent.depth) : 0;
    return sum;
}

}  // namespace palpate
