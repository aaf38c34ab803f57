#pragma once
#include "palpate/solver/cpu/ties.h"

#include <optional>
#include <utility>
#include <vector>

namespace palpate::cpu {

/// A body laid out for the kernels: it owns the memory that a Laid points to.
class LaidBody {
 public:
    LaidBody(const Body& body, const Simulation& simulation, int lanes);
    LaidBody(const LaidBody&) = delete;
    LaidBody& operator=(const LaidBody&) = delete;

    const Layout& layout() const { return layout_; }
    const Laid& view() const { return view_; }
    /// One float a slot, for whoever needs more of them.
    Array<float> array() { return Array<float>(layout_, arrays_++); }
    /// Gives a state what neighbours look at, if they are looked up one by one.
    void let_neighbours_see(Fields& state);
    std::size_t bytes() const { return bytes_; }

 private:
    LaidBody(const Body& body, const Simulation& simulation, int lanes,
             const std::pair<Springs, std::vector<vec3>>& springs);
    void lay_grid(const Body& body);
    void bound_blocks(const Body& body);
    const float* spread(const std::vector<float>& of_nodes);
    float* keep();

    Layout layout_;
    int arrays_ = 0;
    std::size_t bytes_ = 0;
    std::vector<Array<float>> floats_;
    std::vector<Array<std::uint32_t>> words_;
    std::optional<LaidTies> ties_;
    bool damped_;                        // along its springs: neighbours look at velocities too
    std::vector<Bounds> rest_bounds_;    // of blocks
    std::vector<float> furthest_cover_;  // of blocks
    std::vector<vec3> corners_;
    std::vector<const DistanceField*> fields_;
    Laid view_{};
};

}  // namespace palpate::cpu
