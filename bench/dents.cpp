#include "bench/studies.h"
#include "palpate/body/dent.h"

#include <cmath>

namespace palpate::studies {
namespace {

constexpr float width = 0.01f;  // m; only the paper's axis, which is not normalised, depends on it

// The profile of the undented surface: an arc of this curvature, 1/m, with the dent at 0, where its normal
// points up.
struct Arc {
    double curvature;

    dvec3 normal(double along) const { return {std::sin(curvature * along), 0, std::cos(curvature * along)}; }
    dvec3 place(double along) const {
        if (!(curvature > 0)) return {along, 0, 0};
        const double half = std::sin(0.5 * curvature * along);
        return {std::sin(curvature * along) / curvature, 0, -2 * half * half / curvature};
    }
};

// The arc displaced along its normals, and its own normals by central differences.
struct DentedArc {
    Arc arc;
    double height;  // m, in the middle: below 0 a dent

    dvec3 place(double along) const {
        const dvec3 p = arc.place(along);
        return p + height * std::exp(-0.5 * glm::dot(p, p) / (double(width) * width)) * arc.normal(along);
    }
    dvec3 normal(double along) const {
        const double h = 1e-4 * width;
        const dvec3 t = place(along + h) - place(along - h);
        return glm::normalize(dvec3(-t.z, 0, t.x));
    }
};

// Section IV.B of the 2007 paper as printed, except for the corrections asked for.
dvec3 normal_of_2007(const Arc& arc, double along, double depth, bool negative_exponent, bool unit_axis) {
    const dvec3 place = arc.place(along), normal = arc.normal(along);
    const double d = glm::length(place), square = double(width) * width;
    const double exponent = (negative_exponent ? -0.5 : 0.5) * d * d / square;
    const double angle = std::atan(depth * d / square * std::exp(exponent));  // of -G'
    const dvec3 to_contact = -DentedArc{arc, depth}.place(along);
    dvec3 axis = glm::cross(normal, to_contact);
    if (unit_axis) axis = glm::normalize(axis);
    const dvec3 kept = axis * glm::dot(normal, axis);
    return kept + (normal - kept) * std::cos(angle) + glm::cross(normal, axis) * std::sin(angle);
}

double degrees_between(dvec3 a, dvec3 b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

}  // namespace

DentNormals dent_normals(double width_over_radius, double depth_over_width) {
    const Arc arc{width_over_radius / width};
    const double depth = depth_over_width * width;
    const DentedArc dent{arc, -depth}, bump{arc, depth};
    const Dent one{vec3(0), float(depth), width};
    DentNormals worst;
    auto raise = [](double& most, double value) {
        if (!(value <= most)) most = value;
    };
    for (int i = 1; i <= 300; ++i) {
        const double along = 3.0 * width * i / 300;
        const vec3 ours = dented_normal({&one, 1}, vec3(arc.place(along)), vec3(arc.normal(along)));
        raise(worst.ours, degrees_between(dent.normal(along), dvec3(ours)));
        auto of_2007 = [&](bool negative_exponent, bool unit_axis) {
            return degrees_between(bump.normal(along),
                                   normal_of_2007(arc, along, depth, negative_exponent, unit_axis));
        };
        raise(worst.printed, of_2007(false, false));
        raise(worst.with_exponent, of_2007(true, false));
        raise(worst.with_axis, of_2007(false, true));
        raise(worst.with_both, of_2007(true, true));
    }
    return worst;
}

}  // namespace palpate::studies
