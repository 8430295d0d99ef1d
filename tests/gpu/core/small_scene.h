#pragma once
// Small frames of the library alone: a wall five metres before the camera, a grid of spot lights that shine on it, and
// shadowmaps of noise, so that nearly every tile is partly lit and asks for slots.

#include <memory>
#include <vector>

#include "gnomon/gnomon.h"
#include "gpu/renderer/device_test.h"
#include "renderer/gpu/resources.h"

namespace gnomon::test {

/// One frame of the scene.
struct Shot {
    std::uint32_t widthPx = 64, heightPx = 64;
    std::uint32_t lights = 16;
    ShadowSettings settings = {.filters = only(Filter::Hard)};
    bool viewsChanged = true;
    Timeline* timeline = nullptr;
    bool hostRows = false;  ///< rows of the host between those of the library
};

class SmallScene {
public:
    static constexpr std::uint32_t kMostPx = 256;  ///< of a shot, each way

    explicit SmallScene(const renderer::Device& device);

    /// Phase 1 and View::beginFrame().
    Result begin(View& view, const Shot& shot, std::uint64_t frameNumber);
    /// All passes.
    static void record(View& view, const Shot& shot, VkCommandBuffer commands);
    /// The input of phase 1; valid until the next call.
    ViewInput input(const Shot& shot);

private:
    const renderer::Device& device_;
    renderer::GpuImage depth_, atlas_;
    std::vector<Light> lights_;
    std::vector<ShadowView> views_;
};

/// Frames one after the other, as many in flight as the view has.
class Frames {
public:
    Frames(const renderer::Device& device, SmallScene& scene, std::uint32_t framesInFlight);

    /// Waits for no more than frame number - framesInFlight. Fails the test where the frame does not begin. Returns its
    /// number.
    std::uint64_t run(View& view, const Shot& shot);
    /// Waits for all.
    void wait();

private:
    const renderer::Device& device_;
    SmallScene& scene_;
    std::vector<std::unique_ptr<renderer::Commands>> commands_;
    std::uint64_t next_ = 0;
};

/// Fail the test and return null where the library refuses.
std::unique_ptr<Context> makeContext(const renderer::Device& device, const ContextDesc& more = {});
std::unique_ptr<View> makeView(const Context& context, const ViewDesc& desc);
std::unique_ptr<Timeline> makeTimeline(const Context& context, const TimelineDesc& desc);

/// Small pools of memory for a small extent.
ViewDesc smallView(std::uint32_t widthPx = 64, std::uint32_t heightPx = 64, std::uint32_t framesInFlight = 2);

/// What a shot counts in a view of its own whose pools suffice.
FrameStatistics countedAlone(const renderer::Device& device, const Context& context, SmallScene& scene,
                             const Shot& shot);
/// All that does not depend on pools or time.
void expectSameCounts(const FrameStatistics& found, const FrameStatistics& expected);

/// A device with a context and the scene's images.
struct SharedDevice {
    renderer::Device device;
    std::unique_ptr<Context> context;
    SmallScene scene;
    SharedDevice(const renderer::VulkanInstance& instance, const renderer::DeviceInfo& info);
};

/// Every device found, with validation; any message fails the test.
class CoreTest : public renderer::DeviceTest {
public:
    /// Destroys all devices; messages fail the program.
    static void dropDevices();

protected:
    /// A device with what may be shared; alive until the program ends.
    static SharedDevice& shared(const renderer::DeviceInfo& info);
    /// body(device, context, scene); the context has pipelines of earlier tests.
    template <typename Body>
    static void onEveryDevice(const Body& body) {
        const std::vector<renderer::DeviceInfo> infos = suitable();
        ASSERT_FALSE(infos.empty());
        for (const renderer::DeviceInfo& info : infos) {
            SCOPED_TRACE(info.name);
            SharedDevice& own = shared(info);
            ASSERT_NE(own.context, nullptr);
            body(own.device, *own.context, own.scene);
            expectNoMessages();
        }
    }
};

}  // namespace gnomon::test
