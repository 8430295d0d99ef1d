#include "unit/truth/truth_scenes.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace gnomon::renderer::truth_test {

SceneBuilder::SceneBuilder() {
    scene.materials.resize(1);
}

std::uint32_t SceneBuilder::add(Primitive primitive) {
    for (const glm::vec3& p : primitive.positions) primitive.bounds.add(p);
    Mesh mesh;
    mesh.primitives.push_back(std::move(primitive));
    scene.meshes.push_back(std::move(mesh));
    Instance instance;
    instance.mesh = static_cast<std::uint32_t>(scene.meshes.size() - 1);
    scene.instances.push_back(instance);
    return instance.mesh;
}

std::uint32_t SceneBuilder::quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d,
                                 std::uint32_t cellsPerSide) {
    Primitive p;
    const std::uint32_t n = cellsPerSide;
    for (std::uint32_t y = 0; y <= n; ++y)
        for (std::uint32_t x = 0; x <= n; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(n);
            const float v = static_cast<float>(y) / static_cast<float>(n);
            p.positions.push_back(glm::mix(glm::mix(a, b, u), glm::mix(d, c, u), v));
            p.texcoords[0].emplace_back(u, v);
        }
    for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t i = y * (n + 1) + x;
            for (const std::uint32_t k : {0u, 1u, n + 2u, 0u, n + 2u, n + 1u}) p.indices.push_back(i + k);
        }
    return add(std::move(p));
}

std::uint32_t SceneBuilder::sphere(const glm::vec3& centre, float radius, std::uint32_t segments) {
    Primitive p;
    const std::uint32_t rings = segments / 2;
    for (std::uint32_t r = 0; r <= rings; ++r)
        for (std::uint32_t s = 0; s <= segments; ++s) {
            const double theta = std::numbers::pi * r / rings, phi = 2.0 * std::numbers::pi * s / segments;
            p.positions.push_back(centre + radius * glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta),
                                                              std::sin(theta) * std::sin(phi)));
        }
    for (std::uint32_t r = 0; r < rings; ++r)
        for (std::uint32_t s = 0; s < segments; ++s) {
            const std::uint32_t i = r * (segments + 1) + s;
            for (const std::uint32_t k : {0u, 1u, segments + 2u, 0u, segments + 2u, segments + 1u})
                p.indices.push_back(i + k);
        }
    return add(std::move(p));
}

namespace {

// Nearest triangle along a ray, all of them tried.
std::uint32_t seenTriangle(const TracedScene& scene, const glm::dvec3& from, const glm::dvec3& way) {
    std::uint32_t best = kNone;
    double nearest = INFINITY;
    for (std::uint32_t i = 0; i < scene.triangles().size(); ++i) {
        const auto& c = scene.triangles()[i].corners;
        const glm::dvec3 n = glm::cross(c[1] - c[0], c[2] - c[0]);
        const double t = glm::dot(c[0] - from, n) / glm::dot(way, n);
        if (!(t > 0.0 && t < nearest)) continue;
        const glm::dvec3 p = from + t * way;
        bool inside = true;
        for (std::size_t k = 0; k < 3; ++k)
            inside = inside && glm::dot(glm::cross(c[(k + 1) % 3] - c[k], p - c[k]), n) >= 0.0;
        if (inside) nearest = t, best = i;
    }
    return best;
}

}  // namespace

Seen lookAt(const TracedScene& scene, const glm::dvec3& eye, const glm::dvec3& target, TruthExtent extent) {
    SceneCamera camera;
    const glm::dmat4 world = glm::inverse(glm::lookAt(eye, target, glm::dvec3(0.1, 1.0, 0.2)));
    camera.worldFromCamera = glm::mat4(world);
    camera.verticalFieldOfView = 0.8f;
    const double scale = 2.0 * std::tan(0.4) / extent.heightPx;
    std::vector<std::uint32_t> ids;
    for (std::uint32_t y = 0; y < extent.heightPx; ++y)
        for (std::uint32_t x = 0; x < extent.widthPx; ++x) {
            const glm::dvec4 way((x + 0.5 - 0.5 * extent.widthPx) * scale, (0.5 * extent.heightPx - y - 0.5) * scale,
                                 -1.0, 0.0);
            ids.push_back(seenTriangle(scene, glm::dvec3(world[3]) - scene.origin(), glm::dvec3(world * way)));
        }
    return {extent, receiversOf(scene, camera, extent.widthPx, extent.heightPx, ids)};
}

TruthReceiver onFloor(double x, double z, std::uint32_t own) {
    TruthReceiver r;
    r.position = {x, 0.0, z};
    r.normal = r.toEye = {0.0, 1.0, 0.0};
    r.triangle = own;
    return r;
}

}  // namespace gnomon::renderer::truth_test
