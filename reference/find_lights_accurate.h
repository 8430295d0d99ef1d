#pragma once
// Phase 3, Find lights accurate: which light reaches which pixel, and so which lights a shadow tile must list. Where
// phase 2 writes the lists (kListsByFroxel) it is a tile's least list.
//
// Source: the specification, Phase 3 and slip 7; the paper, section 2.3.
//
// What: for each (light, pixel), in double precision: the pixel is not background, the masks meet, the pixel is in
// range and in the cone, and (unless it is subsurface) its face looks at a light that casts. Each is `Must`, `May` or
// `Never` with the margin that 32-bit floats need: the pixel's own reconstruction error plus a few roundings of the
// terms. A tile lists a light if at least one of its pixels is reached.
//
// Limits: facing is `May` where the host gave no face normals. Costs lights x pixels, less what a tile's bounding ball
// rules out at once: some ten million pairs a second.

#include <span>

#include "reference/findings.h"
#include "reference/lights.h"
#include "reference/lists.h"
#include "reference/receivers.h"

namespace gnomon::reference {

/// Not background, masks, range, cone: the pixels that sample and vote in phase 4.
Verdict inInfluence(const LightModel& light, const Pixel& pixel);
/// Does the pixel's face look at the light: dot(faceNormal, direction to the light) > 0? Asked of pixels that are not
/// background.
Verdict facesLight(const LightModel& light, const Pixel& pixel);
/// inInfluence, and where `dropFacedAway`, the light casts and the pixel is not subsurface: facesLight.
Verdict reaches(const LightModel& light, const Pixel& pixel, bool dropFacedAway);

struct TileLights {
    std::vector<std::uint32_t> must, may;  ///< light indices, ascending; disjoint
};
/// One per shadow tile, in rows.
std::vector<TileLights> findLights(const PixelGrid& grid, const std::vector<LightModel>& lights, bool dropFacedAway);

struct EarlyListReport {
    Findings findings;
    std::size_t must = 0, may = 0;  ///< (tile, light) pairs by the oracle
    std::size_t listed = 0;         ///< pairs in the lists
    std::size_t tilesWithoutSpace = 0;
    [[nodiscard]] double mayShare() const { return must + may ? double(may) / double(must + may) : 0.0; }
};
/// must is in the list; the number of casting lights in the count word is right. Of phase 3's lists: the list is in
/// must or may. Of phase 2's lists: they are as long as the approximate count.
EarlyListReport checkEarlyLists(const std::vector<TileLights>& expected, const std::vector<LightModel>& lights,
                                const ListBuffers& buffers);

}  // namespace gnomon::reference
