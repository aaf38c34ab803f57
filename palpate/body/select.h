#pragma once
#include "palpate/body/body.h"
#include "palpate/mesh/volume.h"

#include <span>
#include <vector>

namespace palpate {

// Ways to point at nodes of a body at rest. Each returns node numbers in rising order.

/// The nodes in the lowest `fraction` of the body's height along `down`; 0.15 is the lowest 15 %.
std::vector<int> nodes_below(const Body& body, float fraction, vec3 down);

/// The nodes within `radius` of a point; 0 gives the nearest node alone.
std::vector<int> nodes_near(const Body& body, vec3 point, float radius = 0);

/// The nodes in a box, its faces included.
std::vector<int> nodes_in(const Body& body, const Bounds& box);

/// The nodes that lie in voxels of this value: a label volume says what is what. Outside it there are none.
std::vector<int> nodes_labelled(const Body& body, const Volume& labels, float label);

/// Makes the springs of each node so many times as stiff as they are: one factor a node, and a spring takes
/// the mean of its ends'.
void strengthen(Body& body, std::span<const float> factors);

/// No force moves these nodes any more: their inverse mass becomes 0. Throws Error if the body has not all of
/// them.
void pin(Body& body, std::span<const int> nodes);

}  // namespace palpate
