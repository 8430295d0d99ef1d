#include "scene.h"

#include <algorithm>
#include <cmath>

namespace host {
namespace {

struct Box {
    Vec3 low, high;
};
constexpr Box kBoxes[] = {
    {{-6, -0.2f, -4}, {6, 0, 5}},            // floor
    {{-6, -0.2f, -4.2f}, {6, 2.5f, -4}},     // back wall
    {{-2, 0, -0.6f}, {-0.8f, 1.2f, 0.6f}},   // cube
    {{0.9f, 0, -1.4f}, {1.3f, 2.2f, -1}},    // pillar
    {{1.8f, 0, 0.6f}, {3.2f, 0.4f, 1.8f}},   // slab
    {{-0.4f, 0.9f, 1}, {0.4f, 1.2f, 1.8f}},  // a box that floats
};

constexpr float kNearMetres = 0.05f;

// The face of a box on the low or the high side of an axis, as two triangles.
void addFace(const Box& box, int axis, bool high, std::vector<Vertex>& out) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    Vec3 normal = {};
    normal[axis] = high ? 1.0f : -1.0f;
    const auto corner = [&](bool highU, bool highV) {
        Vec3 p;
        p[axis] = high ? box.high[axis] : box.low[axis];
        p[u] = highU ? box.high[u] : box.low[u];
        p[v] = highV ? box.high[v] : box.low[v];
        out.push_back({p, normal});
    };
    corner(false, false), corner(true, false), corner(true, true);
    corner(false, false), corner(true, true), corner(false, true);
}

}  // namespace

Mat4 multiply(const Mat4& a, const Mat4& b) {
    Mat4 product = {};
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            for (int k = 0; k < 4; ++k) product[column * 4 + row] += a[k * 4 + row] * b[column * 4 + k];
    return product;
}

Mat4 lookAlong(const Vec3& eye, const Vec3& d) {
    const float length = std::hypot(d[0], d[1], d[2]), flat = std::hypot(d[0], d[2]);
    const Vec3 z = {-d[0] / length, -d[1] / length, -d[2] / length};
    const Vec3 x = flat > 0 ? Vec3{-d[2] / flat, 0, d[0] / flat} : Vec3{1, 0, 0};
    const Vec3 y = {z[1] * x[2], z[2] * x[0] - z[0] * x[2], -z[1] * x[0]};
    const Mat4 turn = {x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0, 0, 0, 0, 1};
    const Mat4 move = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -eye[0], -eye[1], -eye[2], 1};
    return multiply(turn, move);
}

Mat4 perspective(float tangentX, float tangentY, float nearMetres) {
    return {1 / tangentX, 0, 0, 0, 0, -1 / tangentY, 0, 0, 0, 0, 0, -1, 0, 0, nearMetres, 0};
}

Mat4 orthographic(float halfWidthMetres, float nearMetres, float farMetres) {
    const float scale = 1 / halfWidthMetres, depth = 1 / (farMetres - nearMetres);
    return {scale, 0, 0, 0, 0, -scale, 0, 0, 0, 0, depth, 0, 0, 0, farMetres * depth, 1};
}

std::vector<Vertex> sceneTriangles() {
    std::vector<Vertex> out;
    for (const Box& box : kBoxes)
        for (int axis = 0; axis < 3; ++axis)
            for (const bool high : {false, true}) addFace(box, axis, high, out);
    return out;
}

CasterBounds sceneCasters() {
    return {{0, 1, 0.5f}, 8};
}

gnomon::Camera sceneCamera(std::uint32_t widthPx, std::uint32_t heightPx) {
    constexpr float kTangentY = 0.4f;  // of half the vertical field of view
    gnomon::Camera camera;             // reversed z is its default
    const float aspect = static_cast<float>(widthPx) / static_cast<float>(heightPx);
    std::ranges::copy(lookAlong({0, 3.2f, 7.5f}, {0, -2.8f, -7.5f}), camera.viewFromWorld);
    std::ranges::copy(perspective(kTangentY * aspect, kTangentY, kNearMetres), camera.clipFromView);
    return camera;
}

Mat4 clipFromWorld(const gnomon::Camera& camera) {
    return multiply(std::to_array(camera.clipFromView), std::to_array(camera.viewFromWorld));
}

std::vector<gnomon::Light> sceneLights(std::uint64_t frameNumber) {
    using enum gnomon::LightType;
    // A lamp as wide as a football: its shadows have penumbrae, wider the farther the caster is from what it darkens.
    gnomon::Light warm;
    warm.type = Spot;
    warm.position[0] = -4, warm.position[1] = 4, warm.position[2] = 3;
    warm.direction[0] = 3, warm.direction[1] = -3.6f, warm.direction[2] = -3;
    warm.rangeMetres = 14;
    warm.sourceRadius = 0.15f;
    warm.filter = gnomon::Filter::Pcss;

    // Another spot, with shadows as sharp as its map: the cheapest filter, for lights that do not matter much.
    gnomon::Light cool;
    cool.type = Spot;
    cool.position[0] = 4, cool.position[1] = 4.5f, cool.position[2] = 2;
    cool.direction[0] = -3, cool.direction[1] = -4.5f, cool.direction[2] = -3;
    cool.rangeMetres = 14;
    cool.filter = gnomon::Filter::Hard;

    // A point light that moves, so that its six views are drawn anew in every frame while all others are kept.
    gnomon::Light lantern;
    lantern.type = Point;
    lantern.position[0] = -0.45f + 0.05f * static_cast<float>(frameNumber);
    lantern.position[1] = 1.8f, lantern.position[2] = -1.8f;
    lantern.rangeMetres = 7;
    lantern.filter = gnomon::Filter::Pcf;

    // A lamp that lights and casts no shadow. It is in the same lists, and costs no shadow view and no slot.
    gnomon::Light glow;
    glow.type = Point;
    glow.position[0] = 2.5f, glow.position[1] = 0.8f, glow.position[2] = 2.6f;
    glow.rangeMetres = 2.5f;
    glow.casts = false;

    // A moon. Directional lights have neither position nor range; one view holds all that this one can shade.
    gnomon::Light moon;
    moon.type = Directional;
    moon.direction[0] = 0.4f, moon.direction[1] = -1, moon.direction[2] = -0.5f;
    moon.sourceRadius = 0.01f;  // radians
    moon.filter = gnomon::Filter::Pcss;
    return {warm, cool, lantern, glow, moon};
}

std::vector<std::array<float, 4>> sceneIntensities() {
    return {{19, 14, 8, 0}, {5, 9, 17, 0}, {1.5f, 1.3f, 1.1f, 0}, {0.1f, 0.4f, 0.15f, 0}, {0.09f, 0.11f, 0.14f, 0}};
}

}  // namespace host
