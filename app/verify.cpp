// gnomon verify: the shadows of one frame against ray-traced truth, light by light.

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <numeric>

#include "app/commands.h"
#include "app/errors.h"
#include "app/outputs.h"
#include "app/progress.h"
#include "app/session.h"
#include "app/verify_maps.h"
#include "app/verify_report.h"
#include "renderer/scene/pose.h"

namespace gnomon::app {
namespace {

using renderer::LightTruthDesc;

constexpr float kFlickerStepMetres = 0.01f;

struct VerifyOptions {
    Settings settings;
    std::string json, maps, edgeSet = "footprint";
    std::vector<std::uint32_t> lights;  // empty: all
    std::uint32_t rays = 256, subset = 16, flickerFrames = 0;
};

class Verification {
public:
    Verification(const Session& session, const VerifyOptions& options)
        : session_(session),
          options_(options),
          renderer_(session.device(), session.scene(), session.rendererDesc()),
          pose_(poseAt(session.scene(), options.settings.time)),
          camera_(posedCamera(session.scene(), pose_, session.camera())),
          traced_(session.scene(), pose_, glm::dvec3(camera_.worldFromCamera[3])),
          extent_{session.rendererDesc().widthPx, session.rendererDesc().heightPx} {
        camera_.node = renderer::kNone;  // posed already
        drawFrom(camera_);
    }

    VerifyResult run() {
        const Stopwatch watch;
        VerifyResult result;
        std::vector<std::uint32_t> wanted = options_.lights;
        if (wanted.empty()) {
            wanted.resize(pose_.lights.size());
            std::iota(wanted.begin(), wanted.end(), 0u);
        }
        std::erase_if(wanted, [&](std::uint32_t i) { return !pose_.lights[i].casts; });
        double said = -1.0;
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            verifyLight(wanted[i], result);
            if (i + 1 != wanted.size() && watch.seconds() - said < 1.0) continue;
            said = watch.seconds();
            sayProgress(fmt::format("Light {} of {}, {:.1f} s.", i + 1, wanted.size(), said));
        }
        if (options_.flickerFrames != 0) measureFlicker(result);
        result.seconds = watch.seconds();
        return result;
    }

private:
    void drawFrom(const renderer::SceneCamera& camera) {
        renderer_.renderFrame(camera, renderer::ShadowMode::Deferred, options_.settings.time);
        receivers_ = receiversOf(traced_, camera, extent_.widthPx, extent_.heightPx, renderer_.readTriangleIds());
    }

    [[nodiscard]] LightTruthDesc truthDescOf(std::uint32_t index) const {
        LightTruthDesc desc;
        desc.light = pose_.lights[index];
        desc.views = renderer_.shadowViews(index);
        desc.viewsOrigin = renderer_.frameOrigin();
        desc.soft = soft();
        desc.softRaysPerSide = raysPerSide();
        desc.subsetOf = options_.subset;
        desc.seed = options_.settings.seed * 1'000'003u + index;
        desc.edgeSet = options_.edgeSet == "circle" ? renderer::EdgeSet::Circle : renderer::EdgeSet::Footprint;
        return desc;
    }

    // The camera moves sideways, the scene stands still.
    void measureFlicker(VerifyResult& result) {
        std::vector<renderer::FlickerMeter> meters(result.lights.size());
        FrameProgress progress(options_.flickerFrames);
        for (std::uint32_t frame = 0; frame < options_.flickerFrames; ++frame) {
            renderer::SceneCamera camera = camera_;
            const glm::vec3 right = glm::normalize(glm::vec3(camera.worldFromCamera[0]));
            camera.worldFromCamera[3] += glm::vec4(static_cast<float>(frame) * kFlickerStepMetres * right, 0.0f);
            drawFrom(camera);
            for (std::size_t i = 0; i < meters.size(); ++i) {
                LightTruthDesc desc = truthDescOf(result.lights[i].index);
                desc.soft = false;
                meters[i].add(traceLight(traced_, receivers_, extent_, desc),
                              renderer_.readVisibility(result.lights[i].index));
            }
            progress.step();
        }
        result.flickerFrames = options_.flickerFrames;
        for (std::size_t i = 0; i < meters.size(); ++i) {
            result.lights[i].flicker = meters[i].figures();
            result.flicker += meters[i].figures();
        }
    }

    void verifyLight(std::uint32_t index, VerifyResult& result) {
        const std::vector<float> visibility = renderer_.readVisibility(index);
        const LightTruthDesc desc = truthDescOf(index);
        renderer::LightTruth truth = traceLight(traced_, receivers_, extent_, desc);
        completeSoftTruth(truth, traced_, receivers_, desc, visibility);
        VerifiedLight light;
        light.index = index;
        light.name = desc.light.name;
        light.kind = desc.light.kind;
        light.hasShadowmap = !desc.views.empty();
        light.figures = figuresOf(truth, visibility, soft());
        if (light.figures.opaque.pairs + light.figures.subsurface.pairs == 0) {
            ++result.unseen;
            return;
        }
        if (!options_.maps.empty())
            writePng(errorMap(ofEveryPixel(truth), visibility, extent_, soft()),
                     std::filesystem::path(options_.maps) / mapFileName(light));
        result.total += light.figures;
        result.lights.push_back(std::move(light));
    }

    [[nodiscard]] bool soft() const { return session_.rendererDesc().filter == Filter::Pcss; }
    [[nodiscard]] std::uint32_t raysPerSide() const {
        std::uint32_t side = 1;
        while (side * side < options_.rays) ++side;
        return side;
    }

    const Session& session_;
    const VerifyOptions& options_;
    renderer::Renderer renderer_;
    renderer::Pose pose_;
    renderer::SceneCamera camera_;
    renderer::TracedScene traced_;
    renderer::TruthExtent extent_;
    std::vector<renderer::TruthReceiver> receivers_;
};

void verifyWithin(const renderer::VulkanInstance& instance, const VerifyOptions& options) {
    const Session session(instance, options.settings);
    for (const std::uint32_t light : options.lights)
        if (light >= session.scene().lights.size())
            throw UsageError(fmt::format("There is no light #{}: the scene has {}, counted from 0.", light,
                                         session.scene().lights.size()));
    const Stopwatch setUp;
    Verification verification(session, options);
    sayProgress(fmt::format("Drawn, and made ready to trace, in {:.1f} s.", setUp.seconds()));
    const VerifyResult result = verification.run();
    if (!options.json.empty()) writeJson(describe(session, result), options.json);
    printVerified(session, result);
    if (!options.maps.empty()) fmt::print("Written: maps of {} lights in {}\n", result.lights.size(), options.maps);
}

void prepareFolder(const std::string& folder) {
    if (folder.empty()) return;
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (!std::filesystem::is_directory(folder))
        throw UsageError(fmt::format("'{}' is no folder and cannot be made one.", folder));
    renderer::checkWritable(std::filesystem::path(folder) / "light_000.png");
}

int verify(const VerifyOptions& options) {
    rendererDescOf(options.settings);  // refuses wrong settings before anything is started
    if (options.settings.unquantised)
        throw UsageError("--unquantised has no meaning here: verify reads what is stored.");
    checkOutputs({&options.json, 1}, {&options.settings.scene, 1});
    prepareFolder(options.maps);
    const renderer::VulkanInstance instance(instanceDescOf(options.settings));
    verifyWithin(instance, options);
    return exitCodeOf(instance, options.settings);
}

}  // namespace

void addVerifyCommand(CLI::App& app, Work& chosen) {
    CLI::App* command = app.add_subcommand("verify", "Compare the shadows of one frame with ray-traced truth");
    const auto options = std::make_shared<VerifyOptions>();
    addSettings(*command, options->settings);
    command->add_option("--json", options->json, "All figures, a JSON file")->check(fileName());
    command->add_option("--maps", options->maps, "A folder for one picture per light: truth, result, errors")
        ->check(fileName());
    command->add_option("--light", options->lights, "Only this light of the scene, counted from 0; may be repeated");
    command->add_option("--rays", options->rays, "Soft truth: rays to the source, rounded up to a square number")
        ->check(CLI::Range(256u, 65536u))
        ->capture_default_str();
    command->add_option("--subset", options->subset, "Soft truth is traced for one tile of pixels in so many")
        ->check(CLI::IsMember({1, 4, 16}))
        ->capture_default_str();
    command
        ->add_option("--flicker", options->flickerFrames,
                     "Also so many frames of a camera that moves sideways, 1 cm each: how much shadows change")
        ->check(CLI::Range(2u, 10'000u));
    command
        ->add_option("--edge-set", options->edgeSet,
                     "Around a pixel: as far as pixels and shadow texels fall on its face, or a circle on it")
        ->check(CLI::IsMember({"footprint", "circle"}))
        ->capture_default_str();
    command->callback([&chosen, options] { chosen = [options] { return verify(*options); }; });
}

}  // namespace gnomon::app
