#pragma once
#include "palpate/body/body.h"
#include "palpate/mesh/volume.h"

#include <span>
#include <vector>

namespace palpate {

// Selections of nodes of a body at rest. Each returns node numbers in increasing order.

/// The nodes in the lowest `fraction` of the body's height along `down`; 0.15 is the lowest 15 %.
std::vector<int> nodes_below(const Body& body, float fraction, vec3 down);

/// The nodes within `radius` of a point; 0 gives the nearest node alone.
std::vector<int> nodes_near(const Body& body, vec3 point, float radius = 0);

/// The nodes in a box, including its faces.
std::vector<int> nodes_in(const Body& body, const Bounds& box);

/// The nodes in voxels of this value in a label volume (a segmentation).
std::vector<int> nodes_labelled(const Body& body, const Volume& labels, float label);

/// Multiplies the stiffness of springs: one factor for each node, and a spring takes the mean of its ends.
void strengthen(Body& body, std::span<const float> factors);

/// Fixes these nodes: their inverse mass becomes 0, so no force moves them. Throws Error for a node that the
/// body does not have.
void pin(Body& body, std::span<const int> nodes);

}  // namespace palpate
