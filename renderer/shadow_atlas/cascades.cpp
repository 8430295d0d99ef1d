#include "renderer/shadow_atlas/cascades.h"

#include <algorithm>
#include <cmath>

#include "gpu_interface/numbers.h"

namespace gnomon::renderer {
namespace {

struct Axes {
    glm::dvec3 right, down, forward;
};
Axes axesOf(const glm::vec3& direction) {
    Axes a;
    a.forward = glm::normalize(glm::dvec3(direction));
    const glm::dvec3 helper = std::abs(a.forward.y) > 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
    a.right = glm::normalize(glm::cross(a.forward, helper));
    a.down = glm::cross(a.forward, a.right);
    return a;
}

struct SliceSphere {
    glm::dvec3 centre;
    double radius;
};
// The smallest sphere around the view's slice between two distances whose centre is on the axis.
SliceSphere sphereAround(const CascadeCamera& camera, double from, double to) {
    double middle = 0.5 * (from + to), radius = std::hypot(0.5 * (to - from), camera.halfDiagonalMetres);
    if (camera.halfDiagonalMetres == 0.0) {
        const double k = camera.tangent * camera.tangent;
        middle = std::min(to, 0.5 * (from + to) * (1.0 + k));
        radius = std::hypot(to - middle, camera.tangent * to);
    }
    return {camera.position + camera.forward * middle, radius};
}

}  // namespace

void cascadeEnds(const CascadeSettings& settings, const CascadeCamera& camera, const CasterBounds& casters,
                 double (&ends)[8]) {
    const double toFarthest = glm::length(casters.centre - camera.position) + casters.radius;
    const double reach = std::max(std::min<double>(settings.reachMetres, toFarthest), 1e-3);
    const double start = std::min<double>(settings.nearestMetres, 0.1 * reach);
    for (std::uint32_t i = 0; i < settings.count; ++i) {
        const double share = (i + 1.0) / settings.count;
        const double logarithmic = start * std::pow(reach / start, share);
        const double even = start + (reach - start) * share;
        ends[i] = logarithmic + (even - logarithmic) * settings.evenShare;
    }
}

Cascade cascadeAround(const CascadeSettings& settings, const CascadeCamera& camera, const CasterBounds& casters,
                      const glm::vec3& direction, std::uint32_t index, std::uint32_t sizePx) {
    double ends[8] = {};
    cascadeEnds(settings, camera, casters, ends);
    const SliceSphere sphere = sphereAround(camera, index == 0 ? 0.0 : ends[index - 1], ends[index]);
    const Axes axes = axesOf(direction);
    // The sphere, the margin that no receiver uses, and half a step to each side.
    const double usable = sizePx - 2.0 * gpu::kCascadeMarginPx - kCascadeStepPx;
    const double texel = 2.0 * sphere.radius / std::max(usable, 1.0);
    const double step = texel * kCascadeStepPx;
    const auto snapped = [step](double value) { return std::round(value / step) * step; };
    const double nearest = glm::dot(axes.forward, casters.centre) - casters.radius;
    Cascade cascade;
    cascade.centre = axes.right * snapped(glm::dot(axes.right, sphere.centre)) +
                     axes.down * snapped(glm::dot(axes.down, sphere.centre)) + axes.forward * nearest;
    cascade.halfExtent = 0.5 * texel * sizePx;
    cascade.depth = 2.0 * casters.radius;
    return cascade;
}

ShadowView cascadeView(const Cascade& cascade, const glm::vec3& direction, std::uint32_t sizePx,
                       const glm::dvec3& origin) {
    const Axes axes = axesOf(direction);
    const glm::dvec3 position = cascade.centre - origin;
    // Reversed Z: 1 at the plane of the nearest caster, 0 beyond the farthest.
    const glm::dvec3 rows[3] = {axes.right / cascade.halfExtent, axes.down / cascade.halfExtent,
                                axes.forward * (-1.0 / cascade.depth)};
    ShadowView view;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) view.clipFromWorld[c * 4 + r] = static_cast<float>(rows[r][c]);
        view.clipFromWorld[12 + r] = static_cast<float>(-glm::dot(rows[r], position) + (r == 2 ? 1.0 : 0.0));
    }
    view.clipFromWorld[15] = 1.0f;
    view.widthPx = view.heightPx = sizePx;
    view.nearMetres = 0.0f;
    view.farMetres = static_cast<float>(cascade.depth);
    view.orthographic = true;
    return view;
}

}  // namespace gnomon::renderer
