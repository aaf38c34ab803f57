#include "palpate/viewer/views.h"

#include "palpate/base/clock.h"
#include "palpate/run/framing.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

constexpr float usual = 1.3f;  // the aspect ratio for which scenes choose their angles
constexpr double calm = 0.4;   // s without motion, after which a picture is drawn in full

// Two pictures side by side.
Image beside_each_other(const Image& left, const Image& right) {
    Image both{left.width + right.width, left.height, {}};
    for (int row = 0; row < left.height; ++row)
        for (const Image* one : {&left, &right}) {
            const auto from = one->pixels.begin() + 4 * std::ptrdiff_t(row) * one->width;
            both.pixels.insert(both.pixels.end(), from, from + 4 * one->width);
        }
    return both;
}

// The camera of one eye; both look at the same point, a thirtieth of its distance apart.
Camera eye_of(Camera camera, float side) {
    const vec3 to = camera.look_at - camera.eye;
    const vec3 right = glm::cross(to, camera.up);
    if (glm::length(right) > 0) camera.eye += side * glm::length(to) / 60 * glm::normalize(right);
    return camera;
}

}  // namespace

Views::Views(const gl::Context& context, ivec2 size, const Session& session, const Options& options)
    : context_(context),
      session_(session),
      options_(options),
      size_(glm::max(size, ivec2(1))),
      pane_(context, size_),
      other_pane_(context, ivec2(16)) {}

void Views::resize(ivec2 size, int left) {
    if (size.x < 1 || size.y < 1) return;  // minimised: nothing is drawn until it has a size again
    size_ = size;
    left_ = left;
}

ivec2 Views::view_size() const {
    const bool halved = options_.stereo || session_.beside();
    return glm::max(halved ? ivec2(size_.x / 2, size_.y) : size_, ivec2(1));
}

Camera Views::camera() const {
    Camera camera = orbit.camera();
    const float aspect = float(view_size().x) / float(view_size().y);
    if (aspect >= usual) return camera;
    const float slope =
        std::tan(0.5f * glm::radians(std::clamp(camera.angle, 1.0f, 170.0f))) * usual / aspect;
    camera.angle = 2 * glm::degrees(std::atan(slope));
    return camera;
}

Sight Views::sight(vec2 pixel) const {
    const ivec2 view = view_size();
    if (view.x < size_.x && pixel.x >= float(view.x)) pixel.x -= float(view.x);
    return {camera(), view, pixel};
}

void Views::go_home() {
    const Experiment& experiment = *session_.experiment();
    orbit = Orbit(camera_of(experiment.scene(), experiment.models(), usual));
}

void Views::wake() { moved_ = now(); }

Quality Views::quality(bool may_be_draft) const {
    if (!may_be_draft || options_.care == Care::full) return {};
    const bool hurry = context_.software() && now() - moved_ < calm;
    return options_.care == Care::draft || hurry ? draft_quality : Quality{};
}

void Views::look(const Traces& traces, bool always, bool may_be_draft) {
    const Drawing as{options_.look, view_size(), quality(may_be_draft)};
    const bool is_drawn = options_.paused && drawn_ > moved_ && !options_.stereo && drawn_as_ == as;
    if (!always && is_drawn) return;
    look(as.quality, traces);
    drawn_as_ = as;
}

void Views::look(const Quality& quality, const Traces& traces) {
    const Experiment &experiment = *session_.experiment(), *beside = session_.beside();
    is_due_ = true;
    looked_ = now();
    is_first_ |= drawn_of_ != experiment.shapes();
    drawn_of_ = experiment.shapes();
    pane_.resize(view_size());
    pane_.set(quality);
    pane_.look(experiment, camera(), options_.look, traces);
    other_is_shown_ = beside != nullptr;
    if (!beside) return;
    other_pane_.resize(view_size());
    other_pane_.set(quality);
    other_pane_.look(*beside, camera(), options_.look, traces);
}

std::optional<float> Views::draw() {
    const double start = now();
    if (is_due_) {
        draw_panes();
        drawn_ = looked_;
    }
    pane_.show({left_, 0});
    if (other_is_shown_) other_pane_.show({left_ + view_size().x, 0});
    context_.finish();
    is_due_ = false;
    if (std::exchange(is_first_, false)) return std::nullopt;  // computing the ambient occlusion took time
    return float(1000 * (now() - start));
}

// Stereo uses the left view's renderer twice, so its picture is copied at once.
void Views::draw_panes() {
    if (is_stereo()) {
        pane_.draw(eye_of(camera(), 1));
        pane_.show({left_ + view_size().x, 0});
        return pane_.draw(eye_of(camera(), -1));
    }
    pane_.draw(camera());
    if (other_is_shown_) other_pane_.draw(camera());
}

Image Views::image(const Traces& traces) {
    drawn_ = 0;  // the panes no longer hold what the window shows
    look(Quality{}, traces);
    draw_panes();
    const Image left = pane_.image();
    if (other_is_shown_) return beside_each_other(left, other_pane_.image());
    if (!is_stereo()) return left;
    pane_.draw(eye_of(camera(), 1));
    return beside_each_other(left, pane_.image());
}

}  // namespace palpate
