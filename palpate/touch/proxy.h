#pragma once
#include "palpate/base/vectors.h"
#include "palpate/body/feel.h"
#include "palpate/body/patch.h"

#include <array>
#include <span>

namespace palpate {

/// A contact that stops the proxy.
struct Contact {
    dvec3 point;     // m, on the surface
    dvec3 normal;    // unit, from there to the proxy's centre
    dvec3 velocity;  // m/s, of the surface there
    int surface;     // the number of its Touchable,
    int triangle;    // which of its triangles,
    dvec3 weights;   // and where in that: barycentric
    double depth;    // m, the penetration of the hand along the normal; the sum of depth · normal leads from
                     // the hand to where the proxy would be without friction
    bool behind = false;  // for a sheet: whether it is touched from its back

    /// The normal on the front of its triangles.
    dvec3 front() const { return behind ? -normal : normal; }
};

/// The proxy: a ball that follows the hand but never enters a surface (the god-object of Zilles and Salisbury
/// 1995, with a size as in Ruspini, Kolarov and Khatib 1997). "Hand" here means its position, that of the
/// device's tip: the haptic interface point. A virtual coupling between the two, a spring, pushes the hand
/// back out. Between two calls the ball slides along up to three surfaces at once, with continuous collision
/// detection by exact distances, so that it passes through nothing, however fast it moves. Allocates nothing.
class Proxy {
 public:
    explicit Proxy(double radius) : radius_(radius) {}

    /// Puts it at a place, which should be free; it touches nothing.
    void put(dvec3 place);

    /// Moves it as near to the hand as the surfaces of the patch allow, which have moved on to `time` (s),
    /// and not beyond the patch. `friction`: one for each surface of the patch; throws Error if there are
    /// fewer. Returns how far surfaces have pushed or carried it, in m, beyond what their speeds explain: 0,
    /// unless a surface appeared or jumped.
    double follow(const Patch& patch, double time, dvec3 hand, std::span<const Friction> friction);

    dvec3 position() const { return place_; }  // m, of its centre
    double radius() const { return radius_; }
    void set_radius(double radius) { radius_ = radius; }  // m; from the next call on
    bool slips() const { return slips_; }

    /// The contacts that stop it, none of them redundant; none if it is where the hand is.
    std::span<const Contact> contacts() const { return {contacts_.data(), count_}; }

    /// The contact with the greatest depth; null if there is none.
    const Contact* deepest() const;

 private:
    class Near;
    void move_with_surface(const Patch& patch, double time, double explained);
    void leave_penetration(Near& near);
    void follow_receding_surface(Near& near);
    void approach(Near& near, dvec3 goal);
    void go(Near& near, dvec3 way);
    dvec3 constrained_way(Near& near, dvec3 goal);

    double radius_;
    dvec3 place_ = dvec3(0);
    double time_ = 0;
    bool slips_ = true;
    std::array<Contact, 3> contacts_ = {};
    std::size_t count_ = 0;
};

}  // namespace palpate
