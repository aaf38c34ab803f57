#pragma once
#include <chrono>

namespace palpate {

/// Seconds on a monotonic clock.
inline double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Adds the seconds of its lifetime to a sum: `{ Timed timed(seconds.map); deform(...); }`
class Timed {
 public:
    explicit Timed(double& sum) : sum_(sum), start_(now()) {}
    ~Timed() { sum_ += now() - start_; }
    Timed(const Timed&) = delete;
    Timed& operator=(const Timed&) = delete;

 private:
    double& sum_;
    double start_;
};

}  // namespace palpate
