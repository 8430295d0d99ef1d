#pragma once
// What a view can see, for tests against bounding spheres on the CPU.

#include <glm/glm.hpp>

namespace gnomon::renderer {

/// The bounds of a part of the scene: a sphere, and a box of any directions with the same centre.
struct ScenePart {
    glm::dvec3 centre{0.0};  ///< world
    double radius = 0.0;
    bool seen = false;         ///< the camera may see some of it
    glm::dmat3 halfAxes{0.0};  ///< columns: from the centre to the middles of three faces of the box
};

/// Planes of a frustum around the frame's origin and, optionally, a sphere (a light's range).
struct CullVolume {
    glm::dvec3 origin{0.0};    ///< world position that the planes are relative to
    glm::vec4 planes[6] = {};  ///< xyz unit, into the volume: outside iff dot(xyz, p - origin) + w < -radius
    int planeCount = 0;
    bool hasSphere = false;
    glm::dvec3 sphereCentre{0.0};
    float sphereRadius = 0.0f;

    [[nodiscard]] bool mayHold(const glm::dvec3& centre, float radius) const {
        if (hasSphere) {
            const glm::dvec3 d = centre - sphereCentre;
            const double reach = static_cast<double>(radius) + sphereRadius;
            if (glm::dot(d, d) > reach * reach) return false;
        }
        const glm::vec3 p(centre - origin);
        // The slack covers the rounding of p and of the planes.
        const float slack = 1e-5f * (radius + glm::length(p));
        for (int i = 0; i < planeCount; ++i) {
            if (glm::dot(glm::vec3(planes[i]), p) + planes[i].w < -(radius + slack)) return false;
        }
        return true;
    }
};

/// Planes of Vulkan's clip volume. A plane at infinity is left out.
inline CullVolume cullVolumeOf(const glm::mat4& clipFromWorld, const glm::dvec3& origin) {
    const glm::mat4 rows = glm::transpose(clipFromWorld);
    const glm::vec4 candidates[6] = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1],
                                     rows[3] - rows[1], rows[2],           rows[3] - rows[2]};
    CullVolume volume;
    volume.origin = origin;
    for (const glm::vec4& plane : candidates) {
        const float length = glm::length(glm::vec3(plane));
        if (length > 1e-12f) volume.planes[volume.planeCount++] = plane / length;
    }
    return volume;
}

}  // namespace gnomon::renderer
