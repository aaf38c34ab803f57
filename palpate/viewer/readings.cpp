#include "palpate/viewer/readings.h"

#include "palpate/base/clock.h"

namespace palpate {

float Recent::mean() const {
    float sum = 0;
    for (std::size_t i = 0; i < count_; ++i) sum += at(i);
    return count_ > 0 ? sum / float(count_) : 0;
}

float Recent::most() const {
    float most = 0;
    for (std::size_t i = 0; i < count_; ++i) most = std::max(most, at(i));
    return most;
}

void Readings::measure(const Experiment& experiment, bool moves) {
    auto since = [](double sum, double& before) { return std::max(sum - std::exchange(before, sum), 0.0); };
    const bool is_first = measured_ == 0;
    const double seconds = since(now(), measured_);
    if (is_first || !moves) return;
    const Report& report = experiment.report();
    simulate.add(float(1000 * since(report.seconds.simulate, simulated_)));
    map.add(float(1000 * since(report.seconds.map, mapped_)));
    pace.add(float(since(experiment.time(), paced_) / std::max(seconds, 1e-6)));
    largest_speed = 0;
    for (const Stats& stats : experiment.play().stats())
        largest_speed = std::max(largest_speed, stats.largest_speed);
    if (pictures_++ % 15 != 0) return;
    memory = experiment.play().memory();
    energy.reset();  // it would have to be read back from the GPU
    if (!on_gpu(experiment.models().simulation.backend)) energy = experiment.energy();
}

void Readings::feel(const Felt& felt) {
    constexpr std::size_t most = 3600;  // pictures: a minute
    const bool began = felt.surface >= 0 && !touches_;
    touches_ = felt.surface >= 0;
    if (began) {
        touch.clear();
        touched_ = felt.proxy;
    }
    if (touches_ && touch.size() < most)
        touch.emplace_back(glm::distance(felt.proxy, touched_), glm::length(felt.force));
}

}  // namespace palpate
