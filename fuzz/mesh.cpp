// Any bytes as a mesh of the format PALPATE_FORMAT: an Error, or a valid mesh.
#include "palpate/base/error.h"
#include "palpate/files/read.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace {

using namespace palpate;

void demand(bool truth) {
    if (!truth) std::abort();
}

template <int L>
void demand_finite(const std::vector<glm::vec<L, float>>& list) {
    for (const auto& v : list)
        for (int k = 0; k < L; ++k) demand(std::isfinite(v[k]));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    try {
        const Mesh mesh = parse_mesh(bytes, "fuzz" PALPATE_FORMAT, Units::millimetres);
        demand(!mesh.triangles.empty());
        demand(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
        demand_finite(mesh.positions);
        demand_finite(mesh.normals);
        demand(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
        demand_finite(mesh.uvs);
        for (uvec3 t : mesh.triangles)
            for (int k = 0; k < 3; ++k) demand(t[k] < mesh.positions.size());
    } catch (const Error& error) {
        demand(std::string_view(error.what()).find_first_of("\n\r") == std::string_view::npos);
    }
    return 0;
}
