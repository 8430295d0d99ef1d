#pragma once
// The triangles of a posed scene, to be met by shadow rays.
//
// Problem: Embree computes in float. Floats do not tell on which side of its own surface a point lies. So a ray that
// starts there meets that surface, or the coplanar neighbour, a few micrometres ahead.
// Plain way: an offset along the normal or the ray. That is a depth bias again, in the very thing that shall judge
// biases.
// Here: Embree only proposes.
// - Its rays start a little before the point.
// - Every triangle that it offers is met again in double, from the point itself. It must lie farther from the point
//   than double arithmetic errs.
// - The triangle that the point lies on is left out by its number.
// Limits: a triangle is taken to be a few float steps larger where the ray passes its edge far from its start. So no
// light falls through seams that Embree saw a step beside the true ones. Alpha masks are read at the finest mip.
// Instances whose matrix leaves lines or points alone (scene/flatness.h) do not block.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "scene/pose.h"
#include "scene/scene.h"

namespace gnomon::renderer {

/// From a point to a light, both relative to TracedScene::origin().
struct ShadowRay {
    glm::dvec3 from{0.0}, to{0.0};
    std::uint32_t own = kNone;    ///< the triangle that `from` lies on; it cannot block
    double freeMetres = 0.0;      ///< what is nearer to `from` does not block
    bool fromSubsurface = false;  ///< `from` lies on a subsurface material
};

/// What light may do that has entered a body of a subsurface material (docs/verify.md).
struct SubsurfaceRule {
    /// False: single-sided triangles of subsurface materials do not block rays that leave through their front, the side
    /// from which they are counter-clockwise as placed. True: they do.
    bool frontsBlock = false;
    /// With `frontsBlock`: what is nearer to a subsurface point than this, along its ray, does not block.
    double freeMetres = 0.02;
};

/// Thread safe once made.
class TracedScene {
public:
    /// Positions are kept relative to `origin`, which should be near the camera. The scene must outlive this.
    /// Throws std::runtime_error with one sentence where Embree fails.
    TracedScene(const Scene& scene, const Pose& pose, const glm::dvec3& origin, const SubsurfaceRule& rule = {});
    ~TracedScene();
    TracedScene(const TracedScene&) = delete;
    TracedScene& operator=(const TracedScene&) = delete;

    struct Triangle {
        std::array<glm::dvec3, 3> corners;
        std::uint32_t material = 0;
        std::uint32_t mask = kNone;  // among the alpha-tested ones
        bool drawn = true;
        bool mirrored = false;  // the instance's matrix turned the winding around
        /// How large its mesh's own coordinates are, as placed: floats round by a share of that, wherever the mesh is.
        float meshMetres = 0.0f;
    };
    /// In the scene's order: instances, their primitives, their triangles (Renderer::readTriangleIds()).
    [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
    [[nodiscard]] bool isSubsurface(std::uint32_t triangle) const;
    [[nodiscard]] const glm::dvec3& origin() const { return origin_; }
    /// Diameter of the scene; a ray to a light at infinity need not be longer.
    [[nodiscard]] double reachMetres() const { return reachMetres_; }

    [[nodiscard]] bool blocked(const ShadowRay& ray) const;
    /// Metres from the start to the nearest blocker, infinity if the ray is free.
    [[nodiscard]] double nearestBlocker(const ShadowRay& ray) const;

    struct Query;  // for Embree's callback

private:
    struct Embree;
    struct MaskCorners {
        std::array<glm::dvec2, 3> uv{};
        std::array<double, 3> alpha{1.0, 1.0, 1.0};
    };
    void append(const Primitive& primitive, const std::vector<glm::vec3>& positions, const glm::dmat4& worldFromObject);
    void build();
    [[nodiscard]] bool leavesThrough(const Triangle& triangle, const glm::dvec3& way) const;
    [[nodiscard]] bool isCutOut(const Triangle& triangle, const glm::dvec3& barycentrics) const;

    const Scene& scene_;
    glm::dvec3 origin_;
    SubsurfaceRule rule_;
    double reachMetres_ = 0.0;
    std::vector<Triangle> triangles_;
    std::vector<MaskCorners> masks_;
    std::unique_ptr<Embree> embree_;
};

}  // namespace gnomon::renderer
