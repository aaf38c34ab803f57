#pragma once
#include "palpate/base/progress.h"
#include "palpate/body/body.h"
#include "palpate/scene/scene.h"

#include <string>
#include <vector>

namespace palpate {

/// A body with the surface that people see, and how the one hangs on the other.
struct Model {
    Body body;
    Mesh surface;
    Embedding embedding;
};

/// What a scene's recipes make, in the recipes' order.
struct Models {
    std::vector<Model> models;
    std::vector<std::string>
        notes;  // what the user should know: a count that was not met, a size that looks wrong
};

/// Reads the files, makes surfaces, lattices and embeddings, and pins. Throws Error.
Models build(const Scene& scene, const Progress& progress = {});

/// A surface, and what was done to get it, a line each with its counts.
struct CleanSurface {
    Mesh mesh;
    std::vector<std::string> steps;
};

/// The surface of one recipe: read, cleaned, placed. Not for a plain box, whose surface comes from its
/// lattice.
CleanSurface make_surface(const BodyRecipe& recipe, const std::filesystem::path& folder,
                          const Progress& progress = {});

/// What looks wrong with a surface's size, or nothing: over 10 m or under 1 mm the unit is probably not what
/// was said.
std::string size_warning(const Mesh& surface);

}  // namespace palpate
