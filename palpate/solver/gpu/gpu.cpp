#include "palpate/solver/gpu/gpu.h"

#include "palpate/gl/context.h"
#include "palpate/gl/program.h"
#include "palpate/gl/visit.h"
#include "palpate/solver/check.h"
#include "palpate/solver/gpu/answers.h"
#include "palpate/solver/gpu/pipeline.h"
#include "palpate/solver/gpu/placement.h"
#include "palpate/solver/gpu/world.h"
#include "palpate/solver/schedule.h"

#include <algorithm>
#include <cassert>
#include <optional>

namespace palpate {
namespace {

using namespace gpu;

const char* closing_comp =
#include "embedded/closing.comp.h"
    ;
const char* touch_comp =
#include "embedded/touch.comp.h"
    ;

constexpr int group = 64;          // as in the compute shaders
constexpr int nodes_each = 16;     // of one invocation of closing.comp
constexpr int most_adders = 1024;  // invocations of touch.comp
constexpr int row = 1024;          // of a flat texture

int groups(int invocations) { return (invocations + group - 1) / group; }

std::unique_ptr<Pipeline> make_pipeline(Backend backend, const Text& text) {
    switch (backend) {
        case Backend::fragment:
            return make_fragment(text);
        case Backend::compute:
            return make_compute(text);
        default:
            return make_feedback(text);
    }
}

gl::Program compute_program(const Text& text, const char* file, const char* stage) {
    const std::string whole = text.physics + stage;
    return gl::Program({{GL_COMPUTE_SHADER, file, whole}});
}

const gl::Context& current_one(std::optional<gl::Context>& own, const gl::Context* given) {
    const gl::Context& context = given ? *given : own.emplace();
    context.make_current();
    return context;
}

class Gpu final : public Solver {
 public:
    Gpu(const Body& body, const Simulation& simulation, double frequency, const gl::Context* context,
        std::optional<bool> tiles)
        : context_(current_one(own_, context)),
          body_(body),
          simulation_(simulation),
          scheme_(scheme(simulation.integrator)),
          frequency_(frequency),
          placement_(body_),
          width_(simulation.backend == Backend::fragment ? row : 0),
          world_(body_, simulation_, placement_),
          tiled_(simulation.backend == Backend::compute && tiles.value_or(!context_.software())),
          alone_(make_pipeline(simulation.backend, text(false, tiled_))),
          closing_(compute_program(text(false, false), "closing.comp", closing_comp)),
          quiet_(make_pass(body_, simulation_)),
          shown_positions_(gl::Buffer::room(body_.count() * sizeof(vec4))),
          shown_normals_(gl::Buffer::room(body_.count() * sizeof(vec4))),
          adders_(std::clamp(groups(int(placement_.rim.size())) * group, group, most_adders)),
          answers_(context_, adders_) {
        for (Where where : {current, between, further, sum})
            if (needs(scheme_, where) || (where == further && scheme_.stages.size() > 1))
                states_[where].emplace(make_state());
        if (simulation.contact > 0 || simulation.pull > 0) touched();  // before it has to be quick
        if (adds_up()) next_sum_.emplace(make_state());
        for (int i = 0; i < (simulation_.late ? 2 : 1); ++i) pasts_.push_back({make_state(), 0, {}, {}});
        restore({std::vector<dvec3>(body_.positions.begin(), body_.positions.end()),
                 std::vector<dvec3>(body_.count(), dvec3(0)), 0});
    }

    ~Gpu() override { context_.make_current_or_not(); }

    Stats step(double seconds, const Influences& influences) override {
        check(seconds, influences, body_, simulation_);
        context_.make_current();
        const gl::Visit visit;
        Stats stats = about_to_do(influences, seconds, longest_.under(influences));
        remember();
        world_.guide(influences.moves, seconds);
        const Touched* tools = influences.presses.empty() && influences.drags.empty() ? nullptr : &touched();
        Pipeline& pipeline = tools ? *tools->pipeline : *alone_;
        if (tools) answers_.clear_impulses();
        world_.bind();
        Pass constant = quiet_;
        constant.wind = vec4(influences.wind, simulation_.air);
        for (std::size_t d = 0; d < influences.drags.size(); ++d)
            constant.dragged[d / 4][int(d % 4)] = placement_.slot[std::size_t(influences.drags[d].node)];
        const Call call{scheme_, simulation_, influences, body_.damping, stats.step, stats.steps, lag_};
        call.for_each_pass(constant, [&](const Pass& pass, const Turn& turn) {
            world_.upload(pass);
            look_at(*states_[turn.at]);
            if (tools && turn.impulse > 0) add_impulses(*tools, turn.impulse);
            run(pipeline, turn);
        });
        lag_ = call.lag_after();
        world_.arrive(influences.moves);
        close();
        answers_.ask(stats, influences);
        return simulation_.late ? settle_all_but_one(stats) : settle();
    }

    void undo() override {
        if (history_ < 1) refuse_undo(body_);
        context_.make_current();
        const gl::Visit visit;
        if (answers_.pending() > 0) answers_.drop_newest();
        go_back(1);
    }

    double frequency() const override { return frequency_; }

    double longest_step(const Influences& influences) const override { return longest_.under(influences); }

    Nodes nodes() const override {
        if (!published_) publish();
        return {positions_, normals_};
    }

    GpuNodes gpu_nodes() const override {
        return {shown_positions_.name(), shown_normals_.name(), 0, body_.count(), bounds_};
    }

    State state() const override {
        State state = save();
        if (lag_ > 0) {
            state.lag = 0;
            const std::vector<vec4> velocities = velocities_now();
            for (std::size_t i = 0; i < body_.count(); ++i)
                state.velocities[i] = dvec3(velocities[std::size_t(placement_.slot[i])]);
        }
        return state;
    }

    State save() const override {
        context_.make_current();
        const std::vector<vec4> positions = read(states_[current]->positions),
                                velocities = read(states_[current]->velocities);
        State state;
        for (int slot : placement_.slot) {
            state.positions.push_back(dvec3(positions[std::size_t(slot)]));
            state.velocities.push_back(dvec3(velocities[std::size_t(slot)]));
        }
        state.lag = lag_;
        return state;
    }

    void restore(const State& state) override {
        check(state, body_);
        context_.make_current();
        const gl::Visit visit;
        std::vector<vec4> positions(std::size_t(placement_.slots), vec4(0, 0, 0, -1)), velocities(positions);
        for (std::size_t i = 0; i < body_.count(); ++i) {
            const auto slot = std::size_t(placement_.slot[i]);
            positions[slot] = vec4(vec3(state.positions[i]), body_.inverse_mass[i]);
            velocities[slot] = vec4(vec3(state.velocities[i]), float(world_.guide_of(i)));
        }
        world_.stand(state);
        for (auto& one :
             states_) {  // all of them, because what lies between the nodes has to be there in each
            if (!one) continue;
            one->positions.put(std::as_bytes(std::span(positions)));
            one->velocities.put(std::as_bytes(std::span(velocities)));
        }
        lag_ = state.lag;
        if (lag_ > 0 && !scheme_.staggered) {  // a staggered scheme's state: this one wants velocities of now
            velocities = velocities_now();
            states_[current]->velocities.put(std::as_bytes(std::span(velocities)));
            lag_ = 0;
        }
        answers_.drop_all();
        history_ = 0;
        world_.bind();
        close();
        answers_.ask({}, {});
        bounds_ = answers_.oldest().bounds;
    }

    std::size_t memory() const override {
        std::size_t bytes = world_.bytes();
        auto add = [&](const Moving& moving) {
            bytes += moving.positions.bytes() + moving.velocities.bytes();
        };
        for (const auto& state : states_)
            if (state) add(*state);
        if (next_sum_) add(*next_sum_);
        return bytes;
    }

 private:
    // What a call began with.
    struct Past {
        Moving state;
        double lag;
        std::vector<vec3> guided;
        Bounds bounds;  // as known then
    };

    // What is needed where tools act.
    struct Touched {
        std::unique_ptr<Pipeline> pipeline;
        gl::Program impulses;
    };
    const Touched& touched() {
        if (!touched_)
            touched_ = Touched{make_pipeline(simulation_.backend, text(true, tiled_)),
                               compute_program(text(true, false), "touch.comp", touch_comp)};
        return *touched_;
    }
    Text text(bool with_tools, bool tiled) const {
        return physics(body_, simulation_, placement_, width_, with_tools, tiled);
    }

    bool adds_up() const { return needs(scheme_, sum); }

    Moving make_state() const {
        const auto slots = std::size_t(placement_.slots);
        return {gl::Field(GL_RGBA32F, sizeof(vec4), slots, width_),
                gl::Field(GL_RGBA32F, sizeof(vec4), slots, width_)};
    }

    // ---- a pass ----

    void look_at(const Moving& moving) const {
        moving.positions.bind(0);
        moving.velocities.bind(1);
    }

    // No pass writes what it reads: the last of several writes `further`, which then is the current state.
    void run(Pipeline& pipeline, const Turn& turn) {
        const bool over = turn.next == current;
        const Moving &now = *states_[turn.at],
                     &start = turn.start == sum ? *states_[sum] : *states_[turn.start];
        const Moving& next = *states_[over ? further : turn.next];
        const Moving& total = turn.opens || !adds_up() ? now : *states_[sum];
        pipeline.pass({now, start, states_[current]->positions, total, next, adds_up() ? *next_sum_ : next});
        const bool sums_now = adds_up() && turn.start != sum;
        if (sums_now) std::swap(*states_[sum], *next_sum_);
        const bool single = scheme_.stages.size() == 1;
        if (over || single) std::swap(*states_[current], *states_[over ? further : between]);
    }

    // The positions before the last step, which the last pass has left behind.
    const gl::Field& before_last_step() const {
        return states_[scheme_.stages.size() == 1 ? between : further]->positions;
    }

    void add_impulses(const Touched& tools, double seconds) const {
        tools.impulses.use();
        tools.impulses.set("seconds", float(seconds));
        tools.impulses.set("count", int(placement_.rim.size()));
        world_.bind_rim(9);
        answers_.bind_impulses();
        glDispatchCompute(GLuint(adders_ / group), 1, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    }

    // ---- after a call ----

    void close() {
        look_at(*states_[current]);
        before_last_step().bind(9);
        world_.upload(quiet_);
        closing_.use();
        closing_.set("count", int(body_.count()));
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, shown_positions_.name());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, shown_normals_.name());
        answers_.bind_findings();
        const int each = (int(body_.count()) + nodes_each - 1) / nodes_each;
        if (each > 0) glDispatchCompute(GLuint(groups(each)), 1, 1);
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                        GL_BUFFER_UPDATE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
        published_ = false;
    }

    Stats settle() {
        Answer answer = answers_.oldest();
        bounds_ = answer.bounds;
        if (!answer.stats.diverged) return answer.stats;
        const int calls = answers_.pending() + 1;
        answers_.drop_all();
        go_back(calls);
        return undone(answer.stats);
    }

    // The stats of the call before; of this one what is known already.
    Stats settle_all_but_one(const Stats& known) {
        Stats stats;
        if (answers_.pending() > 1) stats = settle();
        stats.steps = known.steps;
        stats.step = known.step;
        stats.late = true;
        return stats;
    }

    // ---- the past ----

    void remember() {
        std::rotate(pasts_.begin(), pasts_.end() - 1, pasts_.end());
        Past& past = pasts_.front();
        past.state.positions.copy(states_[current]->positions);
        past.state.velocities.copy(states_[current]->velocities);
        past.lag = lag_;
        past.guided = world_.guided();
        past.bounds = bounds_;
        history_ = std::min(history_ + 1, int(pasts_.size()));
    }

    void go_back(int calls) {
        assert(calls <= history_);
        const Past& past = pasts_[std::size_t(calls - 1)];
        states_[current]->positions.copy(past.state.positions);
        states_[current]->velocities.copy(past.state.velocities);
        lag_ = past.lag;
        world_.stand(past.guided);
        bounds_ = past.bounds;
        std::rotate(pasts_.begin(), pasts_.begin() + calls, pasts_.end());
        history_ -= calls;
        world_.bind();
        close();
    }

    // ---- for the host ----

    std::vector<vec4> read(const gl::Field& field) const {
        std::vector<vec4> values(std::size_t(placement_.slots));
        field.get(context_, std::as_writable_bytes(std::span(values)));
        return values;
    }

    // Velocities by slots at the time of the positions: half a kick brings them up.
    std::vector<vec4> velocities_now() const {
        context_.make_current();
        const gl::Visit visit;
        Pass pass = quiet_;
        pass.kick = float(lag_ / (1 + body_.damping * lag_));
        world_.bind();
        world_.upload(pass);
        const Moving &at = *states_[current],
                     &free = *states_[scheme_.stages.size() == 1 ? between : further];
        look_at(at);
        alone_->pass({at, at, at.positions, at, free, adds_up() ? *next_sum_ : free});
        return read(free.velocities);
    }

    void publish() const {
        context_.make_current();
        std::vector<vec4> values(body_.count());
        for (auto [buffer, to] :
             {std::pair(&shown_positions_, &positions_), std::pair(&shown_normals_, &normals_)}) {
            context_.read(buffer->name(), std::as_writable_bytes(std::span(values)));
            to->assign(values.begin(), values.end());
        }
        published_ = true;
    }

    std::optional<gl::Context> own_;  // first, because all the rest lives in it
    const gl::Context& context_;
    const Body body_;
    const Simulation simulation_;
    const Scheme& scheme_;
    const double frequency_;  // rad/s, the highest of the body with nothing touching it
    mutable LongestStep longest_{body_, simulation_, frequency_};
    const Placement placement_;
    const int width_;  // of flat textures; 0: buffers
    World world_;
    const bool tiled_;
    std::unique_ptr<Pipeline> alone_;  // with no tools
    gl::Program closing_;
    std::optional<Touched> touched_;
    const Pass quiet_;                 // nothing touches or moves it
    std::optional<Moving> states_[4];  // Where
    std::optional<Moving> next_sum_;
    std::vector<Past> pasts_;                     // the newest first
    int history_ = 0;                             // how many of them are true
    gl::Buffer shown_positions_, shown_normals_;  // of the nodes in their order
    int adders_;                                  // invocations that add up impulses
    Answers answers_;
    double lag_ = 0;  // s, how far the velocities are behind the positions
    Bounds bounds_;
    mutable std::vector<vec3> positions_, normals_;  // what nodes() shows
    mutable bool published_ = false;
};

}  // namespace

std::unique_ptr<Solver> make_gpu(const Body& body, const Simulation& simulation, double frequency,
                                 const gl::Context* context, std::optional<bool> tiles) {
    check(body, simulation);
    std::optional<gl::Visit> visit;  // in a context of its own nobody else is
    if (context) {
        context->make_current();
        visit.emplace();
    }
    return std::make_unique<Gpu>(body, simulation, frequency, context, tiles);
}

}  // namespace palpate
