#include "app/verify/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "app/progress.h"

namespace gnomon::app {
namespace {

using renderer::LightTruthDesc;

constexpr float kFlickerStepMetres = 0.01f;
// Truth kept at one time: that of one light may come on top. 128 million pairs of pixel and light.
constexpr std::size_t kMostTruthBytes = std::size_t{2} << 30;

std::uint32_t sideOfSquare(std::uint32_t rays) {
    std::uint32_t side = 1;
    while (side * side < rays) ++side;
    return side;
}

renderer::SubsurfaceRule ruleOf(const renderer::FrameSettings& desc) {
    return {desc.drawing.subsurfaceFronts, static_cast<double>(desc.subsurfaceBiasMetres)};
}

bool sameView(const ShadowView& a, const ShadowView& b) {
    return std::memcmp(a.clipFromWorld, b.clipFromWorld, sizeof(a.clipFromWorld)) == 0 && a.xPx == b.xPx &&
           a.yPx == b.yPx && a.widthPx == b.widthPx && a.heightPx == b.heightPx;
}

}  // namespace

Verification::Verification(const Session& session, const VerifyOptions& options, std::vector<BiasSetting> others)
    : session_(session),
      options_(options),
      others_(std::move(others)),
      pose_(poseAt(session.scene(), options.settings.time)),
      camera_(posedCamera(session.scene(), pose_, session.camera())),
      traced_(session.scene(), pose_, glm::dvec3(camera_.worldFromCamera[3]), ruleOf(session.rendererDesc().frame)),
      extent_{session.rendererDesc().frame.widthPx, session.rendererDesc().frame.heightPx},
      renderer_(session.device(), session.scene(), session.rendererDesc()) {
    camera_.node = renderer::kNone;
    const std::uint64_t frame = drawFrom(camera_);
    lightsLeftOut_ = renderer_.report(frame).statistics.lights.dropped;
    for (const std::uint32_t index : wantedLights()) lights_.push_back({index, truthDescOf(index), {}});
    if (options.maps.empty()) return;
    const renderer::HdrPicture linear = renderer_.readPicture();
    const float exposure = session.scene().exposureEv100.value_or(renderer::automaticExposure(linear));
    maps_ = std::make_unique<VerifyMaps>(options.maps, renderer::toneMap(linear, exposure), soft());
}

std::vector<std::uint32_t> Verification::wantedLights() const {
    std::vector<std::uint32_t> wanted = options_.lights;
    if (wanted.empty()) {
        wanted.resize(pose_.lights.size());
        std::iota(wanted.begin(), wanted.end(), 0u);
    }
    std::ranges::sort(wanted);
    wanted.erase(std::ranges::unique(wanted).begin(), wanted.end());
    std::erase_if(wanted, [&](std::uint32_t i) { return !pose_.lights[i].casts; });
    return wanted;
}

std::uint64_t Verification::drawFrom(const renderer::SceneCamera& camera) {
    const std::uint64_t frame = renderer_.renderFrame(camera, renderer::ShadowMode::Deferred, options_.settings.time);
    receivers_ = receiversOf(traced_, camera, extent_.widthPx, extent_.heightPx, renderer_.readTriangleIds());
    return frame;
}

void Verification::drawSetting(std::size_t setting) {
    if (drawn_ == setting) return;
    const renderer::FrameSettings& chosen = session_.rendererDesc().frame;
    renderer_.set(setting == 0 ? chosen : withBias(chosen, others_[setting - 1]));
    renderer_.renderFrame(camera_, renderer::ShadowMode::Deferred, options_.settings.time);
    drawn_ = setting;
    checkShadowViews();
}

// Biases are compared by shadowmaps of the same size, that see the same.
void Verification::checkShadowViews() const {
    for (const TracedLight& light : lights_)
        if (!std::ranges::equal(light.desc.views, renderer_.shadowViews(light.index), sameView))
            throw std::runtime_error(fmt::format(
                "The shadowmaps of light #{} changed with the depth bias; the sweep compares nothing.", light.index));
}

LightTruthDesc Verification::truthDescOf(std::uint32_t index) const {
    LightTruthDesc desc;
    desc.light = pose_.lights[index];
    desc.views = renderer_.shadowViews(index);
    desc.viewsOrigin = renderer_.frameOrigin();
    desc.soft = soft();
    desc.softRaysPerSide = sideOfSquare(options_.rays);
    desc.subsetOf = options_.subset;
    desc.seed = options_.settings.seed * 1'000'003u + index;
    desc.edgeSet = options_.edgeSet == "circle" ? renderer::EdgeSet::Circle : renderer::EdgeSet::Footprint;
    return desc;
}

void Verification::say(const std::string& sentence, bool last) {
    if (!last && watch_.seconds() - said_ < 1.0) return;
    said_ = watch_.seconds();
    sayProgress(fmt::format("{}, {:.1f} s.", sentence, said_));
}

VerifyResult Verification::run() {
    VerifyResult result;
    result.lightsLeftOut = lightsLeftOut_;
    if (!others_.empty())
        result.sweep.push_back({chosenSetting(options_.settings.bias, session_.rendererDesc().frame), {}});
    for (const BiasSetting& setting : others_) result.sweep.push_back({setting, {}});
    for (std::size_t next = 0; next < lights_.size();) {
        std::vector<TracedLight> some = traceSome(next);
        judgeChosen(some, result);
        judgeOthers(some, result);
    }
    if (maps_ != nullptr) maps_->writeTotal();
    if (!others_.empty()) result.sweep[0].figures = result.total;
    if (options_.flickerFrames != 0) measureFlicker(result);
    result.seconds = watch_.seconds();
    return result;
}

std::vector<Verification::TracedLight> Verification::traceSome(std::size_t& next) {
    std::vector<TracedLight> some;
    std::size_t bytes = 0;
    do {
        TracedLight light = lights_[next++];
        light.truth = traceLight(traced_, receivers_, extent_, light.desc);
        bytes += light.truth.bytes();
        some.push_back(std::move(light));
        say(fmt::format("Light {} of {}", next, lights_.size()), next == lights_.size());
    } while (!others_.empty() && next < lights_.size() && bytes < kMostTruthBytes);
    return some;
}

renderer::LightFigures Verification::judge(TracedLight& light, const std::vector<float>& visibility) const {
    completeSoftTruth(light.truth, traced_, receivers_, light.desc, visibility);
    return figuresOf(light.truth, visibility, soft());
}

// Leaves those that reach no pixel out of `lights`.
void Verification::judgeChosen(std::vector<TracedLight>& lights, VerifyResult& result) {
    drawSetting(0);
    for (TracedLight& light : lights) {
        const std::vector<float> visibility = renderer_.readVisibility(light.index);
        VerifiedLight verified;
        verified.index = light.index;
        verified.name = light.desc.light.name;
        verified.kind = light.desc.light.kind;
        verified.hasShadowmap = !light.desc.views.empty();
        verified.figures = judge(light, visibility);
        if (verified.figures.opaque.pairs + verified.figures.subsurface.pairs == 0) {
            ++result.unseen;
            light.truth = {};
            continue;
        }
        if (maps_ != nullptr) maps_->add(verified, light.truth, visibility);
        result.total += verified.figures;
        result.lights.push_back(std::move(verified));
    }
    std::erase_if(lights, [](const TracedLight& light) { return light.truth.pixels.empty(); });
}

void Verification::judgeOthers(std::vector<TracedLight>& lights, VerifyResult& result) {
    for (std::size_t i = 0; i < others_.size(); ++i) {
        drawSetting(i + 1);
        for (TracedLight& light : lights)
            result.sweep[i + 1].figures += judge(light, renderer_.readVisibility(light.index));
        say(fmt::format("Bias {} of {}: {}", i + 2, others_.size() + 1, nameOf(others_[i])), i + 1 == others_.size());
    }
}

// The camera moves sideways, the scene stands still.
void Verification::measureFlicker(VerifyResult& result) {
    drawSetting(0);
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

}  // namespace gnomon::app
