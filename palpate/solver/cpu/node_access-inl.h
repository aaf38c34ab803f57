// What node.inl asks of a backend, for as many nodes as a SIMD register holds: nodes of a grid, and nodes
// with their springs written out. kernel.cpp includes it inside HWY_NAMESPACE, after FN and ASIDE are defined
// and pack-inl.h, each time (so it has no include guard).

// A pass in which only springs and gravity act. What is constant zero here, the compiler leaves out.
struct QuietPass : Pass {
    static constexpr float link_damping = 0;
    static constexpr int tips = 0, resistance = 0, pushes = 0, obstacles = 0;
    static constexpr vec4 wind = vec4(0);
    explicit QuietPass(const Pass& pass) : Pass(pass) {}

    // But for tools and obstacles that are far.
    static bool calm(const Pass& p) { return p.link_damping == 0 && p.wind.w == 0; }
};

// Adds up what a register holds, one node after the other.
FN void add(Pack3 force, double seconds, dvec3& sum) {
    HWY_ALIGN float x[HWY_LANES(float)], y[HWY_LANES(float)], z[HWY_LANES(float)];
    store(force, x, y, z, 0);
    for (std::size_t n = 0; n < lanes(); ++n) sum += seconds * dvec3(x[n], y[n], z[n]);
}

// What node.inl asks of every node, whichever springs it has; of hinges only where there are some.
template <class AnyPass>
struct NodeAccess {
    using Real = Pack;
    using Real3 = Pack3;

    const BodyView& body;
    const AnyPass& pass;
    const Task& task;
    const Fields& at;
    std::ptrdiff_t id;  // slot of the first of the nodes

    // As Hinges says.
    struct HingeRecord {
        std::uint32_t to[3][HWY_LANES(float)];
        float x[3][HWY_LANES(float)], y[3][HWY_LANES(float)], z[3][HWY_LANES(float)];
        float stiffness[HWY_LANES(float)], rest[HWY_LANES(float)], area_square[HWY_LANES(float)];
        float is_end[HWY_LANES(float)];
    };
    FN const Slice& hinges() const { return body.hinges.slices[std::size_t(id) / lanes()]; }
    FN const HingeRecord& hinge(int h) const {
        return reinterpret_cast<const HingeRecord*>(body.hinges.records)[hinges().first + h];
    }
    FN Mask hinge_end(int h) const { return load(hinge(h).is_end) > 0.0f; }
    FN Pack3 hinge_toward(Pack3 p, int h, int n) const {
        const HingeRecord& record = hinge(h);
        return of_nodes(at.places, record.to[n]) - p + load(record.x[n], record.y[n], record.z[n], 0);
    }
    FN Pack3 hinge_passing(Pack3 v, int h, int n) const { return of_nodes(at.speeds, hinge(h).to[n]) - v; }
    FN Pack hinge_stiffness(int h) const { return load(hinge(h).stiffness); }
    FN Pack hinge_rest(int h) const { return load(hinge(h).rest); }
    FN Pack hinge_area_square(int h) const { return load(hinge(h).area_square); }

    // Four floats a node, of which each lane takes those of its own.
    FN static Pack3 of_nodes(const float* fours, const std::uint32_t* to) {
        return load_each([&](std::size_t lane) { return fours + to[lane]; });
    }

    FN Pack3 origin() const { return load(body.rest_x, body.rest_y, body.rest_z, id); }
    FN Pack area() const { return load(body.area + id); }
    FN Pack cover() const { return load(body.cover + id); }
    RoundTip tip(int i) const { return task.plan.tips[std::size_t(i)]; }
    FN void given(int i, Pack3 force) const {
        if (any_node(dot(force, force) > 0.0f)) add(force, task.plan.impulse, task.given[i]);
    }
    FN Pack3 push() const {
        const Pushes& p = *task.pushes;
        return load(p.force_x, p.force_y, p.force_z, id);
    }
    FN Pack3 push_target() const {
        const Pushes& p = *task.pushes;
        return load(p.target_x, p.target_y, p.target_z, id);
    }
    FN Pack push_stiffness() const { return load(task.pushes->stiffness + id); }
    FN Pack3 corner(int i) const {
        const vec3 c = body.corners[i];
        return {c.x, c.y, c.z};
    }
    FN Pack3 cell_axis(int axis) const {
        const vec3 a = body.cells.axes[axis];
        return {a.x, a.y, a.z};
    }
    // Fields are looked up one node after the other.
    HWY_NOINLINE Pack distance_at(int i, Pack3 p) const {
        return each(p, [&](vec3 q) { return vec3(body.fields[i]->at(q), 0, 0); }).x;
    }
    HWY_NOINLINE Pack3 uphill_at(int i, Pack3 p) const {
        return each(p, [&](vec3 q) { return body.fields[i]->gradient(q); });
    }

 private:
    template <class F>
    FN static Pack3 each(Pack3 p, F f) {
        HWY_ALIGN float x[HWY_LANES(float)], y[HWY_LANES(float)], z[HWY_LANES(float)];
        store(p, x, y, z, 0);
        for (std::size_t n = 0; n < lanes(); ++n) {
            const vec3 r = f(vec3(x[n], y[n], z[n]));
            x[n] = r.x, y[n] = r.y, z[n] = r.z;
        }
        return load(x, y, z, 0);
    }
};

// The links of a stencil, known when this is compiled. `all`: offsets a run has.
template <int links, int furthest, const auto& offsets, int all = links>
struct Stencil {
    static constexpr int count = links, reach = furthest, stride = all;
    static constexpr int along(int l, int axis) { return offsets[std::size_t(l)][axis]; }
};
using LatticeStencil = Stencil<lattice_links, 1, volume_links>;
using TissueStencil = Stencil<lattice_links, 1, volume_links, lattice_links + 10>;
using VolumeStencil = Stencil<int(volume_links.size()), 2, volume_links>;
using ClothStencil = Stencil<int(cloth_links.size()), 2, cloth_links>;

// The members of a base that depends on a template must be named.
#define USE_NODE_ACCESS(P)                                                                           \
    using NodeAccess<P>::body, NodeAccess<P>::pass, NodeAccess<P>::task, NodeAccess<P>::at,          \
        NodeAccess<P>::id, NodeAccess<P>::origin, NodeAccess<P>::area, NodeAccess<P>::cover,         \
        NodeAccess<P>::tip, NodeAccess<P>::given, NodeAccess<P>::push, NodeAccess<P>::push_target,   \
        NodeAccess<P>::push_stiffness, NodeAccess<P>::corner, NodeAccess<P>::cell_axis,              \
        NodeAccess<P>::distance_at, NodeAccess<P>::uphill_at, NodeAccess<P>::hinges,                 \
        NodeAccess<P>::hinge_end, NodeAccess<P>::hinge_toward, NodeAccess<P>::hinge_passing,         \
        NodeAccess<P>::hinge_stiffness, NodeAccess<P>::hinge_rest, NodeAccess<P>::hinge_area_square, \
        NodeAccess<P>::of_nodes;                                                                     \
    using typename NodeAccess<P>::Real, typename NodeAccess<P>::Real3;

// Nodes of a grid: their neighbours along a link are as far away for all of them.
template <class Links, int bits_per_link, bool along_axes, bool with_strength, bool with_cells = false,
          class AnyPass = Pass>
struct GridPhysics : NodeAccess<AnyPass> {
    using WithPass = AnyPass;
    using Quiet = GridPhysics<Links, bits_per_link, along_axes, with_strength, with_cells, QuietPass>;
    static constexpr bool has_cells = with_cells;
    USE_NODE_ACCESS(AnyPass)
    static constexpr int per_word = bits_per_link == 1 ? 32 : 10;
    static constexpr int words = (Links::count + per_word - 1) / per_word;
    static constexpr bool masked = bits_per_link == 1;

    // What all nodes need of a link, ready in memory where one instruction can take it: the stiffness of what
    // is one in a word; the tension times half and three halves; and where its share is in a word.
    struct Constants {
        Pack stiffness[Links::count], tension_half[Links::count], tension_three_halves[Links::count];
        Word bits_of[Links::count];
        Word bit_of_row[4];  // of tissue
        FN explicit Constants(const Pass& pass) {
            const hn::RebindToUnsigned<Lanes> d;
            for (int row = 0; row < 4; ++row) bit_of_row[row] = hn::Set(d, std::uint32_t(1) << (24 + row));
            for (int l = 0; l < Links::count; ++l) {
                const float unit = one_over_whole(l);
                stiffness[l] = unit * pass.spring[l].stiffness;
                tension_half[l] = 0.5f * unit * pass.spring[l].tension;
                tension_three_halves[l] = 1.5f * unit * pass.spring[l].tension;
                const std::uint32_t bits = bits_per_link == 1 ? 1 : 7;
                bits_of[l] = hn::Set(d, bits << (l % per_word * bits_per_link));
            }
        }
    };

    const Constants& constants;
    const int* offsets;
    const float *x, *y, *z;  // of the first node: from here one addition finds a neighbour
    Word word[words];
    Pack ahead[3][2 * Links::reach + 1];  // from the node along each axis, in spacings: less where it is now
    Pack half_strength;

    FN GridPhysics(const Task& s, const AnyPass& p, const Constants& c, const Fields& from, int run,
                   std::ptrdiff_t slot)
        : NodeAccess<AnyPass>{s.body, p, s, from, slot},
          constants(c),
          offsets(s.body.offsets + run * Links::stride),
          x(from.x + slot),
          y(from.y + slot),
          z(from.z + slot) {
        const hn::RebindToUnsigned<Lanes> d;
        for (int w = 0; w < words; ++w) word[w] = hn::LoadU(d, body.words[w] + id);
        if constexpr (along_axes) {
            const Pack3 here = load(x, y, z, 0);
            for (int n = -Links::reach; n <= Links::reach; ++n) {
                const Pack way = float(n) * body.spacing;
                ahead[0][n + Links::reach] = way - here.x;
                ahead[1][n + Links::reach] = way - here.y;
                ahead[2][n + Links::reach] = way - here.z;
            }
        }
        if constexpr (with_strength) half_strength = load(body.half_strength + id);
    }

    // One over what a whole link is as a number, where it stands in its word.
    static constexpr float one_over_whole(int l) {
        return masked ? 1 : 1.0f / float(4 << (l % per_word * bits_per_link));
    }
    FN Pack times_share(int l, Pack a) const {
        const Word share = hn::And(word[l / per_word], constants.bits_of[l]);
        if constexpr (masked)
            return hn::IfThenElseZero(hn::RebindMask(Lanes(), hn::Eq(share, constants.bits_of[l])), a.v);
        else
            return a * Pack(hn::ConvertTo(Lanes(), hn::BitCast(hn::RebindToSigned<Lanes>(), share)));
    }
    FN Pack stronger(int l, Pack a) const {
        if constexpr (with_strength)
            return (half_strength + load(body.half_strength + id + offsets[l])) * a;
        else
            return a;
    }

    FN Pack3 toward([[maybe_unused]] Pack3 p, int l) const {
        const Pack3 there = load(x, y, z, offsets[l]);
        if constexpr (along_axes) {
            return {there.x + ahead[0][Links::along(l, 0) + Links::reach],
                    there.y + ahead[1][Links::along(l, 1) + Links::reach],
                    there.z + ahead[2][Links::along(l, 2) + Links::reach]};
        } else {
            const vec3 way = body.along[std::size_t(l)];
            return there - p + Pack3(way.x, way.y, way.z);
        }
    }
    FN Pack3 passing(Pack3 v, int l) const { return load(at.vx, at.vy, at.vz, id + offsets[l]) - v; }
    FN Pack share(int l) const { return times_share(l, one_over_whole(l)); }
    FN Pack neighbour(int l) const { return select(share(l) > 0.0f, Pack(1.0f), Pack(0.0f)); }
    FN Pack stiffness(int l) const { return stronger(l, pass.spring[l].stiffness); }
    FN Pack tension(int l) const { return stronger(l, pass.spring[l].tension); }
    FN Pack longest(int l) const { return pass.spring[l].longest; }

    // With Newton's step for the root and the share's unit worked into the constants.
    FN Pack pull(int l, Pack square) const {
        const Pack e = estimate(square);
        const Pack tension = constants.tension_three_halves[l] - constants.tension_half[l] * (square * e * e);
        return times_share(l, stronger(l, constants.stiffness[l] - e * tension));
    }

    // Of cells whose lowest corners these are.
    FN Pack3 cell_corner(int, int c) const { return load(x, y, z, to_corner(c)); }
    FN Pack3 cell_corner_velocity(int, int c) const { return load(at.vx, at.vy, at.vz, id + to_corner(c)); }
    FN int to_corner(int c) const { return c == 0 ? 0 : offsets[Links::count + c - 1]; }
    FN Pack cell_weight(int) const { return load(body.cells.weights + id); }

    // What the cells around them do, which CellsAhead has worked out.
    FN Pack3 cells_force() const {
        const std::ptrdiff_t size = task.cells.size, array = size + std::ptrdiff_t(lanes());
        const std::ptrdiff_t here = std::uint32_t(id) % std::uint32_t(size);
        Pack3 force(0.0f, 0.0f, 0.0f);
        _Pragma("GCC unroll 4") for (int row = 0; row < 4; ++row) {
            std::ptrdiff_t place = here + (row > 0 ? offsets[Links::count + 6 + row] : 0);
            if (place < 0) place += size;
            const float* const pushes = task.cells.numbers + 3 * row * array + place;
            const Word bit = constants.bit_of_row[row];
            const Mask there = hn::RebindMask(Lanes(), hn::Eq(hn::And(word[1], bit), bit));
            force +=
                {hn::IfThenElseZero(there, load(pushes).v), hn::IfThenElseZero(there, load(pushes + array).v),
                 hn::IfThenElseZero(there, load(pushes + 2 * array).v)};
        }
        return force;
    }

#define LINKS Links::count
#undef SPRINGS
#define SPRINGS (with_cells ? 0 : Links::count)
#define HINGES 0
#define CELLS (with_cells ? 8 : 0)
#define OWN_CELLS
#if HWY_TARGET == HWY_SCALAR  // for processors from before 2010: loops take the compiler a third of the time
#define UNROLL
#else
#define UNROLL _Pragma("GCC unroll 32")
#endif
#define OWN_PULL
#include "palpate/solver/node.inl"
#undef OWN_PULL
#undef UNROLL
#undef OWN_CELLS
#undef CELLS
#undef HINGES
#undef SPRINGS
#undef LINKS
};

// Nodes with their springs written out, and their hinges, if the body has any. What acts on a node whatever
// its springs, obstacles and tools, is made for these alone.
template <class AnyPass = Pass, bool with_hinges = false, bool with_cells = false>
struct TablePhysics : NodeAccess<AnyPass> {
    using WithPass = AnyPass;
    using Quiet = TablePhysics<QuietPass, with_hinges, with_cells>;
    static constexpr bool has_cells = false;  // none that are worked out ahead of their nodes
    USE_NODE_ACCESS(AnyPass)
    struct Constants {
        explicit Constants(const Pass&) {}
    };
    // As Ties says.
    struct Pulling {
        std::uint32_t to[HWY_LANES(float)];
        float x[HWY_LANES(float)], y[HWY_LANES(float)], z[HWY_LANES(float)];
        float stiffness[HWY_LANES(float)], tension[HWY_LANES(float)];
    };
    struct Whole {
        float share[HWY_LANES(float)], stiffness[HWY_LANES(float)], longest[HWY_LANES(float)];
    };

    FN TablePhysics(const Task& s, const AnyPass& p, const Constants&, const Fields& from, int,
                    std::ptrdiff_t slot)
        : NodeAccess<AnyPass>{s.body, p, s, from, slot} {}

    FN const Slice& slice() const { return body.ties.slices[std::size_t(id) / lanes()]; }
    FN const Pulling& pulling(int l) const {
        return reinterpret_cast<const Pulling*>(body.ties.pulling)[slice().first + l];
    }
    FN const Whole& whole(int l) const {
        return reinterpret_cast<const Whole*>(body.ties.whole)[slice().first + l];
    }
    FN Pack3 toward(Pack3 p, int l) const {
        const Pulling& tie = pulling(l);
        return of_nodes(at.places, tie.to) - p + load(tie.x, tie.y, tie.z, 0);
    }
    FN Pack3 passing(Pack3 v, int l) const { return of_nodes(at.speeds, pulling(l).to) - v; }
    FN Pack share(int l) const { return load(whole(l).share); }
    FN Pack neighbour(int) const { return 1.0f; }  // where there is none it is the node itself
    FN Pack stiffness(int l) const { return load(whole(l).stiffness); }
    FN Pack tension(int l) const {
        return select(share(l) > 0.0f, load(pulling(l).tension) / share(l), Pack(0.0f));
    }
    FN Pack longest(int l) const { return load(whole(l).longest); }

    // As cell_records() writes them.
    struct CellRecord {
        std::uint32_t corners[8][HWY_LANES(float)];
        float weight[HWY_LANES(float)];
    };
    FN const CellRecord& cell(int k) const {
        return reinterpret_cast<const CellRecord*>(
            body.cells.records)[8 * (std::size_t(id) / lanes()) + std::size_t(k)];
    }
    FN Pack cell_weight(int k) const { return load(cell(k).weight); }
    FN Pack3 cell_corner(int k, int c) const { return of_nodes(at.places, cell(k).corners[c]); }
    FN Pack3 cell_corner_velocity(int k, int c) const { return of_nodes(at.speeds, cell(k).corners[c]); }

    // With the share worked into stiffness and tension. The stream is longer than the nearer caches, and is
    // asked for ahead: that brings a twentieth where it fits the last of them, a fifth where it does not.
    FN Pack pull(int l, Pack square) const {
        const Pulling& tie = pulling(l);
        constexpr std::size_t ahead = 10 * sizeof(Pulling);
        for (std::size_t line = 0; line < sizeof(Pulling); line += 64)
            hwy::Prefetch(reinterpret_cast<const std::byte*>(&tie) + ahead + line);
        return load(tie.stiffness) - load(tie.tension) * inversesqrt(square);
    }

#undef FAN
#define FAN slice().fan
#define LINKS slice().count
#define HINGES (with_hinges ? hinges().count : 0)
#define CELLS (with_cells ? 8 : 0)
#define UNROLL
#define OWN_PULL
#include "palpate/solver/node.inl"
#include "palpate/solver/obstacles.inl"
#undef OWN_PULL
#undef UNROLL
#undef CELLS
#undef HINGES
#undef LINKS
#undef FAN
};
