#pragma once
// One view on one device: uploads a frame's input, runs the phases, reads everything back.

#include <functional>
#include <memory>
#include <vector>

#include "devices.h"
#include "gpu_interface/packing.h"
#include "gpu_interface/structs.h"
#include "reference/lists.h"
#include "reference/receivers.h"
#include "reference/test_shadows.h"
#include "renderer/gpu/resources.h"

namespace gnomon::test {

/// Every word of every device buffer of the library holds this before a frame.
inline constexpr std::uint32_t kCanary = 0xA5C3F00Du;
inline constexpr std::uint32_t kGuardBytes = 1024;

/// What most tests run with: percentage closer filtering, and space in the lists as the paper gives it out.
[[nodiscard]] inline ShadowSettings plainSettings() {
    ShadowSettings settings;
    settings.filters = only(Filter::Pcf);
    settings.listReservation = ListReservation::Approximate;
    return settings;
}

struct FrameInput {
    std::uint32_t widthPx = 64, heightPx = 40;  ///< active extent
    std::uint32_t viewportXPx = 0, viewportYPx = 0;
    Camera camera;
    std::vector<Light> lights;
    std::vector<LightShadowViews> lightViews;  ///< of each light, in the order of `lights`; beyond its end: none
    ShadowSettings settings = plainSettings();
    reference::Receivers receivers;  ///< of the active extent; images for what is not empty
    std::shared_ptr<const reference::TestShadows> shadows;
    bool shadowViewsChanged = true;   ///< what the host says of all its shadow views
    std::vector<float> depthPyramid;  ///< with hostDepthPyramid: min and max device depth per shadow tile
};

/// CPU copies of everything that the library answered and wrote.
struct FrameResult {
    std::vector<LightOnScreen> answer;  ///< of prepare()
    PrepareReport answerReport;
    PrepareReport report;  ///< of beginFrame()
    gpu::GpuFrame constants{};
    std::vector<gpu::GpuLight> lights;
    std::vector<float> depthRanges;
    std::vector<std::uint32_t> depthSlices, tileLightMasks;
    std::vector<std::uint32_t> groupMasks, slotIds, approximateCounts, earlyList, earlyCounts, finalList, finalCounts,
        visibility, evaluateTiles;  ///< per-tile ones: of the active tiles, the others whole
    std::vector<std::uint32_t> listTiles, queuedPairs;
    gpu::GpuPairHead pairs{};
    std::vector<gpu::vec2> shadowBounds;  ///< least and greatest depths; see src/shadow_bounds
    gpu::GpuCounters counters{};
    FrameStatistics statistics;
    bool hasStatistics = false;
    std::vector<TimelineRow> rows;
    std::uint32_t listCapacity = 0, slotCapacity = 0, subgroupSize = 0;
    std::size_t brokenGuards = 0;  ///< words outside the contents of a buffer that are no longer kCanary
    std::size_t beyondTiles = 0;   ///< words of per-tile arrays beyond the active tiles, likewise
    ShadowSettings settings;

    [[nodiscard]] std::uint32_t slotWords() const { return gpu::visibilitySlotWords(settings.visibilityBits); }
    [[nodiscard]] std::uint32_t tilesX() const { return constants.tileCounts.x; }
    [[nodiscard]] std::uint32_t tilesY() const { return constants.tileCounts.y; }
    [[nodiscard]] reference::ListBuffers lists() const;
};

struct RunOptions {
    bool shadows = true;   ///< record phase 4
    bool endFrame = true;  ///< record the statistics
    bool fill = true;      ///< fill the library's buffers with kCanary first
    bool timeline = true;  ///< rows for every pass
};

class Rig {
public:
    /// Images are larger than the view by 24 x 16 pixels, for viewport offsets. `desc`: guardBytes is set here.
    Rig(TestDevice& device, const ContextSetup& setup, const ViewDesc& desc);
    /// With a context of the test's own, which must outlive the rig.
    Rig(TestDevice& device, const Context& context, const ViewDesc& desc);
    ~Rig();
    Rig(const Rig&) = delete;
    Rig& operator=(const Rig&) = delete;

    /// Waits for the device. Fails the test where a call of the library fails.
    FrameResult run(const FrameInput& input, const RunOptions& options = {});
    /// One submission per input, all recorded before any is waited for; at most ViewDesc::framesInFlight of them. The
    /// images are those of the first. `before` is called before each frame is begun.
    void runInFlight(const std::vector<FrameInput>& inputs, const std::function<void(std::size_t)>& before = {});
    /// Destroys all images, so that the next frame makes new ones.
    void dropImages();
    /// Phase 1 alone: prepare() and beginFrame(). Images are made, nothing is recorded.
    Result begin(const FrameInput& input, PrepareReport* report = nullptr);
    /// What prepare() is given, to be spoilt by tests of misuse.
    [[nodiscard]] static ViewInput viewInput(const FrameInput& input);
    Result prepare(const FrameInput& input);
    /// What beginFrame() is given after prepare(), to be spoilt likewise; valid until the next call.
    FrameDesc frameDesc(const FrameInput& input);
    /// Another extent or other pools.
    Result resize(const ViewDesc& desc);

    [[nodiscard]] View& view() { return *view_; }
    [[nodiscard]] bool ok() const { return view_ != nullptr; }
    [[nodiscard]] std::uint64_t lastFrame() const { return nextFrame_ - 1; }
    [[nodiscard]] const Timeline& timeline() const { return *timeline_; }
    [[nodiscard]] std::span<const LightOnScreen> answer() const { return answer_.visible; }

private:
    void create(const Context& context);
    void makeImages(const FrameInput& input);
    void recordUploads(VkCommandBuffer commands, const FrameInput& input);
    void recordFill(VkCommandBuffer commands) const;
    void recordPhases(VkCommandBuffer commands, const RunOptions& options);
    void recordReadback(VkCommandBuffer commands);
    void decode(FrameResult& result) const;
    [[nodiscard]] std::vector<std::uint32_t> contents(const char* name) const;

    TestDevice& device_;
    ViewDesc desc_;
    std::unique_ptr<View> view_;
    std::uint32_t subgroupSize_ = 0;
    std::unique_ptr<Timeline> timeline_;
    PreparedLights answer_;
    std::vector<LightShadowViews> views_;  // of the answer's lights
    ShadowSettings settings_;              // of the frame begun
    bool withTimeline_ = true;
    std::uint64_t nextFrame_ = 1;
    renderer::GpuImage depth_, faceNormals_, receiverFlags_, pyramid_;
    std::vector<renderer::GpuImage> atlases_;
    std::vector<ShadowAtlas> atlasDescs_;
    std::shared_ptr<const reference::TestShadows> shadows_;  // those in atlases_
    bool atlasesUploaded_ = false;
    std::vector<ShadowView> unchangedViews_;  // of the frame begun, where they are said to be so
    bool boundsKept_ = false;                 // no view has changed: the fill leaves them alone
    std::vector<renderer::Buffer> staging_;
    struct Range {
        std::string name;
        VkDeviceSize offset = 0, bytes = 0;  // in readback_; guards included
        bool guarded = false;
    };
    std::vector<Range> ranges_;
    renderer::Buffer readback_;
};

}  // namespace gnomon::test
