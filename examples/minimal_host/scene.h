#pragma once
// The scene: white boxes, five lights and a camera. Metres, right-handed, y is up; matrices are column-major and named
// destination-from-source, as the library wants them.

#include <gnomon/scene.h>

#include <array>
#include <cstdint>
#include <vector>

namespace host {

using Vec3 = std::array<float, 3>;
using Mat4 = std::array<float, 16>;

Mat4 multiply(const Mat4& a, const Mat4& b);
/// viewFromWorld of a view that looks from `eye` along `direction`, down its -z axis.
Mat4 lookAlong(const Vec3& eye, const Vec3& direction);
/// clipFromView with reversed z and without a far plane: device depth = near / distance. Vulkan's y points down.
/// Reversed z keeps the depth's precision where floats have it, so the near plane may be as near as you like.
Mat4 perspective(float tangentX, float tangentY, float nearMetres);
/// clipFromView with reversed z: 1 at the near plane, 0 at the far plane.
Mat4 orthographic(float halfWidthMetres, float nearMetres, float farMetres);

struct Vertex {
    Vec3 position;
    Vec3 normal;
};
/// Three per triangle.
std::vector<Vertex> sceneTriangles();

/// Where everything is that casts a shadow: what a cascade of a directional light must hold.
struct CasterBounds {
    Vec3 centre;
    float radiusMetres;
};
CasterBounds sceneCasters();

gnomon::Camera sceneCamera(std::uint32_t widthPx, std::uint32_t heightPx);
Mat4 clipFromWorld(const gnomon::Camera& camera);

/// All of the scene's lights, as the library wants them. One of them moves.
std::vector<gnomon::Light> sceneLights(std::uint64_t frameNumber);
/// What the library need not know of them: candela (lux for the directional one), in the same order.
std::vector<std::array<float, 4>> sceneIntensities();

}  // namespace host
