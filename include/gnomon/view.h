#pragma once
// View: tiled deferred shadows of one camera, phases 1 to 4, recorded into the host's own command buffers.
//
// The host owns instance, device, queues, command buffers, images and submission. The library never submits or waits.
// A frame allocates in two cases only: where ViewDesc allows pools to grow, and where its settings need pipelines that
// Context::prepare() has not made.
//
// One frame of one view:
//
//     view.prepare(input, lights);                     // phase 1 on the CPU: which lights are visible, and how large
//     ... the host plans its shadow views for these ...
//     view.beginFrame(frame);                          // checks, and fills mapped memory
//     view.recordHierarchicalDepth(commands);          // needs the host's depth
//     view.recordFindLightsApproximate(commands);      // phase 2 \  need no shadowmap: may run on an async compute
//     view.recordFindLightsAccurate(commands);         // phase 3 /  queue while shadowmaps are drawn (LightLists)
//     view.recordShadowBounds(commands);               // optional, needs the shadowmaps
//     view.recordGenerateShadows(commands);            // phase 4, needs the shadowmaps
//     ... the host's lighting, with listsSet(): see src/shading/tile_lights.glsl ...
//     view.recordEndFrame(commands);                   // statistics; after the lighting
//
// Source: Fatnassi 2023, "Shadow Techniques from Final Fantasy XVI", section 2.

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gnomon/context.h"
#include "gnomon/export.h"
#include "gnomon/prepare.h"
#include "gnomon/result.h"
#include "gnomon/scene.h"
#include "gnomon/settings.h"
#include "gnomon/timeline.h"

namespace gnomon {

struct ViewDesc {
    std::uint32_t maxWidthPx = 3840, maxHeightPx = 2160;  ///< 1 to 16384 each; at most 4,186,127 tiles of 8x8
    std::uint32_t framesInFlight = 2;  ///< 1 to 4: frames the host records before the oldest has finished
    /// Pools. 0: 8 list entries and 4 slots per shadow tile on average. Capped by the device's largest storage buffer:
    /// see MemoryReport.
    std::uint32_t listEntries = 0;
    std::uint32_t visibilitySlots = 0;
    /// 8 or 4: the bits of the slots that visibilitySlots counts. A frame with other ShadowSettings::visibilityBits has
    /// half or twice as many slots in the same memory.
    std::uint32_t visibilityBits = 8;
    /// Above 0: a pool may grow up to this. If a frame that has finished would have needed more, beginFrame() makes the
    /// pool as large as FrameStatistics recommends. It then allocates, and frees the old buffer when its frames have
    /// finished. Tiles without list space ask for no slots: so slots may grow one round after the lists. Without memory
    /// the pools stay as they are until the next resize(). Slots count in `visibilityBits`.
    std::uint32_t mostListEntries = 0;
    std::uint32_t mostVisibilitySlots = 0;
    std::uint32_t maxShadowViews = 4096;
    /// Texels of all shadow atlases and layers for which recordShadowBounds() keeps bounds (11 bytes per 256), their
    /// sides rounded up to multiples of 256; frames with larger atlases do without. 0: never.
    std::uint64_t shadowBoundsTexels = std::uint64_t{8192} * 8192;
    bool statistics = true;  ///< sums over all tiles, in one small extra pass: see FrameStatistics
    /// Testing: bytes that are left free before and after the contents of every device buffer, and are never written.
    /// A multiple of 256; buffer() then returns buffers whose contents begin at this offset.
    std::uint32_t guardBytes = 0;
    PrepareDesc prepare;  ///< its extent is set from this one
};

struct BufferMemory {
    const char* name = "";
    std::uint64_t bytes = 0;
    bool perFrame = false;  ///< `bytes` counts one of framesInFlight copies
    bool mapped = false;    ///< host-visible
};

class GNOMON_API MemoryReport {
public:
    [[nodiscard]] std::span<const BufferMemory> buffers() const noexcept { return buffers_; }
    std::uint64_t totalBytes = 0;       ///< with all copies
    std::uint32_t listEntries = 0;      ///< capacities after capping
    std::uint32_t visibilitySlots = 0;  ///< of ViewDesc::visibilityBits
    bool poolsCapped = false;           ///< a pool is smaller than asked for

    void add(const BufferMemory& buffer, std::uint32_t copies);  ///< for the library itself; throws std::bad_alloc

private:
    std::vector<BufferMemory> buffers_;
};

/// An image of the host. Layout while the library's passes run: VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL.
struct HostImage {
    VkImageView view = VK_NULL_HANDLE;
};

struct ShadowAtlas {
    VkImageView view = VK_NULL_HANDLE;  ///< 2D array view of the depth aspect of a D32 or D16 image
    std::uint32_t widthPx = 0, heightPx = 0, layers = 1;
    float depthStep = 0.0f;  ///< between neighbouring values: 0 for D32, 1.6e-5 for D16; the bias grows by it
};

/// One frame. Images are read by compute shaders (stage COMPUTE_SHADER, access SHADER_SAMPLED_READ); the host makes
/// their contents visible to that before the phase that reads them: depth, depth pyramid, face normals and receiver
/// flags before the hierarchical depth, atlases before recordShadowBounds(), or before phase 4 without it.
struct FrameDesc {
    /// Grows from frame to frame, by one or more; a frame that was not submitted may begin again under its number. All
    /// frames up to frameNumber - framesInFlight must have finished on the device.
    std::uint64_t frameNumber = 0;
    ShadowSettings settings;
    /// Per visible light, in the order of View::prepare()'s answer: its shadow views. Empty: no light casts.
    std::span<const LightShadowViews> lightViews;
    std::span<const ShadowView> shadowViews;
    HostImage depth;  ///< D32, D24 or D16 aspect view, 2D
    /// Between neighbouring values of the depth image: 0 for D32, 6e-8 for D24, 1.6e-5 for D16. This step and the
    /// rounding of floats may have moved a position off its face. The bias grows by how far.
    float depthStep = 0.0f;
    /// Optional: R16G16_UINT, octahedral, the side the camera sees (src/shading/octahedral.glsl).
    HostImage faceNormals;
    HostImage receiverFlags;  ///< optional: R8G8_UINT: receiver mask; bit 0: subsurface
    /// With ShadowSettings::hostDepthPyramid: R32G32_SFLOAT, min and max device depth per tile; texel (0, 0) is the
    /// first tile of the active viewport.
    HostImage depthPyramid;
    std::span<const ShadowAtlas> atlases;  ///< up to ContextDesc::maxShadowAtlases
    /// Optional: rows of the passes are written to it; the host has called its beginFrame() for this frame.
    Timeline* timeline = nullptr;
};

/// Counted on the device, and read back when the frame has finished.
struct FrameStatistics {
    std::uint64_t frameNumber = 0;
    PrepareReport lights;
    std::uint32_t listEntries = 0;      ///< asked for, whether or not there was space
    std::uint32_t visibilitySlots = 0;  ///< asked for, whether or not there was space
    std::uint32_t listOverflowTiles = 0;
    std::uint32_t slotOverflowEntries = 0;
    std::uint32_t accurateExceedsApproximate = 0;  ///< must be 0
    std::uint32_t evaluateTiles = 0;               ///< shaded by the second lighting pipeline
    std::uint32_t recommendedListEntries = 0;      ///< capacities with which this frame would not have overflowed
    /// In slots of the frame's own ShadowSettings::visibilityBits, as all counts of slots here; where lists overflow,
    /// without ViewDesc::statistics, a lower bound.
    std::uint32_t recommendedVisibilitySlots = 0;
    double prepareMilliseconds = 0.0;                  ///< CPU time of phase 1: prepare(), and its part of beginFrame()
    std::uint32_t listCapacity = 0, slotCapacity = 0;  ///< what the frame had
    // Only with ViewDesc::statistics, else 0. Sums over all shadow tiles; an entry is one light of one tile.
    std::uint32_t tilesWithGeometry = 0;
    std::uint32_t approximateEntries = 0;   ///< after phase 2
    std::uint32_t earlyEntries = 0;         ///< in the lists before phase 4: see ShadowSettings::lightLists
    std::uint32_t earlyCastingEntries = 0;  ///< of these: of lights that cast
    std::uint32_t finalEntries = 0;         ///< after phase 4, without lights that are dark all over their tile
    std::uint32_t finalSlotEntries = 0;     ///< of these: with a visibility slot
    std::uint32_t maxLightsInTile = 0;      ///< before phase 4
};

/// The buffers of one camera. Not thread safe; different views are independent, and record calls of one frame may go to
/// different command buffers as long as they are made, and executed, in the order given above.
class GNOMON_API View {
public:
    /// The buffers that create() will allocate, without guards, alignment, two images of one texel, and memory of the
    /// CPU. Thread safe.
    static Result memory(const Context& context, const ViewDesc& desc, MemoryReport& out) noexcept;
    /// The context must outlive the view.
    static Result create(const Context& context, const ViewDesc& desc, std::unique_ptr<View>& out) noexcept;
    ~View();
    View(const View&) = delete;
    View& operator=(const View&) = delete;

    [[nodiscard]] const MemoryReport& memory() const noexcept;

    /// Gives the view another extent, other pools or other limits. Only the buffers whose size changes are made anew;
    /// shadow bounds are kept unless their own size changes. Between frames: not after prepare() or beginFrame() of a
    /// frame that is still to be recorded. Frames in flight may go on, since what they use is freed when they have
    /// finished. A pool that has grown by itself keeps its size, unless `desc` asks for another one than before.
    /// framesInFlight, guardBytes and statistics cannot change. On failure the view is as it was, but prepare() must
    /// run again.
    Result resize(const ViewDesc& desc) noexcept;

    /// Phase 1: which lights are visible, in which order, and how large on screen. Fails with a sentence on bad input.
    /// The answer holds until the next prepare() or resize().
    Result prepare(const ViewInput& input, PreparedLights& out) noexcept;
    /// Takes the answer of the last prepare(), which counts for one frame, and the shadow views that the host planned
    /// from it. Makes pipelines where these settings are new (see Context::prepare()). Fails with a sentence on bad
    /// input; the frame must then not be recorded. `report`, if given: what phase 1 kept and dropped.
    Result beginFrame(const FrameDesc& frame, PrepareReport* report = nullptr) noexcept;

    // After a beginFrame() that succeeded. Each records its passes, with barriers, debug labels and timeline rows, and
    // leaves its own compute pipeline and descriptor sets bound. On one queue the library's buffers need no barrier by
    // the host, before or after. Across queues a semaphore is enough. The lists exist once per view: the next frame's
    // recordHierarchicalDepth() must wait for this frame's recordEndFrame().
    void recordHierarchicalDepth(VkCommandBuffer commands) noexcept;
    void recordFindLightsApproximate(VkCommandBuffer commands) noexcept;
    /// Afterwards the early lists are visible to all shaders: record it with LightLists::Froxel, too, where it has no
    /// pass. A host that evaluates every shadow while lighting may leave out phase 4.
    void recordFindLightsAccurate(VkCommandBuffer commands) noexcept;
    /// Optional, with ShadowSettings::shadowBounds: least and greatest depths of blocks of the atlases, made anew for
    /// the shadow views that changed. Soft filters then leave out searches whose result they tell, in phase 4 as in
    /// the host's own shaders. Not a bit of the result changes. To be recorded after the shadowmaps are drawn;
    /// afterwards visible to all shaders.
    void recordShadowBounds(VkCommandBuffer commands) noexcept;
    /// Afterwards the final lists, the visibility and the indirect command are visible to all shaders and to indirect
    /// dispatch.
    void recordGenerateShadows(VkCommandBuffer commands) noexcept;
    void recordEndFrame(VkCommandBuffer commands) noexcept;

    /// Sets for the host's lighting, of the frame last begun. The main lighting pipeline needs listsSet() alone; the
    /// second one, for the tiles in evaluateTilesBuffer(), all three.
    [[nodiscard]] VkDescriptorSet listsSet() const noexcept;
    [[nodiscard]] VkDescriptorSet receiversSet() const noexcept;
    [[nodiscard]] VkDescriptorSet shadowmapsSet() const noexcept;
    /// Dispatch size of the main lighting pipeline: one work group of 64 lanes per shadow tile.
    [[nodiscard]] VkExtent2D tileCounts() const noexcept;
    /// VkDispatchIndirectCommand of the second lighting pipeline.
    [[nodiscard]] VkBuffer evaluateTilesBuffer() const noexcept;
    [[nodiscard]] VkDeviceSize evaluateCommandOffset() const noexcept;

    /// Statistics of a frame that the host knows to have finished: one of the last framesInFlight frames begun. Never
    /// waits. False if the frame is not among them, had no recordEndFrame(), or was never submitted.
    bool statistics(std::uint64_t frameNumber, FrameStatistics& out) const noexcept;

    /// Where a buffer's contents can be copied from, by its name in the memory report (for tools and tests); or null.
    [[nodiscard]] VkBuffer buffer(const char* name) const noexcept;

    struct State;

private:
    explicit View(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

}  // namespace gnomon
