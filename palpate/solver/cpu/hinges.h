#pragma once
#include "palpate/solver/cpu/kernel.h"

#include <array>
#include <vector>

namespace palpate::cpu {

/// The hinges of a body as kernels read them: it owns the memory that a Hinges points to.
class HingeMemory {
 public:
    HingeMemory(const Body& body, const Layout& layout, int lanes);

    Hinges view() const { return {slices_.data(), records_.data()}; }
    std::size_t bytes() const { return records_.bytes() + slices_.size() * sizeof(Slice); }

 private:
    static constexpr std::size_t numbers = 16;  // a record, for each node

    // The last numbers of one of a slot's hinges, and any of them.
    void write(std::size_t hinge, std::size_t slot, const std::array<float, 4>& last);
    std::uint32_t& number(std::size_t hinge, std::size_t slot, std::size_t k);

    std::size_t lanes_;
    std::vector<Slice> slices_;
    Array<std::uint32_t> records_;
};

}  // namespace palpate::cpu
