#pragma once
#include "palpate/body/body.h"
#include "palpate/body/material.h"
#include "palpate/scene/scene.h"

#include <string>
#include <vector>

// What holds the nodes of a body, and what it is made of to bear that.

namespace palpate {

/// The direction of gravity; without any, that of -y.
vec3 down(const Scene& scene);

/// The chosen nodes in increasing order, without duplicates. A criterion without nodes gives a note, because
/// a body that nothing pins would fall. `where` and `key` name the choice: "body cube", "pin."; `lines` are
/// those of its recipe. Throws Error if a node is named that there is not.
std::vector<int> chosen(const Body& body, const Choice& choice, const Scene& scene, const Lines& lines,
                        const std::string& where, const std::string& key, std::vector<std::string>& notes);

/// What its lattice is made of, until it is known what holds it.
Material first_material(const BodyRecipe& recipe);

/// Pins the nodes that the recipe names, gives a body that shall bear its own weight its modulus, and makes
/// its regions harder and softer.
void hold(Body& body, const BodyRecipe& recipe, const Scene& scene, std::vector<std::string>& notes);

}  // namespace palpate
