// From the scene's camera to the library's matrices.
#include "renderer/frame/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/type_ptr.hpp>

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

}  // namespace gnomon::renderer
