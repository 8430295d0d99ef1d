#include "truth/light_truth.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "truth/parallel.h"
#include "truth/random.h"

namespace gnomon::renderer {
namespace {

constexpr double kEdgePixels = 2.0;
constexpr int kEdgePoints = 8;
// Faces are taken to slant by at most 84 degrees: a footprint ends somewhere.
constexpr double kLeastCosine = 0.1;
// A result's face normal has 16 bits, and within them it may see a face look at the light or away from it.
constexpr double kUndecidedCosine = 1e-4;
// A neighbour that continues a face is as flat as floats can say. How flat that is, is a share of the mesh's own
// coordinates. (A share of the world's, 4 km from the origin, would let rays out of whatever lies flat on a grazed
// face.)
constexpr double kFlatness = 1.2e-7;
constexpr std::size_t kPixelsAtOnce = 512;

class Tracer {
public:
    Tracer(const TracedScene& scene, std::span<const TruthReceiver> receivers, TruthExtent extent,
           const LightTruthDesc& desc)
        : scene_(scene), receivers_(receivers), extent_(extent), desc_(desc) {
        const SceneLight& light = desc.light;
        source_.kind = light.kind;
        source_.position = glm::dvec3(light.position) - scene.origin();
        source_.direction = glm::normalize(glm::dvec3(light.direction));
        source_.radius = static_cast<double>(light.sourceRadius);
        viewsFromTraced_ = scene.origin() - desc.viewsOrigin;
        while (blockTiles_ * blockTiles_ < desc.subsetOf) ++blockTiles_;
    }

    [[nodiscard]] bool reaches(std::uint32_t pixel) const {
        const TruthReceiver& r = receivers_[pixel];
        return r.triangle != kNone && reaches(r.position);
    }

    [[nodiscard]] PixelTruth traced(std::uint32_t pixel) const {
        const TruthReceiver& r = receivers_[pixel];
        PixelTruth truth;
        const glm::dvec3 toLight = directionTo(source_, r.position);
        truth.subset = inSubset(pixel % extent_.widthPx, pixel / extent_.widthPx);
        truth.subsurface = r.subsurface;
        if (!r.subsurface && glm::dot(r.normal, toLight) <= 0.0) {
            truth.hard = HardTruth::Away;
        } else {
            const double blocker = scene_.nearestBlocker(
                {r.position, endOfRay(source_, r.position, scene_.reachMetres() + 1.0), r.triangle, 0.0, r.subsurface});
            truth.hard = std::isfinite(blocker) ? HardTruth::Dark : HardTruth::Lit;
            truth.blockerMetres = static_cast<float>(blocker);
        }
        truth.edge = isEdge(r, toLight, truth.hard != HardTruth::Lit);
        if (!desc_.soft) return truth;
        if (truth.hard == HardTruth::Away)
            truth.soft = 0.0f;
        else if (truth.subset)
            truth.soft = softAt(pixel);
        return truth;
    }

    [[nodiscard]] float softAt(std::uint32_t pixel) const {
        const std::uint64_t place = std::uint64_t{pixel / extent_.widthPx} << 32 | pixel % extent_.widthPx;
        return static_cast<float>(softVisibility(scene_, receivers_[pixel], source_, desc_.softRaysPerSide,
                                                 mixedBits(desc_.seed ^ mixedBits(place))));
    }

private:
    [[nodiscard]] bool reaches(const glm::dvec3& p) const {
        if (source_.kind == LightKind::Directional) return true;
        const glm::dvec3 d = p - source_.position;
        const double distance = glm::length(d);
        if (distance > static_cast<double>(desc_.light.rangeMetres)) return false;
        const double outer = static_cast<double>(desc_.light.outerConeAngle);
        return source_.kind != LightKind::Spot || glm::dot(d, source_.direction) >= std::cos(outer) * distance;
    }

    [[nodiscard]] bool inSubset(std::uint32_t x, std::uint32_t y) const {
        const std::uint32_t tileX = x / kSubsetTilePx, tileY = y / kSubsetTilePx;
        const std::uint64_t block = std::uint64_t{tileY / blockTiles_} << 32 | tileX / blockTiles_;
        const std::uint64_t chosen = mixedBits(mixedBits(desc_.seed) ^ block) % (blockTiles_ * blockTiles_);
        return chosen == tileY % blockTiles_ * blockTiles_ + tileX % blockTiles_;
    }

    // The point `k` of the edge set, relative to the receiver, on its plane.
    [[nodiscard]] glm::dvec3 edgeOffset(const TruthReceiver& r, const glm::dvec3& toLight, double texel, int k) const {
        const double angle = 2.0 * std::numbers::pi * k / kEdgePoints;
        const glm::dvec3 n = r.normal;
        glm::dvec3 slope = toLight - glm::dot(toLight, n) * n;
        if (!(glm::length(slope) > 1e-6))
            slope = glm::cross(n, std::abs(n.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0));
        slope = glm::normalize(slope);
        const glm::dvec3 level = glm::cross(n, slope);
        const double pixels = kEdgePixels * r.pixelMetres, texels = desc_.edgeTexels * texel;
        if (desc_.edgeSet == EdgeSet::Circle)
            return std::max(pixels, texels) * (std::cos(angle) * slope + std::sin(angle) * level);
        const double cosine = std::max(std::abs(glm::dot(toLight, n)), kLeastCosine);
        const glm::dvec3 inMap = std::cos(angle) / cosine * slope + std::sin(angle) * level;
        const glm::dvec3 seen = inMap - glm::dot(inMap, r.toEye) * r.toEye;
        const double seenLength = std::max(glm::length(seen), kLeastCosine * glm::length(inMap));
        return std::max(texels, pixels / seenLength) * inMap;
    }

    [[nodiscard]] bool isEdge(const TruthReceiver& r, const glm::dvec3& toLight, bool dark) const {
        const double cosine = glm::dot(r.normal, toLight);
        if (std::abs(cosine) < kUndecidedCosine) return true;
        if (!r.subsurface && cosine < 0.0) return false;
        const double texel = shadowTexelMetres(desc_.views, source_.kind, source_.position + viewsFromTraced_,
                                               r.position + viewsFromTraced_);
        const double meshMetres = static_cast<double>(scene_.triangles()[r.triangle].meshMetres);
        const double flatness = kFlatness * (1.0 + meshMetres) / std::max(std::abs(cosine), 1e-2);
        for (int k = 0; k < kEdgePoints; ++k) {
            const glm::dvec3 q = r.position + edgeOffset(r, toLight, texel, k);
            const glm::dvec3 end = endOfRay(source_, q, scene_.reachMetres() + 1.0);
            if (scene_.blocked({q, end, r.triangle, flatness, r.subsurface}) != dark) return true;
        }
        return false;
    }

    const TracedScene& scene_;
    std::span<const TruthReceiver> receivers_;
    TruthExtent extent_;
    const LightTruthDesc& desc_;
    LightSource source_;
    std::uint32_t blockTiles_ = 1;  // across a block of tiles, one of which is in the subset
    glm::dvec3 viewsFromTraced_{0.0};
};

// Pieces of `count` for all cores: work(first, last).
template <class Work>
void inPieces(std::size_t count, const Work& work) {
    forEachInParallel((count + kPixelsAtOnce - 1) / kPixelsAtOnce, [&](std::size_t piece) {
        work(piece * kPixelsAtOnce, std::min((piece + 1) * kPixelsAtOnce, count));
    });
}

}  // namespace

bool disagrees(const PixelTruth& truth, float result) {
    const float most = truth.edge ? 0.5f : kFaint;
    return truth.hard == HardTruth::Lit ? result < 1.0f - most : result > most;
}

LightTruth traceLight(const TracedScene& scene, std::span<const TruthReceiver> receivers, TruthExtent extent,
                      const LightTruthDesc& desc) {
    const Tracer tracer(scene, receivers, extent, desc);
    LightTruth out{.extent = extent};
    for (std::uint32_t i = 0; i < receivers.size(); ++i)
        if (tracer.reaches(i)) out.indices.push_back(i);
    out.indices.shrink_to_fit();
    out.pixels.resize(out.indices.size());
    inPieces(out.pixels.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) out.pixels[i] = tracer.traced(out.indices[i]);
    });
    return out;
}

void completeSoftTruth(LightTruth& truth, const TracedScene& scene, std::span<const TruthReceiver> receivers,
                       const LightTruthDesc& desc, std::span<const float> result) {
    if (!desc.soft) return;
    const Tracer tracer(scene, receivers, truth.extent, desc);
    inPieces(truth.pixels.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            PixelTruth& pixel = truth.pixels[i];
            const float visibility = result[truth.indices[i]];
            if (visibility >= 0.0f && std::isnan(pixel.soft) && disagrees(pixel, visibility))
                pixel.soft = tracer.softAt(truth.indices[i]);
        }
    });
}

std::vector<PixelTruth> ofEveryPixel(const LightTruth& truth) {
    std::vector<PixelTruth> out(std::size_t{truth.extent.widthPx} * truth.extent.heightPx);
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) out[truth.indices[i]] = truth.pixels[i];
    return out;
}

}  // namespace gnomon::renderer
