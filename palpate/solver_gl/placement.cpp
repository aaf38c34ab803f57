#include "palpate/solver_gl/placement.h"

#include <algorithm>
#include <numeric>

namespace palpate::gpu {
namespace {

constexpr std::size_t most_links = 20;       // with shares in quarters: ten in a word
constexpr std::size_t slots_for_a_node = 6;  // beyond, springs that are written out take less memory and time

struct Box {
    ivec3 low = ivec3(0), dims = ivec3(0);
};
Box box_of(std::span<const ivec3> places) {
    if (places.empty()) return {};
    ivec3 low = places[0], high = low;
    for (ivec3 p : places) low = glm::min(low, p), high = glm::max(high, p);
    return {low, high - low + 1};
}

}  // namespace

Placement::Placement(const Body& body) {
    const GridSprings* springs = body.terms.size() == 1 ? body.grid() : nullptr;
    const Box box = springs ? box_of(body.at) : Box{};
    const double volume = double(box.dims.x) * box.dims.y * box.dims.z;
    grid = springs && body.count() > 0 && volume <= double(slots_for_a_node * body.count()) &&
           !(springs->in_quarters() && springs->links.size() > most_links);
    if (!grid) {
        slots = int(body.count());
        slot.resize(body.count());
        std::iota(slot.begin(), slot.end(), 0);
    } else {
        write_grid(body);
    }
    for (std::size_t i = 0; i < body.count(); ++i)
        if (body.area[i] > 0 || tissue_of(body)) rim.push_back(slot[i]);
}

void Placement::write_grid(const Body& body) {
    const Box box = box_of(body.at);
    auto number = [&](ivec3 p) { return (p.z * box.dims.y + p.y) * box.dims.x + p.x; };
    int room = 0;
    for (const Link& link : body.grid()->links) {
        offsets.push_back(number(link.offset));
        room = std::max(room, std::abs(offsets.back()));
    }
    dims = box.dims;
    first = room;
    for (ivec3 p : body.at) slot.push_back(first + number(p - box.low));
    slots = room + box.dims.x * box.dims.y * box.dims.z + room;
}

}  // namespace palpate::gpu
