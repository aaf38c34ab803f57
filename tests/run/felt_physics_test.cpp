// A hand that feels a simulated body and presses it, on a clock of its own: against the same press at rest,
// and against theory.
#include "bench/felt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace palpate {
namespace {

using namespace studies;

TEST(FeltPhysics, AtRestItIsPushedBackAsAPressIsOnTheReference) {
    const FeltBlock block;
    const double depth = 0.005, rest = pressed_at_rest(block, {&depth, 1})[0];
    EXPECT_GT(rest, 0.1);
    for (double slice : {1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 1000})
        for (double rate : {500.0, 1000.0, 2000.0})
            EXPECT_LE(std::abs(felt_at_rest(block, depth, {slice, rate}) / rest - 1), 0.001)
                << slice << " s, " << rate << " Hz";
}

TEST(FeltPhysics, ASlowSwingIsFeltAsAtRest) {
    const std::vector<FeltClock> clocks{{.slice = 1.0 / 240}, {.slice = 1.0 / 1000}};
    for (double frequency : {1.0, 2.0})
        for (const FeltSwing& swing : felt_swings({}, frequency, clocks)) {
            EXPECT_LE(std::abs(swing.amplitude - 1), 0.05) << frequency << " Hz";
            EXPECT_LE(std::abs(swing.ahead), 5) << frequency << " Hz";
        }
}

TEST(FeltPhysics, ANoduleIsFeltTheLessTheDeeperItLies) {
    const double deep = 0.003;
    const FeltStroke without = felt_stroke(palpated, deep);
    const double plain = without.forces[without.forces.size() / 2];
    std::vector<double> over;
    for (double depth : {0.005, 0.010, 0.015}) {
        FeltBlock block = palpated;
        block.nodule = Nodule{.depth = depth};
        over.push_back(excess(felt_stroke(block, deep), without) / plain);
    }
    EXPECT_GE(over[0], 0.15);
    EXPECT_LE(over[1], 0.6 * over[0]);
    EXPECT_LE(over[2], 0.7 * over[1]);
    EXPECT_GE(over[2], 0.02);
}

// What is late by a slice and a tick, is so by no more.
TEST(FeltPhysics, WithoutPassivityControlASwingIsLateByASliceAndATick) {
    const FeltBlock block{.most_damping = 0};
    const std::vector<FeltClock> clocks{
        {.slice = 1.0 / 60}, {.slice = 1.0 / 120}, {.slice = 1.0 / 240}, {.slice = 1.0 / 1000}};
    const std::vector<FeltSwing> swings = felt_swings(block, 2, clocks);
    for (std::size_t c = 0; c < clocks.size(); ++c) {
        const double late = clocks[c].slice + 1 / clocks[c].rate;  // s
        EXPECT_LE(std::abs(swings[c].ahead + 360 * 2 * late), 1) << clocks[c].slice << " s";
        EXPECT_LE(std::abs(swings[c].amplitude - 1), 0.02) << clocks[c].slice << " s";
    }
}

// What passivity control takes from the hand, the body does not learn of.
TEST(FeltPhysics, AFreeBodyGetsTheMomentumThatTheHandFeels) {
    for (double slice : {1.0 / 240, 1.0 / 1000}) {
        const GivenAndFelt with = momentum_of_a_free_block({.slice = slice}),
                           without = momentum_of_a_free_block({.slice = slice}, 0);
        EXPECT_GT(with.given, 0.005);
        EXPECT_LE(std::abs(with.felt / with.given - 1), 0.1) << slice << " s";
        EXPECT_LE(std::abs(without.felt / without.given - 1), 0.005) << slice << " s";
    }
}

TEST(FeltPhysics, WhatTheHandDidNotFeelCanBeGivenBack) {
    for (double slice : {1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 1000}) {
        const GivenAndFelt both = momentum_of_a_free_block({.slice = slice, .gives_back_in = 0.05});
        EXPECT_GT(both.given, 0.005);
        EXPECT_LE(std::abs(both.felt / both.given - 1), 1e-4) << slice << " s";
    }
}

// The default stiffness is half of what is stable, or less, in slices of up to a frame; with passivity
// control or without, and where the body gets back what that takes.
TEST(FeltPhysics, TwiceTheDefaultStiffnessComesToRest) {
    const double control = SafetySettings{}.most_damping;
    for (double modulus : {500.0, 5000.0, 100'000.0})
        for (double slice : {1.0 / 60, 1.0 / 240, 1.0 / 1000})
            for (const FeltHold& hold :
                 {FeltHold{modulus, slice}, {modulus, slice, control}, {modulus, slice, control, 0.05}})
                EXPECT_TRUE(comes_to_rest(hold, 2 * Feel{}.stiffness))
                    << modulus << " Pa, " << slice << " s, " << hold.most_damping << " N s/m, "
                    << hold.gives_back_in << " s";
}

TEST(FeltPhysics, ATouchIsStableUpToTheLinearBoundary) {
    for (const FeltHold& hold : {FeltHold{100'000, 1.0 / 60}, FeltHold{300'000, 1.0 / 240}}) {
        const StiffestTouch found = stiffest_touch(hold);
        EXPECT_LT(found.linear, StiffestTouch::most);
        EXPECT_LE(std::abs(found.measured / found.linear - 1), 0.1) << hold.slice << " s";
    }
}

}  // namespace
}  // namespace palpate
