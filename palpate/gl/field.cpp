#include "palpate/gl/field.h"

#include "palpate/base/error.h"
#include "palpate/gl/context.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace palpate::gl {
namespace {

// The layout of a format in the host's memory.
struct Layout {
    GLenum format, type;
};
Layout layout(GLenum format) {
    switch (format) {
        case GL_RGBA32UI:
            return {GL_RGBA_INTEGER, GL_UNSIGNED_INT};
        case GL_R32I:
            return {GL_RED_INTEGER, GL_INT};
        case GL_R32F:
            return {GL_RED, GL_FLOAT};
        default:
            if (format == GL_RGBA32F) return {GL_RGBA, GL_FLOAT};
            throw Error("an unsupported format", "a field", "use RGBA32F, R32F, RGBA32UI or R32I");
    }
}

std::size_t most(GLenum what) {
    GLint64 value = 0;
    glGetInteger64v(what, &value);
    return std::size_t(value);
}

void require_room(std::size_t slots, std::size_t room) {
    if (slots > room)
        throw Error(fmt::format("{} values in one field, but the driver allows {} at most", slots, room),
                    "OpenGL", "use fewer nodes, or the backend cpu");
}

}  // namespace

Field::Field(GLenum format, std::size_t bytes, std::size_t slots, int width, Bytes values)
    : format_(format), bytes_(bytes), slots_(std::max<std::size_t>(slots, 1)) {
    if (width > 0) {
        const std::size_t rows = (slots_ + std::size_t(width) - 1) / std::size_t(width);
        require_room(slots_, std::size_t(width) * most(GL_MAX_TEXTURE_SIZE));
        flat_.emplace(format, width, int(rows));
        glClearTexImage(flat_->name(), 0, layout(format).format, layout(format).type, nullptr);
    } else {
        require_room(slots_, most(GL_MAX_TEXTURE_BUFFER_SIZE));
        buffer_ = Buffer::room(bytes_ * slots_);
        GLuint name = 0;
        glCreateTextures(GL_TEXTURE_BUFFER, 1, &name);
        view_ = Handle<TextureKind>(name);
        glTextureBuffer(name, format, buffer_->name());
    }
    put(values);
}

void Field::check_fits(std::size_t bytes_at_hand) const {
    if (bytes_at_hand > bytes())
        throw Error(fmt::format("{} bytes, but there is room for only {}", bytes_at_hand, bytes()), "a field",
                    "put in no more values than it has slots");
}

void Field::put(Bytes values) {
    check_fits(values.size());
    if (values.empty()) return;
    if (buffer_) return glNamedBufferSubData(buffer_->name(), 0, GLsizeiptr(values.size()), values.data());
    const auto width = std::size_t(flat_->width()), given = values.size() / bytes_, rows = given / width;
    const auto [format, type] = layout(format_);
    if (rows > 0)
        glTextureSubImage2D(flat_->name(), 0, 0, 0, int(width), int(rows), format, type, values.data());
    if (const auto rest = given - rows * width; rest > 0)
        glTextureSubImage2D(flat_->name(), 0, 0, int(rows), int(rest), 1, format, type,
                            values.data() + rows * width * bytes_);
}

void Field::copy(const Field& from) {
    if (from.slots_ != slots_ || from.width() != width() || from.format_ != format_)
        throw Error("a copy of a field of another format or size", "a field", "make both alike");
    if (buffer_) return glCopyNamedBufferSubData(from.buffer(), buffer(), 0, 0, GLsizeiptr(bytes()));
    glCopyImageSubData(from.texture(), GL_TEXTURE_2D, 0, 0, 0, 0, texture(), GL_TEXTURE_2D, 0, 0, 0, 0,
                       flat_->width(), flat_->height(), 1);
}

void Field::get(const Context& context, std::span<std::byte> to) const {
    check_fits(to.size());
    if (buffer_) return context.read(buffer_->name(), to);
    std::vector<std::byte> all(bytes_ * std::size_t(flat_->width()) * std::size_t(flat_->height()));
    context.read_texture(flat_->name(), layout(format_).format, layout(format_).type, all);
    std::copy_n(all.begin(), to.size(), to.begin());
}

}  // namespace palpate::gl
