// The nearest surface to each light.
//
// Problem: a few lights, and perhaps millions of triangles, in every pose of an animation.
// Plain way: every light asks every triangle.
// Here: triangles go in runs of neighbours with a box each. A light opens only boxes that are nearer than what it has
// found. Lights that stand still ask what stands still in the first pose alone.
// A spot's cone is widened to the pyramid around it, and triangles are clipped by its four sides. Cones beyond kWidest
// are taken for all that is before the light.

#include "scene/nearest_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scene/pose.h"
#include "scene/things.h"
#include "scene/triangle_distance.h"

namespace gnomon::renderer {
namespace {

constexpr std::size_t kRunIndices = 3 * 64;
constexpr float kWidest = 1.4f;  // radians; from there on the pyramid is hardly less than a half space
constexpr float kInfinity = std::numeric_limits<float>::infinity();
// Nearer than this share of how far away the triangle's corners are, the light lies on it: floats tell no more.
constexpr double kOn = 1.0e-6;

struct Run {
    Bounds bounds;  // world
    std::uint32_t instance = 0;
    const std::vector<glm::vec3>* positions = nullptr;
    const std::vector<std::uint32_t>* indices = nullptr;
    std::size_t first = 0, end = 0;  // of the indices
};

glm::dvec3 inWorld(const glm::dmat4& worldFromObject, const glm::vec3& p) {
    return glm::dvec3(worldFromObject * glm::dvec4(glm::dvec3(p), 1.0));
}

void addRuns(const std::vector<glm::vec3>& positions, const std::vector<std::uint32_t>& indices, std::uint32_t instance,
             const Pose& pose, std::vector<Run>& runs) {
    for (std::size_t first = 0; first < indices.size(); first += kRunIndices) {
        Run run = {{}, instance, &positions, &indices, first, std::min(first + kRunIndices, indices.size())};
        for (std::size_t i = run.first; i < run.end; ++i)
            run.bounds.add(glm::vec3(inWorld(pose.worldFromObject[instance], positions[indices[i]])));
        runs.push_back(run);
    }
}

// Of the instances that move, or of those that do not.
std::vector<Run> runsOf(const Scene& scene, const Pose& pose, const std::vector<bool>& moves, bool moving) {
    std::vector<Run> runs;
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i)
        for (const Primitive& primitive : scene.meshes[scene.instances[i].mesh].primitives)
            if (moves[i] == moving && !deforms(scene.instances[i], primitive))
                addRuns(primitive.positions, primitive.indices, i, pose, runs);
    for (const PosedPrimitive& posed : pose.deformed) {
        const Mesh& mesh = scene.meshes[scene.instances[posed.instance].mesh];
        if (moves[posed.instance] == moving)
            addRuns(posed.positions, mesh.primitives[posed.primitive].indices, posed.instance, pose, runs);
    }
    return runs;
}

// What a light reaches, but for its range: within the planes through the light, all of whose normals point inwards.
struct Reach {
    glm::dvec3 position;
    std::array<glm::dvec3, 4> planes{};
    std::size_t planeCount = 0;

    explicit Reach(const SceneLight& light) : position(light.position) {
        if (light.kind != LightKind::Spot) return;
        const glm::dvec3 axis = glm::normalize(glm::dvec3(light.direction));
        if (light.outerConeAngle > kWidest) {
            planes[planeCount++] = axis;
            return;
        }
        const glm::dvec3 helper = std::abs(axis.y) > 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
        const glm::dvec3 right = glm::normalize(glm::cross(axis, helper)), up = glm::cross(right, axis);
        const double tangent = std::tan(static_cast<double>(light.outerConeAngle));
        for (const glm::dvec3& side : {right, -right, up, -up}) planes[planeCount++] = axis * tangent + side;
    }

    // Infinity where none of the triangle is within.
    [[nodiscard]] double distanceTo(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) const {
        a -= position, b -= position, c -= position;
        const double corners = std::max({glm::length(a), glm::length(b), glm::length(c)});
        std::array<glm::dvec3, 8> polygon = {a, b, c}, clipped;
        std::size_t count = 3;
        for (std::size_t p = 0; p < planeCount && count != 0; ++p) {
            std::size_t kept = 0;
            for (std::size_t i = 0; i < count; ++i) {
                const glm::dvec3 &from = polygon[i], &to = polygon[(i + 1) % count];
                const double begin = glm::dot(from, planes[p]), end = glm::dot(to, planes[p]);
                if (begin >= 0.0) clipped[kept++] = from;
                if ((begin > 0.0 && end < 0.0) || (begin < 0.0 && end > 0.0))
                    clipped[kept++] = from + (to - from) * (begin / (begin - end));
            }
            polygon = clipped;
            count = kept;
        }
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 2; i < count; ++i)
            nearest = std::min(nearest, distanceToTriangle(polygon[0], polygon[i - 1], polygon[i]));
        return nearest > kOn * corners ? nearest : std::numeric_limits<double>::infinity();
    }
};

float distanceToBox(const Bounds& box, const glm::vec3& p) {
    return glm::length(glm::max(glm::max(box.min - p, p - box.max), glm::vec3(0.0f)));
}

void ask(const std::vector<Run>& runs, const Pose& pose, const SceneLight& light, float& nearest) {
    const Reach reach(light);
    for (const Run& run : runs) {
        if (!(distanceToBox(run.bounds, light.position) < nearest)) continue;
        const glm::dmat4& world = pose.worldFromObject[run.instance];
        for (std::size_t i = run.first; i + 2 < run.end; i += 3) {
            const auto corner = [&](std::size_t k) { return inWorld(world, (*run.positions)[(*run.indices)[i + k]]); };
            const double distance = reach.distanceTo(corner(0), corner(1), corner(2));
            nearest = std::min(nearest, static_cast<float>(distance));
        }
    }
}

}  // namespace

std::vector<float> nearestSurfaces(const Scene& scene, const std::vector<bool>& wanted) {
    std::vector<float> nearest(scene.lights.size(), kInfinity);
    std::vector<std::size_t> lights;
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        if (wanted[i] && scene.lights[i].kind != LightKind::Directional) lights.push_back(i);
    if (lights.empty()) return nearest;

    const bool animated = isAnimated(scene);
    const std::vector<bool> moves = movingInstances(scene);
    bool first = true;
    std::vector<Run> still;
    forEachPose(scene, kExtentSamples, [&](const Pose& pose) {
        if (first) still = runsOf(scene, pose, moves, false);
        const std::vector<Run> moving = runsOf(scene, pose, moves, true);
        for (const std::size_t i : lights) {
            const SceneLight& light = pose.lights[i];
            // Within the range, yet the range itself is no surface.
            float found = std::min(nearest[i], std::nextafter(light.rangeMetres, kInfinity));
            const float before = found;
            if (first || (animated && light.node != kNone)) ask(still, pose, light, found);
            ask(moving, pose, light, found);
            if (found < before) nearest[i] = found;
        }
        first = false;
    });
    return nearest;
}

}  // namespace gnomon::renderer
