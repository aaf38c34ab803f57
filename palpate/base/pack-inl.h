// Pack: as many floats as a SIMD register holds; Pack3: a vector of three of them. Their operations have
// GLSL's names. For code that Highway's foreach_target compiles once for each instruction set: include this
// inside HWY_NAMESPACE, after FN is defined, each time (so it has no include guard).

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::ScalableTag<float>;
using Word = hn::Vec<hn::RebindToUnsigned<Lanes>>;  // as many unsigned integers
using Mask = hn::Mask<Lanes>;

struct Pack {
    hn::Vec<Lanes> v;

    Pack() = default;
    FN Pack(float f) : v(hn::Set(Lanes(), f)) {}
    FN Pack(hn::Vec<Lanes> lanes) : v(lanes) {}

    FN friend Pack operator+(Pack a, Pack b) { return hn::Add(a.v, b.v); }
    FN friend Pack operator-(Pack a, Pack b) { return hn::Sub(a.v, b.v); }
    FN friend Pack operator*(Pack a, Pack b) { return hn::Mul(a.v, b.v); }
    FN friend Pack operator/(Pack a, Pack b) { return hn::Div(a.v, b.v); }
    FN friend Pack operator-(Pack a) { return hn::Neg(a.v); }
    FN Pack& operator+=(Pack b) { return *this = *this + b; }
    FN Pack& operator-=(Pack b) { return *this = *this - b; }
    FN friend Mask operator>(Pack a, Pack b) { return hn::Gt(a.v, b.v); }
    FN friend Mask operator<(Pack a, Pack b) { return hn::Lt(a.v, b.v); }
    FN friend Mask operator<=(Pack a, Pack b) { return hn::Le(a.v, b.v); }
    FN friend Pack max(Pack a, Pack b) { return hn::Max(a.v, b.v); }
    FN friend Pack min(Pack a, Pack b) { return hn::Min(a.v, b.v); }
    FN friend Pack abs(Pack a) { return hn::Abs(a.v); }
    FN friend Pack select(Mask m, Pack a, Pack b) { return hn::IfThenElse(m, a.v, b.v); }
};

FN bool any_node(Mask m) { return !hn::AllFalse(Lanes(), m); }
FN size_t lanes() { return hn::Lanes(Lanes()); }
FN Pack load(const float* from) { return hn::LoadU(Lanes(), from); }
FN void store(Pack a, float* to) { hn::StoreU(a.v, Lanes(), to); }

// Each lane in the next one's place, and the last in the first's. There are a power of two of them.
FN Pack one_lane_on(Pack a) {
    const hn::RebindToSigned<Lanes> d;
    const auto last = std::int32_t(lanes()) - 1;
    const auto from = hn::And(hn::Iota(d, last), hn::Set(d, last));
    return hn::TableLookupLanes(a.v, hn::IndicesFromVec(Lanes(), from));
}

// The first lane of one, and all others of the other.
FN Pack first_lane_of(Pack first, Pack others) {
    return hn::IfThenElse(hn::FirstN(Lanes(), 1), first.v, others.v);
}

// The processor's own estimate of 1/√a, exact to at least eleven bits.
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_SSE4
FN Pack estimate(Pack a) { return hn::ApproximateReciprocalSqrt(a.v); }
#elif HWY_TARGET == HWY_NEON  // only eight bits: one more step of Newton's method
FN Pack estimate(Pack a) {
    const Pack e = hn::ApproximateReciprocalSqrt(a.v);
    return e * (1.5f - (0.5f * a) * (e * e));
}
#else
FN Pack estimate(Pack a) { return Pack(1.0f) / Pack(hn::Sqrt(a.v)); }
#endif

// One step of Newton's method from there: exact to two units in the last place.
FN Pack inversesqrt(Pack a) {
    const Pack e = estimate(a);
    return e * (1.5f - (0.5f * a) * (e * e));
}

struct Pack3 {
    Pack x, y, z;

    Pack3() = default;
    FN Pack3(Pack a, Pack b, Pack c) : x(a), y(b), z(c) {}

    FN friend Pack3 operator+(Pack3 a, Pack3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    FN friend Pack3 operator-(Pack3 a, Pack3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    FN friend Pack3 operator*(Pack s, Pack3 a) { return {s * a.x, s * a.y, s * a.z}; }
    FN Pack3& operator+=(Pack3 b) { return *this = *this + b; }
    FN Pack3& operator-=(Pack3 b) { return *this = *this - b; }
    FN friend Pack x_of(Pack3 a) { return a.x; }
    FN friend Pack dot(Pack3 a, Pack3 b) { return a.x * b.x + (a.y * b.y + a.z * b.z); }
    FN friend Pack3 cross(Pack3 a, Pack3 b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
    FN friend Pack3 select(Mask m, Pack3 a, Pack3 b) {
        return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
    }
};

FN Pack3 load(const float* x, const float* y, const float* z, std::ptrdiff_t i) {
    return {load(x + i), load(y + i), load(z + i)};
}
FN void store(Pack3 a, float* x, float* y, float* z, std::ptrdiff_t i) {
    store(a.x, x + i);
    store(a.y, y + i);
    store(a.z, z + i);
}

// A transposing gather: loads four floats at the address at(lane) for each lane, and returns the first three
// as three packs.
template <class At>
FN Pack3 load_each(At at) {
#if HWY_TARGET == HWY_SCALAR
    const float* p = at(std::size_t(0));
    return {p[0], p[1], p[2]};
#else
    const Lanes d;
    const hn::FixedTag<float, 4> four;
    auto every_fourth = [&](std::size_t from) HWY_ATTR {
#if HWY_TARGET == HWY_AVX3
        const hn::FixedTag<float, 8> eight;
        return hn::Combine(d,
                           hn::Combine(eight, hn::LoadU(four, at(from + 12)), hn::LoadU(four, at(from + 8))),
                           hn::Combine(eight, hn::LoadU(four, at(from + 4)), hn::LoadU(four, at(from))));
#elif HWY_TARGET == HWY_AVX2
        return hn::Combine(d, hn::LoadU(four, at(from + 4)), hn::LoadU(four, at(from)));
#else
        return hn::LoadU(d, at(from));
#endif
    };
    const auto a = every_fourth(0), b = every_fourth(1), c = every_fourth(2), e = every_fourth(3);
    const hn::RepartitionToWide<Lanes> pairs;
    const auto xy_of_ab = hn::BitCast(pairs, hn::InterleaveLower(d, a, b)),
               xy_of_ce = hn::BitCast(pairs, hn::InterleaveLower(d, c, e)),
               z_of_ab = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b)),
               z_of_ce = hn::BitCast(pairs, hn::InterleaveUpper(d, c, e));
    return {hn::BitCast(d, hn::InterleaveLower(pairs, xy_of_ab, xy_of_ce)),
            hn::BitCast(d, hn::InterleaveUpper(pairs, xy_of_ab, xy_of_ce)),
            hn::BitCast(d, hn::InterleaveLower(pairs, z_of_ab, z_of_ce))};
#endif
}

// The inverse: stores four floats for each lane, the last of them 0, one lane after the other.
FN void store_each(Pack3 a, float* to) {
#if HWY_TARGET == HWY_SCALAR
    store(a, to, to + 1, to + 2, 0);
    store(0.0f, to + 3);
#else
    hn::StoreInterleaved4(a.x.v, a.y.v, a.z.v, hn::Zero(Lanes()), Lanes(), to);
#endif
}

// Stores x, y, z of one lane after the other.
FN void store_interleaved(Pack3 a, float* to) {
#if HWY_TARGET == HWY_SCALAR
    store(a, to, to + 1, to + 2, 0);
#else
    hn::StoreInterleaved3(a.x.v, a.y.v, a.z.v, Lanes(), to);
#endif
}
