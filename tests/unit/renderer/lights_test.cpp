// What the library is told of the scene's lights.
#include "renderer/frame/lights.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace gnomon::renderer
