#pragma once
// Phase 4, Generate shadows: the visibility of a light at a pixel, from copies of the shadow atlases.
//
// Problem: a shadow test compares floats against floats, so the oracle cannot name one right byte. It names an
// interval.
//
// Source: the specification, Phase 4, Oriented depth bias, and "Stored visibility is perceptual".
//
// What, for a pixel p with face normal n, toLight the unit vector to the light, c = dot(n, toLight):
//   1. A light that does not cast is lit. A pixel that is not subsurface with c <= 0 is dark without sampling.
//   2. A point light's face is that of the largest component of the vector from light to p (+X -X +Y -Y +Z -Z).
//   3. L = linear depth of p in the view; a texel is t = texelMetres * L wide (orthographic: texelMetres).
//      p moves along n (against n where c < 0) by t * (radius + 1) * sqrt(1 - c^2), where radius is 0 for Hard, and is
//      projected again. clip.w <= 0: lit.
//   4. Its linear depth moves toward the light by the light's bias (subsurface: by the larger of that and the
//      frame's), at least to 0.1 mm for perspective. A texel is lit iff it is no nearer to the light than that.
//   5. Hard: the texel that holds the position. PCF of radius r: the mean of (2r + 1)^2 bilinear comparisons, that is
//      the sum over (2r + 2)^2 texels with weights (1 - f), 1, ..., 1, f per axis over (2r + 1)^2, f being the
//      position's fraction relative to texel centres. The position is clamped so that the kernel's support, r + 1
//      texels to each side, stays in the view's rectangle.
//   6. v' = 1 - shadowFade * (1 - v), q = round(255 sqrt(v')).
// Every decision that float errors could turn (a comparison, a texel, a face, c <= 0) is taken both ways, and the
// interval holds all outcomes.
//
// Limits: no face normals: every byte is acceptable. A pixel whose projected position is uncertain by more than two
// texels (at the light itself) likewise.

#include <cstdint>
#include <vector>

#include "reference/lights.h"
#include "reference/receivers.h"
#include "reference/shadow_views.h"

namespace gnomon::reference {

enum class ShadowFilter { Hard, Pcf, Off };

struct ShadowInput {
    ShadowFilter filter = ShadowFilter::Pcf;
    int pcfRadius = 1;
    double subsurfaceBiasMetres = 0.02;
    std::vector<ShadowViewModel> views;
    std::vector<AtlasCopy> atlases;
};

/// Visibilities between 0 and 1 that are acceptable.
struct Visibility {
    double min = 1, max = 1;
};
/// Stored values, 0 to 255, that are acceptable.
struct StoredVisibility {
    int min = 255, max = 255;
    [[nodiscard]] bool ambiguous() const { return min != max; }
    [[nodiscard]] bool holds(int q) const { return q >= min && q <= max; }
};

/// Steps 1 to 5. The pixel must not be background.
Visibility visibility(const LightModel& light, const Pixel& pixel, const ShadowInput& input);
/// Step 6.
StoredVisibility quantised(Visibility visibility, double shadowFade);
/// All steps.
StoredVisibility storedVisibility(const LightModel& light, const Pixel& pixel, const ShadowInput& input);

/// Step 5 alone, for tests: the mean over texels around an exact position against an exact device depth.
Visibility filterAt(const ShadowViewModel& view, const AtlasCopy& atlas, ShadowFilter filter, int radius, double xPx,
                    double yPx, double positionErrorPx, double deviceDepth, double depthError);

}  // namespace gnomon::reference
