// Springs and cells are cut out while a body swings: on every machine the rest goes on as it was, to the bit,
// and as a body does that was made like that.
#include "palpate/body/edit.h"
#include "palpate/gl/context.h"
#include "tests/gl/with_context.h"
#include "tests/refusal.h"
#include "tests/shapes.h"
#include "tests/solver/agreement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace palpate {
namespace {

Body organ() {
    Body body = lattice(ellipsoid({0.05f, 0.03f, 0.04f}, 12), {.nodes = 500, .material = of_springs});
    for (std::size_t i = 0; i < body.count(); i += 9) body.inverse_mass[i] = 0;
    return body;
}

Body stiff_sheet() {
    Body body = cloth({9, 8}, 0.01f, linen);
    body.terms.push_back(bending(body, 2e-4f));
    return body;
}

// Springs near one another, and with `cells` some cells.
Edit edit_of(const Body& body, bool with_cells, unsigned seed) {
    std::mt19937 random(seed);
    Edit edit;
    const auto ends = spring_ends(body);
    for (int i = 0; i < 9 && !ends.empty(); ++i) edit.links.push_back(ends[random() % ends.size()]);
    for (int i = 0; with_cells && !body.cells.empty() && i < 5; ++i)
        edit.cells.push_back(int(random() % body.cells.size()));
    return edit;
}

double whole_mass(const Body& body) {
    double sum = 0;
    for (float inverse : body.inverse_mass)
        if (inverse > 0) sum += 1.0 / inverse;
    return sum;
}

TEST(Edits, OfCellsLeaveTheLatticeOfTheRest) {
    // A box without its last layer is a smaller box: the same shares, masses and outside.
    Body body = lattice({5, 4, 6}, 0.01f, of_springs);
    const Body whole = body, smaller = lattice({5, 4, 5}, 0.01f, of_springs);
    Edit edit;
    for (int c = 0; c < int(body.cells.size()); ++c)
        if (whole.at[std::size_t(whole.cells[std::size_t(c)][0])].z == 4) edit.cells.push_back(c);
    const BodyChange change = apply(body, edit);
    EXPECT_FALSE(change.same_nodes());
    EXPECT_EQ(body.positions, smaller.positions);
    EXPECT_EQ(body.grid()->shares, smaller.grid()->shares);
    EXPECT_EQ(body.at, smaller.at);
    EXPECT_EQ(body.cells, smaller.cells);
    EXPECT_EQ(body.area, smaller.area);
    for (std::size_t i = 0; i < body.count(); ++i)
        EXPECT_NEAR(body.inverse_mass[i] / smaller.inverse_mass[i], 1, 1e-6);
    check(body);
    for (int node : change.nodes) EXPECT_GE(body.at[std::size_t(node)].z, 4);
}

TEST(Edits, HoldOnBodiesOfAnyKind) {
    for (auto [name, body] : odd_bodies()) {
        SCOPED_TRACE(name);
        const double mass = whole_mass(body);
        for (unsigned round = 0; round < 8; ++round) {
            const std::size_t before = spring_ends(body).size();
            const Edit edit = edit_of(body, !body.cells.empty(), round);
            const BodyChange change = apply(body, edit);
            check(body);
            EXPECT_TRUE(spring_ends(body).size() < before || before == 0);
            for (const auto& cell : body.cells)
                for (std::size_t k = 0; k < 8; ++k) ASSERT_GE(cell[k], 0);
            if (body.cells.empty()) EXPECT_TRUE(change.same_nodes());
        }
        EXPECT_LE(whole_mass(body), mass * 1.000001);
    }
}

// A hinge goes with any edge of its two triangles, and with its nodes; the flexion between its tips is no
// edge.
TEST(Edits, HingesGoWithTheirTriangles) {
    Body body = cloth({3, 2}, 0.01f, linen);
    body.terms.push_back(bending(body, 1));
    auto hinges = [&] { return std::get<Bending>(body.terms[1]).hinges; };
    ASSERT_EQ(hinges().size(), 3u);  // two diagonals, and the edge between the squares from node 1 to 4
    apply(body, {.links = {{0, 5}, {3, 1}}, .cells = {}});
    EXPECT_EQ(hinges().size(), 3u);
    const BodyChange change = apply(body, {.links = {{0, 1}}, .cells = {}});
    ASSERT_EQ(hinges().size(), 1u);
    EXPECT_EQ(hinges()[0].from, 1);
    EXPECT_EQ(hinges()[0].to, 5);
    EXPECT_EQ(change.nodes, (std::vector{0, 1, 3, 4, 5}));

    // On a box, whose cells take nodes with them.
    body = lattice({3, 2, 2}, 0.01f, of_springs);
    body.terms.push_back(Bending{{{0, 1, 3, 6, 1}, {1, 2, 4, 7, 1}, {4, 1, 5, 3, 1}}});
    ASSERT_EQ(body.cells.size(), 2u);
    apply(body, {.links = {}, .cells = {0}});
    ASSERT_EQ(hinges().size(), 1u);
    EXPECT_EQ(body.positions[std::size_t(hinges()[0].to)], vec3(0.02f, 0, 0));
    check(body);
}

TEST(Edits, WhatIsNotThereIsRefused) {
    Body body = organ();
    const Body before = body;
    EXPECT_NE(refusal([&] { apply(body, {.links = {{0, 100000}}, .cells = {}}); }), "");
    EXPECT_NE(refusal([&] { apply(body, {.links = {}, .cells = {-1}}); }), "");
    EXPECT_EQ(body.terms, before.terms);
}

// A vertex whose cell went stays where it is at rest, and all others to the bit.
TEST(Edits, LeaveASurfaceWhereItWas) {
    Body body = organ();
    const Mesh surface = ellipsoid({0.05f, 0.03f, 0.04f}, 24);
    Embedding skin = embed(surface, body, Mapping::trilinear);
    std::vector<vec3> before, after, normals;
    deform(skin, {body.positions, {}}, before, normals);
    const BodyChange change = apply(body, edit_of(body, true, 3));
    ASSERT_TRUE(rehang(skin, body, change));
    deform(skin, {body.positions, {}}, after, normals);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LE(glm::distance(before[i], after[i]), 1e-7f);
    Embedding other = embed(surface, body, Mapping::constant);
    EXPECT_NE(refusal([&] { rehang(other, body, change); }), "");  // it hangs on the body of now
}

class Changes : public ::testing::TestWithParam<Backend> {
 protected:
    void SetUp() override {
        if (!on_gpu(GetParam())) return;
        try {
            context_.emplace();
        } catch (const Error& error) {
            GTEST_SKIP() << "OpenGL is not available: " << error.what();
        }
    }
    const gl::Context* context() const { return context_ ? &*context_ : nullptr; }
    std::optional<gl::Context> context_;
};
INSTANTIATE_TEST_SUITE_P(Every, Changes,
                         ::testing::Values(Backend::reference, Backend::cpu, Backend::feedback,
                                           Backend::fragment, Backend::compute),
                         [](const auto& one) { return std::string(name_of(one.param)); });

TEST_P(Changes, KeepTheStateToTheBit) {
    for (const bool with_cells : {false, true})
        for (const Body& body : {organ(), lattice({6, 5, 7}, 0.01f, of_springs), without_grid(organ()),
                                 stiff_sheet(), lattice({6, 5, 7}, 0.01f, of_tissue)}) {
            const Simulation how{.backend = GetParam(), .step = 2e-4, .force = true};
            auto swinging = make_solver(body, how, context());
            swinging->step(0.01);
            for (unsigned round = 0; round < 3; ++round) {
                const Body was = swinging->body();
                const State before = swinging->save();
                const Edit edit = edit_of(was, with_cells && !was.cells.empty(), round);
                const BodyChange change = swinging->change(edit);
                const State after = swinging->save();
                ASSERT_EQ(after.positions.size(), change.node_before.size());
                EXPECT_EQ(after.lag, before.lag);
                for (std::size_t i = 0; i < after.positions.size(); ++i) {
                    const auto old = std::size_t(change.node_before[i]);
                    ASSERT_EQ(after.positions[i], before.positions[old]);
                    ASSERT_EQ(after.velocities[i], before.velocities[old]);
                }
                // And goes on as a body that was made like that.
                auto fresh = make_solver(swinging->body(), how, context());
                fresh->restore(after);
                const NodePush push{.node = 5, .force = {0, 0, 0.01f}};
                const Press press{swinging->nodes().positions[3] + vec3(0, 0, 0.005f), vec3(0), 0.008f, 5};
                for (auto* solver : {swinging.get(), fresh.get()})
                    ASSERT_FALSE(
                        solver->step(0.004, {.presses = {&press, 1}, .pushes = {&push, 1}}).diverged);
                EXPECT_TRUE(swinging->save().positions == fresh->save().positions);
                EXPECT_TRUE(swinging->save().velocities == fresh->save().velocities);
                EXPECT_TRUE(std::ranges::equal(swinging->nodes().normals, fresh->nodes().normals));
            }
            EXPECT_NE(refusal([&] { swinging->change({.links = {{0, 1u << 30}}, .cells = {}}); }), "");
        }
}

}  // namespace
}  // namespace palpate
