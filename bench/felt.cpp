#include "bench/felt.h"

#include "bench/tissue.h"
#include "bench/walls.h"
#include "palpate/body/hull.h"
#include "palpate/body/lattice.h"
#include "palpate/body/scatter.h"
#include "palpate/body/select.h"
#include "palpate/run/felt_hand.h"
#include "palpate/solver/stability.h"
#include "palpate/solver/world.h"
#include "palpate/touch/devices/script.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <memory>
#include <utility>

namespace palpate::studies {
namespace {

constexpr double pi = 3.14159265358979;

// ---- a block and its hand ----

Body made(const FeltBlock& block, bool stands = true) {
    const auto spacing = float(block.spacing);
    Body body = lattice(ivec3(glm::round(block.size / block.spacing)) + 1, spacing,
                        {.youngs_modulus = float(block.youngs_modulus),
                         .density = float(density),
                         .damping = float(block.damping)});
    if (stands) pin(body, nodes_below(body, 0, {0, -1, 0}));
    if (const auto& nodule = block.nodule) {
        const dvec3 middle = block.size * dvec3(0.5, 1, 0.5) - dvec3(0, nodule->depth + nodule->radius, 0);
        std::vector<float> factors(body.count(), 1);
        for (std::size_t i = 0; i < body.count(); ++i)
            if (glm::distance(dvec3(body.positions[i]), middle) <= nodule->radius)
                factors[i] = float(nodule->youngs_modulus / block.youngs_modulus);
        strengthen(body, factors);
    }
    return body;
}

const Simulation weightless{.shortest_step = 0, .gravity = vec3(0)};

// The ball over the middle of a block, its lowest point so far below the top; and `aside` along x.
vec3 ball(const FeltBlock& block, double depth, double aside = 0) {
    return vec3(block.size * dvec3(0.5, 1, 0.5) + dvec3(aside, block.radius - depth, 0));
}

double depth_of(const FeltBlock& block, double height) { return block.size.y + block.radius - height; }

// A hand and the body that it presses, slice by slice, as a program does it whose clock is its own.
class Pressed {
 public:
    using Watch = std::function<void(double time, const Felt& felt)>;

    Pressed(const Body& body, const FeltClock& clock, std::unique_ptr<Device> device,
            const TouchSettings& settings, vec3 start)
        : clock_(clock),
          surface_(hull_mesh(body)),
          embedding_(embed(surface_, body)),
          skins_{{surface_.positions, surface_.normals, &surface_.triangles}},
          hand_(std::move(device), settings, start),
          world_(weightless, nullptr, nullptr, clock.slice) {
        world_.add(body);
        hand_.touch().expect_rate(clock.rate);
    }

    // Goes on to a time, and shows each tick of the hand. False if the body diverged.
    bool go_on(double until, const Watch& watch = {}) {
        while (time_ < until - 1e-9) {
            const std::vector<BodyPush> back = give_back();
            const WorldStats stats = world_.step(
                clock_.slice,
                {.pushes = back, .press_in_slice = [&](double, double, std::span<const dvec3> reactions) {
                     return std::vector<Press>{press(reactions, watch)};
                 }});
            if (stats.diverged) return false;
            time_ += clock_.slice;
        }
        return true;
    }

    const Solver& solver() const { return world_.solver(0); }

    // N s, of all that was written to the device.
    dvec3 felt() {
        take_pushes();
        return felt_;
    }

 private:
    void take_pushes() {
        for (Push push; hand_.touch().next(push);) {
            felt_ -= push.impulse;
            unfelt_ += push.impulse;
            touched_ = push;
        }
    }

    std::vector<BodyPush> give_back() {
        if (!(clock_.gives_back_in > 0) || !touched_) return {};
        const dvec3 force = unfelt_ / clock_.gives_back_in;
        unfelt_ -= clock_.slice * force;
        std::vector<SurfacePush> corners;
        for (int k = 0; k < 3; ++k)
            corners.push_back({.vertex = surface_.triangles[std::size_t(touched_->triangle)][k],
                               .force = vec3(touched_->weights[k] * force)});
        std::vector<BodyPush> pushes;
        for (const NodePush& push : scatter(embedding_, solver().nodes(), corners))
            pushes.push_back({0, push});
        return pushes;
    }

    Press press(std::span<const dvec3> reactions, const Watch& watch) {
        const dvec3 load = reactions.empty() ? dvec3(0) : reactions[0] / clock_.slice;
        take_pushes();
        unfelt_ += clock_.slice * std::exchange(load_, load);
        const float reach = hand_.radius() + 0.02f + float(clock_.slice);
        deform(embedding_, solver().nodes(), skins_[0].positions);
        hand_.feel(skins_, time_, reach, {.surfaces = 1, .load = load});
        for (; double(ticks_) / clock_.rate <= time_ + clock_.slice + 1e-9; ++ticks_) {
            const double now = double(ticks_) / clock_.rate;
            hand_.tick(now);
            if (watch) watch(now, hand_.felt());
        }
        return hand_.press(clock_.slice, 1);
    }

    const FeltClock clock_;
    const Mesh surface_;
    const Embedding embedding_;
    std::vector<Skin> skins_;
    FeltHand hand_;
    World world_;
    double time_ = 0;
    long ticks_ = 0;
    dvec3 load_ = dvec3(0);                      // N, that the hand was last told of
    dvec3 felt_ = dvec3(0), unfelt_ = dvec3(0);  // N s; of all loads
    std::optional<Push> touched_;
};

// Without friction and damper, so that force at rest is a function of depth.
Feel smooth(double stiffness) { return {.stiffness = stiffness, .damping = 0, .friction = {0, 0}}; }

TouchSettings settings_for(const FeltBlock& block) {
    return {.radius = block.radius,
            .feels = {smooth(block.stiffness)},
            .safety = {.most_damping = block.most_damping}};
}

Pressed scripted(const FeltBlock& block, const FeltClock& clock, const Path& path) {
    return {made(block), clock, std::make_unique<Script>(path), settings_for(block), path.front().position};
}

// Down to a depth, when the force has ramped up.
Path down(const FeltBlock& block, double depth, double aside = 0) {
    return {
        {0, ball(block, -0.003, aside)}, {1.1, ball(block, -0.003, aside)}, {1.5, ball(block, depth, aside)}};
}

// Damped as the slowest shear wave of the block asks for.
std::vector<double> at_rest(const FeltBlock& block, std::span<const double> depths, bool exactly) {
    FeltBlock damped = block;
    const double shear = block.youngs_modulus / (2 * (1 + 0.45));
    const double wave = block.size.y / std::sqrt(shear / density);
    damped.damping = pi / wave;
    const Body body = made(damped);
    const auto solver = exactly ? make_exact_solver(body, weightless, highest_frequency(body))
                                : make_solver(body, weightless);
    std::vector<double> forces;
    for (double depth : depths) {
        const Press tip{ball(block, depth), vec3(0), float(block.radius), float(block.stiffness)};
        double before = 0, force = 0;
        int rounds = 0;
        do {
            before = std::exchange(force, solver->step(wave, {.presses = {&tip, 1}}).reactions[0].y / wave);
        } while (++rounds < 3 || (rounds < 100 && std::abs(force - before) > 1e-5 * std::abs(force)));
        forces.push_back(force);
    }
    return forces;
}

}  // namespace

std::vector<double> pressed_at_rest(const FeltBlock& block, std::span<const double> depths) {
    return at_rest(block, depths, true);
}

double felt_at_rest(const FeltBlock& block, double depth, const FeltClock& clock) {
    constexpr double end = 3, over = 0.5;  // s
    double sum = 0;
    int count = 0;
    scripted(block, clock, down(block, depth)).go_on(end, [&](double time, const Felt& felt) {
        if (time <= end - over) return;
        sum += double(felt.force.y);
        ++count;
    });
    return sum / count;
}

// ---- a swing ----

namespace {

constexpr double middle = 0.004, swing = 0.002;  // m, of the depth
constexpr double swings_from = 1.5;              // s

// The force at rest at all depths of a swing, N, between those where it is known.
class ForceAtRest {
 public:
    explicit ForceAtRest(const FeltBlock& block) {
        std::vector<double> depths;
        for (int i = 0; i <= parts; ++i) depths.push_back(middle + swing * (2.0 * i / parts - 1));
        forces_ = pressed_at_rest(block, depths);
    }

    double at(double depth) const {
        const double place = parts * std::clamp((depth - middle + swing) / (2 * swing), 0.0, 1.0);
        const auto i = std::min(std::size_t(place), std::size_t(parts - 1));
        return glm::mix(forces_[i], forces_[i + 1], place - double(i));
    }

 private:
    static constexpr int parts = 16;
    std::vector<double> forces_;
};

FeltSwing swing_of(const FeltBlock& block, const ForceAtRest& rest, double frequency,
                   const FeltClock& clock) {
    const double turns = 2 * pi * frequency, watched = swings_from + 1 / frequency,
                 end = watched + 2 / frequency;
    Path path = down(block, middle);
    for (double t = 0.001; t < end - swings_from + 0.1; t += 0.001)
        path.push_back({swings_from + t, ball(block, middle + swing * std::sin(turns * t))});
    std::complex<double> felt(0), at_rest(0);
    scripted(block, clock, path).go_on(end, [&](double time, const Felt& now) {
        if (time <= watched || time > end) return;
        const auto turn = std::polar(1.0, -turns * time);
        felt += double(now.force.y) * turn;
        at_rest += rest.at(depth_of(block, now.pose.place.y)) * turn;
    });
    return {std::abs(felt / at_rest), std::arg(felt / at_rest) * 180 / pi};
}

}  // namespace

std::vector<FeltSwing> felt_swings(const FeltBlock& block, double frequency,
                                   std::span<const FeltClock> clocks) {
    const ForceAtRest rest(block);
    std::vector<FeltSwing> swings;
    for (const FeltClock& clock : clocks) swings.push_back(swing_of(block, rest, frequency, clock));
    return swings;
}

// ---- a stroke ----

FeltStroke felt_stroke(const FeltBlock& block, double depth, const FeltClock& clock) {
    constexpr double speed = 0.03;  // m/s
    constexpr double begins = 2;    // s
    const double half = block.size.x / 4, end = begins + 2 * half / speed;
    Path path = down(block, depth, -half);
    path.push_back({begins, ball(block, depth, -half)});
    path.push_back({end, ball(block, depth, half)});
    FeltStroke stroke;
    scripted(block, clock, path).go_on(end, [&](double time, const Felt& felt) {
        if (time <= begins) return;
        stroke.places.push_back(felt.pose.place.x - block.size.x / 2);
        stroke.forces.push_back(double(felt.force.y));
    });
    return stroke;
}

double excess(const FeltStroke& with, const FeltStroke& without) {
    double most = 0;
    for (std::size_t i = 0; i < std::min(with.forces.size(), without.forces.size()); ++i)
        most = std::max(most, with.forces[i] - without.forces[i]);
    return most;
}

// ---- a hand of an arm ----

namespace {

constexpr double held_depth = 0.004, shove = 0.0002;  // m, of the hand at equilibrium; by which that jumps
constexpr double chatter = 0.01;                      // of the force: what counts as rest

FeltBlock held(const FeltHold& hold, double stiffness) {
    return {.size = {0.048, 0.032, 0.048},
            .spacing = 0.008,
            .youngs_modulus = hold.youngs_modulus,
            .stiffness = stiffness};
}

// The force at the depth of equilibrium, N, and how it grows with depth, N/m.
std::pair<double, double> force_and_slope(const FeltBlock& block) {
    const double depths[] = {held_depth - shove, held_depth, held_depth + shove};
    const std::vector<double> forces = at_rest(block, depths, false);
    return {forces[1], (forces[2] - forces[0]) / (2 * shove)};
}

// Gently, so that nothing swings yet when the equilibrium jumps.
Path held_down(const FeltBlock& block, const VirtualHandSettings& arm, double jumps) {
    const auto [force, slope] = force_and_slope(block);
    const double above = -0.001, depth = held_depth + force / arm.stiffness;
    Path plan;
    for (double t = 0; t < jumps; t += 0.01)
        plan.push_back({t, ball(block, above + (depth - above) * 0.5 * (1 - std::cos(pi * t / jumps)))});
    plan.push_back({jumps, ball(block, depth + shove * (1 + slope / arm.stiffness))});
    return plan;
}

}  // namespace

bool comes_to_rest(const FeltHold& hold, double stiffness) {
    constexpr double jumps = 1.5, late = 6.5;  // s
    const FeltBlock block = held(hold, stiffness);
    VirtualHandSettings arm = hold.hand;
    arm.peak_force = arm.lasting_force = 1e9f;
    arm.stiffest_wall = float(4 * StiffestTouch::most);
    const Path plan = held_down(block, arm, jumps);
    TouchSettings settings = without_limits(smooth(stiffness), hold.most_damping);
    settings.radius = block.radius;
    settings.surprise = 1;
    Pressed pressed(made(block), {.slice = hold.slice, .gives_back_in = hold.gives_back_in},
                    std::make_unique<VirtualHand>(plan, arm), settings, plan.front().position);
    Range first, last;
    const bool whole = pressed.go_on(late + 1, [&](double time, const Felt& felt) {
        if (time >= jumps && time < jumps + 1) first.take(double(felt.force.y));
        if (time >= late) last.take(double(felt.force.y));
    });
    const bool presses = last.least > 0;  // it did not fall through
    return whole && presses && last.size() < std::max(first.size(), chatter * last.most);
}

StiffestTouch stiffest_touch(const FeltHold& hold) {
    constexpr double most = StiffestTouch::most;
    const double bound = stiffest_linear(hold);
    return {stiffest(0.02, most, [&](double k) { return comes_to_rest(hold, k); }),
            stiffest(0.02, most, [&](double k) { return force_and_slope(held(hold, k)).second < bound; })};
}

namespace {

Wall as_wall(const FeltHold& hold) {
    Wall wall{.damping = 0, .rate = 1 / hold.slice, .hand = hold.hand};
    wall.hand.delay += hold.slice / 2 + 1 / FeltClock{}.rate;
    return wall;
}

}  // namespace

double stiffest_linear(const FeltHold& hold) { return stiffest_linear(as_wall(hold)); }

double stiffest_passive(const FeltHold& hold) { return stiffest_passive(as_wall(hold)); }

// ---- momentum ----

GivenAndFelt momentum_of_a_free_block(const FeltClock& clock, double most_damping) {
    const FeltBlock block{.size = {0.048, 0.024, 0.048},
                          .damping = 0,
                          .radius = 0.01,
                          .stiffness = 500,
                          .most_damping = most_damping};
    const Body body = made(block, false);
    const Path path{{0, ball(block, -0.001)}, {0.2, ball(block, -0.001)}, {1.2, ball(block, 0.05)}};
    Pressed pressed(body, clock, std::make_unique<Script>(path), settings_for(block), path.front().position);
    pressed.go_on(1.2);
    GivenAndFelt both{0, pressed.felt().y};
    const State state = pressed.solver().state();
    for (std::size_t i = 0; i < body.count(); ++i)
        both.given -= state.velocities[i].y / double(body.inverse_mass[i]);
    return both;
}

}  // namespace palpate::studies
