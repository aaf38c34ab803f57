#pragma once
#include "palpate/files/formats/source.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace palpate {

/// A mesh that Draco packed, and which of its attributes are wanted.
struct DracoPacked {
    std::string_view bytes;
    std::vector<std::uint32_t> attributes;  // their ids
};

struct DracoMesh {
    std::vector<double> corners;  // of triangles
    std::vector<std::vector<double>>
        attributes;  // all numbers of each, in the order in which they were asked for
};

/// Unpacks them all, in one process of its own, to no more than `most` bytes in all. Throws Error, for the
/// file that is `source`.
std::vector<DracoMesh> unpack_draco(const std::vector<DracoPacked>& packed, const Source& source,
                                    std::size_t most);

}  // namespace palpate
