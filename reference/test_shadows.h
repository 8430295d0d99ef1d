#pragma once
// Seeded input for tests: shadow views of a set of lights, and atlases with the analytic scene's depth in them.
//
// What: every point light that is to cast gets six views, every spot one that holds its cone, every directional light
// its cascades, each three times as wide as the one before and centred on whole texels of its own, all packed into the
// atlases' cells one after the other. Each texel's ray is cast through its centre in double precision and stored as
// device depth. Every third view limits the lights' bias. Texels outside every rectangle hold the nearest possible
// depth: a kernel that leaves its rectangle finds shadow there.

#include <span>
#include <vector>

#include "gnomon/scene.h"
#include "reference/shadow_views.h"
#include "reference/shapes.h"

namespace gnomon::reference {

struct ShadowSetup {
    std::uint32_t viewSizePx = 64;  ///< side of every rectangle, at least 8
    std::uint32_t cellsPerRow = 8;  ///< of an atlas; rows are added as needed
    std::uint32_t atlasCount = 2;   ///< 1 to 4; views take turns
    std::uint32_t layers = 2;
    bool reversed = true;
    bool mixDepthKinds = false;  ///< every other light uses the other kind of depth
    bool infiniteFar = true;     ///< else far is a little beyond the light's range
    double nearMetres = 0.05;
    double borderTexels = 2;     ///< by which point light faces reach beyond 90 degrees
    std::uint32_t cascades = 0;  ///< of a directional light; 0: 1 to 4, by the light's index
    Vec3 cascadeCentre{0, 1, 0};
    double cascadeHalfExtentMetres = 1.5;  ///< of the first cascade
};

struct TestShadows {
    std::vector<ShadowView> views;
    std::vector<AtlasCopy> atlases;
    std::vector<LightShadowViews> lightViews;  ///< of each light, in the host's order
};

/// Views for every light that casts, one light's after the other's.
std::vector<LightShadowViews> numberViews(std::span<const Light> lights, const ShadowSetup& setup = {});

/// Gives every light that casts its views, numbered like that.
TestShadows buildShadows(const Shapes& shapes, std::span<const Light> lights, const ShadowSetup& setup,
                         double rangeCutoffLux = 0.02f);

/// A perspective or orthographic view from a point along a direction; the rectangle is left at zero.
/// halfExtent: tangent of the half-angle, or metres. Rows of the image run along `down`.
ShadowView makeShadowView(Vec3 from, Vec3 direction, Vec3 down, double halfExtent, double nearMetres, double farMetres,
                          bool orthographic, bool reversed);

/// Casts the rays of one view's rectangle into its atlas.
void renderShadowView(const Shapes& shapes, const ShadowView& view, AtlasCopy& atlas);

}  // namespace gnomon::reference
