// Phase 1, Prepare. Source: the paper, section 2.1. In order: camera, cull and sort, zBins, tile light masks.
//
// Every output is put together in the CPU's own memory and copied out front to back, so destinations may be
// write-combined. What the rest of the library adds to the frame's constants stays zero here.

#include "gnomon/prepare.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <utility>
#include <vector>

#include "gpu_interface/numbers.h"
#include "gpu_interface/packing.h"
#include "gpu_interface/structs.h"
#include "prepare/camera.h"
#include "prepare/cull_and_sort.h"
#include "prepare/on_screen.h"
#include "prepare/screen_bounds.h"
#include "prepare/tile_light_masks.h"
#include "prepare/zbins.h"

namespace gnomon {

using gpu::divideRoundingUp;

struct GNOMON_HIDDEN Prepare::State {
    PrepareDesc desc;
    prepare::CullAndSort cullAndSort;
    prepare::ScreenGrid grid;
    prepare::TileLightMasks masks;
    std::vector<prepare::DepthRange> depths;  // of the lights with a range
    // What the last successful run() found.
    bool hasRun = false;
    prepare::ZBinLayout zBinLayout;
    gpu::GpuFrame frame = {};
    PrepareReport report;
    std::vector<LightOnScreen> onScreen;
};

namespace {

using prepare::VisibleLight;

Result checkInput(const ViewInput& input, const PrepareDesc& desc) {
    if (input.widthPx == 0 || input.heightPx == 0) {
        return Result::failure(Status::BadArgument, "ViewInput's extent is %ux%u; give at least 1x1.", input.widthPx,
                               input.heightPx);
    }
    if (input.widthPx > desc.maxWidthPx || input.heightPx > desc.maxHeightPx) {
        return Result::failure(Status::BadArgument,
                               "ViewInput's extent %ux%u is above the maximum %ux%u; create with a larger PrepareDesc.",
                               input.widthPx, input.heightPx, desc.maxWidthPx, desc.maxHeightPx);
    }
    if (!input.lights.empty() && input.lights.data() == nullptr) {
        return Result::failure(Status::BadArgument, "ViewInput::lights points nowhere but is not empty.");
    }
    if (input.lights.size() > 0xFFFFFFFEu) {
        return Result::failure(Status::BadArgument, "ViewInput::lights has more than 2^32 - 2 lights.");
    }
    return {};
}

// Largest |coordinate| that shaders meet near any light: the scale of their rounding errors.
double largestCoordinateOf(const prepare::ViewCamera& camera, std::span<const VisibleLight> lights) {
    double largest = prepare::largestCoordinate(camera.eyeWs);
    for (const VisibleLight& light : lights) {
        if (light.directional) continue;
        const gpu::vec3 p = light.gpu.positionWs;
        largest = std::max(largest, prepare::largestCoordinate({p.x, p.y, p.z}) + light.gpu.rangeMetres);
    }
    return largest;
}

gpu::GpuFrame frameConstants(const ViewInput& input, const prepare::ViewCamera& camera, const prepare::ScreenGrid& grid,
                             const prepare::ZBinLayout& zBins, const prepare::CullAndSort& lists) {
    gpu::GpuFrame frame = {};
    prepare::fillCameraConstants(camera, frame);
    frame.zBinNearDepth = zBins.nearDepth;
    frame.zBinsPerMetre = zBins.binsPerMetre;
    frame.farthestReach = zBins.farthestReach;
    frame.largestCoordinate = static_cast<float>(largestCoordinateOf(camera, lists.visible()));
    frame.extentPx = {input.widthPx, input.heightPx};
    frame.viewportPx = {input.viewportXPx, input.viewportYPx};
    frame.tileCounts = {divideRoundingUp(input.widthPx, gpu::kShadowTileSizePx),
                        divideRoundingUp(input.heightPx, gpu::kShadowTileSizePx)};
    frame.tileGroupCounts = {divideRoundingUp(input.widthPx, gpu::kTileGroupSizePx),
                             divideRoundingUp(input.heightPx, gpu::kTileGroupSizePx)};
    frame.lightCount = static_cast<std::uint32_t>(lists.visible().size());
    frame.directionalLightCount = lists.directionalCount();
    frame.maskTileColumns = grid.columns;
    frame.maskTileRows = grid.rows;
    frame.flags = camera.orthographic ? gpu::kFrameOrthographicBit : 0u;
    return frame;
}

// With the shadow of each light that casts and has views.
void writeLights(std::span<const VisibleLight> lights, std::span<const LightShadowViews> views, void* destination,
                 std::uint32_t& casting) {
    auto* out = static_cast<unsigned char*>(destination);
    casting = 0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const bool casts = !views.empty() && lights[i].casts && views[i].first != kNoShadowViews;
        gpu::GpuLight light = lights[i].gpu;
        if (casts) prepare::giveShadow(lights[i], views[i], light);
        casting += casts ? 1u : 0u;
        std::memcpy(out, &light, sizeof(light));
        out += sizeof(light);
    }
}

Result checkViews(std::span<const VisibleLight> lights, std::span<const LightShadowViews> views,
                  std::uint32_t shadowViewCount) {
    if (!views.empty() && views.size() != lights.size()) {
        return Result::failure(Status::BadArgument, "%zu lights were given shadow views, but %zu are visible.",
                               views.size(), lights.size());
    }
    for (std::size_t i = 0; i < views.size(); ++i) {
        const LightShadowViews& v = views[i];
        if (!lights[i].casts || v.first == kNoShadowViews) continue;
        if (const char* wrong = prepare::whatIsWrong(lights[i], v, shadowViewCount)) {
            return Result::failure(Status::BadArgument, "Light %u: %s.", lights[i].hostIndex, wrong);
        }
    }
    return {};
}

PrepareReport reportOf(const ViewInput& input, const prepare::CullAndSort& lists) {
    PrepareReport report;
    report.given = static_cast<std::uint32_t>(input.lights.size());
    report.visible = static_cast<std::uint32_t>(lists.visible().size());
    report.dropped = lists.droppedCount();
    report.directional = lists.directionalCount();
    for (const VisibleLight& light : lists.visible()) report.casting += light.casts ? 1u : 0u;
    return report;
}

Result checkDesc(const PrepareDesc& desc) {
    const auto extentOk = [](std::uint32_t px) { return px >= 1 && px <= gpu::kMaxExtentPx; };
    if (!extentOk(desc.maxWidthPx) || !extentOk(desc.maxHeightPx)) {
        return Result::failure(Status::BadArgument, "PrepareDesc's maximum extent %ux%u must be 1x1 to %ux%u.",
                               desc.maxWidthPx, desc.maxHeightPx, gpu::kMaxExtentPx, gpu::kMaxExtentPx);
    }
    if (!std::isfinite(desc.rangeCutoffLux) || !(desc.rangeCutoffLux > 0.0f)) {
        return Result::failure(Status::BadArgument, "PrepareDesc::rangeCutoffLux must be finite and above 0.");
    }
    if (!std::isfinite(desc.keepFactor) || !(desc.keepFactor >= 1.0f)) {
        return Result::failure(Status::BadArgument, "PrepareDesc::keepFactor must be finite and at least 1.");
    }
    return {};
}

}  // namespace

PrepareSizes prepareSizes(std::uint32_t widthPx, std::uint32_t heightPx) noexcept {
    const std::size_t entries = static_cast<std::size_t>(divideRoundingUp(widthPx, gpu::kMaskTileSizePx)) *
                                divideRoundingUp(heightPx, gpu::kMaskTileSizePx);
    return {sizeof(gpu::GpuFrame), gpu::kMaxLightsPerView * sizeof(gpu::GpuLight),
            gpu::kZBinWords * sizeof(std::uint32_t), entries * gpu::kLightMaskEntryWords * sizeof(std::uint32_t)};
}

Prepare::Prepare(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
Prepare::~Prepare() = default;

Result Prepare::create(const PrepareDesc& desc, std::unique_ptr<Prepare>& out) noexcept {
    if (Result result = checkDesc(desc); !result) return result;
    try {
        auto state = std::make_unique<State>();
        state->desc = desc;
        const std::uint32_t columns = divideRoundingUp(desc.maxWidthPx, gpu::kMaskTileSizePx);
        const std::uint32_t rows = divideRoundingUp(desc.maxHeightPx, gpu::kMaskTileSizePx);
        state->masks.create(columns, rows);
        state->depths.reserve(gpu::kMaxLightsPerView);
        state->onScreen.reserve(gpu::kMaxLightsPerView);
        out.reset(new Prepare(std::move(state)));
    } catch (const std::bad_alloc&) {
        return Result::failure(Status::OutOfMemory, "Prepare::create found no memory; lower the maximum extent.");
    }
    return {};
}

Result Prepare::resize(const PrepareDesc& desc) noexcept {
    if (Result result = checkDesc(desc); !result) return result;
    State& s = *state_;
    s.hasRun = false;
    try {
        const std::uint32_t columns = divideRoundingUp(desc.maxWidthPx, gpu::kMaskTileSizePx);
        const std::uint32_t rows = divideRoundingUp(desc.maxHeightPx, gpu::kMaskTileSizePx);
        prepare::TileLightMasks masks;
        masks.create(columns, rows);
        s.masks = std::move(masks);
    } catch (const std::bad_alloc&) {
        return Result::failure(Status::OutOfMemory, "Prepare::resize found no memory; lower the maximum extent.");
    }
    s.desc = desc;
    return {};
}

Result Prepare::run(const ViewInput& input, PreparedLights& out) noexcept {
    State& s = *state_;
    s.hasRun = false;
    if (Result result = checkInput(input, s.desc); !result) return result;
    prepare::ViewCamera camera;
    if (Result result = prepare::deriveCamera(input.camera, input.widthPx, input.heightPx, camera); !result)
        return result;
    if (Result result = prepare::validateLights(input.lights); !result) return result;
    try {
        s.cullAndSort.run(input.lights, camera, prepare::frustumOf(camera, input.widthPx, input.heightPx), s.desc);
    } catch (const std::bad_alloc&) {
        return Result::failure(Status::OutOfMemory, "Prepare::run found no memory for %zu lights; give fewer.",
                               input.lights.size());
    }
    const std::span<const VisibleLight> lights = s.cullAndSort.visible();
    const std::uint32_t directional = s.cullAndSort.directionalCount();
    s.depths.clear();
    for (const VisibleLight& light : lights.subspan(directional)) s.depths.push_back(light.depth);
    s.zBinLayout = prepare::layOutZBins(s.depths, camera.nearMetres, camera.farMetres);
    s.grid.set(camera, input.widthPx, input.heightPx);
    s.masks.cover(s.grid, lights);
    s.frame = frameConstants(input, camera, s.grid, s.zBinLayout, s.cullAndSort);
    s.report = reportOf(input, s.cullAndSort);
    s.onScreen.clear();  // room for all was made
    for (std::uint32_t i = 0; i < lights.size(); ++i)
        s.onScreen.push_back(prepare::measure(lights[i], camera, s.masks.share(s.grid, i)));
    out = {s.onScreen, s.report};
    s.hasRun = true;
    return {};
}

Result Prepare::write(std::span<const LightShadowViews> lightViews, std::uint32_t shadowViewCount,
                      const PrepareOutput& output, PrepareReport* report) noexcept {
    State& s = *state_;
    if (!s.hasRun) return Result::failure(Status::BadArgument, "Prepare::write() needs a successful run() before it.");
    if (!output.frameConstants || !output.lights || !output.zBins || !output.tileLightMasks) {
        return Result::failure(Status::BadArgument, "PrepareOutput has a null pointer; give all four destinations.");
    }
    const std::span<const VisibleLight> lights = s.cullAndSort.visible();
    if (Result result = checkViews(lights, lightViews, shadowViewCount); !result) return result;
    const auto zBins = prepare::buildZBins(s.depths, s.cullAndSort.directionalCount(), s.zBinLayout);
    std::memcpy(output.frameConstants, &s.frame, sizeof(s.frame));
    std::uint32_t casting = 0;
    writeLights(lights, lightViews, output.lights, casting);
    std::memcpy(output.zBins, zBins.data(), sizeof(zBins));
    s.masks.write(s.grid, output.tileLightMasks);
    if (report != nullptr) {
        *report = s.report;
        report->casting = casting;
    }
    return {};
}

}  // namespace gnomon
