#pragma once
#include "palpate/scene/build.h"
#include "palpate/scene/camera.h"

namespace palpate {

/// From where a scene is looked at, at what, in a picture `aspect` times as wide as high.
///
/// What the scene leaves out is found: `look_at` is the middle of what there is to see, and the eye stands
/// where all of it is in the picture. That is the bodies and the surfaces that nothing moves, at rest and
/// where prescribed motion takes them; and of colliders, grounds and tips what lies near those or is about to
/// meet them. Of an endless or far thing no more than that counts, so that none makes a body a dot. The eye
/// looks from the front, somewhat from the right and from above; along the shorter side of what is deep; from
/// higher up on what lies flat; and from the side from which tips come. An orthographic picture is as high as
/// the same angle shows.
Camera camera_of(const Scene& scene, const Models& made, float aspect);

}  // namespace palpate
