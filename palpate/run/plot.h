#pragma once
#include "palpate/run/report.h"

#include <filesystem>
#include <string>
#include <vector>

namespace palpate {

struct Curve {
    std::string name;
    std::vector<double> x, y;  // as many of each
};

/// One set of axes with its curves.
struct Panel {
    std::string x_label, y_label;
    std::vector<Curve> curves;
    bool logarithmic = false;  // both axes, in powers of ten; what is not above zero is left out
};

/// Writes panels below each other as an SVG, with axes from round numbers to round numbers. Throws Error.
void write_plot(const std::string& title, const std::vector<Panel>& panels,
                const std::filesystem::path& path);

/// The contact force and the indentation over time, one curve a tool.
void write_plot(const Report& report, const std::filesystem::path& path);

}  // namespace palpate
