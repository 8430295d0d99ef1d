#pragma once
// What tests of drawing share: a square, a camera above it, and reads of what was drawn.

#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <vector>

#include "renderer/gbuffer/gbuffer.h"

namespace gnomon::renderer {

// A square of 2x2 m in the plane z = 0 of object space, facing +z, as two triangles.
inline Mesh squareMesh() {
    Primitive square;
    square.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    square.indices = {0, 1, 2, 0, 2, 3};
    for (const glm::vec3& p : square.positions) square.bounds.add(p);
    return {"square", {square}};
}

inline glm::vec3 decodeOctahedral(std::uint32_t word) {
    const glm::vec2 e = glm::vec2(word & 0xFFFFu, word >> 16) / 65535.0f * 2.0f - 1.0f;
    glm::vec3 n(e, 1.0f - std::abs(e.x) - std::abs(e.y));
    const float fold = std::max(-n.z, 0.0f);
    n.x += n.x >= 0.0f ? -fold : fold;
    n.y += n.y >= 0.0f ? -fold : fold;
    return glm::normalize(n);
}

template <typename T>
std::vector<T> readAs(const Device& device, const GpuImage& image, std::uint32_t layer = 0) {
    const std::vector<std::uint8_t> bytes = readImage(device, image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, layer);
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

struct TestCamera {
    Camera camera;
    bool orthographic = false;
};

// Looks straight down from 4 m above the floor.
inline TestCamera cameraAbove(const glm::vec3& eye, bool orthographic, DeviceDepth depth) {
    TestCamera out;
    out.orthographic = orthographic;
    const glm::mat4 view = glm::lookAt(eye, eye - glm::vec3(0, 1, 0), glm::vec3(0, 0, -1));
    glm::mat4 clip(0.0f);
    const float n = 0.1f, f = 100.0f;
    const bool reversed = depth == DeviceDepth::ReversedZ;
    clip[0][0] = orthographic ? 0.25f : 1.0f;
    clip[1][1] = -clip[0][0];
    if (orthographic) {
        clip[2][2] = (reversed ? 1.0f : -1.0f) / (f - n);
        clip[3][2] = reversed ? f / (f - n) : -n / (f - n);
        clip[3][3] = 1.0f;
    } else {
        clip[2][3] = -1.0f;
        clip[2][2] = reversed ? 0.0f : -1.0f;
        clip[3][2] = reversed ? n : -n;  // infinite far
    }
    std::memcpy(out.camera.viewFromWorld, glm::value_ptr(view), 64);
    std::memcpy(out.camera.clipFromView, glm::value_ptr(clip), 64);
    out.camera.deviceDepth = depth;
    return out;
}

}  // namespace gnomon::renderer
