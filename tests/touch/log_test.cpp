#include "palpate/touch/log.h"

#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "tests/refusal.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace palpate {
namespace {

const std::string head =
    "# palpate log 2\n# device a hand\n# rate 1000\n"
    "now,time,x,y,z,qw,qx,qy,qz,buttons,placed,fx,fy,fz,tx,ty,tz\n";
const std::string old_head =
    "# palpate log 1\n# device a hand\n# rate 1000\nnow,time,x,y,z,buttons,placed,fx,fy,fz\n";

std::string refusal(const std::string& text) {
    return palpate::refusal([&] { parse_log(text, "bad.csv"); });
}

TEST(Log, ReadsBackToTheBit) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> any(-1, 1);
    std::uniform_real_distribution<double> whole(-1, 1);
    Log log{.device = "two\nlines", .rate = 1000.0 / 3, .ticks = {}};
    double now = 1e5 / 3;
    for (int i = 0; i < 1000; ++i) {
        auto vector = [&] { return vec3(any(random), any(random) * 1e-30f, any(random) * 1e30f); };
        now += 1e-3 * (1 + any(random));
        const Pose pose{{whole(random), whole(random) * 1e-300, whole(random) * 1e300},
                        {whole(random), whole(random), whole(random), whole(random)}};
        log.ticks.push_back({now, {pose, now - 1e-4, unsigned(random()), unsigned(i)}, {vector(), vector()}});
    }
    using Limits = std::numeric_limits<float>;
    log.ticks[3].wrench.force = {Limits::denorm_min(), Limits::max(), Limits::lowest()};
    log.ticks[4].wrench.torque = {Limits::min(), 3 * Limits::denorm_min(), Limits::epsilon()};
    const Scratch folder;
    write_log(folder / "log.csv", log);
    const Log back = read_log(folder / "log.csv");
    EXPECT_EQ(back.device, "two lines");
    EXPECT_EQ(back.rate, log.rate);
    ASSERT_EQ(back.ticks.size(), log.ticks.size());
    for (std::size_t i = 0; i < back.ticks.size(); ++i) {
        const Tick &a = log.ticks[i], &b = back.ticks[i];
        EXPECT_EQ(a.now, b.now);
        EXPECT_EQ(a.state.time, b.state.time);
        EXPECT_EQ(a.state.pose, b.state.pose);
        EXPECT_EQ(a.state.buttons, b.state.buttons);
        EXPECT_EQ(a.state.placed, b.state.placed);
        EXPECT_EQ(a.wrench, b.wrench);
    }
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(Log, ABrokenDeviceIsWrittenDownAsItWas) {
    const Scratch folder;
    Log log;
    log.ticks.push_back({1, {{dvec3(NAN, INFINITY, -0.0)}, 0.5}, {}});
    write_log(folder / "log.csv", log);
    const dvec3 back = read_log(folder / "log.csv").ticks.at(0).state.pose.place;
    EXPECT_TRUE(std::isnan(back.x));
    EXPECT_EQ(back.y, INFINITY);
    EXPECT_TRUE(back.z == 0 && std::signbit(back.z));
}

TEST(Log, ForeignLineEndsAndBlankLinesAreRead) {
    const Log log = parse_log(
        "# palpate log 2\r\n# device a hand\r\n# rate 500\r\n"
        "now,time,x,y,z,qw,qx,qy,qz,buttons,placed,fx,fy,fz,tx,ty,tz\r\n"
        "1,1,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0\r\n\r\n"
        "1.5,1,0.25,0,0,0,0.6,0,0.8,1,2,0,0,-3,0,0.125,0",
        "log.csv");
    EXPECT_EQ(log.rate, 500);
    ASSERT_EQ(log.ticks.size(), 2u);
    EXPECT_EQ(log.ticks[1].state.pose, (Pose{{0.25, 0, 0}, {0, 0.6, 0, 0.8}}));
    EXPECT_EQ(log.ticks[1].wrench, (Wrench{{0, 0, -3}, {0, 0.125f, 0}}));
}

// Of version 1, which had no turns, and places in single precision: what was said then is what is read.
TEST(Log, OldOnesAreRead) {
    const Log log = parse_log(old_head + "1,1,0.1,0,0,3,2,0,0,-3\n", "old.csv");
    ASSERT_EQ(log.ticks.size(), 1u);
    EXPECT_EQ(log.ticks[0].state.pose, Pose{dvec3(vec3(0.1f, 0, 0))});
    EXPECT_EQ(log.ticks[0].state.buttons, 3u);
    EXPECT_EQ(log.ticks[0].wrench, (Wrench{{0, 0, -3}}));
}

TEST(Log, BadFilesAreOneLineThatNamesTheirs) {
    const std::string row = "1,1,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0\n", old_row = "1,1,0,0,0,0,0,0,0,0\n";
    const std::pair<std::string, std::string> cases[] = {
        {"", "line 1 is not \"# palpate log \" in bad.csv"},
        {"# palpate log 3\n", "line 1 is a version that is not 1 or 2"},
        {"# palpate log 10\n", "line 1 is a version that is not 1 or 2"},
        {"# palpate log 1\n", "line 2 is not \"# device \""},
        {"# palpate log 2\n# device d\n# rate fast\n", "line 3 is not a number"},
        {"# palpate log 2\n# device d\n# rate 0\n", "line 3 has a rate that is not above 0"},
        {"# palpate log 1\n# device d\n# rate nan\n", "line 3 has a rate that is not above 0"},
        {"# palpate log 1\n# device d\n# rate 1 kHz\n", "line 3 is not a number"},
        {"# palpate log 1\n# device d\n# rate 1\nt,x\n", "line 4 is not \"now,time,x,y,z,buttons"},
        {"# palpate log 2\n# device d\n# rate 1\nt,x\n", "line 4 is not \"now,time,x,y,z,qw"},
        {head + row + old_row, "line 6 is not 17 numbers"},
        {head + "1,1,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0\n", "line 5 is not 17 numbers"},
        {head + row + "1,1,0,0,0,1,0,0,0,0,-1,0,0,0,0,0,0\n", "line 6 is not 17 numbers"},
        {head + row + "2,1,0,0,x,1,0,0,0,0,0,0,0,0,0,0,0\n", "line 6 is not 17 numbers"},
        {head + row + "2,1,0,0,1e999,1,0,0,0,0,0,0,0,0,0,0,0\n", "line 6 is not 17 numbers"},
        {head + row + "0.5,1,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0\n", "line 6 goes back in time"},
        {head + row.substr(0, 7), "line 5 is not 17 numbers"},
        {old_head + "1,1,0,0,0,0,0,0,0\n", "line 5 is not 10 numbers"},
        {old_head + old_row + row, "line 6 is not 10 numbers"},
        {old_head + old_row + "2,1,0,0,1e99,0,0,0,0,0\n", "line 6 is not 10 numbers"},
        {old_head + "inf,1,0,0,0,0,0,0,0,0\n", "line 5 has a time that is not a number"},
        {old_head + "1,nan,0,0,0,0,0,0,0,0\n", "line 5 has a time that is not a number"},
        {std::string(100, '\0'), "line 1 is not"},
    };
    for (const auto& [text, expected] : cases) {
        const std::string said = refusal(text);
        EXPECT_NE(said.find(expected), said.npos) << said << "\n    for\n" << text;
        EXPECT_NE(said.find("docs/devices.md"), said.npos);
    }
    EXPECT_THROW(read_log("/nowhere/log.csv"), Error);
}

TEST(Log, AnyDamageIsAnErrorOrALog) {
    std::string sound = head;
    for (int i = 0; i < 20; ++i)
        sound += std::to_string(i) + ".25,1e-3,0.1,-2,3,1,0,0,0,4,5,1e10,7,8,9,10,11\n";
    std::mt19937 random(3);
    for (int i = 0; i < 3000; ++i) {
        std::string text = sound;
        for (int damages = 0; damages < 3; ++damages) text[random() % text.size()] = char(random());
        text.resize(random() % text.size());
        try {
            for (const Tick& tick : parse_log(text, "damaged").ticks) EXPECT_TRUE(std::isfinite(tick.now));
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
    }
}

}  // namespace
}  // namespace palpate
