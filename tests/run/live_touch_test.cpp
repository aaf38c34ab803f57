// Hands that press what they feel in real time. No duration decides: what is waited for comes on any machine.
#include "palpate/run/live_touch.h"

#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/base/realtime.h"
#include "palpate/body/patch.h"
#include "palpate/run/recording.h"
#include "palpate/touch/drivers.h"
#include "tests/refusal.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <set>

namespace palpate {
namespace {

constexpr double patience = 20;  // s
constexpr vec3 over_block(0.03f, 0.052f, 0.03f);

Experiment block(const std::string& more = {}) {
    return Experiment(prepare({"[[body]]\nname = \"block\"\ndims = [7, 5, 7]\nspacing = 0.009\n"
                               "youngs_modulus = 4000\ndensity = 1000\ndamping = 10\npin = { below = 0 }\n" +
                                   more,
                               "test.toml", "."},
                              {}));
}

// On a script, again and again: 4 mm above one of so many blocks, then pressed in by `depth`. A force that
// was let go because the machine stalled comes back.
std::unique_ptr<FeltHand> hand(double depth, vec3 above = over_block, std::size_t blocks = 1) {
    const vec3 in = above - vec3(0, 0.004f + float(depth), 0);
    Path path;
    for (double time = 0; time < 10 * patience; time += 3)
        for (const auto& [after, place] : {std::pair(0.0, above), {0.2, above}, {0.5, in}, {2.8, in}})
            path.push_back({time + after, place});
    auto one = std::make_unique<FeltHand>(
        driver("script").make({.path = std::move(path)}),
        TouchSettings{.radius = 0.012, .feels = std::vector<Feel>(blocks, {.stiffness = 500})}, above);
    one->go_live();
    return one;
}

// Lets it go on until something holds while it is still.
bool wait_for(LiveTouch& live, const std::function<bool()>& holds) {
    for (const double end = now() + patience; now() < end;) {
        live.go_on();
        sleep_until(now() + 0.05);
        live.hold_still();
        if (holds()) return true;
    }
    return false;
}

TEST(LiveTouch, AHandPressesAndIsPushedBack) {
    Experiment experiment = block();
    const auto one = hand(0.007);
    LiveTouch live(experiment, {one.get()});
    EXPECT_TRUE(wait_for(live, [&] { return one->felt().part == 1 && one->felt().force.y > 0.05f; }));
    EXPECT_GT(live.lengths().longest(), 0);
    EXPECT_LE(live.lengths().longest(), 1.02 * frame_seconds);
    EXPECT_EQ(live.advances(), live.work().count());
    const vec3 force = one->felt().force;
    const dvec3 load = experiment.play().interaction_forces().presses[0];
    EXPECT_LE(glm::length(dvec3(force) - load), 0.3 * glm::length(load)) << force.y << " " << load.y;
    EXPECT_LE(std::abs(force.x) + std::abs(force.z), 0.1f * force.y);
}

// What happened is played back to the bit, whatever slices the machine could afford.
TEST(LiveTouch, IsRecorded) {
    const Scratch scratch;
    Experiment experiment = block();
    const auto one = hand(0.007);
    {
        LiveTouch live(experiment, {one.get()});
        EXPECT_TRUE(wait_for(live, [&] { return one->felt().part > 0.3f; }));
        live.advance();
        live.advance(3);
    }
    experiment.change({"body.1.damping=5"});
    experiment.advance();
    write_recording(experiment.recording(), scratch / "it.json");
    const Recording recording = read_recording(scratch / "it.json");
    Experiment again(prepare(recording.scene, recording.changes));
    while (again.replay(recording)) {}
    EXPECT_EQ(again.fingerprint(), experiment.fingerprint());
    EXPECT_EQ(again.time(), experiment.time());
}

// While it is held still, nothing moves, and nothing pushes for long.
TEST(LiveTouch, HeldStillItPushesNobody) {
    Experiment experiment = block();
    const auto one = hand(0.007);
    LiveTouch live(experiment, {one.get()});
    EXPECT_TRUE(wait_for(live, [&] { return one->felt().force.y > 0.05f; }));
    const std::string state = experiment.fingerprint();
    for (const double end = now() + patience; one->touch().felt().force != vec3(0) && now() < end;) {}
    EXPECT_EQ(one->touch().felt().force, vec3(0));
    EXPECT_EQ(experiment.fingerprint(), state);
    EXPECT_TRUE(wait_for(live, [&] { return one->felt().force.y > 0.05f; }));
}

// A body that blows up pushes nobody, and the way back works.
TEST(LiveTouch, ABodyThatBlowsUpPushesNobody) {
    Experiment experiment = block();
    const auto one = hand(0.007);
    LiveTouch live(experiment, {one.get()});
    EXPECT_TRUE(wait_for(live, [&] { return one->felt().force.y > 0.05f; }));
    experiment.change({"simulation.step=0.016", "body.1.youngs_modulus=1e8"});
    EXPECT_TRUE(wait_for(live, [&] { return !experiment.trouble().empty(); }));
    for (const double end = now() + patience; one->touch().felt().force != vec3(0) && now() < end;) {}
    EXPECT_EQ(one->touch().felt().force, vec3(0));
    experiment.undo();
    one->begin_anew();
    EXPECT_TRUE(wait_for(live, [&] { return one->felt().part == 1 && one->felt().force.y > 0.05f; }));
}

// What it grasps it pulls along, and feels that, though it touches nothing.
TEST(LiveTouch, AHandPullsWhatItGrasps) {
    Experiment experiment = block();
    const auto one = hand(-0.03);  // it goes up
    LiveTouch live(experiment, {one.get()});
    const std::size_t node = 7 * 5 * 3 + 7 * 4 + 3;  // in the middle of the block's top
    const vec3 top = experiment.play().nodes(0).positions[node];
    live.grasp(0, {{0, {int(node), top, vec3(0), 3}}}, over_block);
    auto height = [&] { return experiment.play().nodes(0).positions[node].y; };
    EXPECT_TRUE(wait_for(live, [&] { return one->felt().force.y < -0.02f && height() > top.y + 1e-4f; }));
    live.grasp(0, {});
    EXPECT_TRUE(wait_for(live, [&] { return one->felt().force == vec3(0); }));
}

// Of bodies that move, what a hand may touch is all there, where it is, with its own number.
TEST(NearSkins, HoldAllThatIsNear) {
    Experiment experiment = block();
    const Play& play = experiment.play();
    NearSkins near;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> along(0, 0.06f);
    int chosen = 0;
    for (int frame = 0; frame < 60; ++frame) {
        Interaction pull;
        pull.pulls.push_back({0, {200, vec3(0.09f, 0.09f, 0.02f), vec3(0), 3}});
        experiment.advance(pull, 3);
        const float reach = 0.012f;
        const vec3 centre =
            frame % 10 == 0 ? vec3(along(random), 0.04f, along(random)) : vec3(0.02f, 0.04f, 0.03f);
        const std::vector<Skin> some = near.at(play, experiment.models(), centre, reach);
        chosen += near.chose();
        const Skin& whole = play.skins()[0];
        std::set<int> numbers(some[0].numbers.begin(), some[0].numbers.end());
        EXPECT_LT(numbers.size(), whole.triangles->size());
        for (int t : Patch::near({whole.positions, *whole.triangles}, centre, reach))
            EXPECT_TRUE(numbers.contains(t)) << frame;
        for (std::size_t t = 0; t < some[0].numbers.size(); ++t)
            for (int k = 0; k < 3; ++k)
                EXPECT_EQ(some[0].positions[(*some[0].triangles)[t][k]],
                          whole.positions[(*whole.triangles)[std::size_t(some[0].numbers[t])][k]]);
    }
    EXPECT_GT(chosen, 1);
    EXPECT_LT(chosen, 40);
}

// Several hands on several bodies, with something else that acts.
TEST(LiveTouch, SeveralHands) {
    Experiment experiment = block(
        "[[body]]\nname = \"other\"\ndims = [7, 5, 7]\nspacing = 0.009\nmove = [0.2, 0, 0]\n"
        "youngs_modulus = 4000\ndensity = 1000\ndamping = 10\npin = { below = 0 }\n");
    const auto left = hand(0.007, over_block, 2), right = hand(0.005, over_block + vec3(0.2f, 0, 0), 2);
    LiveTouch live(experiment, {left.get(), right.get()});
    Interaction pull;
    pull.pulls.push_back({0, {0, vec3(0), vec3(0), 5}});
    live.set(pull);
    EXPECT_TRUE(
        wait_for(live, [&] { return left->felt().force.y > 0.05f && right->felt().force.y > 0.005f; }));
}

}  // namespace
}  // namespace palpate
