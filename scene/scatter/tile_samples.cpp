#include "scene/scatter/tile_samples.h"

#include "scene/random.h"

#include <algorithm>
#include <cmath>

namespace gnomon::renderer {
namespace {

constexpr std::uint32_t kTilePx = 8;
constexpr std::uint32_t kMostTilesAcross = 40;  // of the sampled ones
constexpr float kPixels[] = {0.5f, 4.0f, 7.5f};

struct Ray {
    glm::vec3 origin, direction;
};

Ray rayThrough(const TileDensity& view, float xPx, float yPx) {
    const float width = static_cast<float>(view.widthPx), height = static_cast<float>(view.heightPx);
    const glm::vec2 ndc(2.0f * xPx / width - 1.0f, 1.0f - 2.0f * yPx / height);
    const SceneCamera camera = fittedCamera(view.camera, view.widthPx, view.heightPx);
    const glm::mat3 axes(camera.worldFromCamera);
    const glm::vec3 eye(camera.worldFromCamera[3]);
    if (camera.orthographic) {
        const glm::vec2 at = camera.orthographicHalfHeight * glm::vec2(ndc.x * width / height, ndc.y);
        return {eye + axes * glm::vec3(at, 0.0f), glm::normalize(axes * glm::vec3(0, 0, -1))};
    }
    const float slope = std::tan(0.5f * camera.verticalFieldOfView);
    return {eye, glm::normalize(axes * glm::vec3(ndc.x * slope * width / height, ndc.y * slope, -1.0f))};
}

}  // namespace

TileSamples::TileSamples(const TriangleGrid& grid, const TileDensity& view) {
    const std::uint32_t across = (view.widthPx + kTilePx - 1) / kTilePx, down = (view.heightPx + kTilePx - 1) / kTilePx;
    const std::uint32_t columns = std::min(across, kMostTilesAcross), rows = std::min(down, kMostTilesAcross);
    Random random(7);
    for (std::uint32_t i = 0; i < columns * rows; ++i) {
        // One tile by chance of every cell of a coarse grid.
        const auto pick = [&](std::uint32_t cell, std::uint32_t cells, std::uint32_t tiles) {
            return std::min(static_cast<std::uint32_t>((static_cast<float>(cell) + random.unit()) *
                                                       static_cast<float>(tiles) / static_cast<float>(cells)),
                            tiles - 1);
        };
        const std::uint32_t x = kTilePx * pick(i % columns, columns, across),
                            y = kTilePx * pick(i / columns, rows, down);
        Tile tile{};
        Bounds bounds;
        for (const float dy : kPixels) {
            for (const float dx : kPixels) {
                const Ray ray = rayThrough(view, static_cast<float>(x) + dx, static_cast<float>(y) + dy);
                const auto hit = grid.cast(ray.origin, ray.direction, std::numeric_limits<float>::infinity());
                if (!hit) continue;
                const TriangleGrid::Triangle& triangle = grid.triangles()[hit->triangle];
                glm::vec3 normal(0.0f);
                if (!triangle.subsurface) normal = glm::normalize(triangle.areaNormal());
                if (glm::dot(normal, ray.direction) > 0.0f) normal = -normal;
                tile.pixels.push_back({ray.origin + hit->distance * ray.direction, normal});
                bounds.add(tile.pixels.back().position);
            }
        }
        if (tile.pixels.empty()) continue;
        tile.centre = bounds.centre();
        tile.radius = bounds.radius();
        tiles_.push_back(std::move(tile));
    }
}

bool TileSamples::reaches(const SceneLight& light, const Tile& tile) {
    const bool local = light.kind != LightKind::Directional;
    if (local && glm::length(light.position - tile.centre) > light.rangeMetres + tile.radius) return false;
    for (const Pixel& pixel : tile.pixels) {
        const glm::vec3 to = local ? light.position - pixel.position : -light.direction;
        if (pixel.normal != glm::vec3(0.0f) && glm::dot(to, pixel.normal) <= 0.0f) continue;
        if (!local) return true;
        const float distance = glm::length(to);
        if (distance > light.rangeMetres) continue;
        if (light.kind == LightKind::Point) return true;
        if (glm::dot(-to, light.direction) >= distance * std::cos(light.outerConeAngle)) return true;
    }
    return false;
}

float TileSamples::meanShadowed(std::span<const SceneLight> lights) const {
    std::size_t sum = 0;
    for (const SceneLight& light : lights) {
        if (!light.casts) continue;
        for (const Tile& tile : tiles_) sum += reaches(light, tile) ? 1 : 0;
    }
    return static_cast<float>(sum) / static_cast<float>(std::max<std::size_t>(tiles_.size(), 1));
}

}  // namespace gnomon::renderer
