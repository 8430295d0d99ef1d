#pragma once
// Lights as a glTF file with KHR_lights_punctual, for engines and other renderers. CPU only.

#include <glm/glm.hpp>
#include <span>
#include <string>

#include "scene/scene.h"

namespace gnomon::renderer {

/// JSON of a glTF 2.0 file that holds these lights (at least one) and nothing else, each on a node of its own. Places
/// are in the file's coordinates: `origin` is that of the scene. loadGltf() reads back what is written:
///  - kind, name, colour, intensity (candela or lux), cone angles;
///  - the range, unless it is guessed;
///  - extras.sourceRadius (also a guessed one: a picture shows it), extras.shadowBiasMetres and extras.shadowFilter.
/// Colours above 1, which glTF has not, go into the intensity. Whether a light casts cannot be told.
[[nodiscard]] std::string lightsAsGltf(std::span<const SceneLight> lights, const glm::dvec3& origin);

}  // namespace gnomon::renderer
