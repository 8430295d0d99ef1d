#include "rig.h"

#include <algorithm>
#include <cstring>

namespace gnomon::test {
namespace {

using renderer::Access;
using renderer::GpuImage;
using renderer::ImageDesc;

constexpr std::uint32_t kExtraX = 24, kExtraY = 16;  // pixels of the images beyond the view
constexpr Access kAll{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
constexpr const char* kDeviceBuffers[] = {
    "tile_group_light_masks", "tile_depth_ranges", "tile_depth_slices", "tile_light_slot_ids", "approximate_counts",
    "early_light_list",       "early_counts",      "final_light_list",  "final_counts",        "visibility",
    "evaluate_tiles",         "counters",          "list_tiles",        "pair_queues",         "queued_pairs",
    "shadow_bounds"};

void barrier(VkCommandBuffer commands, Access before, Access after) {
    VkMemoryBarrier2 all{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    all.srcStageMask = before.stage;
    all.srcAccessMask = before.access;
    all.dstStageMask = after.stage;
    all.dstAccessMask = after.access;
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &all;
    vkCmdPipelineBarrier2(commands, &info);
}

GpuImage makeImage(const renderer::Device& device, const char* name, VkFormat format, std::uint32_t width,
                   std::uint32_t height, std::uint32_t layers = 1, bool array = false) {
    ImageDesc desc;
    desc.name = name;
    desc.format = format;
    desc.width = width;
    desc.height = height;
    desc.layers = layers;
    desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    desc.arrayView = array;
    return GpuImage(device, desc);
}

/// Fills the image with a trap, and a rectangle of it with the texels of one layer after the other.
struct Placement {
    const GpuImage* image = nullptr;
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
    std::uint32_t trap = 0;  // repeated over the bytes of a texel
};

renderer::Buffer stage(const renderer::Device& device, const Placement& place, const void* texels) {
    const ImageDesc& desc = place.image->desc();
    const std::size_t texel = renderer::bytesPerTexel(desc.format);
    const std::size_t total = std::size_t(desc.width) * desc.height * desc.layers * texel;
    renderer::Buffer buffer(device, "staging", total, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, renderer::MemoryUse::Upload);
    auto* out = buffer.mapped<std::byte>();
    const auto* in = static_cast<const std::byte*>(texels);
    if (place.width != desc.width || place.height != desc.height)
        for (std::size_t i = 0; i < total; i += texel)
            std::memcpy(out + i, reinterpret_cast<const std::byte*>(&place.trap), std::min<std::size_t>(texel, 4));
    for (std::uint32_t layer = 0; layer < desc.layers; ++layer)
        for (std::uint32_t y = 0; y < place.height; ++y) {
            const std::size_t to = ((std::size_t(layer) * desc.height + place.y + y) * desc.width + place.x) * texel;
            const std::size_t from = (std::size_t(layer) * place.height + y) * place.width * texel;
            std::memcpy(out + to, in + from, place.width * texel);
        }
    return buffer;
}

void copyToImage(VkCommandBuffer commands, const renderer::Buffer& from, const GpuImage& image) {
    const ImageDesc& desc = image.desc();
    VkImageMemoryBarrier2 change = renderer::imageBarrier(
        image, VK_IMAGE_LAYOUT_UNDEFINED, kAll, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, renderer::access::kTransferWrite);
    renderer::recordBarriers(commands, {&change, 1});
    VkBufferImageCopy copy{};
    copy.imageSubresource = {renderer::aspectOf(desc.format), 0, 0, desc.layers};
    copy.imageExtent = {desc.width, desc.height, 1};
    vkCmdCopyBufferToImage(commands, from.handle(), image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    change = renderer::imageBarrier(image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, renderer::access::kTransferWrite,
                                    kRead, renderer::access::kSampled);
    renderer::recordBarriers(commands, {&change, 1});
}

std::uint32_t floatBits(float value) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, 4);
    return bits;
}

}  // namespace

reference::ListBuffers FrameResult::lists() const {
    reference::ListBuffers out;
    out.tilesX = tilesX();
    out.tilesY = tilesY();
    out.tileLightSlotIds = slotIds;
    out.approximateCounts = approximateCounts;
    out.earlyList = earlyList;
    out.earlyCounts = earlyCounts;
    out.finalList = finalList;
    out.finalCounts = finalCounts;
    out.visibility = visibility;
    out.listEntries = listCapacity;
    out.visibilitySlots = slotCapacity;
    out.lightLists = settings.lightLists == LightLists::Froxel ? gpu::kListsByFroxel : gpu::kListsByPixel;
    out.reservation = settings.listReservation == ListReservation::Approximate ? gpu::kReserveApproximate
                      : settings.listReservation == ListReservation::Accurate  ? gpu::kReserveAccurate
                                                                               : gpu::kReserveFixed;
    out.fixedEntries = settings.fixedListEntriesPerTile;
    out.visibilityBits = settings.visibilityBits;
    return out;
}

Rig::Rig(TestDevice& device, const ContextSetup& setup, const ViewDesc& desc) : device_(device), desc_(desc) {
    if (const Context* context = device.context(setup)) create(*context);
}

Rig::Rig(TestDevice& device, const Context& context, const ViewDesc& desc) : device_(device), desc_(desc) {
    create(context);
}

void Rig::create(const Context& context) {
    subgroupSize_ = context.subgroupSize();
    desc_.guardBytes = kGuardBytes;
    const Result made = View::create(context, desc_, view_);
    EXPECT_TRUE(made.ok()) << made.message();
    const Result timed = Timeline::create(context, {.framesInFlight = desc_.framesInFlight}, timeline_);
    EXPECT_TRUE(timed.ok()) << timed.message();
}

Rig::~Rig() {
    device_.vulkan().waitIdle();
}

void Rig::makeImages(const FrameInput& input) {
    const renderer::Device& device = device_.vulkan();
    const std::uint32_t width = desc_.maxWidthPx + kExtraX, height = desc_.maxHeightPx + kExtraY;
    if (depth_.handle() == VK_NULL_HANDLE) depth_ = makeImage(device, "depth", VK_FORMAT_D32_SFLOAT, width, height);
    if (!input.receivers.faceNormals.empty() && faceNormals_.handle() == VK_NULL_HANDLE)
        faceNormals_ = makeImage(device, "face normals", VK_FORMAT_R16G16_UINT, width, height);
    if (!input.receivers.receiverFlags.empty() && receiverFlags_.handle() == VK_NULL_HANDLE)
        receiverFlags_ = makeImage(device, "receiver flags", VK_FORMAT_R8G8_UINT, width, height);
    if (!input.depthPyramid.empty() && pyramid_.handle() == VK_NULL_HANDLE)
        pyramid_ = makeImage(device, "depth pyramid", VK_FORMAT_R32G32_SFLOAT,
                             gpu::divideRoundingUp(desc_.maxWidthPx, gpu::kShadowTileSizePx),
                             gpu::divideRoundingUp(desc_.maxHeightPx, gpu::kShadowTileSizePx));
    if (input.shadows == shadows_) return;
    shadows_ = input.shadows;
    atlases_.clear();
    atlasDescs_.clear();
    atlasesUploaded_ = false;
    for (const reference::AtlasCopy& atlas : shadows_->atlases) {
        atlases_.push_back(
            makeImage(device, "atlas", VK_FORMAT_D32_SFLOAT, atlas.widthPx, atlas.heightPx, atlas.layers, true));
        atlasDescs_.push_back(
            {atlases_.back().view(), atlas.widthPx, atlas.heightPx, atlas.layers, static_cast<float>(atlas.depthStep)});
    }
}

ViewInput Rig::viewInput(const FrameInput& input) {
    ViewInput view;
    view.camera = input.camera;
    view.widthPx = input.widthPx;
    view.heightPx = input.heightPx;
    view.viewportXPx = input.viewportXPx;
    view.viewportYPx = input.viewportYPx;
    view.lights = input.lights;
    return view;
}

Result Rig::prepare(const FrameInput& input) {
    return view_->prepare(viewInput(input), answer_);
}

Result Rig::resize(const ViewDesc& desc) {
    ViewDesc wanted = desc;
    wanted.guardBytes = kGuardBytes;
    Result resized = view_->resize(wanted);
    if (!resized) return resized;
    dropImages();
    desc_ = wanted;
    return resized;
}

FrameDesc Rig::frameDesc(const FrameInput& input) {
    makeImages(input);
    FrameDesc frame;
    frame.frameNumber = nextFrame_;
    frame.settings = input.settings;
    views_.clear();
    for (const LightOnScreen& light : answer_.visible)
        views_.push_back(light.light < input.lightViews.size() ? input.lightViews[light.light] : LightShadowViews{});
    frame.lightViews = views_;
    if (shadows_ != nullptr) frame.shadowViews = shadows_->views;
    if (shadows_ != nullptr && !input.shadowViewsChanged) {
        unchangedViews_ = shadows_->views;
        for (ShadowView& view : unchangedViews_) view.changed = false;
        frame.shadowViews = unchangedViews_;
    }
    frame.depth.view = depth_.view();
    if (!input.receivers.faceNormals.empty()) frame.faceNormals.view = faceNormals_.view();
    if (!input.receivers.receiverFlags.empty()) frame.receiverFlags.view = receiverFlags_.view();
    if (!input.depthPyramid.empty()) frame.depthPyramid.view = pyramid_.view();
    frame.atlases = atlasDescs_;
    frame.depthStep = static_cast<float>(input.receivers.depthStep);
    if (withTimeline_) frame.timeline = timeline_.get();
    return frame;
}

Result Rig::begin(const FrameInput& input, PrepareReport* report) {
    if (Result prepared = prepare(input); !prepared) return prepared;
    const Result begun = view_->beginFrame(frameDesc(input), report);
    settings_ = input.settings;
    boundsKept_ = !input.shadowViewsChanged;
    if (begun) ++nextFrame_;
    return begun;
}

void Rig::recordUploads(VkCommandBuffer commands, const FrameInput& input) {
    const renderer::Device& device = device_.vulkan();
    staging_.clear();
    const auto upload = [&](const Placement& place, const void* texels) {
        staging_.push_back(stage(device, place, texels));
        copyToImage(commands, staging_.back(), *place.image);
    };
    const std::uint32_t x = input.viewportXPx, y = input.viewportYPx, w = input.widthPx, h = input.heightPx;
    // Around the active extent lies geometry near the camera, lit from everywhere, that must never be read.
    upload({&depth_, x, y, w, h, floatBits(0.5f)}, input.receivers.depth.data());
    if (!input.receivers.faceNormals.empty())
        upload({&faceNormals_, x, y, w, h, 0x80007FFFu}, input.receivers.faceNormals.data());
    if (!input.receivers.receiverFlags.empty())
        upload({&receiverFlags_, x, y, w, h, 0x01FFu}, input.receivers.receiverFlags.data());
    if (!input.depthPyramid.empty())
        upload({&pyramid_, 0, 0, gpu::divideRoundingUp(w, gpu::kShadowTileSizePx),
                gpu::divideRoundingUp(h, gpu::kShadowTileSizePx), floatBits(0.5f)},
               input.depthPyramid.data());
    if (atlasesUploaded_) return;
    atlasesUploaded_ = true;
    for (std::size_t i = 0; i < atlases_.size(); ++i) {
        const reference::AtlasCopy& atlas = shadows_->atlases[i];
        upload({&atlases_[i], 0, 0, atlas.widthPx, atlas.heightPx}, atlas.depth.data());
    }
}

void Rig::recordFill(VkCommandBuffer commands) const {
    barrier(commands, kAll, renderer::access::kTransferWrite);
    for (const char* name : kDeviceBuffers) {
        if (boundsKept_ && std::strcmp(name, "shadow_bounds") == 0) continue;
        vkCmdFillBuffer(commands, view_->buffer(name), 0, VK_WHOLE_SIZE, kCanary);
    }
    barrier(commands, renderer::access::kTransferWrite, kAll);
}

void Rig::recordPhases(VkCommandBuffer commands, const RunOptions& options) {
    if (withTimeline_) timeline_->beginFrame(commands, lastFrame());
    view_->recordHierarchicalDepth(commands);
    view_->recordFindLightsApproximate(commands);
    view_->recordFindLightsAccurate(commands);
    if (settings_.shadowBounds) view_->recordShadowBounds(commands);
    if (options.shadows) view_->recordGenerateShadows(commands);
    if (options.endFrame) view_->recordEndFrame(commands);
}

void Rig::recordReadback(VkCommandBuffer commands) {
    ranges_.clear();
    VkDeviceSize total = 0;
    for (const BufferMemory& buffer : view_->memory().buffers()) {
        if (view_->buffer(buffer.name) == VK_NULL_HANDLE) continue;
        const bool guarded = !buffer.perFrame;
        const VkDeviceSize bytes = buffer.bytes + (guarded ? 2 * kGuardBytes : 0);
        ranges_.push_back({buffer.name, total, bytes, guarded});
        total += (bytes + 15) / 16 * 16;
    }
    if (readback_.bytes() < total)
        readback_ = renderer::Buffer(device_.vulkan(), "readback", total, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                     renderer::MemoryUse::Readback);
    barrier(commands, kAll,
            {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT});
    for (const Range& range : ranges_) {
        const VkBufferCopy copy{0, range.offset, range.bytes};
        vkCmdCopyBuffer(commands, view_->buffer(range.name.c_str()), readback_.handle(), 1, &copy);
    }
    barrier(commands, renderer::access::kTransferWrite, {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
}

std::vector<std::uint32_t> Rig::contents(const char* name) const {
    for (const Range& range : ranges_) {
        if (range.name != name) continue;
        const VkDeviceSize guard = range.guarded ? kGuardBytes : 0;
        const auto* begin =
            reinterpret_cast<const std::uint32_t*>(readback_.mapped<std::byte>() + range.offset + guard);
        return {begin, begin + (range.bytes - 2 * guard) / 4};
    }
    ADD_FAILURE() << "no buffer " << name;
    return {};
}

void Rig::decode(FrameResult& r) const {
    for (const Range& range : ranges_) {
        if (!range.guarded) continue;
        const auto* words = reinterpret_cast<const std::uint32_t*>(readback_.mapped<std::byte>() + range.offset);
        const std::size_t count = range.bytes / 4, guard = kGuardBytes / 4;
        for (std::size_t i = 0; i < guard; ++i)
            r.brokenGuards += (words[i] != kCanary) + (words[count - 1 - i] != kCanary);
    }
    std::memcpy(&r.constants, contents("frame_constants").data(), sizeof(r.constants));
    std::memcpy(&r.counters, contents("counters").data(), sizeof(r.counters));
    r.lights.resize(r.constants.lightCount);
    if (!r.lights.empty())
        std::memcpy(static_cast<void*>(r.lights.data()), contents("lights").data(),
                    r.lights.size() * sizeof(gpu::GpuLight));
    const std::size_t tiles = std::size_t(r.tilesX()) * r.tilesY();
    const auto perTile = [&](const char* name, std::size_t words) {
        std::vector<std::uint32_t> all = contents(name);
        for (std::size_t i = words; i < all.size(); ++i) r.beyondTiles += all[i] != kCanary;
        all.resize(words);
        return all;
    };
    const std::vector<std::uint32_t> ranges = perTile("tile_depth_ranges", 2 * tiles);
    r.depthRanges.resize(ranges.size());
    std::memcpy(r.depthRanges.data(), ranges.data(), ranges.size() * 4);
    r.depthSlices = perTile("tile_depth_slices", tiles);
    r.groupMasks = perTile("tile_group_light_masks", std::size_t(r.constants.tileGroupCounts.x) *
                                                         r.constants.tileGroupCounts.y * gpu::kLightMaskEntryWords);
    r.slotIds = perTile("tile_light_slot_ids", tiles);
    r.approximateCounts = perTile("approximate_counts", tiles);
    r.earlyCounts = perTile("early_counts", tiles);
    r.finalCounts = perTile("final_counts", tiles);
    r.earlyList = contents("early_light_list");
    r.finalList = contents("final_light_list");
    r.visibility = contents("visibility");
    r.evaluateTiles = contents("evaluate_tiles");
    r.listTiles = contents("list_tiles");
    r.queuedPairs = contents("queued_pairs");
    std::memcpy(&r.pairs, contents("pair_queues").data(), sizeof(r.pairs));
    const std::vector<std::uint32_t> bounds = contents("shadow_bounds");
    r.shadowBounds.resize(bounds.size() / 2);
    std::memcpy(r.shadowBounds.data(), bounds.data(), bounds.size() * 4);
    r.listCapacity = view_->memory().listEntries;
    r.subgroupSize = subgroupSize_;
    r.settings = settings_;
    // The pool counts slots of its own bits.
    r.slotCapacity = view_->memory().visibilitySlots * desc_.visibilityBits / settings_.visibilityBits;
    EXPECT_EQ(r.constants.slotCapacity, r.slotCapacity);
    EXPECT_EQ(r.constants.listCapacity, r.listCapacity);
    r.answer.assign(answer_.visible.begin(), answer_.visible.end());
    r.answerReport = answer_.report;
    r.tileLightMasks = contents("tile_light_masks");
}

FrameResult Rig::run(const FrameInput& input, const RunOptions& options) {
    FrameResult result;
    if (!ok()) return result;
    withTimeline_ = options.timeline;
    const Result begun = begin(input, &result.report);
    EXPECT_TRUE(begun.ok()) << begun.message();
    if (!begun) return result;
    device_.vulkan().submitAndWait([&](VkCommandBuffer commands) {
        recordUploads(commands, input);
        if (options.fill) recordFill(commands);
        recordPhases(commands, options);
        recordReadback(commands);
    });
    decode(result);
    result.hasStatistics = view_->statistics(lastFrame(), result.statistics);
    const std::span<const TimelineRow> rows = timeline_->rows(lastFrame());
    result.rows.assign(rows.begin(), rows.end());
    if (result.hasStatistics) {
        EXPECT_EQ(result.statistics.listCapacity, result.listCapacity);
        EXPECT_EQ(result.statistics.slotCapacity, result.slotCapacity);
    }
    if (!options.fill) result.beyondTiles = 0;
    return result;
}

void Rig::runInFlight(const std::vector<FrameInput>& inputs, const std::function<void(std::size_t)>& before) {
    withTimeline_ = true;
    std::vector<std::unique_ptr<renderer::Commands>> submissions;
    for (const FrameInput& input : inputs) {
        if (before) before(submissions.size());
        const Result begun = begin(input);
        ASSERT_TRUE(begun.ok()) << begun.message();
        submissions.push_back(std::make_unique<renderer::Commands>(device_.vulkan()));
        const VkCommandBuffer commands = submissions.back()->begin();
        if (submissions.size() == 1) recordUploads(commands, input);
        recordPhases(commands, {});
        submissions.back()->submit();
    }
    for (const auto& submission : submissions) submission->wait();
}

void Rig::dropImages() {
    device_.vulkan().waitIdle();
    depth_ = {};
    faceNormals_ = {};
    receiverFlags_ = {};
    pyramid_ = {};
    shadows_.reset();
    atlases_.clear();
    atlasDescs_.clear();
}

}  // namespace gnomon::test
