#include "palpate/run/contacts.h"

#include "palpate/base/files.h"

#include <fmt/format.h>

#include <iterator>

namespace palpate {

double ToolContact::normal() const {
    return end.normal == dvec3(0) ? glm::length(force) : glm::dot(force, end.normal);
}

double ToolContact::friction() const {
    return end.normal == dvec3(0) ? 0 : glm::length(force - normal() * end.normal);
}

ContactTable::ContactTable(const Scene& scene)
    : scene_(scene),
      text_(
          "time_s,tool,body,force_x_n,force_y_n,force_z_n,normal_n,friction_n,place_x_m,place_y_m,place_z_m,"
          "penetration_m,area_m2,pressure_pa\n") {}

void ContactTable::add(std::span<const ToolContact> contacts) {
    auto out = std::back_inserter(text_);
    for (const ToolContact& one : contacts) {
        const dvec3 f = one.force, p = one.end.place;
        fmt::format_to(out, "{:.9g},{},{},", one.time, scene_.tools[one.tool].name,
                       scene_.bodies[one.body].name);
        fmt::format_to(out, "{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},", f.x, f.y, f.z, one.normal(),
                       one.friction());
        fmt::format_to(out, "{:.7g},{:.7g},{:.7g},", p.x, p.y, p.z);
        fmt::format_to(out, "{:.7g},{:.7g},{:.7g}\n", one.end.penetration, one.end.area(),
                       one.end.pressure());
    }
}

void ContactTable::write(const std::filesystem::path& path) const { write_text(path, text_); }

}  // namespace palpate
