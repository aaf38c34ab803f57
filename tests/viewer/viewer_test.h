#pragma once
// What tests of the viewer share: one without a window, and what a pointer does in it.
#include "palpate/gl/context.h"
#include "palpate/mesh/image.h"
#include "palpate/viewer/viewer.h"
#include "tests/viewer/opened.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

namespace palpate {

inline constexpr ivec2 size(320, 240);

class ViewerTest : public testing::Test {
 protected:
    gl::Context context;
    Viewer viewer{context, size};

    void open(const std::string& scene, std::vector<Change> changes = {}) {
        viewer.open(find_scene(scene), std::move(changes));
        wait_until_open(viewer);
        ASSERT_TRUE(viewer.experiment()) << viewer.message().text;
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
    void drag(vec2 from, vec2 to, int frames, Button button = Button::left) {
        viewer.move_pointer(from);
        viewer.press(button);
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
