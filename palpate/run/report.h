#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpate {

/// The results of a run. docs/report.md describes the file; its keys are these names followed by their units.
struct Report {
    /// Of one body.
    struct Body {
        std::string name;
        std::size_t nodes = 0, pinned = 0, springs = 0, cells = 0, vertices = 0, faces = 0;
        double spacing = 0;               // m
        double mass = 0;                  // kg, of the free nodes
        double volume = 0;                // m³, enclosed by the surface at rest; 0 for an open sheet
        long steps = 0;                   // in all
        double step = 0;                  // s, the shortest taken
        double kinetic_energy = 0;        // J, at the end
        double elastic_energy = 0;        // J, at the end
        double largest_speed = 0;         // m/s, at the end of any frame
        std::size_t inverted_cells = 0;   // at the end of the worst frame
        std::size_t inverted_now = 0;     // at the end of the last
        std::size_t held_at_start = 0;    // free nodes inside colliders at the start
        std::vector<std::string> mended;  // the steps that made its surface
    };
    /// Of one tool.
    struct Tool {
        std::string name;
        double largest_force = 0;  // N
        double deepest_indentation =
            0;  // m, of a surface under the tip, relative to its place when the tip appeared
        // Of one that presses bodies, on any of them (ToolContact):
        double largest_normal_force = 0;  // N
        double deepest_penetration = 0;   // m, of the tip into the surface as it is pressed in
        double largest_area = 0;          // m²
        double largest_pressure = 0;      // Pa
        std::vector<double> time;         // s, the end of each frame
        std::vector<double> force;        // N, mean over the frame
        std::vector<double> indentation;  // m, at the end of the frame
    };
    /// Time by kind of work.
    struct Seconds {
        double build = 0, simulate = 0, map = 0, render = 0, write = 0, total = 0;
    };

    std::string scene, backend, integrator, renderer;
    int threads = 1;
    int frames = 0;              // of 1/60 s, but see RunSettings::steps
    int pictures = 0;            // drawn
    double simulated = 0;        // s
    Seconds seconds;             // s, of work
    bool diverged = false;       // then the run ended at the time `simulated`
    std::optional<double> rest;  // s, when a run with until_rest came to rest
    std::vector<Body> bodies;
    std::vector<Tool> tools;
    std::vector<std::string> notes;

    /// Frames per second of time spent on simulating, mapping and drawing; nothing if nothing moved, was felt
    /// or was drawn.
    std::optional<double> frames_per_second() const;
};

/// Writes a report as JSON. Throws Error if it cannot.
void write_report(const Report& report, const std::filesystem::path& path);

}  // namespace palpate
