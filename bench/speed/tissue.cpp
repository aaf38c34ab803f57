// Tissue against theory and finite elements (bench/tissue.h).
#include "bench/tissue.h"

#include "bench/speed/drawing.h"
#include "palpate/base/pipe.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <span>
#include <utility>

namespace palpate::speed {
namespace {

using namespace studies;

const std::string sags = "A cantilever's sag under its own weight over Timoshenko's, by its thickness",
                  torques = "A bar's torque over Saint-Venant's, by its thickness",
                  tips = "The force on a sphere that presses over that of theory; lengths in spacings",
                  volumes = "A block of Poisson's ratio 0.49 from whose height a ball presses away a third",
                  laws =
                      "The laws alone: the stress in a bar that is pressed, its sides free, over CalculiX's",
                  frequencies =
                      "The highest frequency of tissue that is pressed like that bar, over that at rest",
                  beams = "A beam that bends far under its own weight";

constexpr Plate plates[] = {Plate::flat, Plate::dished};
constexpr double ratios[] = {0.45, 0.49};
constexpr float ratios_of_bars[] = {0.3f, 0.45f, 0.49f};
constexpr double depths[] = {0.05, 0.1, 0.15, 0.2, 0.25, 0.3};
constexpr double shortenings[] = {0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5};

// What a block is computed by, and how many cells or elements it is high.
struct Method {
    const char *name, *parts;
    int count;
    std::string row() const { return fmt::format("{}, {} {}", name, count, parts); }
};
constexpr Method tissue_methods[] = {
    {"tissue", "cells", 8}, {"tissue", "cells", 16}, {"tissue", "cells", 32}};
constexpr Method element_methods[] = {
    {"CalculiX", "elements", 4}, {"CalculiX", "elements", 8}, {"CalculiX", "elements", 12}};
constexpr const Method &finest_tissue = tissue_methods[2], &finest_elements = element_methods[2];

std::string ratio_of(double poisson) { return fmt::format("Poisson's ratio {}", float(poisson)); }

const char* name_of(Plate plate) { return plate == Plate::flat ? "flat" : "dished"; }

std::string percent(double part) { return fmt::format("{:.0f} %", 100 * part); }

std::string press_table(Plate plate, double poisson) {
    return fmt::format("A block under a {} plate, {}; volume and energy at the last", name_of(plate),
                       ratio_of(poisson));
}

// All that is measured, by the names of cells.
class Study {
 public:
    void add(const std::string& table, const std::string& row, const std::string& column, double value) {
        timings_.figures.push_back({Cell{table, row, column}.name(), value});
    }

    void small_deformations() {
        for (float poisson : ratios_of_bars) {
            by_thickness(sags, tissue_sag, poisson);
            if (has_ccx_) add(sags, ratio_of(poisson), "the solid, by CalculiX", solid_sag(double(poisson)));
        }
        for (float poisson : ratios_of_bars) by_thickness(torques, tissue_torque, poisson);
    }

    void by_thickness(const std::string& table, double (*measure)(int cells, float poisson), float poisson) {
        for (int cells : {1, 2, 4, 8})
            add(table, ratio_of(poisson), fmt::format("{} cell{}", cells, cells > 1 ? "s" : ""),
                measure(cells, poisson));
    }

    void tip(const std::string& name, const Indenter& indenter, std::span<const double> how_deep) {
        for (const Indentation& one : indent(indenter, how_deep)) {
            const std::string row =
                fmt::format("{}, ratio {}, {:.2f} deep", name, indenter.poisson, one.depth);
            add(tips, row, "radius of contact", one.contact);
            add(tips, row, "over the height", one.contact / indenter.height);
            add(tips, row, "force over Hertz's", one.over_hertz);
            add(tips, row, "over that on a layer", one.over_layer);
        }
    }

    void ball() {
        const UnderABall block = press_with_a_ball();
        add(volumes, "tissue, 12 cells", "pressed away", block.depth);
        add(volumes, "tissue, 12 cells", "volume over that at rest", block.volume);
    }

    void plate(Plate plate, double poisson) {
        const Block block{.poisson = poisson};
        auto take = [&](const Method& method, const std::vector<PressedBlock>& pressed) {
            const std::string table = press_table(plate, poisson);
            for (const PressedBlock& one : pressed)
                add(table, method.row(), "N at " + percent(one.depth), one.force);
            add(table, method.row(), "volume", pressed.back().volume);
            add(table, method.row(), "energy, mJ", 1e3 * pressed.back().energy);
            add(table, method.row(), "by the tissue's law", 1e3 * pressed.back().energy_by_ours);
        };
        for (const Method& method : tissue_methods) take(method, press(block, plate, depths, method.count));
        if (has_ccx_)
            for (const Method& method : element_methods)
                take(method, press_by_elements(block, plate, depths, method.count));
    }

    void beam() {
        auto take = [&](const Method& method, const BentBeam& bent) {
            add(beams, method.row(), "sag, mm", 1e3 * bent.sag);
            add(beams, method.row(), "volume over that at rest", bent.volume);
        };
        for (const Method& method : tissue_methods) take(method, bend(studies::beam, method.count));
        if (has_ccx_)
            for (const Method& method : element_methods)
                take(method, bend_by_elements(studies::beam, method.count));
    }

    void bars(const std::string& table, double (*measure)(double poisson, double shortening),
              std::span<const double> how_much) {
        for (double poisson : ratios)
            for (double shortening : how_much)
                add(table, ratio_of(poisson), "by " + percent(shortening), measure(poisson, shortening));
    }

    Timings take() { return std::move(timings_); }

 private:
    Timings timings_;
    const bool has_ccx_ = has_program("ccx");
};

Timings run(int) {
    Study study;
    study.small_deformations();
    study.tip("thick block, 80 x 80 x 56, radius 30",
              {.width = 80, .height = 56, .radius = 30, .poisson = 0.45f}, std::vector{0.3, 0.6, 1.0});
    for (double poisson : ratios)
        study.tip("bonded layer, 80 x 80 x 16, radius 60",
                  {.width = 80, .height = 16, .radius = 60, .poisson = float(poisson)},
                  std::vector{0.5, 1.0, 1.5});
    study.ball();
    for (Plate plate : plates)
        for (double poisson : ratios) study.plate(plate, poisson);
    study.beam();
    study.bars(laws, bar_over_calculix, shortenings);
    study.bars(frequencies, frequency_when_pressed, std::vector{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7});
    return study.take();
}

using Values = std::map<std::string, double>;

Values values_of(const Timings& timings) {
    Values values;
    for (const auto& figure : timings.figures) values[figure.name] = figure.value;
    return values;
}

// Of the finest cells over that of the finest elements.
double over_elements(const Values& values, const std::string& table, const std::string& column) {
    return values.at(Cell{table, finest_tissue.row(), column}.name()) /
           values.at(Cell{table, finest_elements.row(), column}.name());
}

bool has_elements(const Outline& outline) {
    return std::ranges::count(outline.rows, finest_elements.row()) > 0;
}

std::string line(const std::string& name, const Outline& outline,
                 const std::function<double(const std::string& column)>& value) {
    std::vector<std::string> cells{name};
    for (const std::string& column : outline.columns) cells.push_back(fmt::format("{:#.4g}", value(column)));
    return row(cells);
}

std::string table_text(const std::string& table, const Outline& outline, const Values& values) {
    std::vector<std::string> columns{""};
    columns.insert(columns.end(), outline.columns.begin(), outline.columns.end());
    std::string text = table + ":\n\n" + head(columns);
    for (const std::string& name : outline.rows)
        text += line(name, outline, [&](const std::string& column) {
            return values.at(Cell{table, name, column}.name());
        });
    if (has_elements(outline))
        text += line("the finest of both: a ratio", outline,
                     [&](const std::string& column) { return over_elements(values, table, column); });
    else if (std::ranges::count(outline.rows, finest_tissue.row()) > 0)
        text += "\nCalculiX is not available: ccx (Debian package calculix-ccx)\n";
    return text + "\n";
}

std::string text(const Timings& timings) {
    std::vector<std::pair<std::string, Outline>> tables;
    for (const auto& figure : timings.figures) {
        const Cell cell = cell_of(figure.name);
        if (tables.empty() || tables.back().first != cell.table) tables.push_back({cell.table, {}});
        tables.back().second.add(cell);
    }
    std::string text;
    for (const auto& [table, outline] : tables) text += table_text(table, outline, values_of(timings));
    return text;
}

// How far the forces differ from CalculiX's, if it is here, and the laws do.
std::vector<Panel> curves(const Timings& timings) {
    const Values values = values_of(timings);
    std::vector<Panel> panels;
    for (double poisson : ratios) {
        Panel& panel =
            panels.emplace_back(Panel{fmt::format("depth (% of the height), {}", ratio_of(poisson)),
                                      "ours over CalculiX's, less 1 (%)",
                                      {}});
        auto curve = [&](const std::string& name, std::span<const double> at, const auto& ratio_at) {
            Curve& drawn = panel.curves.emplace_back(Curve{name, {0}, {0}});
            for (double depth : at) {
                drawn.x.push_back(100 * depth);
                drawn.y.push_back(100 * (ratio_at(percent(depth)) - 1));
            }
        };
        for (Plate plate : plates) {
            const std::string table = press_table(plate, poisson);
            if (values.contains(Cell{table, finest_elements.row(), "volume"}.name()))
                curve(fmt::format("under a {} plate", name_of(plate)), depths,
                      [&](const std::string& at) { return over_elements(values, table, "N at " + at); });
        }
        curve("the laws alone, in a bar", shortenings, [&](const std::string& at) {
            return values.at(Cell{laws, ratio_of(poisson), "by " + at}.name());
        });
    }
    return panels;
}

}  // namespace

Benchmark tissue_study() {
    return {"tissue", "a neo-Hookean solid against theory and finite elements", false, run, text, curves};
}

}  // namespace palpate::speed
