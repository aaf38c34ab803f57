#pragma once
#include "palpate/solver/cpu/hinges.h"
#include "palpate/solver/cpu/ties.h"

#include <optional>
#include <utility>
#include <vector>

namespace palpate::cpu {

/// A body in the order in which the kernels read it: owns the memory that a BodyView points to.
class BodyMemory {
 public:
    BodyMemory(const Body& body, const Simulation& simulation, int lanes);
    BodyMemory(const BodyMemory&) = delete;
    BodyMemory& operator=(const BodyMemory&) = delete;

    /// Rewrites what these nodes have. False, and nothing has changed, where their springs need another
    /// kernel.
    bool change(const Body& body, std::span<const int> nodes);

    const Layout& layout() const { return layout_; }
    const BodyView& view() const { return view_; }
    /// One float a slot, for other arrays of the same kind.
    Array<float> array() { return Array<float>(layout_, arrays_++); }
    /// Adds to a state the arrays from which neighbours are looked up one by one, where the kernel does so.
    void add_neighbour_arrays(Fields& state);
    std::size_t bytes() const { return bytes_; }

 private:
    BodyMemory(const Body& body, const Simulation& simulation, int lanes,
               const std::pair<Springs, std::vector<vec3>>& springs);
    void write_grid(const Body& body);
    void write_shares(const Body& body, std::size_t node);
    void write_cells(const Body& body, const OwnCells& cells, std::size_t node);
    void bound_blocks(const Body& body);
    float* spread(const std::vector<float>& of_nodes, float elsewhere = 0);
    float* keep();

    Layout layout_;
    int arrays_ = 0;
    std::size_t bytes_ = 0;
    std::vector<Array<float>> floats_;
    std::vector<Array<std::uint32_t>> words_;
    std::optional<TieMemory> ties_;
    std::optional<HingeMemory> hinges_;
    bool damped_;                        // along its springs: neighbours look at velocities too
    std::vector<Bounds> rest_bounds_;    // of blocks
    std::vector<float> furthest_cover_;  // of blocks
    std::vector<vec3> corners_;
    std::vector<const DistanceField*> fields_;
    float *inverse_mass_ = nullptr, *area_ = nullptr, *cover_ = nullptr,
          *cell_weights_ = nullptr;  // of slots, as in
    BodyView view_{};
};

}  // namespace palpate::cpu
