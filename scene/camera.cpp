#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scene/pose.h"
#include "scene/scene.h"

namespace gnomon::renderer {
namespace {

// Within the nearest thing one looks at in a room, yet no closer than the scene's size warrants. A scene may be as
// small as it likes.
float nearDistance(const Scene& scene) {
    const float radius = animatedExtent(scene).drawn.radius();
    return radius > 0.0f ? std::min(0.004f * radius, 1.0f) : 0.005f;
}

glm::mat4 lookingAt(const glm::vec3& eye, const glm::vec3& target) {
    const glm::vec3 back = glm::normalize(eye - target);
    const glm::vec3 up = std::abs(back.y) > 0.9999f ? glm::vec3(0.0f, 0.0f, -1.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
    const glm::vec3 right = glm::normalize(glm::cross(up, back));
    return {glm::vec4(right, 0.0f), glm::vec4(glm::cross(back, right), 0.0f), glm::vec4(back, 0.0f),
            glm::vec4(eye, 1.0f)};
}

// The whole of `text` as a finite number.
template <class Number>
bool readNumber(std::string_view text, Number& out) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    return error == std::errc() && end == text.data() + text.size() && std::isfinite(out);
}

// In the file's coordinates; comes out relative to the scene's origin.
bool readPoint(std::string_view text, const glm::dvec3& origin, glm::vec3& out) {
    for (int c = 0; c < 3; ++c) {
        const std::size_t comma = text.find(',');
        double value = 0.0;
        if ((comma == std::string_view::npos) != (c == 2) || !readNumber(text.substr(0, comma), value)) return false;
        out[c] = static_cast<float>(value - origin[c]);
        if (!std::isfinite(out[c])) return false;
        text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
    }
    return true;
}

Result wrongCamera(std::string_view text) {
    return Result::failure(
        Status::BadArgument,
        "'%.60s' is no camera: give eye:target[:degrees] as in 0,14,12:0,0,0:60, a camera's name, #index or default.",
        std::string(text).c_str());
}

Result cameraByIndex(std::string_view text, const Scene& scene, SceneCamera& camera) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), index);
    if (error != std::errc() || end != text.data() + text.size()) return wrongCamera(text);
    if (index >= scene.cameras.size())
        return Result::failure(Status::BadArgument, "There is no camera #%zu: the scene has %zu.", index,
                               scene.cameras.size());
    camera = scene.cameras[index];
    return {};
}

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

Result parseCamera(std::string_view text, const Scene& scene, SceneCamera& camera) {
    if (text == "default") {
        camera = defaultCamera(scene);
        return {};
    }
    for (const SceneCamera& known : scene.cameras)
        if (known.name == text) {
            camera = known;
            return {};
        }
    if (text.starts_with('#')) return cameraByIndex(text, scene, camera);

    std::array<std::string_view, 3> parts;
    std::size_t count = 0;
    for (std::string_view rest = text; count < 3;) {
        const std::size_t colon = rest.find(':');
        parts[count++] = rest.substr(0, colon);
        if (colon == std::string_view::npos) break;
        if (count == 3) return wrongCamera(text);
        rest.remove_prefix(colon + 1);
    }
    glm::vec3 eye, target;
    float degrees = 60.0f;
    if (count < 2 || !readPoint(parts[0], scene.origin, eye) || !readPoint(parts[1], scene.origin, target) ||
        (count == 3 && !readNumber(parts[2], degrees)))
        return wrongCamera(text);
    const float distance = glm::length(eye - target);
    if (!(distance > 0.0f) || !std::isfinite(distance))
        return Result::failure(Status::BadArgument,
                               "The camera's eye and target must be two points at a finite distance.");
    if (!(degrees >= 1.0f && degrees <= 170.0f))
        return Result::failure(Status::BadArgument, "A vertical field of view of %g degrees is outside 1 to 170.",
                               double(degrees));
    SceneCamera made;
    made.name = text;
    made.worldFromCamera = lookingAt(eye, target);
    made.verticalFieldOfView = glm::radians(degrees);
    made.nearMetres = nearDistance(scene);
    camera = made;
    return {};
}

}  // namespace gnomon::renderer
