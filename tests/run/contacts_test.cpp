// What a run says about contacts: the table, the report.
#include "palpate/run/contacts.h"

#include "palpate/base/files.h"
#include "palpate/body/pressure_map.h"
#include "palpate/files/image_file.h"
#include "palpate/files/read.h"
#include "palpate/run/play.h"
#include "palpate/run/run.h"
#include "tests/refusal.h"
#include "tests/run/pressed.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>

namespace palpate {
namespace {

// A row by the names of its columns; empty fields are left out.
struct Row {
    std::string tool, body;
    std::map<std::string, double> at;
    dvec3 force() const { return {at.at("force_x_n"), at.at("force_y_n"), at.at("force_z_n")}; }
};

std::vector<std::string> fields_of(const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
    return fields;
}

struct Contacts {
    Report report;
    std::vector<Row> rows;
};

Contacts contacts_of(const Scene& scene) {
    Scratch scratch;
    RunSettings settings;
    settings.contacts = scratch / "contacts.csv";
    Contacts all{run(scene, settings), {}};
    std::istringstream lines(read_text(settings.contacts));
    std::string line;
    std::getline(lines, line);
    const std::vector<std::string> names = fields_of(line);
    while (std::getline(lines, line)) {
        const std::vector<std::string> fields = fields_of(line);
        Row& row = all.rows.emplace_back();
        row.tool = fields[1];
        row.body = fields[2];
        for (std::size_t k = 0; k < fields.size(); ++k)
            if (k != 1 && k != 2 && !fields[k].empty()) row.at[names[k]] = std::stod(fields[k]);
    }
    return all;
}

// A row for each slice of a millisecond or less while the tip is there; their mean over a frame is what the
// report says of that frame.
TEST(Contacts, AreARowASlice) {
    const Contacts all = contacts_of(scene());
    const Report::Tool& finger = all.report.tools[0];
    constexpr std::size_t slices = 17;  // in 1/60 s
    ASSERT_EQ(all.rows.size() % slices, 0u);
    std::size_t frame = 0, frames = 0;
    for (std::size_t first = 0; first < all.rows.size(); first += slices, ++frames) {
        double normal = 0;
        for (std::size_t r = first; r < first + slices; ++r) {
            const Row& row = all.rows[r];
            EXPECT_EQ(row.tool, "finger");
            EXPECT_EQ(row.body, "block");
            if (r > 0)
                EXPECT_LE(
                    std::abs(row.at.at("time_s") - all.rows[r - 1].at.at("time_s") - frame_seconds / slices),
                    1e-7);
            normal += row.at.at("normal_n") / slices;
        }
        while (std::abs(finger.time[frame] - all.rows[first + slices - 1].at.at("time_s")) > 1e-6)
            ASSERT_LT(++frame, finger.time.size());
        EXPECT_LE(std::abs(normal - finger.force[frame]), 0.002 * finger.largest_force) << finger.time[frame];
    }
    EXPECT_GE(frames, 41u);  // 0.4 to 1.1 s
}

// On the block's top, into it, and without friction; as deep and as wide as the report says at most.
TEST(Contacts, AreWhereTheTipIs) {
    const Contacts all = contacts_of(scene());
    const Row& last = all.rows.back();
    const double force = last.at.at("normal_n");
    EXPECT_GT(force, 0.3);
    EXPECT_LE(glm::distance(last.force(), dvec3(0, -force, 0)), 0.01 * force);
    double most = 0, deepest = 0, widest = 0, hardest = 0;
    for (const Row& row : all.rows) {
        most = std::max(most, row.at.at("normal_n"));
        deepest = std::max(deepest, row.at.at("penetration_m"));
        widest = std::max(widest, row.at.at("area_m2"));
        hardest = std::max(hardest, row.at.at("pressure_pa"));
        EXPECT_LE(row.at.at("friction_n"), 0.01 * force);
    }
    // The tip is pressed in by 10 mm: partly the block yields, partly the tip sinks in.
    // What is pressed bends round the tip, so that its middle is higher than its deepest place.
    const double sunk = last.at.at("penetration_m"), above = last.at.at("place_y_m") - (0.05 - 0.01 + sunk);
    EXPECT_GE(above, 0);
    EXPECT_LE(above, 0.0025);
    EXPECT_LE(std::abs(last.at.at("place_x_m") - 0.05) + std::abs(last.at.at("place_z_m") - 0.05), 1e-4);
    EXPECT_LE(std::abs(last.at.at("pressure_pa") / (sunk * 600 / (3.14159265 * 0.012 * 0.012)) - 1), 1e-3);
    const Report::Tool& finger = all.report.tools[0];
    auto expect_same = [](double a, double b) { EXPECT_LE(std::abs(a / b - 1), 1e-6) << a << " " << b; };
    expect_same(finger.largest_normal_force, most);
    expect_same(finger.deepest_penetration, deepest);
    expect_same(finger.largest_area, widest);
    expect_same(finger.largest_pressure, hardest);
}

// The report has them too where no table is asked for, of each frame.
TEST(Contacts, AreInEveryReport) {
    const Report::Tool each = contacts_of(scene()).report.tools[0], framed = run(scene(), {}).tools[0];
    EXPECT_LE(std::abs(framed.largest_normal_force / each.largest_normal_force - 1), 0.02);
    EXPECT_LE(std::abs(framed.deepest_penetration / each.deepest_penetration - 1), 0.05);
    EXPECT_LE(std::abs(framed.largest_pressure / each.largest_pressure - 1), 0.05);
}

// Every tool that presses, and every body: a hand that feels what it presses among them.
TEST(Contacts, AreOfEachToolAndBody) {
    const Scene two = parse_scene(pressed + R"(
[[body]]
name = "other"
dims = [4, 4, 4]
spacing = 0.01
move = [0.3, 0, 0]
youngs_modulus = 8000
density = 1000
damping = 50
pin = { below = 0 }
[[tool]]
name = "hand"
kind = "touch"
radius = 0.01
from = [0.315, 0.3, 0.015]
path = [[0, 0, 0.002, 0], [1, 0, 0.002, 0], [1.2, 0, -0.004, 0], [2, 0, -0.004, 0]]
[[tool]]
name = "thread"
kind = "drag"
path = [[0, 0, 0, 0], [2, 0, 0, 0]]
stiffness = 1
)",
                                  "two.toml", ".");
    const Contacts all = contacts_of(two);
    std::map<std::pair<std::string, std::string>, double> most;
    const double end = all.report.simulated;
    double given = 0;  // N, by the hand in the last frame
    for (const Row& row : all.rows) {
        double& force = most[{row.tool, row.body}];
        force = std::max(force, row.at.at("normal_n"));
        if (row.tool == "hand" && row.at.at("time_s") > end - frame_seconds + 1e-6)
            given += row.at.at("normal_n") / 17;
    }
    ASSERT_EQ(most.size(), 4u);
    EXPECT_GT((most[{"finger", "block"}]), 0.3);
    EXPECT_GT((most[{"hand", "other"}]), 0.01);
    EXPECT_EQ((most[{"finger", "other"}]), 0);
    EXPECT_EQ((most[{"hand", "block"}]), 0);
    EXPECT_GT(all.report.tools[1].largest_normal_force, 0.01);
    EXPECT_EQ(all.report.tools[2].largest_normal_force, 0);
    // What the hand feels, it gives.
    EXPECT_LE(std::abs(given / all.report.tools[1].force.back() - 1), 0.1);
}

// The same block of finer cells, so that the tip presses more than a few of its vertices.
Scene fine_scene(std::vector<Change> changes = {}) {
    changes.insert(changes.end(), {"body.block.dims=[21, 11, 21]", "body.block.spacing=0.005"});
    return scene(changes);
}

// A pad across the tip that covers the contact measures the force; one that stands on its edge next to
// nothing.
TEST(Contacts, AddUpOnAPad) {
    const std::string side =
        "tool.finger.pad={ width = [0.03, 0, 0], height = [0, 0, 0.03], columns = 3, rows = 2 }";
    const Contacts all = contacts_of(fine_scene({side}));
    for (const Row& row : all.rows) {
        double sum = 0;
        for (const auto& [name, value] : row.at)
            if (name.starts_with("taxel_")) sum += value * 0.03 * 0.03 / 6;
        EXPECT_LE(std::abs(sum - row.at.at("normal_n")), 1e-3 * all.report.tools[0].largest_normal_force)
            << row.at.at("time_s");
    }
    const auto& last = all.rows.back().at;
    EXPECT_GT(last.at("taxel_1_2_pa"), 3 * last.at("taxel_1_1_pa"));  // in the middle of the columns,
    EXPECT_LE(std::abs(last.at("taxel_2_2_pa") / last.at("taxel_1_2_pa") - 1), 0.05);  // between the rows
    EXPECT_FALSE(last.contains("taxel_3_1_pa"));
    const Scene other =
        fine_scene({side, "tool.finger.pad.width=[0.03, 0, 0]", "tool.finger.pad.height=[0, 0.03, 0]"});
    for (const Row& row : contacts_of(other).rows)
        EXPECT_LE(std::abs(row.at.at("taxel_1_2_pa")), 0.02 * row.at.at("pressure_pa"));  // edgeways
}

TEST(Contacts, ASurfaceHasItsPressures) {
    Scratch scratch;
    RunSettings settings;
    settings.surface = scratch / "pressed.ply";
    settings.contacts = scratch / "contacts.csv";
    settings.frames = 60;
    const Scene pressing = fine_scene();
    settings.sequence = scratch / "s.ply";
    const Report report = run(pressing, settings);
    EXPECT_EQ(read_text(scratch / "s-0031.ply"), read_text(settings.surface));
    const std::string ply = read_text(settings.surface);
    EXPECT_NE(ply.find("property float pressure\n"), std::string::npos);
    EXPECT_EQ(read_mesh(settings.surface, Units::metres).positions.size(), report.bodies[0].vertices);
    // The same from a play, whose pressures add up to the force.
    const Models made = build(pressing);
    Report again;
    Play play(pressing, made, again);
    for (int frame = 0; frame < 60; ++frame) ASSERT_TRUE(play.advance(frame * frame_seconds, frame_seconds));
    ASSERT_EQ(play.contacts().size(), 1u);
    const ToolContact& contact = play.contacts()[0];
    const Skin& skin = play.skins()[0];
    const std::vector<float> pressures = play.pressures(0);
    dvec3 sum(0);
    float most = 0;
    for (const PressedVertex& one :
         pressed_vertices(skin.positions, *skin.triangles, contact.press, contact.push())) {
        sum += one.force;
        most = std::max(most, float(one.pressure));
        EXPECT_LE(std::abs(pressures[one.vertex] - one.pressure), 1e-3);
    }
    EXPECT_LE(std::abs(glm::dot(sum, contact.end.normal) - contact.normal()), 1e-9);
    EXPECT_EQ(*std::ranges::max_element(pressures), most);
    // Less than on the nodes, whose areas are those at rest: the surface is stretched over the tip.
    EXPECT_LE(most, contact.end.pressure());
    EXPECT_GE(most, 0.7 * contact.end.pressure());
    settings.contacts.clear();
    run(pressing, settings);
    EXPECT_EQ(read_text(settings.surface).find("pressure"), std::string::npos);
}

// Where the tip presses, and nowhere before it has come; the tip itself is not in the way.
TEST(Contacts, AreShownAsColours) {
    Scratch scratch;
    auto yellow = [&](int frames) {  // pixels of the scale's lighter half
        RunSettings settings;
        settings.frames = frames;
        settings.image_every = 1;
        settings.width = 160;
        settings.height = 120;
        settings.images = scratch / std::to_string(frames);
        run(fine_scene({"body.block.shade=\"pressure\"", "camera.eye=[0.05, 0.4, 0.06]"}), settings);
        const Image image =
            read_image(settings.images / (frames < 60 ? "block-00.00s.png" : "block-01.00s.png"));
        int count = 0;
        for (std::size_t i = 0; i < image.pixels.size(); i += 4)
            count += image.pixels[i] > image.pixels[i + 2] + 60;
        return count;
    };
    try {
        EXPECT_EQ(yellow(1), 0);
        EXPECT_GT(yellow(61), 20);
    } catch (const Error& error) {
        if (std::string(error.what()).find("OpenGL") == std::string::npos) throw;
        GTEST_SKIP() << "not available: " << error.what();
    }
}

TEST(Contacts, AreRefusedWhereThereAreNone) {
    Scratch scratch;
    RunSettings settings;
    settings.contacts = scratch / "x.csv";
    Scene no_tool = scene();
    no_tool.tools.clear();
    expect_refused("no tool that presses a body", [&] { run(no_tool, settings); });
    settings.contacts = scratch / "x.txt";
    expect_refused("name it " + (scratch / "x.csv").string(), [&] { run(scene(), settings); });
    EXPECT_EQ(scratch.entries(), 0u);
}

}  // namespace
}  // namespace palpate
