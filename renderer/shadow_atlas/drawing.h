#pragma once
// How casters are drawn into shadowmaps.

namespace gnomon::renderer {

/// Vulkan's depth bias, with the sign that moves what is drawn away from the light, whatever the kind of depth.
struct HardwareBias {
    float constantFactor = 0.0f;  ///< times the least step of the depth at the triangle's farthest corner
    float slopeFactor = 0.0f;     ///< times the triangle's greatest depth slope per texel
    float clamp = 0.0f;           ///< device depth; 0: none

    [[nodiscard]] bool none() const { return constantFactor == 0.0f && slopeFactor == 0.0f; }
    bool operator==(const HardwareBias&) const = default;
};

struct ShadowDrawing {
    HardwareBias bias;
    /// Off: closed casters that light passes through (subsurface, not double-sided) are drawn without the faces that
    /// look at the light, so that they do not shadow themselves. Source: the paper, section 4.2.
    bool subsurfaceFronts = false;

    bool operator==(const ShadowDrawing&) const = default;
};

}  // namespace gnomon::renderer
