// The peak rates of this machine, with each instruction set.
#include "bench/speed/speed.h"
#include "palpate/base/clock.h"
#include "palpate/base/team.h"

#include <cstring>
#include <vector>

#define HWY_DISABLED_TARGETS \
    (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/speed/limits.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace palpate::speed::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::ScalableTag<float>;
using V = hn::Vec<Lanes>;

// The springs of nodes that stay in the registers, to a few neighbours that stay in the first-level cache:
// subtract, square, estimate the reciprocal square root, one Newton step, accumulate. Two independent chains
// hide the latency.
double links(int times) {
    constexpr std::size_t packs = 32;
    const Lanes d;
    const std::size_t lanes = hn::Lanes(d);
    HWY_ALIGN float from[3][packs * HWY_LANES(float)];
    for (int k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < packs * lanes; ++i) from[k][i] = 0.01f * float(i) + float(k);
    const V here = hn::Set(d, 0.1f), tiny = hn::Set(d, 1e-20f), stiffness = hn::Set(d, 300.0f),
            half = hn::Set(d, 1.5f), three_halves = hn::Set(d, 4.5f);
    V sum[2][3] = {{hn::Zero(d), hn::Zero(d), hn::Zero(d)}, {hn::Zero(d), hn::Zero(d), hn::Zero(d)}};
    for (int t = 0; t < times; ++t)
        for (std::size_t p = 0; p < packs; p += 2)
            for (std::size_t chain = 0; chain < 2; ++chain) {
                const std::size_t i = (p + chain) * lanes;
                const V x = hn::Sub(hn::Load(d, from[0] + i), here),
                        y = hn::Sub(hn::Load(d, from[1] + i), here),
                        z = hn::Sub(hn::Load(d, from[2] + i), here);
                const V square = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::MulAdd(z, z, tiny)));
                const V e = hn::ApproximateReciprocalSqrt(square);
                const V near = hn::Mul(hn::Mul(square, e), e);
                const V pull = hn::NegMulAdd(e, hn::NegMulAdd(near, half, three_halves), stiffness);
                sum[chain][0] = hn::MulAdd(pull, x, sum[chain][0]);
                sum[chain][1] = hn::MulAdd(pull, y, sum[chain][1]);
                sum[chain][2] = hn::MulAdd(pull, z, sum[chain][2]);
            }
    volatile float kept = 0;
    for (auto& chain : sum)
        for (V v : chain) kept = kept + hn::GetLane(v);
    return double(times) * double(packs * lanes);
}

}  // namespace palpate::speed::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpate::speed {
HWY_EXPORT(links);

Work arithmetic(int threads) {
    constexpr int times = 100'000;
    Team team(threads);
    std::vector<double> done(std::size_t(threads), 0.0);
    const double begin = now();
    team.run([&](int member) { done[std::size_t(member)] = HWY_DYNAMIC_DISPATCH(links)(times); });
    return {now() - begin, threads * done[0]};
}

Work copying(int threads) {
    constexpr std::size_t bytes = 64 << 20;
    std::vector<std::vector<char>> from(std::size_t(threads), std::vector<char>(bytes, 1)), to = from;
    Team team(threads);
    const double begin = now();
    team.run([&](int member) {
        std::memcpy(to[std::size_t(member)].data(), from[std::size_t(member)].data(), bytes);
    });
    return {now() - begin, 2.0 * threads * double(bytes)};
}

}  // namespace palpate::speed
#endif
