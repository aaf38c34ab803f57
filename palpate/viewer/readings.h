#pragma once
#include "palpate/run/experiment.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace palpate {

/// The last few seconds of a quantity that is measured once a picture: a ring buffer.
class Recent {
 public:
    static constexpr std::size_t length = 180;
    void add(float value) {
        values_[next_] = value;
        next_ = (next_ + 1) % length;
        count_ = std::min(count_ + 1, length);
    }
    std::size_t count() const { return count_; }
    float at(std::size_t i) const {
        return values_[(next_ + length - count_ + i) % length];
    }  // the oldest: 0
    float mean() const;
    float most() const;

 private:
    std::array<float, length> values_ = {};
    std::size_t next_ = 0, count_ = 0;
};

/// The measurements of an experiment, from picture to picture.
class Readings {
 public:
    Recent simulate, map, draw;    // ms a picture
    Recent pace;                   // simulated s per s
    std::optional<Energy> energy;  // none if it would have to be read back from the GPU
    double largest_speed = 0;      // m/s
    std::size_t memory = 0;        // bytes, of all states

    /// The last touch, from when it began: how far the surface under the tip has moved since, m, and the
    /// force on the hand, N.
    std::vector<vec2> touch;

    /// To be called once a picture. `moves`: it is not paused.
    void measure(const Experiment& experiment, bool moves);
    /// The same, of what a hand feels.
    void feel(const Felt& felt);

 private:
    double simulated_ = 0, mapped_ = 0, measured_ = 0, paced_ = 0;  // s, at the picture before
    long pictures_ = 0;
    bool touches_ = false;
    vec3 touched_ = vec3(0);  // m, where the touch began
};

}  // namespace palpate
