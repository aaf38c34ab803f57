#include "palpate/touch/force.h"

#include "palpate/base/error.h"

#include <algorithm>

namespace palpate {
namespace {

// The normal of the dented surface, on the side that is touched.
double lasting_depth(std::span<const Dent> lasting, const Contact& contact, dvec3 normal) {
    const double side = contact.behind ? -1 : 1;
    return std::max(side * double(depth_at(lasting, vec3(contact.point), vec3(side * normal))), 0.0);
}

}  // namespace

double lasting_depth(std::span<const Dent> lasting, const Contact& contact) {
    return lasting_depth(lasting, contact, contact.normal);
}

dvec3 force(const Proxy& proxy, dvec3 hand, dvec3 velocity, std::span<const Feel> feels,
            std::span<const Dent> lasting, int from) {
    const Contact* most = nullptr;
    dvec3 sunk(0), sunk_in_all(0);
    for (const Contact& contact : proxy.contacts()) {
        sunk_in_all += contact.depth * contact.normal;
        if (contact.surface < from) continue;
        sunk += contact.depth * contact.normal;
        if (!most || contact.depth > most->depth) most = &contact;
    }
    if (!most) return dvec3(0);
    const double depth = glm::length(sunk);
    if (!(depth > 0)) return dvec3(0);
    if (std::size_t(most->surface) >= feels.size())
        throw Error("fewer Feels than the patch has surfaces", "the force of a proxy", "give one for each");
    const Feel& feel = feels[std::size_t(most->surface)];
    const dvec3 normal = sunk / depth;

    const double there = lasting_depth(lasting, *most, normal), left = depth - there;
    if (!(left > 0)) return dvec3(0);
    const double going_out = glm::dot(velocity - most->velocity, normal);
    const double push = std::max(feel.stiffness * left - feel.damping * going_out, 0.0);
    const double side = most->behind ? -1 : 1;
    const dvec3 turned =
        there > 0 ? side * dvec3(dented_normal(lasting, vec3(most->point), vec3(side * normal))) : normal;
    const dvec3 pushed = push / std::max(glm::dot(turned, normal), 0.1) * turned;

    dvec3 along = feel.stiffness * (proxy.position() - hand - sunk_in_all);
    const double held = glm::length(along), most_held = feel.friction.still * push;
    if (held > most_held) along *= most_held / held;
    return pushed + along;
}

}  // namespace palpate
