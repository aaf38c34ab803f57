#pragma once
// Consistency checks of a scene, beyond the grammar of its file.
#include "palpate/scene/scene.h"

#include <string>

namespace palpate {

/// The source of a scene's text, a file or a change, for messages.
struct SceneSource {
    std::string file;

    /// Throws Error. `line`: 0 if unknown.
    [[noreturn]] void fail(int line, const std::string& what, const std::string& remedy) const;
};

/// Names what has no name, normalises normals, and throws Error if something is inconsistent.
void check(Scene& scene, const SceneSource& source);

}  // namespace palpate
