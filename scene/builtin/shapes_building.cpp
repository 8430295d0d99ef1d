// The larger building blocks: walls with arches, and rings of mitred prisms.

#include "scene/builtin/shapes.h"

#include <cmath>

namespace gnomon::renderer {
namespace {

// Unit direction of arc point i of n, from the left springing (i = 0) over the crown to the right one (i = n).
glm::vec2 arcDirection(int i, int n) {
    if (i == 0) return {-1.0f, 0.0f};
    if (i == n) return {1.0f, 0.0f};
    const float angle = 3.14159265359f * static_cast<float>(i) / static_cast<float>(n);
    return {-std::cos(angle), std::sin(angle)};
}

}  // namespace

void ShapeBuilder::archFace(const Arch& arch, float z) {
    const bool front = z > 0.0f;
    const auto panel = [&](glm::vec2 a, glm::vec2 b, glm::vec2 c, glm::vec2 d) {  // counter-clockwise from +z
        const glm::vec3 p[4] = {{a, z}, {b, z}, {c, z}, {d, z}};
        front ? quad(p[0], p[1], p[2], p[3]) : quad(p[3], p[2], p[1], p[0]);
    };
    const float half = 0.5f * arch.width, r = arch.radius, low = arch.springing, high = arch.top;
    panel({-half, low}, {-r, low}, {-r, high}, {-half, high});
    panel({r, low}, {half, low}, {half, high}, {r, high});
    for (int i = 0; i < arch.segments; ++i) {
        const glm::vec2 a = r * arcDirection(i, arch.segments), b = r * arcDirection(i + 1, arch.segments);
        panel({a.x, low + a.y}, {b.x, low + b.y}, {b.x, high}, {a.x, high});
    }
}

void ShapeBuilder::archRing(const Arch& arch, float direction) {
    const float wall = direction * 0.5f * arch.thickness, face = wall + direction * arch.relief;
    const float inner = arch.radius, outer = arch.radius + arch.ringWidth;
    const auto at = [&](glm::vec2 d, float radius, float z) {
        return glm::vec3(radius * d.x, arch.springing + radius * d.y, z);
    };
    const auto flat = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
        direction > 0.0f ? quad(a, b, c, d) : quad(d, c, b, a);
    };
    for (int i = 0; i < arch.segments; ++i) {
        const glm::vec2 a = arcDirection(i, arch.segments), b = arcDirection(i + 1, arch.segments);
        flat(at(a, inner, face), at(b, inner, face), at(b, outer, face), at(a, outer, face));
        flat(at(a, outer, face), at(b, outer, face), at(b, outer, wall), at(a, outer, wall));
        flat(at(b, inner, face), at(a, inner, face), at(a, inner, wall), at(b, inner, wall));
    }
    const glm::vec2 left = arcDirection(0, 1), right = arcDirection(1, 1);
    flat(at(left, outer, wall), at(left, inner, wall), at(left, inner, face), at(left, outer, face));
    flat(at(right, inner, wall), at(right, outer, wall), at(right, outer, face), at(right, inner, face));
}

void ShapeBuilder::arch(const Arch& arch) {
    const float half = 0.5f * arch.thickness, r = arch.radius, low = arch.springing, edge = 0.5f * arch.width;
    archFace(arch, half);
    archFace(arch, -half);
    for (int i = 0; i < arch.segments; ++i) {  // the intrados, smooth
        const glm::vec2 a = arcDirection(i, arch.segments), b = arcDirection(i + 1, arch.segments);
        const glm::vec3 left(r * a.x, low + r * a.y, 0.0f), right(r * b.x, low + r * b.y, 0.0f), deep(0.0f, 0.0f, half);
        const glm::vec3 na(-a, 0.0f), nb(-b, 0.0f);
        const float step = 3.14159265359f * r / static_cast<float>(arch.segments), s = step * static_cast<float>(i);
        smoothQuad({left + deep, left - deep, right - deep, right + deep}, {na, na, nb, nb},
                   {{half, s}, {-half, s}, {-half, s + step}, {half, s + step}});
    }
    quad({-edge, low, -half}, {-r, low, -half}, {-r, low, half}, {-edge, low, half});
    quad({r, low, -half}, {edge, low, -half}, {edge, low, half}, {r, low, half});
    if (arch.relief > 0.0f) {
        archRing(arch, 1.0f);
        archRing(arch, -1.0f);
    }
}

void ShapeBuilder::mitred(const Mitred& s) {
    const float f = s.halfLength - s.front, b = s.halfLength - s.back;
    const glm::vec3 topFrontLeft(-f, s.topFront, s.front), topFrontRight(f, s.topFront, s.front);
    const glm::vec3 topBackLeft(-b, s.topBack, s.back), topBackRight(b, s.topBack, s.back);
    const glm::vec3 lowFrontLeft(-f, s.bottomFront, s.front), lowFrontRight(f, s.bottomFront, s.front);
    const glm::vec3 lowBackLeft(-b, s.bottomBack, s.back), lowBackRight(b, s.bottomBack, s.back);
    quad(topFrontLeft, topFrontRight, topBackRight, topBackLeft);
    quad(lowFrontLeft, lowFrontRight, topFrontRight, topFrontLeft);
    quad(lowBackRight, lowBackLeft, topBackLeft, topBackRight);
    if (s.bottom) quad(lowBackLeft, lowBackRight, lowFrontRight, lowFrontLeft);
}

}  // namespace gnomon::renderer
