#include "scenes.h"

namespace gnomon::test {

using namespace reference;

void useFilter(FrameInput& input, Filter filter) {
    for (Light& light : input.lights) light.filter = filter;
    input.settings.filters = only(filter);
}

namespace {

void takeLights(FrameInput& input, const RoomSetup& setup, Random& random) {
    input.lights = makeLights(random, setup.camera, setup.lights);
    input.settings.filters = setup.lights.filters;
    input.settings.pcssPresetCount = setup.lights.pcssPresets;
}

}  // namespace

void renderRoom(FrameInput& input, const RoomSetup& setup) {
    Random random(setup.seed);
    input.widthPx = setup.widthPx;
    input.heightPx = setup.heightPx;
    input.camera = makeCamera(setup.camera, setup.widthPx, setup.heightPx);
    input.receivers = renderReceivers(makeRoom(random, setup.objects), input.camera, setup.widthPx, setup.heightPx);
}

FrameInput makeRoomFrame(const RoomSetup& setup) {
    FrameInput input;
    Random random(setup.seed);
    const Shapes shapes = makeRoom(random, setup.objects);
    input.widthPx = setup.widthPx;
    input.heightPx = setup.heightPx;
    input.camera = makeCamera(setup.camera, setup.widthPx, setup.heightPx);
    takeLights(input, setup, random);
    input.shadows = std::make_shared<TestShadows>(buildShadows(shapes, input.lights, setup.shadows));
    input.lightViews = input.shadows->lightViews;
    input.receivers = renderReceivers(shapes, input.camera, setup.widthPx, setup.heightPx);
    return input;
}

std::shared_ptr<const TestShadows> sharedPlainShadows() {
    static const auto shared = [] {
        Light light;
        light.position[1] = 2.5f;
        ShadowSetup setup;
        setup.viewSizePx = 8;
        setup.atlasCount = setup.layers = 1;
        return std::make_shared<const TestShadows>(
            buildShadows({plane({0, 0, 0}, {0, 1, 0}), ball({0, 1, 0}, 0.5)}, std::span(&light, 1), setup));
    }();
    return shared;
}

std::vector<LightShadowViews> sharedViews(const std::vector<Light>& lights) {
    std::vector<LightShadowViews> views(lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i)
        if (lights[i].casts && lights[i].type != LightType::Directional)
            views[i] = {0, lights[i].type == LightType::Point ? gpu::kPointLightFaces : 1};
    return views;
}

FrameInput makeQuickFrame(const RoomSetup& setup) {
    FrameInput input;
    Random random(setup.seed);
    const Shapes shapes = makeRoom(random, setup.objects);
    input.widthPx = setup.widthPx;
    input.heightPx = setup.heightPx;
    input.camera = makeCamera(setup.camera, setup.widthPx, setup.heightPx);
    takeLights(input, setup, random);
    input.lightViews = sharedViews(input.lights);
    input.shadows = sharedPlainShadows();
    input.receivers = renderReceivers(shapes, input.camera, setup.widthPx, setup.heightPx);
    return input;
}

ViewDesc viewDescFor(const FrameInput& input) {
    ViewDesc desc;
    desc.maxWidthPx = input.widthPx;
    desc.maxHeightPx = input.heightPx;
    desc.maxShadowViews = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(input.shadows->views.size()));
    const std::uint32_t tiles = gpu::divideRoundingUp(input.widthPx, gpu::kShadowTileSizePx) *
                                gpu::divideRoundingUp(input.heightPx, gpu::kShadowTileSizePx);
    desc.shadowBoundsTexels = 0;
    for (const reference::AtlasCopy& atlas : input.shadows->atlases) {
        const auto cells = [](std::uint32_t px) { return gpu::divideRoundingUp(px, gpu::kShadowBoundsCellPx); };
        desc.shadowBoundsTexels += std::uint64_t(cells(atlas.widthPx)) * cells(atlas.heightPx) * atlas.layers *
                                   gpu::kShadowBoundsCellPx * gpu::kShadowBoundsCellPx;
    }
    desc.listEntries = tiles * 96;
    desc.visibilitySlots = tiles * 48;
    desc.visibilityBits = input.settings.visibilityBits;
    return desc;
}

}  // namespace gnomon::test
