#pragma once
#include "palpate/solver/cpu/kernel.h"

#include <limits>
#include <span>
#include <vector>

namespace palpate::cpu {

/// How many ties of a node a kernel has to go through.
struct TieCount {
    int fan = 0;     // the first so many go round it in a sheet, and keep their places
    int others = 0;  // that are there

    int all() const { return fan + others; }
};
/// `fan`: the body's, long enough for every node.
TieCount count_ties(std::span<const Tie> ties, int fan);

/// The nodes of a table as they had best lie: neighbours near one another, and among as many as a block
/// holds those with the most ties first, so that the nodes of a register have about as many.
std::vector<int> order_for(const Table& springs, std::size_t nodes, int fan);

/// The springs of a table as kernels read them: it owns the memory that a Ties points to.
class TieMemory {
 public:
    TieMemory(const Body& body, const Layout& layout, int lanes);

    Ties view() const { return {slices_.data(), pulling_.data(), whole_.data()}; }
    /// m, of all springs the least (whole_within() in kernel.h).
    float whole_within() const { return whole_within_; }
    std::size_t bytes() const { return pulling_.bytes() + whole_.bytes() + slices_.size() * sizeof(Slice); }

 private:
    static constexpr std::size_t pulling = 6, whole = 3;  // numbers a record, for each node

    // `at` counts the ties of single nodes: those of a register first, then their next ones, as in memory.
    void lead(std::size_t at, std::size_t slot);
    void write(std::size_t at, const Tie& tie, const Body& body, std::size_t node);

    std::size_t lanes_;
    float whole_within_ = std::numeric_limits<float>::max();
    std::vector<Slice> slices_;
    Array<std::byte> pulling_;
    Array<float> whole_;
};

}  // namespace palpate::cpu
