#include "truth/shadow_texels.h"

#include <algorithm>
#include <cmath>

namespace gnomon::renderer {
namespace {

glm::dvec4 clipOf(const ShadowView& view, const glm::dvec3& p) {
    glm::dvec4 clip(0.0);
    for (int row = 0; row < 4; ++row)
        clip[row] = view.clipFromWorld[row] * p.x + view.clipFromWorld[4 + row] * p.y +
                    view.clipFromWorld[8 + row] * p.z + static_cast<double>(view.clipFromWorld[12 + row]);
    return clip;
}

double texelAt(const ShadowView& view, const glm::dvec4& clip) {
    const glm::dvec3 row(view.clipFromWorld[0], view.clipFromWorld[4], view.clipFromWorld[8]);
    return 2.0 * std::abs(clip.w) / (view.widthPx * glm::length(row));
}

std::size_t faceOf(const glm::dvec3& fromLight) {
    const glm::dvec3 a = glm::abs(fromLight);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return static_cast<std::size_t>(2 * axis + (fromLight[axis] >= 0.0 ? 0 : 1));
}

}  // namespace

double shadowTexelMetres(std::span<const ShadowView> views, LightKind kind, const glm::dvec3& lightPosition,
                         const glm::dvec3& position) {
    if (views.empty()) return 0.0;
    if (kind != LightKind::Directional) {
        const std::size_t face = views.size() == 1 ? 0 : faceOf(position - lightPosition);
        return face < views.size() ? texelAt(views[face], clipOf(views[face], position)) : 0.0;
    }
    // The last tenth of a cascade is blended with the next one.
    constexpr double kAlone = 0.88;
    double texel = 0.0;
    for (const ShadowView& view : views) {
        const glm::dvec4 clip = clipOf(view, position);
        const double most = std::max(std::abs(clip.x), std::abs(clip.y)) / clip.w;
        if (most > 1.0 || clip.z < 0.0 || clip.z > clip.w) continue;
        texel = std::max(texel, texelAt(view, clip));
        if (most < kAlone) break;
    }
    return texel;
}

}  // namespace gnomon::renderer
