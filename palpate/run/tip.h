#pragma once
#include "palpate/body/influences.h"
#include "palpate/scene/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace palpate {

/// A surface in its present position.
struct Skin {
    std::vector<vec3> positions, normals;
    const std::vector<uvec3>* triangles;  // of the surface at rest
    bool is_sheet = false;                // it encloses no volume, and is felt from both sides
    std::span<const int> numbers = {};    // of the triangles, where they are part of a larger surface
};

/// The indentation of surfaces under a round tip, m: how far, at most, a vertex within 1.2 radii of the tip's
/// centre is behind its untouched place, along its untouched normal.
double indentation(const std::vector<Skin>& untouched, const std::vector<Skin>& now, vec3 centre,
                   float radius);

/// A tool's tip on a scripted path.
class Tip {
 public:
    /// `file`: of the scene, for messages.
    Tip(const ToolRecipe& recipe, const std::string& file) : recipe_(recipe), file_(file) {}

    /// Whether it is present at a time.
    bool is_there(double time) const { return within(recipe_.path, time); }

    /// The press for the frame from `time` on, when it must be present. At the path's first time the tip is
    /// placed at the surface that it shall touch, and the surfaces are stored as untouched.
    Press press(double time, double frame, const std::vector<Skin>& skins);

    /// How deep it presses with its centre there, m.
    double indentation(vec3 centre, const std::vector<Skin>& skins) const {
        return palpate::indentation(untouched_, skins, centre, recipe_.radius);
    }

    /// The skins now belong to other meshes with the same vertices.
    void lies_over(const std::vector<Skin>& skins) {
        for (std::size_t s = 0; s < untouched_.size(); ++s) untouched_[s].triangles = skins[s].triangles;
    }

    /// The tip's centre at a time within its path, m.
    vec3 centre(double time) const { return origin_ + position(recipe_.path, time); }

 private:
    ToolRecipe recipe_;
    std::string file_;
    vec3 origin_ = vec3(0);  // of the path
    std::vector<Skin> untouched_;
};

/// Where the tool's tip first touches a surface when it is moved from `from` in the direction `along`, m.
/// Throws Error if it never does, or touches one at the start; `file` is the scene's, for the message.
vec3 brought_to_touch(const ToolRecipe& recipe, const std::string& file, const std::vector<Skin>& skins);

/// How far a ball can move from `from` along the unit vector `along` until it touches a surface; nothing if
/// it never does, or touches one at the start.
std::optional<float> way_to_touch(vec3 from, vec3 along, float radius, const std::vector<Skin>& skins);

}  // namespace palpate
