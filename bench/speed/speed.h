#pragma once
#include "palpate/body/body.h"
#include "palpate/body/cloth.h"
#include "palpate/body/simulation.h"
#include "palpate/run/plot.h"

#include <functional>
#include <string>
#include <vector>

// The speed of Palpate against the limits of this machine and against Bullet, printed by `palpate bench`.

namespace palpate::gl {
class Context;
}

namespace palpate::speed {

/// The material of all measured cloths.
inline const ClothSettings linen{.density = 0.15f, .damping = 2};

/// What one run of a case did.
struct Work {
    double seconds = 0;
    double amount = 0;  // in units of its own: node-steps, vertices, links, bytes
};

/// Something to time.
struct Case {
    std::string name;
    std::function<Work()> run;  // for a twentieth of a second or so
    double links = 0;           // evaluated per unit, with those missing at a rim, which cost as much
    double bytes = 0;           // that must be read or written per unit
    double memory = 0;          // bytes kept per node
    int threads = 1;
};

/// Units a second.
struct Rate {
    double best = 0, median = 0;
};

/// The measured rates of cases and of the machine's limits, interleaved so that each meets the same noise.
struct Timings {
    std::vector<Case> cases;
    std::vector<Rate> rates;                // of the cases
    std::vector<Rate> arithmetic, copying;  // links and bytes a second on 1, 2, ... threads
    std::string driver = {};                // OpenGL's, in a sentence; empty where it was not needed
    struct Figure {
        std::string name;  // with its unit
        double value;
    };
    std::vector<Figure> figures = {};  // other than rates
    std::vector<Panel> panels = {};    // to be drawn

    /// Null if there is none of that name.
    const Rate* find(const std::string& name) const;
};
/// `limits`: up to how many threads these are measured; by default, all of the machine's.
Timings time(std::vector<Case> cases, int rounds, int limits = -1);

/// The limits: springs that stay in the registers (for each a reciprocal square root and 13 operations), and
/// a copy that is too large for the caches.
Work arithmetic(int threads);
Work copying(int threads);

/// Steps of a body, of 10 µs each, `steps_a_call` in a call. A body on the GPU needs the context, whose
/// commands are waited for.
Case stepping(std::string name, const Body& body, const Simulation& how, const gl::Context* context = nullptr,
              int steps_a_call = 1 << 30);

/// How many repetitions of something of so many seconds take a twentieth of a second.
int times_for(double seconds);

/// Bullet's soft body of the same nodes and springs: an iteration over its links, or a whole step. No cases
/// if Palpate was built without it.
std::vector<Case> bullet(const Body& body);

/// The cell of a case or a figure in a table; its name is all three.
struct Cell {
    std::string table, row, column;
    std::string name() const { return table + " / " + row + " / " + column; }
};
Cell cell_of(const std::string& name);

/// The rows and columns of a table, in the order in which its cells come.
struct Outline {
    std::vector<std::string> rows, columns;
    void add(const Cell& cell);
};

/// A table, in Markdown.
std::string markdown(const Timings& timings, const std::string& unit);

/// A benchmark, which `palpate bench` knows by its name.
struct Benchmark {
    std::string name, about;
    bool by_default;  // false: only by its name, since it takes minutes
    std::function<Timings(int rounds)> run;
    std::function<std::string(const Timings&)> text;                // Markdown
    std::function<std::vector<Panel>(const Timings&)> curves = {};  // for a plot; may be empty
};
const std::vector<Benchmark>& benchmarks();

std::vector<Case> lattice_cases();
std::vector<Case> cloth_cases();
std::vector<Case> embed_cases();

Benchmark pipeline();      // the 2012 paper's tables
Benchmark heart();         // the 2005 paper's figures
Benchmark touch();         // the 2007 paper's table
Benchmark live();          // a hand that presses what it feels
Benchmark tissue_study();  // against theory and finite elements
Benchmark viewer();        // only where the viewer was built (PALPATE_VIEWER)

}  // namespace palpate::speed
