#pragma once
// Which lights of the scene go into this frame's lists, and in which order.

#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/prepare.h"
#include "gnomon/result.h"
#include "gnomon/scene.h"
#include "gpu_interface/structs.h"
#include "prepare/camera.h"
#include "prepare/light_volume.h"

namespace gnomon::prepare {

/// A light that passed culling. For directional lights volume and depths stay empty.
struct VisibleLight {
    std::uint32_t hostIndex = 0;
    bool directional = false;
    bool casts = false;  // where it is given shadow views
    LightVolume volume;
    DepthRange depth;
    gpu::GpuLight gpu = {};  // without its shadow, which giveShadow() adds
    // Of the shadow: flags besides kLightCastsBit, fade and, for directional lights, tangent of the source's angle.
    std::uint32_t shadowFlags = 0;
    float shadowFade = 0, shadowFadePerMetre = 0, shadowSourceRadius = 0;
    Filter filter = Filter::Pcss;
    std::uint8_t pcssPreset = 0;
};

/// Fails with a sentence that names the light where one breaks a rule of scene.h.
Result validateLights(std::span<const Light> lights) noexcept;
/// What is wrong with the views of a light that casts, or null.
const char* whatIsWrong(const VisibleLight& light, const LightShadowViews& views,
                        std::uint32_t shadowViewCount) noexcept;
/// Completes a copy of `light.gpu`.
void giveShadow(const VisibleLight& light, const LightShadowViews& views, gpu::GpuLight& out) noexcept;

class CullAndSort {
public:
    /// May throw std::bad_alloc where the number of lights has grown. `lights` must be valid.
    void run(std::span<const Light> lights, const ViewCamera& camera, const Frustum& frustum, const PrepareDesc& desc);

    /// Directional lights by host index, then the others by nearest view depth, ties by host index; at most 1024.
    [[nodiscard]] std::span<const VisibleLight> visible() const { return {visible_.data(), visibleCount_}; }
    [[nodiscard]] std::uint32_t directionalCount() const { return directionalCount_; }
    [[nodiscard]] std::uint32_t droppedCount() const { return droppedCount_; }

private:
    struct Candidate {
        std::uint64_t sortKey;  // directional lights first; then depth; then host index
        float importance;
        std::uint32_t reach;  // index into reaches_; nothing for directional lights
    };
    // What culling finds out about a point or spot light, and its entry in the lists needs.
    struct Reach {
        LightVolume volume;
        DepthRange depth;
        Vec3 directionWs;         // spot: unit
        double cosConeAngle = 0;  // spot
    };
    // The first 2047 reaches are kept. The last place is for all others, which are found once more if they are chosen.
    static constexpr std::uint32_t kMaxReaches = 2048, kReachNotKept = kMaxReaches - 1;

    static bool findReach(const Light& light, const ViewCamera& camera, const Frustum& frustum, const PrepareDesc& desc,
                          Reach& out);
    static void fillLocal(const Light& light, const Reach& reach, VisibleLight& out);
    void choose();

    std::vector<Candidate> candidates_;
    std::vector<Reach> reaches_;
    std::vector<std::uint8_t> kept_;  // by host index: in the lists last frame
    std::vector<VisibleLight> visible_;
    std::uint32_t visibleCount_ = 0, directionalCount_ = 0, droppedCount_ = 0;
};

}  // namespace gnomon::prepare
