#pragma once
#include "palpate/run/report.h"

#include <filesystem>
#include <string>
#include <vector>

namespace palpate {

struct Curve {
    std::string name;
    std::vector<double> x, y;  // of equal length
};

/// One set of axes with its curves.
struct Panel {
    std::string x_label, y_label;
    std::vector<Curve> curves;
    bool logarithmic = false;  // on both axes; values that are not above zero are left out
};

/// Writes panels below each other as an SVG, with axes between round numbers. Throws Error.
void write_plot(const std::string& title, const std::vector<Panel>& panels,
                const std::filesystem::path& path);

/// The contact force and the indentation over time, with one curve for each tool.
void write_plot(const Report& report, const std::filesystem::path& path);

}  // namespace palpate
