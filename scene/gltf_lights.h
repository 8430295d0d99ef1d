#pragma once
// KHR_lights_punctual and cameras.

#include "scene/gltf_nodes.h"
#include "scene/scene.h"

namespace gnomon::renderer::gltf {

/// Adds the light and the camera that a node carries, if any.
void addLight(Document& document, const PlacedNode& node, Scene& scene);
void addCamera(Document& document, const PlacedNode& node, Scene& scene);

}  // namespace gnomon::renderer::gltf
