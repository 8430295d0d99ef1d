// See test_shadows.h.
#include "reference/test_shadows.h"

#include "gpu_interface/packing.h"

namespace gnomon::reference {
namespace {

constexpr float kLimitedBias = 0.0004f;  // less than the lights' 2 mm up to 5 m, or anywhere
constexpr float kRaisedBias = 0.004f;    // more than 2 mm from half a metre on, or anywhere

Vec3 anyAcross(Vec3 direction) {
    const Vec3 helper = std::abs(direction.y) > 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    return normalize(cross(direction, helper));
}

std::vector<ShadowView> cascadesOf(const Light& light, std::uint32_t count, const ShadowSetup& setup, bool reversed) {
    constexpr double kBackMetres = 30, kFarMetres = 70, kGrowth = 3;
    const Vec3 direction = normalize(vec3(light.direction));
    const Vec3 down = anyAcross(direction), right = cross(down, direction);
    std::vector<ShadowView> result;
    double half = setup.cascadeHalfExtentMetres;
    for (std::uint32_t i = 0; i < count; ++i, half *= kGrowth) {
        const double texel = 2 * half / setup.viewSizePx;
        const auto toTexel = [&](double metres) { return std::floor(metres / texel) * texel - metres; };
        const Vec3 centre = setup.cascadeCentre + right * toTexel(dot(right, setup.cascadeCentre)) +
                            down * toTexel(dot(down, setup.cascadeCentre));
        result.push_back(makeShadowView(centre - direction * kBackMetres, direction, down, half, setup.nearMetres,
                                        kFarMetres, true, reversed));
    }
    return result;
}

/// Point lights, and spots too wide for one view.
bool hasSixFaces(const Light& light) {
    return light.type == LightType::Point || (light.type == LightType::Spot && light.outerConeAngle > 1.1f);
}

std::vector<ShadowView> viewsOf(const Light& light, const ShadowSetup& setup, bool reversed, double rangeMetres) {
    const Vec3 from = vec3(light.position);
    const double farMetres = setup.infiniteFar ? kInfinity : rangeMetres * 1.1 + setup.nearMetres;
    std::vector<ShadowView> result;
    if (!hasSixFaces(light)) {
        const Vec3 direction = normalize(vec3(light.direction));
        // A texel more on every side than the cone needs.
        const double widen = setup.viewSizePx / (setup.viewSizePx - 2.0);
        result.push_back(makeShadowView(from, direction, anyAcross(direction), std::tan(light.outerConeAngle) * widen,
                                        setup.nearMetres, farMetres, false, reversed));
        return result;
    }
    const double widen = setup.viewSizePx / (setup.viewSizePx - 2.0 * setup.borderTexels);
    for (int face = 0; face < static_cast<int>(gpu::kPointLightFaces); ++face) {
        const double sign = face % 2 == 0 ? 1.0 : -1.0;
        const Vec3 direction = {face / 2 == 0 ? sign : 0.0, face / 2 == 1 ? sign : 0.0, face / 2 == 2 ? sign : 0.0};
        result.push_back(
            makeShadowView(from, direction, anyAcross(direction), widen, setup.nearMetres, farMetres, false, reversed));
    }
    return result;
}

void place(std::vector<ShadowView>& views, const ShadowSetup& setup) {
    for (std::uint32_t i = 0; i < views.size(); ++i) {
        const std::uint32_t cell = i / (setup.atlasCount * setup.layers);
        ShadowView& view = views[i];
        if (i % 3 == 0)
            view.mostBias = kLimitedBias;
        else if (i % 5 == 1)
            view.leastBias = kRaisedBias;
        view.atlas = i % setup.atlasCount;
        view.layer = i / setup.atlasCount % setup.layers;
        // One texel between cells, and around them.
        view.xPx = 1 + cell % setup.cellsPerRow * (setup.viewSizePx + 1);
        view.yPx = 1 + cell / setup.cellsPerRow * (setup.viewSizePx + 1);
        view.widthPx = view.heightPx = setup.viewSizePx;
    }
}

std::vector<AtlasCopy> emptyAtlases(std::size_t viewCount, const ShadowSetup& setup) {
    const auto perCell = setup.atlasCount * setup.layers;
    const auto cells = std::max(1u, gpu::divideRoundingUp(static_cast<std::uint32_t>(viewCount), perCell));
    AtlasCopy atlas;
    atlas.widthPx = 1 + setup.cellsPerRow * (setup.viewSizePx + 1);
    atlas.heightPx = 1 + gpu::divideRoundingUp(cells, setup.cellsPerRow) * (setup.viewSizePx + 1);
    atlas.layers = setup.layers;
    const float nearest = setup.reversed ? 1.0f : 0.0f;
    atlas.depth.assign(std::size_t(atlas.widthPx) * atlas.heightPx * atlas.layers, nearest);
    return std::vector<AtlasCopy>(setup.atlasCount, atlas);
}

}  // namespace

ShadowView makeShadowView(Vec3 from, Vec3 direction, Vec3 down, double halfExtent, double nearMetres, double farMetres,
                          bool orthographic, bool reversed) {
    const Vec3 right = cross(down, direction);
    const DepthFromLinear depth = depthFromLinear(nearMetres, farMetres, orthographic, reversed);
    const auto setRow = [&](Mat4& m, int row, Vec3 axis, double scale, double constant) {
        m.m[row][0] = axis.x * scale;
        m.m[row][1] = axis.y * scale;
        m.m[row][2] = axis.z * scale;
        m.m[row][3] = -dot(axis, from) * scale + constant;
    };
    Mat4 clip;
    setRow(clip, 0, right, 1.0 / halfExtent, 0.0);
    setRow(clip, 1, down, 1.0 / halfExtent, 0.0);
    if (orthographic) {
        setRow(clip, 2, direction, depth.b, depth.a);
        clip.m[3][3] = 1.0;
    } else {
        setRow(clip, 2, direction, depth.a, depth.b);
        setRow(clip, 3, direction, 1.0, 0.0);
    }
    ShadowView view;
    toColumnMajor(clip, view.clipFromWorld);
    view.nearMetres = static_cast<float>(nearMetres);
    view.farMetres = static_cast<float>(farMetres);
    view.orthographic = orthographic;
    view.deviceDepth = reversed ? DeviceDepth::ReversedZ : DeviceDepth::StandardZ;
    return view;
}

void renderShadowView(const Shapes& shapes, const ShadowView& view, AtlasCopy& atlas) {
    const Mat4 worldFromClip = inverse(fromColumnMajor(view.clipFromWorld));
    const bool reversed = view.deviceDepth == DeviceDepth::ReversedZ;
    const DepthFromLinear depth = depthFromLinear(view.nearMetres, view.farMetres, view.orthographic, reversed);
    const double nearDevice = reversed ? 1.0 : 0.0;
    for (std::uint32_t y = 0; y < view.heightPx; ++y) {
        for (std::uint32_t x = 0; x < view.widthPx; ++x) {
            const double ndcX = (x + 0.5) / view.widthPx * 2 - 1, ndcY = (y + 0.5) / view.heightPx * 2 - 1;
            const Vec3 origin = transformPoint(worldFromClip, {ndcX, ndcY, nearDevice});
            const Vec3 other = transformPoint(worldFromClip, {ndcX, ndcY, 0.5});
            const double otherLinear = view.orthographic ? (0.5 - depth.a) / depth.b : depth.b / (0.5 - depth.a);
            const Vec3 perMetre = (other - origin) / (otherLinear - view.nearMetres);
            const auto hit = trace(shapes, origin, perMetre, 0.0, double(view.farMetres) - view.nearMetres);
            double device = 1.0 - nearDevice;
            if (hit) {
                const double linear = view.nearMetres + hit->distance;
                device = view.orthographic ? depth.a + depth.b * linear : depth.a + depth.b / linear;
            }
            atlas.at(view.layer, view.xPx + x, view.yPx + y) = static_cast<float>(std::clamp(device, 0.0, 1.0));
        }
    }
}

std::vector<LightShadowViews> numberViews(std::span<const Light> lights, const ShadowSetup& setup) {
    std::vector<LightShadowViews> result(lights.size());
    std::uint32_t next = 0;
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
        if (!lights[i].casts) continue;
        const std::uint32_t cascades = setup.cascades > 0 ? setup.cascades : 1 + i % 4;
        const std::uint32_t count = lights[i].type == LightType::Directional ? cascades
                                    : hasSixFaces(lights[i])                 ? gpu::kPointLightFaces
                                                                             : 1;
        result[i] = {next, count};
        next += count;
    }
    return result;
}

TestShadows buildShadows(const Shapes& shapes, std::span<const Light> lights, const ShadowSetup& setup,
                         double rangeCutoffLux) {
    TestShadows result;
    result.lightViews = numberViews(lights, setup);
    bool flip = false;
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
        const Light& light = lights[i];
        if (!light.casts) continue;
        const double range = light.rangeMetres > 0 ? light.rangeMetres : std::sqrt(light.intensity / rangeCutoffLux);
        const bool reversed = setup.reversed != flip;
        const std::vector<ShadowView> views = light.type == LightType::Directional
                                                  ? cascadesOf(light, result.lightViews[i].count, setup, reversed)
                                                  : viewsOf(light, setup, reversed, range);
        result.views.insert(result.views.end(), views.begin(), views.end());
        flip = setup.mixDepthKinds && !flip;
    }
    place(result.views, setup);
    result.atlases = emptyAtlases(result.views.size(), setup);
    for (const ShadowView& view : result.views) renderShadowView(shapes, view, result.atlases[view.atlas]);
    return result;
}

}  // namespace gnomon::reference
