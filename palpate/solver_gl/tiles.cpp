#include "palpate/solver_gl/tiles.h"

#include <fmt/format.h>

namespace palpate::gpu {
namespace {

int room(ivec3 wide) { return wide.x * wide.y * wide.z; }

std::string vector(ivec3 v) { return fmt::format("ivec3({}, {}, {})", v.x, v.y, v.z); }

}  // namespace

Tiles tiles(const Body& body, const Placement& placement) {
    Tiles tiles;
    tiles.size = placement.dims.z == 1 ? ivec3(16, 16, 1) : ivec3(8, 8, 4);
    for (const Link& link : body.grid()->links) tiles.reach = glm::max(tiles.reach, glm::abs(link.offset));
    tiles.groups = (placement.dims + tiles.size - 1) / tiles.size;
    return tiles;
}

std::string text(const Tiles& tiles, const Body& body, const Placement& placement) {
    const ivec3 wide = tiles.size + 2 * tiles.reach;
    std::string offsets;
    for (const Link& link : body.grid()->links)
        offsets += fmt::format("{}{}", offsets.empty() ? "" : ", ",
                               (link.offset.z * wide.y + link.offset.y) * wide.x + link.offset.x);
    return fmt::format(
        "#define TILE\n#define TILE_X {}\n#define TILE_Y {}\n#define TILE_Z {}\n#define TILE_ROOM {}\n"
        "#define TILE_REACH {}\n#define GRID {}\n#define FIRST {}\nconst int tile_offset[LINKS] = "
        "int[LINKS]({});\n",
        tiles.size.x, tiles.size.y, tiles.size.z, room(wide), vector(tiles.reach), vector(placement.dims),
        placement.first, offsets);
}

}  // namespace palpate::gpu
