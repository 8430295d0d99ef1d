#include "renderer/shadow_atlas/cascades.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "gpu_interface/numbers.h"
#include "renderer/shadow_atlas/part_extent.h"

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

// Up or down to a quarter of a power of two.
double stepped(double metres, bool up) {
    const double quarters = 4.0 * std::log2(metres);
    return std::exp2(0.25 * (up ? std::ceil(quarters) : std::floor(quarters)));
}

// Along the light: what is seen within the square, and all that may cast upon it. `slice` stands in where nothing is.
Extent depthsOf(std::span<const ScenePart> parts, const Axes& axes, const glm::dvec3& centre, double halfExtent,
                const SliceSphere& slice) {
    const auto side = [&](const glm::dvec3& normal) { return Plane{normal, halfExtent - glm::dot(normal, centre)}; };
    const Plane square[4] = {side(axes.right), side(-axes.right), side(axes.down), side(-axes.down)};
    constexpr double kNone = std::numeric_limits<double>::infinity();
    Extent depths = {kNone, -kNone};
    std::vector<Extent> unseen;
    for (const ScenePart& part : parts) {
        const std::optional<Extent> extent = extentWithin(part, square, axes.forward);
        if (!extent) continue;
        if (!part.seen) {
            unseen.push_back(*extent);
            continue;
        }
        depths.low = std::min(depths.low, extent->low);
        depths.high = std::max(depths.high, extent->high);
    }
    if (depths.high == -kNone) {
        const double middle = glm::dot(axes.forward, slice.centre);
        depths = {middle - slice.radius, middle + slice.radius};
    }
    for (const Extent& extent : unseen)
        if (extent.low < depths.high) depths.low = std::min(depths.low, extent.low);
    // A little more, since floats round what lies on the planes.
    constexpr double kRoom = 0.01;
    const double step = 0.25 * std::exp2(std::ceil(std::log2(halfExtent)));
    depths.low = step * std::floor(depths.low / step - kRoom);
    depths.high = std::max(step * std::ceil(depths.high / step + kRoom), depths.low + step);
    return depths;
}

// Some of what is seen: from `nearest` to `farthest` along the axis, and how much of the picture it may fill.
struct Sight {
    double nearest, farthest, share;
};

// Finds what is seen of parts between the sides of the frustum.
class Sights {
public:
    Sights(const CascadeCamera& camera, const CullVolume& frustum) : camera_(camera), frustum_(frustum) {
        constexpr double kAlong = 1.0 - 1e-6;
        for (const Plane& plane : planesOf(frustum)) {
            const double along = glm::dot(plane.normal, camera.forward);
            if (std::abs(along) < kAlong) sides_.push_back(plane);
            // The planes across the axis are near and far.
            else if (along < 0.0)
                far_ = glm::dot(plane.normal, camera.position) + plane.offset;
        }
    }
    [[nodiscard]] std::optional<Sight> of(const ScenePart& part) const {
        const std::optional<Extent> extent = extentWithin(part, sides_, camera_.forward);
        if (!extent) return std::nullopt;
        const double eye = glm::dot(camera_.forward, camera_.position);
        const bool around = holds(part, camera_.position);
        const double farthest = std::min(extent->high - eye, far_);
        if (!(farthest > 0.0)) return std::nullopt;
        const double size = sizeOf(part);
        return Sight{around ? 0.0 : std::max(extent->low - eye, 0.0), farthest, size * size};
    }
    // What a picture of half the diagonal has as Sight::share.
    [[nodiscard]] double wholePicture() const {
        return camera_.halfDiagonalMetres > 0.0 ? 1.0 : camera_.tangent * camera_.tangent;
    }
    [[nodiscard]] bool mayHold(const ScenePart& part) const {
        return frustum_.planeCount == 0 || frustum_.mayHold(part.centre, static_cast<float>(part.radius));
    }

private:
    // Perspective: radians; orthographic: to half the picture's diagonal.
    [[nodiscard]] double sizeOf(const ScenePart& part) const {
        if (camera_.halfDiagonalMetres > 0.0) return std::min(part.radius / camera_.halfDiagonalMetres, 1.0);
        const double distance = glm::length(part.centre - camera_.position);
        return distance > part.radius ? part.radius / distance : 1.0;
    }

    const CascadeCamera& camera_;
    const CullVolume& frustum_;
    std::vector<Plane> sides_;
    double far_ = std::numeric_limits<double>::infinity();
};

struct SeenPlane {
    std::size_t part;
    Plane plane;
    Sight whole;
};

// Planes reach farther than all else, and most of them lies in the light. Those that would make the range longer count
// where something casts upon them.
void addPlanes(std::vector<SeenPlane>& planes, const Sights& sights, std::span<const ScenePart> parts,
               const glm::dvec3& direction, std::vector<Sight>& out) {
    constexpr std::size_t kMost = 32;  // each looks at all parts
    std::stable_sort(planes.begin(), planes.end(),
                     [](const SeenPlane& a, const SeenPlane& b) { return a.whole.farthest > b.whole.farthest; });
    double farthest = 0.0;
    for (const Sight& sight : out) farthest = std::max(farthest, sight.farthest);
    std::size_t looked = 0;
    for (const SeenPlane& seen : planes) {
        if (seen.whole.farthest <= farthest || looked == kMost) {
            out.push_back(seen.whole);
            continue;
        }
        ++looked;
        for (std::size_t p = 0; p < parts.size(); ++p) {
            if (p == seen.part) continue;
            const std::optional<ScenePart> shadow = shadowOn(seen.plane, parts[p], direction);
            if (!shadow || !sights.mayHold(*shadow)) continue;
            std::optional<Sight> sight = sights.of(*shadow);
            if (!sight || sight->nearest >= seen.whole.farthest) continue;
            sight->farthest = std::min(sight->farthest, seen.whole.farthest);
            farthest = std::max(farthest, sight->farthest);
            out.push_back(*sight);
        }
    }
}

// Leaves out the farthest ones that are together less than a pixel of a 4K picture: something that is parked there has
// no say. Where all is so small, it stays.
void dropSpecks(std::vector<Sight>& sights, double wholePicture) {
    constexpr double kSpeck = 1e-7;  // of the picture
    std::stable_sort(sights.begin(), sights.end(),
                     [](const Sight& a, const Sight& b) { return a.farthest > b.farthest; });
    double beyond = 0.0;
    for (auto sight = sights.begin(); sight != sights.end(); ++sight) {
        beyond += sight->share;
        if (!(beyond > kSpeck * wholePicture)) continue;
        sights.erase(sights.begin(), sight);
        return;
    }
}

// Where all but a small share of what is seen has not begun.
double mostOf(std::vector<Sight>& sights) {
    constexpr double kLess = 0.05;
    std::stable_sort(sights.begin(), sights.end(),
                     [](const Sight& a, const Sight& b) { return a.nearest < b.nearest; });
    double all = 0.0, before = 0.0;
    for (const Sight& sight : sights) all += sight.share;
    for (const Sight& sight : sights) {
        before += sight.share;
        if (before > kLess * all) return sight.nearest;
    }
    return 0.0;
}

}  // namespace

SeenRange seenRangeOf(const CascadeCamera& camera, const CullVolume& frustum, std::span<const ScenePart> parts,
                      const glm::vec3& direction) {
    const glm::dvec3 travel = glm::normalize(glm::dvec3(direction));
    const Sights sights(camera, frustum);
    std::vector<Sight> found;
    std::vector<SeenPlane> planes;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        if (!parts[p].seen) continue;
        const std::optional<Sight> sight = sights.of(parts[p]);
        if (!sight) continue;
        if (const std::optional<Plane> plane = planeOfFlat(parts[p], travel))
            planes.push_back({p, *plane, *sight});
        else
            found.push_back(*sight);
    }
    dropSpecks(found, sights.wholePicture());
    addPlanes(planes, sights, parts, travel, found);
    if (found.empty()) return {};
    dropSpecks(found, sights.wholePicture());
    SeenRange range = {found[0].nearest, found[0].farthest, 0.0};
    // Of a box around the camera nobody knows where its surfaces are: not many are right before it.
    constexpr double kUnknown = 1.0 / 16.0;
    for (Sight& sight : found) {
        range.nearest = std::min(range.nearest, sight.nearest);
        if (sight.nearest == 0.0) sight.nearest = kUnknown * sight.farthest;
    }
    range.most = mostOf(found);
    range.nearest = range.nearest > 0.0 ? stepped(range.nearest, false) : 0.0;
    range.farthest = stepped(range.farthest, true);
    range.most = stepped(range.most, false);
    return range;
}

void cascadeEnds(const CascadeSettings& settings, const CascadeCamera& camera, const SeenRange& seen,
                 double (&ends)[8]) {
    const double reach = seen.farthest > 0.0 ? seen.farthest : 1.0;  // any: nothing is seen
    const bool orthographic = camera.halfDiagonalMetres > 0.0;
    const double begin = orthographic ? seen.nearest : std::max(seen.most, reach / settings.mostRatio);
    const double start = std::min(begin, 0.9 * reach);
    const double evenShare = orthographic ? 1.0 : static_cast<double>(settings.evenShare);
    for (std::uint32_t i = 0; i < settings.count; ++i) {
        const double share = (i + 1.0) / settings.count;
        const double even = start + (reach - start) * share;
        const double logarithmic = orthographic ? even : start * std::pow(reach / start, share);
        ends[i] = logarithmic + (even - logarithmic) * evenShare;
    }
}

Cascade cascadeAround(const CascadeSettings& settings, const CascadeCamera& camera, const SeenRange& seen,
                      std::span<const ScenePart> parts, const glm::vec3& direction, std::uint32_t index,
                      std::uint32_t sizePx) {
    double ends[8] = {};
    cascadeEnds(settings, camera, seen, ends);
    const SliceSphere sphere = sphereAround(camera, index == 0 ? seen.nearest : ends[index - 1], ends[index]);
    const Axes axes = axesOf(direction);
    // The sphere, the margin that no receiver uses, and half a step to each side. The border of the last cascade gives
    // way to light, so it lies beyond the sphere.
    const double held = sizePx - 2.0 * gpu::kCascadeMarginPx;
    const bool last = index + 1 == settings.count;
    const double usable = (last ? held * (1.0 - 1.0 / gpu::kCascadeBlendedPart) : held) - kCascadeStepPx;
    const double texel = 2.0 * sphere.radius / std::max(usable, 1.0);
    const double step = texel * kCascadeStepPx;
    const auto snapped = [step](double value) { return std::round(value / step) * step; };
    const glm::dvec3 across = axes.right * snapped(glm::dot(axes.right, sphere.centre)) +
                              axes.down * snapped(glm::dot(axes.down, sphere.centre));
    Cascade cascade;
    cascade.halfExtent = 0.5 * texel * sizePx;
    const Extent depths = depthsOf(parts, axes, across, cascade.halfExtent, sphere);
    cascade.centre = across + axes.forward * depths.low;
    cascade.depth = depths.high - depths.low;
    return cascade;
}

ShadowView cascadeView(const Cascade& cascade, const glm::vec3& direction, std::uint32_t sizePx,
                       const glm::dvec3& origin) {
    const Axes axes = axesOf(direction);
    const glm::dvec3 position = cascade.centre - origin;
    // Reversed Z: 1 at the plane of the nearest caster, 0 behind the farthest receiver.
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
