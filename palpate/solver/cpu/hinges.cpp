#include "palpate/solver/cpu/hinges.h"

#include <algorithm>
#include <bit>

namespace palpate::cpu {

HingeMemory::HingeMemory(const Body& body, const Layout& layout, int lanes) : lanes_(std::size_t(lanes)) {
    const std::vector<std::vector<OwnHinge>> hinges = own_hinges(body);
    const auto slots = std::size_t(layout.slots);
    slices_.resize((slots + lanes_ - 1) / lanes_);
    for (std::size_t i = 0; i < body.count(); ++i) {
        int& count = slices_[std::size_t(layout.slot[i]) / lanes_].count;
        count = std::max(count, int(hinges[i].size()));
    }
    int records = 0;
    for (Slice& slice : slices_) {
        slice.first = records;
        records += slice.count;
    }
    records_ = Array<std::uint32_t>(std::size_t(records) * lanes_ * numbers, 2);
    // A hinge that is not there leads to the node itself and has no stiffness.
    for (std::size_t slot = 0; slot < slots; ++slot)
        for (std::size_t h = 0; h < std::size_t(slices_[slot / lanes_].count); ++h) {
            for (std::size_t n = 0; n < 3; ++n) number(h, slot, n) = std::uint32_t(4 * slot);
            write(h, slot, {0, 0, 1, 0});
        }
    for (std::size_t i = 0; i < body.count(); ++i)
        for (std::size_t h = 0; h < hinges[i].size(); ++h) {
            const OwnHinge& own = hinges[i][h];
            const auto slot = std::size_t(layout.slot[i]);
            for (std::size_t n = 0; n < 3; ++n) {
                const auto other = std::size_t(own.others[n]);
                number(h, slot, n) = std::uint32_t(4 * layout.slot[other]);
                const vec3 way = body.positions[other] - body.positions[i];
                for (std::size_t axis = 0; axis < 3; ++axis)
                    number(h, slot, 3 + 3 * axis + n) = std::bit_cast<std::uint32_t>(way[int(axis)]);
            }
            write(h, slot, {own.stiffness, own.rest, own.area_square, own.is_end ? 1.0f : 0.0f});
        }
}

void HingeMemory::write(std::size_t hinge, std::size_t slot, const std::array<float, 4>& last) {
    for (std::size_t k = 0; k < last.size(); ++k)
        number(hinge, slot, numbers - last.size() + k) = std::bit_cast<std::uint32_t>(last[k]);
}

std::uint32_t& HingeMemory::number(std::size_t hinge, std::size_t slot, std::size_t k) {
    const std::size_t record = std::size_t(slices_[slot / lanes_].first) + hinge;
    return records_.data()[(record * numbers + k) * lanes_ + slot % lanes_];
}

}  // namespace palpate::cpu
