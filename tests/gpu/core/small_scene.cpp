#include "gpu/core/small_scene.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>

namespace gnomon::test {
namespace {

constexpr float kNearMetres = 0.1f, kWallMetres = 5.0f;
constexpr float kLightMetres = 3.0f;  // of the lights, along the view
constexpr float kLightTangent = 1.3f;
constexpr std::uint32_t kAtlasPx = 256, kShadowViewPx = 64;  // one cell of shadow bounds
constexpr std::uint32_t kGridColumns = 8;

// Down the -z axis; reversed z without a far plane.
void writePerspective(float scale, const float (&eye)[3], float (&out)[16]) {
    std::fill(std::begin(out), std::end(out), 0.0f);
    out[0] = scale;
    out[12] = -scale * eye[0];
    out[5] = -scale;
    out[13] = scale * eye[1];
    out[14] = kNearMetres;
    out[11] = -1.0f;
    out[15] = eye[2];
}

renderer::GpuImage makeDepth(const renderer::Device& device, const char* name, std::uint32_t sizePx, bool array,
                             const std::vector<float>& texels) {
    renderer::ImageDesc desc;
    desc.name = name;
    desc.format = VK_FORMAT_D32_SFLOAT;
    desc.width = desc.height = sizePx;
    desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    desc.arrayView = array;
    renderer::GpuImage image(device, desc);
    std::vector<std::uint8_t> bytes(texels.size() * sizeof(float));
    std::memcpy(bytes.data(), texels.data(), bytes.size());
    renderer::Uploader uploader(device);
    uploader.image(image, bytes);
    uploader.finish();
    return image;
}

// Half of the texels lie before the wall, half at infinity.
std::vector<float> noise() {
    std::vector<float> texels(std::size_t{kAtlasPx} * kAtlasPx);
    std::uint32_t random = 1;
    for (float& texel : texels) {
        random = random * 1664525u + 1013904223u;
        texel = (random >> 31) != 0 ? 1.0f : 0.0f;
    }
    return texels;
}

// Devices with a context each, made when first used and kept to the end: pipelines take longer than all frames.
struct Session {
    std::map<VkPhysicalDevice, std::unique_ptr<SharedDevice>> devices;
};
Session& session() {
    static Session& shared = *new Session;
    return shared;
}

// Before the program's exit, when drivers may have taken down their own statics.
class Teardown : public ::testing::Environment {
    void TearDown() override { CoreTest::dropDevices(); }
};
[[maybe_unused]] const auto* const kTeardown = ::testing::AddGlobalTestEnvironment(new Teardown);  // GoogleTest's own

}  // namespace

SharedDevice::SharedDevice(const renderer::VulkanInstance& instance, const renderer::DeviceInfo& info)
    : device(instance, info), context(makeContext(device)), scene(device) {}

SharedDevice& CoreTest::shared(const renderer::DeviceInfo& info) {
    std::unique_ptr<SharedDevice>& slot = session().devices[info.handle];
    if (slot == nullptr) slot = std::make_unique<SharedDevice>(instance(), info);
    return *slot;
}

void CoreTest::dropDevices() {
    session().devices.clear();
    expectNoMessages();  // nothing was left undestroyed
}

SmallScene::SmallScene(const renderer::Device& device)
    : device_(device),
      depth_(makeDepth(device, "depth", kMostPx, false,
                       std::vector<float>(std::size_t{kMostPx} * kMostPx, kNearMetres / kWallMetres))),
      atlas_(makeDepth(device, "atlas", kAtlasPx, true, noise())) {}

ViewInput SmallScene::input(const Shot& shot) {
    lights_.clear();
    views_.clear();
    for (std::uint32_t i = 0; i < shot.lights; ++i) {
        Light light;
        light.type = LightType::Spot;
        const float spread = 1.2f;
        light.position[0] = spread * (static_cast<float>(i % kGridColumns) - 3.5f);
        light.position[1] = spread * (static_cast<float>(i / kGridColumns % kGridColumns) - 3.5f);
        light.position[2] = -kLightMetres;
        light.outerConeAngle = 0.9f;
        light.rangeMetres = 4.0f;
        light.filter = static_cast<Filter>(shot.settings.filters == 0 ? 0 : std::countr_zero(shot.settings.filters));
        lights_.push_back(light);
        ShadowView view;
        writePerspective(1.0f / kLightTangent, light.position, view.clipFromWorld);
        view.widthPx = view.heightPx = kShadowViewPx;
        view.nearMetres = kNearMetres;
        view.changed = shot.viewsChanged;
        views_.push_back(view);
    }
    ViewInput input;
    writePerspective(1.0f, {0.0f, 0.0f, 0.0f}, input.camera.clipFromView);
    input.widthPx = shot.widthPx;
    input.heightPx = shot.heightPx;
    input.lights = lights_;
    return input;
}

Result SmallScene::begin(View& view, const Shot& shot, std::uint64_t frameNumber) {
    PreparedLights prepared;
    if (Result result = view.prepare(input(shot), prepared); !result) return result;
    std::vector<LightShadowViews> lightViews;
    for (const LightOnScreen& light : prepared.visible) lightViews.push_back({light.light, 1});
    const ShadowAtlas atlas = {atlas_.view(), kAtlasPx, kAtlasPx};
    FrameDesc frame;
    frame.frameNumber = frameNumber;
    frame.settings = shot.settings;
    frame.lightViews = lightViews;
    frame.shadowViews = views_;
    frame.depth = {depth_.view()};
    frame.atlases = {&atlas, 1};
    frame.timeline = shot.timeline;
    return view.beginFrame(frame);
}

void SmallScene::record(View& view, const Shot& shot, VkCommandBuffer commands) {
    const auto hostRow = [&](const char* name, Phase phase, RowKind kind) {
        if (!shot.hostRows || shot.timeline == nullptr) return;
        shot.timeline->end(commands, shot.timeline->begin(commands, name, phase, kind));
    };
    hostRow("gbuffer", Phase::Host, RowKind::Drawing);
    view.recordHierarchicalDepth(commands);
    view.recordFindLightsApproximate(commands);
    view.recordFindLightsAccurate(commands);
    hostRow("shadowmaps", Phase::Host, RowKind::Drawing);
    if (shot.settings.shadowBounds) view.recordShadowBounds(commands);
    view.recordGenerateShadows(commands);
    hostRow("lighting", Phase::Lighting, RowKind::Compute);
    view.recordEndFrame(commands);
}

Frames::Frames(const renderer::Device& device, SmallScene& scene, std::uint32_t framesInFlight)
    : device_(device), scene_(scene) {
    for (std::uint32_t i = 0; i < framesInFlight; ++i)
        commands_.push_back(std::make_unique<renderer::Commands>(device));
}

std::uint64_t Frames::run(View& view, const Shot& shot) {
    const std::uint64_t number = next_++;
    renderer::Commands& commands = *commands_[number % commands_.size()];
    const VkCommandBuffer c = commands.begin();
    if (shot.timeline != nullptr) shot.timeline->beginFrame(c, number);
    const Result begun = scene_.begin(view, shot, number);
    EXPECT_TRUE(begun) << begun.message();
    if (begun) SmallScene::record(view, shot, c);
    commands.submit();
    return number;
}

void Frames::wait() {
    for (const auto& commands : commands_) commands->wait();
}

std::unique_ptr<Context> makeContext(const renderer::Device& device, const ContextDesc& more) {
    const std::uint32_t family = device.queueFamily();
    ContextDesc desc = more;
    desc.instance = device.instance().handle();
    desc.physicalDevice = device.physical();
    desc.device = device.handle();
    desc.getInstanceProcAddr = vkGetInstanceProcAddr;
    desc.queueFamilies = {&family, 1};
    desc.debugLabels = device.instance().debugLabels();
    std::unique_ptr<Context> context;
    const Result result = Context::create(desc, context);
    EXPECT_TRUE(result) << result.message();
    return context;
}

std::unique_ptr<View> makeView(const Context& context, const ViewDesc& desc) {
    std::unique_ptr<View> view;
    const Result result = View::create(context, desc, view);
    EXPECT_TRUE(result) << result.message();
    return view;
}

std::unique_ptr<Timeline> makeTimeline(const Context& context, const TimelineDesc& desc) {
    std::unique_ptr<Timeline> timeline;
    const Result result = Timeline::create(context, desc, timeline);
    EXPECT_TRUE(result) << result.message();
    return timeline;
}

ViewDesc smallView(std::uint32_t widthPx, std::uint32_t heightPx, std::uint32_t framesInFlight) {
    ViewDesc desc;
    desc.maxWidthPx = widthPx;
    desc.maxHeightPx = heightPx;
    desc.framesInFlight = framesInFlight;
    desc.listEntries = 20000;
    desc.visibilitySlots = 20000;
    desc.maxShadowViews = 64;
    desc.shadowBoundsTexels = std::uint64_t{kAtlasPx} * kAtlasPx;
    return desc;
}

FrameStatistics countedAlone(const renderer::Device& device, const Context& context, SmallScene& scene,
                             const Shot& shot) {
    const std::unique_ptr<View> view = makeView(context, smallView(shot.widthPx, shot.heightPx));
    Frames frames(device, scene, 2);
    Shot alone = shot;
    alone.timeline = nullptr;
    const std::uint64_t number = frames.run(*view, alone);
    frames.wait();
    FrameStatistics counted;
    EXPECT_TRUE(view->statistics(number, counted));
    // The scene is what these tests need: lists, slots, and no overflow.
    EXPECT_GT(counted.tilesWithGeometry, 0u);
    EXPECT_GT(counted.finalEntries, 0u);
    EXPECT_GT(counted.visibilitySlots, 0u);
    EXPECT_EQ(counted.listOverflowTiles, 0u);
    EXPECT_EQ(counted.slotOverflowEntries, 0u);
    return counted;
}

void expectSameCounts(const FrameStatistics& found, const FrameStatistics& expected) {
    EXPECT_EQ(found.lights.visible, expected.lights.visible);
    EXPECT_EQ(found.lights.casting, expected.lights.casting);
    EXPECT_EQ(found.listEntries, expected.listEntries);
    EXPECT_EQ(found.visibilitySlots, expected.visibilitySlots);
    EXPECT_EQ(found.listOverflowTiles, expected.listOverflowTiles);
    EXPECT_EQ(found.slotOverflowEntries, expected.slotOverflowEntries);
    EXPECT_EQ(found.accurateExceedsApproximate, 0u);
    EXPECT_EQ(found.evaluateTiles, expected.evaluateTiles);
    EXPECT_EQ(found.tilesWithGeometry, expected.tilesWithGeometry);
    EXPECT_EQ(found.approximateEntries, expected.approximateEntries);
    EXPECT_EQ(found.earlyEntries, expected.earlyEntries);
    EXPECT_EQ(found.earlyCastingEntries, expected.earlyCastingEntries);
    EXPECT_EQ(found.finalEntries, expected.finalEntries);
    EXPECT_EQ(found.finalSlotEntries, expected.finalSlotEntries);
    EXPECT_EQ(found.maxLightsInTile, expected.maxLightsInTile);
}

}  // namespace gnomon::test
