#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace palpate::gl {

/// The limits of a context.
struct Limits {
    long buffer_texels = 0;           // of a buffer texture
    long storage_bytes = 0;           // of a shader storage buffer
    int vertex_storage_buffers = 0;   // that a vertex shader sees
    int compute_storage_buffers = 0;  // that a compute shader sees
    int vertex_textures = 0;          // that a vertex shader sees
    int fragment_textures = 0;        // that a fragment shader sees
    int compute_textures = 0;         // that a compute shader sees
    int captured_buffers = 0;         // that transform feedback fills
    int float_targets = 0;            // RGBA32F colour attachments; 0: they cannot be drawn into
    int texture_side = 0;             // texels along a side of a 2D texture
    int group = 0;                    // invocations of a compute work group
    int shared_bytes = 0;             // of shared memory of a work group
};

/// An OpenGL 4.5 core context without a window, on the first graphics card that offers one, else on Mesa's
/// software driver. A framebuffer of one pixel is bound at the start, because drawing fails without one.
/// Move-only.
class Context {
 public:
    /// Becomes current on this thread. Throws an Error that says which library is missing and what to
    /// install, or which version the driver has if that is too old.
    Context();

    /// Adopts the context that is current on this thread, of another program or of a window, by EGL, GLX or
    /// another system. Its owner keeps it, and must make it current before calling anything here. Throws
    /// Error if there is none, or if it is older than 4.5 core.
    static Context adopt();

    ~Context();
    Context(Context&&) noexcept;
    Context& operator=(Context&&) noexcept;

    /// Makes it current on this thread. Throws Error if the graphics card has lost the context: then
    /// everything in it is lost.
    void make_current() const;
    /// The same for destructors: does not throw.
    void make_current_or_not() const noexcept;

    /// Reads back a buffer's first bytes, or a whole texture, and waits for the GPU. It is the only way to do
    /// so, so read-backs can be counted.
    void read(unsigned buffer, std::span<std::byte> to) const;
    void read_texture(unsigned texture, unsigned format, unsigned type, std::span<std::byte> to) const;

    /// Waits until the GPU has finished all work.
    void finish() const;

    /// The number of read-backs.
    long reads() const;

    const std::string& renderer() const;  // "llvmpipe (LLVM 15.0.6, 256 bits)"
    const std::string& version() const;   // "4.5 (Core Profile) Mesa 22.3.6"
    const std::string& vendor() const;    // "Mesa/X.org"
    const std::string& egl() const;       // "1.5, Mesa Project"; empty if it was adopted

    /// Whether it is a software driver, on the CPU: it draws the same, but more slowly.
    bool software() const;

    /// Makes it current first.
    Limits limits() const;

    /// The number of OpenGL errors so far, and the message of the first; 0 and empty in a correct program.
    int errors() const;
    const std::string& first_error() const;

 private:
    struct Parts;
    explicit Context(std::unique_ptr<Parts> parts);
    std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::gl
