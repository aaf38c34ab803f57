#pragma once
#include "palpate/solver/cpu/hinges.h"
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

    /// Lays these nodes' numbers anew. False, and nothing has changed, where their springs want another
    /// kernel.
    bool change(const Body& body, std::span<const int> nodes);

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
    void lay_shares(const Body& body, std::size_t node);
    void bound_blocks(const Body& body);
    float* spread(const std::vector<float>& of_nodes);
    float* keep();

    Layout layout_;
    int arrays_ = 0;
    std::size_t bytes_ = 0;
    std::vector<Array<float>> floats_;
    std::vector<Array<std::uint32_t>> words_;
    std::optional<LaidTies> ties_;
    std::optional<LaidHinges> hinges_;
    bool damped_;                        // along its springs: neighbours look at velocities too
    std::vector<Bounds> rest_bounds_;    // of blocks
    std::vector<float> furthest_cover_;  // of blocks
    std::vector<vec3> corners_;
    std::vector<const DistanceField*> fields_;
    float *inverse_mass_ = nullptr, *area_ = nullptr, *cover_ = nullptr;  // of slots, as in
    Laid view_{};
};

}  // namespace palpate::cpu
