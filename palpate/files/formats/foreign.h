#pragma once
#include <string>
#include <string_view>

namespace palpate {

/// Throws Error if a file's first bytes (500 are enough) show that it is neither a mesh nor a volume,
/// whatever its name: a web page that was downloaded in its place, a Git LFS pointer, an archive.
void refuse_foreign(std::string_view bytes, const std::string& name);

}  // namespace palpate
