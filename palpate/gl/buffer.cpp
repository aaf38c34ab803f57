#include "palpate/gl/buffer.h"

#include "palpate/base/error.h"

#include <algorithm>

namespace palpate::gl {

Buffer::Buffer(Bytes bytes) : fixed_(true) {
    // OpenGL refuses an empty store, but a mesh may be empty.
    const auto room = static_cast<GLsizeiptr>(std::max<std::size_t>(bytes.size(), 1));
    glNamedBufferStorage(name(), room, bytes.empty() ? nullptr : bytes.data(), 0);
}

Buffer Buffer::room(std::size_t bytes) {
    Buffer made;
    made.fixed_ = true;
    glNamedBufferStorage(made.name(), static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 16)), nullptr,
                         GL_DYNAMIC_STORAGE_BIT);
    glClearNamedBufferData(made.name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
    return made;
}

void Buffer::upload(Bytes bytes) {
    if (fixed_)
        throw Error("an upload", "a buffer whose size is fixed", "put values into it, or make another");
    glNamedBufferData(name(), static_cast<GLsizeiptr>(bytes.size()), bytes.data(), GL_STREAM_DRAW);
}

}  // namespace palpate::gl
