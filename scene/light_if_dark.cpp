#include <glm/glm.hpp>

#include "scene/scene.h"

namespace gnomon::renderer {

void lightIfDark(Scene& scene) {
    if (!scene.lights.empty() || scene.instances.empty()) return;
    SceneLight sun;
    sun.name = "sun of scenes without lights";
    sun.kind = LightKind::Directional;
    sun.direction = glm::normalize(glm::vec3(0.5f, -1.0f, -0.35f));
    sun.colour = {1.0f, 0.96f, 0.9f};
    sun.intensity = 0.6f;  // lux, where Scene::skyColour gives a surface that looks up about 0.1
    scene.lights.push_back(sun);
    scene.notes.emplace_back(
        "There is no light in the file: a sun was added, and the exposure follows from the picture.");
}

}  // namespace gnomon::renderer
