#pragma once
// Tiled deferred shadows, phases 1 to 4, recorded into the host's own command buffers.
//
// The host owns instance, device, queues, command buffers, images and submission. The library never submits, waits or
// allocates per frame. A Context holds pipelines and may serve many Views; a View holds the buffers of one camera.
//
// One frame of one view:
//
//     view.beginFrame(frame, &report);                 // phase 1 on the CPU; fills mapped memory
//     view.recordHierarchicalDepth(commands);          // needs the host's depth
//     view.recordFindLightsApproximate(commands);      // phase 2 \  need no shadowmap: may run on an async compute
//     view.recordFindLightsAccurate(commands);         // phase 3 /  queue while shadowmaps are drawn
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

#include "gnomon/prepare.h"
#include "gnomon/result.h"
#include "gnomon/scene.h"

namespace gnomon {

enum class Filter : std::uint8_t {
    Hard,  ///< one texel, one comparison
    Pcf,   ///< percentage closer filtering over (2 * pcfRadius + 1)^2 bilinear comparisons
    Off,   ///< no shadow at all: what the lists cost by themselves
    Pcss,  ///< percentage closer soft shadows: a penumbra as wide as the light's source makes it
};

/// Taps of Filter::Pcss, each a gather of four texels. A pixel outside of penumbrae takes searchTaps at most, one
/// inside also filterTaps.
struct PcssTaps {
    std::uint32_t searchTaps = 16;  ///< 1 to 64
    std::uint32_t filterTaps = 24;  ///< 1 to 64
};
inline constexpr PcssTaps kPcssLow = {8, 12};
inline constexpr PcssTaps kPcssMedium = {16, 24};
inline constexpr PcssTaps kPcssHigh = {32, 64};

/// What keeps a receiver from shadowing itself.
enum class DepthBias : std::uint8_t {
    /// Nearer to the light by Light::biasMetres, in linear depth, and each texel compared with the plane of the
    /// receiver's face at its own centre. Draw shadowmaps without hardware bias. Needs no tuning.
    /// Source: the paper, section 4.2; the plane is ours.
    Oriented,
    /// The paper's listing 7 as it is meant: one depth for all texels, nearer to the light where the face looks at it,
    /// farther where it looks away. Draw shadowmaps with a slope factor of 1, and set ContextDesc::facedAwayIsDark to
    /// false.
    OrientedConstant,
    /// Depths are compared as they are: for hosts that draw their shadowmaps with a hardware bias.
    Unbiased,
};

/// How space in the light lists is given out.
enum class ListReservation : std::uint8_t {
    Approximate,  ///< the paper's way: by phase 2, one atomic per 64 tiles, as much as the approximate count
    Accurate,     ///< by phase 3, one atomic per tile, as much as the exact count
    Fixed,        ///< debugging: ContextDesc::fixedListEntriesPerTile for every tile, at predictable addresses
};

/// The device, and the variant of the pipelines. Needs Vulkan 1.3 with synchronization2, and computeFullSubgroups and
/// subgroupSizeControl enabled; subgroup operations (basic, arithmetic) in compute shaders; 17 storage buffers per
/// stage; for debugLabels VK_EXT_debug_utils on the instance.
struct ContextDesc {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
    VkPipelineCache pipelineCache = VK_NULL_HANDLE;  ///< optional
    /// Families of all queues that the recorded commands will be submitted to: one, or several where phases run on an
    /// async compute queue (buffers are then shared concurrently, and no ownership transfer is needed).
    std::span<const std::uint32_t> queueFamilies;
    bool debugLabels = false;
    /// 0: the device's own choice. Else 4, 8, 16, 32 or 64, which the device must support.
    std::uint32_t subgroupSize = 0;
    Filter filter = Filter::Pcss;
    std::uint32_t pcfRadius = 1;  ///< texels, 1 to 3
    PcssTaps pcss = kPcssMedium;
    DepthBias depthBias = DepthBias::Oriented;
    /// A pixel whose face looks away from a light is dark, and its shadowmaps are not asked; subsurface pixels are
    /// never. Off, with DepthBias::Unbiased: face normals are not read at all.
    bool facedAwayIsDark = true;
    /// 1 to 4. With one, shaders need not choose at every tap.
    std::uint32_t maxShadowAtlases = 4;
    /// Bits of a pixel's visibility in a slot: 8, or 4 for half the memory and an error of up to 0.066.
    std::uint32_t visibilityBits = 8;
    ListReservation listReservation = ListReservation::Accurate;
    std::uint32_t fixedListEntriesPerTile = 0;  ///< for ListReservation::Fixed, 1 to 1024
    /// The host gives a two-channel pyramid level (min, max device depth per 8x8 tile) instead of having one built.
    bool hostDepthPyramid = false;
    /// Optional SPIR-V of src/generate_shadows/generate_shadows.comp, compiled by the host with
    /// -DGNOMON_HOST_PROVIDER and a gnomon_host_provider.glsl on the include path: see docs/integration.md.
    std::span<const std::uint32_t> generateShadowsSpirv;
};

/// Pipelines and layouts. create() and the destructor: one thread at a time per device; else thread safe (immutable).
class Context {
public:
    static Result create(const ContextDesc& desc, std::unique_ptr<Context>& out) noexcept;
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Set layouts for the host's lighting pipelines; valid as long as the context.
    [[nodiscard]] VkDescriptorSetLayout listsSetLayout() const noexcept;
    [[nodiscard]] VkDescriptorSetLayout receiversSetLayout() const noexcept;
    [[nodiscard]] VkDescriptorSetLayout shadowmapsSetLayout() const noexcept;
    [[nodiscard]] std::uint32_t subgroupSize() const noexcept;
    /// For pipelines of the host that include src/shading: the values of specialization constants 0 to 10, in order.
    [[nodiscard]] std::span<const std::uint32_t> specializationValues() const noexcept;

    struct State;
    [[nodiscard]] const State& state() const noexcept { return *state_; }  ///< for the library itself

private:
    explicit Context(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

struct ViewDesc {
    std::uint32_t maxWidthPx = 3840, maxHeightPx = 2160;
    std::uint32_t framesInFlight = 2;  ///< 1 to 4: frames the host records before the oldest has finished
    /// Pools. 0: 8 per shadow tile on average. Capped by the device's largest storage buffer; capacities() tells.
    std::uint32_t listEntries = 0;
    std::uint32_t visibilitySlots = 0;
    std::uint32_t maxShadowViews = 4096;
    /// Texels of all shadow atlases and layers for which recordShadowBounds() keeps bounds (11 bytes per 256), their
    /// sides rounded up to multiples of 256; frames with larger atlases do without. 0: never.
    std::uint64_t shadowBoundsTexels = std::uint64_t{8192} * 8192;
    bool timestamps = true;  ///< GPU times of every pass in the statistics (needs a queue with timestamps)
    bool statistics = true;  ///< the means over tiles (one small extra pass)
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

struct MemoryReport {
    static constexpr std::uint32_t kMaxBuffers = 24;
    BufferMemory buffers[kMaxBuffers];
    std::uint32_t bufferCount = 0;
    std::uint64_t totalBytes = 0;   ///< with all copies
    std::uint32_t listEntries = 0;  ///< capacities after capping
    std::uint32_t visibilitySlots = 0;
    bool poolsCapped = false;  ///< a pool is smaller than asked for
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
/// their contents visible to that before the phase that reads them: depth, face normals and receiver flags before the
/// hierarchical depth, atlases before recordShadowBounds(), or before phase 4 without it.
struct FrameDesc {
    /// Grows by one per frame. The frame with frameNumber - framesInFlight must have finished on the device.
    std::uint64_t frameNumber = 0;
    ViewInput view;
    std::span<const ShadowView> shadowViews;
    HostImage depth;  ///< D32, D24 or D16 aspect view, 2D
    /// Between neighbouring values of the depth image: 0 for D32, 6e-8 for D24, 1.6e-5 for D16. The bias grows by what
    /// that, and the rounding of floats, may make of a position.
    float depthStep = 0.0f;
    /// Optional: R16G16_UINT, octahedral, the side the camera sees (src/shading/octahedral.glsl).
    HostImage faceNormals;
    HostImage receiverFlags;  ///< optional: R8G8_UINT: receiver mask; bit 0: subsurface
    /// With ContextDesc::hostDepthPyramid: R32G32_SFLOAT, min and max device depth per tile; texel (0, 0) is the first
    /// tile of the active viewport.
    HostImage depthPyramid;
    std::span<const ShadowAtlas> atlases;  ///< up to 4
    /// recordShadowBounds() will be called in this frame. Bounds are kept from frame to frame while ShadowView::changed
    /// is false; set that true once after a recorded frame that was never submitted.
    bool shadowBounds = false;
    /// Subsurface pixels move toward the light by this, if it is more than the light's own bias. Where subsurface
    /// casters are drawn without the faces that look at the light, 0 is right; where those are drawn too, the thickness
    /// through which light shall pass. Source: the paper, section 4.2.
    float subsurfaceBiasMetres = 0.02f;
    /// Turns the sample pattern of Filter::Pcss from frame to frame, for hosts that accumulate frames.
    bool patternPerFrame = false;
    /// Phase 3 drops lights that every pixel of a tile looks away from, with ContextDesc::facedAwayIsDark.
    bool dropLightsFacedAway = true;
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
    std::uint32_t recommendedVisibilitySlots = 0;  ///< where lists overflow: without `statistics` a lower bound
    // Only with ViewDesc::statistics:
    std::uint32_t tilesWithGeometry = 0;
    std::uint32_t approximateEntries = 0, earlyEntries = 0, earlyCastingEntries = 0;
    std::uint32_t finalEntries = 0, finalSlotEntries = 0, maxLightsInTile = 0;
    // Only with ViewDesc::timestamps:
    static constexpr std::uint32_t kMaxPasses = 8;
    struct PassTime {
        const char* name = "";
        double milliseconds = 0.0;
    } passes[kMaxPasses];
    std::uint32_t passCount = 0;
    double prepareMilliseconds = 0.0;  ///< CPU time of phase 1
};

/// The buffers of one camera. Not thread safe; different views are independent, and record calls of one frame may go to
/// different command buffers as long as they are made, and executed, in the order given above.
class View {
public:
    /// What create() will allocate. Thread safe.
    static Result memory(const Context& context, const ViewDesc& desc, MemoryReport& out) noexcept;
    /// The context must outlive the view.
    static Result create(const Context& context, const ViewDesc& desc, std::unique_ptr<View>& out) noexcept;
    ~View();
    View(const View&) = delete;
    View& operator=(const View&) = delete;

    [[nodiscard]] const MemoryReport& memory() const noexcept;

    /// Phase 1. Fails with a sentence on bad input; the frame must then not be recorded.
    Result beginFrame(const FrameDesc& frame, PrepareReport* report = nullptr) noexcept;

    // Each records one pass with its barriers, debug label and timestamps, and leaves its own compute pipeline and
    // descriptor sets 0 to 2 bound. Before and after, the library's buffers need no barrier by the host as long as
    // everything runs on one queue. Across queues a semaphore is enough; since the
    // lists exist once per view, the next frame's recordHierarchicalDepth() must wait for this frame's
    // recordEndFrame().
    void recordHierarchicalDepth(VkCommandBuffer commands) noexcept;
    void recordFindLightsApproximate(VkCommandBuffer commands) noexcept;
    /// Afterwards the early lists are visible to all shaders. A host that evaluates every shadow while lighting may
    /// leave out phase 4.
    void recordFindLightsAccurate(VkCommandBuffer commands) noexcept;
    /// Optional, with FrameDesc::shadowBounds: least and greatest depths of blocks of the atlases, of the views that
    /// changed. Filter::Pcss, in phase 4 as in the host's own shaders, then leaves out searches whose result they tell;
    /// not a bit of the result changes. After the shadowmaps are drawn; afterwards visible to all shaders.
    void recordShadowBounds(VkCommandBuffer commands) noexcept;
    /// Afterwards the final lists, the visibility and the indirect command are visible to all shaders and to indirect
    /// dispatch.
    void recordGenerateShadows(VkCommandBuffer commands) noexcept;
    void recordEndFrame(VkCommandBuffer commands) noexcept;

    /// Sets for the host's lighting, of the frame last begun. The main lighting pipeline needs listsSet() alone; the
    /// second one, for the tiles in evaluateTiles(), all three.
    [[nodiscard]] VkDescriptorSet listsSet() const noexcept;
    [[nodiscard]] VkDescriptorSet receiversSet() const noexcept;
    [[nodiscard]] VkDescriptorSet shadowmapsSet() const noexcept;
    /// Dispatch size of the main lighting pipeline: one work group of 64 lanes per shadow tile.
    [[nodiscard]] VkExtent2D tileCounts() const noexcept;
    /// VkDispatchIndirectCommand of the second lighting pipeline.
    [[nodiscard]] VkBuffer evaluateTilesBuffer() const noexcept;
    [[nodiscard]] VkDeviceSize evaluateCommandOffset() const noexcept;

    /// Statistics of a frame that the host knows to have finished: one of the last framesInFlight frames begun. Never
    /// waits. False if the frame is not among them or had no recordEndFrame().
    bool statistics(std::uint64_t frameNumber, FrameStatistics& out) const noexcept;

    /// Where a buffer's contents can be copied from, by its name in the memory report (for tools and tests).
    [[nodiscard]] VkBuffer buffer(const char* name) const noexcept;

    struct State;

private:
    explicit View(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

}  // namespace gnomon
