#pragma once
// What a scene must be to make sense, beyond what its file's grammar says.
#include "palpate/scene/scene.h"

#include <string>

namespace palpate {

/// The text that a scene is read from, a file or what a change says: names it in messages.
struct SceneSource {
    std::string file;

    /// Throws Error. A line of 0: nobody knows.
    [[noreturn]] void fail(int line, const std::string& what, const std::string& remedy) const;
};

/// Gives names to what has none, lengths of 1 to normals, and throws Error where something does not fit.
void check(Scene& scene, const SceneSource& source);

}  // namespace palpate
