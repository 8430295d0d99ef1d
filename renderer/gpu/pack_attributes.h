#pragma once
// Normals and tangents as scene_pull.glsl unpacks them.

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>

#include "renderer/gpu/scene_data.h"

namespace gnomon::renderer {

/// A position and the words of scene_data.h.
inline constexpr std::size_t kDeformedVertexBytes = sizeof(glm::vec3) + kAttributeWords * sizeof(std::uint32_t);

/// Octahedral coordinates in [-1, 1].
inline glm::vec2 octahedral(glm::vec3 n) {
    const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    if (!(sum > 0.0f)) return {0.0f, 0.0f};
    n /= sum;
    if (n.z >= 0.0f) return {n.x, n.y};
    return {(1.0f - std::abs(n.y)) * (n.x >= 0.0f ? 1.0f : -1.0f),
            (1.0f - std::abs(n.x)) * (n.y >= 0.0f ? 1.0f : -1.0f)};
}

inline std::uint32_t packNormal(const glm::vec3& normal) {
    return glm::packSnorm2x16(octahedral(normal));
}

inline std::uint32_t packTangent(const glm::vec4& tangent) {
    // The lowest bit of y is the handedness: half a step of 1/32767 is lost.
    return (glm::packSnorm2x16(octahedral(glm::vec3(tangent))) & ~0x10000u) | (tangent.w < 0.0f ? 0x10000u : 0u);
}

}  // namespace gnomon::renderer
