#pragma once
#include "palpate/scene/build.h"
#include "palpate/scene/camera.h"

namespace palpate {

/// The camera of a scene, for pictures with this aspect ratio (width over height).
///
/// What the scene does not specify is chosen: `look_at` is the centre of everything that shall be seen, and
/// the eye is placed so that all of it is in the view frustum. This is the bodies and static surfaces, at
/// rest and where prescribed motion takes them; and those parts of colliders, grounds and tips that are near
/// or about to meet them. Only that part of endless or distant things counts, so that bodies do not shrink to
/// a dot. The eye looks from the front, somewhat from the right and from above; along the shorter side of
/// something deep; from higher up at something flat; and from the side from which tips come. The height of an
/// orthographic picture is that of the same angle at look_at.
Camera camera_of(const Scene& scene, const Models& made, float aspect);

}  // namespace palpate
