#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "scene/pose.h"
#include "scene/scene.h"

namespace gnomon::renderer {
namespace {

// The least distance from the centre, against `toEye`, at which the whole box is in a picture of 4:3 or wider.
float framingDistance(const Bounds& bounds, const glm::vec3& toEye, float verticalFieldOfView) {
    constexpr float kMargin = 1.08f;
    constexpr float kNarrowestAspect = 4.0f / 3.0f;
    const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0.0f, 1.0f, 0.0f), toEye));
    const glm::vec3 up = glm::cross(toEye, right);
    const float slope = std::tan(0.5f * verticalFieldOfView) / kMargin;
    float distance = 0.0f;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 sign((corner & 1) != 0 ? 1.0f : -1.0f, (corner & 2) != 0 ? 1.0f : -1.0f,
                             (corner & 4) != 0 ? 1.0f : -1.0f);
        const glm::vec3 p = 0.5f * sign * (bounds.max - bounds.min);
        const float wide = std::max(std::abs(glm::dot(p, right)) / kNarrowestAspect, std::abs(glm::dot(p, up)));
        distance = std::max(distance, wide / slope + glm::dot(p, toEye));
    }
    return distance;
}

}  // namespace

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

SceneCamera defaultCamera(const Scene& scene) {
    if (!scene.cameras.empty()) return scene.cameras.front();
    const AnimatedExtent extent = animatedExtent(scene);
    Bounds bounds = extent.drawn;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        if (!scene.instances.empty() || scene.lights[i].kind == LightKind::Directional) continue;
        bounds.add(extent.lights[i].min);
        bounds.add(extent.lights[i].max);
    }
    SceneCamera camera;
    camera.name = "default";
    const float radius = bounds.radius() > 0.0f ? bounds.radius() : 1.0f;
    const glm::vec3 centre = bounds.empty() ? glm::vec3(0.0f) : bounds.centre();
    const glm::vec3 toEye = glm::normalize(glm::vec3(0.75f, 0.5f, 1.0f));
    const float framing = bounds.radius() > 0.0f ? framingDistance(bounds, toEye, camera.verticalFieldOfView) : 3.0f;
    camera.worldFromCamera = lookingAt(centre + framing * toEye, centre);
    camera.nearMetres = 0.004f * radius;
    return camera;
}

}  // namespace gnomon::renderer
