// See shadows_in_floats.h.
#include "shadows_in_floats.h"

#include "gpu_interface/numbers.h"

namespace gnomon::reference {
namespace {

struct F2 {
    float x, y;
};

/// A view's numbers as floats.
struct View {
    const ShadowViewModel& model;
    F3 r0, r1, r2, r3;
    float a, b;
    F2 scale, offset, perMetre, first, last;  // last: one past

    explicit View(const ShadowViewModel& m)
        : model(m),
          r0(f3(rowOf(m.clipFromWorld, 0))),
          r1(f3(rowOf(m.clipFromWorld, 1))),
          r2(f3(rowOf(m.clipFromWorld, 2))),
          r3(f3(rowOf(m.clipFromWorld, 3))),
          a(float(m.depth.a)),
          b(float(m.depth.b)),
          scale{0.5f * float(m.widthPx), 0.5f * float(m.heightPx)},
          offset{float(m.xPx) + 0.5f * float(m.widthPx), float(m.yPx) + 0.5f * float(m.heightPx)},
          perMetre{float(m.pxPerMetreX), float(m.pxPerMetreY)},
          first{float(m.xPx), float(m.yPx)},
          last{float(m.xPx + m.widthPx), float(m.yPx + m.heightPx)} {}

    [[nodiscard]] float clip(int row, F3 p) const {
        return dot(f3(rowOf(model.clipFromWorld, row)), p) + float(model.clipFromWorld.m[row][3]);
    }
    [[nodiscard]] F2 px(float x, float y, float w) const {
        return {x / w * scale.x + offset.x, y / w * scale.y + offset.y};
    }
    [[nodiscard]] bool lit(float stored, float depth) const {
        return model.reversed ? stored <= depth : stored >= depth;
    }
};

float raised(float k, float least) {
    return k < 0 ? std::min(k, -least) : std::max(k, least);
}

struct Plane {
    F2 px, tangent, slope;
    float z, ray, depth;
};
// `offPlane` below 0: no plane, one depth for all texels.
Plane planeIn(const View& v, F3 p, F3 n, float bias, float toward, float offPlane) {
    Plane plane{};
    const bool parallel = v.model.orthographic;
    const float x = v.clip(0, p), y = v.clip(1, p), w = v.clip(3, p);
    plane.z = parallel ? (v.clip(2, p) - v.a) / v.b : w;
    plane.px = v.px(x, y, w);
    const F2 ndc = {x / w, y / w};
    plane.tangent = parallel ? F2{0, 0} : F2{ndc.x * v.scale.x / v.perMetre.x, ndc.y * v.scale.y / v.perMetre.y};
    const auto depthOf = [&](float z) {
        return parallel ? v.a + v.b * z : v.a + v.b / std::max(z, 1e-3f * std::abs(v.b));
    };
    plane.ray = std::sqrt(1 + plane.tangent.x * plane.tangent.x + plane.tangent.y * plane.tangent.y);
    plane.depth = depthOf(plane.z - toward * bias);
    if (offPlane < 0) return plane;
    const F3 axis = parallel ? v.r2 * (1.0f / v.b) : v.r3, across = cross(v.r0, v.r1);
    const F3 m = {dot(n, cross(v.r1, axis)), dot(n, cross(axis, v.r0)), dot(n, across)};
    float k = parallel ? m.z : m.x * ndc.x + m.y * ndc.y + m.z;
    k = raised(k, float(kLeastCosine) * length(across) * plane.ray);
    const float perNdc = parallel ? -v.b / k : v.b / (plane.z * k);
    plane.slope = {perNdc * m.x / v.scale.x, perNdc * m.y / v.scale.y};
    const float depth = depthOf(plane.z - toward * (bias + offPlane * length(across) / std::abs(k)));
    const float slack = 1e-6f * (std::abs(v.a) + std::abs(depth - v.a)) + float(v.model.depthStep) +
                        (std::abs(plane.slope.x) + std::abs(plane.slope.y)) * 0.0625f;
    plane.depth = v.model.reversed ? depth + toward * slack : depth - toward * slack;
    return plane;
}
float depthAt(const View& v, const Plane& plane, F2 q, bool limited) {
    float d = plane.depth + (plane.slope.x * (q.x - plane.px.x) + plane.slope.y * (q.y - plane.px.y));
    const float most = std::abs(plane.slope.x) + std::abs(plane.slope.y);
    if (limited) d = v.model.reversed ? std::max(d, plane.depth - most) : std::min(d, plane.depth + most);
    return std::clamp(d, 0.0f, 1.0f);
}

struct Tap {
    bool lit;
    float stored;  // in the own view
};
struct Sampler {
    const ShadowInput& input;
    const LightModel& light;
    std::uint32_t index;
    View v;
    Plane plane;
    bool limited;

    [[nodiscard]] float stored(const View& view, float x, float y) const {
        return input.atlases[view.model.atlas].at(view.model.layer, std::uint32_t(x), std::uint32_t(y));
    }
    [[nodiscard]] Tap texel(float x, float y) const {
        x = std::clamp(std::floor(x), v.first.x, v.last.x - 1);
        y = std::clamp(std::floor(y), v.first.y, v.last.y - 1);
        const float depth = stored(v, x, y);
        return {v.lit(depth, depthAt(v, plane, {x + 0.5f, y + 0.5f}, limited)), depth};
    }
    [[nodiscard]] float bilinear(F2 q) const {
        const float x = q.x - 0.5f, y = q.y - 0.5f, fx = x - std::floor(x), fy = y - std::floor(y);
        const auto at = [&](float i, float j) { return texel(std::floor(x) + i, std::floor(y) + j).lit ? 1.0f : 0.0f; };
        const float top = at(0, 0) * (1 - fx) + at(1, 0) * fx, bottom = at(0, 1) * (1 - fx) + at(1, 1) * fx;
        return top * (1 - fy) + bottom * fy;
    }
    [[nodiscard]] F2 clamped(F2 q, float margin) const {
        return {std::clamp(q.x, v.first.x + margin, v.last.x - margin),
                std::clamp(q.y, v.first.y + margin, v.last.y - margin)};
    }
    [[nodiscard]] bool leaves(F2 q) const {
        return light.sixFaces &&
               (q.x < v.first.x + 1 || q.x > v.last.x - 1 || q.y < v.first.y + 1 || q.y > v.last.y - 1);
    }
    [[nodiscard]] Tap elsewhere(F2 q) const;
    [[nodiscard]] float pcf() const;
    [[nodiscard]] float pcss(const Pixel& pixel) const;
    [[nodiscard]] float filter(const Pixel& pixel) const {
        if (light.filter == Filter::Hard) return texel(plane.px.x, plane.px.y).lit ? 1.0f : 0.0f;
        return light.filter == Filter::Pcf ? pcf() : pcss(pixel);
    }
};

std::uint32_t faceOf(F3 d) {
    const float x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
    if (x >= y && x >= z) return d.x >= 0 ? 0 : 1;
    if (y >= z) return d.y >= 0 ? 2 : 3;
    return d.z >= 0 ? 4 : 5;
}

Tap Sampler::elsewhere(F2 q) const {
    const float x = (q.x - v.offset.x) / v.scale.x / dot(v.r0, v.r0);
    const float y = (q.y - v.offset.y) / v.scale.y / dot(v.r1, v.r1);
    const F3 direction = v.r3 + v.r0 * x + v.r1 * y;
    const View other(input.views[light.firstShadowView + faceOf(direction)]);
    const float w = dot(other.r3, direction);
    const F2 px = other.px(dot(other.r0, direction), dot(other.r1, direction), w);
    const float inverse = (depthAt(v, plane, q, true) - v.a) / v.b;
    const float depth = inverse > 0 ? std::clamp(other.a + other.b / ((1 / inverse) * w), 0.0f, 1.0f)
                                    : (other.model.reversed ? 0.0f : 1.0f);
    const float found = stored(other, std::clamp(std::floor(px.x), other.first.x, other.last.x - 1),
                               std::clamp(std::floor(px.y), other.first.y, other.last.y - 1));
    const float linear = other.b / (found - other.a) / w;
    return {other.lit(found, depth), v.a + v.b / linear};
}

float Sampler::pcf() const {
    const int r = input.pcfRadius;
    const F2 middle = clamped(plane.px, float(r) + 1);
    float sum = 0;
    for (int j = -r; j <= r; ++j)
        for (int i = -r; i <= r; ++i) sum += bilinear({middle.x + float(i), middle.y + float(j)});
    return sum / float((2 * r + 1) * (2 * r + 1));
}

float Sampler::pcss(const Pixel& pixel) const {
    const float radius = float(light.sourceRadius), z = plane.z;
    const PcssTapCounts taps = input.pcssPresets[light.pcssPreset];
    const float p = std::max(v.perMetre.x, v.perMetre.y);
    const bool parallel = v.model.orthographic;
    const float g1 = parallel ? -radius / v.b : radius / v.b;
    const float g0 = parallel ? radius * (z + v.a / v.b) : -radius * v.a / v.b - radius / z;
    float widest = 9 * radius / z;
    if (parallel) widest = std::max(g0 + g1 * (v.model.reversed ? 1.0f : 0.0f), 0.0f);
    const float most = std::min(widest, float(gpu::kMaxPcssRadiusPx) / p), search = most + 1 / p;

    const std::uint32_t hash = pixel.x * 3242174889u + pixel.y * 2447445414u + input.patternTurn;
    const float t = (2 * (float((hash << 2) >> 8) * 5.9604644775390625e-8f) - 1) * 0.41421356f;
    F2 start = {(1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)};
    for (std::uint32_t i = hash >> 30; i > 0; --i) start = {-start.y, start.x};
    const auto turned = [](F2 e) {
        return F2{e.x * -0.73736888f - e.y * 0.67549029f, e.x * 0.67549029f + e.y * -0.73736888f};
    };
    const auto position = [&](F2 e, float rho) {
        const float along = (plane.tangent.x * e.x + plane.tangent.y * e.y) / (1 + plane.ray);
        return F2{plane.px.x + (e.x + plane.tangent.x * along) * rho * v.perMetre.x,
                  plane.px.y + (e.y + plane.tangent.y * along) * rho * v.perMetre.y};
    };

    int occluding = 0, blockers = 0;
    float sum = 0;
    F2 e = start;
    for (int i = 0; i < taps.search; ++i, e = turned(e)) {
        const float share = (float(i) + 0.5f) / float(taps.search), aside = share * share * search;
        const F2 q = position(e, aside), corner = clamped(q, 1);
        for (int j = 0; j < 4; ++j) {
            const Tap tap =
                leaves(q) ? elsewhere(q) : texel(corner.x - 0.5f + float(j % 2), corner.y - 0.5f + float(j / 2));
            if (tap.lit) continue;
            ++occluding;
            if (aside > g0 + g1 * tap.stored + 1.5f / p) continue;
            ++blockers;
            sum += tap.stored;
        }
    }
    if (occluding == 4 * taps.search) return 0;
    if (blockers == 0) return 1;
    const float reach = std::clamp(g0 + g1 * (sum / float(blockers)), 1 / p, std::max(most, 1 / p));
    float total = 0;
    e = start;
    for (int i = 0; i < taps.filter; ++i, e = turned(e)) {
        const F2 q = position(e, std::sqrt((float(i) + 0.5f) / float(taps.filter)) * reach);
        total += leaves(q) ? (elsewhere(q).lit ? 1.0f : 0.0f) : bilinear(clamped(q, 1));
    }
    return total / float(taps.filter);
}

bool faces(const LightModel& light, const Pixel& pixel, F3 p) {
    const F3 to = light.type == LightType::Directional ? f3(-light.direction) : f3(light.position) - p;
    return dot(f3(pixel.faceNormal), to) / length(to) > 0;
}

float sample(const LightModel& light, std::uint32_t index, const Pixel& pixel, F3 p, const ShadowInput& input) {
    const View v(input.views[light.firstShadowView + index]);
    if (!v.model.orthographic && v.clip(3, p) <= 0) return 1;
    const float linear = v.model.orthographic ? 1.0f : std::max(v.clip(3, p), 0.0f);
    const float least = float(v.model.leastBias) * linear, most = float(v.model.mostBias) * linear;
    float bias = std::min(std::max(float(light.biasMetres), least), most);
    if (pixel.subsurface) bias = std::max(bias, float(input.subsurfaceBiasMetres));
    const float toward = pixel.subsurface || faces(light, pixel, p) ? 1.0f : -1.0f;
    if (input.bias == BiasMode::Unbiased) bias = 0;
    const float offPlane = input.bias == BiasMode::Oriented ? float(pixel.offPlaneMetres) : -1.0f;
    const Plane plane = planeIn(v, p, f3(pixel.faceNormal), bias, toward, offPlane);
    return Sampler{input, light, index, v, plane, light.filter == Filter::Pcss}.filter(pixel);
}

struct Fit {
    bool holds;
    float blend;
};
Fit fitIn(const View& v, F3 p) {
    const F2 px = v.px(v.clip(0, p), v.clip(1, p), v.clip(3, p));
    const float m = float(gpu::kCascadeMarginPx), z = (v.clip(2, p) - v.a) / v.b, depth = v.a + v.b * z;
    const bool holds = px.x >= v.first.x + m && px.y >= v.first.y + m && px.x <= v.last.x - m && px.y <= v.last.y - m &&
                       depth >= 0 && depth <= 1;
    const float way =
        std::max(std::abs(px.x - v.offset.x) / (v.scale.x - m), std::abs(px.y - v.offset.y) / (v.scale.y - m));
    return {holds, std::clamp((way - 0.9f) * 10, 0.0f, 1.0f)};
}

float sun(const LightModel& light, const Pixel& pixel, F3 p, const ShadowInput& input) {
    for (std::uint32_t i = 0; i < light.cascadeCount; ++i) {
        const Fit fit = fitIn(View(input.views[light.firstShadowView + i]), p);
        if (!fit.holds) continue;
        const float here = sample(light, i, pixel, p, input);
        if (fit.blend <= 0) return here;
        const bool next =
            i + 1 < light.cascadeCount && fitIn(View(input.views[light.firstShadowView + i + 1]), p).holds;
        return here * (1 - fit.blend) + fit.blend * (next ? sample(light, i + 1, pixel, p, input) : 1.0f);
    }
    return 1;
}

}  // namespace

float visibilityInFloats(const LightModel& light, const Pixel& pixel, F3 p, const ShadowInput& input) {
    const bool directional = light.type == LightType::Directional;
    if (input.facedAwayIsDark && !pixel.subsurface && !faces(light, pixel, p)) return 0;
    if (directional) return sun(light, pixel, p, input);
    return sample(light, light.sixFaces ? faceOf(p - f3(light.position)) : 0, pixel, p, input);
}

int storedInFloats(const LightModel& light, const Pixel& pixel, F3 p, F3 eye, const ShadowInput& input) {
    const float v = visibilityInFloats(light, pixel, p, input);
    float fade = float(light.shadowFade);
    if (light.type == LightType::Directional && light.shadowFades)
        fade = std::clamp(float(light.shadowFadeScale) * length(p - eye) + float(light.shadowFadeOffset), 0.0f, 1.0f);
    const float faded = 1 - fade * (1 - v);
    return int(std::floor(float(input.levels()) * std::sqrt(std::clamp(faded, 0.0f, 1.0f)) + 0.5f));
}

}  // namespace gnomon::reference
