#include "palpate/run/report.h"

#include "palpate/base/files.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace palpate {
namespace {

using Json = nlohmann::ordered_json;

// The sum or the largest over a list of one of its members.
template <class T, class V>
V sum(const std::vector<T>& list, V T::*member) {
    V total{};
    for (const T& one : list) total += one.*member;
    return total;
}
template <class T>
double largest(const std::vector<T>& list, double T::*member) {
    double most = 0;
    for (const T& one : list) most = std::max(most, one.*member);
    return most;
}

Json or_null(const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); }

double shortest_step(const Report& report) {
    double step = 0;
    for (const Report::Body& body : report.bodies)
        if (body.step > 0 && (step == 0 || body.step < step)) step = body.step;
    return step;
}

Json to_json(const Report::Body& body) {
    return {{"name", body.name},
            {"nodes", body.nodes},
            {"pinned", body.pinned},
            {"springs", body.springs},
            {"cells", body.cells},
            {"vertices", body.vertices},
            {"faces", body.faces},
            {"spacing_m", body.spacing},
            {"mass_kg", body.mass},
            {"volume_m3", body.volume},
            {"steps", body.steps},
            {"step_s", body.step},
            {"kinetic_energy_j", body.kinetic_energy},
            {"elastic_energy_j", body.elastic_energy},
            {"largest_speed_m_s", body.largest_speed},
            {"inverted_cells", body.inverted_cells},
            {"held_at_start", body.held_at_start},
            {"mended", body.mended}};
}

Json to_json(const Report::Tool& tool) {
    return {{"name", tool.name},
            {"largest_force_n", tool.largest_force},
            {"deepest_indentation_m", tool.deepest_indentation},
            {"largest_normal_force_n", tool.largest_normal_force},
            {"deepest_penetration_m", tool.deepest_penetration},
            {"largest_area_m2", tool.largest_area},
            {"largest_pressure_pa", tool.largest_pressure},
            {"time_s", tool.time},
            {"force_n", tool.force},
            {"indentation_m", tool.indentation}};
}

}  // namespace

std::optional<double> Report::frames_per_second() const {
    const double busy = seconds.simulate + seconds.map + seconds.render;
    const bool moves = std::ranges::any_of(bodies, [](const Body& body) {
        return body.nodes > body.pinned || body.largest_speed > 0;  // freely, or as a [[move]] says
    });
    if (frames == 0 || !(busy > 0) || (!moves && tools.empty() && pictures == 0)) return std::nullopt;
    return frames / busy;
}

void write_report(const Report& report, const std::filesystem::path& path) {
    using Body = Report::Body;
    using Tool = Report::Tool;
    Json json = {{"scene", report.scene},
                 {"backend", report.backend},
                 {"integrator", report.integrator},
                 {"threads", report.threads},
                 {"renderer", report.renderer},
                 {"nodes", sum(report.bodies, &Body::nodes)},
                 {"springs", sum(report.bodies, &Body::springs)},
                 {"vertices", sum(report.bodies, &Body::vertices)},
                 {"faces", sum(report.bodies, &Body::faces)},
                 {"frames", report.frames},
                 {"pictures", report.pictures},
                 {"steps", sum(report.bodies, &Body::steps)},
                 {"step_s", shortest_step(report)},
                 {"simulated_s", report.simulated},
                 {"seconds",
                  {{"build", report.seconds.build},
                   {"simulate", report.seconds.simulate},
                   {"map", report.seconds.map},
                   {"render", report.seconds.render},
                   {"write", report.seconds.write},
                   {"total", report.seconds.total}}},
                 {"frames_per_second", or_null(report.frames_per_second())},
                 {"kinetic_energy_j", sum(report.bodies, &Body::kinetic_energy)},
                 {"elastic_energy_j", sum(report.bodies, &Body::elastic_energy)},
                 {"largest_speed_m_s", largest(report.bodies, &Body::largest_speed)},
                 {"deepest_indentation_m", largest(report.tools, &Tool::deepest_indentation)},
                 {"largest_force_n", largest(report.tools, &Tool::largest_force)},
                 {"diverged", report.diverged},
                 {"at_rest", report.rest.has_value()},
                 {"rest_s", or_null(report.rest)},
                 {"notes", report.notes},
                 {"bodies", Json::array()},
                 {"tools", Json::array()}};
    for (const Body& body : report.bodies) json["bodies"].push_back(to_json(body));
    for (const Tool& tool : report.tools) json["tools"].push_back(to_json(tool));
    write_text(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace palpate
