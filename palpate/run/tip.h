#pragma once
#include "palpate/body/influences.h"
#include "palpate/scene/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace palpate {

/// A surface as it lies at the moment.
struct Skin {
    std::vector<vec3> positions, normals;
    const std::vector<uvec3>* triangles;  // of the surface at rest
    bool is_sheet = false;                // it encloses nothing, and is felt from both sides
};

/// A tool's tip on its way along a scripted path.
class Tip {
 public:
    /// `file`: of the scene, for messages.
    Tip(const ToolRecipe& recipe, const std::string& file) : recipe_(recipe), file_(file) {}

    /// Whether it is there at a time, and not yet or no longer away.
    bool is_there(double time) const { return within(recipe_.path, time); }

    /// The press for the frame from `time` on, at which it is there. At the path's first time the
    /// tip is brought to the surface it shall touch, and the surfaces are remembered as untouched.
    Press press(double time, double frame, const std::vector<Skin>& skins);

    /// How far a surface under the tip is pushed in, m: the furthest that a vertex within 1.2 radii of the
    /// tip's centre lies behind its untouched place, measured along the untouched normal.
    double indentation(vec3 centre, const std::vector<Skin>& skins) const;

    /// The skins are those of other meshes now, vertex by vertex the same.
    void lies_over(const std::vector<Skin>& skins) {
        for (std::size_t s = 0; s < untouched_.size(); ++s) untouched_[s].triangles = skins[s].triangles;
    }

    /// Where the tip's centre is at a time within its path, m.
    vec3 centre(double time) const { return origin_ + position(recipe_.path, time); }

 private:
    ToolRecipe recipe_;
    std::string file_;
    vec3 origin_ = vec3(0);  // of the path
    std::vector<Skin> untouched_;
};

/// Where the tool's tip, moved from its `from` along its `along`, first touches a surface, m. Throws Error if
/// it never does, or touches one where it starts; `file` is the scene's, for the message.
vec3 brought_to_touch(const ToolRecipe& recipe, const std::string& file, const std::vector<Skin>& skins);

/// How far a ball can go from `from` along the unit vector `along` before it touches a surface; nothing if it
/// never does, or touches one where it starts.
std::optional<float> way_to_touch(vec3 from, vec3 along, float radius, const std::vector<Skin>& skins);

}  // namespace palpate
