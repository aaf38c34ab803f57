// Every body, integrator and machine of the CPU moves as it always has, to the bit: golden.txt keeps a hash
// of where each combination ends. PALPATE_GOLDEN=write writes the file anew, where a change is meant to round
// differently.
#include "palpate/base/files.h"
#include "palpate/solver/machine.h"
#include "tests/integrators.h"
#include "tests/solver/agreement.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <span>
#include <sstream>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace palpate {
namespace {

// FNV-1a.
class Hash {
 public:
    template <class T>
    void add(std::span<const T> values) {
        for (std::byte byte : std::as_bytes(values)) sum_ = (sum_ ^ std::uint64_t(byte)) * 0x100000001b3u;
    }
    std::string text() const { return fmt::format("{:016x}", sum_); }

 private:
    std::uint64_t sum_ = 0xcbf29ce484222325u;
};

float rough_root(float a) {
#if defined(__x86_64__)
    return _mm_cvtss_f32(_mm_rsqrt_ss(_mm_set_ss(a)));  // as much a matter of the maker as wider ones are
#else
    return 1 / std::sqrt(a);
#endif
}

// What else bits depend on: the registers' length, how a compiler fuses products and sums, and what
// processors round in their own ways: estimates of roots, and sines, whose code is chosen at run time.
std::string processor() {
    Hash hash;
    for (int i = 1; i < 1000; ++i) {
        const float a = 0.37f * float(i);
        const float of_a[] = {rough_root(a), std::sin(a), std::cos(a)};
        hash.add(std::span<const float>(of_a));
    }
    return fmt::format("{}, compiler {}, {}", cpu_instructions(), __VERSION__, hash.text());
}

// Where a body ends that swings freely, or with all that can act on it.
std::string end_of(Body body, Integrator integrator, Backend backend, bool acted_on) {
    const Acting on = acted_on ? everything(body) : Acting{};
    if (acted_on) body.link_damping = 1e-4f;
    Simulation how = simulation(body, on, integrator, backend, acted_on ? 2 : 1);
    how.step = 0.0002;  // and none that depends on how the bound is found
    const auto solver = make_solver(body, how);
    Hash hash;
    for (int call = 0; call < 2; ++call) {
        const Stats stats = solver->step((acted_on ? 7 : 21) * how.step, on.influences());
        EXPECT_FALSE(stats.diverged);
        hash.add(std::span(stats.reactions));
        hash.add(std::span(stats.pushes));
    }
    const State end = solver->save();
    hash.add(std::span(end.positions));
    hash.add(std::span(end.velocities));
    return hash.text();
}

const std::string golden_file = PALPATE_SOURCE_DIR "/tests/solver/golden.txt";

// By what comes before the last tab of a line.
std::map<std::string, std::string> known_ends() {
    std::map<std::string, std::string> ends;
    std::ifstream file(golden_file);
    for (std::string line; std::getline(file, line);)
        if (const auto tab = line.rfind('\t'); tab != line.npos)
            ends[line.substr(0, tab)] = line.substr(tab + 1);
    return ends;
}

TEST(Golden, BodiesMoveAsTheyAlwaysHave) {
#ifndef NDEBUG
    GTEST_SKIP() << "not available: golden.txt is of optimised builds";
#endif
    std::map<std::string, std::string> known = known_ends();
    const std::string here = processor();
    const char* wish = std::getenv("PALPATE_GOLDEN");
    const bool writes = wish && std::string(wish) == "write";
    const bool is_known =
        std::ranges::any_of(known, [&](const auto& one) { return one.first.starts_with(here); });
    if (!writes && !is_known)
        GTEST_SKIP() << "not available: golden.txt has no values for a processor that rounds like this one, "
                     << here;
    for (const auto& [name, body] : odd_bodies())
        for (const Integrator integrator : every_integrator())
            for (const Backend backend : {Backend::reference, Backend::cpu})
                for (const bool acted_on : {false, true}) {
                    const std::string key = fmt::format("{}\t{}\t{}\t{}\t{}", here, name_of(backend), name,
                                                        name_of(integrator), acted_on ? "acted on" : "free");
                    const std::string end = end_of(body, integrator, backend, acted_on);
                    if (writes)
                        known[key] = end;
                    else
                        EXPECT_EQ(known[key], end) << key;
                }
    if (!writes) return;
    std::ofstream file(golden_file);
    for (const auto& [key, end] : known) file << key << '\t' << end << '\n';
}

}  // namespace
}  // namespace palpate
