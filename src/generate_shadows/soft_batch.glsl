// Soft shadows of a batch of lights, with no lane idle: work is queued in shared memory and shared out again.
//
// Problem: few pixels of a tile lie in a light's penumbra, and only they need the filter's many taps; a lighting shader
// that evaluates its own pixel makes the whole subgroup wait for them, light after light.
// Source: the paper, section 2.4 (shadows apart from lighting); stream compaction as in Billeter et al. 2009.
// Plain way: evaluateBatch(), one lane per pixel.
// Here: pairs of pixel and light that need a shadowmap form one queue, pairs in penumbra a second one, and lanes take
// items by number. An item is a function of its pixel and light alone, so the bits are those of the plain way, whatever
// the order of the queue.
#ifndef GNOMON_GENERATE_SHADOWS_SOFT_BATCH_GLSL
#define GNOMON_GENERATE_SHADOWS_SOFT_BATCH_GLSL

#include "generate_shadows/batch.glsl"
#include "generate_shadows/visibility.glsl"

// An item: lane in bits 0 to 5, light of the batch in 6 to 8, face or cascade in 9 to 11.
const uint kItemLightShift = 6u;
const uint kItemViewShift = 9u;
// Radius of a pair that lies in two cascades: evaluated whole.
const float kTwoCascades = -1.0;

shared vec4 queuedPositions[kWorkGroupSize];  // w: 1 where subsurface
shared vec4 queuedNormals[kWorkGroupSize];
shared uint searches[kWorkGroupSize * kBatch];
shared uint filters[kWorkGroupSize * kBatch];
shared float filterRadii[kWorkGroupSize * kBatch];
shared uint searchCount;
shared uint filterCount;

Receiver queuedReceiver(uint item, uvec2 tile) {
    uint lane = item % kWorkGroupSize;
    Receiver r;
    r.positionWs = queuedPositions[lane].xyz;
    r.faceNormalWs = queuedNormals[lane].xyz;
    r.viewDepth = 0.0;
    r.pixel = tile * kShadowTileSizePx + laneCoordinates(lane);
    r.mask = 0xFFu;
    r.subsurface = queuedPositions[lane].w != 0.0;
    r.valid = true;
    return r;
}

uint queuedLight(uint item) { return item >> kItemLightShift & (kBatch - 1u); }

void storeVisibility(uint item, GpuLight light, Receiver receiver, float visibility) {
    uint q = quantiseVisibility(fadedVisibility(light, receiver, visibility));
    atomicOr(packedVisibility[item % kWorkGroupSize], q << (kBits * queuedLight(item)));
}

void queueFilter(uint item, uint view, float radius) {
    uint at = atomicAdd(filterCount, 1u);
    filters[at] = item | view << kItemViewShift;
    filterRadii[at] = radius;
}

// Pairs that need a shadowmap; what is known without one goes into packedVisibility.
uint queueSearches(uint lane, Receiver receiver, uint slotId, uint first, uint count) {
    uint known = 0u;
    uint voting = 0u;
    for (uint i = 0u; i < count; ++i) {
        GpuLight light = lights[earlyLight(slotId, first + i)];
        vec3 toLight;
        if (!receiver.valid || !lightReaches(light, receiver.positionWs, receiver.mask, toLight)) continue;
        voting |= kLevels << (kBits * i);
        float visibility;
        if (needsShadowmap(light, receiver, toLight, visibility)) {
            searches[atomicAdd(searchCount, 1u)] = lane | i << kItemLightShift;
        } else {
            float faded = lightCasts(light) ? fadedVisibility(light, receiver, visibility) : 1.0;
            known |= quantiseVisibility(faded) << (kBits * i);
        }
    }
    packedVisibility[lane] = known;
    return voting;
}

void search(uint item, uvec2 tile, uint slotId, uint first) {
    Receiver receiver = queuedReceiver(item, tile);
    GpuLight light = lights[earlyLight(slotId, first + queuedLight(item))];
    uint view = 0u;
    if (lightType(light) == kLightPoint) view = cubeFace(receiver.positionWs - light.positionWs);
    if (lightType(light) == kLightDirectional) {
        float border;
        view = cascadeOf(light, receiver.positionWs, border);
        if (border > 0.0 && view < cascadeCount(light)) {
            queueFilter(item, view, kTwoCascades);
            return;
        }
        if (view == cascadeCount(light)) {
            storeVisibility(item, light, receiver, 1.0);
            return;
        }
    }
    ShadowPoint s = shadowPointIn(light.shadowView + view, light, receiver);
    float visibility = 1.0;
    if (s.inFront) {
        PcssKernel k = pcssKernelOf(light, s, receiver.pixel);
        float radius = searchBlockers(light, s, k, visibility);
        if (radius >= 0.0) {
            queueFilter(item, view, radius);
            return;
        }
    }
    storeVisibility(item, light, receiver, visibility);
}

void filterQueued(uint item, float radius, uvec2 tile, uint slotId, uint first) {
    Receiver receiver = queuedReceiver(item, tile);
    GpuLight light = lights[earlyLight(slotId, first + queuedLight(item))];
    float visibility;
    if (radius == kTwoCascades) {
        visibility = cascadedVisibility(light, receiver);
    } else {
        ShadowPoint s = shadowPointIn(light.shadowView + (item >> kItemViewShift), light, receiver);
        visibility = filterPenumbra(light, s, pcssKernelOf(light, s, receiver.pixel), radius);
    }
    storeVisibility(item, light, receiver, visibility);
}

// As evaluateBatch(); packedVisibility is filled. Called by all lanes.
void evaluateSoftBatch(uint lane, uvec2 tile, Receiver receiver, uint slotId, uint first, uint count, out uint stored,
                       out uint voting) {
    barrier();  // the batch before may still be read
    if (first == 0u) {
        queuedPositions[lane] = vec4(receiver.positionWs, receiver.subsurface ? 1.0 : 0.0);
        queuedNormals[lane] = vec4(receiver.faceNormalWs, 0.0);
    }
    if (lane == 0u) {
        searchCount = 0u;
        filterCount = 0u;
    }
    barrier();
    voting = queueSearches(lane, receiver, slotId, first, count);
    barrier();
    for (uint i = lane; i < searchCount; i += kWorkGroupSize) search(searches[i], tile, slotId, first);
    barrier();
    for (uint i = lane; i < filterCount; i += kWorkGroupSize) {
        filterQueued(filters[i], filterRadii[i], tile, slotId, first);
    }
    barrier();
    stored = packedVisibility[lane];
}

#endif
