// A scene that somebody plays with: what is changed, undone, pinned, blown up, recorded and replayed.
#include "palpate/run/experiment.h"

#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/body/hull.h"
#include "palpate/body/lattice.h"
#include "palpate/body/select.h"
#include "palpate/run/recording.h"
#include "palpate/solver/stability.h"
#include "tests/refusal.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

const std::string beam = R"([[body]]
name = "beam"
dims = [9, 4, 3]
spacing = 0.01
youngs_modulus = 20000
density = 1000
damping = 2
pin = { nodes = [0, 9, 18, 27, 36, 45, 54, 63, 72, 81, 90, 99] }
)";

Prepared prepared(const std::string& text, std::vector<Change> changes = {}) {
    return prepare({text, "test.toml", "."}, std::move(changes));
}

Experiment going(int frames, const std::string& text = beam, std::vector<Change> changes = {}) {
    Experiment experiment(prepared(text, std::move(changes)));
    for (int f = 0; f < frames; ++f) experiment.advance();
    return experiment;
}

Interaction pulling(int node, vec3 to) {
    Interaction hands;
    hands.pulls.push_back({0, {node, to, vec3(0), 5}});
    return hands;
}

dvec3 place(const Experiment& experiment, std::size_t node) {
    return experiment.play().save()[0].positions[node];
}

// The largest distance between two states' positions, m; NaN if any is.
double apart(const State& a, const State& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.positions.size(); ++i) {
        const double one = glm::distance(a.positions[i], b.positions[i]);
        if (!(one <= most)) most = one;
    }
    return most;
}

TEST(Experiment, GoesOnFromWhereItIsOnAnyBackendAndWithAnyIntegrator) {
    for (const char* change : {"simulation.backend=\"reference\"", "simulation.integrator=\"rk4\"",
                               "simulation.integrator=\"semi-implicit-euler\"", "simulation.threads=2",
                               "simulation.gravity=[1,-5,0]", "simulation.step=0.0001"}) {
        Experiment experiment = going(20);
        const State before = experiment.play().save()[0];
        experiment.change({change});
        const State after = experiment.play().save()[0];
        EXPECT_TRUE(apart(before, after) <= 1e-8)
            << change;  // the reference keeps places, not ways, in floats
        EXPECT_TRUE(experiment.advance()) << change;
        EXPECT_LT(apart(experiment.play().save()[0], before), 0.02) << change;
    }
}

TEST(Experiment, AnotherBackendMovesAlmostAsTheFirst) {
    Experiment one = going(10), other = going(10);
    other.change({"simulation.backend=\"reference\""});
    for (int f = 0; f < 30; ++f) one.advance(), other.advance();
    const double difference = apart(one.play().save()[0], other.play().save()[0]);
    EXPECT_TRUE(difference <= 1e-5) << difference;
}

TEST(Experiment, WhatWasChangedIsWhatTheSceneWouldSay) {
    // Changed one after the other, then from the beginning; against a scene that said so from the start.
    const std::vector<Change> changes = {"body.1.youngs_modulus=50000", "body.1.damping=5",
                                         "body.1.pin={nodes=[0,1,2]}", "simulation.gravity=[0,-3,2]",
                                         "simulation.integrator=\"midpoint\""};
    Experiment experiment = going(7);
    for (const Change& change : changes) {
        experiment.change({change});
        experiment.advance();
    }
    experiment.restart();
    EXPECT_EQ(experiment.time(), 0);
    Experiment fresh(prepared(beam, changes));
    for (int f = 0; f < 25; ++f) experiment.advance(), fresh.advance();
    EXPECT_EQ(experiment.fingerprint(), fresh.fingerprint());
    // And the saved text says the same once more.
    Experiment saved(prepared(changed(experiment.source(), experiment.changes())));
    for (int f = 0; f < 25; ++f) saved.advance();
    EXPECT_EQ(saved.fingerprint(), fresh.fingerprint());
}

TEST(Experiment, UndoAndRedo) {
    Experiment experiment = going(3);
    EXPECT_FALSE(experiment.can_undo());
    experiment.change({"body.1.damping=3"});
    experiment.change({"body.1.damping=4"}, true);  // the same movement of a slider
    experiment.change({"simulation.gravity=[0,0,0]"});
    EXPECT_EQ(experiment.scene().bodies[0].material.damping, 4);
    experiment.undo();
    EXPECT_EQ(experiment.scene().simulation.gravity, vec3(0, -9.81f, 0));
    EXPECT_EQ(experiment.scene().bodies[0].material.damping, 4);
    experiment.undo();
    EXPECT_EQ(experiment.scene().bodies[0].material.damping, 2);
    EXPECT_FALSE(experiment.can_undo());
    experiment.redo();
    experiment.redo();
    EXPECT_EQ(experiment.scene().simulation.gravity, vec3(0));
    EXPECT_FALSE(experiment.can_redo());
    experiment.undo();
    experiment.change({"body.1.damping=7"});  // another way: what was undone is gone
    EXPECT_FALSE(experiment.can_redo());
}

TEST(Experiment, WhatCannotBeIsRefusedAndNothingChanges) {
    Experiment experiment = going(12);
    const std::string before = experiment.fingerprint();
    for (const char* wrong : {"body.1.damping=-1", "body.7.damping=1", "simulation.integrator=\"leapfrog\"",
                              "body.1.colour_map=\"nowhere.png\"", "simulation.step=1e-9", "no sense"}) {
        EXPECT_THROW(experiment.change({wrong}), Error) << wrong;
        EXPECT_EQ(experiment.fingerprint(), before) << wrong;
        EXPECT_FALSE(experiment.can_undo());
    }
    EXPECT_TRUE(experiment.advance());
}

TEST(Experiment, ANodeThatIsPinnedStaysWhereItIs) {
    Experiment experiment = going(30);
    const dvec3 there = place(experiment, 8);
    EXPECT_GT(glm::distance(there, dvec3(experiment.models().models[0].body.positions[8])), 1e-3);
    experiment.pin(0, {8, 17}, true);
    EXPECT_TRUE(experiment.is_pinned(0, 8));
    for (int f = 0; f < 20; ++f) experiment.advance();
    EXPECT_EQ(place(experiment, 8), there);
    experiment.pin(0, {8}, false);
    EXPECT_FALSE(experiment.is_pinned(0, 8));
    EXPECT_TRUE(experiment.is_pinned(0, 17));
    experiment.change({"simulation.gravity=[0,20,0]"});
    for (int f = 0; f < 20; ++f) experiment.advance();
    EXPECT_NE(place(experiment, 8), there);
    experiment.undo(), experiment.undo(), experiment.undo();
    EXPECT_FALSE(experiment.is_pinned(0, 17));
    EXPECT_TRUE(experiment.is_pinned(0, 9));  // as the scene has it
}

TEST(Experiment, AnUnstableStepIsHeldAndReturnedFrom) {
    Experiment experiment = going(60);
    const double bound = experiment.stable_step(0);
    EXPECT_GT(bound, 0);
    experiment.change({"simulation.step=" + std::to_string(1.3 * bound)});
    for (int f = 0; f < 600 && experiment.trouble().empty(); ++f) experiment.advance();
    ASSERT_FALSE(experiment.trouble().empty());
    EXPECT_NE(experiment.trouble().find("beam"), std::string::npos) << experiment.trouble();
    EXPECT_NE(experiment.trouble().find("diverged"), std::string::npos);
    const double held = experiment.time();
    const State state = experiment.play().save()[0];
    for (dvec3 p : state.positions) EXPECT_TRUE(glm::length(p) < 100);
    EXPECT_FALSE(experiment.advance());
    EXPECT_EQ(experiment.time(), held);
    ASSERT_TRUE(experiment.can_return());
    experiment.return_to_good();
    EXPECT_TRUE(experiment.trouble().empty());
    if (experiment.scene().simulation.step != 0) experiment.undo();  // if it took longer than two seconds
    EXPECT_EQ(experiment.scene().simulation.step, 0);
    for (int f = 0; f < 120; ++f) EXPECT_TRUE(experiment.advance());
}

TEST(Experiment, ReturningGoesBackToTheBitAndChangesBack) {
    Experiment experiment = going(31);
    Experiment same = going(30);
    const std::string good = same.fingerprint();
    // Of what is remembered every half second, the oldest: here frame 0; with more frames, two seconds ago.
    for (int f = 0; f < 119; ++f) experiment.advance();  // 150: 0, 30, 60, 90, 120 are known
    experiment.change({"body.1.damping=9"});
    experiment.advance();  // remembers 150 and drops 0
    experiment.return_to_good();
    EXPECT_EQ(experiment.fingerprint(), good);
    EXPECT_EQ(experiment.scene().bodies[0].material.damping, 2);
    EXPECT_NEAR(experiment.time(), 0.5, 1e-12);
    experiment.undo();  // the return is a change like any other
    EXPECT_EQ(experiment.scene().bodies[0].material.damping, 9);
}

TEST(Experiment, HandsPullAndFeelIt) {
    Experiment experiment = going(60);
    const dvec3 before = place(experiment, 8);
    const vec3 to = vec3(before) + vec3(0, 0.03f, 0);
    for (int f = 0; f < 90; ++f) experiment.advance(pulling(8, to));
    EXPECT_GT(place(experiment, 8).y, before.y + 0.005);
    ASSERT_EQ(experiment.play().interaction_forces().pulls.size(), 1u);
    // The force on the hand: the spring's, as far as it is stretched, within what still swings.
    const dvec3 spring = 5.0 * (place(experiment, 8) - dvec3(to));
    EXPECT_TRUE(glm::distance(experiment.play().interaction_forces().pulls[0], spring) <
                0.1 * glm::length(spring))
        << experiment.play().interaction_forces().pulls[0].y << " " << spring.y;
    experiment.advance();
    EXPECT_TRUE(experiment.play().interaction_forces().pulls.empty());
}

TEST(Experiment, TakesAnyNumberOfHandsThatAreNotTooStrong) {
    const std::string tools =
        beam +
        "[[tool]]\nradius = 0.02\npath = [[0, 1, 1, 1], [9, 1, 1, 1]]\n"
        "[[tool]]\nkind = \"drag\"\nnear = [0.08, 0, 0]\npath = [[0, 0.1, 0, 0], [9, 0.1, 0, 0]]\n";
    Experiment experiment = going(1, tools);
    Interaction hands;
    for (int i = 0; i < 20; ++i) {
        hands.presses.push_back({vec3(1), vec3(0), 0.01f, 1});
        hands.pulls.push_back(pulling(8, vec3(0.1f)).pulls[0]);
    }
    EXPECT_TRUE(experiment.takes(hands));
    EXPECT_TRUE(experiment.advance(hands));
    Interaction more;
    for (float wrong : {-1.0f, 1e30f, NAN}) {
        more = hands;
        more.pulls[2].push.stiffness = wrong;
        EXPECT_FALSE(experiment.takes(more)) << wrong;
        more = hands;
        more.presses[3].stiffness = wrong;
        EXPECT_FALSE(experiment.takes(more)) << wrong;
    }
    more = hands;
    more.presses[0].radius = 0;
    EXPECT_FALSE(experiment.takes(more));
}

TEST(Experiment, ToolsGoOnThroughChanges) {
    // A tip on its way presses as it would have: what it has touched is remembered.
    const std::string tool = beam +
                             "[[tool]]\nradius = 0.02\nfrom = [0.06, 0.2, 0.01]\n"
                             "path = [[0, 0, 0, 0], [1, 0, -0.01, 0]]\n";
    Experiment one = going(30, tool), other = going(30, tool);
    other.change({"simulation.threads=2"});
    const auto beside = one.beside({"body.1.mapping=\"frames\""});
    for (int f = 0; f < 20; ++f) one.advance(), other.advance(), beside->advance();
    EXPECT_EQ(one.fingerprint(), other.fingerprint());
    EXPECT_EQ(one.fingerprint(), beside->fingerprint());
    one.change({"body.1.dims=[9,5,3]"});  // other nodes: it begins anew, and holds nothing that is not there
    for (int f = 0; f < 5; ++f) EXPECT_TRUE(one.advance());
}

TEST(Experiment, BesideItGoesOnFromTheSameState) {
    Experiment experiment = going(25);
    const auto other = experiment.beside({"body.1.mapping=\"frames\""});
    EXPECT_EQ(other->fingerprint(), experiment.fingerprint());
    for (int f = 0; f < 10; ++f) experiment.advance(), other->advance();
    EXPECT_EQ(other->fingerprint(), experiment.fingerprint());  // a mapping does not move the nodes
    EXPECT_EQ(other->time(), experiment.time());
}

TEST(Experiment, ShapesAreNewOnlyWhereTheyAre) {
    Experiment experiment = going(1);
    const auto shapes = experiment.shapes();
    experiment.change({"body.1.damping=3", "simulation.integrator=\"rk4\"", "body.1.pin={nodes=[0]}"});
    EXPECT_EQ(experiment.shapes(), shapes);
    experiment.change({"body.1.mapping=\"frames\""});
    EXPECT_NE(experiment.shapes(), shapes);
    const auto framed = experiment.shapes();
    experiment.undo();
    EXPECT_NE(experiment.shapes(), framed);
}

// The same beam as a program makes it: it moves to the bit as the text's.
TEST(Experiment, OfModelsItDoesWhatNeedsNoText) {
    Body body = lattice({9, 4, 3}, 0.01f, {.youngs_modulus = 20'000, .density = 1000, .damping = 2});
    const std::vector<int> end = {0, 9, 18, 27, 36, 45, 54, 63, 72, 81, 90, 99};
    pin(body, end);
    Experiment made(prepare(body, hull_mesh(body))), told = going(0);
    auto both = [&](auto act) {
        act(made), act(told);
        EXPECT_EQ(made.fingerprint(), told.fingerprint());
        EXPECT_EQ(made.can_undo(), told.can_undo());
    };
    auto advance = [](Experiment& one) {
        for (int f = 0; f < 10; ++f) EXPECT_TRUE(one.advance(pulling(8, vec3(0.1f, 0.02f, 0))));
    };
    both(advance);
    both([](Experiment& one) { one.pin(0, {8, 17}, true); });
    both(advance);
    both([](Experiment& one) { one.undo(); });
    both(advance);
    both([](Experiment& one) { one.redo(); });
    EXPECT_TRUE(made.is_pinned(0, 8));
    both([](Experiment& one) { one.pin(0, {8}, false); });
    EXPECT_FALSE(made.is_pinned(0, 8));
    both(advance);
    both([](Experiment& one) { one.return_to_good(); });
    both(advance);
    both([](Experiment& one) { one.restart(); });
    EXPECT_EQ(made.time(), 0);
    both(advance);
    EXPECT_GT(made.stable_step(0), 0);
    expect_refused("infinite mass", [&] { made.pin(0, {0}, false); });
    expect_refused("without a text", [&] { made.change({"body.1.damping=3"}); });
    expect_refused("without a text", [&] { made.beside({}); });
    expect_refused("without a text", [&] { made.recording(); });
    expect_refused("without a text", [&] { made.replay({}); });
}

TEST(Experiment, OfModelsWithAllThatThereMayBe) {
    Models models;
    Body body = lattice({3, 3, 3}, 0.01f, {.youngs_modulus = 20'000, .density = 1000, .damping = 2});
    Mesh surface = hull_mesh(body);
    Embedding skin = embed(surface, body);
    models.models.push_back({body, surface, skin, {}, {}});
    models.static_surfaces.push_back({"table", surface, {}});
    models.moves.push_back({0, {0, 1, 2}, vec3(0)});
    pin(models.models[0].body, models.moves[0].nodes);
    models.simulation.colliders.push_back({Plane{vec3(0, 1, 0), -0.5f}});
    Prepared prepared = prepare(models);
    prepared.scene.moves[0].path = {{0, vec3(0), vec3(0)}, {0.1, vec3(0, 0.01f, 0), vec3(0)}};
    Experiment experiment(std::move(prepared));
    for (int f = 0; f < 12; ++f) EXPECT_TRUE(experiment.advance());
    EXPECT_NEAR(place(experiment, 0).y, double(body.positions[0].y) + 0.01, 1e-6);
    EXPECT_EQ(experiment.play().skins().size(), 2u);
}

TEST(Experiment, ABodyOfOtherNodesStartsAtRest) {
    Experiment experiment = going(30);
    experiment.change({"body.1.dims=[9,4,4]"});
    const State state = experiment.play().save()[0];
    ASSERT_EQ(state.positions.size(), 144u);
    for (std::size_t i = 0; i < 144; ++i)
        EXPECT_EQ(vec3(state.positions[i]), experiment.models().models[0].body.positions[i]);
}

// ---- recordings ----

// Pulls, changes, an undo, a return and pins, at odd frames.
Experiment lively() {
    Experiment experiment = going(5);
    for (int f = 0; f < 40; ++f)
        experiment.advance(f % 3 ? pulling(8, vec3(0.09f, 0.001f * float(f), 0)) : Interaction());
    experiment.change({"body.1.damping=4", "body.1.youngs_modulus=30000"});
    Interaction press;
    press.presses.push_back({vec3(0.08f, 0.05f, 0.01f), vec3(0, -0.1f, 0), 0.01f, 200, {0.4, 0.3}, 0.5f});
    for (int f = 0; f < 20; ++f) experiment.advance(press);
    experiment.change({"simulation.integrator=\"midpoint\""});
    experiment.pin(0, {50}, true);
    for (int f = 0; f < 11; ++f) experiment.advance();
    experiment.undo();
    for (int f = 0; f < 3; ++f) experiment.advance();
    experiment.return_to_good();
    for (int f = 0; f < 9; ++f) experiment.advance(pulling(7, vec3(0.1f)));
    return experiment;
}

TEST(Recording, ReplaysToTheSameBits) {
    const Scratch scratch;
    const Experiment original = lively();
    write_recording(original.recording(), scratch / "it.json");
    const Recording recording = read_recording(scratch / "it.json");
    EXPECT_EQ(recording.fingerprint, original.fingerprint());
    Experiment again(prepare(recording.scene, recording.changes));
    int frames = 0;
    while (again.replay(recording)) ++frames;
    EXPECT_EQ(frames, recording.advances);
    EXPECT_EQ(again.fingerprint(), original.fingerprint());
    EXPECT_FALSE(again.replay(recording));
    // And what was replayed is a recording again.
    EXPECT_EQ(again.recording().inputs.size(), recording.inputs.size());
}

TEST(Recording, OfAnotherMotionComesOutOtherwise) {
    Recording recording = lively().recording();
    for (Input& input : recording.inputs)  // all of them, since the return undoes the first
        if (auto* hands = std::get_if<Interaction>(&input.what); hands && !hands->pulls.empty())
            hands->pulls[0].push.to.x += 1e-4f;
    Experiment again(prepare(recording.scene, recording.changes));
    while (again.replay(recording)) {}
    EXPECT_NE(again.fingerprint(), recording.fingerprint);
}

TEST(Recording, AMotionThatBlewUpBlowsUpAgainAndComesBack) {
    Experiment experiment = going(90);
    experiment.change({"simulation.step=" + std::to_string(1.4 * experiment.stable_step(0))});
    for (int f = 0; f < 600 && experiment.trouble().empty(); ++f) experiment.advance();
    ASSERT_FALSE(experiment.trouble().empty());
    const Recording in_trouble = experiment.recording();
    Experiment again(prepare(in_trouble.scene, in_trouble.changes));
    while (again.replay(in_trouble)) {}
    EXPECT_EQ(again.fingerprint(), experiment.fingerprint());
    EXPECT_EQ(again.trouble(), experiment.trouble());
    experiment.return_to_good();
    experiment.change({"simulation.step=\"auto\""});
    for (int f = 0; f < 9; ++f) experiment.advance();
    experiment.pin(0, {40}, true);  // after the last frame
    const Recording recording = experiment.recording();
    Experiment third(prepare(recording.scene, recording.changes));
    while (third.replay(recording)) {}
    EXPECT_EQ(third.fingerprint(), experiment.fingerprint());
    EXPECT_TRUE(third.is_pinned(0, 40));
}

TEST(Recording, WhatIsWrongWithAFileIsSaid) {
    const Scratch scratch;
    auto refused = [&](const std::string& text) {
        write_text(scratch / "bad.json", text);
        const std::string said = refusal([&] { read_recording(scratch / "bad.json"); });
        EXPECT_TRUE(said.empty() || said.find("bad.json") != said.npos) << said;
        return !said.empty();
    };
    EXPECT_TRUE(refused(""));
    EXPECT_TRUE(refused("{"));
    EXPECT_TRUE(refused("[1]"));
    EXPECT_TRUE(refused("{\"palpate-recording\": 2}"));
    EXPECT_TRUE(refused("{\"palpate-recording\": 1}"));
    const std::string head =
        R"({"palpate-recording":1,"scene":{"name":"a","folder":"","text":""},"changes":[],"frames":3,)"
        R"("fingerprint":"","inputs":)";
    EXPECT_FALSE(refused(head + "[]}"));
    EXPECT_TRUE(refused(head + "7}"));
    EXPECT_TRUE(refused(head + "[{}]}"));
    EXPECT_TRUE(refused(head + R"([{"at":2,"return":true},{"at":1,"return":true}]})"));
    EXPECT_TRUE(refused(head + R"([{"at":-1,"return":true}]})"));
    EXPECT_TRUE(refused(head + R"([{"at":1,"press":[{"centre":[0,0]}]}]})"));
    EXPECT_TRUE(refused(
        head + R"([{"at":1,"press":[{"centre":[0,0,0],"velocity":[0,0,1e99],"radius":1,"stiffness":1}]}]})"));
    const std::string press =
        R"([{"at":1,"press":[{"centre":[0,0,0],"velocity":[0,0,1],"radius":1,"stiffness":1)";
    EXPECT_FALSE(refused(head + press + "}]}]}"));  // as before there was friction
    EXPECT_FALSE(refused(head + press + R"(,"friction":[0.3,0.2],"damping":1}]}]})"));
    for (const std::string wrong :
         {R"("friction":[0.2,0.3])", R"("friction":[0.2])", R"("friction":[0.2,-1])", R"("friction":1)",
          R"("damping":-1)", R"("damping":[])"})
        EXPECT_TRUE(refused(head + press + "," + wrong + "}]}]}")) << wrong;
    EXPECT_TRUE(refused(
        head +
        R"([{"at":1,"pull":[{"body":-1,"node":0,"to":[0,0,0],"velocity":[0,0,"x"],"stiffness":1}]}]})"));
}

TEST(Recording, APullOfANodeThatIsNotThereIsRefused) {
    Recording recording = going(3).recording();
    recording.inputs.push_back({0, pulling(4000, vec3(0))});
    Experiment experiment(prepare(recording.scene, recording.changes));
    EXPECT_THROW(experiment.replay(recording), Error);
    recording.inputs[0] = {0, pulling(-1, vec3(0))};
    EXPECT_THROW(Experiment(prepare(recording.scene, recording.changes)).replay(recording), Error);
}

}  // namespace
}  // namespace palpate
