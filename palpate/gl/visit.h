#pragma once
#include <memory>

namespace palpate::gl {

/// Saves the OpenGL state of a context in which others draw too (an application, or a window's controls),
/// sets OpenGL's defaults for everything that affects rasterisation and pixel transfer, and restores the
/// saved state at its end. All code here that draws, computes or uploads does so during a visit.
///
/// A visit must not begin during transform feedback or conditional rendering, which it cannot suspend.
class Visit {
 public:
    /// How many texture units and storage buffer bindings are saved, from 0 on: as many as are used here.
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
