#pragma once
#include "palpate/scene/scene.h"
#include "palpate/solver/contact_force.h"

#include <filesystem>
#include <span>
#include <string>

namespace palpate {

/// What a tool did to a body during one slice of a play.
struct ToolContact {
    std::size_t tool = 0, body = 0;  // their numbers in the scene
    double time = 0;                 // s, the end of the slice
    dvec3 force = dvec3(0);          // N, on the body, the mean over the slice
    Press press;                     // the tool's tip at the end,
    ContactForce end;                // and what it does there
    std::vector<double> taxels;      // Pa, of its pad, if it has one; only where each slice is followed

    double normal() const;    // N, the force along the normal; all of it where the tip has left the body
    double friction() const;  // N, the rest
    dvec3 push() const { return normal() * end.normal; }  // N, the former as a vector
};

/// All contacts of a run as a table, CSV. docs/report.md describes it.
class ContactTable {
 public:
    explicit ContactTable(const Scene& scene);

    void add(std::span<const ToolContact> contacts);

    /// Throws Error if it cannot.
    void write(const std::filesystem::path& path) const;

 private:
    void add_taxels(const ToolContact& contact);

    const Scene& scene_;
    int rows_ = 0, columns_ = 0;  // of the largest pad
    std::string text_;
};

}  // namespace palpate
