// The kernels: node.inl with as many nodes for a number as a register holds, compiled once for each
// instruction set.
#include "palpate/solver/cpu/kernel.h"

#include "palpate/body/stencils.h"

// No vectors of unknown length as members (SVE, RVV); AVX3_DL adds nothing here.
#define HWY_DISABLED_TARGETS \
    (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "palpate/solver/cpu/kernel.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#undef FN
#define FN HWY_INLINE
// Not inlined: else what it needs is kept on the stack for it, link by link, whether it runs or not.
#undef ASIDE
#define ASIDE HWY_NOINLINE

// What is done for each pack of nodes: a call for each would cost a tenth.
// (With the address sanitizer it would take the compiler seven minutes instead.)
#undef INLINED
#ifdef __SANITIZE_ADDRESS__
#define INLINED HWY_ATTR
#else
#define INLINED HWY_ATTR __attribute__((always_inline))
#endif

HWY_BEFORE_NAMESPACE();
namespace palpate::cpu::HWY_NAMESPACE {

#include "palpate/base/pack-inl.h"
#include "palpate/solver/cpu/node_access-inl.h"

// ---- what is done with them ----

template <class Physics>
FN typename Physics::Node load_node(const BodyView& body, const Fields& from, std::ptrdiff_t i) {
    typename Physics::Node node;
    node.position = load(from.x, from.y, from.z, i);
    node.velocity = load(from.vx, from.vy, from.vz, i);
    node.inverse_mass = load(body.inverse_mass + i);
    return node;
}
template <class Node>
FN void store_node(const Node& node, const Fields& to, std::ptrdiff_t i) {
    store(node.position, to.x, to.y, to.z, i);
    store(node.velocity, to.vx, to.vy, to.vz, i);
}

template <class Physics, class Do>
FN void for_each_pack(const Task& s, const typename Physics::WithPass& pass,
                      const typename Physics::Constants& constants, const Fields& at, int block, Do act) {
    for (int r = s.body.blocks[block].first_run; r < s.body.blocks[block].end_run; ++r) {
        const Run run = s.body.runs[r];
        for (std::ptrdiff_t i = run.first; i < run.first + run.count; i += std::ptrdiff_t(lanes())) {
            Physics physics(s, pass, constants, at, r, i);
            act(physics, i);
        }
    }
}
template <class Physics, class Do>
FN void for_each_pack(const Task& s, int first_block, int end_block, Do act) {
    const typename Physics::WithPass pass(s.pass);
    const typename Physics::Constants constants(pass);
    for (int block = first_block; block < end_block; ++block)
        for_each_pack<Physics>(s, pass, constants, s.states[s.plan.at], block, act);
}

// Works out cells of tissue, in the order of their lowest corners, not long before nodes need them: along a
// row first, since the nodes of a row are neighbours in a register.
template <class Physics>
class CellsAhead {
 public:
    // For the nodes of these blocks.
    FN CellsAhead(const Task& s, const typename Physics::WithPass& pass,
                  const typename Physics::Constants& constants, int first_block, int end_block)
        : s_(s), pass_(pass), constants_(constants) {
        wanted_ = Physics::has_cells && first_block < end_block && pass.kick > 0;
        if (!wanted_) return;
        const auto width = std::ptrdiff_t(lanes());
        next_ = s.body.blocks[first_block].first_slot - s.body.cells.reach - 1;  // 1: the cell before
        next_ -= next_ < 0 ? width + next_ % width : next_ % width;
        place_ = (next_ + s.cells.size) % s.cells.size;
        while (next_ < 0) go_on({});  // there are none before the first
    }

    // Those whose lowest corners lie before this slot.
    FN void up_to(int end_slot) {
        if constexpr (!Physics::has_cells) return;
        if (!wanted_) return;
        const Fields& at = s_.states[s_.plan.at];
        while (next_ < end_slot) {
            while (s_.body.runs[run_].first + s_.body.runs[run_].count <= next_) ++run_;
            Physics physics(s_, pass_, constants_, at, run_, next_);
            if constexpr (Physics::has_cells) go_on(physics.damped_cell_forces(0));
        }
    }

 private:
    using EightReals = typename Physics::EightReals;

    // By what the cells of a register do, by modes.
    FN void go_on(const typename Physics::Eight& push) {
        EightReals x, y, z;
        for (int k = 1; k < 8; ++k) x.c[k] = push.c[k].x, y.c[k] = push.c[k].y, z.c[k] = push.c[k].z;
        write(x, 0);
        write(y, 1);
        write(z, 2);
        next_ += std::ptrdiff_t(lanes());
        place_ += std::ptrdiff_t(lanes());
        if (place_ == s_.cells.size) place_ = 0;
    }

    // One component of it, on the nodes of the four rows that the cells lie between.
    FN void write(const EightReals& mode, int component) {
        Pack row[4];
        for (int r = 0; r < 4; ++r) {
            const Pack along = mode.c[2 * r + 1];  // there is no mode 0
            const Pack after = one_lane_on(r > 0 ? mode.c[2 * r] + along : along);
            Pack& before = before_[component][r];
            row[r] = first_lane_of(before, after) + (r > 0 ? mode.c[2 * r] - along : -along);
            before = after;
        }
        for (int step : {1, 2})
            for (int r = 0; r < 4; ++r)
                if ((r & step) == 0) {
                    const Pack a = row[r], b = row[r + step];
                    row[r] = a - b;
                    row[r + step] = a + b;
                }
        const std::ptrdiff_t size = s_.cells.size, array = size + std::ptrdiff_t(lanes());
        for (int r = 0; r < 4; ++r) {
            float* const numbers = s_.cells.numbers + (3 * r + component) * array;
            store(row[r], numbers + place_);
            // Once more behind the last, for registers that begin before it.
            if (place_ == 0) store(row[r], numbers + size);
        }
    }

    const Task& s_;
    const typename Physics::WithPass& pass_;
    const typename Physics::Constants& constants_;
    bool wanted_ = false;
    std::ptrdiff_t next_ = 0, place_ = 0;
    int run_ = 0;
    Pack before_[3][4] = {};  // what the last register did to the corners behind it, one lane on
};

// Forces and the motion that they bring.
template <class Physics>
FN void move(const Task& s, const typename Physics::WithPass& pass,
             const typename Physics::Constants& constants, int block) {
    const Fields start = s.states[s.plan.start], at = s.states[s.plan.at], next = s.states[s.plan.next],
                 total = s.states[sum];
    for_each_pack<Physics>(s, pass, constants, at, block, [&](Physics& physics, std::ptrdiff_t i) INLINED {
        const auto node = load_node<Physics>(s.body, at, i);
        Pack3 change = pass.kick > 0 ? physics.acceleration(node) : Pack3(0.0f, 0.0f, 0.0f);
        if (pass.kick > 0 && pass.resistance > 0)
            change = physics.resisted(load_node<Physics>(s.body, start, i), node.position, change);
        if (pass.part > 0) {
            const auto before = load_node<Physics>(s.body, s.plan.opens ? at : total, i);
            store_node(physics.collect(before, node, change), total, i);
        }
        auto from = node;
        if (s.plan.start != s.plan.at) from = load_node<Physics>(s.body, start, i);
        store_node(physics.integrate(from, node, change), next, i);
    });
}

// Out of the obstacles. `was`: where the step began.
HWY_NOINLINE void push_out(const Task& s, int block, const Fields& was) {
    const Fields next = s.states[s.plan.next];
    const TablePhysics<>::Constants none(s.pass);
    for_each_pack<TablePhysics<>>(
        s, s.pass, none, next, block, [&](TablePhysics<>& physics, std::ptrdiff_t i) INLINED {
            const Pack3 before = load(was.x, was.y, was.z, i);
            store_node(physics.collide(load_node<TablePhysics<>>(s.body, next, i), before), next, i);
        });
}

// The nearest multiple of `finest`, which is a power of two; what is large is one already.
FN Pack on_a_multiple(Pack a, float finest) {
    const Pack shift = 12582912.0f * finest;  // 1.5 x 2^23: from here on floats lie `finest` apart
    return select(abs(a) < Pack(4194304.0f * finest), (a + shift) - shift, a);
}

// What is done once, at the end of a call.
FN void finish(const Task& s, const Block& block, const Fields& was, Largest& largest) {
    const Fields next = s.states[s.plan.next];
    const float finest = s.body.finest;
    const Pack3 along(s.pass.origin_speed.x, s.pass.origin_speed.y, s.pass.origin_speed.z);
    Pack speed = 0.0f, move = 0.0f;
    for (std::ptrdiff_t i = block.first_slot; i < block.end_slot; i += std::ptrdiff_t(lanes())) {
        Pack3 p = load(next.x, next.y, next.z, i);
        const Pack3 v = load(next.vx, next.vy, next.vz, i) + along,
                    way = p - load(was.x, was.y, was.z, i) + Pack(s.pass.duration) * along;
        p = {on_a_multiple(p.x, finest), on_a_multiple(p.y, finest), on_a_multiple(p.z, finest)};
        store(p, next.x, next.y, next.z, i);
        speed = max(speed, dot(v, v));
        move = max(move, dot(way, way));
    }
    largest.speed = std::max(largest.speed, hn::GetLane(hn::MaxOfLanes(Lanes(), speed.v)));
    largest.move = std::max(largest.move, hn::GetLane(hn::MaxOfLanes(Lanes(), move.v)));
}

// Where the nodes of a block were when the step began: kept, if the last of several passes writes over it.
class Kept {
 public:
    FN Kept(const Task& s, const Block& block) : fields(s.states[current]) {
        if (s.plan.next != current || !(s.plan.ends || s.pass.obstacles > 0)) return;
        float** fields_of[] = {&fields.x, &fields.y, &fields.z};
        for (std::size_t k = 0; k < 3; ++k) {
            std::copy(*fields_of[k] + block.first_slot, *fields_of[k] + block.end_slot, memory_[k]);
            *fields_of[k] = memory_[k] - block.first_slot;
        }
    }
    Kept(const Kept&) = delete;

    Fields fields;

 private:
    HWY_ALIGN float memory_[3][Block::most];
};

FN Bounds bounds_of(const Fields& at, const Block& block) {
    Pack3 low(3e38f, 3e38f, 3e38f), high(-3e38f, -3e38f, -3e38f);
    for (std::ptrdiff_t i = block.first_slot; i < block.end_slot; i += std::ptrdiff_t(lanes())) {
        const Pack3 p = load(at.x, at.y, at.z, i);
        low = {min(low.x, p.x), min(low.y, p.y), min(low.z, p.z)};
        high = {max(high.x, p.x), max(high.y, p.y), max(high.z, p.z)};
    }
    const Lanes d;
    auto least = [&](Pack a) HWY_ATTR { return hn::GetLane(hn::MinOfLanes(d, a.v)); };
    auto most = [&](Pack a) HWY_ATTR { return hn::GetLane(hn::MaxOfLanes(d, a.v)); };
    return {{least(low.x), least(low.y), least(low.z)}, {most(high.x), most(high.y), most(high.z)}};
}

// Four floats a node, where neighbours in a table look it up.
HWY_NOINLINE void show_block(const Fields& at, const Block& block) {
    for (std::ptrdiff_t i = block.first_slot; i < block.end_slot; i += std::ptrdiff_t(lanes())) {
        if (at.places) store_each(load(at.x, at.y, at.z, i), at.places + 4 * i);
        if (at.speeds) store_each(load(at.vx, at.vy, at.vz, i), at.speeds + 4 * i);
    }
}

void show(const Task& s, int first_block, int end_block) {
    for (int b = first_block; b < end_block; ++b) show_block(s.states[s.plan.at], s.body.blocks[b]);
}

// A pass: block after block, each whole while it is in the first cache. Where nothing is near, nothing is
// looked for.
template <class Physics>
void pass(const Task& s, int first_block, int end_block, Largest& largest) {
    using Quiet = typename Physics::Quiet;
    const typename Quiet::WithPass quiet_pass(s.pass);
    const typename Quiet::Constants quiet_constants(quiet_pass);
    const typename Physics::Constants constants(s.pass);
    const bool tools = s.pass.tips > 0 || s.pass.pushes > 0;
    const bool calm = QuietPass::calm(s.pass);
    CellsAhead<Physics> cells(s, s.pass, constants, calm ? end_block : first_block, end_block);
    CellsAhead<Quiet> quiet_cells(s, quiet_pass, quiet_constants, calm ? first_block : end_block, end_block);
    for (int b = first_block; b < end_block; ++b) {
        const Block& block = s.body.blocks[b];
        const Kept was(s, block);
        cells.up_to(block.end_slot);
        quiet_cells.up_to(block.end_slot);
        if (!calm || (tools && touched(s, b, s.moved[s.plan.at][b]))) {
            Task of_block = s;
            if (s.given) of_block.given += b * s.pass.tips;
            move<Physics>(of_block, s.pass, constants, b);
        } else
            move<Quiet>(s, quiet_pass, quiet_constants, b);
        if (tools || s.pass.obstacles > 0) {
            const Bounds before = s.moved[current][b];  // which the last of several passes writes over
            Bounds& moved = s.moved[s.plan.next][b];
            moved = bounds_of(s.states[s.plan.next], block);
            if (near_obstacles(s, b, before, moved)) {
                push_out(s, b, was.fields);
                moved = bounds_of(s.states[s.plan.next], block);
            }
        }
        if (s.plan.ends) finish(s, block, was.fields, largest);
        if (s.body.springs == Springs::table) show_block(s.states[s.plan.next], block);
    }
}

void find_bounds(const Task& s, int first_block, int end_block) {
    for (int b = first_block; b < end_block; ++b)
        s.moved[s.plan.at][b] = bounds_of(s.states[s.plan.at], s.body.blocks[b]);
}

void give(const Task& s, int first_block, int end_block, dvec3* given) {
    const Fields at = s.states[s.plan.at];
    const TablePhysics<>::Constants none(s.pass);
    for (int b = first_block; b < end_block; ++b) {
        if (!touched(s, b, s.moved[s.plan.at][b])) continue;
        for_each_pack<TablePhysics<>>(s, s.pass, none, at, b,
                                      [&](TablePhysics<>& physics, std::ptrdiff_t i) INLINED {
                                          const Pack3 p = load(at.x, at.y, at.z, i);
                                          for (int t = 0; t < s.pass.tips; ++t) {
                                              const Pack3 force = physics.tip_force(p, t);
                                              if (any_node(dot(force, force) > 0.0f))
                                                  add(force, s.plan.impulse, given[b * s.pass.tips + t]);
                                          }
                                      });
    }
}

template <class Physics>
void normals(const Task& s, int first_block, int end_block, float* x, float* y, float* z) {
    const Fields at = s.states[s.plan.at];
    for_each_pack<Physics>(s, first_block, end_block, [&](Physics& physics, std::ptrdiff_t i) INLINED {
        store(physics.outward(load(at.x, at.y, at.z, i)), x, y, z, i);
    });
}

// Whether no node of a block has gone so far that a spring of it could be torn, which takes a tenth of
// looking at them.
FN bool is_near_rest(const Task& s, const Block& block) {
    const Fields at = s.states[s.plan.at];
    const Pack most = s.body.whole_within * s.body.whole_within;
    Pack gone = 0.0f;
    for (std::ptrdiff_t i = block.first_slot; i < block.end_slot; i += std::ptrdiff_t(lanes())) {
        const Pack3 way = load(at.x, at.y, at.z, i);
        gone += select(dot(way, way) <= most, Pack(0.0f), Pack(1.0f));
    }
    return !any_node(gone > 0.0f);
}

template <class Physics>
bool torn(const Task& s, int first_block, int end_block) {
    const Fields at = s.states[s.plan.at];
    Pack wrong = 0.0f;
    for (int b = first_block; b < end_block; ++b)
        if (!is_near_rest(s, s.body.blocks[b]))
            for_each_pack<Physics>(s, b, b + 1, [&](Physics& physics, std::ptrdiff_t i) INLINED {
                wrong += physics.torn(load(at.x, at.y, at.z, i));
            });
    return any_node(wrong > 0.0f);
}

// Calls act<Node>() with the nodes that a body is made of.
template <class Act>
auto of(const BodyView& body, Act act) {
    switch (body.springs) {
        case Springs::lattice_whole:
            return act.template operator()<GridPhysics<LatticeStencil, 1, true, false>>();
        case Springs::lattice:
            return act.template operator()<GridPhysics<LatticeStencil, 3, true, false>>();
        case Springs::lattice_with_strength:
            return act.template operator()<GridPhysics<LatticeStencil, 3, true, true>>();
        case Springs::turned_lattice:
            return act.template operator()<GridPhysics<LatticeStencil, 3, false, true>>();
        case Springs::cloth:
            return act.template operator()<GridPhysics<ClothStencil, 1, true, false>>();
        case Springs::turned_cloth:
            return act.template operator()<GridPhysics<ClothStencil, 1, false, true>>();
        case Springs::volume:
            return act.template operator()<GridPhysics<VolumeStencil, 1, true, true>>();
        case Springs::turned_volume:
            return act.template operator()<GridPhysics<VolumeStencil, 1, false, true>>();
        case Springs::tissue:
            return act.template operator()<GridPhysics<TissueStencil, 3, false, false, true>>();
        case Springs::table:
            break;
    }
    if (body.cells.records) return act.template operator()<TablePhysics<Pass, true, true>>();
    return body.hinges.slices ? act.template operator()<TablePhysics<Pass, true>>()
                              : act.template operator()<TablePhysics<>>();
}

void pass_over(const Task& s, int first_block, int end_block, Largest& largest) {
    of(s.body, [&]<class Physics>() { pass<Physics>(s, first_block, end_block, largest); });
}
void normals_over(const Task& s, int first_block, int end_block, float* x, float* y, float* z) {
    of(s.body, [&]<class Physics>() { normals<Physics>(s, first_block, end_block, x, y, z); });
}
bool torn_over(const Task& s, int first_block, int end_block) {
    return of(s.body, [&]<class Physics>() { return torn<Physics>(s, first_block, end_block); });
}

Kernels all() {
    return {hwy::TargetName(HWY_TARGET),
            int(lanes()),
            pass_over,
            give,
            find_bounds,
            show,
            normals_over,
            torn_over};
}

}  // namespace palpate::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpate::cpu {
HWY_EXPORT(all);

Kernels kernels() { return HWY_DYNAMIC_DISPATCH(all)(); }

}  // namespace palpate::cpu
#endif
