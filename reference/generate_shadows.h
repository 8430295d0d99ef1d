#pragma once
// Phase 4, Generate shadows: the visibility of a light at a pixel, from copies of the shadow atlases.
//
// Problem: a shadow test compares floats against floats, so the oracle cannot name one right value. It names an
// interval.
//
// Source: the specification, Phase 4, and "Stored visibility is perceptual".
//
// What, for a pixel p with face normal n, toLight the unit vector to the light, c = dot(n, toLight):
//   1. A light that does not cast is lit. A pixel that is not subsurface with c <= 0 is dark without sampling.
//   2. A spot has one view. A point light's face is that of the largest component of the vector from light to p (+X -X
//      +Y -Y +Z -Z). A directional light has cascades: cascades.h. Behind a perspective view: lit.
//   3. The receiver is a plane through p, a bias nearer to the light (subsurface: the larger of the light's and the
//      frame's): receiver_plane.h. A texel is lit iff its surface is no nearer to the light than that plane at the
//      texel's centre.
//   4. By the light's own filter. Hard and percentage closer filtering: filters.h. Soft shadows: pcss.h, with the taps
//      of the light's preset. Soft shadows with one search for four pixels: pcss_quad.h.
//   5. v' = 1 - f (1 - v), f being the light's shadow fade, for directional lights one of the distance from the camera
//      to p. q = round(levels sqrt(v')), levels = 255 or 15.
// Every decision that float errors could turn (a comparison, a texel, a face, a cascade, a blocker, c <= 0) is taken
// both ways, and the interval holds all outcomes.
//
// Limits: no face normals, or a filter of the host's own: every value is acceptable. A pixel whose projected position
// is uncertain by more than two texels (at the light itself) likewise.

#include <array>
#include <cstdint>
#include <vector>

#include "gpu_interface/numbers.h"
#include "reference/filters.h"
#include "reference/lights.h"
#include "reference/pcss.h"
#include "reference/receivers.h"
#include "reference/shadow_views.h"

namespace gnomon::reference {

enum class BiasMode {
    Oriented,          ///< as in 3.
    OrientedConstant,  ///< one depth for all texels: a bias nearer to the light, or farther where c <= 0
    Unbiased,          ///< one depth for all texels: that of p
};

struct ShadowInput {
    bool shadowsOff = false;  ///< no filter in use: everything is lit
    int pcfRadius = 1;
    std::array<PcssTapCounts, gpu::kMaxPcssPresets> pcssPresets;
    std::uint32_t patternTurn = 0;     ///< of the frame: 2^32 to a whole turn
    std::uint32_t visibilityBits = 8;  ///< 8 or 4
    double subsurfaceBiasMetres = 0.02;
    BiasMode bias = BiasMode::Oriented;
    bool facedAwayIsDark = true;  ///< else c <= 0 is sampled like the rest
    std::vector<ShadowViewModel> views;
    std::vector<AtlasCopy> atlases;

    /// What a fully lit pixel stores.
    [[nodiscard]] int levels() const { return (1 << visibilityBits) - 1; }
};

/// Stored values, 0 to the input's levels(), that are acceptable.
struct StoredVisibility {
    int min = 255, max = 255;
    [[nodiscard]] bool ambiguous() const { return min != max; }
    [[nodiscard]] bool holds(int q) const { return q >= min && q <= max; }
};

struct QuadFinding;  // pcss_quad.h

/// Steps 1 to 4. The pixel must not be background. `quad`: for Filter::PcssShared, what the pixel's quad has found;
/// null: the pixel is alone in it.
Visibility visibility(const LightModel& light, const Pixel& pixel, const ShadowInput& input,
                      const QuadFinding* quad = nullptr);
/// The shadow fade of a light at a pixel.
Interval shadowFadeAt(const LightModel& light, const Pixel& pixel);
/// Step 5.
StoredVisibility quantised(Visibility visibility, Interval shadowFade, int levels = 255);
/// All steps.
StoredVisibility storedVisibility(const LightModel& light, const Pixel& pixel, const ShadowInput& input,
                                  const QuadFinding* quad = nullptr);

}  // namespace gnomon::reference
