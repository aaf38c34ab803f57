#pragma once
#include "palpate/base/vectors.h"
#include "palpate/body/feel.h"
#include "palpate/body/patch.h"

#include <array>
#include <span>

namespace palpate {

/// Where the proxy is stopped.
struct Contact {
    dvec3 point;     // m, on the surface
    dvec3 normal;    // unit, from there to the proxy's centre
    dvec3 velocity;  // m/s, of the surface there
    int surface;     // the number of its Touchable,
    int triangle;    // which of its triangles,
    dvec3 weights;   // and where in that: barycentric
    double depth;  // m, how far the hand is behind the surface along the normal; the depths times the normals
                   // are what leads from the hand to where the proxy would be without friction
    bool behind = false;  // of a sheet: whether it is touched from its other side

    /// The side that its triangles look to.
    dvec3 front() const { return behind ? -normal : normal; }
};

/// A ball that follows the hand but never enters a surface (the god-object of Zilles and Salisbury 1995, the
/// size of Ruspini, Kolarov and Khatib 1997): what the hand has sunk in, a virtual coupling pushes back, a
/// spring between the two. Between two calls the ball rolls along at most three surfaces at once, by exact
/// distances, so that neither speed nor a sharp edge takes it through. Allocates nothing.
class Proxy {
 public:
    explicit Proxy(double radius) : radius_(radius) {}

    /// Anew, at a place that is held to be free; it touches nothing.
    void put(dvec3 place);

    /// Goes as near to the hand as the patch allows, whose surfaces have moved on to `time` (s). `friction`:
    /// one for each surface of the patch; throws Error if they are fewer. Beyond what the patch knows it does
    /// not go.
    /// Returns how far surfaces have pushed or carried it, in m, beyond what their speeds explain: 0, unless
    /// a surface appeared or jumped.
    double follow(const Patch& patch, double time, dvec3 hand, std::span<const Friction> friction);

    dvec3 position() const { return place_; }  // m, of its centre
    double radius() const { return radius_; }
    void set_radius(double radius) { radius_ = radius; }  // m; from the next call on
    bool slips() const { return slips_; }

    /// Where it is stopped, with planes that are not redundant; none if it is where the hand is.
    std::span<const Contact> contacts() const { return {contacts_.data(), count_}; }

    /// The one where the hand is deepest; null if there is none.
    const Contact* deepest() const;

 private:
    class Near;
    void move_with_surface(const Patch& patch, double time, double explained);
    void leave_what_came_over_it(Near& near);
    void go_back_down(Near& near);
    void approach(Near& near, dvec3 goal);
    void go(Near& near, dvec3 way);
    dvec3 given_way(Near& near, dvec3 goal);

    double radius_;
    dvec3 place_ = dvec3(0);
    double time_ = 0;
    bool slips_ = true;
    std::array<Contact, 3> contacts_ = {};
    std::size_t count_ = 0;
};

}  // namespace palpate
