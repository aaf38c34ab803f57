#pragma once
#include "palpate/files/formats/source.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace palpate {

/// A mesh compressed by Draco, and which of its attributes are wanted.
struct DracoPacked {
    std::string_view bytes;
    std::vector<std::uint32_t> attributes;  // their ids
};

struct DracoMesh {
    std::vector<double> corners;  // of triangles
    std::vector<std::vector<double>>
        attributes;  // all numbers of each, in the order of DracoPacked::attributes
};

/// Decompresses them all, in one process of its own, to at most `most` bytes in total. Throws Error for the
/// file `source`.
std::vector<DracoMesh> unpack_draco(const std::vector<DracoPacked>& packed, const Source& source,
                                    std::size_t most);

}  // namespace palpate
