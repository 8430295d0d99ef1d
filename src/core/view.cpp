// View: allocates the buffers of one camera, and per frame runs phase 1 and fills descriptors.
#include "core/view.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <new>
#include <utility>

#include "core/settings.h"
#include "gpu_interface/packing.h"
#include "visibility/shadow_views.h"

namespace gnomon {
namespace {

using namespace gpu;

Result createSets(View::State& state) {
    const DeviceContext& device = state.context->device;
    const std::uint32_t frames = state.desc.framesInFlight;
    const VkDescriptorPoolSize poolSizes[] = {
        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, frames},
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, frames * kViewBufferCount},
        {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, frames * (kReceiversBindingCount + kMaxShadowAtlases)},
        {VK_DESCRIPTOR_TYPE_SAMPLER, frames},
    };
    VkDescriptorPoolCreateInfo info = {VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    info.maxSets = kSetCount * frames;
    info.poolSizeCount = static_cast<std::uint32_t>(std::size(poolSizes));
    info.pPoolSizes = poolSizes;
    VkResult result = device.vk.CreateDescriptorPool(device.device, &info, nullptr, &state.descriptors);
    if (result != VK_SUCCESS) return vulkanFailure(result, "vkCreateDescriptorPool");
    for (std::uint32_t i = 0; i < frames; ++i) {
        VkDescriptorSetAllocateInfo allocate = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
        allocate.descriptorPool = state.descriptors;
        allocate.descriptorSetCount = kSetCount;
        allocate.pSetLayouts = state.context->setLayouts;
        result = device.vk.AllocateDescriptorSets(device.device, &allocate, state.frames[i].sets);
        if (result != VK_SUCCESS) return vulkanFailure(result, "vkAllocateDescriptorSets");
    }
    return {};
}

// Points the buffer bindings of a frame in flight at the view's buffers, if they are others than before.
void writeBuffers(View::State& state, std::uint32_t index) {
    FrameInFlight& frame = state.frames[index];
    if (frame.setsGeneration == state.buffers.generation) return;
    frame.setsGeneration = state.buffers.generation;
    VkDescriptorBufferInfo infos[kViewBufferCount] = {};
    VkWriteDescriptorSet writes[kViewBufferCount] = {};
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < kViewBufferCount; ++i) {
        const ViewBuffer& decl = viewBuffers()[i];
        if (decl.kind == BufferKind::Readback) continue;
        infos[count].buffer = state.buffers.of(static_cast<ViewBufferId>(i), index).buffer;
        infos[count].offset = decl.kind == BufferKind::Device ? state.desc.guardBytes : 0;
        infos[count].range = state.sizes.bytes[i];
        writes[count] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                         nullptr,
                         frame.sets[decl.set],
                         decl.binding,
                         0,
                         1,
                         i == kBufferFrame ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                         nullptr,
                         &infos[count],
                         nullptr};
        ++count;
    }
    const DeviceContext& device = state.context->device;
    device.vk.UpdateDescriptorSets(device.device, count, writes, 0, nullptr);
}

// Points the image bindings at the frame's images, in every frame anew. A host that destroys an image view and makes
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

void bindImages(View::State& state, FrameInFlight& inFlight, const FrameDesc& frame) {
    const DeviceContext& device = state.context->device;
    const auto orElse = [](VkImageView view, VkImageView other) { return view != VK_NULL_HANDLE ? view : other; };
    const VkImageView receivers[kReceiversBindingCount] = {
        frame.depth.view, orElse(frame.faceNormals.view, state.noFaceNormals.view),
        orElse(frame.receiverFlags.view, state.noFaceNormals.view), orElse(frame.depthPyramid.view, frame.depth.view)};
    writeImages(device, inFlight.sets[kSetReceivers], kBindDepth, receivers);
    VkImageView atlases[kMaxShadowAtlases] = {};
    for (std::uint32_t i = 0; i < kMaxShadowAtlases; ++i) {
        atlases[i] = i < frame.atlases.size() ? frame.atlases[i].view : state.noAtlas.view;
    }
    writeImages(device, inFlight.sets[kSetShadowmaps], kBindShadowAtlas0, atlases);
}

Result checkFrame(const View::State& state, const FrameDesc& frame) {
    if (!state.isPrepared) {
        return Result::failure(Status::BadArgument, "View::beginFrame() was called without View::prepare() before it.");
    }
    if (state.anyFrame && frame.frameNumber < state.lastFrame) {
        return Result::failure(
            Status::BadArgument, "FrameDesc::frameNumber is %llu; it must not be below that of the last frame, %llu.",
            static_cast<unsigned long long>(frame.frameNumber), static_cast<unsigned long long>(state.lastFrame));
    }
    if (frame.depth.view == VK_NULL_HANDLE) return Result::failure(Status::BadArgument, "FrameDesc::depth is missing.");
    if (frame.settings.hostDepthPyramid && frame.depthPyramid.view == VK_NULL_HANDLE) {
        return Result::failure(Status::BadArgument,
                               "ShadowSettings::hostDepthPyramid is set, but FrameDesc::depthPyramid is missing.");
    }
    if (frame.atlases.size() > state.context->maxShadowAtlases) {
        return Result::failure(Status::BadArgument,
                               "%u shadow atlases were given; ContextDesc::maxShadowAtlases is %u.",
                               static_cast<unsigned>(frame.atlases.size()), state.context->maxShadowAtlases);
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
    if (!(frame.depthStep >= 0.0f) || frame.depthStep > 1.0f) {
        return Result::failure(Status::BadArgument, "FrameDesc::depthStep must be from 0 to 1.");
    }
    return {};
}

// What the lights that cast need of the settings and of their views. After Prepare::write(), so views exist.
Result checkCasters(const View::State& state, const FrameDesc& frame) {
    for (std::size_t i = 0; i < frame.lightViews.size(); ++i) {
        const LightOnScreen& light = state.prepared.visible[i];
        const LightShadowViews& views = frame.lightViews[i];
        if (!light.casts || views.first == kNoShadowViews) continue;
        if (frame.settings.filters != 0 && (frame.settings.filters & only(light.filter)) == 0) {
            return Result::failure(Status::BadArgument, "Light %u: its filter is not among ShadowSettings::filters.",
                                   light.light);
        }
        if (isSoft(light.filter) && light.pcssPreset >= frame.settings.pcssPresetCount) {
            return Result::failure(Status::BadArgument,
                                   "Light %u: its pcssPreset is %u; ShadowSettings::pcssPresetCount is %u.",
                                   light.light, light.pcssPreset, frame.settings.pcssPresetCount);
        }
        const bool parallel = light.type == LightType::Directional;
        for (const ShadowView& view : frame.shadowViews.subspan(views.first, views.count)) {
            if (view.orthographic == parallel) continue;
            return Result::failure(Status::BadArgument, "Light %u: its shadow views must be %s.", light.light,
                                   parallel ? "orthographic" : "perspective");
        }
    }
    return {};
}

// The pair queues that the frame's lights may fill. Bad input is refused later.
QueueSet queuesOfFrame(const View::State& state, const FrameDesc& frame) {
    QueueSet queues = 0;
    const std::size_t lights = std::min(frame.lightViews.size(), state.prepared.visible.size());
    for (std::size_t i = 0; i < lights; ++i) {
        const LightOnScreen& light = state.prepared.visible[i];
        const LightShadowViews& views = frame.lightViews[i];
        if (!light.casts || views.first == kNoShadowViews) continue;
        std::uint32_t kind = views.count == kPointLightFaces ? kShadowViewsSixFaces : kShadowViewsOne;
        if (light.type == LightType::Directional) kind = kShadowViewsCascades;
        queues |= 1u << pairQueueOf(static_cast<std::uint32_t>(light.filter), kind);
    }
    return queues & queuesOf(frame.settings.filters);
}

void completeFrameConstants(const FrameInFlight& inFlight, const FrameDesc& frame, GpuFrame& constants) {
    const ShadowSettings& settings = frame.settings;
    constants.listCapacity = inFlight.listCapacity;
    constants.slotCapacity = inFlight.slotCapacity;
    constants.fixedListEntries = settings.fixedListEntriesPerTile;
    if (frame.faceNormals.view != VK_NULL_HANDLE) constants.flags |= kFrameFaceNormalsBit;
    if (frame.receiverFlags.view != VK_NULL_HANDLE) constants.flags |= kFrameReceiverFlagsBit;
    if (settings.dropLightsFacedAway && settings.facedAwayIsDark) constants.flags |= kFrameFacingCullBit;
    constants.subsurfaceBiasMetres = settings.subsurfaceBiasMetres;
    constants.hostDepthStep = frame.depthStep;
    constants.frameNumber = static_cast<std::uint32_t>(frame.frameNumber);
    writePcssTaps(settings, constants);
    // Golden ratio: the turns of successive frames fill the circle evenly, however many there are.
    if (settings.patternPerFrame) constants.patternTurn = constants.frameNumber * 2654435769u;
}

// A pool after the frame that `used` so much of it, within what the host allows.
std::uint32_t grown(std::uint64_t used, std::uint64_t capacity, std::uint32_t recommended, std::uint32_t most) {
    if (used <= capacity || most <= capacity) return static_cast<std::uint32_t>(capacity);
    return std::max(std::min(recommended, most), static_cast<std::uint32_t>(capacity));
}

// Pools follow the need of the frame that has just finished, where the host allows it. Without memory for that they
// stay as they are: overflow loses nothing, it only costs time.
void growPools(View::State& state, std::uint64_t frameNumber) noexcept {
    if (state.desc.mostListEntries == 0 && state.desc.mostVisibilitySlots == 0) return;
    if (state.growthFailed || frameNumber < state.desc.framesInFlight) return;
    FrameStatistics finished;
    if (!state.readCounters(frameNumber - state.desc.framesInFlight, finished)) return;
    const FrameInFlight& inFlight = state.frames[frameNumber % state.desc.framesInFlight];
    ViewDesc desc = state.desc;
    const std::uint32_t entries =
        grown(finished.listEntries, state.sizes.listEntries, finished.recommendedListEntries, desc.mostListEntries);
    // Slots are counted in the frame's own bits.
    const std::uint32_t bits = inFlight.settings.visibilityBits;
    const auto inPoolBits = [&](std::uint64_t slots) {
        return std::min<std::uint64_t>((slots * bits + desc.visibilityBits - 1) / desc.visibilityBits,
                                       kMaxVisibilitySlots);
    };
    const std::uint32_t slots =
        grown(inPoolBits(finished.visibilitySlots), state.sizes.visibilitySlots,
              static_cast<std::uint32_t>(inPoolBits(finished.recommendedVisibilitySlots)), desc.mostVisibilitySlots);
    desc.listEntries = entries;
    desc.visibilitySlots = slots;
    // Whole words, and what the device allows: there may be nothing to gain.
    const ViewSizes wanted = viewSizesOf(state.context->device, desc);
    const bool larger =
        wanted.listEntries > state.sizes.listEntries || wanted.visibilitySlots > state.sizes.visibilitySlots;
    if (!larger) return;
    try {
        state.growthFailed = !state.resize(desc).ok();
    } catch (const std::bad_alloc&) {
        state.growthFailed = true;
    }
}

Result checkKept(const ViewDesc& from, const ViewDesc& to) {
    if (from.framesInFlight == to.framesInFlight && from.guardBytes == to.guardBytes &&
        from.statistics == to.statistics)
        return {};
    return Result::failure(Status::BadArgument,
                           "View::resize() cannot change framesInFlight, guardBytes or statistics; make another View.");
}

// A pool that has grown by itself keeps its size, unless the host now asks for another one than before.
ViewDesc withGrownPools(const View::State& state, const ViewDesc& desc) {
    ViewDesc out = desc;
    const ViewSizes wanted = viewSizesOf(state.context->device, desc);
    if (desc.listEntries == state.asked.listEntries && state.desc.listEntries != state.asked.listEntries)
        out.listEntries = std::max(wanted.listEntries, state.sizes.listEntries);
    if (desc.visibilitySlots == state.asked.visibilitySlots && desc.visibilityBits == state.asked.visibilityBits &&
        state.desc.visibilitySlots != state.asked.visibilitySlots)
        out.visibilitySlots = std::max(wanted.visibilitySlots, state.sizes.visibilitySlots);
    return out;
}

bool samePrepare(const PrepareDesc& a, const PrepareDesc& b) {
    return a.maxWidthPx == b.maxWidthPx && a.maxHeightPx == b.maxHeightPx && a.rangeCutoffLux == b.rangeCutoffLux &&
           a.keepFactor == b.keepFactor;
}

}  // namespace

View::State::~State() {
    if (context == nullptr) return;
    const DeviceContext& d = context->device;
    buffers.destroy(d);
    destroyImage(d, noFaceNormals);
    destroyImage(d, noAtlas);
    d.vk.DestroyDescriptorPool(d.device, descriptors, nullptr);
}

// Everything that may fail comes before anything that cannot be taken back, but for phase 1's own size: where the
// buffers fail after it, it is set back, and View::prepare() holds frames to the extent of `desc` in any case.
Result View::State::resize(const ViewDesc& to) {
    const ViewSizes wanted = viewSizesOf(context->device, to);
    MemoryReport report = memoryReportOf(to, wanted);
    const bool otherBounds =
        wanted.boundsCells != sizes.boundsCells || to.shadowBoundsTexels != desc.shadowBoundsTexels;
    ShadowBoundsCells cells;
    if (otherBounds) cells.create(to.shadowBoundsTexels == 0 ? 0 : wanted.boundsCells);
    PrepareDesc prepareDesc = to.prepare;
    prepareDesc.maxWidthPx = to.maxWidthPx;
    prepareDesc.maxHeightPx = to.maxHeightPx;
    const bool otherPrepare = prepare != nullptr && !samePrepare(prepareDesc, desc.prepare);
    if (prepare == nullptr) {
        if (Result made = Prepare::create(prepareDesc, prepare); !made) return made;
    } else if (otherPrepare) {
        isPrepared = false;
        if (Result made = prepare->resize(prepareDesc); !made) return made;
    }
    Result made;
    try {
        made = buffers.make(context->device, to, sizes, wanted, lastFrame);
    } catch (const std::bad_alloc&) {
        made = Result::failure(Status::OutOfMemory, "Out of memory while making a view's buffers.");
    }
    if (!made) {
        if (otherPrepare) (void)prepare->resize(desc.prepare);
        return made;
    }
    if (!anyFrame) buffers.release(context->device, ~0ull, 0);
    if (otherBounds) boundsCells = std::move(cells);
    desc = to;
    desc.prepare = prepareDesc;
    growthFailed = false;
    sizes = wanted;
    memory = std::move(report);
    return {};
}

View::View(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
View::~View() = default;

Result View::memory(const Context& context, const ViewDesc& desc, MemoryReport& out) noexcept {
    try {
        if (Result checked = checkViewDesc(desc); !checked) return checked;
        out = memoryReportOf(desc, viewSizesOf(context.state().device, desc));
        return {};
    } catch (const std::bad_alloc&) {
        return Result::failure(Status::OutOfMemory, "Out of memory while describing a view.");
    }
}

Result View::create(const Context& context, const ViewDesc& desc, std::unique_ptr<View>& out) noexcept {
    try {
        if (Result checked = checkViewDesc(desc); !checked) return checked;
        auto state = std::make_unique<State>();
        state->context = &context.state();
        state->desc.framesInFlight = desc.framesInFlight;
        if (Result made = state->resize(desc); !made) return made;
        state->asked = desc;
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
        if (Result made = createSets(*state); !made) return made;
        for (std::uint32_t i = 0; i < desc.framesInFlight; ++i) writeBuffers(*state, i);
        out.reset(new View(std::move(state)));
        return {};
    } catch (const std::bad_alloc&) {
        return Result::failure(Status::OutOfMemory, "Out of memory while creating a view.");
    }
}

const MemoryReport& View::memory() const noexcept {
    return state_->memory;
}

Result View::resize(const ViewDesc& desc) noexcept {
    try {
        if (Result checked = checkViewDesc(desc); !checked) return checked;
        if (Result checked = checkKept(state_->desc, desc); !checked) return checked;
        if (Result resized = state_->resize(withGrownPools(*state_, desc)); !resized) return resized;
        state_->asked = desc;
        return {};
    } catch (const std::bad_alloc&) {
        return Result::failure(Status::OutOfMemory, "Out of memory while resizing a view.");
    }
}

Result View::prepare(const ViewInput& input, PreparedLights& out) noexcept {
    State& state = *state_;
    state.isPrepared = false;
    if (input.widthPx > state.desc.maxWidthPx || input.heightPx > state.desc.maxHeightPx) {
        return Result::failure(Status::BadArgument,
                               "A frame of %ux%u pixels is above the view's maximum of %ux%u; call View::resize().",
                               input.widthPx, input.heightPx, state.desc.maxWidthPx, state.desc.maxHeightPx);
    }
    const auto start = std::chrono::steady_clock::now();
    if (Result result = state.prepare->run(input, state.prepared); !result) return result;
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
    state.prepareMilliseconds = elapsed.count();
    state.isPrepared = true;
    out = state.prepared;
    return {};
}

Result View::beginFrame(const FrameDesc& frame, PrepareReport* report) noexcept {
    State& state = *state_;
    if (Result checked = checkFrame(state, frame); !checked) return checked;
    const auto index = static_cast<std::uint32_t>(frame.frameNumber % state.desc.framesInFlight);
    FrameInFlight& inFlight = state.frames[index];
    const QueueSet queues = queuesOfFrame(state, frame);
    try {
        if (Result found = state.context->pipelinesFor(frame.settings, queues, state.pipelines); !found) return found;
    } catch (const std::bad_alloc&) {
        return Result::failure(Status::OutOfMemory, "Out of memory while beginning a frame.");
    }
    growPools(state, frame.frameNumber);
    state.buffers.release(state.context->device, frame.frameNumber, state.desc.framesInFlight);
    inFlight.frameNumber = ~0ull;
    inFlight.ended = false;
    inFlight.generated = false;
    const auto start = std::chrono::steady_clock::now();
    const auto mapped = [&](ViewBufferId id) { return state.buffers.of(id, index).mapped; };
    GpuFrame constants = {};
    const PrepareOutput output = {&constants, mapped(kBufferLights), mapped(kBufferZBins),
                                  mapped(kBufferTileLightMasks)};
    if (Result written = state.prepare->write(frame.lightViews, static_cast<std::uint32_t>(frame.shadowViews.size()),
                                              output, &inFlight.lights);
        !written) {
        return written;
    }
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
    inFlight.prepareMilliseconds = state.prepareMilliseconds + elapsed.count();
    if (Result checked = checkCasters(state, frame); !checked) return checked;
    auto* const views = static_cast<GpuShadowView*>(mapped(kBufferShadowViews));
    if (Result converted = convertShadowViews(frame.shadowViews, frame.atlases, views); !converted) return converted;
    inFlight.boundsCellCount = 0;
    if (frame.settings.shadowBounds) {
        inFlight.boundsCellCount =
            state.boundsCells.list(frame.shadowViews, frame.atlases, views,
                                   static_cast<GpuShadowBoundsCell*>(mapped(kBufferShadowBoundsCells)));
    } else {
        state.boundsCells.skip(frame.shadowViews, frame.atlases);
    }
    inFlight.settings = frame.settings;
    inFlight.listCapacity = state.sizes.listEntries;
    inFlight.slotCapacity = static_cast<std::uint32_t>(std::min<VkDeviceSize>(
        state.sizes.bytes[kBufferVisibility] / (visibilitySlotWords(frame.settings.visibilityBits) * 4),
        kMaxVisibilitySlots));
    completeFrameConstants(inFlight, frame, constants);
    std::memcpy(mapped(kBufferFrame), &constants, sizeof(constants));
    writeBuffers(state, index);
    bindImages(state, inFlight, frame);
    inFlight.tiles = constants.tileCounts.x * constants.tileCounts.y;
    inFlight.frameNumber = frame.frameNumber;
    state.frame = constants;
    state.current = index;
    state.timeline = frame.timeline;
    state.lastFrame = frame.frameNumber;
    state.anyFrame = true;
    state.isPrepared = false;
    if (report != nullptr) *report = inFlight.lights;
    return {};
}

VkDescriptorSet View::listsSet() const noexcept {
    return state_->frames[state_->current].sets[kSetLists];
}
VkDescriptorSet View::receiversSet() const noexcept {
    return state_->frames[state_->current].sets[kSetReceivers];
}
VkDescriptorSet View::shadowmapsSet() const noexcept {
    return state_->frames[state_->current].sets[kSetShadowmaps];
}
VkExtent2D View::tileCounts() const noexcept {
    return {state_->frame.tileCounts.x, state_->frame.tileCounts.y};
}
VkBuffer View::evaluateTilesBuffer() const noexcept {
    return state_->buffers.device[kBufferEvaluateTiles].buffer;
}
VkDeviceSize View::evaluateCommandOffset() const noexcept {
    return state_->desc.guardBytes;
}

VkBuffer View::buffer(const char* name) const noexcept {
    for (std::uint32_t i = 0; i < kViewBufferCount; ++i) {
        if (std::strcmp(viewBuffers()[i].name, name) != 0) continue;
        if (viewBuffers()[i].kind == BufferKind::Readback) break;  // the host reads that one by statistics()
        return state_->buffers.of(static_cast<ViewBufferId>(i), state_->current).buffer;
    }
    return VK_NULL_HANDLE;
}

}  // namespace gnomon
