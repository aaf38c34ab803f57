#pragma once
#include "palpate/base/progress.h"
#include "palpate/body/body.h"
#include "palpate/mesh/image.h"
#include "palpate/scene/scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace palpate {

/// A body with the surface that people see, and how the one hangs on the other.
struct Model {
    Body body;
    Mesh surface;  // with texture coordinates where its recipe has maps, and tangents where one is of normals
    Embedding embedding;
    Image colour_map, normal_map;         // as the recipe wants them; else empty
    std::vector<std::string> steps = {};  // what was done to get its surface, a line each with its counts
};

/// A surface that nothing moves.
struct Still {
    std::string name;
    Mesh surface;
    std::vector<std::string> steps = {};  // what was done to get it
};

/// The nodes of a prescribed motion.
struct MovedNodes {
    std::size_t body = 0;    // its number
    std::vector<int> nodes;  // in rising order
    vec3 about = vec3(0);    // m, the point that their rotation leaves where it is
};

/// What a scene's recipes make, in the recipes' order.
struct Models {
    std::vector<Model> models;
    std::vector<Still> stills;
    Simulation simulation;     // the scene's, with its colliders and the strength of its tools
    std::vector<vec3> pivots;  // m: a collider that moves is given about this point; one that stands, about 0
    std::vector<MovedNodes> moves;
    std::vector<std::string>
        notes;  // what the user should know: a count that was not met, a size that looks wrong
};

/// All files that a scene is made of: its own, where it has one, those of its paths, and those that build()
/// will read. Throws Error if one is missing.
std::vector<std::filesystem::path> find_files(const Scene& scene);

/// Reads the files, makes surfaces, bodies, embeddings and colliders, and pins. Throws Error.
Models build(const Scene& scene, const Progress& progress = {});

/// The same for a scene that was changed since `made` was built of `before`: what the change does not touch
/// is taken over, so that no file is read and no surface mended again for another stiffness.
Models rebuild(const Scene& scene, const Scene& before, const Models& made, const Progress& progress = {});

}  // namespace palpate
