// View: allocates the buffers of one camera, and per frame runs phase 1 and fills descriptors.
#include "view.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <new>
#include <utility>

#include "gpu_interface/packing.h"
#include "shadow_views.h"

namespace gnomon {
namespace {

using namespace gpu;

constexpr BufferDecl kBuffers[kListsBindingCount] = {
    {"frame_constants", kBindFrame, true},
    {"lights", kBindLights, true},
    {"z_bins", kBindZBins, true},
    {"tile_light_masks", kBindTileLightMasks, true},
    {"tile_group_light_masks", kBindTileGroupLightMasks, false},
    {"tile_depth_ranges", kBindTileDepthRanges, false},
    {"tile_light_slot_ids", kBindTileLightSlotIds, false},
    {"approximate_counts", kBindApproximateCounts, false},
    {"early_light_list", kBindEarlyList, false},
    {"early_counts", kBindEarlyCounts, false},
    {"final_light_list", kBindFinalList, false},
    {"final_counts", kBindFinalCounts, false},
    {"visibility", kBindVisibility, false},
    {"evaluate_tiles", kBindEvaluateTiles, false},
    {"counters", kBindCounters, false},
};

constexpr VkDeviceSize kReadbackBytes = sizeof(GpuCounters) + sizeof(GpuEvaluateHead);

Result checkDesc(const ViewDesc& desc) {
    if (desc.maxWidthPx == 0 || desc.maxHeightPx == 0 || desc.maxWidthPx > kMaxExtentPx ||
        desc.maxHeightPx > kMaxExtentPx) {
        return Result::failure(Status::BadArgument, "A view of %ux%u pixels was asked for; 1x1 to %ux%u are possible.",
                               desc.maxWidthPx, desc.maxHeightPx, kMaxExtentPx, kMaxExtentPx);
    }
    const std::uint64_t tiles = std::uint64_t(divideRoundingUp(desc.maxWidthPx, kShadowTileSizePx)) *
                                divideRoundingUp(desc.maxHeightPx, kShadowTileSizePx);
    if (tiles * roundUpToEarlyWord(kMaxLightsPerView) > 0xFFFFFFFFu) {
        return Result::failure(Status::BadArgument,
                               "A view of %ux%u pixels has more tiles than list space can be counted for.",
                               desc.maxWidthPx, desc.maxHeightPx);
    }
    if (desc.framesInFlight == 0 || desc.framesInFlight > kMaxFramesInFlight) {
        return Result::failure(Status::BadArgument, "ViewDesc::framesInFlight is %u; it must be 1 to %u.",
                               desc.framesInFlight, kMaxFramesInFlight);
    }
    if (desc.maxShadowViews == 0 || desc.maxShadowViews > kMaxLightsPerView * kPointLightFaces) {
        return Result::failure(Status::BadArgument, "ViewDesc::maxShadowViews is %u; it must be 1 to %u.",
                               desc.maxShadowViews, kMaxLightsPerView * kPointLightFaces);
    }
    if (desc.guardBytes % 256 != 0) {
        return Result::failure(Status::BadArgument, "ViewDesc::guardBytes is %u; it must be a multiple of 256.",
                               desc.guardBytes);
    }
    return {};
}

ViewSizes sizesOf(const Context::State& context, const ViewDesc& desc) {
    const DeviceContext& device = context.device;
    const VkDeviceSize slotBytes = visibilitySlotWords(context.desc.visibilityBits) * 4;
    ViewSizes s;
    s.tilesX = divideRoundingUp(desc.maxWidthPx, kShadowTileSizePx);
    s.tilesY = divideRoundingUp(desc.maxHeightPx, kShadowTileSizePx);
    const std::uint64_t tiles = std::uint64_t(s.tilesX) * s.tilesY;
    const std::uint64_t groups = std::uint64_t(divideRoundingUp(s.tilesX, kTileGroupSizeTiles)) *
                                 divideRoundingUp(s.tilesY, kTileGroupSizeTiles);
    const std::uint64_t largest = device.limits.maxStorageBufferRange;

    const std::uint64_t wantedEntries = desc.listEntries != 0 ? desc.listEntries : tiles * kDefaultListEntriesPerTile;
    const std::uint64_t wantedSlots =
        desc.visibilitySlots != 0 ? desc.visibilitySlots : tiles * kDefaultVisibilitySlotsPerTile;
    const std::uint64_t entries = std::min<std::uint64_t>({wantedEntries, largest / 4, 0x7FFFFFFFu});
    const std::uint64_t slots = std::min<std::uint64_t>({wantedSlots, largest / slotBytes, kMaxVisibilitySlots});
    s.poolsCapped = entries < wantedEntries || slots < wantedSlots;
    // Whole early-list words: what is left of a pool of one or two entries cannot hold a list.
    s.listEntries = static_cast<std::uint32_t>(entries / kEarlyIndicesPerWord * kEarlyIndicesPerWord);
    s.visibilitySlots = static_cast<std::uint32_t>(slots);

    const PrepareSizes prepared = prepareSizes(desc.maxWidthPx, desc.maxHeightPx);
    s.bytes[kBindFrame] = sizeof(GpuFrame);
    s.bytes[kBindLights] = prepared.lights;
    s.bytes[kBindZBins] = prepared.zBins;
    s.bytes[kBindTileLightMasks] = prepared.tileLightMasks;
    s.bytes[kBindTileGroupLightMasks] = groups * kLightMaskEntryWords * 4;
    s.bytes[kBindTileDepthRanges] = tiles * 8;
    s.bytes[kBindTileLightSlotIds] = tiles * 4;
    s.bytes[kBindApproximateCounts] = tiles * 4;
    s.bytes[kBindEarlyList] = std::max<VkDeviceSize>(s.listEntries / kEarlyIndicesPerWord, 1) * 4;
    s.bytes[kBindEarlyCounts] = tiles * 4;
    s.bytes[kBindFinalList] = std::max<VkDeviceSize>(s.listEntries, 1) * 4;
    s.bytes[kBindFinalCounts] = tiles * 4;
    s.bytes[kBindVisibility] = s.visibilitySlots * slotBytes;
    s.bytes[kBindEvaluateTiles] = sizeof(GpuEvaluateHead) + tiles * 4;
    s.bytes[kBindCounters] = sizeof(GpuCounters);
    // At least one, so that there is a buffer to bind.
    const std::uint64_t mostCells = largest / shadowBoundsBytes(1);
    const std::uint64_t cells = std::min<std::uint64_t>(shadowBoundsCellsFor(desc.shadowBoundsTexels), mostCells);
    s.boundsCells = std::max(static_cast<std::uint32_t>(cells), 1u);
    return s;
}

MemoryReport reportOf(const ViewDesc& desc, const ViewSizes& sizes) {
    MemoryReport r;
    const auto add = [&](const char* name, std::uint64_t bytes, bool perFrame, bool mapped) {
        r.buffers[r.bufferCount++] = {name, bytes, perFrame, mapped};
        r.totalBytes += bytes * (perFrame ? desc.framesInFlight : 1u);
    };
    for (const BufferDecl& decl : kBuffers) add(decl.name, sizes.bytes[decl.binding], decl.perFrame, decl.perFrame);
    add("shadow_views", VkDeviceSize(desc.maxShadowViews) * sizeof(GpuShadowView), true, true);
    const std::uint32_t cells = sizes.boundsCells;
    add("shadow_bounds", shadowBoundsBytes(cells), false, false);
    add("shadow_bounds_cells", VkDeviceSize(cells) * sizeof(GpuShadowBoundsCell), true, true);
    add("statistics_readback", kReadbackBytes, true, true);
    r.listEntries = sizes.listEntries;
    r.visibilitySlots = sizes.visibilitySlots;
    r.poolsCapped = sizes.poolsCapped;
    return r;
}

constexpr VkBufferUsageFlags kDeviceUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

Result createBuffers(View::State& state) {
    const DeviceContext& device = state.context->device;
    for (const BufferDecl& decl : kBuffers) {
        const VkDeviceSize bytes = state.sizes.bytes[decl.binding];
        if (!decl.perFrame) {
            const VkBufferUsageFlags indirect =
                decl.binding == kBindEvaluateTiles ? VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT : 0;
            if (Result made = createBuffer(device, decl.name, bytes + 2 * state.desc.guardBytes,
                                           kDeviceUsage | indirect, MemoryUse::Device, state.device[decl.binding]);
                !made) {
                return made;
            }
            continue;
        }
        const VkBufferUsageFlags kind =
            decl.binding == kBindFrame ? VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT : VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
        for (std::uint32_t i = 0; i < state.desc.framesInFlight; ++i) {
            if (Result made = createBuffer(device, decl.name, bytes, kind | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                           MemoryUse::Streamed, state.slots[i].streamed[decl.binding]);
                !made) {
                return made;
            }
        }
    }
    const std::uint32_t cells = state.sizes.boundsCells;
    if (Result made = createBuffer(device, "shadow_bounds", shadowBoundsBytes(cells) + 2 * state.desc.guardBytes,
                                   kDeviceUsage, MemoryUse::Device, state.shadowBounds);
        !made) {
        return made;
    }
    state.boundsCells.create(state.desc.shadowBoundsTexels == 0 ? 0 : cells);
    for (std::uint32_t i = 0; i < state.desc.framesInFlight; ++i) {
        FrameSlot& slot = state.slots[i];
        if (Result made = createBuffer(device, "shadow_bounds_cells", cells * sizeof(GpuShadowBoundsCell),
                                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryUse::Streamed, slot.boundsCells);
            !made) {
            return made;
        }
        const VkDeviceSize bytes = VkDeviceSize(state.desc.maxShadowViews) * sizeof(GpuShadowView);
        if (Result made = createBuffer(device, "shadow_views", bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                       MemoryUse::Streamed, slot.shadowViews);
            !made) {
            return made;
        }
        if (Result made = createBuffer(device, "statistics_readback", kReadbackBytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                       MemoryUse::Readback, slot.readback);
            !made) {
            return made;
        }
    }
    return {};
}

Result createPools(View::State& state) {
    const DeviceContext& device = state.context->device;
    const std::uint32_t frames = state.desc.framesInFlight;
    const VkDescriptorPoolSize poolSizes[] = {
        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, frames},
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, frames * (kListsBindingCount + 2)},
        {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, frames * (kReceiversBindingCount + kMaxShadowAtlases)},
        {VK_DESCRIPTOR_TYPE_SAMPLER, frames},
    };
    VkDescriptorPoolCreateInfo info = {VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    info.maxSets = 3 * frames;
    info.poolSizeCount = static_cast<std::uint32_t>(std::size(poolSizes));
    info.pPoolSizes = poolSizes;
    VkResult result = device.vk.CreateDescriptorPool(device.device, &info, nullptr, &state.descriptors);
    if (result != VK_SUCCESS) return vulkanFailure(result, "vkCreateDescriptorPool");
    const VkDescriptorSetLayout layouts[] = {state.context->listsLayout, state.context->receiversLayout,
                                             state.context->shadowmapsLayout};
    for (std::uint32_t i = 0; i < frames; ++i) {
        VkDescriptorSet sets[3] = {};
        VkDescriptorSetAllocateInfo allocate = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
        allocate.descriptorPool = state.descriptors;
        allocate.descriptorSetCount = 3;
        allocate.pSetLayouts = layouts;
        result = device.vk.AllocateDescriptorSets(device.device, &allocate, sets);
        if (result != VK_SUCCESS) return vulkanFailure(result, "vkAllocateDescriptorSets");
        state.slots[i].lists = sets[0];
        state.slots[i].receivers = sets[1];
        state.slots[i].shadowmaps = sets[2];
    }
    if (!state.desc.timestamps || state.context->timestampPeriodNs == 0.0f) return {};
    VkQueryPoolCreateInfo queries = {VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    queries.queryType = VK_QUERY_TYPE_TIMESTAMP;
    queries.queryCount = frames * 2 * kPassCount;
    result = device.vk.CreateQueryPool(device.device, &queries, nullptr, &state.queries);
    return result == VK_SUCCESS ? Result() : vulkanFailure(result, "vkCreateQueryPool");
}

void writeListsSets(View::State& state) {
    const DeviceContext& device = state.context->device;
    for (std::uint32_t i = 0; i < state.desc.framesInFlight; ++i) {
        FrameSlot& slot = state.slots[i];
        VkDescriptorBufferInfo infos[kListsBindingCount + 3] = {};
        VkWriteDescriptorSet writes[kListsBindingCount + 3] = {};
        for (const BufferDecl& decl : kBuffers) {
            const std::uint32_t b = decl.binding;
            infos[b].buffer = decl.perFrame ? slot.streamed[b].buffer : state.device[b].buffer;
            infos[b].offset = decl.perFrame ? 0 : state.desc.guardBytes;
            infos[b].range = state.sizes.bytes[b];
            writes[b] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                         nullptr,
                         slot.lists,
                         b,
                         0,
                         1,
                         b == kBindFrame ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                         nullptr,
                         &infos[b],
                         nullptr};
        }
        const std::pair<std::uint32_t, VkBuffer> others[] = {{kBindShadowViews, slot.shadowViews.buffer},
                                                             {kBindShadowBounds, state.shadowBounds.buffer},
                                                             {kBindShadowBoundsCells, slot.boundsCells.buffer}};
        std::uint32_t count = kListsBindingCount;
        for (const auto& [binding, buffer] : others) {
            infos[count] = {buffer, 0, VK_WHOLE_SIZE};
            if (binding == kBindShadowBounds)
                infos[count] = {buffer, state.desc.guardBytes, shadowBoundsBytes(state.sizes.boundsCells)};
            writes[count] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, slot.shadowmaps, binding, 0, 1,
                             VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,      nullptr, &infos[count],   nullptr};
            ++count;
        }
        device.vk.UpdateDescriptorSets(device.device, count, writes, 0, nullptr);
    }
}

// Points the image bindings at the frame's images. Every frame anew: a host that destroys an image view and makes
// another may get the same handle back, so equal handles prove nothing.
void writeImages(const DeviceContext& device, VkDescriptorSet set, std::uint32_t firstBinding,
                 std::span<const VkImageView> views) {
    for (std::uint32_t i = 0; i < views.size(); ++i) {
        const VkDescriptorImageInfo info = {VK_NULL_HANDLE, views[i], VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        const VkWriteDescriptorSet write = {
            VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, set,     firstBinding + i, 0, 1,
            VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,       &info,   nullptr, nullptr};
        device.vk.UpdateDescriptorSets(device.device, 1, &write, 0, nullptr);
    }
}

void bindImages(View::State& state, FrameSlot& slot, const FrameDesc& frame) {
    const DeviceContext& device = state.context->device;
    const auto orElse = [](VkImageView view, VkImageView other) { return view != VK_NULL_HANDLE ? view : other; };
    const VkImageView receivers[kReceiversBindingCount] = {
        frame.depth.view, orElse(frame.faceNormals.view, state.noFaceNormals.view),
        orElse(frame.receiverFlags.view, state.noFaceNormals.view), orElse(frame.depthPyramid.view, frame.depth.view)};
    writeImages(device, slot.receivers, kBindDepth, receivers);
    VkImageView atlases[kMaxShadowAtlases] = {};
    for (std::uint32_t i = 0; i < kMaxShadowAtlases; ++i) {
        atlases[i] = i < frame.atlases.size() ? frame.atlases[i].view : state.noAtlas.view;
    }
    writeImages(device, slot.shadowmaps, kBindShadowAtlas0, atlases);
}

Result checkFrame(const View::State& state, const FrameDesc& frame) {
    if (frame.depth.view == VK_NULL_HANDLE) return Result::failure(Status::BadArgument, "FrameDesc::depth is missing.");
    if (state.context->desc.hostDepthPyramid && frame.depthPyramid.view == VK_NULL_HANDLE) {
        return Result::failure(Status::BadArgument,
                               "ContextDesc::hostDepthPyramid is set, but FrameDesc::depthPyramid is missing.");
    }
    if (frame.atlases.size() > state.context->desc.maxShadowAtlases) {
        return Result::failure(Status::BadArgument,
                               "%u shadow atlases were given; ContextDesc::maxShadowAtlases is %u.",
                               static_cast<unsigned>(frame.atlases.size()), state.context->desc.maxShadowAtlases);
    }
    for (const ShadowAtlas& atlas : frame.atlases) {
        if (atlas.view == VK_NULL_HANDLE || atlas.widthPx == 0 || atlas.heightPx == 0) {
            return Result::failure(Status::BadArgument, "A shadow atlas needs an image view and its extent.");
        }
        if (!(atlas.depthStep >= 0.0f) || atlas.depthStep > 1.0f) {
            return Result::failure(Status::BadArgument, "ShadowAtlas::depthStep must be from 0 to 1.");
        }
    }
    if (frame.shadowViews.size() > state.desc.maxShadowViews) {
        return Result::failure(Status::BadArgument, "%u shadow views were given; ViewDesc::maxShadowViews is %u.",
                               static_cast<unsigned>(frame.shadowViews.size()), state.desc.maxShadowViews);
    }
    if (!(frame.subsurfaceBiasMetres >= 0.0f) || frame.subsurfaceBiasMetres > 1e6f) {
        return Result::failure(Status::BadArgument, "FrameDesc::subsurfaceBiasMetres must be a length of at least 0.");
    }
    if (!(frame.depthStep >= 0.0f) || frame.depthStep > 1.0f) {
        return Result::failure(Status::BadArgument, "FrameDesc::depthStep must be from 0 to 1.");
    }
    return {};
}

// Directional lights are parallel, all others meet in a point; so must their shadow views.
Result checkProjections(const FrameDesc& frame) {
    for (std::size_t i = 0; i < frame.view.lights.size(); ++i) {
        const Light& light = frame.view.lights[i];
        if (light.firstShadowView == kNoShadowViews) continue;
        const bool parallel = light.type == LightType::Directional;
        const std::uint32_t count = parallel                         ? light.cascadeCount
                                    : light.type == LightType::Point ? kPointLightFaces
                                                                     : 1;
        for (const ShadowView& view : frame.shadowViews.subspan(light.firstShadowView, count)) {
            if (view.orthographic == parallel) continue;
            return Result::failure(Status::BadArgument, "Light %zu: its shadow views must be %s.", i,
                                   parallel ? "orthographic" : "perspective");
        }
    }
    return {};
}

void completeFrameConstants(const View::State& state, const FrameDesc& frame, GpuFrame& constants) {
    constants.listCapacity = state.sizes.listEntries;
    constants.slotCapacity = state.sizes.visibilitySlots;
    constants.fixedListEntries = state.context->desc.fixedListEntriesPerTile;
    if (frame.faceNormals.view != VK_NULL_HANDLE) constants.flags |= kFrameFaceNormalsBit;
    if (frame.receiverFlags.view != VK_NULL_HANDLE) constants.flags |= kFrameReceiverFlagsBit;
    if (frame.dropLightsFacedAway && state.context->desc.facedAwayIsDark) constants.flags |= kFrameFacingCullBit;
    constants.subsurfaceBiasMetres = frame.subsurfaceBiasMetres;
    constants.hostDepthStep = frame.depthStep;
    constants.frameNumber = static_cast<std::uint32_t>(frame.frameNumber);
    constants.pcssSearchTaps = state.context->desc.pcss.searchTaps;
    constants.pcssFilterTaps = state.context->desc.pcss.filterTaps;
    // Golden ratio: the turns of successive frames fill the circle evenly, however many there are.
    if (frame.patternPerFrame) constants.patternTurn = constants.frameNumber * 2654435769u;
}

}  // namespace

View::State::~State() {
    if (context == nullptr) return;
    const DeviceContext& d = context->device;
    for (DeviceBuffer& buffer : device) destroyBuffer(d, buffer);
    for (FrameSlot& slot : slots) {
        for (DeviceBuffer& buffer : slot.streamed) destroyBuffer(d, buffer);
        destroyBuffer(d, slot.shadowViews);
        destroyBuffer(d, slot.boundsCells);
        destroyBuffer(d, slot.readback);
    }
    destroyBuffer(d, shadowBounds);
    destroyImage(d, noFaceNormals);
    destroyImage(d, noAtlas);
    d.vk.DestroyDescriptorPool(d.device, descriptors, nullptr);
    d.vk.DestroyQueryPool(d.device, queries, nullptr);
}

View::View(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
View::~View() = default;

Result View::memory(const Context& context, const ViewDesc& desc, MemoryReport& out) noexcept {
    if (Result checked = checkDesc(desc); !checked) return checked;
    out = reportOf(desc, sizesOf(context.state(), desc));
    return {};
}

Result View::create(const Context& context, const ViewDesc& desc, std::unique_ptr<View>& out) noexcept {
    try {
        if (Result checked = checkDesc(desc); !checked) return checked;
        auto state = std::make_unique<State>();
        state->context = &context.state();
        state->desc = desc;
        state->desc.prepare.maxWidthPx = desc.maxWidthPx;
        state->desc.prepare.maxHeightPx = desc.maxHeightPx;
        state->sizes = sizesOf(context.state(), desc);
        state->memory = reportOf(desc, state->sizes);
        if (Result made = Prepare::create(state->desc.prepare, state->prepare); !made) return made;
        if (Result made = createBuffers(*state); !made) return made;
        const DeviceContext& device = context.state().device;
        if (Result made = createPlaceholder(device, VK_FORMAT_R16G16_UINT, VK_IMAGE_ASPECT_COLOR_BIT,
                                            VK_IMAGE_VIEW_TYPE_2D, state->noFaceNormals);
            !made) {
            return made;
        }
        if (Result made = createPlaceholder(device, VK_FORMAT_D16_UNORM, VK_IMAGE_ASPECT_DEPTH_BIT,
                                            VK_IMAGE_VIEW_TYPE_2D_ARRAY, state->noAtlas);
            !made) {
            return made;
        }
        if (Result made = createPools(*state); !made) return made;
        writeListsSets(*state);
        out.reset(new View(std::move(state)));
        return {};
    } catch (const std::bad_alloc&) {
        return Result::failure(Status::OutOfMemory, "Out of memory while creating a view.");
    }
}

const MemoryReport& View::memory() const noexcept {
    return state_->memory;
}

Result View::beginFrame(const FrameDesc& frame, PrepareReport* report) noexcept {
    State& state = *state_;
    if (Result checked = checkFrame(state, frame); !checked) return checked;
    const std::uint32_t index = static_cast<std::uint32_t>(frame.frameNumber % state.desc.framesInFlight);
    FrameSlot& slot = state.slots[index];
    slot.frameNumber = ~0ull;
    slot.ended = false;
    slot.passBits = 0;
    const auto start = std::chrono::steady_clock::now();
    GpuFrame constants = {};
    const PrepareOutput output = {&constants, slot.streamed[kBindLights].mapped, slot.streamed[kBindZBins].mapped,
                                  slot.streamed[kBindTileLightMasks].mapped};
    ViewInput input = frame.view;
    input.shadowViewCount = static_cast<std::uint32_t>(frame.shadowViews.size());
    if (Result prepared = state.prepare->run(input, output, slot.lights); !prepared) return prepared;
    if (Result checked = checkProjections(frame); !checked) return checked;
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
    slot.prepareMilliseconds = elapsed.count();
    if (Result converted =
            convertShadowViews(frame.shadowViews, frame.atlases, static_cast<GpuShadowView*>(slot.shadowViews.mapped));
        !converted) {
        return converted;
    }
    slot.boundsCellCount = 0;
    if (frame.shadowBounds) {
        slot.boundsCellCount = state.boundsCells.list(frame.shadowViews, frame.atlases,
                                                      static_cast<GpuShadowView*>(slot.shadowViews.mapped),
                                                      static_cast<GpuShadowBoundsCell*>(slot.boundsCells.mapped));
    } else {
        state.boundsCells.skip(frame.shadowViews, frame.atlases);
    }
    completeFrameConstants(state, frame, constants);
    std::memcpy(slot.streamed[kBindFrame].mapped, &constants, sizeof(constants));
    bindImages(state, slot, frame);
    slot.tiles = constants.tileCounts.x * constants.tileCounts.y;
    state.frame = constants;
    state.current = index;
    slot.frameNumber = frame.frameNumber;
    if (report != nullptr) *report = slot.lights;
    return {};
}

VkDescriptorSet View::listsSet() const noexcept {
    return state_->slots[state_->current].lists;
}
VkDescriptorSet View::receiversSet() const noexcept {
    return state_->slots[state_->current].receivers;
}
VkDescriptorSet View::shadowmapsSet() const noexcept {
    return state_->slots[state_->current].shadowmaps;
}
VkExtent2D View::tileCounts() const noexcept {
    return {state_->frame.tileCounts.x, state_->frame.tileCounts.y};
}
VkBuffer View::evaluateTilesBuffer() const noexcept {
    return state_->device[kBindEvaluateTiles].buffer;
}
VkDeviceSize View::evaluateCommandOffset() const noexcept {
    return state_->desc.guardBytes;
}

VkBuffer View::buffer(const char* name) const noexcept {
    for (const BufferDecl& decl : kBuffers) {
        if (std::strcmp(decl.name, name) != 0) continue;
        return decl.perFrame ? state_->slots[state_->current].streamed[decl.binding].buffer
                             : state_->device[decl.binding].buffer;
    }
    return std::strcmp(name, "shadow_bounds") == 0 ? state_->shadowBounds.buffer : VK_NULL_HANDLE;
}

}  // namespace gnomon
