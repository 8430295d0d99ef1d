#include "scene/builtin/procedural_textures.h"

#include "scene/builtin/numbers.h"
#include "scene/random.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace gnomon::renderer {
namespace {

struct Texel {
    float heightMetres;
    glm::vec3 colour;  // sRGB, 0 to 1
    float roughness;
};

std::uint8_t toByte(float v) {
    return static_cast<std::uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255.0f + 0.5f);
}

// Value noise that repeats after `cellsU` by `cellsV` cells over the unit square.
float noise(float u, float v, int cellsU, int cellsV, std::uint32_t seed) {
    const float x = u * static_cast<float>(cellsU), y = v * static_cast<float>(cellsV);
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const float fx = smooth(0, 1, x - static_cast<float>(x0)), fy = smooth(0, 1, y - static_cast<float>(y0));
    const auto at = [&](int i, int j) {
        const int wrapped_i = ((i % cellsU) + cellsU) % cellsU, wrapped_j = ((j % cellsV) + cellsV) % cellsV;
        return hashUnit(static_cast<std::uint32_t>(wrapped_i), static_cast<std::uint32_t>(wrapped_j), seed);
    };
    const float low = at(x0, y0) * (1 - fx) + at(x0 + 1, y0) * fx;
    const float high = at(x0, y0 + 1) * (1 - fx) + at(x0 + 1, y0 + 1) * fx;
    return low * (1 - fy) + high * fy;
}

// Four octaves, 0 to 1.
float clouds(float u, float v, int cells, std::uint32_t seed) {
    float sum = 0.0f, weight = 0.5f;
    for (std::uint32_t octave = 0; octave < 4; ++octave, weight *= 0.5f, cells *= 2)
        sum += weight * noise(u, v, cells, cells, seed + octave);
    return sum / 0.9375f;
}

PaintedTexture paint(std::uint32_t size, float metres, const std::function<Texel(float, float)>& texelAt) {
    PaintedTexture painted;
    painted.metres = metres;
    for (Image* image : {&painted.colour, &painted.normal, &painted.metallicRoughness}) {
        image->width = image->height = size;
        image->rgba8.assign(std::size_t(size) * size * 4, 255);
    }
    std::vector<float> heights(std::size_t(size) * size);
    for (std::uint32_t y = 0; y < size; ++y) {
        for (std::uint32_t x = 0; x < size; ++x) {
            const std::size_t i = std::size_t(y) * size + x;
            const Texel texel = texelAt((static_cast<float>(x) + 0.5f) / static_cast<float>(size),
                                        (static_cast<float>(y) + 0.5f) / static_cast<float>(size));
            heights[i] = texel.heightMetres;
            for (int c = 0; c < 3; ++c) painted.colour.rgba8[i * 4 + std::size_t(c)] = toByte(texel.colour[c]);
            painted.metallicRoughness.rgba8[i * 4 + 1] = toByte(texel.roughness);
            painted.metallicRoughness.rgba8[i * 4 + 2] = 0;
        }
    }
    const float texelsPerMetre = static_cast<float>(size) / metres;
    const auto height = [&](std::uint32_t x, std::uint32_t y) {
        return heights[std::size_t(y % size) * size + x % size];
    };
    for (std::uint32_t y = 0; y < size; ++y) {
        for (std::uint32_t x = 0; x < size; ++x) {
            const float dx = 0.5f * texelsPerMetre * (height(x + 1, y) - height(x + size - 1, y));
            const float dy = 0.5f * texelsPerMetre * (height(x, y + 1) - height(x, y + size - 1));  // downwards
            const glm::vec3 n = glm::normalize(glm::vec3(-dx, dy, 1.0f)) * 0.5f + 0.5f;
            for (int c = 0; c < 3; ++c)
                painted.normal.rgba8[(std::size_t(y) * size + x) * 4 + std::size_t(c)] = toByte(n[c]);
        }
    }
    return painted;
}

struct CellHit {
    float toEdge;  // second-nearest minus nearest distance, in cells
    float random;  // of the nearest cell
};

// Voronoi cells on a jittered grid of `cells` by `cells`, shifted by half a cell in odd rows.
CellHit voronoi(float u, float v, int cells, std::uint32_t seed) {
    const float x = u * static_cast<float>(cells), y = v * static_cast<float>(cells);
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    float nearest = 1e9f, second = 1e9f, random = 0.0f;
    for (int j = row - 1; j <= row + 1; ++j) {
        for (int i = column - 2; i <= column + 2; ++i) {
            const auto wi = static_cast<std::uint32_t>((i + cells) % cells),
                       wj = static_cast<std::uint32_t>((j + cells) % cells);
            const float shift = (wj & 1u) != 0 ? 0.5f : 0.0f;
            const float px = static_cast<float>(i) + shift + 0.5f + 0.34f * (hashUnit(wi, wj, seed) - 0.5f);
            const float py = static_cast<float>(j) + 0.5f + 0.3f * (hashUnit(wi, wj, seed + 1) - 0.5f);
            const float distance = std::sqrt((x - px) * (x - px) + (y - py) * (y - py));
            if (distance < nearest) {
                second = nearest;
                nearest = distance;
                random = hashUnit(wi, wj, seed + 2);
            } else {
                second = std::min(second, distance);
            }
        }
    }
    return {second - nearest, random};
}

}  // namespace

PaintedTexture paintCobbles(std::uint32_t size) {
    return paint(size, 2.4f, [](float u, float v) {
        const CellHit hit = voronoi(u, v, 16, 11);
        const float stone = smooth(0.04f, 0.32f, hit.toEdge), grain = clouds(u, v, 32, 21), wet = clouds(u, v, 3, 31);
        const glm::vec3 warm(0.47f, 0.43f, 0.39f), cool(0.36f, 0.38f, 0.41f), joint(0.17f, 0.15f, 0.13f);
        const glm::vec3 face = glm::mix(warm, cool, hit.random) * (0.8f + 0.35f * grain);
        const float damp = smooth(0.42f, 0.62f, wet);
        const glm::vec3 colour = glm::mix(joint, face, stone) * (1.0f - 0.25f * damp);
        const float roughness = glm::mix(0.85f, glm::mix(0.62f, 0.3f, damp), stone);
        return Texel{0.016f * std::sqrt(stone) + 0.0015f * grain + 0.004f * hit.random, colour, roughness};
    });
}

PaintedTexture paintBlocks(std::uint32_t size, float metres, int across, int rows, const glm::vec3& tint) {
    return paint(size, metres, [=](float u, float v) {
        const float y = v * static_cast<float>(rows);
        const int row = std::min(static_cast<int>(y), rows - 1);
        const float x = u * static_cast<float>(across) + ((row & 1) != 0 ? 0.5f : 0.0f);
        const int column = static_cast<int>(x) % across;
        const float fx = x - std::floor(x), fy = y - static_cast<float>(row);
        const float blockWidth = metres / static_cast<float>(across), blockHeight = metres / static_cast<float>(rows);
        const float edge = std::min(std::min(fx, 1 - fx) * blockWidth, std::min(fy, 1 - fy) * blockHeight);  // metres
        const float grain = clouds(u, v, 24, 5), stain = clouds(u, v, 3, 8);
        const float stone = smooth(0.004f, 0.016f, edge + 0.006f * (grain - 0.5f));
        const auto random = hashUnit(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row), 77);
        const glm::vec3 face = tint * (0.80f + 0.22f * random + 0.2f * (grain - 0.5f) - 0.16f * stain);
        const glm::vec3 warm = face * glm::vec3(1.0f + 0.05f * random, 1.0f, 1.0f - 0.06f * random);
        return Texel{0.006f * stone + 0.004f * grain, glm::mix(tint * 0.55f, warm, stone), 0.75f + 0.15f * grain};
    });
}

PaintedTexture paintPlaster(std::uint32_t size, const glm::vec3& tint) {
    return paint(size, 3.0f, [=](float u, float v) {
        const float broad = clouds(u, v, 4, 41), fine = clouds(u, v, 32, 43);
        const float crack = 1.0f - smooth(0.0f, 0.02f, std::abs(clouds(u, v, 5, 47) - 0.5f));
        const glm::vec3 colour = tint * (0.82f + 0.28f * broad + 0.08f * (fine - 0.5f) - 0.05f * crack);
        return Texel{0.006f * broad + 0.0025f * fine - 0.001f * crack, colour, 0.88f};
    });
}

PaintedTexture paintPlanks(std::uint32_t size, const glm::vec3& tint) {
    constexpr int kPlanks = 6;
    return paint(size, 1.0f, [=](float u, float v) {
        const float x = u * kPlanks;
        const int plank = std::min(static_cast<int>(x), kPlanks - 1);
        const float fx = x - static_cast<float>(plank), edge = std::min(fx, 1 - fx);
        const float bend = 0.02f * noise(u, v, 4, 4, 61);
        const float grain = noise(u + bend, v, 48, 3, static_cast<std::uint32_t>(62 + plank));
        const float fibre = noise(u + bend, v, 128, 6, 69), body = smooth(0.0f, 0.07f, edge);
        const float random = hashUnit(static_cast<std::uint32_t>(plank), 3, 71);
        const glm::vec3 colour = tint * (0.7f + 0.25f * random + 0.3f * (grain - 0.5f) + 0.12f * (fibre - 0.5f));
        return Texel{0.003f * body + 0.0006f * grain, glm::mix(tint * 0.25f, colour, body), 0.62f + 0.15f * grain};
    });
}

PaintedTexture paintStripes(std::uint32_t size, const glm::vec3& first, const glm::vec3& second) {
    return paint(size, 0.8f, [=](float u, float v) {
        const float inside = smooth(0.245f, 0.255f, std::abs(u - 0.5f));
        const float thin = smooth(0.012f, 0.02f, std::abs(std::abs(u - 0.5f) - 0.2f));
        const float threads = 120.0f * 6.28318530718f;
        const float weave = 0.25f * (2.0f + std::sin(u * threads * 0.5f) + std::sin(v * threads * 0.5f));
        const glm::vec3 colour = glm::mix(second, glm::mix(first, second, inside), thin);
        return Texel{0.0004f * weave, colour * (0.88f + 0.08f * weave + 0.1f * clouds(u, v, 4, 91)), 0.9f};
    });
}

PaintedTexture paintClay(std::uint32_t size, const glm::vec3& tint) {
    return paint(size, 1.3f, [=](float u, float v) {
        const float broad = clouds(u, v, 5, 101), fine = clouds(u, v, 28, 103);
        const glm::vec3 shifted = glm::mix(tint, glm::vec3(tint.g, tint.g, tint.b), 0.5f * smooth(0.5f, 0.8f, broad));
        return Texel{0.003f * fine, shifted * (0.7f + 0.4f * broad + 0.2f * (fine - 0.5f)), 0.7f};
    });
}

}  // namespace gnomon::renderer
