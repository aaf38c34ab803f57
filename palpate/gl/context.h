#pragma once
#include <memory>
#include <string>

namespace palpate::gl {

/// An OpenGL 4.5 core context without a window, on the first graphics card that offers one, else on Mesa's
/// software driver. A framebuffer of one pixel is bound from the start, because drawing fails where none is.
/// Move-only.
class Context {
 public:
    /// Becomes current on this thread. Throws Error that says which part is missing and what to install.
    Context();
    ~Context();
    Context(Context&&) noexcept;
    Context& operator=(Context&&) noexcept;

    /// GL calls of this thread go here from now on.
    void make_current() const;

    const std::string& renderer() const;  // "llvmpipe (LLVM 15.0.6, 256 bits)"
    const std::string& version() const;   // "4.5 (Core Profile) Mesa 22.3.6"

    /// How many GL calls the driver has refused so far, and what it said of the first; 0 and empty in a sound
    /// program.
    int errors() const;
    const std::string& first_error() const;

 private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::gl
