#include "bench/walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace palpate::studies {
namespace {

constexpr double stiffest_tried = 1e6;  // N/m
constexpr double half_a_percent = 0.005;

// ---- measured ----

constexpr double depth = 0.005;     // m, of the hand in the wall at equilibrium
constexpr double shake = 0.001;     // m, by which the equilibrium jumps
constexpr double chatter = 0.0003;  // m: motion of ten encoder steps counts as rest
constexpr double shaken_at = 1;     // s, when the equilibrium jumps
constexpr double late = 16;         // s, when the swing is compared with that just after the jump
constexpr double flung_off = 0.1;   // m

// Whether the swing of a disturbed hand decays. The hand is pressed in so far that it stays in contact and
// the damper never has to pull, unless the motion grows until that limits it. A strong damper on a
// soft wall chatters by the encoder's steps, which is allowed as long as it is small.
bool dies_down(const Wall& wall, double stiffness, double most_damping) {
    VirtualHandSettings person = wall.hand;
    person.peak_force = person.lasting_force = 1e9f;
    person.stiffest_wall = float(4 * stiffest_tried);
    const TouchSettings settings =
        without_limits({.stiffness = stiffness, .damping = wall.damping}, most_damping);
    const double radius = settings.radius, pressed = 1 + stiffness / person.stiffness;
    auto down = [&](double deep) { return vec3(0, float(radius - deep), 0); };
    auto hand = std::make_unique<VirtualHand>(Path{{0, down(-1e-4)},
                                                   {shaken_at, down((depth - shake) * pressed)},
                                                   {shaken_at + 1e-6, down(depth * pressed)}},
                                              person);
    const VirtualHand& moved = *hand;
    Touch touch(std::move(hand), settings);
    const std::array<vec3, 3> corners = {vec3(-1, 0, 1), vec3(1, 0, 1), vec3(0, 0, -2)};
    const std::array<uvec3, 1> triangle = {uvec3(0, 1, 2)};
    const Touchable plane[] = {{corners, triangle}};
    touch.feel(Patch(plane));
    Range first_second, last_second;
    bool loses_contact = false;  // in the last second
    for (int i = 0; i < int((late + 1) * wall.rate); ++i) {
        const double now = i / wall.rate;
        touch.tick(now);
        const double place = moved.position().y;
        if (!(std::abs(place) < flung_off)) return false;
        if (now >= shaken_at && now < shaken_at + 1) first_second.take(place);
        if (now < late) continue;
        last_second.take(place);
        loses_contact = loses_contact || moved.force().y == 0;
    }
    return last_second.size() < (loses_contact ? chatter : first_second.size());
}

// ---- linear ----

struct Motion {
    double place = 0, speed = 0;
};

// The solution of m x'' = force - k x - c x', by its Taylor series.
Motion moved(const VirtualHandSettings& hand, Motion from, double force, double seconds) {
    auto rate = [&](Motion at, double push) {
        return Motion{at.speed, (push - hand.stiffness * at.place - hand.damping * at.speed) / hand.mass};
    };
    Motion sum = from, term = rate(from, force);
    double part = seconds;
    for (int n = 2; n < 30; ++n) {
        sum = {sum.place + part * term.place, sum.speed + part * term.speed};
        term = rate(term, 0);
        part *= seconds / n;
    }
    return sum;
}

// The state between ticks: the hand's position and velocity, its previous position, the velocity as the loop
// filters it, and the delayed forces, the newest first.
using State = std::vector<double>;

State next(const Wall& wall, double stiffness, const State& state) {
    const double tick = 1 / wall.rate;
    const double weight = 1 - std::exp(-tick / TouchSettings{}.velocity_filter);
    const Motion at = {state[0], state[1]};
    const double filtered = state[3] + weight * ((at.place - state[2]) / tick - state[3]);
    State after(state.size());
    after[2] = at.place;
    after[3] = filtered;
    after[4] = -stiffness * at.place - wall.damping * filtered;
    std::copy(state.begin() + 4, state.end() - 1, after.begin() + 5);
    // The delay ends within a tick; until then the previous force acts.
    const double rest = wall.hand.delay - tick * double(state.size() - 5);
    Motion hand = moved(wall.hand, at, state.back(), rest);
    hand = moved(wall.hand, hand, after.back(), tick - rest);
    after[0] = hand.place;
    after[1] = hand.speed;
    return after;
}

// The largest absolute eigenvalue, as the root of the norm of a high power, by repeated squaring.
double spectral_radius(std::vector<State> columns) {
    const std::size_t n = columns.size();
    double logarithm = 0, power = 1;
    for (int i = 0; i < 40; ++i) {
        double size = 0;
        for (const State& column : columns)
            for (double value : column) size += std::abs(value);
        if (size == 0) return 0;
        logarithm += std::log(size) / power;
        std::vector<State> square(n, State(n, 0));
        for (std::size_t c = 0; c < n; ++c)
            for (std::size_t k = 0; k < n; ++k)
                for (std::size_t r = 0; r < n; ++r)
                    square[c][r] += columns[k][r] / size * (columns[c][k] / size);
        columns = std::move(square);
        power *= 2;
    }
    return std::exp(logarithm);
}

}  // namespace

double stiffest(double fraction, double most, const std::function<bool(double)>& holds) {
    double low = 0, high = std::min(100.0, most);
    while (holds(high)) {
        low = high;
        if (high >= most) return most;
        high = std::min(2 * high, most);
    }
    if (low == 0 && !holds(1)) return 0;
    while (high - low > fraction * high) {
        const double middle = 0.5 * (low + high);
        (holds(middle) ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

TouchSettings without_limits(const Feel& feel, double most_damping) {
    TouchSettings settings;
    settings.feels = {feel};
    settings.direction_filter = 0;
    settings.safety.small_force = settings.safety.fastest_hand = std::numeric_limits<double>::max();
    settings.safety.calm = settings.safety.ramp = 0;
    settings.safety.jump = 1;
    settings.safety.most_damping = most_damping;
    return settings;
}

double stiffest_measured(const Wall& wall, double most_damping) {
    return stiffest(half_a_percent, stiffest_tried,
                    [&](double k) { return dies_down(wall, k, most_damping); });
}

double stiffest_linear(const Wall& wall) {
    const auto delayed = std::size_t(wall.hand.delay * wall.rate + 1e-9) + 1;
    return stiffest(half_a_percent, stiffest_tried, [&](double k) {
        std::vector<State> columns;
        for (std::size_t i = 0; i < 4 + delayed; ++i) {
            State one(4 + delayed, 0);
            one[i] = 1;
            columns.push_back(next(wall, k, one));
        }
        return spectral_radius(columns) < 1;
    });
}

double stiffest_passive(const Wall& wall) {
    return std::max(wall.hand.damping - wall.damping, 0.0) / (0.5 / wall.rate + wall.hand.delay);
}

}  // namespace palpate::studies
