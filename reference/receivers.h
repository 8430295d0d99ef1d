#pragma once
// The receivers: what the host's depth, face-normal and receiver-flag images say about every pixel.
//
// Source: the specification (Conventions; Oriented depth bias: face normals) and gnomon/tiled_shadows.h (FrameDesc).
//
// What: CPU copies of the three images, and the pixels they describe in double precision: position, view depth, how far
// 32-bit floats may be off, face normal, mask, subsurface.
//
// Limits: a face normal is decoded from the stored 16-bit pair, so quantisation is no error here. Where the host has no
// face normals the library derives them from depth; the oracle does not, and calls what hangs on them `May`.

#include <cstdint>
#include <vector>

#include "reference/camera.h"

namespace gnomon::reference {

/// Images over the active extent only, rows from the top.
struct Receivers {
    std::uint32_t widthPx = 0, heightPx = 0;
    std::vector<float> depth;                 ///< device depth, one per pixel
    double depthStep = 0;                     ///< between neighbouring values of the depth image, beyond float rounding
    std::vector<std::uint16_t> faceNormals;   ///< R16G16_UINT octahedral, two per pixel; empty: the host has none
    std::vector<std::uint8_t> receiverFlags;  ///< R8G8_UINT: mask, bits; two per pixel; empty: mask 0xFF, no subsurface
};

/// Octahedral encoding of a unit vector in two 16-bit numbers: n / (|x| + |y| + |z|), the lower half folded over, each
/// component e of [-1, 1] stored as round((e / 2 + 1/2) * 65535).
void encodeOctahedral(Vec3 normal, std::uint16_t out[2]);
Vec3 decodeOctahedral(std::uint16_t x, std::uint16_t y);

struct Pixel {
    std::uint32_t x = 0, y = 0;  ///< in the active extent
    bool background = true;
    Vec3 position;              ///< origin-relative metres
    double viewDepth = 0;       ///< metres
    double viewDepthError = 0;  ///< metres, see camera.h
    double positionError = 0;   ///< metres, see camera.h
    double eyeDistance = 0;     ///< metres from the camera
    double eyeDistanceError = 0;
    bool hasFaceNormal = false;
    Vec3 faceNormal;            ///< unit
    double offPlaneMetres = 0;  ///< how far the rounding of the depth image may have moved the position off the face
    double offPlaneError = 0;
    std::uint8_t receiverMask = 0xFF;
    bool subsurface = false;
};

struct PixelGrid {
    std::uint32_t widthPx = 0, heightPx = 0;
    std::uint32_t tilesX = 0, tilesY = 0;    ///< shadow tiles
    std::uint32_t groupsX = 0, groupsY = 0;  ///< tile groups
    std::vector<Pixel> pixels;

    [[nodiscard]] const Pixel& at(std::uint32_t x, std::uint32_t y) const {
        return pixels[std::size_t(y) * widthPx + x];
    }
    /// Pixels (x, y) of a shadow tile that lie inside the extent.
    struct Coordinates {
        std::uint32_t x, y;
    };
    [[nodiscard]] std::vector<Coordinates> tilePixels(std::uint32_t tileX, std::uint32_t tileY) const;
};

PixelGrid makePixelGrid(const CameraModel& camera, const Receivers& receivers);

}  // namespace gnomon::reference
