// Building blocks of what grows and walks: tubes of changing section, and leaf cards.

#include "scene/builtin/shapes.h"

#include <cmath>

#include "scene/builtin/numbers.h"

namespace gnomon::renderer {

void ShapeBuilder::loft(std::span<const Ring> rings, int sides) {
    const auto first = static_cast<std::uint32_t>(vertexCount());
    const auto around = static_cast<std::uint32_t>(sides) + 1;
    const auto angleOf = [&](int k) { return kTau * static_cast<float>(k % sides) / static_cast<float>(sides); };
    const auto around2d = [&](std::size_t i, int k) {  // cosine and sine, folded
        const float a = angleOf(k), fold = std::cos(static_cast<float>(kLoftFolds) * a + 1.3f * std::sin(2.0f * a));
        return (1.0f + rings[i].folds * fold) * glm::vec2(std::cos(a), std::sin(a));
    };
    const auto at = [&](std::size_t i, int k) {
        const glm::vec2 d = around2d(i, k);
        return rings[i].centre + rings[i].across * d.x + rings[i].forward * d.y;
    };
    const float girth = kTau * glm::length(rings[rings.size() / 2].across);
    float arc = 0.0f;
    for (std::size_t i = 0; i < rings.size(); ++i) {
        const std::size_t before = i > 0 ? i - 1 : i, after = i + 1 < rings.size() ? i + 1 : i;
        if (i > 0) arc += glm::length(rings[i].centre - rings[before].centre);
        for (int k = 0; k <= sides; ++k) {
            const float u = static_cast<float>(k) / static_cast<float>(sides);
            const glm::vec3 tangent = at(i, (k + 1) % sides) - at(i, (k + sides - 1) % sides);
            vertex(at(i, k), glm::normalize(glm::cross(tangent, at(after, k) - at(before, k))), {u * girth, -arc});
        }
    }
    for (std::uint32_t i = 0; i + 1 < rings.size(); ++i) {
        for (std::uint32_t k = 0; k + 1 < around; ++k) {
            const std::uint32_t a = first + i * around + k, b = a + around;
            triangle(a, a + 1, b + 1);
            triangle(a, b + 1, b);
        }
    }
    // Caps are fans around the middle: a folded ring is no convex polygon.
    for (const std::size_t i : {std::size_t{0}, rings.size() - 1}) {
        glm::vec3 out = glm::normalize(glm::cross(rings[i].across, rings[i].forward));
        if (i == 0) out = -out;
        const std::uint32_t middle = vertex(rings[i].centre, out, {0.0f, 0.0f});
        for (int k = 0; k < sides; ++k) {
            const glm::vec3 p = at(i, k) - rings[i].centre;
            vertex(at(i, k), out,
                   {glm::dot(p, glm::normalize(rings[i].across)), glm::dot(p, glm::normalize(rings[i].forward))});
        }
        for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(sides); ++k) {
            const std::uint32_t a = middle + 1 + k, b = middle + 1 + (k + 1) % static_cast<std::uint32_t>(sides);
            i == 0 ? triangle(middle, b, a) : triangle(middle, a, b);
        }
    }
}

void ShapeBuilder::branch(std::span<const glm::vec3> path, std::span<const float> radii, int sides) {
    std::vector<Ring> rings;
    glm::vec3 across(1, 0, 0);
    for (std::size_t i = 0; i < path.size(); ++i) {
        const glm::vec3 forward = glm::normalize(path[i + 1 < path.size() ? i + 1 : i] - path[i > 0 ? i - 1 : i]);
        if (i == 0 && std::abs(forward.x) > 0.9f) across = {0, 0, 1};
        across = glm::normalize(across - forward * glm::dot(across, forward));  // carried along without twist
        rings.push_back({path[i], radii[i] * across, radii[i] * glm::cross(forward, across)});
    }
    loft(rings, sides);
}

void ShapeBuilder::card(const glm::vec3& root, const glm::vec3& up, const glm::vec3& side, const glm::vec3& outward) {
    glm::vec3 half = 0.5f * side;
    glm::vec3 face = glm::normalize(glm::cross(side, up));
    if (glm::dot(face, outward) < 0.0f) {  // the front looks outwards
        half = -half;
        face = -face;
    }
    const glm::vec3 normal = glm::normalize(face + 0.8f * glm::normalize(outward));
    const glm::vec3 p[4] = {root - half, root + half, root + half + up, root - half + up};
    smoothQuad(p, {normal, normal, normal, normal}, {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
}

}  // namespace gnomon::renderer
