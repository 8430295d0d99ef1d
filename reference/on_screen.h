#pragma once
// Phase 1's answer: how large each visible light is on screen, and whether it wants shadow views.
//
// Source: gnomon/prepare.h (LightOnScreen says what each value means).
//
// What: every value again from the host's description, in double precision. A spot's reach has the smallest ball around
// its cone and round cap: through the apex and the rim for half-angles up to 60 degrees, about the apex beyond.
//
// Limits: the share of the view is compared with the tile light masks, which checkTileLightMasks() holds to the exact
// convex test. Depths may be wider by the margins of phase 1, never narrower.

#include <span>

#include "gnomon/prepare.h"
#include "reference/lights.h"

namespace gnomon::reference {

/// The lights of an answer in its order. Entries that name no light become one that reaches nothing.
std::vector<LightModel> orderLights(const std::vector<LightModel>& all, std::span<const LightOnScreen> answer);

struct Ball {
    Vec3 centre;
    double radius = 0;
};
/// The smallest one around all that a light reaches. Not of directional lights.
Ball reachOf(const LightModel& light);

/// Every entry against its light; `lights` in the order of the answer. `masks`: the tile light masks, `tilesX` entries
/// in a row; no tiles where none were written.
Findings checkOnScreen(const std::vector<LightModel>& lights, const CameraModel& camera,
                       std::span<const LightOnScreen> answer, std::span<const std::uint32_t> masks = {},
                       std::uint32_t tilesX = 0, std::uint32_t tilesY = 0);

/// The counts of the answer, of `given` lights of which `must` must be visible (checkVisibleLights() counts them).
/// `casting` as run() gives it: of those that want shadow views.
Findings checkReport(std::size_t given, std::size_t must, const PreparedLights& answer);

}  // namespace gnomon::reference
