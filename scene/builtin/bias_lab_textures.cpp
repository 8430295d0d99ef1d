// Pictures of the bias lab.

#include "scene/builtin/bias_lab.h"
#include "scene/builtin/numbers.h"
#include "scene/random.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace gnomon::renderer::lab {
namespace {

// sRGB and alpha, 0 to 1, at the middle of every texel of the unit square.
Image painted(std::uint32_t size, const std::function<glm::vec4(float, float)>& texelAt) {
    Image image;
    image.width = image.height = size;
    for (std::uint32_t y = 0; y < size; ++y) {
        for (std::uint32_t x = 0; x < size; ++x) {
            const glm::vec4 texel = texelAt((static_cast<float>(x) + 0.5f) / static_cast<float>(size),
                                            (static_cast<float>(y) + 0.5f) / static_cast<float>(size));
            for (int c = 0; c < 4; ++c)
                image.rgba8.push_back(static_cast<std::uint8_t>(std::clamp(texel[c], 0.0f, 1.0f) * 255.0f + 0.5f));
        }
    }
    return image;
}

// Distance to the nearest whole number of `parts` to the unit.
float toLine(float v, float parts) {
    const float scaled = v * parts;
    return std::abs(scaled - std::round(scaled)) / parts;
}

}  // namespace

Image paintGrid(std::uint32_t size) {
    return painted(size, [=](float u, float v) {
        const float metre = std::min(toLine(u, 1.0f), toLine(v, 1.0f));
        const float quarter = std::min(toLine(u, 4.0f), toLine(v, 4.0f));
        const float wide = 1.0f - smooth(0.005f, 0.007f, metre), fine = 1.0f - smooth(0.001f, 0.0025f, quarter);
        const auto cell = static_cast<float>(size);
        const float grain = hashUnit(static_cast<std::uint32_t>(u * cell), static_cast<std::uint32_t>(v * cell), 3);
        const glm::vec3 ground = glm::vec3(0.66f, 0.66f, 0.65f) * (0.985f + 0.03f * grain);
        return glm::vec4(glm::mix(ground, glm::vec3(0.36f, 0.39f, 0.42f), std::max(wide, 0.45f * fine)), 1.0f);
    });
}

// A net of threads with a flower in the middle of every repeat, a smaller one at its corners, and picots around them.
Image paintLace(std::uint32_t size) {
    constexpr float kMesh = 14.0f, kThread = 0.0062f;  // of a repeat of 0.4 m: meshes of 20 mm, threads of 5 mm
    struct Flower {
        float inside, solid;  // positive within its outline, and where it is not pierced
    };
    const auto flower = [](float x, float y, float radius) {
        const float r = std::sqrt(x * x + y * y) / radius, a = std::atan2(y, x);
        const float outline = 0.74f + 0.26f * std::cos(8.0f * a) - r;
        const float sector = a - std::round(a * 4.0f / kPi) * kPi / 4.0f;  // from the middle of the petal
        const float px = r * std::cos(sector) - 0.68f, py = r * std::sin(sector);
        const float petalHole = 0.15f - std::sqrt(0.45f * px * px + 3.0f * py * py);
        const float heart = 0.055f - std::abs(r - 0.27f);
        const float spokes = 0.024f - std::abs(r * std::sin(sector));
        const float core = r < 0.27f ? std::max(spokes, 0.07f - r) : outline;
        const float bands = r < 0.40f ? std::max(heart, core) : outline;
        return Flower{radius * outline, radius * std::min({bands, outline, -petalHole})};
    };
    return painted(size, [=](float u, float v) {
        const auto thread = [=](float w) { return kThread - std::abs(w - std::round(w)) / (1.41421356f * kMesh); };
        const Flower large = flower(u - 0.5f, v - 0.5f, 0.36f),
                     small = flower(u - std::round(u), v - std::round(v), 0.21f);
        float solid = std::max(thread((u + v) * kMesh), thread((u - v) * kMesh));
        if (large.inside > 0.0f || small.inside > 0.0f) solid = std::max(large.solid, small.solid);
        for (int k = 0; k < 8; ++k) {
            const float a = kPi * (static_cast<float>(k) + 0.5f) / 4.0f;
            const float x = u - 0.5f - 0.34f * std::cos(a), y = v - 0.5f - 0.34f * std::sin(a);
            solid = std::max(solid, 0.02f - std::sqrt(x * x + y * y));
        }
        return glm::vec4(0.90f, 0.87f, 0.80f, smooth(-0.0012f, 0.0012f, solid));
    });
}

Image paintLeaf(std::uint32_t size) {
    return painted(size, [](float u, float v) {
        const float across = std::abs(u - 0.5f);
        const float rib = 1.0f - smooth(0.008f, 0.03f, across);
        const float vein = smooth(0.86f, 1.0f, std::sin((v - 0.9f * across) * 62.0f));
        const glm::vec3 green = glm::mix(glm::vec3(0.30f, 0.50f, 0.20f), glm::vec3(0.40f, 0.60f, 0.24f), across * 2.0f);
        return glm::vec4(glm::mix(green, glm::vec3(0.56f, 0.68f, 0.38f), std::max(rib, 0.4f * vein)), 1.0f);
    });
}

}  // namespace gnomon::renderer::lab
