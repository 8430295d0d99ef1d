#include "renderer/frame/camera.h"

#include <cmath>
#include <cstring>

namespace gnomon::renderer {
namespace {

void store(const glm::dmat4& matrix, float out[16]) {
    const glm::mat4 m(matrix);
    std::memcpy(out, &m[0][0], 16 * sizeof(float));
}

// Device depth = (a * z + b) / w with z the view depth; `near` at 1 and `far` at 0 if reversed, else the other way
// round.
glm::dmat4 perspective(const SceneCamera& camera, double aspect, bool reversed) {
    const double n = camera.nearMetres;
    const double f = camera.farMetres;
    const double scale = 1.0 / std::tan(0.5 * static_cast<double>(camera.verticalFieldOfView));
    double a = reversed ? 0.0 : 1.0;
    double b = reversed ? n : -n;
    if (std::isfinite(f)) {
        a = reversed ? -n / (f - n) : f / (f - n);
        b = reversed ? n * f / (f - n) : -n * f / (f - n);
    }
    glm::dmat4 m(0.0);
    m[0][0] = scale / aspect;
    m[1][1] = -scale;
    m[2][2] = -a;
    m[2][3] = -1.0;
    m[3][2] = b;
    return m;
}

// In half heights, where the camera states no far plane: depth needs an end here.
constexpr double kDeepest = 1e4;

glm::dmat4 orthographic(const SceneCamera& camera, double aspect, bool reversed) {
    const double n = camera.nearMetres;
    const double half = static_cast<double>(camera.orthographicHalfHeight), scale = 1.0 / half;
    const double f = std::isfinite(camera.farMetres) ? static_cast<double>(camera.farMetres) : n + kDeepest * half;
    glm::dmat4 m(0.0);
    m[0][0] = scale / aspect;
    m[1][1] = -scale;
    m[2][2] = (reversed ? 1.0 : -1.0) / (f - n);
    m[3][2] = (reversed ? f : -n) / (f - n);
    m[3][3] = 1.0;
    return m;
}

}  // namespace

glm::dvec3 frameOriginOf(const SceneCamera& camera) {
    constexpr double kGrid = 1024.0;
    const glm::dvec3 position(camera.worldFromCamera[3]);
    return glm::round(position / kGrid) * kGrid;
}

Camera cameraOf(const SceneCamera& given, const glm::dvec3& origin, std::uint32_t widthPx, std::uint32_t heightPx,
                DeviceDepth depth) {
    const SceneCamera camera = fittedCamera(given, widthPx, heightPx);
    // Rigid, whatever scale the file's nodes have.
    const glm::dmat4 placed(camera.worldFromCamera);
    const glm::dvec3 z = glm::normalize(glm::dvec3(placed[2]));
    const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(placed[1]), z));
    const glm::dvec3 y = glm::cross(z, x);
    const glm::dmat4 worldFromView(glm::dvec4(x, 0.0), glm::dvec4(y, 0.0), glm::dvec4(z, 0.0),
                                   glm::dvec4(glm::dvec3(placed[3]) - origin, 1.0));
    Camera result;
    result.deviceDepth = depth;
    const bool reversed = depth == DeviceDepth::ReversedZ;
    const double aspect = static_cast<double>(widthPx) / static_cast<double>(heightPx);
    store(glm::inverse(worldFromView), result.viewFromWorld);
    store(camera.orthographic ? orthographic(camera, aspect, reversed) : perspective(camera, aspect, reversed),
          result.clipFromView);
    return result;
}

double axisDistanceOf(const Camera& camera, float deviceDepth) {
    const float* m = camera.clipFromView;
    // d = (zScale * z + zShift) / (wScale * z + wShift), with z along the view's own axis, which points back.
    const double zScale = m[10], zShift = m[14], wScale = m[11], wShift = m[15], d = deviceDepth;
    return -(zShift - d * wShift) / (d * wScale - zScale);
}

}  // namespace gnomon::renderer
