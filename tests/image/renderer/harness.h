#pragma once
// What all image tests share: the devices, scenes ready to be drawn, frames, and comparisons that leave a picture of
// the difference in the build folder's image_failures/ when they fail.

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "picture/picture.h"
#include "renderer/renderer.h"
#include "scene/builtin/builtin.h"

namespace gnomon::renderer::image_test {

/// GNOMON_FULL=1: every combination instead of a chosen few.
bool fullRun();
/// False where a handful of cases must do: with GNOMON_QUICK=1, as test.sh has it, unless GNOMON_FULL=1.
bool thorough();

/// Renderers of a device share these, so that each pipeline is compiled once: software devices take seconds for each.
std::shared_ptr<SharedPipelines> pipelinesOf(const Device& device, std::uint32_t subgroupSize = 0);

/// One test per suitable Vulkan device; fails on any validation message.
class ImageTest : public ::testing::TestWithParam<std::size_t> {
protected:
    const Device& device() const;
    void TearDown() override;
};

std::vector<std::size_t> deviceIndices();
std::string deviceTestName(const ::testing::TestParamInfo<std::size_t>& info);

#define GNOMON_IMAGE_TEST_SUITE(suite) \
    class suite : public ImageTest {}; \
    INSTANTIATE_TEST_SUITE_P(EveryDevice, suite, ::testing::ValuesIn(deviceIndices()), deviceTestName)

/// A scene with its camera. `scattered` shadowed lights are added to the scene's own.
struct View3d {
    std::string name;
    Scene scene;
    SceneCamera camera;
};
View3d builtin(const std::string& name, std::uint32_t scattered = 0);
/// The same place seen by an orthographic camera that shows about as much at `focusMetres`.
View3d orthographic(View3d view, float focusMetres);

/// Of Filter::Pcss where the number of taps does not matter: software devices are slow.
inline constexpr PcssTaps kFewTaps = {4, 6};
/// Small enough for software devices: few taps, 240x135 and an atlas of 2048 (1024 where a handful of cases must do).
RendererDesc smallDesc(std::uint32_t widthPx = 240, std::uint32_t heightPx = 135);

struct Frame {
    HdrPicture linear;
    FrameReport report;
};
Frame draw(Renderer& renderer, const SceneCamera& camera, ShadowMode mode);
/// One frame of a renderer that lives no longer.
Frame drawOnce(const Device& device, const View3d& view, const RendererDesc& desc, ShadowMode mode);

/// Largest difference over many comparisons.
struct Worst {
    std::uint32_t largest = 0;
    std::uint64_t pixels = 0, comparisons = 0;
    std::string where;
    void add(const Difference& difference, const std::string& name);
    /// Prints a line and records the properties `key`_largest and `key`_pixels.
    void report(const Device& device, const std::string& key) const;
};

/// Exposes both by `expected` (automatic exposure), compares, and fails if a channel differs by more than `tolerance`.
Difference expectEqual(const Device& device, const std::string& name, const HdrPicture& expected,
                       const HdrPicture& actual, std::uint32_t tolerance);
Difference expectEqual(const Device& device, const std::string& name, const Picture& expected, const Picture& actual,
                       std::uint32_t tolerance);
/// Writes expected, actual and their difference; says where on stdout.
void writeFailure(const Device& device, const std::string& name, const Picture& expected, const Picture& actual);

/// Deferred and inline frames of one renderer must be equal, and where `shadows` is set differ from the unshadowed one.
Frame expectDeferredIsInline(const Device& device, const std::string& name, const View3d& view,
                             const RendererDesc& desc, Worst& worst, bool shadows);
Frame expectDeferredIsInline(const Device& device, const std::string& name, Renderer& renderer,
                             const SceneCamera& camera, Worst& worst, bool shadows);

}  // namespace gnomon::renderer::image_test
