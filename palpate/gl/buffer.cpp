#include "palpate/gl/buffer.h"

#include <algorithm>
#include <cassert>

namespace palpate::gl {

Buffer::Buffer(Bytes bytes) : fixed_(true) {
    // A store of no bytes is an error to GL; an empty mesh is none to us.
    const auto room = static_cast<GLsizeiptr>(std::max<std::size_t>(bytes.size(), 1));
    glNamedBufferStorage(name(), room, bytes.empty() ? nullptr : bytes.data(), 0);
}

void Buffer::upload(Bytes bytes) {
    assert(!fixed_);
    glNamedBufferData(name(), static_cast<GLsizeiptr>(bytes.size()), bytes.data(), GL_STREAM_DRAW);
}

}  // namespace palpate::gl
