#pragma once
// The functions behind makeBuiltinScene, one per scene.

#include "scene/builtin/builtin.h"

namespace gnomon::renderer {

Scene makeCourtyardNight();
Scene makeCourtyardDay();
Scene makeCourtyardBench();

Scene makeBiasLab();

Scene makeEmptyPlane();
Scene makeSphereOnPlane();
Scene makeBoxes();
Scene makeColumns(const BuiltinOptions& options);
Scene makeCloth();
Scene makeMasked();
Scene makeSundial();
Scene makeSingleTriangle();
Scene makeLightsOnly();

}  // namespace gnomon::renderer
