// See pcss_faces.h.
#include "reference/pcss_faces.h"

#include "reference/filters.h"

namespace gnomon::reference {
namespace {

constexpr int kMaxTexelsPerAxis = 4;  // of uncertainty: anything may come out

/// Direction of a position in a view, and linear depth 1 along it.
Interval3 directionOf(const ShadowViewModel& view, Interval xPx, Interval yPx) {
    const double scaleX = 0.5 * view.widthPx, scaleY = 0.5 * view.heightPx;
    const Vec3 r0 = rowOf(view.clipFromWorld, 0), r1 = rowOf(view.clipFromWorld, 1);
    const Interval x = (xPx - (view.xPx + scaleX)) / scaleX / rounded(dot(r0, r0), 4);
    const Interval y = (yPx - (view.yPx + scaleY)) / scaleY / rounded(dot(r1, r1), 4);
    return Interval3(rowOf(view.clipFromWorld, 3)) + Interval3(r0) * x + Interval3(r1) * y;
}

/// Faces whose component may be the largest.
std::vector<std::size_t> facesOf(const Interval3& direction) {
    double largest = 0;
    for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, abs(component(direction, axis)).lo);
    std::vector<std::size_t> result;
    for (int axis = 0; axis < 3; ++axis) {
        const Interval value = component(direction, axis);
        if (value.magnitude() < largest) continue;
        if (value.hi >= 0) result.push_back(2 * axis);
        if (value.lo < 0) result.push_back(2 * axis + 1);
    }
    return result;
}

Interval atlasPx(Interval clip, Interval w, int first, int size) {
    return clip / w * (0.5 * size) + (first + 0.5 * size);
}

}  // namespace

OtherFaces otherFaces(std::span<const ShadowViewModel> faces, std::size_t own, const ReceiverPlane& plane, Interval xPx,
                      Interval yPx) {
    OtherFaces result;
    const ShadowViewModel& view = faces[own];
    const Interval3 direction = directionOf(view, xPx, yPx);
    const Interval here = depthOfPlane(view, plane, xPx, yPx, true);
    // 1 / l; no finite depth counts as infinite.
    const Interval inverse = max((here - rounded(view.depth.a)) / rounded(view.depth.b), 0.0);
    for (const std::size_t face : facesOf(direction)) {
        const ShadowViewModel& other = faces[face];
        const auto row = [&](int i) { return dot(Interval3(rowOf(other.clipFromWorld, i)), direction); };
        OtherTexel texel;
        texel.face = face;
        texel.w = row(3);
        const Interval x = atlasPx(row(0), texel.w, other.xPx, other.widthPx);
        const Interval y = atlasPx(row(1), texel.w, other.yPx, other.heightPx);
        texel.depth = clamp(rounded(other.depth.a) + rounded(other.depth.b) * inverse / texel.w, 0.0, 1.0);
        if (!x.finite() || !y.finite()) return {true, {}};
        const TexelRange across = texelsOf(x, other.xPx, other.widthPx), down = texelsOf(y, other.yPx, other.heightPx);
        if (across.to - across.from >= kMaxTexelsPerAxis || down.to - down.from >= kMaxTexelsPerAxis) return {true, {}};
        for (int atY = down.from; atY <= down.to; ++atY)
            for (int atX = across.from; atX <= across.to; ++atX) {
                texel.x = static_cast<std::uint32_t>(atX);
                texel.y = static_cast<std::uint32_t>(atY);
                result.texels.push_back(texel);
            }
    }
    return result;
}

Interval inOwnView(const ShadowViewModel& own, const ShadowViewModel& other, const OtherTexel& texel, double stored) {
    const Interval inverse = (Interval(stored) - rounded(other.depth.a)) / rounded(other.depth.b);
    return rounded(own.depth.a) + rounded(own.depth.b) * (inverse * texel.w);
}

}  // namespace gnomon::reference
