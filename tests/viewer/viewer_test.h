#pragma once
// What tests of the viewer share: one without a window, and what a pointer does in it.
#include "palpate/files/write.h"
#include "palpate/gl/context.h"
#include "palpate/mesh/image.h"
#include "palpate/viewer/viewer.h"
#include "tests/scratch.h"
#include "tests/shapes.h"
#include "tests/viewer/opened.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

namespace palpate {

inline constexpr ivec2 size(320, 240);

class ViewerTest : public testing::Test {
 protected:
    std::optional<Scratch> of_still;
    gl::Context context;
    Viewer viewer{context, size};

    void open(const std::string& scene, std::vector<Change> changes = {}) {
        viewer.open(find_scene(scene), std::move(changes));
        wait_until_open(viewer);
        ASSERT_TRUE(viewer.experiment()) << viewer.message().text;
    }
    // A ball that nothing moves.
    void open_still(std::vector<Change> changes = {}) {
        of_still.emplace();
        write_mesh(ellipsoid(vec3(0.05f), 30), *of_still / "ball.ply");
        viewer.open({"[[surface]]\nname = \"ball\"\nsurface = \"ball.ply\"\n", "ball", *of_still / "."},
                    std::move(changes));
        wait_until_open(viewer);
        ASSERT_TRUE(viewer.experiment()) << viewer.message().text;
    }
    // As in a window, for so long in real time.
    void live(int milliseconds) {
        viewer.advance(1);
        viewer.go_on();
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        viewer.hold_still();
    }
    // N, on the hand, by the bodies.
    float force() {
        const auto& all = viewer.experiment()->play().interaction_forces().presses;
        return all.empty() ? 0 : float(glm::length(all[0]));
    }
    // Where a node of the first body is in the picture.
    vec2 pixel(std::size_t node) {
        return *pixel_of(viewer.camera(), viewer.experiment()->play().nodes(0).positions[node],
                         viewer.view_size());
    }
    vec2 middle() {
        vec3 sum(0);
        const auto positions = viewer.experiment()->play().skins()[0].positions;
        for (vec3 p : positions) sum += p;
        return *pixel_of(viewer.camera(), sum / float(positions.size()), viewer.view_size());
    }
    // With Shift, the left button grasps.
    void drag(vec2 from, vec2 to, int frames, Button button = Button::left) {
        viewer.move_pointer(from);
        viewer.press(button, button == Button::left);
        for (int f = 1; f <= frames; ++f) {
            viewer.move_pointer(glm::mix(from, to, float(f) / float(frames)));
            viewer.advance(1);
        }
    }
    State state() { return viewer.experiment()->play().save()[0]; }
    // How much two pictures differ, of 255; not a number if they have not the same size.
    static double difference(const Image& a, const Image& b) {
        if (a.pixels.size() != b.pixels.size() || a.pixels.empty()) return NAN;
        double sum = 0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i)
            sum += std::abs(int(a.pixels[i]) - int(b.pixels[i]));
        return sum / double(a.pixels.size());
    }
};

}  // namespace palpate
