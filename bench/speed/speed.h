#pragma once
#include "palpate/body/body.h"
#include "palpate/body/cloth.h"
#include "palpate/body/simulation.h"
#include "palpate/run/plot.h"

#include <functional>
#include <string>
#include <vector>

// How fast Palpate is: against what this machine can do at best, and against others. `palpate bench` prints
// it.

namespace palpate::gl {
class Context;
}

namespace palpate::speed {

/// What all measured cloths are of.
inline const ClothSettings linen{.density = 0.15f, .damping = 2};

/// What one run of something did.
struct Work {
    double seconds = 0;
    double amount = 0;  // in units of its own: node-steps, vertices, links, bytes
};

/// Something to time.
struct Case {
    std::string name;
    std::function<Work()> run;  // some of it, for a twentieth of a second or so
    double links = 0;           // evaluated for a unit, those that a node lacks included: they cost as much
    double bytes = 0;           // that have to be read or written for a unit
    double memory = 0;          // bytes that a unit's node keeps
    int threads = 1;
};

/// Units a second.
struct Rate {
    double best = 0, median = 0;
};

/// What became of cases, and beside them of the machine's own limits: all ran by turns, so that each met the
/// same noise.
struct Timings {
    std::vector<Case> cases;
    std::vector<Rate> rates;                // of the cases
    std::vector<Rate> arithmetic, copying;  // links and bytes a second on 1, 2, ... threads
    std::string driver = {};                // OpenGL's, in a sentence; empty where it was not needed
    struct Figure {
        std::string name;  // with its unit
        double value;
    };
    std::vector<Figure> figures = {};  // what is no rate
    std::vector<Panel> panels = {};    // to be drawn

    /// None of that name: null.
    const Rate* find(const std::string& name) const;
};
/// `limits`: on how many threads those are measured; the machine's by default.
Timings time(std::vector<Case> cases, int rounds, int limits = -1);

/// The limits: springs that never leave the registers (for each a reciprocal root and 13 operations), and a
/// copy that is too large for the caches.
Work arithmetic(int threads);
Work copying(int threads);

/// Steps of a body, of 10 µs each, as many in a call as are said. In a context if it moves on the GPU, which
/// is waited for.
Case stepping(std::string name, const Body& body, const Simulation& how, const gl::Context* context = nullptr,
              int steps_a_call = 1 << 30);

/// How often something of so many seconds has to be done for a twentieth of a second.
int times_for(double seconds);

/// Bullet's soft body of the same nodes and springs: a pass over its links, or a whole step. No case where
/// Palpate was built without it.
std::vector<Case> bullet(const Body& body);

/// A table, in Markdown.
std::string markdown(const Timings& timings, const std::string& unit);

/// A benchmark, which `palpate bench` knows by its name.
struct Benchmark {
    std::string name, about;
    bool by_default;  // or only if it is asked for: it takes minutes
    std::function<Timings(int rounds)> run;
    std::function<std::string(const Timings&)> text;                // Markdown
    std::function<std::vector<Panel>(const Timings&)> curves = {};  // for a plot; or none
};
const std::vector<Benchmark>& benchmarks();

std::vector<Case> lattice_cases();
std::vector<Case> cloth_cases();
std::vector<Case> embed_cases();

Benchmark pipeline();  // the 2012 paper's tables
Benchmark heart();     // the 2005 paper's figures
Benchmark touch();     // the 2007 paper's table
Benchmark viewer();    // only where the viewer was built (PALPATE_VIEWER)

}  // namespace palpate::speed
