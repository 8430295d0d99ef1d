// What the library is told of the scene's lights.
#include "renderer/frame/lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gnomon::renderer {
namespace {

// With as many presets as filters, an index shared by both would leave a preset unused.
TEST(LibraryLights, PresetsTakeTurnsAmongSoftLightsAlone) {
    FrameSettings settings;
    settings.filters = {Filter::Hard, Filter::Pcss};
    settings.shadows.pcssPresetCount = 2;
    const std::vector<SceneLight> scene(6);
    const std::vector<Light> lights = libraryLights(scene, glm::dvec3(0.0), settings);
    ASSERT_EQ(lights.size(), 6u);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        EXPECT_EQ(lights[i].filter, settings.filters[i % 2]) << i;
        if (lights[i].filter == Filter::Pcss) {
            EXPECT_EQ(lights[i].pcssPreset, (i / 2) % 2) << i;
        }
    }
}

// A bias that somebody stated is literal. Else it is 2 mm within the limits of what a view sees.
TEST(LibraryLights, OnlyStatedBiasesAreLiteral) {
    std::vector<SceneLight> scene(3);
    scene[1].kind = LightKind::Directional;
    scene[2].biasMetres = 0.03f;
    FrameSettings settings;
    const auto viewsOf = [&] {
        std::vector<PlannedView> views(3);
        for (std::uint32_t i = 0; i < views.size(); ++i) views[i].light = i;
        views[1].cascade.halfExtent = 0.003;
        limitBiases(scene, settings, views);
        return views;
    };
    std::vector<PlannedView> views = viewsOf();
    EXPECT_FLOAT_EQ(views[0].view.mostBias, 2e-3f);
    EXPECT_FLOAT_EQ(views[1].view.mostBias, 6e-6f);
    EXPECT_FLOAT_EQ(views[0].view.leastBias, 1e-4f);
    EXPECT_FLOAT_EQ(views[1].view.leastBias, 3e-7f);
    EXPECT_EQ(views[2].view.leastBias, 0.0f);
    EXPECT_TRUE(std::isinf(views[2].view.mostBias));
    EXPECT_EQ(libraryLights(scene, glm::dvec3(0.0), settings)[0].biasMetres, 0.002f);
    EXPECT_EQ(libraryLights(scene, glm::dvec3(0.0), settings)[2].biasMetres, 0.03f);
    settings.biasMetres = 0.5f;
    views = viewsOf();
    for (const PlannedView& view : views) EXPECT_TRUE(std::isinf(view.view.mostBias));
    EXPECT_EQ(libraryLights(scene, glm::dvec3(0.0), settings)[1].biasMetres, 0.5f);
    EXPECT_EQ(libraryLights(scene, glm::dvec3(0.0), settings)[2].biasMetres, 0.03f);
}

}  // namespace
}  // namespace gnomon::renderer
