#pragma once
#include "palpate/base/error.h"
#include "palpate/scene/scene.h"

#include <fmt/format.h>

#include <string>

namespace palpate {

/// Reads a file of a scene: an error says in addition where and under which key the scene names it.
template <class Read>
auto reading(const Scene& scene, const std::string& whose, const Lines& lines, const std::string& key,
             Read read) {
    try {
        return read();
    } catch (const Error& error) {
        throw Error(fmt::format("{}, {} of {}: {}", lines.where(key, scene.file), key, whose, error.what()));
    }
}

}  // namespace palpate
