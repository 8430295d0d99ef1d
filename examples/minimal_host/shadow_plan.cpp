#include "shadow_plan.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "scene.h"

namespace host {
namespace {

constexpr std::uint32_t kLeastPx = 32;
constexpr std::uint32_t kMostSpotPx = 1024, kMostFacePx = 512, kMostCascadePx = 1024;
// A view's rectangle reaches so many texels beyond its cone or its 90 degrees, on each side, so that filters at the
// border find depths there. PCF needs its radius and two more.
constexpr float kGuardTexels = 4;
constexpr float kShadowNearMetres = 0.05f;

// Of a point light's six views, in the order that the library wants.
constexpr Vec3 kFaces[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

// Six faces of a cube, one cone, or cascades: one of these is enough for this scene, 1 to 8 are possible.
std::uint32_t viewsOf(gnomon::LightType type) {
    return type == gnomon::LightType::Point ? 6 : 1;
}

// One texel per pixel, where the light's reach is seen from: a face of a point light holds half of that across.
std::uint32_t wishedPx(const gnomon::LightOnScreen& light) {
    if (light.type == gnomon::LightType::Directional) return kMostCascadePx;  // its reach is endless
    const bool point = light.type == gnomon::LightType::Point;
    const std::uint32_t most = point ? kMostFacePx : kMostSpotPx;
    const float pixels = point ? 0.5f * light.reachDiameterPx : light.reachDiameterPx;
    if (pixels >= static_cast<float>(most)) return most;
    return std::max(std::bit_ceil(static_cast<std::uint32_t>(pixels)), kLeastPx);
}

// Every second bit of n. The n-th square along a Morton curve is at (evenBits(n), evenBits(n >> 1)). Squares of powers
// of two that are placed along it from the largest to the smallest fill the atlas without gaps.
std::uint32_t evenBits(std::uint64_t n) {
    std::uint32_t out = 0;
    for (std::uint32_t bit = 0; bit < 32; ++bit) out |= static_cast<std::uint32_t>(n >> (2 * bit) & 1) << bit;
    return out;
}

Mat4 viewOf(const gnomon::Light& light, std::uint32_t face, float sidePx, gnomon::ShadowView& view) {
    const float beyond = sidePx / (sidePx - 2 * kGuardTexels);
    const Vec3 position = std::to_array(light.position), direction = std::to_array(light.direction);
    if (light.type == gnomon::LightType::Directional) {
        // Everything that casts lies between the planes. A receiver in the outer tenth of the last cascade fades into
        // light, so the square is wider than the scene. A host with a large world has several, and moves them in steps
        // of whole texels, or shadows' edges crawl.
        const CasterBounds casters = sceneCasters();
        const float length = std::hypot(direction[0], direction[1], direction[2]), r = casters.radiusMetres;
        Vec3 eye = casters.centre;
        for (int i = 0; i < 3; ++i) eye[i] -= direction[i] / length * 2 * r;
        view.orthographic = true;
        view.nearMetres = r;
        view.farMetres = 3 * r;
        return multiply(orthographic(1.2f * r, view.nearMetres, view.farMetres), lookAlong(eye, direction));
    }
    const bool spot = light.type == gnomon::LightType::Spot;
    const float tangent = (spot ? std::tan(light.outerConeAngle) : 1.0f) * beyond;
    view.nearMetres = kShadowNearMetres;  // the far plane is at infinity, which is the default
    return multiply(perspective(tangent, tangent, kShadowNearMetres),
                    lookAlong(position, spot ? direction : kFaces[face]));
}

bool sameTexels(const gnomon::ShadowView& a, const gnomon::ShadowView& b) {
    return a.xPx == b.xPx && a.yPx == b.yPx && a.widthPx == b.widthPx &&
           std::ranges::equal(a.clipFromWorld, b.clipFromWorld);
}

}  // namespace

bool ShadowPlanner::shrinkToFit(std::vector<Wish>& wishes) const {
    const auto weight = [](const Wish& wish) {
        if (wish.sidePx == kLeastPx) return 0.0f;  // cannot shrink
        return static_cast<float>(wish.texels()) / std::max(wish.light->screenShare, 1e-3f);
    };
    for (;;) {
        std::uint64_t texels = 0;
        for (const Wish& wish : wishes) texels += wish.texels();
        if (texels <= std::uint64_t{atlasPx_} * atlasPx_) return true;
        const auto heaviest = std::ranges::max_element(wishes, {}, weight);
        if (heaviest->sidePx == kLeastPx) return false;
        heaviest->sidePx /= 2;
    }
}

// Gives every wish its views, in a row, and tells the library which they are: an entry for each visible light.
void ShadowPlanner::number(std::vector<Wish>& wishes, const gnomon::PreparedLights& prepared) {
    plan_.lightViews.assign(prepared.visible.size(), {});  // casts nothing
    std::uint32_t views = 0;
    for (Wish& wish : wishes) {
        wish.firstView = views;
        plan_.lightViews[static_cast<std::size_t>(wish.light - prepared.visible.data())] = {views, wish.views};
        views += wish.views;
    }
    plan_.views.assign(views, {});
}

void ShadowPlanner::place(std::vector<Wish> wishes, std::span<const gnomon::Light> lights) {
    std::ranges::stable_sort(wishes, std::ranges::greater{}, &Wish::sidePx);
    std::uint64_t taken = 0;  // of the least squares
    for (const Wish& wish : wishes) {
        for (std::uint32_t face = 0; face < wish.views; ++face) {
            gnomon::ShadowView& view = plan_.views[wish.firstView + face];
            view.xPx = evenBits(taken) * kLeastPx;
            view.yPx = evenBits(taken >> 1) * kLeastPx;
            view.widthPx = view.heightPx = wish.sidePx;
            const Mat4 matrix = viewOf(lights[wish.light->light], face, static_cast<float>(wish.sidePx), view);
            std::ranges::copy(matrix, view.clipFromWorld);
            // Squares of one frame never overlap. So whoever was in the frame before, with this very square and matrix,
            // is still there. In this scene no caster moves; else a view is drawn anew, too, when one moves in it.
            view.changed =
                std::ranges::none_of(before_, [&](const gnomon::ShadowView& old) { return sameTexels(old, view); });
            taken += std::uint64_t{wish.sidePx / kLeastPx} * (wish.sidePx / kLeastPx);
        }
    }
}

const ShadowPlan& ShadowPlanner::plan(const gnomon::PreparedLights& prepared, std::span<const gnomon::Light> lights) {
    std::vector<Wish> wishes;
    for (const gnomon::LightOnScreen& light : prepared.visible)
        if (light.casts) wishes.push_back({&light, 0, viewsOf(light.type), wishedPx(light)});
    // Where not even the least squares fit, the least lights go without a shadow.
    while (!shrinkToFit(wishes))
        wishes.erase(std::ranges::min_element(wishes, {}, [](const Wish& w) { return w.light->screenShare; }));
    before_ = std::move(plan_.views);
    number(wishes, prepared);
    place(std::move(wishes), lights);
    return plan_;
}

}  // namespace host
