// The stiffest stable wall: of a whole Touch against the linear sampled-data system (bench/walls.h), and the
// defaults against both.
#include "bench/walls.h"
#include "palpate/touch/device.h"
#include "palpate/touch/safety.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate {
namespace {

using namespace studies;

// Without damping of the wall and stiffness of the hand the boundary is known: K = 2 c / T, where the hand's
// damping dissipates what the wall's spring generates by half a tick of lag. A delay adds to that lag.
TEST(Stability, TheLinearBoundaryIsThatOfTextbooks) {
    for (double rate : {1000.0, 4000.0})
        for (int delay : {0, 1, 2, 7}) {
            Wall wall{.damping = 0, .rate = rate};
            wall.hand = {.stiffness = 1e-6, .delay = delay / rate};
            const double known = 2 * rate * wall.hand.damping / (1 + 2 * delay);
            EXPECT_LE(std::abs(stiffest_linear(wall) / known - 1), 0.02) << rate << " Hz, " << delay;
        }
}

// Within the half percent of the search, and as much again because the motion is watched for a limited time.
TEST(Stability, ATouchIsStableUpToTheLinearBoundary) {
    for (double rate : {500.0, 1000.0, 2000.0})
        for (double damping : {0.0, 1.0, 30.0, 200.0}) {
            const Wall wall{.damping = damping, .rate = rate};
            EXPECT_LE(std::abs(stiffest_measured(wall) / stiffest_linear(wall) - 1), 0.01)
                << rate << " Hz, damping " << damping;
        }
}

TEST(Stability, SoItIsInOtherHands) {
    std::mt19937 random(7);
    auto any = [&](double low, double high) {
        return low * std::pow(high / low, std::uniform_real_distribution<>(0, 1)(random));
    };
    for (int i = 0; i < 8; ++i) {
        Wall wall{.damping = any(0.1, 10), .rate = any(500, 3000)};
        wall.hand = {.mass = any(0.1, 1),
                     .damping = any(2, 10),
                     .stiffness = any(50, 300),
                     .resolution = i % 2 ? 3e-5 : 0,
                     .delay = any(2e-4, 3e-3)};
        EXPECT_LE(std::abs(stiffest_measured(wall) / stiffest_linear(wall) - 1), 0.02)
            << "mass " << wall.hand.mass << ", damping " << wall.hand.damping << " and " << wall.damping
            << ", delay " << wall.hand.delay << ", " << wall.rate << " Hz";
    }
}

// A passive wall is stable in any hand, and so in this one.
TEST(Stability, WhatIsPassiveIsStable) {
    for (double rate : {500.0, 1000.0, 2000.0})
        for (double damping : {0.0, 0.5, 1.0, 3.0, 6.0}) {
            const Wall wall{.damping = damping, .rate = rate};
            EXPECT_LE(stiffest_passive(wall), 1.001 * stiffest_linear(wall)) << rate << ' ' << damping;
        }
}

TEST(Stability, ThePassivityObserverAddsToIt) {
    for (double damping : {0.0, 1.0, 10.0}) {
        const Wall wall{.damping = damping};
        EXPECT_GE(stiffest_measured(wall, SafetySettings{}.most_damping), 1.05 * stiffest_measured(wall))
            << damping;
    }
}

// The default stiffness, and that to which a usual device limits stiffer surfaces.
TEST(Stability, TheDefaultsAreAtMostHalfTheBoundary) {
    const Wall wall;
    for (double stiffness : {Feel{}.stiffness, 0.5 * double(DeviceSpec{}.stiffness)}) {
        EXPECT_LE(stiffness, 0.5 * stiffest_linear(wall));
        EXPECT_LE(stiffness, 0.5 * stiffest_measured(wall));
        EXPECT_LE(stiffness, 0.5 * stiffest_passive(wall));
    }
}

}  // namespace
}  // namespace palpate
