#include "truth/receivers.h"

#include <algorithm>
#include <cmath>

namespace gnomon::renderer {
namespace {

// Off the edges by so much of the triangle, so that it is plain on which side of a neighbour the point lies.
constexpr double kInset = 1e-6;

struct PixelRays {
    glm::dvec3 eye, x, y, z;  // z points backwards
    double scale;             // view xy per pixel, at depth 1 if perspective
    bool orthographic;
    std::uint32_t widthPx, heightPx;

    PixelRays(const SceneCamera& given, const glm::dvec3& origin, std::uint32_t width, std::uint32_t height)
        : orthographic(given.orthographic), widthPx(width), heightPx(height) {
        const SceneCamera camera = fittedCamera(given, width, height);
        const glm::dmat4 world(camera.worldFromCamera);
        eye = glm::dvec3(world[3]) - origin;
        z = glm::normalize(glm::dvec3(world[2]));
        x = glm::normalize(glm::cross(glm::dvec3(world[1]), z));
        y = glm::cross(z, x);
        const double half = orthographic ? static_cast<double>(camera.orthographicHalfHeight)
                                         : std::tan(0.5 * static_cast<double>(camera.verticalFieldOfView));
        scale = 2.0 * half / heightPx;
    }
    [[nodiscard]] glm::dvec3 lateral(std::uint32_t px, std::uint32_t py) const {
        return (px + 0.5 - 0.5 * widthPx) * scale * x + (0.5 * heightPx - py - 0.5) * scale * y;
    }
};

glm::dvec3 nearestOnSegment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 ab = b - a;
    const double squared = glm::dot(ab, ab);
    return squared > 0.0 ? a + std::clamp(glm::dot(p - a, ab) / squared, 0.0, 1.0) * ab : a;
}

glm::dvec3 intoTriangle(const std::array<glm::dvec3, 3>& c, const glm::dvec3& p) {
    const glm::dvec3 n = glm::cross(c[1] - c[0], c[2] - c[0]);
    bool inside = true;
    for (std::size_t i = 0; i < 3; ++i)
        inside = inside && glm::dot(glm::cross(c[(i + 1) % 3] - c[i], p - c[i]), n) >= 0.0;
    if (inside) return p;
    glm::dvec3 best = c[0];
    double least = INFINITY;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 q = nearestOnSegment(p, c[i], c[(i + 1) % 3]);
        if (glm::length(q - p) < least) {
            least = glm::length(q - p);
            best = q;
        }
    }
    return glm::mix(best, (c[0] + c[1] + c[2]) / 3.0, kInset);
}

TruthReceiver receiverAt(const TracedScene& scene, const PixelRays& rays, std::uint32_t px, std::uint32_t py,
                         std::uint32_t id) {
    TruthReceiver r;
    if (id >= scene.triangles().size()) return r;
    const TracedScene::Triangle& triangle = scene.triangles()[id];
    const glm::dvec3 ab = triangle.corners[1] - triangle.corners[0], ac = triangle.corners[2] - triangle.corners[0];
    const double size = std::max(glm::length(ab), glm::length(ac));
    if (!(size > 0.0)) return r;
    const glm::dvec3 n = glm::cross(ab / size, ac / size);
    if (!(glm::length(n) > 1e-12)) return r;
    r.normal = glm::normalize(n);
    const glm::dvec3 lateral = rays.lateral(px, py);
    const glm::dvec3 from = rays.orthographic ? rays.eye + lateral : rays.eye;
    const glm::dvec3 way = rays.orthographic ? -rays.z : lateral - rays.z;
    const double along = glm::dot(way, r.normal);
    const double t = glm::dot(triangle.corners[0] - from, r.normal) / along;
    const glm::dvec3 onPlane = std::isfinite(t) ? from + t * way : triangle.corners[0];
    r.position = intoTriangle(triangle.corners, onPlane);
    r.toEye = rays.orthographic ? rays.z : glm::normalize(rays.eye - r.position);
    if (glm::dot(r.normal, r.toEye) < 0.0) r.normal = -r.normal;
    const double depth = glm::dot(rays.eye - r.position, rays.z);
    r.pixelMetres = rays.scale * (rays.orthographic ? 1.0 : std::max(depth, 0.0));
    r.triangle = id;
    r.subsurface = scene.isSubsurface(id);
    return r;
}

}  // namespace

std::vector<TruthReceiver> receiversOf(const TracedScene& scene, const SceneCamera& camera, std::uint32_t widthPx,
                                       std::uint32_t heightPx, std::span<const std::uint32_t> triangleIds) {
    const PixelRays rays(camera, scene.origin(), widthPx, heightPx);
    std::vector<TruthReceiver> out(std::size_t{widthPx} * heightPx);
    for (std::uint32_t y = 0; y < heightPx; ++y)
        for (std::uint32_t x = 0; x < widthPx; ++x) {
            const std::size_t i = std::size_t{y} * widthPx + x;
            out[i] = receiverAt(scene, rays, x, y, triangleIds[i]);
        }
    return out;
}

}  // namespace gnomon::renderer
