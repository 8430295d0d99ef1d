// See receivers.h.
#include "reference/receivers.h"

#include "gpu_interface/packing.h"

namespace gnomon::reference {
namespace {

double signNotZero(double value) {
    return value >= 0.0 ? 1.0 : -1.0;
}

// A step of the depth image is 2^-23 of a float's value, and its own where it has fewer bits. Along the pixel's ray
// that is a step of the position, and of it counts what crosses the face.
void findOffPlane(const CameraModel& camera, double deviceDepth, double depthStep, Pixel& pixel) {
    double share = 0;
    const double metres = viewDepthPerDeviceDepth(camera, deviceDepth, share) * (1.2e-7 * deviceDepth + depthStep);
    const Vec3 ray = camera.orthographic ? camera.forward : (pixel.position - camera.eye) / pixel.viewDepth;
    const double rayError =
        8 * kFloatRoundoff + (camera.orthographic ? 0.0 : 2 * pixel.positionError / pixel.viewDepth);
    const double cosine = std::abs(dot(pixel.faceNormal, ray));
    pixel.offPlaneMetres = metres * cosine;
    pixel.offPlaneError = metres * (rayError + cosine * share) * (1 + share);
}

std::uint16_t store16(double e) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(e * 0.5 + 0.5, 0.0, 1.0) * 65535.0));
}

}  // namespace

void encodeOctahedral(Vec3 normal, std::uint16_t out[2]) {
    const Vec3 n = normal / sumOfMagnitudes(normal);
    double x = n.x, y = n.y;
    if (n.z < 0.0) {
        x = (1.0 - std::abs(n.y)) * signNotZero(n.x);
        y = (1.0 - std::abs(n.x)) * signNotZero(n.y);
    }
    out[0] = store16(x);
    out[1] = store16(y);
}

Vec3 decodeOctahedral(std::uint16_t storedX, std::uint16_t storedY) {
    const double x = storedX / 65535.0 * 2.0 - 1.0;
    const double y = storedY / 65535.0 * 2.0 - 1.0;
    Vec3 n = {x, y, 1.0 - std::abs(x) - std::abs(y)};
    if (n.z < 0.0) {
        n.x = (1.0 - std::abs(y)) * signNotZero(x);
        n.y = (1.0 - std::abs(x)) * signNotZero(y);
    }
    return normalize(n);
}

std::vector<PixelGrid::Coordinates> PixelGrid::tilePixels(std::uint32_t tileX, std::uint32_t tileY) const {
    std::vector<Coordinates> result;
    for (std::uint32_t y = tileY * gpu::kShadowTileSizePx; y < (tileY + 1) * gpu::kShadowTileSizePx; ++y)
        for (std::uint32_t x = tileX * gpu::kShadowTileSizePx; x < (tileX + 1) * gpu::kShadowTileSizePx; ++x)
            if (x < widthPx && y < heightPx) result.push_back({x, y});
    return result;
}

PixelGrid makePixelGrid(const CameraModel& camera, const Receivers& receivers) {
    PixelGrid grid;
    grid.widthPx = receivers.widthPx;
    grid.heightPx = receivers.heightPx;
    grid.tilesX = gpu::divideRoundingUp(grid.widthPx, gpu::kShadowTileSizePx);
    grid.tilesY = gpu::divideRoundingUp(grid.heightPx, gpu::kShadowTileSizePx);
    grid.groupsX = gpu::divideRoundingUp(grid.tilesX, gpu::kTileGroupSizeTiles);
    grid.groupsY = gpu::divideRoundingUp(grid.tilesY, gpu::kTileGroupSizeTiles);
    grid.pixels.resize(receivers.depth.size());
    for (std::uint32_t y = 0; y < grid.heightPx; ++y) {
        for (std::uint32_t x = 0; x < grid.widthPx; ++x) {
            const std::size_t i = std::size_t(y) * grid.widthPx + x;
            Pixel& pixel = grid.pixels[i];
            const float depth = receivers.depth[i];
            pixel.x = x;
            pixel.y = y;
            pixel.background = isBackground(camera, depth);
            if (!receivers.receiverFlags.empty()) {
                pixel.receiverMask = receivers.receiverFlags[2 * i];
                pixel.subsurface = (receivers.receiverFlags[2 * i + 1] & gpu::kReceiverSubsurfaceBit) != 0;
            }
            pixel.hasFaceNormal = !receivers.faceNormals.empty();
            if (pixel.hasFaceNormal)
                pixel.faceNormal = decodeOctahedral(receivers.faceNormals[2 * i], receivers.faceNormals[2 * i + 1]);
            if (pixel.background) continue;
            pixel.position = worldFromPixel(camera, x + 0.5, y + 0.5, depth);
            pixel.viewDepth = viewDepth(camera, pixel.position);
            pixel.viewDepthError = viewDepthError(camera, depth);
            pixel.positionError = positionError(camera, pixel.position, depth);
            pixel.eyeDistance = length(pixel.position - camera.eye);
            if (pixel.hasFaceNormal) findOffPlane(camera, static_cast<double>(depth), receivers.depthStep, pixel);
            pixel.eyeDistanceError =
                pixel.positionError + kErrorFactor * kFloatRoundoff * (pixel.eyeDistance + sumOfMagnitudes(camera.eye));
        }
    }
    return grid;
}

}  // namespace gnomon::reference
