#include "palpate/gl/context.h"
#include "palpate/gl/program.h"
#include "palpate/gl/visit.h"
#include "palpate/solver/machine.h"
#include "palpate/solver_gl/answers.h"
#include "palpate/solver_gl/body_on_gpu.h"
#include "palpate/solver_gl/pipeline.h"
#include "palpate/solver_gl/placement.h"

#include <algorithm>
#include <optional>

namespace palpate {
namespace {

using namespace gpu;

const char* cells_comp =
#include "embedded/cells.comp.h"
    ;
const char* closing_comp =
#include "embedded/closing.comp.h"
    ;
const char* touch_comp =
#include "embedded/touch.comp.h"
    ;

constexpr int nodes_each = 16;     // of one invocation of closing.comp
constexpr int most_adders = 1024;  // invocations of touch.comp
constexpr int row = 1024;          // of a flat texture

int groups(int invocations) { return (invocations + group_size - 1) / group_size; }

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

class Gpu final : public Machine {
 public:
    Gpu(const Body& body, const Simulation& simulation, const gl::Context* context, std::optional<bool> tiles)
        : context_(current_one(own_, context)),
          body_(body),
          simulation_(simulation),
          scheme_(scheme(simulation.integrator)),
          placement_(body_),
          width_(simulation.backend == Backend::fragment ? row : 0),
          on_gpu_(body_, simulation_, placement_),
          tiled_(simulation.backend == Backend::compute && tiles.value_or(!context_.software())),
          alone_(make_pipeline(simulation.backend, text(Tools::none, tiled_))),
          closing_(compute_program(text(Tools::none, false), "closing.comp", closing_comp)),
          quiet_(make_pass(body_, simulation_)),
          shown_positions_(gl::Buffer::room(body_.count() * sizeof(vec4))),
          shown_normals_(gl::Buffer::room(body_.count() * sizeof(vec4))),
          adders_(std::clamp(groups(int(placement_.rim.size())) * group_size, group_size, most_adders)),
          answers_(context_, adders_) {
        for (StateBuffer where : {current, between, further, sum})
            if (needs(scheme_, where) || (where == further && scheme_.stages.size() > 1))
                states_[where].emplace(make_state());
        if (adds_up()) next_sum_.emplace(make_state());
        before_.emplace(make_state());
        if (tissue_of(body_))
            cells_.emplace(Cells{compute_program(text(Tools::none, false), "cells.comp", cells_comp),
                                 gl::Field(GL_RGBA32F, sizeof(vec4), 8 * body_.cells.size(), 0)});
    }

    ~Gpu() override { context_.make_current_or_not(); }

    bool change(std::span<const int> nodes) override {
        return placement_.grid && body_.terms.size() == 1 && on_gpu_.change(body_, placement_, nodes);
    }

    Findings run(const Call& call) override {
        context_.make_current();
        const gl::Visit visit;
        const Influences& influences = call.influences;
        on_gpu_.lead(call.guides);
        const bool touches = !influences.presses.empty() || !influences.pushes.empty();
        const Touched* tools = touches ? &touched(call.constant.resistance > 0) : nullptr;
        Pipeline& pipeline = tools ? *tools->pipeline : *alone_;
        on_gpu_.bind();
        if (tools) {
            answers_.clear_impulses(influences);
            on_gpu_.push(call.pushes, influences.pushes);
        }
        call.for_each_pass([&](const Pass& pass, const PassPlan& plan) {
            on_gpu_.upload(pass);
            if (tools) on_gpu_.place(plan.tips);
            look_at(*states_[plan.at]);
            if (pass.kick > 0) work_out_cells();
            if (tools && plan.impulse > 0) add_impulses(*tools, call, plan);
            run(pipeline, plan);
        });
        return close(influences, call.origin.after(call.steps * call.step), call.step);
    }

    void put(const State& state, const Origin& origin) override {
        context_.make_current();
        const gl::Visit visit;
        std::vector<vec4> positions(std::size_t(placement_.slots), vec4(0, 0, 0, -1)), velocities(positions);
        for (std::size_t i = 0; i < body_.count(); ++i) {
            const auto slot = std::size_t(placement_.slot[i]);
            positions[slot] = vec4(vec3(state.positions[i]), body_.inverse_mass[i]);
            velocities[slot] = vec4(vec3(state.velocities[i]), float(on_gpu_.guide_of(i)));
        }
        for (auto& one :
             states_) {  // all of them, because what lies between the nodes has to be there in each
            if (!one) continue;
            one->positions.put(std::as_bytes(std::span(positions)));
            one->velocities.put(std::as_bytes(std::span(velocities)));
        }
        on_gpu_.bind();
        close({}, origin);
    }

    void shift(dvec3 place, dvec3 velocity) override {
        context_.make_current();
        const gl::Visit visit;
        Pass pass = quiet_;
        pass.place_shift = vec4(vec3(place), 1);
        pass.speed_shift = vec4(vec3(velocity), 0);
        std::swap(*states_[current], write_beside(pass));
    }

    State get() const override {
        context_.make_current();
        const std::vector<vec4> positions = read(states_[current]->positions),
                                velocities = read(states_[current]->velocities);
        State state;
        for (int slot : placement_.slot) {
            state.positions.push_back(dvec3(positions[std::size_t(slot)]));
            state.velocities.push_back(dvec3(velocities[std::size_t(slot)]));
        }
        return state;
    }

    void remember() override {
        context_.make_current();
        before_->positions.copy(states_[current]->positions);
        before_->velocities.copy(states_[current]->velocities);
    }

    void bring_back(const Origin& origin) override {
        context_.make_current();
        const gl::Visit visit;
        states_[current]->positions.copy(before_->positions);
        states_[current]->velocities.copy(before_->velocities);
        on_gpu_.bind();
        close({}, origin);
    }

    std::vector<dvec3> kicked(const Pass& pass) const override {
        context_.make_current();
        const gl::Visit visit;
        const std::vector<vec4> by_slots = read(write_beside(pass).velocities);
        std::vector<dvec3> velocities;
        for (int slot : placement_.slot) velocities.emplace_back(by_slots[std::size_t(slot)]);
        return velocities;
    }

    void show(const Origin&, std::vector<vec3>& positions, std::vector<vec3>& normals) const override {
        context_.make_current();
        std::vector<vec4> values(body_.count());
        for (auto [buffer, to] :
             {std::pair(&shown_positions_, &positions), std::pair(&shown_normals_, &normals)}) {
            context_.read(buffer->name(), std::as_writable_bytes(std::span(values)));
            to->assign(values.begin(), values.end());
        }
    }

    GpuNodes gpu_nodes() const override {
        return {shown_positions_.name(), shown_normals_.name(), 0, body_.count(), bounds_};
    }

    std::size_t memory() const override {
        std::size_t bytes = on_gpu_.bytes();
        auto add = [&](const Moving& moving) {
            bytes += moving.positions.bytes() + moving.velocities.bytes();
        };
        for (const auto& state : states_)
            if (state) add(*state);
        if (next_sum_) add(*next_sum_);
        if (cells_) bytes += cells_->forces.bytes();
        return bytes;
    }

 private:
    // What is needed of tissue.
    struct Cells {
        gl::Program program;
        gl::Field forces;  // of each cell on its corners, N
    };
    // In the state that is looked at.
    void work_out_cells() const {
        if (!cells_) return;
        cells_->program.use();
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, cell_forces_buffer, cells_->forces.buffer());
        glDispatchCompute(GLuint(groups(placement_.slots)), 1, 1);
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
        cells_->forces.bind(cell_forces_unit);
    }

    // What is needed where tools act.
    struct Touched {
        std::unique_ptr<Pipeline> pipeline;
        gl::Program impulses;
    };
    const Touched& touched(bool resists) {
        std::optional<Touched>& made = resists ? resisted_ : touched_;
        const Tools tools = resists ? Tools::resisting : Tools::pushing;
        if (!made)
            made = Touched{make_pipeline(simulation_.backend, text(tools, tiled_)),
                           compute_program(text(tools, false), "touch.comp", touch_comp)};
        return *made;
    }
    Text text(Tools tools, bool tiled) const {
        return physics(body_, simulation_, placement_, width_, tools, tiled);
    }

    bool adds_up() const { return needs(scheme_, sum); }

    Moving make_state() const {
        const auto slots = std::size_t(placement_.slots);
        return {gl::Field(GL_RGBA32F, sizeof(vec4), slots, width_),
                gl::Field(GL_RGBA32F, sizeof(vec4), slots, width_)};
    }

    // ---- a pass ----

    void look_at(const Moving& moving) const {
        moving.positions.bind(positions_unit);
        moving.velocities.bind(velocities_unit);
    }

    // No pass writes what it reads: the last of several writes `further`, which then is the current state.
    void run(Pipeline& pipeline, const PassPlan& plan) {
        const bool over = plan.next == current;
        const Moving &now = *states_[plan.at], &start = *states_[plan.start];
        const Moving& next = *states_[over ? further : plan.next];
        const Moving& total = plan.opens || !adds_up() ? now : *states_[sum];
        pipeline.pass({now, start, states_[current]->positions, total, next, adds_up() ? *next_sum_ : next});
        const bool sums_now = adds_up() && plan.start != sum;
        if (sums_now) std::swap(*states_[sum], *next_sum_);
        const bool single = scheme_.stages.size() == 1;
        if (over || single) std::swap(*states_[current], *states_[over ? further : between]);
    }

    // Runs a pass over the current state, which leaves it and writes what it returns.
    Moving& write_beside(const Pass& pass) const {
        on_gpu_.bind();
        on_gpu_.upload(pass);
        Moving &at = *states_[current], &free = *states_[scheme_.stages.size() == 1 ? between : further];
        look_at(at);
        work_out_cells();
        alone_->pass({at, at, at.positions, at, free, adds_up() ? *next_sum_ : free});
        return free;
    }

    // The positions before the last step, which the last pass has left behind.
    const gl::Field& before_last_step() const {
        return states_[scheme_.stages.size() == 1 ? between : further]->positions;
    }

    void add_impulses(const Touched& tools, const Call& call, const PassPlan& plan) const {
        tools.impulses.use();
        tools.impulses.set("seconds", float(plan.impulse));
        tools.impulses.set("first_push", int(call.pushes.size()));
        tools.impulses.set("pushes_given", int(call.influences.pushes.size()));
        tools.impulses.set("count", int(placement_.rim.size()));
        states_[plan.start]->velocities.bind(start_velocities_unit);
        on_gpu_.bind_rim();
        answers_.bind_impulses();
        glDispatchCompute(GLuint(adders_ / group_size), 1, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    }

    // ---- after a call ----

    // `step`: s, the last one.
    Findings close(const Influences& influences, const Origin& origin, double step = 0) {
        look_at(*states_[current]);
        before_last_step().bind(before_unit);
        on_gpu_.upload(quiet_);
        closing_.use();
        closing_.set("count", int(body_.count()));
        closing_.set("zero", vec3(origin.place));
        closing_.set("zero_speed", vec3(origin.velocity));
        closing_.set("duration", float(step));
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, shown_positions_buffer, shown_positions_.name());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, shown_normals_buffer, shown_normals_.name());
        answers_.bind_findings();
        const int each = (int(body_.count()) + nodes_each - 1) / nodes_each;
        if (each > 0) glDispatchCompute(GLuint(groups(each)), 1, 1);
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                        GL_BUFFER_UPDATE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
        const Answer answer = answers_.wait(influences);
        bounds_ = answer.bounds;
        return answer.findings;
    }

    // ---- for the host ----

    std::vector<vec4> read(const gl::Field& field) const {
        std::vector<vec4> values(std::size_t(placement_.slots));
        field.get(context_, std::as_writable_bytes(std::span(values)));
        return values;
    }

    std::optional<gl::Context> own_;  // first, because all the rest lives in it
    const gl::Context& context_;
    const Body& body_;
    const Simulation& simulation_;
    const Scheme& scheme_;
    const Placement placement_;
    const int width_;  // of flat textures; 0: buffers
    BodyOnGpu on_gpu_;
    const bool tiled_;
    std::unique_ptr<Pipeline> alone_;  // with no tools
    gl::Program closing_;
    std::optional<Cells> cells_;
    std::optional<Touched> touched_, resisted_;
    const Pass quiet_;                         // nothing touches or moves it
    mutable std::optional<Moving> states_[4];  // StateBuffer
    std::optional<Moving> next_sum_, before_;
    gl::Buffer shown_positions_, shown_normals_;  // of the nodes in their order
    int adders_;                                  // invocations that add up impulses
    Answers answers_;
    Bounds bounds_;
};

}  // namespace

std::unique_ptr<Machine> make_gpu(const Body& body, const Simulation& simulation, const gl::Context* context,
                                  std::optional<bool> tiles) {
    std::optional<gl::Visit> visit;  // a context of its own needs none
    if (context) {
        context->make_current();
        visit.emplace();
    }
    return std::make_unique<Gpu>(body, simulation, context, tiles);
}

}  // namespace palpate
