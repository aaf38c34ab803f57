#pragma once
#include "palpate/body/body.h"

#include <optional>

namespace palpate {

/// What a machine counts places and velocities from.
struct Origin {
    dvec3 place = dvec3(0);     // m, in the world
    dvec3 velocity = dvec3(0);  // m/s, at which it goes on during a call

    Origin after(double seconds) const { return {place + seconds * velocity, velocity}; }
    bool operator==(const Origin&) const = default;
};

/// m, of any node at rest along any axis, without its sign.
float largest_coordinate(const Body& body);

/// The origin of one body, which goes along with it. A float has seven digits: counted from the world's
/// origin, a body that lies far out or falls fast spends them on the way there and on the speed that all its
/// nodes have alike; its springs feel what is lost, and shake it.
class FloatingOrigin {
 public:
    explicit FloatingOrigin(const Body& body);

    /// The body at rest, counted from the first origin. What float has lost is put right: a grid's nodes
    /// stand in straight lines again, and springs that were as long as their ends were apart still are.
    const Body& local(const Body& body) const { return local_ ? *local_ : body; }
    /// The body was edited.
    void change(const Body& body);

    /// The first origin: the world's, unless the body lies farther from it than twice its size.
    Origin first() const { return {home_}; }
    /// The origin of a body whose first node is there in the world, m, at this speed, m/s: the first one,
    /// until the node has gone farther than twice the body's size; then the origin goes with the node, and
    /// `now` serves on as long as the node has not gone far from that.
    Origin beside(dvec3 first_node, dvec3 velocity, const Origin& now) const;

 private:
    dvec3 home_ = dvec3(0);      // m, the first origin
    dvec3 begin_ = dvec3(0);     // m, the first node at rest, in the world
    double size_ = 0;            // m, of the body along its longest side
    std::optional<Body> local_;  // where home is not the world's origin
};

}  // namespace palpate
