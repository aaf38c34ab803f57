#include "app/viewer/viewer.h"

#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/mesh/write.h"
#include "palpate/run/framing.h"
#include "palpate/run/notes.h"
#include "palpate/run/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

namespace palpate {
namespace {

constexpr float usual = 1.3f;           // times as wide as high, for which scenes choose their angles
constexpr double calm = 0.4;            // s without motion, after which a picture is drawn in full
constexpr long frames_per_picture = 2;  // of a film: 30 pictures a second
const vec3 hand_colour(0.95f, 0.6f, 0.1f), proxy_colour(0.1f, 0.45f, 0.85f);

Change all_cores() {
    return fmt::format("simulation.threads={}", std::clamp(std::thread::hardware_concurrency(), 1u, 8u));
}

std::vector<Change> changes_for(const Compared& compared, const Scene& scene) {
    std::vector<Change> changes;
    if (compared.with == Compared::With::backend)
        changes.push_back(fmt::format("simulation.backend=\"{}\"", name_of(compared.backend)));
    if (compared.with == Compared::With::mapping)
        for (std::size_t b = 0; b < scene.bodies.size(); ++b)
            changes.push_back(fmt::format("body.{}.mapping=\"{}\"", b + 1, name_of(compared.mapping)));
    return changes;
}

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

float Recent::mean() const {
    float sum = 0;
    for (std::size_t i = 0; i < count_; ++i) sum += at(i);
    return count_ > 0 ? sum / float(count_) : 0;
}

float Recent::most() const {
    float most = 0;
    for (std::size_t i = 0; i < count_; ++i) most = std::max(most, at(i));
    return most;
}

Viewer::Viewer(const gl::Context& context, ivec2 size)
    : context_(context),
      size_(glm::max(size, ivec2(1))),
      pane_(context, size_),
      other_pane_(context, ivec2(16)) {}

Viewer::~Viewer() {
    attempt([&] { finish_film(); });
}

void Viewer::say(const std::string& text, bool bad) { message_ = {text, bad, now()}; }

// What a person asks for may fail, and the window goes on. False if it did.
bool Viewer::attempt(const std::function<void()>& what) noexcept {
    try {
        what();
        return true;
    } catch (const std::bad_alloc&) {
        say("not enough memory in this machine; use fewer nodes or faces", true);
    } catch (const std::exception& error) {
        say(error.what(), true);
    }
    return false;
}

// A change of what moves; the scene beside it goes on from there. Not in a recording that is replayed.
void Viewer::alter(const std::function<void()>& how, const std::string& said) {
    if (!experiment_) return;
    if (replay_) return say("a recording is replayed; press R to begin anew");
    const bool done = attempt([&] {
        how();
        compared_ = {};
        moved_ = now();
    });
    if (done && !said.empty()) say(said);
}

void Viewer::let_go() {
    holds_.clear();
    active_.reset();
    device_hold_.reset();
    drag_ = Drag::none;
    denting_ = false;
}

// ---- what is open ----

// On all cores unless told otherwise: the motion is the same, and drawing waits for it.
void Viewer::open(SceneText source, std::vector<Change> changes) {
    coming_.reset();
    const bool told = std::ranges::any_of(
        changes, [](const Change& change) { return change.starts_with("simulation.threads="); });
    if (!told) changes.push_back(all_cores());
    import_ = std::make_unique<Import>(std::move(source), std::move(changes));
}

void Viewer::open_file(const std::filesystem::path& file) noexcept {
    attempt([&] {
        if (file.extension() == ".json")
            replay(read_recording(file));
        else
            open(find_scene(std::filesystem::absolute(file).string()));
    });
}

void Viewer::replay(Recording recording) {
    import_ = std::make_unique<Import>(recording.scene, recording.changes);
    coming_ = std::move(recording);
}

void Viewer::cancel_import() {
    if (!import_) return;
    import_->cancel();
    say("stopped opening " + import_->name() + " as soon as it notices");
}

void Viewer::take_import() {
    if (!import_ || !import_->done()) return;
    const std::unique_ptr<Import> done = std::move(import_);
    if (done->cancelled()) return say("stopped opening " + done->name());
    attempt([&] { begin(done->take()); });
}

void Viewer::begin(Prepared prepared) {
    auto experiment = std::make_unique<Experiment>(std::move(prepared), &context_);
    drop_feeling_hand();
    let_go();
    beside_.reset();
    compared_ = {};
    replay_ = std::exchange(coming_, std::nullopt);
    experiment_ = std::move(experiment);
    frames_ = 0;
    shapes_shown_ = -1;
    simulated_before_ = mapped_before_ = 0;
    readings_ = {};
    selected_.clear();
    const Scene& scene = experiment_->scene();
    orbit_ = Orbit(camera_of(scene, experiment_->models(), usual));
    const Bounds box = bounds_of(experiment_->play().skins());
    options.tip = box.empty() ? 0.01f : std::clamp(0.05f * glm::length(box.size()), 0.002f, 0.5f);
    for (const ToolRecipe& tool : scene.tools)
        if (tool.kind != ToolKind::drag) options.tip = tool.radius;
    options.paused = false;
    std::string opened = (replay_ ? "replaying " : "opened ") + experiment_->source().name;
    for (const std::string& note : notes_before(scene, experiment_->models())) opened += "\n" + note;
    say(opened);
}

// ---- the scene beside it ----

void Viewer::follow_compared() {
    if (replay_) options.compared = {};
    if (options.compared == compared_ || !experiment_) return;
    compared_ = options.compared;
    moved_ = now();
    beside_.reset();
    attempt([&] {
        const std::vector<Change> changes = changes_for(compared_, experiment_->scene());
        if (!changes.empty()) beside_ = experiment_->beside(changes);
    });
    if (!beside_) options.compared = compared_ = {};
}

// ---- changes ----

void Viewer::change(const std::vector<Change>& changes, bool again) {
    alter([&] { experiment_->change(changes, again); });
}

void Viewer::undo() {
    if (const Stroke* stroke = last_dent()) {
        feeling_->touch().forget(stroke->number);
        strokes_.resize(std::size_t(stroke - strokes_.data()));
        moved_ = now();
        return say("the dent is gone");
    }
    if (experiment_ && experiment_->can_undo()) alter([&] { experiment_->undo(); }, "undone");
}

void Viewer::redo() {
    if (experiment_ && experiment_->can_redo()) alter([&] { experiment_->redo(); }, "done again");
}

void Viewer::restart() {
    replay_.reset();
    let_go();
    alter([&] { experiment_->restart(); }, "from the beginning");
    strokes_.clear();
    if (feeling_) feeling_->begin_anew();
}

void Viewer::return_to_good() {
    if (!experiment_ || !experiment_->can_return()) return;
    if (!replay_) let_go();
    alter([&] { experiment_->return_to_good(); }, "as it was a moment ago");
    if (feeling_) feeling_->expect_jump();
}

void Viewer::step_once() {
    options.paused = true;
    if (experiment_) one_frame();
}

// ---- going on ----

void Viewer::advance(int frames) {
    take_import();
    if (!experiment_) return;
    if (std::erase_if(holds_, [&](const Hold& hold) { return !hold.fits(*experiment_); }) > 0) {
        active_.reset();  // whichever it was
        drag_ = Drag::none;
    }
    follow_compared();
    for (int f = 0; f < frames && !options.paused && (replay_ || experiment_->trouble().empty()); ++f)
        one_frame();
    attempt([&] { feel(); });
    const double time = now();
    if (measured_ > 0) measure(time - measured_);
    measured_ = time;
}

void Viewer::one_frame() {
    const bool done = attempt([&] { replay_ ? replay_frame() : live_frame(); });
    if (!done) {  // it would fail again
        replay_.reset();
        options.paused = true;
    }
    moved_ = now();
    ++frames_;
    if (film_ && frames_ % frames_per_picture == 0) add_film_frame();
}

void Viewer::replay_frame() {
    if (experiment_->replay(*replay_)) return;
    const bool same = experiment_->fingerprint() == replay_->fingerprint;
    say(same ? "replayed to the end, the same to the bit"
             : "replayed to the end, but the state is another: another backend, other files, or another "
               "version?",
        !same);
    replay_.reset();
    options.paused = true;
}

void Viewer::live_frame() {
    follow_device();
    Hands hands;
    for (Hold& hold : holds_) hold.add_to(hands);
    if (device_hold_) device_hold_->add_to(hands);
    experiment_->advance(hands);
    if (!experiment_->trouble().empty())
        say(experiment_->trouble() + "; it is held where it was last sound", true);
    if (!beside_ || !beside_->trouble().empty()) return;
    beside_->advance(hands);
    if (!beside_->trouble().empty()) say("on the right, " + beside_->trouble(), true);
}

void Viewer::measure(double seconds) {
    const Report& report = experiment_->report();
    auto spent = [](double sum, double& before) {
        const double more = std::max(sum - before, 0.0);
        before = sum;
        return float(1000 * more);
    };
    if (options.paused) return;
    readings_.simulate.add(spent(report.seconds.simulate, simulated_before_));
    readings_.map.add(spent(report.seconds.map, mapped_before_));
    readings_.pace.add(float(std::max(experiment_->time() - paced_, 0.0) / std::max(seconds, 1e-6)));
    paced_ = experiment_->time();
    readings_.largest_speed = 0;
    for (const Stats& stats : experiment_->play().stats())
        readings_.largest_speed = std::max(readings_.largest_speed, stats.largest_speed);
    if (frames_ % 15 != 0) return;
    readings_.memory = experiment_->play().memory();
    readings_.energy.reset();  // from a GPU the nodes would have to be read
    if (!on_gpu(experiment_->models().simulation.backend)) readings_.energy = experiment_->energy();
}

// ---- pictures ----

ivec2 Viewer::view_size() const {
    const bool halved = options.stereo || beside_;
    return glm::max(halved ? ivec2(size_.x / 2, size_.y) : size_, ivec2(1));
}

Camera Viewer::camera() const {
    Camera camera = orbit_.camera();
    const float aspect = float(view_size().x) / float(view_size().y);
    if (aspect >= usual) return camera;
    const float slope =
        std::tan(0.5f * glm::radians(std::clamp(camera.angle, 1.0f, 170.0f))) * usual / aspect;
    camera.angle = 2 * glm::degrees(std::atan(slope));
    return camera;
}

void Viewer::resize(ivec2 size, int left) {
    if (size.x < 1 || size.y < 1) return;  // minimised: nothing is drawn until it has a size again
    size_ = size;
    left_ = left;
}

std::vector<Viewer::Arrow> Viewer::arrows() const {
    std::vector<Arrow> arrows;
    if (!experiment_) return arrows;
    std::size_t press = 0, pull = 0;
    for (const Hold& hold : holds()) {
        const dvec3 force = hold.force(experiment_->play().pushes(), hold.presses() ? press : pull);
        arrows.push_back({hold.place(), vec3(force)});
        (hold.presses() ? press : pull) += hold.presses() ? 1 : hold.pulls();
    }
    if (feeling_ && options.mode == Mode::dent) {
        const Felt& felt = feeling_->felt();
        if (glm::length(felt.force) > 0) arrows.push_back({felt.proxy, felt.force});
    }
    return arrows;
}

Traces Viewer::traces() const {
    Traces traces;
    for (const Hold& hold : holds()) {
        if (hold.presses()) {
            traces.balls.push_back({hold.place(), hold.radius(), hand_colour});
            continue;
        }
        traces.balls.push_back({hold.place(), 0.25f * options.tip, hand_colour});
        traces.lines.push_back(uvec2(traces.points.size(), traces.points.size() + 1));
        traces.points.insert(traces.points.end(), {hold.held(experiment_->play()), hold.place()});
    }
    if (!feeling_ || options.mode != Mode::dent) return traces;
    const Felt& felt = feeling_->felt();
    const vec3 hand(felt.pose.place);
    // A small one, or it would hide the dent; the controls draw a ring as large as the tip.
    traces.balls.push_back({felt.proxy, 0.25f * options.tip, proxy_colour});
    if (glm::distance(hand, felt.proxy) > 0.05f * options.tip) {
        traces.balls.push_back({hand, 0.2f * options.tip, hand_colour});
        traces.lines.push_back(uvec2(traces.points.size(), traces.points.size() + 1));
        traces.points.insert(traces.points.end(), {felt.proxy, hand});
    }
    for (std::size_t s = 0; s < experiment_->play().skins().size(); ++s)
        traces.dents.push_back(felt.dents_of(int(s)));
    return traces;
}

Quality Viewer::quality() const {
    if (film_ || options.care == Care::full) return {};
    const bool hurry = context_.software() && now() - moved_ < calm;
    return options.care == Care::draft || hurry ? draft_quality : Quality{};
}

// Whether the last picture is still right: nothing moves, and it is to look the same.
bool Viewer::is_drawn(const Drawing& as) const {
    return options.paused && drawn_ > moved_ && !feeling_ && !options.stereo && !film_ && drawn_as_ == as;
}

void Viewer::draw() {
    if (!experiment_) return;
    const double start = now();
    const int shown = shapes_shown_;
    const Drawing as{options.look, view_size(), quality()};
    if (!is_drawn(as)) {
        draw_views(as.quality);
        drawn_ = start;
        drawn_as_ = as;
    }
    pane_.show({left_, 0});
    if (beside_) other_pane_.show({left_ + view_size().x, 0});
    context_.finish();
    // Not the first one of a mesh, which finds out how deep its grooves are.
    if (shown == shapes_shown_ && !options.paused) readings_.draw.add(float(1000 * (now() - start)));
}

// Stereo shows the left view's renderer twice; the other picture goes beside it at once.
void Viewer::draw_views(const Quality& quality) {
    shapes_shown_ = experiment_->shapes();
    const Traces traces = this->traces();
    pane_.resize(view_size());
    pane_.set(quality);
    if (options.stereo && !beside_) {
        pane_.draw(*experiment_, eye_of(camera(), 1), options.look, traces);
        pane_.show({left_ + view_size().x, 0});
        pane_.draw(*experiment_, eye_of(camera(), -1), options.look, traces);
        return;
    }
    pane_.draw(*experiment_, camera(), options.look, traces);
    if (!beside_) return;
    other_pane_.resize(view_size());
    other_pane_.set(quality);
    other_pane_.draw(*beside_, camera(), options.look, traces);
}

Image Viewer::image() {
    drawn_ = 0;  // what the views hold then is not what the window shows
    if (!experiment_) return {};
    draw_views({});
    Image left = pane_.image();
    if (beside_) return beside_each_other(left, other_pane_.image());
    if (!options.stereo) return left;
    pane_.draw(*experiment_, eye_of(camera(), 1), options.look, traces());
    return beside_each_other(left, pane_.image());
}

// ---- files ----

std::filesystem::path Viewer::free_name(const std::filesystem::path& in, const std::string& ending) const {
    const std::string stem = std::filesystem::path(experiment_->source().name).stem().string();
    std::error_code error;
    for (int number = 1;; ++number) {
        const std::filesystem::path name = in / fmt::format("{}-{}{}", stem, number, ending);
        if (!std::filesystem::exists(name, error)) return name;
    }
}

// Beside the scene itself, from where the files that it names are found.
void Viewer::save_scene() {
    if (!experiment_) return;
    attempt([&] {
        const std::filesystem::path name = free_name(experiment_->source().folder, ".toml");
        std::vector<Change> changes = experiment_->changes();
        std::erase(changes, all_cores());  // this machine's, not the scene's
        write_text(name, changed(experiment_->source(), changes));
        say("saved the scene as " + name.lexically_normal().string());
    });
}

void Viewer::save_picture() {
    if (!experiment_) return;
    attempt([&] {
        const std::filesystem::path name = free_name(folder, ".png");
        write_png(image(), name);
        say("saved a picture as " + name.string());
    });
}

void Viewer::save_surface() {
    if (!experiment_) return;
    attempt([&] {
        const std::vector<Skin>& skins = experiment_->play().skins();
        std::string names;
        for (const Skin& skin : skins) {
            const std::filesystem::path name = free_name(folder, ".ply");
            write_mesh({skin.positions, skin.normals, *skin.triangles}, name);
            names += (names.empty() ? "" : ", ") + name.string();
        }
        say("saved the surface as " + names);
    });
}

void Viewer::save_recording() {
    if (!experiment_) return;
    attempt([&] {
        const std::filesystem::path name = free_name(folder, ".json");
        write_recording(experiment_->recording(), name);
        say("saved all inputs since the beginning as " + name.string() + "; drop it here to replay it");
    });
}

void Viewer::start_or_stop_film() {
    if (!experiment_) return;
    attempt([&] {
        if (film_) return finish_film();
        const std::filesystem::path name = free_name(folder, ".mp4");
        const Image first = image();
        auto film = std::make_unique<Film>(name, first.width, first.height, 60 / int(frames_per_picture));
        film->add(first);
        film_ = std::move(film);
        film_name_ = name;
        film_size_ = {first.width, first.height};
        say("filming; V again ends it");
    });
}

void Viewer::finish_film() {
    if (!film_) return;
    const std::unique_ptr<Film> film = std::move(film_);
    film->finish();
    say("saved the film as " + film_name_.string());
}

void Viewer::add_film_frame() {
    const bool done = attempt([&] {
        const Image next = image();
        if (ivec2(next.width, next.height) == film_size_) return film_->add(next);
        finish_film();
        say("the film ended where the picture got another size, and is saved as " + film_name_.string(),
            true);
    });
    if (!done) film_.reset();
}

}  // namespace palpate
