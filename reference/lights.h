#pragma once
// The lights, in double precision, from the host's own descriptions, and put into the order that phase 1 chose.
//
// Source: gnomon/scene.h (what each value means) and gpu_interface/structs.h (GpuLight).
//
// What: every later phase of the oracle works on a vector of LightModel in sorted order, so that an element's place is
// its light index. The order comes from the GpuLight array (hostIndex); all other values come from the host's
// description. A light's shadow views come beside it: the host gives them once phase 1 has answered.
//
// Limits: whether a light casts, and whether its shadow fades, is taken from the GpuLight's bits once the order is
// known, because phase 1 decides it in floats: it may drop the shadow of a light whose shadow has faded away
// (checkGpuLights allows no other change).

#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/scene.h"
#include "gpu_interface/numbers.h"
#include "gpu_interface/structs.h"
#include "reference/camera.h"
#include "reference/findings.h"

namespace gnomon::reference {

struct LightModel {
    LightType type = LightType::Point;
    std::uint8_t mask = 0xFF;
    Vec3 position;             ///< origin-relative metres
    Vec3 direction{0, 0, -1};  ///< unit, from the light into the scene
    double rangeMetres = kInfinity;
    double outerAngle = kPi;   ///< spots: half-angle of the cone, radians
    double sourceRadius = 0;   ///< metres; directional lights: tangent of the angular radius
    bool wantsShadow = false;  ///< Light::casts
    bool casts = false;        ///< it wants to, and has shadow views
    Filter filter = Filter::Pcss;
    std::uint32_t pcssPreset = 0;
    std::uint32_t firstShadowView = kNoShadowViews;
    std::uint32_t cascadeCount = 0;  ///< directional lights
    bool sixFaces = false;           ///< its shadow views look along the six axes: point lights, and wide spots
    double biasMetres = 0;
    double lightFade = 1;      ///< 0: the light has faded away
    double shadowFade = 1;     ///< visibility = 1 - shadowFade * (1 - visibility)
    bool shadowFades = false;  ///< lets light through, here or farther away, also where faces look away
    double shadowFadeScale = 0, shadowFadeOffset = 1;  ///< directional: shadowFade by the distance of eye and pixel
    std::uint32_t hostIndex = 0;

    [[nodiscard]] std::uint32_t viewCount() const {
        return sixFaces ? gpu::kPointLightFaces : type == LightType::Directional ? cascadeCount : 1;
    }
};

/// All lights of the host, in the host's order. `views`: of each of them; of lights beyond its end there are none.
/// `rangeCutoffLux` as in PrepareDesc.
std::vector<LightModel> makeLightModels(std::span<const Light> lights, std::span<const LightShadowViews> views,
                                        const CameraModel& camera, double rangeCutoffLux = 0.02f);

/// The lights of a GpuLight array in its order. Entries with a bad hostIndex become a light that reaches nothing (they
/// are reported by checkGpuLights).
std::vector<LightModel> orderLights(const std::vector<LightModel>& all, std::span<const gpu::GpuLight> gpuLights);

/// Every GpuLight against the host's description that it names: position, range, cone, direction, masks, flags, filter,
/// fades, view-space depth; and no hostIndex twice. Relative tolerance: a few float roundings.
Findings checkGpuLights(const std::vector<LightModel>& all, const CameraModel& camera,
                        std::span<const gpu::GpuLight> gpuLights);

}  // namespace gnomon::reference
