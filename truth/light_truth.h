#pragma once
// The truth about one light's shadow, pixel by pixel: docs/verify.md.

#include <limits>
#include <span>
#include <vector>

#include "truth/receivers.h"
#include "truth/shadow_texels.h"
#include "truth/soft_shadow.h"

namespace gnomon::renderer {

/// What "2 pixels or 1.5 shadow texels (LightTruthDesc::edgeTexels) around the point" means on a slanted face.
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
    double edgeTexels = 1.5;
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

/// Of the pixels that a light reaches, whatever a result says; the others are not counted. 16 bytes a pixel.
struct LightTruth {
    TruthExtent extent;
    std::vector<std::uint32_t> indices;  ///< of the pixels in the picture, rows from the top, ascending
    std::vector<PixelTruth> pixels;      ///< as many
    [[nodiscard]] std::size_t bytes() const { return indices.size() * (sizeof(PixelTruth) + sizeof(std::uint32_t)); }
};

/// Off so far that soft truth has to say what is right: by more than one half, at pixels that are no edge by kFaint.
[[nodiscard]] bool disagrees(const PixelTruth& truth, float result);

/// Hard truth and edges, and soft truth within the subset: one tile of 8x8 pixels of every 4x4 (2x2, 1x1) tiles.
/// All cores work; the answer does not depend on their number.
[[nodiscard]] LightTruth traceLight(const TracedScene& scene, std::span<const TruthReceiver> receivers,
                                    TruthExtent extent, const LightTruthDesc& desc);

/// Adds soft truth, where there is none yet, to the pixels at which `result` disagrees. `result` is a visibility for
/// each pixel of the picture, below 0 where it is not judged. All other arguments are those of traceLight(). One truth
/// can so judge any number of results: a pixel's soft truth depends on neither the results nor their order.
void completeSoftTruth(LightTruth& truth, const TracedScene& scene, std::span<const TruthReceiver> receivers,
                       const LightTruthDesc& desc, std::span<const float> result);

/// For each pixel of the picture.
[[nodiscard]] std::vector<PixelTruth> ofEveryPixel(const LightTruth& truth);

}  // namespace gnomon::renderer
