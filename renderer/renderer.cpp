#include "renderer/renderer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <utility>

#include "gpu_interface/numbers.h"
#include "gpu_interface/structs.h"
#include "renderer/camera.h"
#include "renderer/gbuffer/gbuffer.h"
#include "renderer/gpu/error.h"
#include "renderer/gpu/gpu_scene.h"
#include "renderer/gpu/timer.h"
#include "renderer/lighting/light_visibility.h"
#include "renderer/lighting/lighting.h"
#include "renderer/shadow_atlas/plan.h"
#include "renderer/shadow_atlas/shadow_atlas.h"
#include "scene/pose.h"

namespace gnomon::renderer {
namespace {

constexpr std::uint32_t kFramesInFlight = GpuScene::kFramesInFlight;

void require(const Result& result) {
    if (!result) throw GpuError(result.message());
}

std::unique_ptr<Context> makeContext(const Device& device, const RendererDesc& desc) {
    const std::uint32_t family = device.queueFamily();
    ContextDesc c;
    c.instance = device.instance().handle();
    c.physicalDevice = device.physical();
    c.device = device.handle();
    c.getInstanceProcAddr = vkGetInstanceProcAddr;
    c.pipelineCache = device.pipelineCache();
    c.queueFamilies = std::span(&family, 1);
    c.debugLabels = device.instance().debugLabels();
    c.subgroupSize = desc.subgroupSize;
    c.filter = desc.filter;
    c.pcfRadius = desc.pcfRadius;
    c.pcss = desc.pcss;
    c.visibilityBits = desc.visibilityBits;
    c.depthBias = desc.depthBias;
    c.facedAwayIsDark = desc.facedAwayIsDark;
    c.maxShadowAtlases = 1;
    c.listReservation = desc.listReservation;
    c.fixedListEntriesPerTile = desc.fixedListEntriesPerTile;
    std::unique_ptr<Context> context;
    require(Context::create(c, context));
    return context;
}

std::unique_ptr<View> makeView(const Context& context, const RendererDesc& desc, std::uint64_t texelsOfAtlas) {
    ViewDesc v;
    v.maxWidthPx = desc.widthPx;
    v.maxHeightPx = desc.heightPx;
    v.framesInFlight = kFramesInFlight;
    v.listEntries = desc.listEntries;
    v.visibilitySlots = desc.visibilitySlots;
    v.shadowBoundsTexels = desc.shadowBounds ? texelsOfAtlas : 0;
    v.maxShadowViews = gpu::kMaxLightsPerView * gpu::kPointLightFaces;
    std::unique_ptr<View> view;
    require(View::create(context, v, view));
    return view;
}

LightType typeOf(LightKind kind) {
    switch (kind) {
        case LightKind::Point:
            return LightType::Point;
        case LightKind::Spot:
            return LightType::Spot;
        case LightKind::Directional:
            return LightType::Directional;
    }
    return LightType::Point;
}

Light lightOf(const SceneLight& light, const glm::dvec3& origin, std::uint32_t firstShadowView,
              std::uint32_t cascadeCount, float defaultBiasMetres) {
    Light l;
    l.type = typeOf(light.kind);
    const glm::vec3 position(glm::dvec3(light.position) - origin);
    std::memcpy(l.position, &position, sizeof(l.position));
    std::memcpy(l.direction, &light.direction, sizeof(l.direction));
    l.rangeMetres = light.rangeMetres;
    l.intensity = light.intensity * std::max({light.colour.x, light.colour.y, light.colour.z});
    l.outerConeAngle = std::min(light.outerConeAngle, 1.55f);
    l.sourceRadius = light.sourceRadius;
    l.biasMetres = light.biasMetres >= 0.0f ? light.biasMetres : defaultBiasMetres;
    l.firstShadowView = firstShadowView;
    l.cascadeCount = cascadeCount;
    return l;
}

ShadowPlanCamera planCameraOf(const SceneCamera& camera, const GBufferCamera& gbuffer, const glm::dvec3& origin,
                              std::uint32_t widthPx, std::uint32_t heightPx) {
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

ShadowPlanSettings planSettingsOf(const Device& device, const Scene& scene, const RendererDesc& desc) {
    ShadowPlanSettings settings;
    const std::uint32_t largest = std::bit_floor(device.limits().maxFramebufferWidth);
    const std::uint32_t wanted =
        desc.atlasSizePx != 0 ? desc.atlasSizePx : ShadowAtlasImage::defaultSizePx(device, desc.heightPx);
    settings.atlasSizePx = std::min(std::bit_floor(wanted), largest);
    const Bounds bounds = animatedBounds(scene, 16);
    if (!bounds.empty()) {
        // Room for what moves, and no box of zero depth.
        const double radius = bounds.radius();
        settings.casters = {glm::dvec3(bounds.centre()), 1.05 * radius + 1e-3};
        settings.cascades.reachMetres = static_cast<float>(std::max(200.0, 2.0 * radius));
    }
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
    RendererDesc desc;
    Scene posable;
    Pose pose;
    const std::vector<SceneLight>& sceneLights = pose.lights;
    std::vector<ShadowLight> shadowLights;
    std::unique_ptr<Context> context;
    std::unique_ptr<View> view;
    GpuScene scene;
    GBuffer gbuffer;
    ShadowPlanner planner;
    ShadowAtlasImage atlas;
    Lighting lighting;
    GpuTimer timer;
    Commands commands[kFramesInFlight];
    std::unique_ptr<Prepare> selection;  // where more lights are given than a view can have
    std::vector<std::byte> selectionMemory;
    std::unique_ptr<LightVisibility> lightVisibility;  // from the first time that it is asked for
    ShadowPlan lastPlan;
    glm::dvec3 lastOrigin{0.0};
    std::uint64_t frameNumber = 0;
    struct Known {
        std::uint64_t frameNumber = ~0ull;
        FrameReport report;  // all but statistics and passes
    } known[kFramesInFlight];

    State(const Device& d, const Scene& s, const RendererDesc& r)
        : device(d),
          desc(r),
          posable(posablePart(s)),
          pose(poseAt(posable, 0.0)),
          context(makeContext(d, r)),
          view(makeView(*context, r,
                        std::uint64_t{planSettingsOf(d, s, r).atlasSizePx} * planSettingsOf(d, s, r).atlasSizePx)),
          scene(d, s),
          gbuffer(d, scene, r.widthPx, r.heightPx),
          planner(planSettingsOf(d, s, r)),
          atlas(d, scene, planner.settings().atlasSizePx, 1, r.shadowDrawing),
          lighting(d, *context, s, gbuffer, {.quantises = r.quantiseInline, .walksMasks = !r.inlineNeedsLists}),
          timer(d, kFramesInFlight),
          commands{Commands(d), Commands(d)} {
        std::ranges::transform(sceneLights, std::back_inserter(shadowLights), shadowLightOf);
        takePose();
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    void setTime(double seconds);
    void takePose();

    std::vector<Light> lightsOf(const glm::dvec3& origin, const ShadowPlan& plan) const;
    void selectCasters(const Camera& camera, const glm::dvec3& origin);
    void beginView(const Camera& camera, const glm::dvec3& origin, const ShadowPlan& plan, ShadowMode mode);
    void recordPasses(VkCommandBuffer c, const GBufferCamera& camera, ShadowMode mode, FrameReport& report);
};

Renderer::Renderer(const Device& device, const Scene& scene, const RendererDesc& desc)
    : state_(std::make_unique<State>(device, scene, desc)) {}

Renderer::~Renderer() {
    if (state_ != nullptr) state_->device.waitIdle();
}

void Renderer::State::setTime(double seconds) {
    if (seconds == pose.timeSeconds || !isAnimated(posable)) return;
    poseAt(posable, seconds, pose);
    takePose();
}

void Renderer::State::takePose() {
    scene.setPose(pose);
    // What leaves the bounds must still cast; with room to spare, so that the cascades rarely change.
    const CasterBounds casters = planner.settings().casters;
    const double reach = scene.reachOfMoved(casters.centre);
    if (reach > casters.radius) planner.setCasters({casters.centre, 1.25 * reach});
    for (std::size_t i = 0; i < sceneLights.size(); ++i) {
        if (sceneLights[i].node == kNone) continue;
        requireReachable(sceneLights[i].position, "light", sceneLights[i].name);
        const bool casts = shadowLights[i].casts;
        shadowLights[i] = shadowLightOf(sceneLights[i]);
        shadowLights[i].casts = casts;
    }
}

std::vector<Light> Renderer::State::lightsOf(const glm::dvec3& origin, const ShadowPlan& plan) const {
    std::vector<Light> lights;
    lights.reserve(sceneLights.size());
    for (std::size_t i = 0; i < sceneLights.size(); ++i) {
        const bool none = plan.firstView.empty() || !sceneLights[i].casts;
        const std::uint32_t first = none ? kNoShadowViews : plan.firstView[i];
        lights.push_back(lightOf(sceneLights[i], origin, first, plan.cascadeCount, desc.biasMetres));
    }
    return lights;
}

// Only lights that phase 1 will keep deserve shadowmaps. Asking phase 1 itself, with a history of its own that sees the
// same frames, gives the very choice that the view will make.
void Renderer::State::selectCasters(const Camera& camera, const glm::dvec3& origin) {
    if (sceneLights.size() <= gpu::kMaxLightsPerView) return;
    const PrepareSizes sizes = prepareSizes(desc.widthPx, desc.heightPx);
    if (selection == nullptr) {
        require(Prepare::create({.maxWidthPx = desc.widthPx, .maxHeightPx = desc.heightPx}, selection));
        selectionMemory.resize(sizes.frameConstants + sizes.lights + sizes.zBins + sizes.tileLightMasks);
    }
    std::byte* memory = selectionMemory.data();
    const auto take = [&memory](std::size_t bytes) { return std::exchange(memory, memory + bytes); };
    const PrepareOutput output = {take(sizes.frameConstants), take(sizes.lights), take(sizes.zBins),
                                  take(sizes.tileLightMasks)};
    const std::vector<Light> lights = lightsOf(origin, {});
    ViewInput input;
    input.camera = camera;
    input.widthPx = desc.widthPx;
    input.heightPx = desc.heightPx;
    input.lights = lights;
    PrepareReport report;
    require(selection->run(input, output, report));
    for (ShadowLight& light : shadowLights) light.casts = false;
    const auto* kept = static_cast<const gpu::GpuLight*>(output.lights);
    for (std::uint32_t i = 0; i < report.visible; ++i) {
        shadowLights[kept[i].hostIndex].casts = sceneLights[kept[i].hostIndex].casts;
    }
}

// Phase 1 and everything else the library wants to know of the frame.
void Renderer::State::beginView(const Camera& camera, const glm::dvec3& origin, const ShadowPlan& plan,
                                ShadowMode mode) {
    const std::vector<Light> lights = lightsOf(origin, plan);
    std::vector<ShadowView> views;
    views.reserve(plan.views.size());
    for (const PlannedView& planned : plan.views) views.push_back(planned.view);
    const ShadowAtlas atlases[] = {atlas.atlas()};
    FrameDesc frame;
    frame.frameNumber = frameNumber;
    frame.view.camera = camera;
    frame.view.widthPx = desc.widthPx;
    frame.view.heightPx = desc.heightPx;
    frame.view.lights = lights;
    frame.shadowViews = views;
    frame.depth = {gbuffer.depth().view()};
    if (desc.readFaceNormals) frame.faceNormals = {gbuffer.view(GBuffer::FaceNormal)};
    frame.receiverFlags = {gbuffer.view(GBuffer::Receiver)};
    frame.atlases = atlases;
    frame.subsurfaceBiasMetres = desc.shadowDrawing.subsurfaceFronts ? desc.subsurfaceBiasMetres : 0.0f;
    frame.patternPerFrame = desc.patternPerFrame;
    frame.shadowBounds = desc.shadowBounds && mode != ShadowMode::Off;
    require(view->beginFrame(frame));
}

void Renderer::State::recordPasses(VkCommandBuffer c, const GBufferCamera& camera, ShadowMode mode,
                                   FrameReport& report) {
    {
        const GpuScope scope(&timer, c, "gbuffer");
        gbuffer.record(c, scene, camera);
    }
    view->recordHierarchicalDepth(c);
    view->recordFindLightsApproximate(c);
    view->recordFindLightsAccurate(c);
    {
        const GpuScope scope(&timer, c, "shadow_atlas");
        const ShadowAtlasStatistics drawn = atlas.record(c, scene);
        report.shadowViewsDrawn = drawn.viewsDrawn;
        report.shadowTrianglesDrawn = drawn.triangles;
    }
    if (desc.shadowBounds && mode != ShadowMode::Off) view->recordShadowBounds(c);
    switch (mode) {
        case ShadowMode::Deferred:
            view->recordGenerateShadows(c);
            lighting.recordDeferred(c, *view, &timer);
            break;
        case ShadowMode::Inline:
            lighting.recordInline(c, *view, LightingVariant::Inline, &timer);
            break;
        case ShadowMode::Off:
            lighting.recordInline(c, *view, LightingVariant::Unshadowed, &timer);
            break;
    }
    view->recordEndFrame(c);
}

std::uint64_t Renderer::renderFrame(const SceneCamera& cameraAtRest, ShadowMode mode, double timeSeconds) {
    State& s = *state_;
    s.setTime(timeSeconds);
    const SceneCamera sceneCamera = posedCamera(s.posable, s.pose, cameraAtRest);
    requireReachable(glm::vec3(sceneCamera.worldFromCamera[3]), "camera", sceneCamera.name);
    const std::uint64_t number = s.frameNumber;
    Commands& commands = s.commands[number % kFramesInFlight];
    const VkCommandBuffer c = commands.begin();
    s.timer.beginFrame(c, number);
    const glm::dvec3 origin = frameOriginOf(sceneCamera);
    const Camera camera = cameraOf(sceneCamera, origin, s.desc.widthPx, s.desc.heightPx, s.desc.deviceDepth);
    const GBufferCamera gbufferCamera = gbufferCameraOf(camera);
    s.scene.recordTransforms(c, origin);
    s.selectCasters(camera, origin);
    ShadowPlan plan = s.planner.plan(
        s.shadowLights, planCameraOf(sceneCamera, gbufferCamera, origin, s.desc.widthPx, s.desc.heightPx), origin);
    s.atlas.prepare(s.scene, s.shadowLights, plan);
    s.beginView(camera, origin, plan, mode);

    State::Known& known = s.known[number % kFramesInFlight];
    known = {};
    known.frameNumber = number;
    known.report.shadowViews = static_cast<std::uint32_t>(plan.views.size());
    known.report.shadowLightsShrunk = plan.lightsShrunk;
    known.report.shadowLightsDropped = plan.lightsWithout;
    known.report.atlasSizePx = s.planner.settings().atlasSizePx;
    s.recordPasses(c, gbufferCamera, mode, known.report);
    commands.submit();
    s.lastPlan = std::move(plan);
    s.lastOrigin = origin;
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
    if (known.frameNumber != frameNumber || !s.view->statistics(frameNumber, report.statistics)) {
        throw GpuError("The report of a frame was asked for that is not known any more.");
    }
    const FrameStatistics& statistics = report.statistics;
    const auto library = [&](const std::string& name) {
        for (std::uint32_t i = 0; i < statistics.passCount; ++i) {
            if (name == statistics.passes[i].name)
                report.passes.push_back({name, statistics.passes[i].milliseconds, false});
        }
    };
    // In order of execution: the library's phases stand between the renderer's own passes.
    for (const GpuTime& time : s.timer.times(frameNumber)) {
        const bool drawing = time.name == "gbuffer" || time.name == "shadow_atlas";
        report.passes.push_back({time.name, time.milliseconds, drawing});
        if (time.name == "gbuffer") {
            library("hierarchical_depth");
            library("find_lights_approximate");
            library("find_lights_accurate");
        }
        if (time.name == "shadow_atlas") {
            library("shadow_bounds");
            library("generate_shadows");
        }
    }
    if (!report.passes.empty()) library("gather_statistics");
    return report;
}

HdrPicture Renderer::readPicture() {
    wait();
    const GpuImage& image = state_->lighting.picture();
    const std::vector<std::uint8_t> bytes = readImage(state_->device, image, VK_IMAGE_LAYOUT_GENERAL);
    HdrPicture picture;
    picture.width = state_->desc.widthPx;
    picture.height = state_->desc.heightPx;
    picture.rgba.resize(std::size_t(picture.width) * picture.height * 4);
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        std::uint16_t half;
        std::memcpy(&half, bytes.data() + 2 * i, 2);
        picture.rgba[i] = glm::unpackHalf1x16(half);
    }
    return picture;
}

std::vector<std::uint32_t> Renderer::readTriangleIds() {
    wait();
    const std::vector<std::uint8_t> bytes =
        readImage(state_->device, state_->gbuffer.image(GBuffer::TriangleId), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    std::vector<std::uint32_t> ids(bytes.size() / 4);
    std::memcpy(ids.data(), bytes.data(), ids.size() * 4);
    for (std::uint32_t& id : ids) id = state_->scene.trianglePosition(id);
    return ids;
}

std::vector<float> Renderer::readVisibility(std::uint32_t light) {
    State& s = *state_;
    wait();
    if (s.lightVisibility == nullptr)
        s.lightVisibility = std::make_unique<LightVisibility>(s.device, *s.context, s.desc.widthPx, s.desc.heightPx);
    return s.lightVisibility->read(*s.view, light);
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
    const MemoryReport& library = s.view->memory();
    for (std::uint32_t i = 0; i < library.bufferCount; ++i) {
        const BufferMemory& buffer = library.buffers[i];
        rows.push_back({buffer.name, buffer.bytes, true, buffer.perFrame ? kFramesInFlight : 1u});
    }
    for (const auto& part :
         {s.scene.memoryRows(), s.gbuffer.memoryRows(), s.atlas.memoryRows(), s.lighting.memoryRows()}) {
        for (const MemoryRow& row : part) rows.push_back({row.name, row.bytes, false, 1u});
    }
    return rows;
}

const MemoryReport& Renderer::libraryMemory() const {
    return state_->view->memory();
}
std::uint32_t Renderer::subgroupSize() const {
    return state_->context->subgroupSize();
}

}  // namespace gnomon::renderer
