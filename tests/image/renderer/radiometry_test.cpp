// Unshadowed light against the formulas of glTF (KHR_lights_punctual): on a spot's axis irradiance is intensity over
// the square of the distance, whatever the cone; and the inverse square holds to within a millimetre of the lamp.
#include <cmath>
#include <cstdio>

#include <glm/gtc/matrix_transform.hpp>

#include "image/renderer/harness.h"

namespace gnomon::renderer::image_test {
namespace {

GNOMON_IMAGE_TEST_SUITE(Radiometry);

constexpr double kPi = 3.14159265358979;

// A grey plane seen from straight above, in a black world, with one lamp above the middle of the picture. Of matter
// that reflects diffusely alone, but for the 4 % that a dielectric mirrors.
View3d lampOverPlane(const SceneLight& lamp, float eyeMetres) {
    View3d view = builtin("empty-plane");
    view.scene.lights = {lamp};
    // A level of the G-buffer's eight bits, and not between two, where devices round as they like.
    for (Material& material : view.scene.materials) material.baseColour = glm::vec4(glm::vec3(0.50289f), 1.0f);
    view.scene.skyColour = view.scene.groundColour = glm::vec3(0.0f);
    view.camera.worldFromCamera =
        glm::inverse(glm::lookAt(glm::vec3(0, eyeMetres, 0), glm::vec3(0), glm::vec3(0, 0, -1)));
    view.camera.nearMetres = 0.01f * eyeMetres;
    return view;
}

SceneLight lampAt(float metres, float candela) {
    SceneLight lamp;
    lamp.position = {0.0f, metres, 0.0f};
    lamp.direction = {0.0f, -1.0f, 0.0f};
    lamp.intensity = candela;
    lamp.rangeMetres = 1e4f * metres;
    lamp.sourceRadius = 0.001f * metres;
    return lamp;
}

// Odd numbers of pixels: the ray of the middle one meets the plane right below the lamp.
double middleOf(const Device& device, const View3d& view) {
    RendererDesc desc = smallDesc(61, 35);
    desc.frame.filters = {Filter::Hard};
    const HdrPicture picture = drawOnce(device, view, desc, ShadowMode::Off).linear;
    const std::size_t pixel = std::size_t{picture.height / 2} * picture.width + picture.width / 2;
    return static_cast<double>(picture.rgba[4 * pixel]);
}

TEST_P(Radiometry, OnTheAxisTheConeIsNothing) {
    const SceneLight point = lampAt(2.0f, 40.0f);
    const double expected = middleOf(device(), lampOverPlane(point, 3.0f));
    // 10 lux on a diffuse reflectance of half of 96 %, and a little more from the mirror.
    EXPECT_NEAR(expected, 10.0 * 0.5 / kPi, 0.1 * expected);
    for (const double degrees : {0.05, 0.2, 1.0, 2.86, 20.0, 60.0, 85.0}) {
        for (const double innerShare : {0.0, 0.5, 1.0}) {
            SceneLight spot = point;
            spot.kind = LightKind::Spot;
            spot.outerConeAngle = static_cast<float>(degrees * kPi / 180.0);
            spot.innerConeAngle = static_cast<float>(innerShare) * spot.outerConeAngle;
            EXPECT_NEAR(middleOf(device(), lampOverPlane(spot, 3.0f)), expected, 2e-3 * expected)
                << degrees << " degrees, inner share " << innerShare;
        }
    }
}

TEST_P(Radiometry, InverseSquareNearTheLamp) {
    const double expected = middleOf(device(), lampOverPlane(lampAt(1.0f, 10.0f), 3.0f));
    for (const float metres : {10.0f, 0.1f, 0.01f, 0.001f}) {
        const View3d view = lampOverPlane(lampAt(metres, 10.0f * metres * metres), 3.0f * metres);
        // Positions come from depths, which hardware knows to some micrometres at the camera's three metres.
        EXPECT_NEAR(middleOf(device(), view), expected, (2e-3 + 2e-5 / static_cast<double>(metres)) * expected)
            << metres;
    }
}

// Half of the way between inner and outer angle, by the formula of the extension: ((cos - cosOuter) / (cosInner -
// cosOuter))^2.
TEST_P(Radiometry, EdgesOfConesFollowTheExtension) {
    for (const double degrees : {4.0, 30.0, 70.0}) {
        SceneLight spot = lampAt(2.0f, 40.0f);
        const double expected = middleOf(device(), lampOverPlane(spot, 3.0f));
        spot.kind = LightKind::Spot;
        const double outer = degrees * kPi / 180.0, inner = 0.4 * outer, aside = 0.7 * outer;
        spot.outerConeAngle = static_cast<float>(outer);
        spot.innerConeAngle = static_cast<float>(inner);
        // The lamp turns, so that the middle of the picture is `aside` off its axis.
        spot.direction = {static_cast<float>(std::sin(aside)), static_cast<float>(-std::cos(aside)), 0.0f};
        const double edge = (std::cos(aside) - std::cos(outer)) / (std::cos(inner) - std::cos(outer));
        EXPECT_NEAR(middleOf(device(), lampOverPlane(spot, 3.0f)), edge * edge * expected, 3e-3 * expected) << degrees;
    }
}

}  // namespace
}  // namespace gnomon::renderer::image_test
