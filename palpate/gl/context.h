#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace palpate::gl {

/// How much a context can take at once.
struct Limits {
    long buffer_texels = 0;           // of a texture that is a buffer
    long storage_bytes = 0;           // of a storage buffer
    int vertex_storage_buffers = 0;   // that a vertex shader sees
    int compute_storage_buffers = 0;  // that a compute shader sees
    int vertex_textures = 0;          // that a vertex shader sees
    int fragment_textures = 0;        // that a fragment shader sees
    int compute_textures = 0;         // that a compute shader sees
    int captured_buffers = 0;         // that transform feedback fills
    int float_targets = 0;            // RGBA32F, that a fragment shader draws into; 0: it cannot
    int texture_side = 0;             // texels of a flat texture
    int group = 0;                    // invocations of a compute shader that work together
    int shared_bytes = 0;             // of the memory that they share
};

/// An OpenGL 4.5 core context without a window, on the first graphics card that offers one, else on Mesa's
/// software driver. A framebuffer of one pixel is bound from the start, because drawing fails where none is.
/// Move-only.
class Context {
 public:
    /// Becomes current on this thread. Throws Error that says which part is missing and what to install, or
    /// which version there is where it is too old.
    Context();

    /// The context of another program, or of a window: the one that is current on this thread, of EGL, GLX or
    /// whatever else. It stays its owner's, who also makes it current before anything here is called. Throws
    /// Error if there is none, or if it is older than 4.5 core.
    static Context adopt();

    ~Context();
    Context(Context&&) noexcept;
    Context& operator=(Context&&) noexcept;

    /// GL calls of this thread go here from now on. Throws Error if the graphics card has dropped the
    /// context: then all that it held is lost.
    void make_current() const;
    /// The same for destructors: what is lost cannot be given back.
    void make_current_or_not() const noexcept;

    /// Copies a buffer's first bytes, or a whole texture of such values, to the host, which waits for the
    /// GPU. The only way to do so, and therefore counted.
    void read(unsigned buffer, std::span<std::byte> to) const;
    void read_texture(unsigned texture, unsigned format, unsigned type, std::span<std::byte> to) const;

    /// Waits until the GPU has done all that it was told.
    void finish() const;

    /// How often the host has read from it.
    long reads() const;

    const std::string& renderer() const;  // "llvmpipe (LLVM 15.0.6, 256 bits)"
    const std::string& version() const;   // "4.5 (Core Profile) Mesa 22.3.6"
    const std::string& vendor() const;    // "Mesa/X.org"
    const std::string& egl() const;       // "1.5, Mesa Project"; empty for one that was adopted

    /// Whether it computes on the CPU: it draws the same, slower.
    bool software() const;

    /// Makes it current first.
    Limits limits() const;

    /// How many GL calls the driver has refused so far, and what it said of the first; 0 and empty in a sound
    /// program.
    int errors() const;
    const std::string& first_error() const;

 private:
    struct Parts;
    explicit Context(std::unique_ptr<Parts> parts);
    std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::gl
