// From the scene's camera to the library's matrices.
#include "renderer/frame/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <limits>

namespace gnomon::renderer {
namespace {

// Where a point of the view ends up in the picture, from -1 to 1.
glm::dvec2 pictured(const SceneCamera& camera, const glm::dvec3& view, std::uint32_t width, std::uint32_t height) {
    const Camera made = cameraOf(camera, glm::dvec3(0.0), width, height, DeviceDepth::ReversedZ);
    const glm::dvec4 clip = glm::dmat4(glm::make_mat4(made.clipFromView)) * glm::dvec4(view, 1.0);
    return glm::dvec2(clip) / clip.w;
}

}  // namespace

// A corner of what a camera of 3:1 sees: never cropped, whatever the picture's shape.
TEST(LibraryCamera, PicturesOfAnotherShapeCropNothing) {
    SceneCamera camera;
    camera.widthOverHeight = 3.0f;
    camera.verticalFieldOfView = 2.0f * std::atan(0.25f);
    camera.orthographicHalfHeight = 0.5f;
    for (const bool orthographic : {false, true}) {
        camera.orthographic = orthographic;
        const glm::dvec3 corner(1.5, 0.5, -2.0);
        EXPECT_LT(glm::length(pictured(camera, corner, 300, 100) - glm::dvec2(1, -1)), 1e-5);
        const glm::dvec2 narrow = pictured(camera, corner, 1280, 720), tall = pictured(camera, corner, 100, 400);
        EXPECT_LT(glm::length(narrow - glm::dvec2(1.0, -(1280.0 / 720.0) / 3.0)), 1e-5);
        EXPECT_LT(glm::length(tall - glm::dvec2(1.0, -0.25 / 3.0)), 1e-5);
        const glm::dvec2 wide = pictured(camera, corner, 600, 100);
        EXPECT_LT(glm::length(wide - glm::dvec2(0.5, -1)), 1e-5);
    }
}

// From the near plane to the far one, and far out where there is none: there and back through the float matrix.
TEST(LibraryCamera, DeviceDepthsComeBackAsDistances) {
    SceneCamera camera;
    camera.nearMetres = 0.05f;
    for (const bool orthographic : {false, true})
        for (const float farMetres : {80.0f, std::numeric_limits<float>::infinity()})
            for (const DeviceDepth depth : {DeviceDepth::ReversedZ, DeviceDepth::StandardZ}) {
                camera.orthographic = orthographic;
                camera.farMetres = farMetres;
                const Camera made = cameraOf(camera, glm::dvec3(0.0), 16, 9, depth);
                // What a step of the device depth is worth where it is near 1: a share of the range, or of distance^2.
                const double step = depth == DeviceDepth::ReversedZ && !orthographic ? 0.0 : 6.0e-8;
                for (const double z : {0.05, 0.2, 3.0, 79.0}) {
                    const glm::dvec4 clip = glm::dmat4(glm::make_mat4(made.clipFromView)) * glm::dvec4(0, 0, -z, 1);
                    const double worth = orthographic ? std::min(1e4, static_cast<double>(farMetres)) : z * z / 0.05;
                    EXPECT_NEAR(axisDistanceOf(made, static_cast<float>(clip.z / clip.w)), z, 1e-6 * z + step * worth)
                        << orthographic << " " << farMetres << " " << static_cast<int>(depth);
                }
            }
}

}  // namespace gnomon::renderer
