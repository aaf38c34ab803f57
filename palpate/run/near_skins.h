#pragma once
#include "palpate/body/embedding.h"
#include "palpate/run/tip.h"

#include <vector>

namespace palpate {

class Play;
struct Models;

/// The parts of a play's skins near a place, which take less time to map and to look through than all
/// of them. They are chosen anew only when others may have come near.
class NearSkins {
 public:
    /// All triangles within `reach` of `centre`, and some that are farther away; one skin for each of the
    /// play's, without normals. Valid until the next call. A vertex is taken to move no farther than the node
    /// that moves farthest, and 15 mm are to spare.
    const std::vector<Skin>& at(const Play& play, const Models& models, vec3 centre, float reach);
    /// To be called before at() is called with another play or other models.
    void forget() { parts_.clear(); }

    /// Whether the last call chose anew; and where those vertices were at the call before.
    bool chose() const { return chose_; }
    const std::vector<std::vector<vec3>>& before() const { return before_; }

 private:
    struct Part {
        std::vector<uvec3> triangles;  // of its own vertices
        std::vector<int> numbers;      // of those triangles, in the whole skin
        Embedding embedding;           // of a body
    };
    bool suffice(const Play& play, vec3 centre, float reach) const;
    void choose(const Play& play, const Models& models, vec3 centre, float reach);

    std::vector<Part> parts_;
    std::vector<Skin> skins_;
    vec3 centre_ = vec3(0);
    float reach_ = 0;                              // m
    std::vector<std::vector<vec3>> chosen_nodes_;  // of each body, when the parts were chosen,
    std::vector<std::vector<vec3>> last_nodes_;    // and at the last call
    std::vector<std::vector<vec3>> before_;
    bool chose_ = false;
};

}  // namespace palpate
