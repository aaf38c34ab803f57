#include "palpate/solver/cpu/ties.h"

#include "palpate/solver/pass.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

namespace palpate::cpu {
namespace {

bool is_there(const Tie& tie) { return tie.to >= 0 && tie.share > 0; }

// Walks from node to node along springs (Cuthill and McKee): nodes met one after the other are near.
class Walks {
 public:
    Walks(const Table& springs, std::size_t nodes) : springs_(springs), placed_(nodes), seen_(nodes) {
        for (std::size_t i = 0; i < nodes; ++i)
            degree_.push_back(int(std::ranges::count_if(springs.of(i), [](Tie tie) { return tie.to >= 0; })));
    }

    // All nodes, part after part of what hangs together, each from one of its ends to the other.
    std::vector<int> all() {
        std::vector<int> order;
        for (int start = 0; start < int(placed_.size()); ++start)
            while (!placed_[std::size_t(start)]) {
                const std::vector<int> part = from(from(from(start).back()).back());
                for (int node : part) placed_[std::size_t(node)] = true;
                order.insert(order.end(), part.begin(), part.end());
            }
        return order;
    }

 private:
    // What can be reached from a node, and has no place yet: step by step, and where a step leads to several
    // nodes, those with the fewest springs first.
    std::vector<int> from(int start) {
        ++walk_;
        std::vector<int> reached;
        auto reach = [&](int node) {
            if (placed_[std::size_t(node)] || std::exchange(seen_[std::size_t(node)], walk_) == walk_) return;
            reached.push_back(node);
        };
        reach(start);
        for (std::size_t k = 0; k < reached.size(); ++k) {
            const auto before = std::ptrdiff_t(reached.size());
            for (const Tie& tie : springs_.of(std::size_t(reached[k])))
                if (tie.to >= 0) reach(tie.to);
            std::ranges::stable_sort(reached.begin() + before, reached.end(), {},
                                     [this](int node) { return degree_[std::size_t(node)]; });
        }
        return reached;
    }

    const Table& springs_;
    std::vector<int> degree_;
    std::vector<bool> placed_;
    std::vector<int> seen_;  // in which walk last
    int walk_ = 0;
};

// Of each slot; -1: none.
std::vector<int> nodes_in(const Layout& layout) {
    std::vector<int> nodes(std::size_t(layout.slots), -1);
    for (std::size_t i = 0; i < layout.slot.size(); ++i) nodes[std::size_t(layout.slot[i])] = int(i);
    return nodes;
}

// Each as long as the longest of its nodes needs it.
std::vector<Slice> slices_for(const Table& springs, std::span<const int> nodes, int fan, std::size_t lanes) {
    std::vector<Slice> slices;
    int ties = 0;
    for (std::size_t first = 0; first < nodes.size(); first += lanes) {
        TieCount most;
        for (int node : nodes.subspan(first, lanes)) {
            if (node < 0) continue;
            const TieCount count = count_ties(springs.of(std::size_t(node)), fan);
            most = {std::max(most.fan, count.fan), std::max(most.others, count.others)};
        }
        slices.push_back({ties, most.all(), most.fan});
        ties += most.all();
    }
    return slices;
}

// The ties of a node in the order in which the kernels of a slice go through them.
std::vector<Tie> in_order(std::span<const Tie> ties, int fan, const Slice& slice) {
    std::vector<Tie> order(ties.begin(), ties.begin() + slice.fan);
    std::copy_if(ties.begin() + fan, ties.end(), std::back_inserter(order), is_there);
    order.resize(std::size_t(slice.count));
    return order;
}

}  // namespace

TieCount count_ties(std::span<const Tie> ties, int fan) {
    // A closed ring need not come back to where it began; an open one ends in one place that is empty.
    auto only_repeats = [&](std::size_t l) {
        const Tie& tie = ties[l];
        return tie.to < 0 ? ties[l - 1].to < 0 : tie.to == ties[0].to && tie.share * tie.stiffness == 0;
    };
    TieCount count{fan, int(std::count_if(ties.begin() + fan, ties.end(), is_there))};
    while (count.fan > 1 && only_repeats(std::size_t(count.fan) - 1)) --count.fan;
    return count;
}

std::vector<int> order_for(const Table& springs, std::size_t nodes, int fan) {
    std::vector<int> order = Walks(springs, nodes).all(), ties(nodes);
    for (std::size_t i = 0; i < nodes; ++i) ties[i] = count_ties(springs.of(i), fan).all();
    for (std::size_t first = 0; first < nodes; first += Block::most) {
        const auto begin = order.begin() + std::ptrdiff_t(first);
        const auto count = std::min(nodes - first, std::size_t(Block::most));
        std::ranges::stable_sort(begin, begin + std::ptrdiff_t(count), std::greater(),
                                 [&](int node) { return ties[std::size_t(node)]; });
    }
    return order;
}

TieMemory::TieMemory(const Body& body, const Layout& layout, int lanes) : lanes_(std::size_t(lanes)) {
    const Table springs = table(body);
    const std::vector<int> nodes = nodes_in(layout);
    slices_ = slices_for(springs, nodes, body.fan, lanes_);
    const std::size_t ties = slices_.empty() ? 0 : std::size_t(slices_.back().first + slices_.back().count);
    pulling_ = Array<std::byte>(ties * lanes_ * pulling * sizeof(float), 0);
    whole_ = Array<float>(ties * lanes_ * whole, 1);
    for (std::size_t slot = 0; slot < nodes.size(); ++slot) {
        const Slice& slice = slices_[slot / lanes_];
        std::size_t at = std::size_t(slice.first) * lanes_ + slot % lanes_;
        if (nodes[slot] < 0) {
            for (int l = 0; l < slice.count; ++l, at += lanes_) lead(at, slot);
            continue;
        }
        const auto node = std::size_t(nodes[slot]);
        for (const Tie& tie : in_order(springs.of(node), body.fan, slice)) {
            lead(at, tie.to < 0 ? slot : std::size_t(layout.slot[std::size_t(tie.to)]));
            if (tie.to >= 0) write(at, tie, body, node);
            at += lanes_;
        }
    }
}

void TieMemory::lead(std::size_t at, std::size_t slot) {
    std::byte* const record = pulling_.data() + at / lanes_ * lanes_ * pulling * sizeof(float);
    reinterpret_cast<std::uint32_t*>(record)[at % lanes_] = std::uint32_t(4 * slot);
}

void TieMemory::write(std::size_t at, const Tie& tie, const Body& body, std::size_t node) {
    const std::size_t record = at / lanes_ * lanes_, lane = at % lanes_;
    const vec3 way = body.positions[std::size_t(tie.to)] - body.positions[node];
    const float pulls[] = {way.x, way.y, way.z, tie.share * tie.stiffness,
                           tie.share * (tie.stiffness * tie.rest)};
    const float asked[] = {tie.share, tie.stiffness, torn_at(tie.rest, body)};
    whole_within_ = std::min(whole_within_, cpu::whole_within(asked[2], way));
    auto* const numbers = reinterpret_cast<float*>(pulling_.data()) + record * pulling;
    for (std::size_t k = 0; k < std::size(pulls); ++k) numbers[(k + 1) * lanes_ + lane] = pulls[k];
    for (std::size_t k = 0; k < std::size(asked); ++k)
        whole_.data()[record * whole + k * lanes_ + lane] = asked[k];
}

}  // namespace palpate::cpu
