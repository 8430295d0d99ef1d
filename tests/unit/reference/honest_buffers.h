#pragma once
// Buffers as phases 1 to 4 ought to fill them, made from the oracle itself, for tests of its checkers: the honest ones
// must pass, and each planted error must be found.

#include <vector>

#include "gpu_interface/packing.h"
#include "reference/find_lights_approximate.h"
#include "reference/generate_shadows_check.h"
#include "reference/pcss_quad.h"
#include "reference/test_scene.h"
#include "reference/test_shadows.h"

namespace gnomon::reference {

/// A small scene with everything that the checkers need.
struct TestFrame {
    CameraSetup setup;
    Camera camera;
    CameraModel model;
    Shapes shapes;
    std::vector<Light> hostLights;
    std::vector<LightModel> lights;  // host order serves as light index
    Receivers receivers;
    PixelGrid grid;
    ShadowInput shadows;
};

inline void useFilter(std::vector<LightModel>& lights, Filter filter) {
    for (LightModel& light : lights) light.filter = filter;
}

inline TestFrame makeTestFrame(std::uint64_t seed, std::uint32_t widthPx, std::uint32_t heightPx,
                               std::uint32_t lightCount, const CameraSetup* setup = nullptr, std::uint32_t suns = 0) {
    TestFrame frame;
    Random random(seed);
    frame.setup = setup ? *setup : randomCamera(random);
    frame.camera = makeCamera(frame.setup, widthPx, heightPx);
    frame.model = makeCameraModel(frame.camera, widthPx, heightPx);
    frame.shapes = makeRoom(random);
    LightSetup lightSetup;
    lightSetup.count = lightCount;
    lightSetup.spreadMetres = 8;
    lightSetup.suns = suns;
    frame.hostLights = makeLights(random, frame.setup, lightSetup);
    ShadowSetup shadowSetup;
    shadowSetup.viewSizePx = 32;
    shadowSetup.mixDepthKinds = suns > 0;
    TestShadows shadows = buildShadows(frame.shapes, frame.hostLights, shadowSetup);
    frame.shadows.views = makeShadowViewModels(shadows.views);
    frame.shadows.atlases = std::move(shadows.atlases);
    frame.lights = makeLightModels(frame.hostLights, shadows.lightViews, frame.model);
    frame.receivers = renderReceivers(frame.shapes, frame.camera, widthPx, heightPx);
    frame.grid = makePixelGrid(frame.model, frame.receivers);
    return frame;
}

/// Owns what ListBuffers points to.
struct HonestBuffers {
    std::vector<std::uint32_t> slotIds, approximateCounts, earlyList, earlyCounts, finalList, finalCounts, visibility;
    std::vector<std::uint32_t> groupMasks;
    std::uint32_t tilesX = 0, tilesY = 0;
    std::uint32_t slots = 0;
    std::uint32_t visibilityBits = 8;

    [[nodiscard]] ListBuffers view() const {
        ListBuffers buffers;
        buffers.tilesX = tilesX;
        buffers.tilesY = tilesY;
        buffers.tileLightSlotIds = slotIds;
        buffers.approximateCounts = approximateCounts;
        buffers.earlyList = earlyList;
        buffers.earlyCounts = earlyCounts;
        buffers.finalList = finalList;
        buffers.finalCounts = finalCounts;
        buffers.visibility = visibility;
        buffers.listEntries = static_cast<std::uint32_t>(finalList.size());
        buffers.visibilitySlots = slots;
        buffers.visibilityBits = visibilityBits;
        return buffers;
    }
    /// The first final entry that is a slot, or the first that is ALL_LIT; null if there is none.
    [[nodiscard]] std::uint32_t* findEntry(bool slot) {
        for (std::size_t tile = 0; tile < slotIds.size(); ++tile)
            for (std::uint32_t e = 0; e < (finalCounts[tile] & gpu::kFinalCountMask); ++e) {
                std::uint32_t& word = finalList[slotIds[tile] + e];
                const std::uint32_t slotOrFlag = gpu::finalSlotOrFlag(word);
                if (slot ? isSlot(slotOrFlag) : slotOrFlag == gpu::kSlotAllLit) return &word;
            }
        return nullptr;
    }
};

inline void setMaskBit(std::uint32_t* entry, std::uint32_t light) {
    entry[0] |= 1u << (light / gpu::kLightGroupSize);
    entry[1 + light / gpu::kLightGroupSize] |= 1u << (light % gpu::kLightGroupSize);
}

inline void fillTile(HonestBuffers& out, const TestFrame& frame, std::uint32_t tileX, std::uint32_t tileY,
                     const std::vector<std::uint32_t>& listed) {
    const std::uint32_t slotId = static_cast<std::uint32_t>(out.finalList.size());
    const std::uint32_t reserved = gpu::roundUpToEarlyWord(static_cast<std::uint32_t>(listed.size()) + 1);
    out.slotIds.push_back(slotId);
    out.approximateCounts.push_back(static_cast<std::uint32_t>(listed.size()) + 1);
    out.finalList.resize(slotId + reserved);
    out.earlyList.resize((slotId + reserved) / gpu::kEarlyIndicesPerWord);
    std::uint32_t casting = 0;
    for (std::uint32_t e = 0; e < listed.size(); ++e) {
        const LightModel& light = frame.lights[listed[e]];
        casting += light.casts;
        out.earlyList[gpu::earlyWordIndex(slotId, e)] |= listed[e] << (gpu::kLightIndexBits * (e % 3));
        const std::uint32_t bits = frame.shadows.visibilityBits, perWord = 32 / bits;
        std::vector<std::uint32_t> slot(gpu::visibilitySlotWords(bits));
        bool dark = true, lit = true;
        QuadFindings quads(light, frame.grid, frame.shadows);
        for (const auto [x, y] : frame.grid.tilePixels(tileX, tileY)) {
            if (inInfluence(light, frame.grid.at(x, y)) == Verdict::Never) continue;
            const std::uint32_t q = storedVisibility(light, frame.grid.at(x, y), frame.shadows, quads.at(x, y)).max;
            dark = dark && q == 0;
            lit = lit && q == gpu::visibilityLevels(bits);
            const std::uint32_t lane = gpu::mortonLane(x % 8, y % 8);
            slot[lane / perWord] |= q << (bits * (lane % perWord));
        }
        std::uint32_t slotOrFlag = dark ? gpu::kSlotAllUnlit : gpu::kSlotAllLit;
        if (!dark && !lit) {
            out.visibility.insert(out.visibility.end(), slot.begin(), slot.end());
            slotOrFlag = out.slots++;
        }
        out.finalList[slotId + e] = gpu::packFinalEntry(listed[e], slotOrFlag);
    }
    out.earlyCounts.push_back(static_cast<std::uint32_t>(listed.size()) | casting << gpu::kEarlyCastingShift);
    out.finalCounts.push_back(static_cast<std::uint32_t>(listed.size()));
}

inline HonestBuffers makeHonestBuffers(const TestFrame& frame, const std::vector<TileLights>& expected) {
    HonestBuffers out;
    out.visibilityBits = frame.shadows.visibilityBits;
    out.tilesX = frame.grid.tilesX;
    out.tilesY = frame.grid.tilesY;
    out.groupMasks.resize(std::size_t(frame.grid.groupsX) * frame.grid.groupsY * gpu::kLightMaskEntryWords);
    for (std::uint32_t y = 0; y < frame.grid.tilesY; ++y) {
        for (std::uint32_t x = 0; x < frame.grid.tilesX; ++x) {
            const TileLights& tile = expected[out.slotIds.size()];
            const std::size_t group = std::size_t(y / 8) * frame.grid.groupsX + x / 8;
            for (const std::uint32_t i : tile.must) setMaskBit(&out.groupMasks[group * gpu::kLightMaskEntryWords], i);
            fillTile(out, frame, x, y, tile.must);
        }
    }
    return out;
}

}  // namespace gnomon::reference
