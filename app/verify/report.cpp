#include "app/verify/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/frame_json.h"

namespace gnomon::app {

std::string percent(double share) {
    return fmt::format("{:.4f}", 100.0 * share);
}

namespace {

using renderer::Figures;
using renderer::LightFigures;

void printRow(const std::string& name, const Figures& f, double setAside) {
    const bool soft = f.penumbraPairs != 0;
    fmt::print("{:<30.30} {:>10} {:>9} {:>9} {:>9} {:>9} {:>8} {:>8} {:>8} {:>8}\n", name, f.pairs,
               percent(f.share(f.acne)), percent(f.share(f.leak)), percent(f.share(f.contactLeak)),
               percent(f.share(f.edgeError + f.penumbraError)), fmt::format("{:.2f}", 100.0 * setAside),
               f.comparedPairs != 0 ? fmt::format("{:.5f}", f.visibilityError()) : "-",
               soft ? fmt::format("{:.4f}", f.penumbraRmse()) : "-",
               f.ssimPixels != 0 ? fmt::format("{:.4f}", f.penumbraSsim()) : "-");
}

// Above this share, acne and leak say too little to be read alone.
constexpr double kMuchSetAside = 0.05;

}  // namespace

std::vector<std::string> warningsOf(const VerifyResult& result) {
    std::vector<std::string> warnings;
    std::size_t many = 0, withoutMap = 0;
    const VerifiedLight* worst = nullptr;
    for (const VerifiedLight& light : result.lights) {
        withoutMap += light.hasShadowmap ? 0 : 1;
        if (light.figures.setAside() <= kMuchSetAside) continue;
        ++many;
        const auto wrong = [](const VerifiedLight& l) { return l.figures.setAside() * l.figures.wrongOfSetAside(); };
        if (worst == nullptr || wrong(light) > wrong(*worst)) worst = &light;
    }
    if (worst != nullptr)
        warnings.push_back(fmt::format(
            "{} of {} lights have more than {:.0f} % of their pairs set aside (edges, penumbrae, subsurface), where "
            "acne "
            "and leak say nothing. Light #{} {} is the worst: {:.1f} % are set aside, and {:.2f} % of these are wrong.",
            many, result.lights.size(), 100.0 * kMuchSetAside, worst->index, worst->name,
            100.0 * worst->figures.setAside(), 100.0 * worst->figures.wrongOfSetAside()));
    if (withoutMap != 0)
        warnings.push_back(fmt::format("{} of {} lights have no shadowmap, so that they light through everything.",
                                       withoutMap, result.lights.size()));
    if (result.lightsLeftOut != 0)
        warnings.push_back(
            fmt::format("{} visible lights were left out of the frame, since it has too many.", result.lightsLeftOut));
    return warnings;
}

Json describe(const Figures& f) {
    double low = 0.0, high = 0.0;
    f.penumbraRmseInterval(low, high);
    const auto count = static_cast<double>(f.penumbraPairs);
    return {{"acne", f.share(f.acne)},
            {"leak", f.share(f.leak)},
            {"contactLeak", f.share(f.contactLeak)},
            {"contactLeakOfContacts", f.contactLeakOfContacts()},
            {"edgeError", f.share(f.edgeError)},
            {"penumbraError", f.share(f.penumbraError)},
            {"visibilityError", f.comparedPairs == 0 ? Json() : Json(f.visibilityError())},
            {"faintAcne", f.share(f.faintAcne)},
            {"faintLeak", f.share(f.faintLeak)},
            {"penumbraRmse", count == 0.0 ? Json() : Json(f.penumbraRmse())},
            {"penumbraRmse95", count == 0.0 ? Json() : Json({low, high})},
            {"penumbraSsim", f.ssimPixels == 0 ? Json() : Json(f.penumbraSsim())},
            {"counts",
             {{"pairs", f.pairs},
              {"away", f.away},
              {"lit", f.lit},
              {"dark", f.dark},
              {"edges", f.edges},
              {"contacts", f.contacts},
              {"acne", f.acne},
              {"leak", f.leak},
              {"contactLeak", f.contactLeak},
              {"edgeError", f.edgeError},
              {"penumbraError", f.penumbraError},
              {"undecided", f.undecided},
              {"compared", f.comparedPairs},
              {"faintAcne", f.faintAcne},
              {"faintLeak", f.faintLeak},
              {"softTruth", f.softPairs},
              {"penumbra", f.penumbraPairs}}}};
}

Json describe(const LightFigures& f) {
    Json out = describe(f.opaque);
    out["setAside"] = f.setAside();
    out["wrongOfSetAside"] = f.wrongOfSetAside();
    return out;
}

void printVerified(const Session& session, const VerifyResult& result) {
    const renderer::FrameSettings& desc = session.rendererDesc().frame;
    fmt::print("{}, {}x{}, filter {}, {}: shadows against ray-traced truth\n\n", session.settings().scene, desc.widthPx,
               desc.heightPx, session.settings().filter, session.device().info().name);
    fmt::print("{:<30} {:>10} {:>9} {:>9} {:>9} {:>9} {:>8} {:>8} {:>8} {:>8}\n", "Light", "pairs", "acne %", "leak %",
               "contact %", "edge %", "aside %", "error", "rmse", "ssim");
    for (const VerifiedLight& light : result.lights) {
        const std::string room = light.hasShadowmap ? "" : " (no map)";
        printRow(fmt::format("#{} {}{}", light.index, light.name, room), light.figures.opaque,
                 light.figures.setAside());
    }
    printRow("total", result.total.opaque, result.total.setAside());
    if (result.total.subsurface.pairs != 0) printRow("total, subsurface", result.total.subsurface, 1.0);
    const Figures& f = result.total.opaque;
    fmt::print("\nVisibility error: {:.5f}, the mean of |result - truth| over {} pairs, edges included.\n",
               f.visibilityError(), f.comparedPairs);
    fmt::print("Acne and leak together: {} % of {} pairs ({} lit, {} dark, {} facing away; {} at edges).\n",
               percent(f.share(f.acne + f.leak)), f.pairs, f.lit, f.dark, f.away, f.edges);
    fmt::print("Faint acne (truth lit, result 0.5 to 0.9): {} %; faint leak (truth dark, result 0.1 to 0.5): {} %.\n",
               percent(f.share(f.faintAcne)), percent(f.share(f.faintLeak)));
    fmt::print("Contact leak: {} % of the {} pairs that a blocker touches.\n", percent(f.contactLeakOfContacts()),
               f.contacts);
    if (f.penumbraPairs != 0) {
        double low = 0.0, high = 0.0;
        f.penumbraRmseInterval(low, high);
        fmt::print("Penumbra RMSE: {:.4f} to {:.4f} with 95 % confidence, over {} pairs of the subset.\n", low, high,
                   f.penumbraPairs);
    }
    if (result.flickerFrames != 0)
        fmt::print("Flicker: {:.6f} in the mean over {} frames, {} pairs of neighbouring frames.\n",
                   result.flicker.mean(), result.flickerFrames, result.flicker.pairs);
    if (result.unseen != 0) fmt::print("{} casting lights reach no pixel.\n", result.unseen);
    for (const std::string& warning : warningsOf(result)) fmt::print("\nWARNING: {}\n", warning);
    if (!result.sweep.empty()) printSweep(result.sweep);
}

void writeVerified(const Session& session, const VerifyOptions& options, const VerifyResult& result,
                   const std::filesystem::path& file) {
    Json out = describe(session);
    out["settings"].update({{"rays", options.rays},
                            {"subset", options.subset},
                            {"edgeSet", options.edgeSet},
                            {"onlyLights", options.lights}});
    Json lights = Json::array();
    for (const VerifiedLight& light : result.lights) {
        Json row = {{"index", light.index},
                    {"name", light.name},
                    {"kind", nameOf(light.kind)},
                    {"hasShadowmap", light.hasShadowmap}};
        row.update(describe(light.figures));
        if (result.flickerFrames != 0) row["flicker"] = light.flicker.mean();
        row["subsurface"] = describe(light.figures.subsurface);
        lights.push_back(row);
    }
    out["total"] = describe(result.total);
    out["total"]["flicker"] = result.flickerFrames == 0 ? Json() : Json(result.flicker.mean());
    out["flickerFrames"] = result.flickerFrames;
    out["subsurface"] = describe(result.total.subsurface);
    out["lights"] = lights;
    out["castingLightsUnseen"] = result.unseen;
    out["lightsLeftOut"] = result.lightsLeftOut;
    out["warnings"] = warningsOf(result);
    if (!result.sweep.empty()) describeSweep(result.sweep, out);
    out["seconds"] = result.seconds;
    writeJson(out, file);
}

}  // namespace gnomon::app
