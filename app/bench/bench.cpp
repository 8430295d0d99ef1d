// Measures variants in one process, in turn, frame by frame. So whatever the machine does meanwhile (clocks, heat,
// other work) meets all of them alike. The ratio is the result.

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <set>

#include "app/bench/preset.h"
#include "app/bench/report.h"
#include "app/commands.h"
#include "app/errors.h"
#include "app/export_lights.h"
#include "app/option_checks.h"
#include "app/outputs.h"
#include "app/progress.h"
#include "app/session.h"
#include "picture/picture.h"

namespace gnomon::app {
namespace {

struct BenchOptions {
    Settings settings;
    std::uint32_t warmUp = 20, frames = 200;
    double framesPerSecond = 0.0;
    std::vector<std::string> variants = {"deferred", "inline"};
    std::string preset, json, lights;
    bool floor = false;
};

// A variant's name is a way to shadow, as in "inline", or that and a depth bias, as in "deferred@hardware".
struct Way {
    renderer::ShadowMode mode = renderer::ShadowMode::Deferred;
    std::string bias;  // empty: that of the settings
};
Way wayOf(const std::string& name) {
    const std::size_t at = name.find('@');
    Way way = {shadowModeOf(name.substr(0, at)), at == std::string::npos ? "" : name.substr(at + 1)};
    renderer::FrameSettings unused;
    if (at != std::string::npos) setBias(way.bias, unused);
    return way;
}

// A renderer remembers two finished frames, so frames go in pairs: submit two, wait, read both.
class PairedFrames {
public:
    explicit PairedFrames(renderer::Renderer& renderer) : renderer_(renderer) {}

    void submit(const renderer::FrameSettings& settings, renderer::ShadowMode mode, const renderer::SceneCamera& camera,
                double timeSeconds, Variant* counting) {
        if (pending_.size() == 2) finish();
        renderer_.set(settings);
        pending_.push_back({renderer_.renderFrame(camera, mode, timeSeconds), counting});
    }

    void finish() {
        renderer_.wait();
        for (const Pending& frame : pending_)
            if (frame.variant != nullptr) frame.variant->add(renderer_.report(frame.number));
        pending_.clear();
    }

private:
    struct Pending {
        std::uint64_t number;
        Variant* variant;  // null while warming up
    };
    renderer::Renderer& renderer_;
    std::vector<Pending> pending_;
};

renderer::FrameSettings settingsOf(const Session& session, const Way& way) {
    renderer::FrameSettings settings = session.rendererDesc().frame;
    settings.inlineVariant.walksMasks = false;
    settings.history = session.settings().history != "off";
    if (!way.bias.empty()) setBias(way.bias, settings);
    return settings;
}

// One renderer for all variants. What each way of drawing shadowmaps has drawn is kept while another has its turn.
renderer::RendererDesc descOf(const Session& session, const std::vector<std::string>& variants) {
    renderer::RendererDesc desc = session.rendererDesc();
    std::vector<renderer::ShadowDrawing> drawings;
    for (const std::string& name : variants) {
        const renderer::ShadowDrawing drawing = settingsOf(session, wayOf(name)).drawing;
        if (std::ranges::find(drawings, drawing) == drawings.end()) drawings.push_back(drawing);
    }
    desc.keptDrawings = static_cast<std::uint32_t>(drawings.size());
    desc.frame = settingsOf(session, wayOf(variants.front()));
    return desc;
}

// What the paper's lists would hold: one more frame.
FrameStatistics countByPixel(const Session& session, PairedFrames& frames, double time) {
    renderer::FrameSettings settings = settingsOf(session, {});
    settings.shadows.lightLists = LightLists::Pixel;
    Variant counted("deferred");
    frames.submit(settings, renderer::ShadowMode::Deferred, session.camera(), time, &counted);
    frames.finish();
    return counted.last().report.statistics;
}

void measure(const BenchOptions& options, Measurement& out) {
    const Session& session = out.session;
    renderer::Renderer renderer(session.device(), session.scene(), descOf(session, options.variants));
    for (const std::string& name : options.variants) {  // no round shall make pipelines
        renderer.set(settingsOf(session, wayOf(name)));
        renderer.prepare(wayOf(name).mode);
    }
    std::vector<Variant>& variants = out.variants;
    variants = {options.variants.begin(), options.variants.end()};
    const std::uint32_t rounds = options.warmUp + options.frames;
    FrameProgress progress(std::uint64_t{rounds} * variants.size());
    PairedFrames frames(renderer);
    std::uint64_t frame = 0;
    for (std::uint32_t round = 0; round < rounds; ++round)
        for (Variant& variant : variants) {
            // Time goes on from frame to frame, so that shadowmaps age alike for all variants.
            const double time = frameTime(options.settings.time, frame++, options.framesPerSecond);
            const Way way = wayOf(variant.name());
            frames.submit(settingsOf(session, way), way.mode, session.camera(), time,
                          round >= options.warmUp ? &variant : nullptr);
            progress.step();
        }
    frames.finish();
    if (options.preset.empty()) return;
    const double time = frameTime(options.settings.time, frame, options.framesPerSecond);
    out.byPixel = countByPixel(session, frames, time);
}

// Inline shading is measured without its way out of full lists, so that it is as fast as it can be.
void checkLists(const std::vector<Variant>& variants) {
    for (const Variant& variant : variants) {
        const FrameStatistics& s = variant.last().report.statistics;
        if (wayOf(variant.name()).mode != renderer::ShadowMode::Deferred && s.listOverflowTiles != 0)
            throw UsageError(
                fmt::format("The light lists have no room for {} tiles, which '{}' cannot shade while it is measured: "
                            "--list-entries {} would hold them.",
                            s.listOverflowTiles, variant.name(), s.recommendedListEntries));
    }
}

void benchWithin(const renderer::VulkanInstance& instance, const BenchOptions& options) {
    const Session session(instance, options.settings);
    exportLights(session, options.lights, options.settings.time, {});
    if (session.device().timestampPeriodNs() == 0.0)
        throw std::runtime_error(fmt::format("'{}' has no timestamps to measure with.", session.device().info().name));
    Measurement measured = {session, {}, std::nullopt, options.warmUp, options.framesPerSecond, std::nullopt};
    measure(options, measured);
    checkLists(measured.variants);
    if (options.floor) measured.rates = renderer::measureDeviceRates(session.device());
    if (!options.json.empty()) writeMeasurement(measured, options.preset, options.json);
    printBench(measured);
    printPreset(options.preset, measured);
}

int bench(const BenchOptions& options) {
    rendererDescOf(options.settings);  // refuses wrong settings before anything is started
    std::set<std::string> names;
    for (const std::string& name : options.variants)
        if (!options.settings.hardwareBias.empty() && name.find('@') != std::string::npos)
            throw UsageError(fmt::format("--hardware-bias does not go with '{}', which has a bias of its own.", name));
    for (const std::string& name : options.variants) {
        wayOf(name);
        if (!names.insert(name).second) throw UsageError(fmt::format("--variants names '{}' twice.", name));
    }
    checkPreset(options.preset, options.variants);
    requireExtension(options.lights, ".gltf");
    const std::string outputs[] = {options.json, options.lights};
    checkOutputs(outputs, {&options.settings.scene, 1});
    const renderer::VulkanInstance instance(instanceDescOf(options.settings));
    benchWithin(instance, options);
    return exitCodeOf(instance, options.settings);
}

}  // namespace

void addBenchCommand(CLI::App& app, Work& chosen) {
    CLI::App* command = app.add_subcommand("bench", "Measure ways to shadow against each other");
    const auto options = std::make_shared<BenchOptions>();
    command->add_option("--warmup", options->warmUp, "Rounds that do not count")
        ->check(CLI::Range(0, 10'000))
        ->capture_default_str();
    command->add_option("--frames", options->frames, "Rounds that count")
        ->check(CLI::Range(1, 100'000))
        ->capture_default_str();
    command->add_option("--fps", options->framesPerSecond, "Frames per second of the animations' time; 0: they stand")
        ->check(numberWithin(0.0, 1e6))
        ->capture_default_str();
    command
        ->add_option(
            "--variants", options->variants,
            "Some of deferred, inline, off, each perhaps with a depth bias of its own, as in deferred@hardware")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--preset", options->preset, "A table of the paper: sets scene, size, filter and variants")
        ->check(CLI::IsMember(presetNames()));
    command->add_flag("--floor", options->floor,
                      "Measure the device's copies and texture samples too, and how far each pass is from them");
    command->add_option("--json", options->json, "Write the measurement to a file")->check(fileName());
    addExportLights(*command, options->lights);
    addSettings(*command, options->settings);
    command->callback([&chosen, options, command] {
        const auto given = [command](const char* option) { return command->get_option(option)->count() != 0; };
        applyPreset(options->preset, given, options->settings, options->variants);
        chosen = [options] { return bench(*options); };
    });
}

}  // namespace gnomon::app
