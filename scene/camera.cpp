#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "scene/scene.h"

namespace gnomon::renderer {

glm::mat4 lookingAt(const glm::vec3& eye, const glm::vec3& target) {
    const glm::vec3 back = glm::normalize(eye - target);
    const glm::vec3 up = std::abs(back.y) > 0.9999f ? glm::vec3(0.0f, 0.0f, -1.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
    const glm::vec3 right = glm::normalize(glm::cross(up, back));
    return {glm::vec4(right, 0.0f), glm::vec4(glm::cross(back, right), 0.0f), glm::vec4(back, 0.0f),
            glm::vec4(eye, 1.0f)};
}

SceneCamera fittedCamera(const SceneCamera& camera, std::uint32_t widthPx, std::uint32_t heightPx) {
    constexpr float kWidest = 3.1415f;  // radians; the tangent of half of it is still positive
    const float picture = static_cast<float>(widthPx) / static_cast<float>(heightPx);
    SceneCamera out = camera;
    out.widthOverHeight = 0.0f;
    if (!(camera.widthOverHeight > picture)) return out;
    const float taller = camera.widthOverHeight / picture;
    out.orthographicHalfHeight *= taller;
    const float half = std::atan(taller * std::tan(0.5f * camera.verticalFieldOfView));
    out.verticalFieldOfView = std::max(camera.verticalFieldOfView, std::min(2.0f * half, kWidest));
    return out;
}

}  // namespace gnomon::renderer
