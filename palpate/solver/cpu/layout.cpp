#include "palpate/solver/cpu/layout.h"

#include "palpate/body/grid.h"

#include <algorithm>
#include <array>

namespace palpate::cpu {
namespace {

int rounded_up(int count, int lanes) { return (count + lanes - 1) / lanes * lanes; }

// Nodes of one row with no gap as wide as a register.
struct Segment {
    ivec3 first;                  // the place of its first node
    int length = 0;               // to its last
    int slot = 0;                 // of its first
    std::vector<int> nodes = {};  // that are there
};

// The places with `axis` in front: rows run along x.
std::vector<ivec3> turned(std::span<const ivec3> places, int axis) {
    std::vector<ivec3> to;
    for (ivec3 p : places) to.push_back({p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]});
    return to;
}

std::vector<Segment> segments(std::span<const ivec3> places, int lanes) {
    std::vector<int> order(places.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = int(i);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
        const ivec3 p = places[std::size_t(a)], q = places[std::size_t(b)];
        return std::array{p.z, p.y, p.x} < std::array{q.z, q.y, q.x};
    });
    std::vector<Segment> all;
    for (int node : order) {
        const ivec3 p = places[std::size_t(node)];
        const bool goes_on = !all.empty() && all.back().first.y == p.y && all.back().first.z == p.z &&
                             p.x - (all.back().first.x + all.back().length) < lanes - 1;
        if (!goes_on) all.push_back({p});
        all.back().length = p.x - all.back().first.x + 1;
        all.back().nodes.push_back(node);
    }
    return all;
}

bool fills_its_box(std::span<const ivec3> places) {
    if (places.empty()) return false;
    ivec3 low = places[0], high = places[0];
    for (ivec3 p : places) low = glm::min(low, p), high = glm::max(high, p);
    const ivec3 size = high - low + 1;
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z) == places.size();
}

class GridLayout {
 public:
    GridLayout(const Body& body, int lanes, Layout& layout)
        : body_(body), stencil_(*body.grid()), lanes_(lanes), layout_(layout) {
        box_ = fills_its_box(body.at);
        choose_axis();
        for (const Link& link : stencil_.links) links_.push_back(link.offset);
        if (tissue_of(body)) {
            cells_ = own_cells(body);
            for (int k = 1; k < 8; ++k) links_.push_back(layout.corner(k));
            for (int row = 1; row < 4; ++row) links_.push_back(-layout.corner(2 * row));
        }
        give_slots();
        if (box_)
            add_runs_of_box();
        else
            for (const Segment& segment : segments_) add_runs(segment);
    }

 private:
    // The axis along which rows need the fewest registers. A box needs as many along each.
    void choose_axis() {
        std::size_t least = 0;
        for (int axis = 0; axis < (box_ ? 1 : 3); ++axis) {
            std::vector<ivec3> places = turned(body_.at, axis);
            std::vector<Segment> rows = segments(places, lanes_);
            std::size_t registers = 0;
            for (const Segment& row : rows) registers += std::size_t(rounded_up(row.length, lanes_) / lanes_);
            if (axis > 0 && registers >= least) continue;
            least = registers;
            layout_.row_axis = axis;
            places_ = std::move(places);
            segments_ = std::move(rows);
        }
    }

    void give_slots() {
        layout_.slot.resize(places_.size());
        for (Segment& segment : segments_) {
            segment.slot = layout_.slots;
            for (int node : segment.nodes)
                layout_.slot[std::size_t(node)] =
                    segment.slot + places_[std::size_t(node)].x - segment.first.x;
            layout_.slots += box_ ? segment.length : rounded_up(segment.length, lanes_);
        }
        layout_.slots = rounded_up(layout_.slots, lanes_);
    }

    // A box is one row: a node's neighbours are as far away as in the middle of it.
    void add_runs_of_box() {
        if (segments_.empty()) return;
        const ivec3 size =
            segments_.back().first - segments_.front().first + ivec3(segments_.back().length, 1, 1);
        std::vector<int> offsets;
        for (ivec3 link : links_) offsets.push_back(link.x + size.x * (link.y + size.y * link.z));
        for (int first = 0; first < layout_.slots; first += lanes_) add(first, offsets);
    }

    void add_runs(const Segment& segment) {
        const int end = segment.slot + rounded_up(segment.length, lanes_);
        for (int first = segment.slot; first < end; first += lanes_) add(first, offsets_of(segment, first));
    }

    // Register after register: those whose neighbours are equally far away make one run.
    void add(int first, const std::vector<int>& offsets) {
        auto& runs = layout_.runs;
        const bool goes_on = !runs.empty() && runs.back().first + runs.back().count == first &&
                             runs.back().count + lanes_ <= Block::most &&
                             std::equal(offsets.begin(), offsets.end(),
                                        layout_.offsets.end() - std::ptrdiff_t(offsets.size()));
        if (goes_on) {
            runs.back().count += lanes_;
        } else {
            runs.push_back({first, lanes_});
            layout_.offsets.insert(layout_.offsets.end(), offsets.begin(), offsets.end());
        }
        for (int offset : offsets) {
            layout_.margin = std::max(layout_.margin, -(first + offset));
            layout_.margin = std::max(layout_.margin, first + offset + lanes_ - layout_.slots);
        }
    }

    // From the slots of one register to their neighbours' along each link, 0 where none has any.
    std::vector<int> offsets_of(const Segment& segment, int first) const {
        std::vector<int> offsets(links_.size(), 0);
        const auto from = nodes_from(segment, first);
        for (std::size_t l = 0; l < offsets.size(); ++l)
            for (int node : from) {
                if (!leads_on(std::size_t(node), l)) continue;
                const int to = number_.at(body_.at[std::size_t(node)] + links_[l]);
                offsets[l] = layout_.slot[std::size_t(to)] - layout_.slot[std::size_t(node)];
                break;  // the others' are as far: no gap within a segment is as wide as a register
            }
        return offsets;
    }

    // Whether a node has this link: by a spring, or through a cell of tissue that holds both of its ends.
    bool leads_on(std::size_t node, std::size_t link) const {
        if (link < stencil_.links.size() && stencil_.quarters(node, link) > 0) return true;
        if (cells_.empty()) return false;
        for (int k = 0; k < 8; ++k) {
            const ivec3 end = cell_corner(k) + links_[link];
            const bool holds =
                glm::all(glm::greaterThanEqual(end, ivec3(0))) && glm::all(glm::lessThanEqual(end, ivec3(1)));
            if (holds && cells_[node][std::size_t(k)] >= 0) return true;
        }
        return false;
    }

    std::span<const int> nodes_from(const Segment& segment, int first) const {
        auto before = [&](int slot) {
            return [this, slot](int node) { return layout_.slot[std::size_t(node)] < slot; };
        };
        auto begin = std::partition_point(segment.nodes.begin(), segment.nodes.end(), before(first));
        auto end = std::partition_point(begin, segment.nodes.end(), before(first + lanes_));
        return {begin, end};
    }

    const Body& body_;
    const GridSprings& stencil_;
    std::vector<ivec3> links_;     // the springs', and through the cells of tissue
    std::vector<OwnCells> cells_;  // of tissue
    const int lanes_;
    Layout& layout_;
    const GridIndex number_{body_.at};
    bool box_ = false;
    std::vector<ivec3> places_;
    std::vector<Segment> segments_;
};

}  // namespace

Layout::Layout(const Body& body, int lanes) {
    GridLayout(body, lanes, *this);
    make_blocks();
}

Layout::Layout(std::span<const int> order, int lanes)
    : slot(order.size()), slots(rounded_up(int(order.size()), lanes)) {
    for (std::size_t i = 0; i < order.size(); ++i) slot[std::size_t(order[i])] = int(i);
    for (int first = 0; first < slots; first += Block::most)
        runs.push_back({first, std::min(Block::most, slots - first)});
    make_blocks();
}

ivec3 Layout::corner(int k) const {
    ivec3 c(0);
    for (int bit = 0; bit < 3; ++bit) c[(row_axis + bit) % 3] = k >> bit & 1;
    return c;
}

void Layout::make_blocks() {
    for (int r = 0; r < int(runs.size()); ++r) {
        const Run& run = runs[std::size_t(r)];
        if (blocks.empty() || run.first + run.count - blocks.back().first_slot > Block::most)
            blocks.push_back({r, r, run.first, run.first});
        blocks.back().end_run = r + 1;
        blocks.back().end_slot = run.first + run.count;
    }
}

}  // namespace palpate::cpu
