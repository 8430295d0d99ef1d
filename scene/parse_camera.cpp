// Cameras from text: `eye:target` and what may follow, a camera's name, or its number.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "scene/pose.h"
#include "scene/scene.h"

namespace gnomon::renderer {
namespace {

constexpr float kNearOfTarget = 1.0e-3f, kNearOfScene = 4.0e-3f, kBehindAll = 1.01f;
constexpr float kLeastDegrees = 1.0f, kMostDegrees = 170.0f, kMostRoll = 360.0f;
constexpr float kLeastHeight = 1.0e-6f, kMostHeight = 1.0e9f;  // as far apart as scenes are

struct Wanted {
    glm::vec3 eye{0.0f}, target{0.0f};
    std::optional<float> degrees, height;
    float roll = 0.0f;  // degrees
};

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

// `degrees`, `height=` or `roll=`, each once.
bool readPart(std::string_view text, Wanted& wanted, bool& rolled) {
    float number = 0.0f;
    const std::size_t equals = text.find('=');
    if (!readNumber(equals == std::string_view::npos ? text : text.substr(equals + 1), number)) return false;
    const std::string_view name = equals == std::string_view::npos ? std::string_view() : text.substr(0, equals);
    if (name == "roll" && !rolled) {
        wanted.roll = number;
        return rolled = true;
    }
    if (wanted.degrees || wanted.height || (name != "" && name != "height")) return false;
    (name == "height" ? wanted.height : wanted.degrees) = number;
    return true;
}

bool readParts(std::string_view text, const glm::dvec3& origin, Wanted& wanted) {
    bool rolled = false;
    for (std::size_t part = 0;; ++part) {
        const std::size_t colon = text.find(':');
        const std::string_view here = text.substr(0, colon);
        const bool good = part == 0   ? readPoint(here, origin, wanted.eye)
                          : part == 1 ? readPoint(here, origin, wanted.target)
                                      : readPart(here, wanted, rolled);
        if (!good) return false;
        if (colon == std::string_view::npos) return part >= 1;
        text.remove_prefix(colon + 1);
    }
}

Result wrongCamera(std::string_view text) {
    return Result::failure(Status::BadArgument,
                           "'%.60s' is no camera: give eye:target[:degrees or :height=UNITS][:roll=DEGREES] as in "
                           "0,14,12:0,0,0:60, a camera's name, #index or default.",
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

// By how far it looks. The scene's size can only bring it nearer: for those who give a direction by a far target.
float nearDistance(const Bounds& drawn, float targetDistance) {
    const float byTarget = kNearOfTarget * targetDistance;
    return drawn.radius() > 0.0f ? std::min(kNearOfScene * drawn.radius(), byTarget) : byTarget;
}

// Of an orthographic view, whose depth needs an end: behind all that is drawn, wherever it moves.
float farDistance(const Bounds& drawn, const Wanted& wanted, float nearMetres) {
    const float toTarget = glm::length(wanted.target - wanted.eye);
    const float toCorner = drawn.empty() ? 0.0f : glm::length(drawn.centre() - wanted.eye) + drawn.radius();
    return nearMetres + kBehindAll * std::max(toTarget, toCorner);
}

// Clockwise for one who stands behind the camera. So the picture turns the other way.
glm::mat4 rolled(const glm::mat4& worldFromCamera, float degrees) {
    return degrees == 0.0f ? worldFromCamera
                           : glm::rotate(worldFromCamera, -glm::radians(degrees), glm::vec3(0.0f, 0.0f, 1.0f));
}

Result cameraOf(const Wanted& wanted, const Scene& scene, SceneCamera& out) {
    const float distance = glm::length(wanted.eye - wanted.target), degrees = wanted.degrees.value_or(60.0f);
    if (!(distance > 0.0f) || !std::isfinite(distance))
        return Result::failure(Status::BadArgument,
                               "The camera's eye and target must be two points at a finite distance.");
    if (!(degrees >= kLeastDegrees && degrees <= kMostDegrees))
        return Result::failure(Status::BadArgument, "A vertical field of view of %g degrees is outside %g to %g.",
                               double(degrees), double(kLeastDegrees), double(kMostDegrees));
    if (wanted.height && !(*wanted.height >= kLeastHeight && *wanted.height <= kMostHeight))
        return Result::failure(Status::BadArgument, "A view's height of %g is outside %g to %g.",
                               double(*wanted.height), double(kLeastHeight), double(kMostHeight));
    if (!(std::abs(wanted.roll) <= kMostRoll))
        return Result::failure(Status::BadArgument, "A roll of %g degrees is outside -%g to %g.", double(wanted.roll),
                               double(kMostRoll), double(kMostRoll));
    out.worldFromCamera = rolled(lookingAt(wanted.eye, wanted.target), wanted.roll);
    out.verticalFieldOfView = glm::radians(degrees);
    out.orthographic = wanted.height.has_value();
    if (out.orthographic) out.orthographicHalfHeight = 0.5f * *wanted.height;
    const Bounds drawn = animatedExtent(scene).drawn;
    out.nearMetres = nearDistance(drawn, distance);
    if (out.orthographic) out.farMetres = farDistance(drawn, wanted, out.nearMetres);
    return {};
}

}  // namespace

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
    Wanted wanted;
    if (!readParts(text, scene.origin, wanted)) return wrongCamera(text);
    SceneCamera made;
    made.name = text;
    const Result result = cameraOf(wanted, scene, made);
    if (result.ok()) camera = made;
    return result;
}

}  // namespace gnomon::renderer
