#pragma once
#include <string>
#include <string_view>

namespace palpate {

/// Throws Error where a file's first bytes (500 are enough) show that it is neither a mesh nor a volume,
/// whatever its name says: a web page that was downloaded in its place, a pointer of Git LFS, an archive.
void refuse_strangers(std::string_view bytes, const std::string& name);

}  // namespace palpate
