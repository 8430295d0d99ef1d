#pragma once
// The truth about one light's shadow, pixel by pixel: docs/verify.md.

#include <limits>
#include <span>
#include <vector>

#include "renderer/truth/receivers.h"
#include "renderer/truth/shadow_texels.h"
#include "renderer/truth/soft_shadow.h"

namespace gnomon::renderer {

/// What "2 pixels or 1.5 shadow texels around the point" means on a slanted face.
enum class EdgeSet : std::uint8_t {
    Footprint,  ///< they are measured in the picture and in the shadowmap: on the face they are as long as they fall
    Circle,     ///< a circle of that many metres on the face
};

struct LightTruthDesc {
    SceneLight light;                    ///< posed, with its range
    std::vector<ShadowView> views;       ///< of the result; for the size of their texels
    glm::dvec3 viewsOrigin{0.0};         ///< world
    bool soft = true;                    ///< trace the source's extent too
    std::uint32_t softRaysPerSide = 16;  ///< 256 rays
    std::uint32_t subsetOf = 16;         ///< soft truth is traced for one tile in 1, 4 or 16
    std::uint64_t seed = 1;
    EdgeSet edgeSet = EdgeSet::Footprint;
};

enum class HardTruth : std::uint8_t {
    NotCounted,  ///< background, or out of the light's range or cone
    Away,        ///< the face looks away from the light: dark
    Lit,
    Dark,
};

struct PixelTruth {
    HardTruth hard = HardTruth::NotCounted;
    bool edge = false;    ///< not unanimous around
    bool subset = false;  ///< in the seeded subset
    bool subsurface = false;
    float blockerMetres = std::numeric_limits<float>::infinity();  ///< Dark: to the nearest blocker
    float soft = std::numeric_limits<float>::quiet_NaN();          ///< visible share of the source, where traced
};

inline constexpr std::uint32_t kSubsetTilePx = 8;
/// A result that is off by more is looked at.
inline constexpr float kFaint = 0.1f;

struct TruthExtent {
    std::uint32_t widthPx = 0, heightPx = 0;
};

/// All cores work; the answer does not depend on their number. `result`, if not empty, is the visibility that is
/// judged: pixels where it is below 0 are not counted, and soft truth is traced, beyond the subset, wherever result and
/// hard truth disagree (by more than one half, at pixels that are no edge by kFaint). The subset is one tile of 8x8
/// pixels of every 4x4 (2x2, 1x1) tiles.
[[nodiscard]] std::vector<PixelTruth> traceLight(const TracedScene& scene, std::span<const TruthReceiver> receivers,
                                                 TruthExtent extent, const LightTruthDesc& desc,
                                                 std::span<const float> result);

}  // namespace gnomon::renderer
