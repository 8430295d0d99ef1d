#pragma once
// Hard shadows by casting rays through a scene's triangles on the CPU, in double: independent of the GPU and of the
// library. For each pixel and the scene's only light: lit, dark, or not counted.

#include <cstdint>
#include <vector>

#include "renderer/scene/scene.h"

namespace gnomon::renderer::image_test {

class Triangles {
public:
    struct Triangle {
        glm::dvec3 a, b, c;
        glm::dvec2 uv[3];
        const Image* mask = nullptr;  ///< alpha-tested by this image
        float cutoff = 0.0f;
        bool singleSided = true;
    };
    struct Hit {
        double distance = 0.0;
        std::uint32_t triangle = kNone;
    };

    explicit Triangles(const Scene& scene);

    /// Nearest hit of a camera ray; single-sided triangles are seen from their front alone.
    [[nodiscard]] Hit nearest(const glm::dvec3& origin, const glm::dvec3& direction) const;
    /// Whether any triangle but `except` stands between the two points, whichever side it shows.
    [[nodiscard]] bool blocked(const glm::dvec3& from, const glm::dvec3& to, std::uint32_t except) const;
    [[nodiscard]] const Triangle& operator[](std::uint32_t i) const { return triangles_[i]; }

private:
    struct Node {
        glm::dvec3 min, max;
        std::uint32_t first = 0, count = 0;  // a leaf's triangles; inner: count 0, children first and first + 1
    };
    void split(std::uint32_t node);
    template <class Visit>
    void walk(const glm::dvec3& origin, const glm::dvec3& direction, const double& reach, Visit visit) const;

    std::vector<Triangle> triangles_;
    std::vector<Node> nodes_;
};

enum class Truth : std::uint8_t {
    Background,
    Unlit,  ///< out of the light's range or cone
    Lit,
    Dark,   ///< in shadow, or the face looks away from the light
    Edge,   ///< not unanimous nearby
};

/// Of the scene's first and only light. A pixel is at an edge if its own ray and those from 16 points around it on its
/// face's plane do not agree. Seen from the light they lie on circles with the radius max(2 pixels, `texels` texels of a
/// shadowmap of the size `shadowSizePx`) and half of it.
std::vector<Truth> truthOf(const Scene& scene, const SceneCamera& camera, std::uint32_t widthPx, std::uint32_t heightPx,
                           double texels, std::uint32_t shadowSizePx);

}  // namespace gnomon::renderer::image_test
