#include "palpate/scene/scene.h"

namespace palpate {
namespace {

ShippedScene scene(std::string name, std::string text) {
    // The first line of each is a comment that says what it is.
    std::string about = text.substr(2, text.find('\n') - 2);
    return {std::move(name), std::move(text), std::move(about)};
}

}  // namespace

const std::vector<ShippedScene>& shipped_scenes() {
    static const std::vector<ShippedScene> all{
        scene("brain",
#include "embedded/brain.toml.h"
              ),
        scene("heart",
#include "embedded/heart.toml.h"
              ),
        scene("head",
#include "embedded/head.toml.h"
              ),
        scene("catheter",
#include "embedded/catheter.toml.h"
              ),
        scene("drape",
#include "embedded/drape.toml.h"
              ),
        scene("flag",
#include "embedded/flag.toml.h"
              ),
        scene("dragon",
#include "embedded/dragon.toml.h"
              ),
        scene("cow",
#include "embedded/cow.toml.h"
              ),
        scene("nodule",
#include "embedded/nodule.toml.h"
              ),
        scene("box",
#include "embedded/box.toml.h"
              ),
    };
    return all;
}

}  // namespace palpate
