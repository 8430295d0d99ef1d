#pragma once
// What a host tells the library about one view: camera, lights, shadowmap views. Plain data with working defaults.
//
// Conventions: right-handed world in metres, column vectors, column-major matrices named destination-from-source. All
// positions of one frame are relative to one origin that the host chooses per frame (a float step at 16 km is 2 mm, so
// keep the origin near the camera in large worlds). Vulkan clip space.

#include <cstdint>
#include <limits>
#include <span>

#include "gnomon/settings.h"

namespace gnomon {

inline constexpr std::uint32_t kNoShadowViews = 0xFFFFFFFFu;

enum class DeviceDepth : std::uint8_t {
    ReversedZ,  ///< 1 at the near plane, 0 at the far plane or at infinity.
    StandardZ,  ///< 0 at the near plane, 1 at the far plane or at infinity.
};

/// A camera. Perspective or orthographic, finite or infinite far plane, off-centre and jittered projections are fine;
/// sheared and mirrored ones, oblique near planes and orthographic near planes behind the eye are refused. Pixels whose
/// device depth is exactly the far value are background.
struct Camera {
    /// Rigid: a rotation and a translation, nothing else (checked to 1e-3).
    float viewFromWorld[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    /// The very matrix the depth buffer was drawn with, jitter included. The view may look down its -z or its +z axis.
    float clipFromView[16] = {};
    DeviceDepth deviceDepth = DeviceDepth::ReversedZ;
};

enum class LightType : std::uint8_t { Point, Spot, Directional };

/// One light. All of the scene's lights may be given; the library culls.
struct Light {
    LightType type = LightType::Point;
    /// Bit mask; the light reaches a receiver iff (mask & receiver mask) != 0.
    std::uint8_t mask = 0xFF;
    /// Metres, relative to the frame's origin, at most 1e9. Ignored for directional lights.
    float position[3] = {0, 0, 0};
    /// From the light into the scene; normalised by the library, not zero. Ignored for point lights.
    float direction[3] = {0, 0, -1};
    /// Metres, at least 0; the light has no influence beyond. 0: derived from `intensity` as the distance at which an
    /// unshadowed surface facing the light receives PrepareDesc::rangeCutoffLux. Ignored for directional lights.
    float rangeMetres = 0.0f;
    /// Candela (lux for directional lights), at least 0. 0: the light is off. Else it serves two things only: a missing
    /// range, and the choice among too many lights. What the host's shader makes of the light is its own business.
    float intensity = 1.0f;
    /// Spot: half-angle of the cone in radians, above 0 and at most pi/2.
    float outerConeAngle = 0.785398163f;
    /// Radius of the source in metres, at least 0; directional lights: angular radius in radians, at most 0.5. Drives
    /// the penumbra.
    float sourceRadius = 0.0f;
    /// The light fades from full at fadeStart to nothing at fadeEnd metres between camera and light. Ignored for
    /// directional lights. The end may not be before the start.
    float fadeStartMetres = std::numeric_limits<float>::infinity();
    float fadeEndMetres = std::numeric_limits<float>::infinity();
    /// Likewise its shadow; beyond the end the light casts none. Directional lights: metres between camera and pixel.
    float shadowFadeStartMetres = std::numeric_limits<float>::infinity();
    float shadowFadeEndMetres = std::numeric_limits<float>::infinity();
    /// Depth bias in metres, at least 0. Source: the paper, section 4.2, uses 2 mm.
    float biasMetres = 0.002f;
    /// Multiplies the light's importance, where more than 1024 lights compete. At least 0.
    float priority = 1.0f;
    /// Whether it casts a shadow, where it is given shadow views: FrameDesc::lightViews.
    bool casts = true;
    /// How its shadowmaps are read; one of ShadowSettings::filters.
    Filter filter = Filter::Pcss;
    /// Filter::Pcss and PcssShared: which of ShadowSettings::pcssPresets.
    std::uint8_t pcssPreset = 0;
};

/// The shadow views of one light, in a row. Point lights have six (+X -X +Y -Y +Z -Z), spots have one that holds their
/// cone, or six like point lights, directional lights one per cascade, 1 to 8, from the nearest on.
/// A flat view's texels grow with the square of the cosine towards its border. So six are better for wide cones: from
/// a tangent of the half-angle of sqrt(6) on (68 degrees) they need fewer texels for the same sharpness along the axis.
struct LightShadowViews {
    std::uint32_t first = kNoShadowViews;  ///< index into FrameDesc::shadowViews; kNoShadowViews: it casts nothing
    std::uint32_t count = 0;
};

/// One view of a light, drawn by the host into a rectangle of one of its shadow atlases (D32 or D16, any age).
/// A spot needs one view that holds its cone; a directional light one orthographic view per cascade; a point light or a
/// wide spot six, of 90 degrees or more: where the rectangle reaches a few texels beyond 90 degrees, filters are
/// seamless across faces. How far it reaches is not checked and may be any number of texels, the same for all six. A
/// receiver's view is the one of its direction's largest axis, however wide the views are.
struct ShadowView {
    /// Perspective: clip w is the distance along the shadow view's axis in metres. Orthographic: it is 1. Near and far
    /// below must be those of this matrix: that is not checked, and shadows are wrong where they are not.
    float clipFromWorld[16] = {};
    std::uint32_t atlas = 0;  ///< 0 to 3
    std::uint32_t layer = 0;
    std::uint32_t xPx = 0, yPx = 0;           ///< first pixel of the rectangle
    std::uint32_t widthPx = 0, heightPx = 0;  ///< at least 8 each
    float nearMetres = 0.05f;
    float farMetres = std::numeric_limits<float>::infinity();  ///< infinity allowed for perspective views
    bool orthographic = false;
    DeviceDepth deviceDepth = DeviceDepth::ReversedZ;
    /// Limit Light::biasMetres by what this view sees. Perspective: shares of the receiver's distance along the view's
    /// axis. Orthographic: metres. 0 <= least <= most. As they are, the light's bias is taken as it is. The reference
    /// renderer gives a five-hundredth and a ten-thousandth, and of a cascade these shares of half its width. So 2 mm
    /// are never much, however small the scene is, and never less than what rasterizers round, however large.
    float mostBias = std::numeric_limits<float>::infinity();
    float leastBias = 0.0f;
    /// False promises that the View's previous frame had this very rectangle, and that its texels are still the same.
    /// Its shadow bounds are then kept. Set it true after a frame in which this shadow view was not given.
    bool changed = true;
};

/// What phase 1 needs of one frame and view.
struct ViewInput {
    Camera camera;
    std::uint32_t widthPx = 0, heightPx = 0;         ///< active extent, at least 1x1
    std::uint32_t viewportXPx = 0, viewportYPx = 0;  ///< where it begins in the host's images
    std::span<const Light> lights;                   ///< all of the scene's; read during the call only
};

}  // namespace gnomon
