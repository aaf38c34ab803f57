#include "palpate/solver/guides.h"

#include <algorithm>

namespace palpate {

Guides::Guides(const Body& body, dvec3 origin) : guide_of_(body.count(), -1) {
    for (std::size_t i = 0; i < body.count(); ++i) {
        if (body.inverse_mass[i] > 0) continue;
        guide_of_[i] = int(guides_.size());
        guides_.push_back({.node = int(i)});
        at_.push_back(origin + dvec3(body.positions[i]));
    }
}

void Guides::stand(const State& state) {
    for (std::size_t g = 0; g < guides_.size(); ++g) at_[g] = state.positions[std::size_t(guides_[g].node)];
}

void Guides::write_to(State& state) const {
    for (std::size_t g = 0; g < guides_.size(); ++g) state.positions[std::size_t(guides_[g].node)] = at_[g];
}

std::span<const Guide> Guides::lead(const Influences& influences, double seconds) {
    const double arrival = std::max(influences.arrival, seconds);
    for (std::size_t g = 0; g < guides_.size(); ++g) guides_[g] = {.node = guides_[g].node, .to = at_[g]};
    for (const Move& move : influences.moves)
        for (std::size_t k = 0; k < move.nodes.size(); ++k) {
            const int g = guide_of_[std::size_t(move.nodes[k])];
            if (g < 0) continue;
            Guide& guide = guides_[std::size_t(g)];
            const dvec3 from = at_[std::size_t(g)], to(move.to[k]);
            guide.velocity = (to - from) / arrival;
            guide.to = arrival > seconds ? from + seconds * guide.velocity : to;
            guide.is_led = true;
        }
    return guides_;
}

void Guides::arrive() {
    for (std::size_t g = 0; g < guides_.size(); ++g)
        if (guides_[g].is_led) at_[g] = guides_[g].to;
}

}  // namespace palpate
