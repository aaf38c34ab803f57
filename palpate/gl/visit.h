#pragma once
#include <memory>

namespace palpate::gl {

/// A visit in a context in which others draw too: an application, or a window's controls. It begins with
/// OpenGL's own defaults for all that decides how triangles become pixels and how pixels are copied, whatever
/// the others have set; at its end they find everything as they left it. Everything here that draws, computes
/// or uploads does so during one.
///
/// Two things no visit can put aside: it must not begin between glBeginTransformFeedback and its end, nor
/// during conditional rendering.
class Visit {
 public:
    /// How many texture units and bindings of storage buffers are kept, from 0 on: as many as are used here.
    static constexpr unsigned units = 18, buffers = 8;

    Visit();
    ~Visit();
    Visit(const Visit&) = delete;
    Visit& operator=(const Visit&) = delete;

 private:
    struct Kept;
    std::unique_ptr<Kept> kept_;
};

}  // namespace palpate::gl
