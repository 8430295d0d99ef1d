#include "app/frame_json.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>

#include "app/build_info.h"
#include "app/frame_table.h"
#include "app/settings_table.h"
#include "picture/files.h"
#include "renderer/frame/lights.h"

namespace gnomon::app {
namespace {

Json lightsOf(const PrepareReport& lights) {
    return {{"given", lights.given},
            {"visible", lights.visible},
            {"dropped", lights.dropped},
            {"directional", lights.directional},
            {"casting", lights.casting}};
}

// What each light was given or, where nobody gave it, got.
Json sceneLightsOf(const Session& session, const FrameResult& result) {
    const std::vector<renderer::SceneLight>& lights = session.scene().lights;
    Json out = Json::array();
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const renderer::SceneLight& light = lights[i];
        const bool local = light.kind != renderer::LightKind::Directional;
        const std::optional<float> stated = statedBias(light, session.rendererDesc().frame);
        Json row = {{"name", light.name}, {"kind", nameOf(light.kind)}};
        if (local) row.update({{"rangeMetres", shortest(light.rangeMetres)}, {"rangeGuessed", light.rangeIsGuessed}});
        row[local ? "sourceRadiusMetres" : "sourceRadiusRadians"] = shortest(light.sourceRadius);
        row["sourceRadiusGuessed"] = light.sourceIsGuessed;
        row["biasMetres"] = shortest(stated.value_or(renderer::kBiasMetres));
        row["biasStated"] = stated.has_value();
        if (local && !stated) {
            row["biasAtMostPerMetre"] = shortest(renderer::kMostBias);
            row["biasAtLeastPerMetre"] = shortest(renderer::kLeastBias);
        }
        for (const float bias : result.cascadeBiases.at(i)) row["cascadeBiasMetres"].push_back(shortest(bias));
        out.push_back(std::move(row));
    }
    return out;
}

Json passesOf(const std::vector<TimelineRow>& passes) {
    Json out = Json::array();
    for (const TimelineRow& pass : passes) {
        Json row = {{"name", pass.name}};
        row.update(sortOf(pass.phase, pass.kind));
        row["ms"] = pass.milliseconds();
        row["beginMs"] = pass.beginMilliseconds;
        out.push_back(std::move(row));
    }
    return out;
}

Json memoryOf(const std::vector<renderer::MemoryUseRow>& rows) {
    Json library = Json::object(), host = Json::object();
    for (const renderer::MemoryUseRow& row : rows)
        (row.library ? library : host)[row.name] = {{"bytes", row.bytes}, {"copies", row.copies}};
    return {{"library", library}, {"renderer", host}};
}

}  // namespace

const char* nameOf(renderer::LightKind kind) {
    switch (kind) {
        case renderer::LightKind::Point:
            return "point";
        case renderer::LightKind::Spot:
            return "spot";
        case renderer::LightKind::Directional:
            return "directional";
    }
    return "";
}

Json describe(const Session& session) {
    const renderer::DeviceInfo& info = session.device().info();
    return {{"program", "gnomon " + version()},
            {"commit", commit()},
            {"device", info.name},
            {"deviceType", info.typeName},
            {"driver", info.driver},
            {"scene", session.settings().scene},
            {"triangles", renderer::triangleCount(session.scene())},
            {"extent", {session.rendererDesc().frame.widthPx, session.rendererDesc().frame.heightPx}},
            {"settings", valuesOf(session.settings())}};
}

Json sortOf(Phase phase, RowKind kind) {
    return {{"phase", phaseName(phase)}, {"kind", kindName(kind)}};
}

Json countersOf(const FrameResult& result) {
    const FrameStatistics& s = result.report.statistics;
    return {{"listEntries", s.listEntries},
            {"visibilitySlots", s.visibilitySlots},
            {"listOverflowTiles", s.listOverflowTiles},
            {"slotOverflowEntries", s.slotOverflowEntries},
            {"accurateExceedsApproximate", s.accurateExceedsApproximate},
            {"evaluateTiles", s.evaluateTiles},
            {"tilesWithGeometry", s.tilesWithGeometry},
            {"approximateEntries", s.approximateEntries},
            {"earlyEntries", s.earlyEntries},
            {"earlyCastingEntries", s.earlyCastingEntries},
            {"finalEntries", s.finalEntries},
            {"finalSlotEntries", s.finalSlotEntries},
            {"maxLightsInTile", s.maxLightsInTile},
            {"meanLightsPerTile", meanPerTile(s.earlyEntries, s)},
            {"meanShadowedLightsPerTile", meanPerTile(s.earlyCastingEntries, s)},
            {"recommendedListEntries", s.recommendedListEntries},
            {"recommendedVisibilitySlots", s.recommendedVisibilitySlots}};
}

Json describe(const Session& session, const FrameResult& result) {
    const renderer::FrameReport& report = result.report;
    const Totals totals = totalsOf(report.passes);
    Json out = describe(session);
    out["shadows"] = result.shadows;
    out["frames"] = result.frames;
    out["lights"] = lightsOf(report.statistics.lights);
    out["sceneLights"] = sceneLightsOf(session, result);
    out["passes"] = passesOf(report.passes);
    out["drawingMs"] = totals.drawing;
    out["computeMs"] = totals.compute;
    out["prepareCpuMs"] = report.statistics.prepareMilliseconds;
    out["memory"] = memoryOf(result.memory);
    out["capacities"] = {{"listEntries", result.library.listEntries},
                         {"visibilitySlots", result.library.visibilitySlots},
                         {"poolsCapped", result.library.poolsCapped}};
    out["counters"] = countersOf(result);
    out["shadowAtlas"] = {{"sizePx", report.atlasSizePx},
                          {"views", report.shadowViews},
                          {"viewsDrawn", report.shadowViewsDrawn},
                          {"trianglesDrawn", report.shadowTrianglesDrawn},
                          {"lightsShrunk", report.shadowLightsShrunk},
                          {"lightsDropped", report.shadowLightsDropped}};
    out["exposureEv100"] = result.exposureEv100;
    out["clippedPixels"] = result.clippedPixels;
    out["hash"] = result.hash;
    return out;
}

void writeJson(const Json& json, const std::filesystem::path& file) {
    const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    renderer::replaceFile(file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace gnomon::app
