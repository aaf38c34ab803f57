#include "palpate/run/plot.h"

#include "palpate/base/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace palpate {
namespace {

constexpr double width = 960, panel_height = 260, left = 80, right = 190, top = 50, between = 70;
constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                   "#e69f00", "#56b4e9", "#555555"};  // distinguishable also with colour
                                                                      // blindness

// Ticks at round numbers that cover a range.
struct Axis {
    double low, high, tick;
    Axis(double least, double most, int ticks) {
        if (!(most > least)) most = least + 1;
        const double raw = (most - least) / ticks, power = std::pow(10, std::floor(std::log10(raw)));
        tick = power * (raw <= power ? 1 : raw <= 2 * power ? 2 : raw <= 5 * power ? 5 : 10);
        low = std::floor(least / tick) * tick;
        high = std::ceil(most / tick - 1e-9) * tick;
    }
    double part(double value) const { return (value - low) / (high - low); }
};

// The unscaled position of a value on an axis; NaN for the logarithm of a value that is not above zero.
double place(const Panel& panel, double value) {
    if (!panel.logarithmic) return value;
    return value > 0 ? std::log10(value) : std::nan("");
}

Axis axis_of(const Panel& panel, std::vector<double> Curve::*values, int ticks) {
    std::vector<double> places;
    if (!panel.logarithmic) places.push_back(0);
    for (const Curve& curve : panel.curves)
        for (double v : curve.*values)
            if (const double at = place(panel, v); std::isfinite(at)) places.push_back(at);
    if (places.empty()) places.push_back(0);
    const auto [least, most] = std::minmax_element(places.begin(), places.end());
    if (!panel.logarithmic) return {*least, *most, ticks};
    Axis axis(*least, *most, ticks);
    axis.tick = 1;
    axis.low = std::floor(*least);
    axis.high = std::max(std::ceil(*most), axis.low + 1);
    return axis;
}

std::string escape(std::string_view text) {
    std::string safe;
    for (char c : text) safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : std::string(1, c);
    return safe;
}

std::string text(double x, double y, const char* anchor, std::string_view words, std::string_view more = "") {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" {}>{}</text>\n", x, y, anchor,
                       more, escape(words));
}

std::string line(double x1, double y1, double x2, double y2, const char* colour) {
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x1,
                       y1, x2, y2, colour);
}

// The label of a tick, without rounding errors.
std::string number(const Panel& panel, double value, double tick) {
    if (panel.logarithmic) return fmt::format("{:g}", std::pow(10, std::round(value)));
    return fmt::format("{:g}", std::round(value / tick * 1e6) / 1e6 * tick);
}

std::string draw(const Panel& panel, double above) {
    const Axis xs = axis_of(panel, &Curve::x, 8), ys = axis_of(panel, &Curve::y, 5);
    const double w = width - left - right, h = panel_height;
    auto x = [&](double value) { return left + w * xs.part(value); };
    auto y = [&](double value) { return above + h * (1 - ys.part(value)); };

    std::string svg;
    for (double v = ys.low; v <= ys.high + 0.5 * ys.tick; v += ys.tick)
        svg += line(left, y(v), left + w, y(v), "#ddd") +
               text(left - 8, y(v) + 4, "end", number(panel, v, ys.tick));
    for (double v = xs.low; v <= xs.high + 0.5 * xs.tick; v += xs.tick)
        svg += line(x(v), above + h, x(v), above + h + 5, "#555") +
               text(x(v), above + h + 20, "middle", number(panel, v, xs.tick));
    svg += line(left, above + h, left + w, above + h, "#555");
    svg += text(left + w / 2, above + h + 40, "middle", panel.x_label);
    svg += text(22, above + h / 2, "middle", panel.y_label,
                fmt::format("transform=\"rotate(-90 22 {:.1f})\"", above + h / 2));

    double key = above + 12;  // beside the panel, where no curve crosses it
    for (std::size_t c = 0; c < panel.curves.size(); ++c) {
        const Curve& curve = panel.curves[c];
        const char* colour = colours[c % std::size(colours)];
        std::string points;
        for (std::size_t i = 0; i < curve.x.size(); ++i)
            if (const double px = place(panel, curve.x[i]), py = place(panel, curve.y[i]);
                std::isfinite(px) && std::isfinite(py))
                points += fmt::format("{:.1f},{:.1f} ", x(px), y(py));
        svg += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n",
                           points, colour);
        svg += text(left + w + 12, key, "start", curve.name, fmt::format("fill=\"{}\"", colour));
        key += 18;
    }
    return svg;
}

}  // namespace

void write_plot(const std::string& title, const std::vector<Panel>& panels,
                const std::filesystem::path& path) {
    const double height = top + double(panels.size()) * (panel_height + between);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
        "font-family=\"sans-serif\" font-size=\"13\" fill=\"#222\">\n<rect width=\"{0}\" height=\"{1}\" "
        "fill=\"white\"/>\n",
        width, height);
    svg += text(width / 2, 28, "middle", title, "font-size=\"16\"");
    for (std::size_t i = 0; i < panels.size(); ++i)
        svg += draw(panels[i], top + double(i) * (panel_height + between));
    write_text(path, svg + "</svg>\n");
}

void write_plot(const Report& report, const std::filesystem::path& path) {
    Panel force{"time (s)", "contact force (N)", {}}, depth{"time (s)", "indentation (mm)", {}};
    for (const Report::Tool& tool : report.tools) {
        force.curves.push_back({tool.name, tool.time, tool.force});
        Curve& curve = depth.curves.emplace_back(Curve{tool.name, tool.time, tool.indentation});
        for (double& y : curve.y) y *= 1000;
    }
    write_plot("Touch in " + report.scene, {force, depth}, path);
}

}  // namespace palpate
