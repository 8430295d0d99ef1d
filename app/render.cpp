#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "app/commands.h"
#include "app/errors.h"
#include "app/export_lights.h"
#include "app/frame_files.h"
#include "app/frame_json.h"
#include "app/frame_table.h"
#include "app/option_checks.h"
#include "app/outputs.h"
#include "app/progress.h"
#include "app/session.h"
#include "picture/exr.h"
#include "renderer/frame/lights.h"

namespace gnomon::app {
namespace {

struct RenderOptions {
    Settings settings;
    std::string png, exr, statistics, lights;
    std::string exrType = "half";
    FrameFiles files;
    std::string shadows = "deferred";
    std::uint32_t frames = 1;
    double framesPerSecond = 30.0;
    bool sequence = false;
    std::optional<float> exposure;
};

bool floatPicture(const RenderOptions& options) {
    return options.exrType == "float";
}

// name_0000.png
std::string sequenceFile(const std::string& png, std::uint32_t frame) {
    const std::filesystem::path path(png);
    return (path.parent_path() / fmt::format("{}_{:04}{}", path.stem().string(), frame, path.extension().string()))
        .string();
}

// The first frame's exposure holds for all: a sequence must not flicker.
float exposureOf(const renderer::HdrPicture& linear, const Session& session, const RenderOptions& options) {
    return options.exposure                ? *options.exposure
           : session.scene().exposureEv100 ? *session.scene().exposureEv100
                                           : renderer::automaticExposure(linear);
}

FrameResult renderFrames(renderer::Renderer& renderer, const Session& session, const RenderOptions& options) {
    const renderer::ShadowMode mode = shadowModeOf(options.shadows);
    FrameProgress progress(options.frames);
    std::uint64_t last = 0;
    FrameResult result;
    for (std::uint32_t i = 0; i < options.frames; ++i) {
        last =
            renderer.renderFrame(session.camera(), mode, frameTime(options.settings.time, i, options.framesPerSecond));
        if (i + 1 == options.frames) renderer.wait();
        if (options.sequence) {
            const renderer::HdrPicture linear = renderer.readPicture();
            if (i == 0) result.exposureEv100 = exposureOf(linear, session, options);
            renderer::writePng(renderer::toneMap(linear, result.exposureEv100), sequenceFile(options.png, i));
        }
        progress.step();
    }
    result.shadows = options.shadows;
    result.frames = options.frames;
    result.report = renderer.report(last);
    for (std::uint32_t i = 0; i < session.scene().lights.size(); ++i) {
        const renderer::SceneLight& light = session.scene().lights[i];
        std::vector<float>& biases = result.cascadeBiases.emplace_back();
        if (light.kind != renderer::LightKind::Directional) continue;
        const float bias = statedBias(light, renderer.settings()).value_or(renderer::kBiasMetres);
        for (const ShadowView& view : renderer.shadowViews(i))
            biases.push_back(std::clamp(bias, view.leastBias, view.mostBias));
    }
    result.memory = renderer.memory();
    result.library = renderer.libraryMemory();
    return result;
}

void writePictures(renderer::Renderer& renderer, const Session& session, const RenderOptions& options,
                   FrameResult& result) {
    const renderer::HdrPicture linear = renderer.readPicture();
    if (!options.sequence) result.exposureEv100 = exposureOf(linear, session, options);
    const renderer::Picture picture = renderer::toneMap(linear, result.exposureEv100);
    result.hash = renderer::hashOf(picture);
    result.clippedPixels = renderer::clippedPixels(linear);
    result.brightest = linear.brightest;
    if (!options.png.empty() && !options.sequence) renderer::writePng(picture, options.png);
    const renderer::ExrType type = floatPicture(options) ? renderer::ExrType::Float : renderer::ExrType::Half;
    if (!options.exr.empty()) renderer::writeExr(linear, options.exr, type);
}

void printWritten(const RenderOptions& options) {
    if (options.sequence)
        fmt::print("Written: {} to {}\n", sequenceFile(options.png, 0), sequenceFile(options.png, options.frames - 1));
    else if (!options.png.empty())
        fmt::print("Written: {}\n", options.png);
    std::vector<std::string> others = namesOf(options.files);
    others.insert(others.begin(), {options.exr, options.lights});
    for (const std::string& file : others)
        if (!file.empty()) fmt::print("Written: {}\n", file);
}

void renderWithin(const renderer::VulkanInstance& instance, const RenderOptions& options) {
    const Session session(instance, options.settings);
    const std::vector<std::uint32_t> lights = visibilityLights(options.files, session);
    exportLights(session, options.lights, frameTime(options.settings.time, options.frames - 1, options.framesPerSecond),
                 options.settings.onlyLights);
    const Stopwatch setUp;
    renderer::RendererDesc desc = session.rendererDesc();
    desc.floatPicture = floatPicture(options);
    renderer::Renderer renderer(session.device(), session.scene(), desc);
    sayProgress(fmt::format("Set up in {:.1f} s.", setUp.seconds()));
    FrameResult result = renderFrames(renderer, session, options);
    writePictures(renderer, session, options, result);
    writeFrameFiles(renderer, options.files, lights);
    if (!options.statistics.empty()) writeJson(describe(session, result), options.statistics);
    printFrame(session, result);
    printWritten(options);
}

int render(const RenderOptions& options) {
    if (options.exposure && !(std::abs(*options.exposure) <= 40.0f))
        throw UsageError("--exposure must be an EV100 from -40 to 40.");
    rendererDescOf(options.settings);  // refuses wrong settings before anything is started
    if (options.settings.unquantised && options.shadows != "inline")
        throw UsageError("--unquantised goes with --shadows inline alone.");
    checkExtension(options.png, ".png");
    requireExtension(options.exr, ".exr");
    requireExtension(options.lights, ".gltf");
    checkFrameFiles(options.files, options.shadows);
    if (options.sequence && options.png.empty()) throw UsageError("--sequence needs -o NAME.png to name its files by.");
    std::vector<std::string> outputs = namesOf(options.files);
    outputs.insert(outputs.end(), {options.exr, options.statistics, options.lights});
    if (!options.sequence) outputs.push_back(options.png);
    for (std::uint32_t i = 0; options.sequence && i < options.frames; ++i)
        outputs.push_back(sequenceFile(options.png, i));
    checkOutputs(outputs, {&options.settings.scene, 1});
    const renderer::VulkanInstance instance(instanceDescOf(options.settings));
    renderWithin(instance, options);
    return exitCodeOf(instance, options.settings);
}

}  // namespace

void addRenderCommand(CLI::App& app, Work& chosen) {
    CLI::App* command = app.add_subcommand("render", "Render a scene into a picture");
    const auto options = std::make_shared<RenderOptions>();
    command->add_option("-o,--output", options->png, "The picture, a PNG file")->check(fileName());
    CLI::Option* exr = command->add_option("--exr", options->exr, "The linear picture, an EXR file");
    exr->check(fileName());
    command
        ->add_option("--exr-type", options->exrType,
                     "Numbers of the linear picture: half ends at 65504; with float the renderer's picture is of "
                     "32-bit floats, too, and nothing is clipped")
        ->check(CLI::IsMember({"half", "float"}))
        ->needs(exr)
        ->capture_default_str();
    addFrameFiles(*command, options->files);
    command->add_option("--stats", options->statistics, "Times, memory and counters, a JSON file")->check(fileName());
    addExportLights(*command, options->lights);
    command->add_option("--shadows", options->shadows, "How lights are shadowed")
        ->check(CLI::IsMember({"deferred", "inline", "off"}))
        ->capture_default_str();
    command->add_option("--frames", options->frames, "Frames to render; the last is kept, see --sequence")
        ->check(CLI::Range(1, 100'000))
        ->capture_default_str();
    command->add_option("--fps", options->framesPerSecond, "Frames per second of the animations' time")
        ->check(numberWithin(1e-3, 1e6))
        ->capture_default_str();
    command->add_flag("--sequence", options->sequence, "Write every frame, as NAME_0000.png and so on");
    command->add_option("--light", options->settings.onlyLights,
                        "Only this light of the scene shines, counted from 0; may be repeated");
    command->add_option("--exposure", options->exposure, "EV100; without it the scene's own, or from the picture");
    addSettings(*command, options->settings);
    command->callback([&chosen, options] { chosen = [options] { return render(*options); }; });
}

}  // namespace gnomon::app
