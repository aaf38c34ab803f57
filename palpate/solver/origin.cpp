#include "palpate/solver/origin.h"

#include "palpate/body/simulation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

// In sizes of a body: how far it may be from what it counts from. Less would save a digit more, and cost
// bodies that hardly move the promise that a state is restored to the bit.
constexpr double far = 2;
// The same for an origin that goes along: to move it costs something at every node.
constexpr double slack = 1.0 / 64;

double largest(dvec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// m: what float may have cost a place so far out, which was turned and moved before.
double lost(double far) { return 4 * far * double(std::numeric_limits<float>::epsilon()); }

dmat3 nearest_rotation(dmat3 a) {  // the polar decomposition's, by Newton's method; of a mirror a mirror
    for (int i = 0; i < 20; ++i) a = 0.5 * (a + glm::transpose(glm::inverse(a)));
    return a;
}

// Where a grid lies: its place (0, 0, 0), and what a step along each axis adds, m.
struct GridFit {
    dvec3 origin = dvec3(0);
    dmat3 axes = dmat3(0);

    // By least squares.
    explicit GridFit(const Body& body) {
        const auto count = double(body.count());
        dvec3 mean_place(0), mean(0);
        for (std::size_t i = 0; i < body.count(); ++i) {
            mean_place += dvec3(body.at[i]) / count;
            mean += dvec3(body.positions[i]) / count;
        }
        dmat3 spread(0), towards(0);
        for (std::size_t i = 0; i < body.count(); ++i) {
            const dvec3 place = dvec3(body.at[i]) - mean_place;
            spread += glm::outerProduct(place, place);
            towards += glm::outerProduct(dvec3(body.positions[i]) - mean, place);
        }
        for (int k = 0; k < 3; ++k)
            if (!(spread[k][k] > 0)) spread[k][k] = 1;  // a sheet has no third axis
        axes = towards * glm::inverse(spread);
        straighten(body, std::sqrt(glm::dot(spread[0] + spread[1] + spread[2], dvec3(1)) / count));
        origin = mean - axes * mean_place;
    }

    dvec3 at(ivec3 place) const { return origin + axes * dvec3(place); }

 private:
    // At right angles, `spacing` long and along the world's axes, as far as float lets one tell. `steps`: how
    // wide the grid is.
    void straighten(const Body& body, double steps) {
        const double hair = lost(largest_coordinate(body)) / (4 * steps);
        const dmat3 measured = axes;
        auto take = [&](dmat3 better) {
            for (int k = 0; k < 3; ++k)
                if (measured[k] != dvec3(0) && !(largest(better[k] - measured[k]) <= hair)) return;
            axes = better;
        };
        dmat3 all = axes;
        for (int k = 0; k < 3; ++k)
            if (all[k] == dvec3(0))
                all[k] =
                    double(body.spacing) * glm::normalize(glm::cross(all[(k + 1) % 3], all[(k + 2) % 3]));
        take(double(body.spacing) * nearest_rotation(all / double(body.spacing)));
        take(dmat3(body.spacing));
    }
};

// The places at rest in double: those of a grid's nodes as they were before they were rounded.
std::vector<dvec3> exact_places(const Body& body) {
    std::vector<dvec3> places(body.positions.begin(), body.positions.end());
    if (!body.grid() || body.count() == 0) return places;
    const GridFit fit(body);
    const double hair = lost(largest_coordinate(body));
    for (std::size_t i = 0; i < body.count(); ++i)
        if (!(largest(fit.at(body.at[i]) - places[i]) <= hair)) return places;
    for (std::size_t i = 0; i < body.count(); ++i) places[i] = fit.at(body.at[i]);
    return places;
}

Body counted_from(dvec3 origin, const Body& body) {
    Body local = body;
    const double hair = lost(largest_coordinate(body));
    const std::vector<dvec3> places = exact_places(body);
    for (std::size_t i = 0; i < places.size(); ++i) local.positions[i] = vec3(places[i] - origin);
    for (Term& term : local.terms)
        if (auto* listed = std::get_if<ListedSprings>(&term))
            for (Spring& spring : listed->springs) {
                const auto a = std::size_t(spring.a), b = std::size_t(spring.b);
                const float apart = glm::distance(local.positions[a], local.positions[b]);
                if (std::abs(apart - spring.rest) <= hair) spring.rest = apart;
            }
    return local;
}

}  // namespace

float largest_coordinate(const Body& body) {
    float most = 0;
    for (vec3 p : body.positions)
        for (int k = 0; k < 3; ++k) most = std::max(most, std::abs(p[k]));
    return most;
}

FloatingOrigin::FloatingOrigin(const Body& body) {
    const Bounds box = bounds(body.positions);
    const vec3 size = box.size();
    size_ = std::max({size.x, size.y, size.z});
    const dvec3 middle(box.centre());
    if (size_ > 0 && largest(middle) > far * size_) home_ = middle;
    change(body);
}

void FloatingOrigin::change(const Body& body) {
    if (home_ != dvec3(0)) local_ = counted_from(home_, body);
    if (body.count() > 0) begin_ = home_ + dvec3(local(body).positions[0]);
}

Origin FloatingOrigin::beside(dvec3 first_node, dvec3 velocity, const Origin& now) const {
    const dvec3 way = first_node - begin_;
    if (!(size_ > 0) || !(largest(way) > far * size_)) return first();
    const Origin best{home_ + way, velocity};
    const bool serves = largest(best.place - now.place) <= slack * size_ &&
                        largest(best.velocity - now.velocity) * frame_seconds <= slack * size_;
    return serves ? now : best;
}

}  // namespace palpate
