// Triangles stand in a tree of boxes, split at the middle of the longest side of their centres; a ray visits every box
// it meets. Nothing clever: the largest scene here has 12,000 triangles.
#include "image/renderer/truth.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace gnomon::renderer::image_test {
namespace {

constexpr std::uint32_t kLeafTriangles = 4;
constexpr std::uint32_t kMostOpen = 64;  // halving 2^32 triangles down to one opens 33 at most

// Möller and Trumbore 1997.
std::optional<glm::dvec3> distanceAndBarycentrics(const Triangles::Triangle& t, const glm::dvec3& origin,
                                                  const glm::dvec3& direction) {
    const glm::dvec3 ab = t.b - t.a, ac = t.c - t.a;
    const glm::dvec3 p = glm::cross(direction, ac);
    const double determinant = glm::dot(ab, p);
    if (determinant == 0.0) return std::nullopt;
    const glm::dvec3 s = origin - t.a;
    const double u = glm::dot(s, p) / determinant;
    const glm::dvec3 q = glm::cross(s, ab);
    const double v = glm::dot(direction, q) / determinant;
    if (u < 0.0 || v < 0.0 || u + v > 1.0) return std::nullopt;
    return glm::dvec3(glm::dot(ac, q) / determinant, u, v);
}

// Nearest texel, repeated: what is nearer to a hole's edge than a texel counts as an edge anyway.
bool cutOut(const Triangles::Triangle& t, double u, double v) {
    if (t.mask == nullptr) return false;
    const glm::dvec2 uv = (1.0 - u - v) * t.uv[0] + u * t.uv[1] + v * t.uv[2];
    const glm::dvec2 wrapped = uv - glm::floor(uv);
    const auto x = std::min(static_cast<std::uint32_t>(wrapped.x * t.mask->width), t.mask->width - 1);
    const auto y = std::min(static_cast<std::uint32_t>(wrapped.y * t.mask->height), t.mask->height - 1);
    return t.mask->rgba8[4 * (std::size_t(y) * t.mask->width + x) + 3] < 255.0f * t.cutoff;
}

bool meetsBox(const glm::dvec3& min, const glm::dvec3& max, const glm::dvec3& origin, const glm::dvec3& direction,
              double reach) {
    double enter = 0.0, leave = reach;
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0) {
            if (origin[axis] < min[axis] || origin[axis] > max[axis]) return false;
            continue;
        }
        const double a = (min[axis] - origin[axis]) / direction[axis], b = (max[axis] - origin[axis]) / direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave * (1.0 + 1e-12);
}

void append(std::vector<Triangles::Triangle>& out, const Scene& scene, const Instance& instance,
            const Primitive& primitive) {
    const Material& material = scene.materials[primitive.material];
    const glm::dmat4 world(instance.worldFromObject);
    const bool mirrored = isMirrored(instance);
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
        Triangles::Triangle t;
        glm::dvec3* corners[] = {&t.a, &t.b, &t.c};
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t index = primitive.indices[i + (mirrored ? 2 - k : k)];
            *corners[k] = glm::dvec3(world * glm::dvec4(primitive.positions[index], 1.0));
            if (!primitive.texcoords[0].empty()) t.uv[k] = glm::dvec2(primitive.texcoords[0][index]);
        }
        t.singleSided = !material.doubleSided;
        if (material.alphaMode != AlphaMode::Opaque && material.baseColourTexture.image != kNone) {
            t.mask = &scene.images[material.baseColourTexture.image];
            t.cutoff = material.alphaCutoff;
        }
        out.push_back(t);
    }
}

}  // namespace

Triangles::Triangles(const Scene& scene) {
    for (const Instance& instance : scene.instances)
        for (const Primitive& primitive : scene.meshes[instance.mesh].primitives)
            append(triangles_, scene, instance, primitive);
    Node root;
    root.count = static_cast<std::uint32_t>(triangles_.size());
    nodes_.push_back(root);
    split(0);
}

void Triangles::split(std::uint32_t index) {
    const Node node = nodes_[index];
    const auto first = triangles_.begin() + node.first, last = first + node.count;
    glm::dvec3 min(INFINITY), max(-INFINITY), centreMin(INFINITY), centreMax(-INFINITY);
    for (auto t = first; t != last; ++t) {
        min = glm::min(min, glm::min(t->a, glm::min(t->b, t->c)));
        max = glm::max(max, glm::max(t->a, glm::max(t->b, t->c)));
        centreMin = glm::min(centreMin, t->a + t->b + t->c);
        centreMax = glm::max(centreMax, t->a + t->b + t->c);
    }
    nodes_[index].min = min;
    nodes_[index].max = max;
    if (node.count <= kLeafTriangles) return;
    const glm::dvec3 size = centreMax - centreMin;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t half = node.count / 2;
    std::nth_element(first, first + half, last, [axis](const Triangle& a, const Triangle& b) {
        return a.a[axis] + a.b[axis] + a.c[axis] < b.a[axis] + b.b[axis] + b.c[axis];
    });
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_[index].first = child;
    nodes_[index].count = 0;
    nodes_.push_back({{}, {}, node.first, half});
    nodes_.push_back({{}, {}, node.first + half, node.count - half});
    split(child);
    split(child + 1);
}

// Calls visit(triangle index, distance in lengths of `direction`) until it returns true.
template <class Visit>
void Triangles::walk(const glm::dvec3& origin, const glm::dvec3& direction, const double& reach, Visit visit) const {
    std::uint32_t open[kMostOpen] = {0}, count = 1;
    while (count > 0) {
        const Node& node = nodes_[open[--count]];
        if (!meetsBox(node.min, node.max, origin, direction, reach)) continue;
        if (node.count == 0) {
            open[count++] = node.first;
            open[count++] = node.first + 1;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const auto hit = distanceAndBarycentrics(triangles_[i], origin, direction);
            if (!hit || hit->x <= 0.0 || hit->x >= reach || cutOut(triangles_[i], hit->y, hit->z)) continue;
            if (visit(i, hit->x)) return;
        }
    }
}

Triangles::Hit Triangles::nearest(const glm::dvec3& origin, const glm::dvec3& direction) const {
    Hit best;
    double reach = INFINITY;
    if (triangles_.empty()) return best;
    walk(origin, direction, reach, [&](std::uint32_t i, double distance) {
        const Triangle& t = triangles_[i];
        const bool fromBehind = glm::dot(glm::cross(t.b - t.a, t.c - t.a), direction) >= 0.0;
        if (t.singleSided && fromBehind) return false;
        best = {distance, i};
        reach = distance;
        return false;
    });
    return best;
}

bool Triangles::blocked(const glm::dvec3& from, const glm::dvec3& to, std::uint32_t except) const {
    bool found = false;
    walk(from, to - from, 1.0, [&](std::uint32_t i, double) { return found = i != except; });
    return found;
}

namespace {

struct PixelRay {
    glm::dvec3 origin, direction;  // the direction reaches a view depth of one metre
    double pixelMetresPerDepth;
};

PixelRay rayOf(const SceneCamera& camera, double x, double y, std::uint32_t widthPx, std::uint32_t heightPx) {
    const glm::dmat4 world(camera.worldFromCamera);
    const double half = std::tan(0.5 * static_cast<double>(camera.verticalFieldOfView));
    const double scale = 2.0 * half / heightPx;
    const glm::dvec3 view((x + 0.5 - 0.5 * widthPx) * scale, (0.5 * heightPx - y - 0.5) * scale, -1.0);
    return {glm::dvec3(world[3]), glm::dvec3(world * glm::dvec4(view, 0.0)), scale};
}

bool reaches(const SceneLight& light, const glm::dvec3& p) {
    const glm::dvec3 d = p - glm::dvec3(light.position);
    // A hair inside range and cone, where float and double agree; the light is next to nothing there.
    if (glm::length(d) > 0.999 * light.rangeMetres) return false;
    return light.kind != LightKind::Spot ||
           glm::dot(glm::normalize(d), glm::dvec3(light.direction)) > std::cos(0.999 * light.outerConeAngle);
}

// Width of a texel one metre away: a face of 90 degrees, or the cone; the guard texels add next to nothing.
double texelMetresPerMetre(const SceneLight& light, std::uint32_t shadowSizePx) {
    const double half = light.kind == LightKind::Point ? 1.0 : std::tan(static_cast<double>(light.outerConeAngle));
    return 2.0 * half / shadowSizePx;
}

// Two rings of points on p's face plane which, seen from the light, are circles: a texel falls on a slanted face as a long
// strip. The plane is taken to slant by at most 84 degrees.
Truth unanimous(const Triangles& triangles, const glm::dvec3& light, const glm::dvec3& p, const glm::dvec3& normal,
                std::uint32_t own, double radius) {
    const bool dark = triangles.blocked(p, light, own);
    const glm::dvec3 toLight = glm::normalize(light - p);
    const glm::dvec3 axis = std::abs(toLight.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 side = glm::normalize(glm::cross(toLight, axis)), other = glm::cross(toLight, side);
    const double cosine = std::max(glm::dot(toLight, normal), 0.1);
    for (int i = 0; i < 16; ++i) {
        const double angle = std::numbers::pi * i / 4.0, r = i < 8 ? radius : 0.5 * radius;
        const glm::dvec3 o = r * (std::cos(angle) * side + std::sin(angle) * other);
        const glm::dvec3 q = p + o - toLight * (glm::dot(o, normal) / cosine);
        if (triangles.blocked(q, light, own) != dark) return Truth::Edge;
    }
    return dark ? Truth::Dark : Truth::Lit;
}

}  // namespace

std::vector<Truth> truthOf(const Scene& scene, const SceneCamera& camera, std::uint32_t widthPx, std::uint32_t heightPx,
                           double texels, std::uint32_t shadowSizePx) {
    const Triangles triangles(scene);
    const SceneLight& light = scene.lights.at(0);
    std::vector<Truth> out(std::size_t(widthPx) * heightPx, Truth::Background);
    for (std::uint32_t y = 0; y < heightPx; ++y) {
        for (std::uint32_t x = 0; x < widthPx; ++x) {
            const PixelRay ray = rayOf(camera, x, y, widthPx, heightPx);
            const Triangles::Hit hit = triangles.nearest(ray.origin, ray.direction);
            if (hit.triangle == kNone) continue;
            const glm::dvec3 p = ray.origin + hit.distance * ray.direction;
            const Triangles::Triangle& t = triangles[hit.triangle];
            glm::dvec3 normal = glm::normalize(glm::cross(t.b - t.a, t.c - t.a));
            if (glm::dot(normal, ray.direction) > 0.0) normal = -normal;  // the side the camera sees
            Truth& truth = out[std::size_t(y) * widthPx + x];
            const glm::dvec3 toLight = glm::dvec3(light.position) - p;
            const double facing = glm::dot(normal, glm::normalize(toLight));
            if (!reaches(light, p)) {
                truth = Truth::Unlit;
            } else if (std::abs(facing) < 1e-3) {
                truth = Truth::Edge;  // the stored normal has 16 bits
            } else if (facing < 0.0) {
                truth = Truth::Dark;
            } else {
                const double texel = texelMetresPerMetre(light, shadowSizePx) * glm::length(toLight);
                const double radius = std::max(2.0 * ray.pixelMetresPerDepth * hit.distance, texels * texel);
                truth = unanimous(triangles, glm::dvec3(light.position), p, normal, hit.triangle, radius);
            }
        }
    }
    return out;
}

}  // namespace gnomon::renderer::image_test
