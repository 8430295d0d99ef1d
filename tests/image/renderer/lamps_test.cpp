// Lamps as files have them: without a range, without a size, in housings, and in scenes of any size.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "image/renderer/verified.h"

namespace gnomon::renderer::image_test {
namespace {

GNOMON_IMAGE_TEST_SUITE(Lamps);

constexpr double kMostWrong = 0.001, kMostContactsLost = 0.05;

// A ball of triangles around `centre`, seen from outside: its faces look away from what is in it.
void addBulb(Scene& scene, const glm::vec3& centre, float radius) {
    Primitive p;
    constexpr std::uint32_t kRows = 8, kColumns = 16;
    for (std::uint32_t y = 0; y <= kRows; ++y)
        for (std::uint32_t x = 0; x <= kColumns; ++x) {
            const float polar = std::numbers::pi_v<float> * static_cast<float>(y) / kRows;
            const float turn = 2.0f * std::numbers::pi_v<float> * static_cast<float>(x % kColumns) / kColumns;
            p.positions.emplace_back(radius * std::sin(polar) * std::cos(turn), radius * std::cos(polar),
                                     -radius * std::sin(polar) * std::sin(turn));
            p.bounds.add(p.positions.back());
        }
    for (std::uint32_t y = 0; y < kRows; ++y)
        for (std::uint32_t x = 0; x < kColumns; ++x) {
            const std::uint32_t a = y * (kColumns + 1) + x, b = a + kColumns + 1;
            for (const std::uint32_t i : {a, b, a + 1, a + 1, b, b + 1}) p.indices.push_back(i);
        }
    scene.instances.push_back(
        {"bulb", static_cast<std::uint32_t>(scene.meshes.size()), glm::translate(glm::dmat4(1.0), glm::dvec3(centre))});
    scene.meshes.push_back({"bulb", {p}});
}

// All is `scale` times as large, and as bright to look at.
View3d scaled(View3d view, float scale) {
    for (Instance& instance : view.scene.instances)
        instance.worldFromObject = glm::scale(glm::dmat4(1.0), glm::dvec3(scale)) * instance.worldFromObject;
    for (SceneLight& light : view.scene.lights) {
        light.position *= scale;
        light.rangeMetres *= scale;
        if (light.kind == LightKind::Directional) continue;
        light.sourceRadius *= scale;
        light.intensity *= scale * scale;
    }
    for (int c = 0; c < 3; ++c) view.camera.worldFromCamera[3][c] *= scale;
    view.camera.nearMetres *= scale;
    view.name += " times " + std::to_string(scale);
    return view;
}

SceneLight sunOverBoxes() {
    SceneLight sun;
    sun.kind = LightKind::Directional;
    sun.direction = glm::normalize(glm::vec3(0.4f, -0.8f, -0.3f));
    sun.sourceRadius = 0.00465f;
    sun.intensity = 10.0f;
    return sun;
}

TEST_P(Lamps, ShineThroughNoClosedHousing) {
    for (const float range : {2.0f, 20.0f, 60.0f, 1e4f}) {
        View3d view = builtin("boxes");
        view.scene.lights.resize(1);
        view.scene.lights[0].rangeMetres = range;
        view.scene.lights[0].sourceRadius = 0.002f;
        addBulb(view.scene, view.scene.lights[0].position, 0.02f);
        view.name = "bulb of 2 cm, range " + std::to_string(range);
        RendererDesc desc = hardDesc();
        const Figures f = figuresIn(device(), view, desc);
        EXPECT_GT(f.pairs, range < 3.0f ? 500u : 5000u);
        EXPECT_EQ(f.lit, 0u);
        EXPECT_EQ(f.leak + f.contactLeak + f.edgeError, 0u);
    }
}

// The camera's depth is standard, too: its rounding is the larger one.
TEST_P(Lamps, SmallScenesAreAsRightAsLargeOnes) {
    View3d boxes = builtin("boxes");
    std::erase_if(boxes.scene.instances, [](const Instance& i) { return i.name == "red wall"; });
    boxes.scene.lights.push_back(sunOverBoxes());
    for (const float scale : {1.0f, 1e-3f, 1e3f}) {
        if (scale > 1.0f && isSwiftShader(device())) continue;  // its depths: docs/driver-ledger.md
        const View3d view = scaled(boxes, scale);
        RendererDesc desc = hardDesc();
        for (const DeviceDepth depth : {DeviceDepth::ReversedZ, DeviceDepth::StandardZ}) {
            if (depth == DeviceDepth::StandardZ && !thorough()) break;
            desc.frame.deviceDepth = depth;
            const Figures f = figuresIn(device(), view, desc);
            EXPECT_GT(f.dark, 1000u);
            EXPECT_LE(f.share(f.acne + f.leak), kMostWrong);
        }
    }
    // What everything touches in so small a scene is a shadow all the same.
    const View3d small = scaled(boxes, 1e-3f);
    RendererDesc literal = hardDesc();
    literal.frame.biasMetres = kBiasMetres;
    const Figures lost = figuresIn(device(), small, literal);
    EXPECT_GT(lost.contactLeakOfContacts(), 0.2) << "a bias that is stated is taken as it is";
    EXPECT_LE(figuresIn(device(), small, hardDesc()).contactLeakOfContacts(), kMostContactsLost);
}

// Two lamps, one of which is a thousand times as faint. Nobody states a range; nothing of either is lost.
TEST_P(Lamps, WithoutARangeFollowTheInverseSquare) {
    View3d view = builtin("empty-plane");
    view.scene.skyColour = view.scene.groundColour = glm::vec3(0.0f);
    SceneLight strong, faint;
    strong.position = {-2.5f, 2.5f, 0.0f};
    strong.colour = {1.0f, 0.0f, 0.0f};
    strong.intensity = 10000.0f;
    faint.position = {2.5f, 1.2f, 0.0f};
    faint.colour = {0.0f, 1.0f, 0.0f};
    faint.intensity = 10.0f;
    view.scene.lights = {strong, faint};
    View3d stated = view;
    for (SceneLight& light : stated.scene.lights) light.rangeMetres = 1e4f;  // its window is nothing here
    completeLights(view.scene);
    completeLights(stated.scene);
    const HdrPicture guessed = drawOnce(device(), view, hardDesc(), ShadowMode::Off).linear;
    const HdrPicture whole = drawOnce(device(), stated, hardDesc(), ShadowMode::Off).linear;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < guessed.rgba.size(); i += 4)
        for (std::size_t c = 0; c < 2; ++c) {
            seen += whole.rgba[i + c] > 0.0f ? 1 : 0;
            EXPECT_NEAR(guessed.rgba[i + c], whole.rgba[i + c], 2e-3f * whole.rgba[i + c]) << i << " " << c;
        }
    EXPECT_GT(seen, 5000u);
}

}  // namespace
}  // namespace gnomon::renderer::image_test
