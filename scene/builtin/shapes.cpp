#include "scene/builtin/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "scene/builtin/numbers.h"

namespace gnomon::renderer {
namespace {

constexpr float kSharpCosine = 0.766f;  // 40 degrees: corners sharper than this keep separate normals

// Box projection: u to the right and v downwards for a viewer in front of the face.
glm::vec2 boxUv(const glm::vec3& p, const glm::vec3& n) {
    const glm::vec3 a = glm::abs(n);
    if (a.y >= a.x && a.y >= a.z) return {p.x, n.y > 0.0f ? p.z : -p.z};
    if (a.x >= a.z) return {n.x > 0.0f ? -p.z : p.z, -p.y};
    return {n.z > 0.0f ? p.x : -p.x, -p.y};
}

glm::vec3 turned(glm::vec2 radiusAndHeight, float angle) {
    return {radiusAndHeight.x * std::cos(angle), radiusAndHeight.y, radiusAndHeight.x * std::sin(angle)};
}

// Unit normals around every point of a path, carried along it without twist.
std::vector<std::vector<glm::vec3>> tubeNormals(std::span<const glm::vec3> path, int sides) {
    const auto direction = [&](std::size_t i) {
        const std::size_t before = i > 0 ? i - 1 : i, after = i + 1 < path.size() ? i + 1 : i;
        return glm::normalize(path[after] - path[before]);
    };
    glm::vec3 across = std::abs(direction(0).y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    std::vector<std::vector<glm::vec3>> normals(path.size());
    for (std::size_t i = 0; i < path.size(); ++i) {
        const glm::vec3 forward = direction(i);
        across = glm::normalize(across - forward * glm::dot(across, forward));  // transported without twist
        const glm::vec3 side = glm::cross(forward, across);
        for (int k = 0; k < sides; ++k) {
            const float angle = kTau * static_cast<float>(k) / static_cast<float>(sides);
            normals[i].push_back(across * std::cos(angle) + side * std::sin(angle));
        }
    }
    return normals;
}

}  // namespace

std::uint32_t ShapeBuilder::vertex(const glm::vec3& position, const glm::vec3& normal, const glm::vec2& uv) {
    primitive_.positions.push_back(glm::vec3(transform_ * glm::vec4(position, 1.0f)));
    primitive_.normals.push_back(glm::normalize(glm::mat3(transform_) * normal));
    primitive_.texcoords[0].push_back(uv);
    return static_cast<std::uint32_t>(primitive_.positions.size() - 1);
}

void ShapeBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    primitive_.indices.insert(primitive_.indices.end(), {a, b, c});
}

void ShapeBuilder::polygon(std::span<const glm::vec3> corners) {
    const glm::vec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    const auto first = static_cast<std::uint32_t>(primitive_.positions.size());
    for (const glm::vec3& corner : corners) vertex(corner, normal, boxUv(corner, normal));
    for (std::uint32_t i = 2; i < corners.size(); ++i) triangle(first, first + i - 1, first + i);
}

void ShapeBuilder::quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
    polygon(std::array{a, b, c, d});
}

void ShapeBuilder::box(const glm::vec3& l, const glm::vec3& h, unsigned faces) {
    if (faces & kLeft) quad({l.x, l.y, l.z}, {l.x, l.y, h.z}, {l.x, h.y, h.z}, {l.x, h.y, l.z});
    if (faces & kRight) quad({h.x, l.y, h.z}, {h.x, l.y, l.z}, {h.x, h.y, l.z}, {h.x, h.y, h.z});
    if (faces & kBottom) quad({l.x, l.y, l.z}, {h.x, l.y, l.z}, {h.x, l.y, h.z}, {l.x, l.y, h.z});
    if (faces & kTop) quad({l.x, h.y, h.z}, {h.x, h.y, h.z}, {h.x, h.y, l.z}, {l.x, h.y, l.z});
    if (faces & kBack) quad({h.x, l.y, l.z}, {l.x, l.y, l.z}, {l.x, h.y, l.z}, {h.x, h.y, l.z});
    if (faces & kFront) quad({l.x, l.y, h.z}, {h.x, l.y, h.z}, {h.x, h.y, h.z}, {l.x, h.y, h.z});
}

void ShapeBuilder::smoothQuad(const glm::vec3 (&p)[4], const glm::vec3 (&n)[4], const glm::vec2 (&uv)[4]) {
    const std::uint32_t a = vertex(p[0], n[0], uv[0]), b = vertex(p[1], n[1], uv[1]);
    const std::uint32_t c = vertex(p[2], n[2], uv[2]), d = vertex(p[3], n[3], uv[3]);
    triangle(a, b, c);
    triangle(a, c, d);
}

void ShapeBuilder::latheBand(glm::vec2 low, glm::vec2 high, glm::vec2 normalLow, glm::vec2 normalHigh, float arcLow,
                             float arcHigh, float girth, int sides, bool faceted) {
    const auto first = static_cast<std::uint32_t>(primitive_.positions.size());
    for (int side = 0; side < sides; ++side) {
        const float middle = kTau * (static_cast<float>(side) + 0.5f) / static_cast<float>(sides);
        for (int end = 0; end < 2; ++end) {
            const float fraction = static_cast<float>(side + end) / static_cast<float>(sides);
            const float angle = side + end == sides ? 0.0f : kTau * fraction;
            // On a faceted body the height part of the normal is steeper than the profile's: the apothem is shorter.
            const float shrink = std::cos(0.5f * kTau / static_cast<float>(sides));
            const auto normal = [&](glm::vec2 n) {
                return faceted ? glm::normalize(turned({n.x, n.y * shrink}, middle)) : turned(n, angle);
            };
            // u grows to the right for a viewer outside: against the angle.
            vertex(turned(low, angle), normal(normalLow), {-fraction * girth, -arcLow});
            vertex(turned(high, angle), normal(normalHigh), {-fraction * girth, -arcHigh});
        }
    }
    for (int side = 0; side < sides; ++side) {
        const std::uint32_t v = first + static_cast<std::uint32_t>(side) * 4;
        if (high.x > 0.0f) triangle(v, v + 1, v + 3);
        if (low.x > 0.0f) triangle(v, v + 3, v + 2);
    }
}

void ShapeBuilder::lathe(std::span<const glm::vec2> profile, int sides, bool faceted) {
    const std::size_t count = profile.size() - 1;
    std::vector<glm::vec2> normals(count);
    float widest = 0.0f, arc = 0.0f;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec2 along = glm::normalize(profile[i + 1] - profile[i]);
        normals[i] = {along.y, -along.x};
        widest = std::max({widest, profile[i].x, profile[i + 1].x});
    }
    const auto blend = [&](std::size_t i, std::size_t j) {
        return glm::dot(normals[i], normals[j]) > kSharpCosine ? glm::normalize(normals[i] + normals[j]) : normals[i];
    };
    for (std::size_t i = 0; i < count; ++i) {
        const float length = glm::length(profile[i + 1] - profile[i]);
        const glm::vec2 low = i > 0 ? blend(i, i - 1) : normals[i];
        const glm::vec2 high = i + 1 < count ? blend(i, i + 1) : normals[i];
        latheBand(profile[i], profile[i + 1], low, high, arc, arc + length, kTau * widest, sides, faceted);
        arc += length;
    }
}

void ShapeBuilder::sphere(const glm::vec3& centre, float radius, int rings, int sides) {
    std::vector<glm::vec2> profile;
    for (int i = 0; i <= rings; ++i) {
        const float angle = 0.5f * kTau * static_cast<float>(i) / static_cast<float>(rings);
        const bool pole = i == 0 || i == rings;
        profile.emplace_back(pole ? 0.0f : radius * std::sin(angle), -radius * std::cos(angle));
    }
    const auto first = primitive_.positions.size();
    const glm::mat4 before = transform_;
    transform_ = glm::translate(before, centre);
    lathe(profile, sides);
    // Exact normals instead of the profile's averages.
    const glm::vec3 middle(transform_ * glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    for (std::size_t i = first; i < primitive_.positions.size(); ++i)
        primitive_.normals[i] = glm::normalize(primitive_.positions[i] - middle);
    transform_ = before;
}

void ShapeBuilder::tube(std::span<const glm::vec3> path, float radius, int sides) {
    const std::vector<std::vector<glm::vec3>> normals = tubeNormals(path, sides);
    float along = 0.0f;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        const float length = glm::length(path[i + 1] - path[i]);
        for (int k = 0; k < sides; ++k) {
            const auto l = static_cast<std::size_t>((k + 1) % sides), r = static_cast<std::size_t>(k);
            const glm::vec3 n[4] = {normals[i][r], normals[i][l], normals[i + 1][l], normals[i + 1][r]};
            const glm::vec3 p[4] = {path[i] + radius * n[0], path[i] + radius * n[1], path[i + 1] + radius * n[2],
                                    path[i + 1] + radius * n[3]};
            const float u = radius * kTau / static_cast<float>(sides), k0 = static_cast<float>(k);
            smoothQuad(
                p, n,
                {{k0 * u, -along}, {(k0 + 1) * u, -along}, {(k0 + 1) * u, -along - length}, {k0 * u, -along - length}});
        }
        along += length;
    }
    std::vector<glm::vec3> start, end;
    for (int k = 0; k < sides; ++k) {
        end.push_back(path.back() + radius * normals.back()[static_cast<std::size_t>(k)]);
        start.push_back(path[0] + radius * normals[0][static_cast<std::size_t>(sides - 1 - k)]);
    }
    polygon(start);
    polygon(end);
}

void ShapeBuilder::sheet(const std::function<glm::vec3(float, float)>& position, int columns, int rows,
                         float widthMetres, float heightMetres) {
    const auto first = static_cast<std::uint32_t>(primitive_.positions.size());
    constexpr float kStep = 0.004f;  // of the parameter: for the normal's differences
    for (int row = 0; row <= rows; ++row) {
        for (int column = 0; column <= columns; ++column) {
            const float u = static_cast<float>(column) / static_cast<float>(columns);
            const float v = static_cast<float>(row) / static_cast<float>(rows);
            const glm::vec3 du = position(u + kStep, v) - position(u - kStep, v);
            const glm::vec3 dv = position(u, v + kStep) - position(u, v - kStep);
            vertex(position(u, v), glm::normalize(glm::cross(dv, du)), {u * widthMetres, v * heightMetres});
        }
    }
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const std::uint32_t a = first + static_cast<std::uint32_t>(row * (columns + 1) + column);
            const std::uint32_t below = a + static_cast<std::uint32_t>(columns) + 1;
            triangle(a, below, below + 1);
            triangle(a, below + 1, a + 1);
        }
    }
}

Primitive ShapeBuilder::take() {
    for (std::uint32_t index : primitive_.indices) primitive_.bounds.add(primitive_.positions[index]);
    Primitive done = std::move(primitive_);
    primitive_ = Primitive{};
    primitive_.material = done.material;
    transform_ = glm::mat4(1.0f);
    return done;
}

glm::mat4 placed(const glm::vec3& position, float turnRadians, float scale) {
    const glm::mat4 moved = glm::translate(glm::mat4(1.0f), position);
    return glm::scale(glm::rotate(moved, turnRadians, glm::vec3(0, 1, 0)), glm::vec3(scale));
}

std::uint32_t SceneBuilder::image(Image image) {
    scene.images.push_back(std::move(image));
    return static_cast<std::uint32_t>(scene.images.size() - 1);
}

std::uint32_t SceneBuilder::material(Material material) {
    scene.materials.push_back(std::move(material));
    return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

std::uint32_t SceneBuilder::mesh(std::string name, std::vector<Primitive> primitives) {
    scene.meshes.push_back({std::move(name), std::move(primitives)});
    return static_cast<std::uint32_t>(scene.meshes.size() - 1);
}

void SceneBuilder::place(std::uint32_t mesh, const glm::mat4& worldFromObject) {
    scene.instances.push_back({scene.meshes[mesh].name, mesh, worldFromObject});
}

void SceneBuilder::place(std::string name, ShapeBuilder& shape, const glm::mat4& worldFromObject) {
    std::vector<Primitive> primitives;
    primitives.push_back(shape.take());
    place(mesh(std::move(name), std::move(primitives)), worldFromObject);
}

void SceneBuilder::camera(std::string name, const glm::vec3& eye, const glm::vec3& target, float verticalFieldOfView) {
    SceneCamera camera;
    camera.name = std::move(name);
    camera.worldFromCamera = lookingAt(eye, target);
    camera.verticalFieldOfView = verticalFieldOfView;
    scene.cameras.push_back(std::move(camera));
}

}  // namespace gnomon::renderer
