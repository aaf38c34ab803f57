#pragma once
#include "palpate/base/progress.h"
#include "palpate/body/body.h"
#include "palpate/mesh/image.h"
#include "palpate/scene/scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace palpate {

/// A body with the surface that is drawn, and the embedding of the surface in the body.
struct Model {
    Body body;
    Mesh surface;  // with texture coordinates if its recipe has maps, and with tangents if one is a normal
                   // map
    Embedding embedding;
    Image colour_map, normal_map;         // of the recipe, or empty
    std::vector<std::string> steps = {};  // the steps that made its surface, one line each
};

/// A surface that does not move.
struct StaticSurface {
    std::string name;
    Mesh surface;
    std::vector<std::string> steps = {};  // the steps that made it
};

/// The nodes of a prescribed motion.
struct MovedNodes {
    std::size_t body = 0;    // its index
    std::vector<int> nodes;  // in increasing order
    vec3 about = vec3(0);    // m, the centre of their rotation
};

/// What is built from a scene's recipes, in their order.
struct Models {
    std::vector<Model> models;
    std::vector<StaticSurface> static_surfaces;
    Simulation simulation;     // that of the scene, with its colliders and the stiffness of its tools
    std::vector<vec3> pivots;  // m: a moving collider is given relative to this point; one that stands,
                               // relative to 0
    std::vector<MovedNodes> moves;
    std::vector<std::string> notes;  // warnings: a count that was not met, a size that looks wrong
};

/// All files of a scene: its own, if it has one, those of its paths, and those that build() will read. Throws
/// Error if one is missing.
std::vector<std::filesystem::path> find_files(const Scene& scene);

/// Reads the files, makes surfaces, bodies, embeddings and colliders, and pins. Throws Error.
Models build(const Scene& scene, const Progress& progress = {});

/// The same for a scene that was changed after `made` was built from `before`: what the change does not
/// affect is taken over, so a new stiffness does not require reading files and repairing surfaces again.
Models rebuild(const Scene& scene, const Scene& before, const Models& made, const Progress& progress = {});

}  // namespace palpate
