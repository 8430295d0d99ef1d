// Settings that change in a running renderer: each picture is the one of a fresh renderer, to the bit, and what is made
// for it is told: no view, and nothing at all the second time.
#include "image/renderer/harness.h"
#include "renderer/gpu/error.h"

namespace gnomon::renderer::image_test {
namespace {

GNOMON_IMAGE_TEST_SUITE(Switching);

struct Change {
    const char* name;
    void (*apply)(FrameSettings&);
    bool grows = false;  // beyond the largest extent so far
};
const Change kChanges[] = {
    {"as it was", [](FrameSettings&) {}},
    {"hard", [](FrameSettings& f) { f.filters = {Filter::Hard}; }},
    {"pcf, radius 2",
     [](FrameSettings& f) {
         f.filters = {Filter::Pcf};
         f.shadows.pcfRadius = 2;
     }},
    {"other taps",
     [](FrameSettings& f) {
         f.shadows.pcssPresets[0] = {6, 9};
     }},
    {"slots of 4 bits", [](FrameSettings& f) { f.shadows.visibilityBits = 4; }},
    {"shared searches", [](FrameSettings& f) { f.filters = {Filter::PcssShared}; }},
    {"lists by pixel", [](FrameSettings& f) { f.shadows.lightLists = LightLists::Pixel; }},
    {"list space by phase 2", [](FrameSettings& f) { f.shadows.listReservation = ListReservation::Approximate; }},
    {"one depth for all texels",
     [](FrameSettings& f) {
         f.filters = {Filter::Hard};
         f.shadows.depthBias = DepthBias::OrientedConstant;
         f.drawing.bias = {.slopeFactor = 1.0f};
     }},
    {"hardware bias",
     [](FrameSettings& f) {
         f.filters = {Filter::Hard};
         f.shadows.depthBias = DepthBias::Unbiased;
         f.drawing.bias = {.constantFactor = 4096.0f, .slopeFactor = 2.0f};
     }},
    {"wider cube faces", [](FrameSettings& f) { f.faceGuardTexels = 16; }},
    {"standard depth", [](FrameSettings& f) { f.deviceDepth = DeviceDepth::StandardZ; }},
    {"smaller",
     [](FrameSettings& f) {
         f.widthPx = 67;
         f.heightPx = 43;
     }},
    {"larger",
     [](FrameSettings& f) {
         f.widthPx = 130;
         f.heightPx = 75;
     },
     true},
    {"as it was again", [](FrameSettings&) {}},
};

TEST_P(Switching, EveryPictureIsThatOfAFreshRenderer) {
    const View3d view = builtin("sundial", 16);
    RendererDesc desc = smallDesc(120, 68);
    // Where pools overflow, other pipelines shade, which may differ in the last bit: they are large enough here.
    desc.listEntries = desc.visibilitySlots = 1u << 17;
    Renderer kept(device(), view.scene, desc, pipelinesOf(device()));
    std::uint32_t resizes = 0;
    for (const Change& change : kChanges) {
        SCOPED_TRACE(change.name);
        RendererDesc fresh = desc;
        change.apply(fresh.frame);
        kept.set(fresh.frame);
        const Frame actual = draw(kept, view.camera, ShadowMode::Deferred);
        resizes += change.grows ? 1 : 0;
        EXPECT_EQ(kept.counts().views, 1u);
        EXPECT_EQ(kept.counts().resizes, resizes);
        // A few of them where a handful must do.
        const std::string name = change.name;
        if (!thorough() && name != "hard" && name != "shared searches" && name != "lists by pixel" &&
            name != "slots of 4 bits" && name != "wider cube faces" && name != "smaller")
            continue;
        const Frame expected = drawOnce(device(), view, fresh, ShadowMode::Deferred);
        EXPECT_EQ(actual.linear.width, fresh.frame.widthPx);
        EXPECT_TRUE(actual.linear.rgba == expected.linear.rgba);
    }
    // Once more through all of them.
    const RendererCounts before = kept.counts();
    for (const Change& change : kChanges) {
        FrameSettings settings = desc.frame;
        change.apply(settings);
        kept.set(settings);
        kept.renderFrame(view.camera, ShadowMode::Deferred);
    }
    kept.wait();
    EXPECT_EQ(kept.counts().libraryPipelines, before.libraryPipelines);
    EXPECT_EQ(kept.counts().lightingPipelines, before.lightingPipelines);
    EXPECT_EQ(kept.counts().resizes, before.resizes);
}

// prepare() makes what the next frame needs, so that the frame makes nothing.
TEST_P(Switching, PreparedFramesMakeNoPipelines) {
    const View3d view = builtin("boxes");
    RendererDesc desc = smallDesc(64, 40);
    desc.frame.filters = {Filter::Hard};
    Renderer renderer(device(), view.scene, desc);  // with pipelines of its own
    for (const ShadowMode mode : {ShadowMode::Deferred, ShadowMode::Inline, ShadowMode::Off}) {
        const RendererCounts none = renderer.counts();
        renderer.prepare(mode);
        const RendererCounts prepared = renderer.counts();
        EXPECT_GT(prepared.lightingPipelines, none.lightingPipelines);
        draw(renderer, view.camera, mode);
        EXPECT_EQ(renderer.counts().libraryPipelines, prepared.libraryPipelines);
        EXPECT_EQ(renderer.counts().lightingPipelines, prepared.lightingPipelines);
    }
}

// A second renderer on the same pipelines makes none, and draws what the first one drew.
TEST_P(Switching, SharedPipelinesAreMadeOnce) {
    const View3d view = builtin("boxes");
    RendererDesc desc = smallDesc(64, 40);
    desc.frame.filters = {Filter::Hard};
    const auto shared = std::make_shared<SharedPipelines>(device());
    Renderer first(device(), view.scene, desc, shared);
    const HdrPicture picture = draw(first, view.camera, ShadowMode::Deferred).linear;
    const RendererCounts made = first.counts();
    EXPECT_GT(made.libraryPipelines, 0u);
    EXPECT_GT(made.lightingPipelines, 0u);
    Renderer second(device(), view.scene, desc, shared);
    EXPECT_TRUE(draw(second, view.camera, ShadowMode::Deferred).linear.rgba == picture.rgba);
    EXPECT_EQ(second.counts().libraryPipelines, made.libraryPipelines);
    EXPECT_EQ(second.counts().lightingPipelines, made.lightingPipelines);
    desc.subgroupSize = device().info().subgroupSize;
    EXPECT_THROW(Renderer(device(), view.scene, desc, shared), GpuError) << "pipelines of another wish";
}

// Two ways of drawing shadowmaps, each with an atlas of its own: going to and fro draws nothing again.
TEST_P(Switching, KeptDrawingsAreNotDrawnAgain) {
    const View3d view = builtin("boxes");
    RendererDesc desc = smallDesc(64, 40);
    desc.frame.filters = {Filter::Hard};
    desc.keptDrawings = 2;
    FrameSettings biased = desc.frame;
    biased.drawing.bias = {.slopeFactor = 1.0f};
    Renderer renderer(device(), view.scene, desc, pipelinesOf(device()));
    for (int round = 0; round < 3; ++round)
        for (const FrameSettings* settings : {&desc.frame, &biased}) {
            renderer.set(*settings);
            const Frame frame = draw(renderer, view.camera, ShadowMode::Deferred);
            EXPECT_EQ(frame.report.shadowViewsDrawn > 0, round == 0);
        }
    EXPECT_EQ(renderer.counts().views, 2u);
}

// A pool that was too small follows the need, and the picture stays.
TEST_P(Switching, PoolsGrowWithinTheirLimit) {
    const View3d view = builtin("boxes");
    RendererDesc desc = smallDesc();
    desc.frame.filters = {Filter::Hard};
    const Frame ample = drawOnce(device(), view, desc, ShadowMode::Deferred);
    desc.listEntries = 96;
    desc.visibilitySlots = 8;
    desc.mostListEntries = desc.mostVisibilitySlots = 1u << 20;
    Renderer renderer(device(), view.scene, desc, pipelinesOf(device()));
    std::uint32_t overflowing = 0;
    for (int frame = 0; frame < 8; ++frame) {
        const Frame now = draw(renderer, view.camera, ShadowMode::Deferred);
        EXPECT_TRUE(now.linear.rgba == ample.linear.rgba) << frame;
        const FrameStatistics& s = now.report.statistics;
        overflowing = s.listOverflowTiles + s.slotOverflowEntries;
        if (frame == 0) {
            EXPECT_GT(overflowing, 0u);
        }
    }
    EXPECT_EQ(overflowing, 0u) << "the pools did not follow";
}

}  // namespace
}  // namespace gnomon::renderer::image_test
