// gnomon verify: the shadows of one frame against ray-traced truth, light by light.

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>

#include "app/commands.h"
#include "app/errors.h"
#include "app/export_lights.h"
#include "app/option_checks.h"
#include "app/outputs.h"
#include "app/progress.h"
#include "app/verify/verification.h"

namespace gnomon::app {
namespace {

constexpr double kMostConstant = 1e9, kMostSlope = 1e3;

// What --sweep judges beside the chosen bias.
std::vector<BiasSetting> sweepOf(const VerifyOptions& options) {
    if (!options.sweep) return {};
    if (!options.settings.hardwareBias.empty() || options.settings.bias.starts_with("hardware"))
        throw UsageError("--sweep draws with hardware biases itself: leave --hardware-bias and --bias hardware out.");
    return settingsOfSweep(options.settings.bias,
                           parseSweepNumbers(options.sweepConstants, "constant factors", kMostConstant),
                           parseSweepNumbers(options.sweepSlopes, "slope factors", kMostSlope));
}

void verifyWithin(const renderer::VulkanInstance& instance, const VerifyOptions& options) {
    const Session session(instance, options.settings);
    for (const std::uint32_t light : options.lights) checkLight(light, session.scene());
    exportLights(session, options.exportedLights, options.settings.time, options.lights);
    const Stopwatch setUp;
    Verification verification(session, options, sweepOf(options));
    sayProgress(fmt::format("Drawn, and made ready to trace, in {:.1f} s.", setUp.seconds()));
    const VerifyResult result = verification.run();
    if (!options.json.empty()) writeVerified(session, options, result, options.json);
    printVerified(session, result);
    if (!options.maps.empty()) fmt::print("Written: maps of {} lights in {}\n", result.lights.size(), options.maps);
}

void prepareFolder(const std::string& folder) {
    if (folder.empty()) return;
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (!std::filesystem::is_directory(folder))
        throw UsageError(fmt::format("'{}' is no folder and cannot be made one.", folder));
    for (const char* file : {"light_000.png", "total.png"})
        renderer::checkWritable(std::filesystem::path(folder) / file);
}

int verify(const VerifyOptions& options) {
    sweepOf(options);
    rendererDescOf(options.settings);  // refuses wrong settings before anything is started
    if (options.settings.unquantised)
        throw UsageError("--unquantised has no meaning here: verify reads what is stored.");
    // What is refused leaves no folder behind. A file within a folder that is still to be made has to wait for it.
    requireExtension(options.exportedLights, ".gltf");
    const std::string outputs[] = {options.json, options.exportedLights};
    const auto outside = [&](const std::string& file) { return liesIn(file, options.maps) ? std::string() : file; };
    const std::string first[] = {outside(options.json), outside(options.exportedLights)};
    checkOutputs(first, {&options.settings.scene, 1});
    prepareFolder(options.maps);
    checkOutputs(outputs, {&options.settings.scene, 1});
    const renderer::VulkanInstance instance(instanceDescOf(options.settings));
    verifyWithin(instance, options);
    return exitCodeOf(instance, options.settings);
}

}  // namespace

void addVerifyCommand(CLI::App& app, Work& chosen) {
    CLI::App* command = app.add_subcommand("verify", "Compare the shadows of one frame with ray-traced truth");
    const auto options = std::make_shared<VerifyOptions>();
    command->add_option("--json", options->json, "All figures, a JSON file")->check(fileName());
    addExportLights(*command, options->exportedLights);
    command->add_option("--maps", options->maps, "A folder for one picture per light: truth, result, errors")
        ->check([](const std::string& name) { return name.empty() ? "give a folder's name" : std::string(); });
    command->add_option("--light", options->lights, "Only this light of the scene, counted from 0; may be repeated");
    command->add_option("--rays", options->rays, "Soft truth: rays to the source, rounded up to a square number")
        ->check(CLI::Range(256u, 65536u))
        ->capture_default_str();
    command->add_option("--subset", options->subset, "Soft truth is traced for one tile out of so many")
        ->check(CLI::IsMember({1, 4, 16}))
        ->capture_default_str();
    command
        ->add_option(
            "--flicker", options->flickerFrames,
            "Also measure how much shadows change over so many frames, while the camera moves sideways by 1 cm each")
        ->check(CLI::Range(2u, 10'000u));
    command
        ->add_option(
            "--edge-set", options->edgeSet,
            "Where edges are looked for around a pixel: as far as pixels and shadow texels reach on its face, or in "
            "a circle on it")
        ->check(CLI::IsMember({"footprint", "circle"}))
        ->capture_default_str();
    CLI::Option* sweep = command->add_flag("--sweep", options->sweep,
                                           "Also all other biases against the same truth: hardware biases in a grid");
    command->add_option("--sweep-constants", options->sweepConstants, "Constant factors of the grid, parted by commas")
        ->needs(sweep)
        ->capture_default_str();
    command->add_option("--sweep-slopes", options->sweepSlopes, "Slope factors of the grid, parted by commas")
        ->needs(sweep)
        ->capture_default_str();
    addSettings(*command, options->settings);
    command->callback([&chosen, options] { chosen = [options] { return verify(*options); }; });
}

}  // namespace gnomon::app
