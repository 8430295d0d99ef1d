// See on_screen.h.
#include "reference/on_screen.h"

#include "gpu_interface/numbers.h"
#include "reference/prepare.h"

namespace gnomon::reference {
namespace {

constexpr double kRelative = 1e-5;  // floats, and positions by a view matrix of floats

bool near(double a, double b, double absolute = 0) {
    if (a == b) return true;
    return std::isfinite(b) && std::abs(a - b) <= absolute + kRelative * std::max(std::abs(a), std::abs(b));
}

/// Pixels per metre at view depth 1 (perspective) or anywhere (orthographic).
double pxPerMetre(const CameraModel& camera) {
    return std::abs(camera.clipFromView.m[1][1]) * 0.5 * camera.heightPx;
}

/// Of the nearest point of interest: no nearer than half the radius.
double distanceTo(const Ball& ball, const CameraModel& camera) {
    return std::max(length(ball.centre - camera.eye), 0.5 * ball.radius);
}

double diameterPx(const Ball& ball, const CameraModel& camera) {
    const double across = 2.0 * ball.radius * pxPerMetre(camera);
    if (camera.orthographic || across == 0) return across;
    return across / distanceTo(ball, camera);
}

/// How far a light reaches along a unit direction, from its position.
double reachAlong(const LightModel& light, Vec3 direction) {
    if (light.type != LightType::Spot) return light.rangeMetres;
    const double angle = std::acos(std::clamp(dot(light.direction, direction), -1.0, 1.0));
    if (angle <= light.outerAngle) return light.rangeMetres;
    return std::max(0.0, light.rangeMetres * std::cos(angle - light.outerAngle));
}

/// By which phase 1 may widen a light's depths: coordinates of floats, and the angle of a cone.
double depthSlack(const LightModel& light, const CameraModel& camera) {
    const double scale = sumOfMagnitudes(camera.eye) + sumOfMagnitudes(light.position) + light.rangeMetres +
                         length(light.position - camera.eye);
    double slack = 1e-5 + 1.5e-5 * scale;
    if (light.type == LightType::Spot)
        slack += light.rangeMetres * (1e-5 + 1e-6 / std::max(std::sin(light.outerAngle), 1e-3));
    return slack;
}

void checkDepths(Findings& findings, std::size_t i, const LightModel& light, const CameraModel& camera,
                 const LightOnScreen& entry) {
    const double centre = viewDepth(camera, light.position), slack = depthSlack(light, camera);
    const double nearest = std::max(0.0, centre - reachAlong(light, -camera.forward));
    const double farthest = centre + reachAlong(light, camera.forward);
    const double rounding =
        4 * kFloatRoundoff *
        (std::abs(centre) + light.rangeMetres + sumOfMagnitudes(camera.eye) + sumOfMagnitudes(light.position));
    if (!(entry.nearestMetres <= nearest + rounding && entry.nearestMetres >= nearest - slack))
        findings.add("light %zu reaches from a depth of %g instead of %g", i, entry.nearestMetres, nearest);
    if (!(entry.farthestMetres >= farthest - rounding && entry.farthestMetres <= farthest + slack))
        findings.add("light %zu reaches to a depth of %g instead of %g", i, entry.farthestMetres, farthest);
}

void checkSize(Findings& findings, std::size_t i, const char* what, float found, const Ball& ball,
               const CameraModel& camera) {
    const double expected = diameterPx(ball, camera);
    // Near the eye a rounding of the light's own place counts.
    const double place = 8 * kFloatRoundoff * (sumOfMagnitudes(ball.centre) + sumOfMagnitudes(camera.eye));
    const double share = camera.orthographic || ball.radius == 0 ? 0.0 : place / distanceTo(ball, camera);
    if (!near(found, expected, expected * share))
        findings.add("light %zu has a %s of %g pixels instead of %g", i, what, found, expected);
}

void checkSizes(Findings& findings, std::size_t i, const LightModel& light, const CameraModel& camera,
                const LightOnScreen& entry) {
    if (light.type != LightType::Directional) {
        checkSize(findings, i, "reach", entry.reachDiameterPx, reachOf(light), camera);
        checkSize(findings, i, "source", entry.sourceDiameterPx, {light.position, light.sourceRadius}, camera);
        return;
    }
    const double source = camera.orthographic ? 0.0 : 2.0 * light.sourceRadius * pxPerMetre(camera);
    if (entry.reachDiameterPx != kInfinity)
        findings.add("directional light %zu has a reach of %g pixels", i, entry.reachDiameterPx);
    if (!near(entry.sourceDiameterPx, source))
        findings.add("directional light %zu has a source of %g pixels instead of %g", i, entry.sourceDiameterPx,
                     source);
}

void checkShare(Findings& findings, std::size_t i, const LightModel& light, const LightOnScreen& entry,
                std::span<const std::uint32_t> masks, std::size_t tiles) {
    std::size_t marked = 0;
    for (std::size_t tile = 0; tile < tiles; ++tile)
        marked += maskHas(masks.subspan(tile * gpu::kLightMaskEntryWords, gpu::kLightMaskEntryWords),
                          static_cast<std::uint32_t>(i));
    if (light.type == LightType::Directional) marked = tiles;
    if (!near(entry.screenShare, double(marked) / double(tiles)))
        findings.add("light %zu covers %g of the view, but %zu of %zu mask tiles", i, entry.screenShare, marked, tiles);
}

}  // namespace

std::vector<LightModel> orderLights(const std::vector<LightModel>& all, std::span<const LightOnScreen> answer) {
    std::vector<LightModel> result;
    for (const LightOnScreen& entry : answer) {
        LightModel model;
        model.mask = 0;
        model.rangeMetres = 0;
        if (entry.light < all.size()) model = all[entry.light];
        result.push_back(model);
    }
    return result;
}

Ball reachOf(const LightModel& light) {
    if (light.type != LightType::Spot || light.outerAngle > kPi / 3) return {light.position, light.rangeMetres};
    const double radius = light.rangeMetres / (2.0 * std::cos(light.outerAngle));
    return {light.position + light.direction * radius, radius};
}

Findings checkOnScreen(const std::vector<LightModel>& lights, const CameraModel& camera,
                       std::span<const LightOnScreen> answer, std::span<const std::uint32_t> masks,
                       std::uint32_t tilesX, std::uint32_t tilesY) {
    Findings findings;
    const std::size_t tiles = std::size_t(tilesX) * tilesY;
    for (std::size_t i = 0; i < lights.size() && i < answer.size(); ++i) {
        const LightModel& light = lights[i];
        const LightOnScreen& entry = answer[i];
        if (entry.type != light.type) findings.add("light %zu is of type %d", i, int(entry.type));
        if (entry.filter != light.filter || entry.pcssPreset != light.pcssPreset)
            findings.add("light %zu has filter %d and preset %u", i, int(entry.filter), entry.pcssPreset);
        const bool closeToCall = light.wantsShadow && light.type != LightType::Directional && light.shadowFade < 1e-4 &&
                                 light.shadowFade > 0;
        const bool casts = light.wantsShadow && (light.type == LightType::Directional || light.shadowFade > 0);
        if (entry.casts != casts && !closeToCall)
            findings.add("light %zu %s shadow views at shadow fade %g", i, entry.casts ? "wants" : "wants no",
                         light.shadowFade);
        checkSizes(findings, i, light, camera, entry);
        if (light.type != LightType::Directional)
            checkDepths(findings, i, light, camera, entry);
        else if (entry.nearestMetres != 0.0f || !(entry.farthestMetres == kInfinity))
            findings.add("directional light %zu reaches from %g to %g", i, entry.nearestMetres, entry.farthestMetres);
        if (tiles > 0) checkShare(findings, i, light, entry, masks, tiles);
    }
    return findings;
}

Findings checkReport(std::size_t given, std::size_t must, const PreparedLights& answer) {
    Findings findings;
    const PrepareReport& report = answer.report;
    std::size_t directional = 0, casting = 0;
    for (const LightOnScreen& entry : answer.visible) {
        directional += entry.type == LightType::Directional;
        casting += entry.casts;
    }
    const auto compare = [&](const char* what, std::size_t told, std::size_t counted) {
        if (told != counted) findings.add("%zu lights are said to be %s; there are %zu", told, what, counted);
    };
    compare("given", report.given, given);
    compare("visible", report.visible, answer.visible.size());
    compare("directional", report.directional, directional);
    compare("casting", report.casting, casting);
    const bool full = answer.visible.size() == gpu::kMaxLightsPerView;
    if (report.dropped > 0 && !full) findings.add("%u lights were dropped from a list with space", report.dropped);
    const std::size_t found = answer.visible.size() + report.dropped;
    if (found < must || found > given)
        findings.add("%zu lights were found; %zu of %zu are visible for certain", found, must, given);
    return findings;
}

}  // namespace gnomon::reference
