#pragma once
// Soft shadows with one search for 2x2 pixels: Filter::PcssShared.
//
// Source: the head of src/visibility/pcss_quad.glsl, in words; the rest is pcss.h.
//
// What, for an aligned quad of 2x2 pixels and a light:
//   1. A pixel asks if it is in the light's influence and not dark by its facing alone. Others, and those beyond the
//      picture, take no part.
//   2. The quad shares if all that ask take the same shadow view first, or none; are all subsurface or none; and lie in
//      one plane with the first of them (left before right, upper row first): off the first one's face by no more than
//      a quarter of how far they are from it and twice the largest off-plane error up to them, with normals whose
//      cosine is at least 0.97.
//   3. It searches once, for a receiver in the middle of the box around them, moved onto the first one's face, with
//      that face's normal and the largest off-plane error; by the pattern of the quad's first pixel, whether that asks
//      or not; for receivers that lie aside by up to half of the box's diagonal.
//   4. The search says dark, or lit, or a radius, which is rounded to 1/1024 of a texel. By that radius each pixel
//      filters from its own place, in a next cascade that blends in as well. If the quad does not share, each pixel
//      searches by itself, with half of the taps.
//   5. The filter's taps follow the radius: tapsForRadius().
// Every decision that hangs on floats is taken both ways: which pixels ask, their view, flatness, and the search.
//
// Limits: which pixels ask is tried in every possible combination, but the outcomes are put together, whichever pixel
// they are for.

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "reference/generate_shadows.h"

namespace gnomon::reference {

/// Pixel 2 y + x of the quad; null beyond the picture.
using QuadPixels = std::array<const Pixel*, 4>;
/// The quad that holds a pixel of the picture.
QuadPixels quadOf(const PixelGrid& grid, std::uint32_t x, std::uint32_t y);

/// All that the quad may find.
struct QuadFinding {
    bool mayBeOwn = false;  ///< each pixel searches by itself
    bool mayBeDark = false, mayBeLit = false;
    bool unknown = false;  ///< anything may come out
    struct Radius {
        std::size_t view;  ///< of the light
        Interval px;       ///< of the filter, in texels of that view
    };
    std::vector<Radius> radii;
};
QuadFinding findQuad(const LightModel& light, const QuadPixels& quad, const ShadowInput& input);

/// Findings of a light's quads, each made when it is first asked for.
class QuadFindings {
public:
    QuadFindings(const LightModel& light, const PixelGrid& grid, const ShadowInput& input)
        : light_(light), grid_(grid), input_(input) {}
    /// Null for lights with another filter.
    const QuadFinding* at(std::uint32_t x, std::uint32_t y);

private:
    const LightModel& light_;
    const PixelGrid& grid_;
    const ShadowInput& input_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, QuadFinding> found_;
};

}  // namespace gnomon::reference
