#include "palpate/run/contacts.h"

#include "palpate/base/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace palpate {

double ToolContact::normal() const {
    return end.normal == dvec3(0) ? glm::length(force) : glm::dot(force, end.normal);
}

double ToolContact::friction() const { return end.normal == dvec3(0) ? 0 : glm::length(force - push()); }

ContactTable::ContactTable(const Scene& scene)
    : scene_(scene),
      text_(
          "time_s,tool,body,force_x_n,force_y_n,force_z_n,normal_n,friction_n,place_x_m,place_y_m,place_z_m,"
          "penetration_m,area_m2,pressure_pa") {
    for (const ToolRecipe& tool : scene.tools)
        if (tool.pad) {
            rows_ = std::max(rows_, tool.pad->rows);
            columns_ = std::max(columns_, tool.pad->columns);
        }
    for (int r = 1; r <= rows_; ++r)
        for (int c = 1; c <= columns_; ++c) text_ += fmt::format(",taxel_{}_{}_pa", r, c);
    text_ += '\n';
}

void ContactTable::add(std::span<const ToolContact> contacts) {
    auto out = std::back_inserter(text_);
    for (const ToolContact& one : contacts) {
        fmt::format_to(out, "{:.9g},{},{}", one.time, scene_.tools[one.tool].name,
                       scene_.bodies[one.body].name);
        const dvec3 f = one.force, p = one.end.place;
        for (double number : {f.x, f.y, f.z, one.normal(), one.friction(), p.x, p.y, p.z, one.end.penetration,
                              one.end.area(), one.end.pressure()})
            fmt::format_to(out, ",{:.7g}", number);
        add_taxels(one);
        text_ += '\n';
    }
}

// The fields of taxels that the tool's pad does not have stay empty.
void ContactTable::add_taxels(const ToolContact& contact) {
    const auto& pad = scene_.tools[contact.tool].pad;
    for (int r = 0; r < rows_; ++r)
        for (int c = 0; c < columns_; ++c) {
            text_ += ',';
            if (pad && r < pad->rows && c < pad->columns)
                text_ += fmt::format("{:.5g}", contact.taxels[std::size_t(r * pad->columns + c)]);
        }
}

void ContactTable::write(const std::filesystem::path& path) const { write_text(path, text_); }

}  // namespace palpate
