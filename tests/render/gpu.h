#pragma once
#include "palpate/gl/buffer.h"
#include "palpate/gl/texture.h"
#include "palpate/render/gpu_embedding.h"
#include "palpate/render/view.h"

#include <cmath>
#include <vector>

// Nodes in the memory of a GPU, for tests.

namespace palpate {

inline std::vector<vec4> in_fours(const std::vector<vec3>& vectors) {
    std::vector<vec4> list;
    for (vec3 v : vectors) list.emplace_back(v, std::nanf(""));  // whatever: nobody may look at it
    return list;
}

struct NodeBuffers {
    gl::Buffer positions, normals;
    GpuNodes nodes;

    NodeBuffers(const std::vector<vec3>& at, const std::vector<vec3>& facing)
        : positions(in_fours(at)),
          normals(in_fours(facing)),
          nodes{positions.name(), normals.name(), 0, at.size(), bounds_of(at)} {}
};

struct NodeTextures {
    int width;
    gl::Texture positions, normals;
    GpuNodes nodes;

    NodeTextures(const std::vector<vec3>& at, const std::vector<vec3>& facing, int texels)
        : width(texels),
          positions(flat(at)),
          normals(flat(facing)),
          nodes{positions.name(), normals.name(), width, at.size(), bounds_of(at)} {}

 private:
    gl::Texture flat(const std::vector<vec3>& vectors) const {
        std::vector<vec4> list = in_fours(vectors);
        const int rows = (int(list.size()) + width - 1) / width;
        list.resize(std::size_t(rows) * std::size_t(width));
        gl::Texture texture(GL_RGBA32F, width, rows);
        glTextureSubImage2D(texture.name(), 0, 0, 0, width, rows, GL_RGBA, GL_FLOAT, list.data());
        return texture;
    }
};

}  // namespace palpate
