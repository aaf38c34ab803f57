#pragma once
#include "palpate/body/body.h"

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

namespace palpate::cpu {

/// Nodes that lie one after the other in memory, and whose neighbours along each link do so too.
struct Run {
    int first;  // slot
    int count;  // of slots, a multiple of the lanes
};

/// Runs that lie one after the other: a few hundred slots that stay in the first cache together. What threads
/// share, and what is asked as a whole whether a tool or an obstacle is near.
struct Block {
    static constexpr int most = 256;  // slots
    int first_run, end_run;
    int first_slot, end_slot;
};

/// Where the nodes of a body lie: each has a slot of its own, and along a row of the grid slots follow each
/// other. What a run may read beside its own slots exists, but means nothing.
struct Layout {
    std::vector<int> slot;  // of each node
    std::vector<Run> runs;  // at most 256 slots each
    std::vector<Block> blocks;
    /// Of each run and each link: from a slot to that of its neighbour. In tissue ten more follow: from the
    /// lowest corner of a cell to the others, 1 to 7; and from a node to those before it in the rows beside,
    /// 1 to 3, whose cells hold it too.
    std::vector<int> offsets;
    /// The axis of the grid along which rows run. Corners of cells are counted from it on: of corner k, along
    /// the rows in the lowest bit, then along the next axis, x after z, then along the third.
    int row_axis = 0;
    int slots = 0;
    int margin = 0;  // slots before the first and behind the last that a run may read

    /// A body in a grid, for registers of so many floats. A box without a hole is one long row: all its nodes
    /// have their neighbours at the same distance. Of other shapes the rows along that axis are kept that
    /// fill their registers best, each cut where a register or more would be empty: memory goes with the
    /// nodes, not the box.
    Layout(const Body& body, int lanes);

    /// A body whose springs are written out: its nodes in that order.
    Layout(std::span<const int> order, int lanes);

    /// Corner k of a cell, as the grid counts its axes.
    ivec3 corner(int k) const;

 private:
    void make_blocks();
};

/// Zeros at first.
template <class T>
class Array {
 public:
    Array() = default;
    /// One T for each slot. `number`: of the array. Each begins at another place of a page, else reading one
    /// waits for writing another.
    Array(const Layout& layout, int number)
        : Array(std::size_t(layout.slots + layout.margin), number, std::size_t(layout.margin)) {}
    /// So many, and room before the first.
    Array(std::size_t size, int number, std::size_t room = 0) {
        const std::size_t before = room + std::size_t(number * 5 % 61) * line, count = before + line + size;
        bytes_ = (count * sizeof(T) + page - 1) / page * page;
        memory_.reset(static_cast<T*>(std::aligned_alloc(page, bytes_)));
        if (!memory_) throw std::bad_alloc();
        std::memset(static_cast<void*>(memory_.get()), 0, bytes_);
        first_ = memory_.get() + (before + line - 1) / line * line;
    }
    T* data() const { return first_; }
    std::size_t bytes() const { return bytes_; }

 private:
    static constexpr std::size_t page = 4096, line = 64 / sizeof(T);
    struct Free {
        void operator()(T* p) const { std::free(p); }
    };
    std::unique_ptr<T, Free> memory_;
    T* first_ = nullptr;
    std::size_t bytes_ = 0;
};

}  // namespace palpate::cpu
