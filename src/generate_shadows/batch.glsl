// The lights of a tile that phase 4 evaluates together: four, or eight with slots of 4 bits; one field of a word each.
#ifndef GNOMON_GENERATE_SHADOWS_BATCH_GLSL
#define GNOMON_GENERATE_SHADOWS_BATCH_GLSL

const uint kBits = kVisibilityBits;
const uint kBatch = 32u / kBits;  // lights, and pixels in a word of a slot
const uint kLevels = kVisibilityLevels;
const uint kSlotWords = kVisibilitySlotWords;

shared uint packedVisibility[kWorkGroupSize];  // per lane, a field per light

uint earlyLight(uint slotId, uint entry) {
    return unpackEarlyIndex(earlyList[earlyWordIndex(slotId, entry)], entry);
}

// `voting`: fields of the lights that reach this lane's pixel. Others do not vote on all lit or all dark.
void evaluateBatch(Receiver receiver, uint slotId, uint first, uint count, out uint stored, out uint voting) {
    stored = 0u;
    voting = 0u;
    for (uint i = 0u; i < count; ++i) {
        GpuLight light = lights[earlyLight(slotId, first + i)];
        vec3 toLight;
        if (receiver.valid && lightReaches(light, receiver.positionWs, receiver.mask, toLight)) {
            stored |= quantiseVisibility(evaluateVisibility(light, receiver, toLight)) << (kBits * i);
            voting |= kLevels << (kBits * i);
        }
    }
}

#endif
