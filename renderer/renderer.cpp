#include "renderer/renderer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "renderer/frame/camera.h"
#include "renderer/frame/frame.h"
#include "renderer/frame/lights.h"
#include "renderer/frame/readback.h"
#include "renderer/frame/shadowmaps.h"
#include "renderer/gbuffer/gbuffer.h"
#include "renderer/gpu/error.h"
#include "renderer/gpu/gpu_scene.h"
#include "renderer/lighting/light_visibility.h"
#include "renderer/lighting/lighting.h"
#include "renderer/shadow_atlas/plan.h"
#include "scene/pose.h"

namespace gnomon::renderer {
namespace {

constexpr std::uint32_t kFramesInFlight = GpuScene::kFramesInFlight;

std::unique_ptr<Timeline> makeTimeline(const Context& context) {
    std::unique_ptr<Timeline> timeline;
    require(Timeline::create(context, {.framesInFlight = kFramesInFlight}, timeline));
    return timeline;
}

std::shared_ptr<SharedPipelines> pipelinesFor(const Device& device, const RendererDesc& desc,
                                              std::shared_ptr<SharedPipelines> given) {
    if (given == nullptr) return std::make_shared<SharedPipelines>(device, desc.subgroupSize);
    if (&given->device() != &device || given->wantedSubgroupSize() != desc.subgroupSize)
        throw GpuError("Renderers can share pipelines of one device and one subgroup size only.");
    return given;
}

ShadowPlanCamera planCameraOf(const SceneCamera& given, const GBufferCamera& gbuffer, const glm::dvec3& origin,
                              std::uint32_t widthPx, std::uint32_t heightPx) {
    const SceneCamera camera = fittedCamera(given, widthPx, heightPx);
    ShadowPlanCamera c;
    c.position = glm::dvec3(camera.worldFromCamera[3]);
    c.pixelsPerRadian = static_cast<float>(heightPx) / (2.0f * std::tan(0.5f * camera.verticalFieldOfView));
    c.orthographic = camera.orthographic;
    c.pixelsPerMetre = static_cast<float>(heightPx) / (2.0f * std::max(camera.orthographicHalfHeight, 1e-6f));
    c.frustum = cullVolumeOf(gbuffer.clipFromWorld, origin);
    const double aspect = static_cast<double>(widthPx) / heightPx;
    const double tangent = std::tan(0.5 * static_cast<double>(camera.verticalFieldOfView));
    c.cascades.position = c.position;
    c.cascades.forward = -glm::normalize(glm::dvec3(camera.worldFromCamera[2]));
    c.cascades.tangent = tangent * std::hypot(aspect, 1.0);
    if (camera.orthographic)
        c.cascades.halfDiagonalMetres = static_cast<double>(camera.orthographicHalfHeight) * std::hypot(aspect, 1.0);
    return c;
}

ShadowPlanSettings planSettingsOf(const Device& device, const RendererDesc& desc) {
    ShadowPlanSettings settings;
    const std::uint32_t largest = std::bit_floor(device.limits().maxFramebufferWidth);
    const std::uint32_t wanted =
        desc.atlasSizePx != 0 ? desc.atlasSizePx : ShadowAtlasImage::defaultSizePx(device, desc.frame.heightPx);
    settings.atlasSizePx = std::min(std::bit_floor(wanted), largest);
    return settings;
}

void requireReachable(const glm::vec3& position, const char* what, const std::string& name) {
    if (std::max({std::abs(position.x), std::abs(position.y), std::abs(position.z)}) <= kFarthestMetres) return;
    throw PoseError(std::string("An animation throws the ") + what + " '" + name.substr(0, 60) +
                    "' farther than 100,000 km from the origin.");
}

}  // namespace

struct Renderer::State {
    const Device& device;
    FrameSettings settings;
    Scene posable;
    Pose pose;
    const std::vector<SceneLight>& sceneLights = pose.lights;
    std::vector<ShadowLight> shadowLights;
    std::shared_ptr<SharedPipelines> pipelines;
    std::unique_ptr<Timeline> timeline;
    GpuScene scene;
    GBuffer gbuffer;
    ShadowPlanner planner;
    Shadowmaps shadowmaps;
    Lighting lighting;
    Commands commands[kFramesInFlight];
    std::unique_ptr<LightVisibility> lightVisibility;  // from the first time that it is asked for
    ShadowPlan lastPlan;
    ShadowSettings lastShadows;
    VkExtent2D lastExtent{};
    Camera lastCamera;
    glm::dvec3 lastOrigin{0.0};
    std::uint64_t frameNumber = 0;
    std::uint32_t resizes = 0;
    struct Known {
        std::uint64_t frameNumber = ~0ull;
        const View* view = nullptr;
        FrameReport report;  // all but statistics and passes
    } known[kFramesInFlight];

    State(const Device& d, const Scene& s, const RendererDesc& r, std::shared_ptr<SharedPipelines> p)
        : device(d),
          settings(r.frame),
          posable(posablePart(s)),
          pose(poseAt(posable, 0.0)),
          pipelines(pipelinesFor(d, r, std::move(p))),
          timeline(makeTimeline(pipelines->context())),
          scene(d, s),
          gbuffer(d, scene, r.frame.widthPx, r.frame.heightPx),
          planner(planSettingsOf(d, r)),
          shadowmaps(d, pipelines->context(), scene, r, planner.settings().atlasSizePx, kFramesInFlight),
          lighting(d, pipelines->lighting(), s, gbuffer, r.floatPicture ? PictureFormat::Float : PictureFormat::Half),
          commands{Commands(d), Commands(d)} {
        std::ranges::transform(sceneLights, std::back_inserter(shadowLights), shadowLightOf);
        takePose();
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    void setTime(double seconds);
    void takePose();
    void growTo(std::uint32_t widthPx, std::uint32_t heightPx);
    PreparedLights prepareLights(View& view, const Camera& camera, const glm::dvec3& origin);
    ShadowPlan planShadows(const PreparedLights& prepared, const SceneCamera& sceneCamera, const Camera& camera,
                           const glm::dvec3& origin);
    void beginView(Shadowmaps::Pair& maps, const PreparedLights& prepared, const ShadowPlan& plan,
                   const ShadowSettings& shadows);
};

Renderer::Renderer(const Device& device, const Scene& scene, const RendererDesc& desc,
                   std::shared_ptr<SharedPipelines> pipelines)
    : state_(std::make_unique<State>(device, scene, desc, std::move(pipelines))) {}

Renderer::~Renderer() {
    if (state_ != nullptr) state_->device.waitIdle();
}

void Renderer::set(const FrameSettings& settings) {
    if (settings.filters.empty()) throw GpuError("FrameSettings::filters names no filter.");
    state_->growTo(settings.widthPx, settings.heightPx);
    state_->settings = settings;
}

const FrameSettings& Renderer::settings() const {
    return state_->settings;
}

void Renderer::prepare(ShadowMode mode) {
    State& s = *state_;
    const ShadowSettings shadows = librarySettings(s.sceneLights, s.settings);
    LightingPipelines& lighting = s.pipelines->lighting();
    const PictureFormat format = s.lighting.format();
    require(s.pipelines->context().prepare(shadows));
    switch (mode) {
        case ShadowMode::Deferred:
            lighting.get(LightingKind::Deferred, shadows, {}, format);
            lighting.get(LightingKind::Evaluate, shadows, {}, format);
            break;
        case ShadowMode::Inline:
            lighting.get(LightingKind::Inline, shadows, s.settings.inlineVariant, format);
            break;
        case ShadowMode::Off:
            lighting.get(LightingKind::Unshadowed, shadows, s.settings.inlineVariant, format);
            break;
    }
}

// The images hold the largest extent that was asked for; smaller frames use a part of them.
void Renderer::State::growTo(std::uint32_t widthPx, std::uint32_t heightPx) {
    const VkExtent2D now = gbuffer.extent();
    if (widthPx <= now.width && heightPx <= now.height) return;
    device.waitIdle();
    const std::uint32_t width = std::max(widthPx, now.width), height = std::max(heightPx, now.height);
    shadowmaps.growTo(width, height);  // first: what fails here can be tried again
    gbuffer.resize(width, height);
    lighting.resize(gbuffer);
    lightVisibility.reset();
    ++resizes;
}

void Renderer::State::setTime(double seconds) {
    if (seconds == pose.timeSeconds || !isAnimated(posable)) return;
    poseAt(posable, seconds, pose);
    takePose();
}

void Renderer::State::takePose() {
    scene.setPose(pose);
    for (std::size_t i = 0; i < sceneLights.size(); ++i) {
        if (sceneLights[i].node == kNone) continue;
        requireReachable(sceneLights[i].position, "light", sceneLights[i].name);
        shadowLights[i] = shadowLightOf(sceneLights[i]);
    }
}

// Phase 1: which lights are visible.
PreparedLights Renderer::State::prepareLights(View& view, const Camera& camera, const glm::dvec3& origin) {
    const std::vector<Light> lights = libraryLights(sceneLights, origin, settings);
    ViewInput input;
    input.camera = camera;
    input.widthPx = settings.widthPx;
    input.heightPx = settings.heightPx;
    input.lights = lights;
    PreparedLights prepared;
    require(view.prepare(input, prepared));
    return prepared;
}

ShadowPlan Renderer::State::planShadows(const PreparedLights& prepared, const SceneCamera& sceneCamera,
                                        const Camera& camera, const glm::dvec3& origin) {
    chooseCasters(sceneLights, prepared, shadowLights);
    const ShadowPlanCamera seenBy =
        planCameraOf(sceneCamera, gbufferCameraOf(camera), origin, settings.widthPx, settings.heightPx);
    planner.setFaceGuardTexels(settings.faceGuardTexels);
    ShadowPlan plan = planner.plan(shadowLights, seenBy, scene.parts(seenBy.frustum), origin, settings.history);
    limitBiases(sceneLights, settings, plan.views);
    return plan;
}

// Everything else that the library wants to know of the frame.
void Renderer::State::beginView(Shadowmaps::Pair& maps, const PreparedLights& prepared, const ShadowPlan& plan,
                                const ShadowSettings& shadows) {
    const std::vector<LightShadowViews> lights = lightViews(prepared, plan);
    std::vector<ShadowView> views;
    views.reserve(plan.views.size());
    for (const PlannedView& planned : plan.views) views.push_back(planned.view);
    const ShadowAtlas atlases[] = {maps.atlas.atlas()};
    FrameDesc frame;
    frame.frameNumber = frameNumber;
    frame.settings = shadows;
    frame.lightViews = lights;
    frame.shadowViews = views;
    frame.depth = {gbuffer.depth().view()};
    if (settings.readFaceNormals) frame.faceNormals = {gbuffer.view(GBuffer::FaceNormal)};
    frame.receiverFlags = {gbuffer.view(GBuffer::Receiver)};
    frame.atlases = atlases;
    frame.timeline = timeline.get();
    require(maps.view->beginFrame(frame));
}

std::uint64_t Renderer::renderFrame(const SceneCamera& cameraAtRest, ShadowMode mode, double timeSeconds) {
    State& s = *state_;
    s.setTime(timeSeconds);
    const SceneCamera sceneCamera = posedCamera(s.posable, s.pose, cameraAtRest);
    requireReachable(glm::vec3(sceneCamera.worldFromCamera[3]), "camera", sceneCamera.name);
    const std::uint64_t number = s.frameNumber;
    const glm::dvec3 origin = frameOriginOf(sceneCamera);
    const Camera camera =
        cameraOf(sceneCamera, origin, s.settings.widthPx, s.settings.heightPx, s.settings.deviceDepth);
    ShadowSettings shadows = librarySettings(s.sceneLights, s.settings);
    shadows.shadowBounds = shadows.shadowBounds && mode != ShadowMode::Off;

    Commands& commands = s.commands[number % kFramesInFlight];
    const VkCommandBuffer c = commands.begin();
    s.timeline->beginFrame(c, number);
    s.scene.recordTransforms(c, origin);

    Shadowmaps::Pair& maps = s.shadowmaps.pairFor(s.settings.drawing);
    const PreparedLights prepared = s.prepareLights(*maps.view, camera, origin);
    ShadowPlan plan = s.planShadows(prepared, sceneCamera, camera, origin);
    maps.atlas.prepare(s.scene, s.shadowLights, plan);
    s.beginView(maps, prepared, plan, shadows);
    const FrameParts parts = {s.device, s.scene, s.gbuffer, maps.atlas, *maps.view, s.lighting, *s.timeline};
    const FrameInput view = {
        gbufferCameraOf(camera), {s.settings.widthPx, s.settings.heightPx}, mode, shadows, s.settings.inlineVariant};
    const ShadowAtlasStatistics drawn = recordFrame(c, parts, view);
    commands.submit();

    State::Known& known = s.known[number % kFramesInFlight];
    known = {};
    known.frameNumber = number;
    known.view = maps.view.get();
    known.report.shadowViews = static_cast<std::uint32_t>(plan.views.size());
    known.report.shadowViewsDrawn = drawn.viewsDrawn;
    known.report.shadowTrianglesDrawn = drawn.triangles;
    known.report.shadowLightsShrunk = plan.lightsShrunk;
    known.report.shadowLightsDropped = plan.lightsWithout;
    known.report.atlasSizePx = s.planner.settings().atlasSizePx;
    s.lastPlan = std::move(plan);
    s.lastOrigin = origin;
    s.lastShadows = shadows;
    s.lastExtent = view.extent;
    s.lastCamera = camera;
    ++s.frameNumber;
    return number;
}

void Renderer::wait() {
    for (Commands& commands : state_->commands) commands.wait();
}

FrameReport Renderer::report(std::uint64_t frameNumber) const {
    const State& s = *state_;
    const State::Known& known = s.known[frameNumber % kFramesInFlight];
    FrameReport report = known.report;
    if (known.frameNumber != frameNumber || !known.view->statistics(frameNumber, report.statistics)) {
        throw GpuError("The report of a frame was asked for that is not known any more.");
    }
    const std::span<const TimelineRow> rows = s.timeline->rows(frameNumber);
    report.passes.assign(rows.begin(), rows.end());
    return report;
}

HdrPicture Renderer::readPicture() {
    wait();
    return pictureIn(state_->device, state_->lighting.picture(), state_->lastExtent);
}

std::vector<std::uint32_t> Renderer::readTriangleIds() {
    State& s = *state_;
    wait();
    std::vector<std::uint32_t> ids = triangleIdsIn(s.device, s.gbuffer, s.lastExtent);
    for (std::uint32_t& id : ids) id = s.scene.trianglePosition(id);
    return ids;
}

std::vector<float> Renderer::readDepth() {
    wait();
    return depthsIn(state_->device, state_->gbuffer, state_->lastExtent, state_->lastCamera);
}

std::vector<glm::vec3> Renderer::readNormals() {
    wait();
    return normalsIn(state_->device, state_->gbuffer, state_->lastExtent);
}

std::vector<float> Renderer::readVisibility(std::uint32_t light) {
    State& s = *state_;
    wait();
    const VkExtent2D whole = s.gbuffer.extent();
    if (s.lightVisibility == nullptr)
        s.lightVisibility =
            std::make_unique<LightVisibility>(s.device, s.pipelines->lightVisibility(), whole.width, whole.height);
    return s.lightVisibility->read(*s.shadowmaps.current().view, s.lastShadows, light, s.lastExtent.width,
                                   s.lastExtent.height);
}

std::vector<ShadowView> Renderer::shadowViews(std::uint32_t light) const {
    std::vector<ShadowView> views;
    for (const PlannedView& planned : state_->lastPlan.views)
        if (planned.light == light) views.push_back(planned.view);
    return views;
}

glm::dvec3 Renderer::frameOrigin() const {
    return state_->lastOrigin;
}

std::vector<MemoryUseRow> Renderer::memory() const {
    const State& s = *state_;
    std::vector<MemoryUseRow> rows;
    for (const BufferMemory& buffer : libraryMemory().buffers())
        rows.push_back({buffer.name, buffer.bytes, true, buffer.perFrame ? kFramesInFlight : 1u});
    for (const auto& part : {s.scene.memoryRows(), s.gbuffer.memoryRows(), s.shadowmaps.current().atlas.memoryRows(),
                             s.lighting.memoryRows()}) {
        for (const MemoryRow& row : part) rows.push_back({row.name, row.bytes, false, 1u});
    }
    return rows;
}

const MemoryReport& Renderer::libraryMemory() const {
    return state_->shadowmaps.current().view->memory();
}
std::uint32_t Renderer::subgroupSize() const {
    return state_->pipelines->context().subgroupSize();
}
RendererCounts Renderer::counts() const {
    const State& s = *state_;
    return {s.pipelines->context().pipelineCount(), static_cast<std::uint32_t>(s.pipelines->lighting().count()),
            s.shadowmaps.count(), s.resizes};
}

}  // namespace gnomon::renderer
