// A Vulkan program with tiled deferred shadows, to be copied from: one camera, five lights, one shadow atlas.
//
//     minimal_host [picture.ppm] [index of the Vulkan device] [entries in each pool] [entries to which they may grow]
//
// This file is the order of things: what is made once, and a frame from phase 1 to its statistics, as in figure 1 of
// the paper. The numbers are the steps of docs/integration.md, which holds every rule. The other files hold the parts
// that an engine has already:
//
//     vulkan_setup   device, memory, command buffers, fences
//     scene          boxes, lights, a camera
//     shadow_plan    which light gets which squares of the atlas
//     drawing        G-buffer and shadowmaps, with the barriers that the library counts on
//     lighting       the two lighting pipelines; lighting.comp is what to look at for shaders
//
// The host owns instance, device, queue, command buffers, images and submission. The library records compute passes
// into the host's command buffer; it never submits and never waits.
#include <gnomon/gnomon.h>

#include <charconv>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "drawing.h"
#include "lighting.h"
#include "scene.h"
#include "shadow_plan.h"
#include "vulkan_setup.h"

namespace host {
namespace {

constexpr std::uint32_t kWidthPx = 480, kHeightPx = 270, kAtlasPx = 2048;
constexpr std::uint32_t kFramesInFlight = 2;
// Enough for pools that are allowed to grow: what frame 0 lacked is known in frame 2. A tile without list space asks
// for no slot, so slots follow in frame 4.
constexpr std::uint64_t kFrames = 6;

// The library throws nothing. A call that fails says what to do in one sentence.
void check(const gnomon::Result& result) {
    if (!result) throw std::runtime_error(result.message());
}

struct Arguments {
    std::string picture = "minimal_host.ppm";
    std::uint32_t device = 0;
    std::uint32_t poolEntries = 0;      // 0: the library's default. Few show what happens where a pool runs out
    std::uint32_t mostPoolEntries = 0;  // above 0: pools grow up to this
};

// Everything about shadows that a user tunes, for one frame: a host may give other settings in the next.
gnomon::ShadowSettings makeSettings() {
    gnomon::ShadowSettings settings;
    // What Light::filter may be. Pipelines hold the code of these alone; a single one is fastest.
    settings.filters =
        gnomon::only(gnomon::Filter::Hard) | gnomon::only(gnomon::Filter::Pcf) | gnomon::only(gnomon::Filter::Pcss);
    settings.shadowBounds = true;  // recordShadowBounds() will be called: spares PCSS searches, with the same bits
    return settings;
}

std::unique_ptr<gnomon::Context> makeContext(const Device& device) {
    gnomon::ContextDesc desc;
    desc.instance = device.instance;
    desc.physicalDevice = device.physical;
    desc.device = device.handle;
    desc.getInstanceProcAddr = vkGetInstanceProcAddr;  // the library links no loader
    // Every family that will run the library's commands. With several, buffers are shared among them, and phases 2 and
    // 3 may run on an async compute queue.
    desc.queueFamilies = {&device.queueFamily, 1};
    desc.maxShadowAtlases = 1;
    std::unique_ptr<gnomon::Context> context;
    check(gnomon::Context::create(desc, context));
    return context;
}

gnomon::ViewDesc viewDesc(const Arguments& arguments) {
    gnomon::ViewDesc desc;
    desc.maxWidthPx = kWidthPx;  // frames may be smaller
    desc.maxHeightPx = kHeightPx;
    desc.framesInFlight = kFramesInFlight;
    desc.listEntries = desc.visibilitySlots = arguments.poolEntries;
    desc.mostListEntries = desc.mostVisibilitySlots = arguments.mostPoolEntries;
    desc.shadowBoundsTexels = std::uint64_t{kAtlasPx} * kAtlasPx;
    return desc;
}

// What a view costs is known before anything is allocated.
void printMemory(const gnomon::MemoryReport& report) {
    std::printf("%-24s %10s %7s\n", "buffer", "KiB", "copies");
    for (const gnomon::BufferMemory& buffer : report.buffers()) {
        std::printf("%-24s %10.1f %7u%s\n", buffer.name, static_cast<double>(buffer.bytes) / 1024,
                    buffer.perFrame ? kFramesInFlight : 1, buffer.mapped ? ", mapped" : "");
    }
    std::printf("%-24s %10.1f\n", "total", static_cast<double>(report.totalBytes) / 1024);
    std::printf("pools: %u list entries, %u visibility slots%s\n", report.listEntries, report.visibilitySlots,
                report.poolsCapped ? ", fewer than asked for" : "");
}

// What lives from frame to frame. Members are destroyed from the last to the first: views and timelines before their
// context, the context before the device.
struct Host {
    Device device;
    gnomon::ShadowSettings settings = makeSettings();
    std::unique_ptr<gnomon::Context> context;
    std::unique_ptr<gnomon::View> view;
    std::unique_ptr<gnomon::Timeline> timeline;
    FrameRing frames;
    Drawing drawing;
    ShadowPlanner planner{kAtlasPx};
    std::unique_ptr<Lighting> lighting;

    explicit Host(const Arguments& arguments);
    ~Host() { vkDeviceWaitIdle(device.handle); }
    Host(const Host&) = delete;
    Host& operator=(const Host&) = delete;

    void renderFrame(std::uint64_t number);
};

Host::Host(const Arguments& arguments)
    : device(arguments.device),  // 1.
      frames(device, kFramesInFlight),
      drawing(device, kWidthPx, kHeightPx, kAtlasPx) {  // 4.
    context = makeContext(device);                      // 2.
    // Makes the pipelines of these settings now, so that no frame has to. It may take seconds, and may run on a thread
    // of its own while frames with other settings are recorded.
    check(context->prepare(settings));

    const gnomon::ViewDesc desc = viewDesc(arguments);  // 3.
    gnomon::MemoryReport report;
    check(gnomon::View::memory(*context, desc, report));
    printMemory(report);
    check(gnomon::View::create(*context, desc, view));
    check(gnomon::Timeline::create(*context, {.framesInFlight = kFramesInFlight}, timeline));

    lighting = std::make_unique<Lighting>(device, *context, settings, kWidthPx, kHeightPx);  // 5.
}

void printPlan(const gnomon::PreparedLights& prepared, const ShadowPlan& plan) {
    for (std::size_t i = 0; i < prepared.visible.size(); ++i) {
        const gnomon::LightOnScreen& light = prepared.visible[i];
        const gnomon::LightShadowViews& views = plan.lightViews[i];
        const std::uint32_t sidePx = views.count == 0 ? 0 : plan.views[views.first].widthPx;
        std::printf("light %u: %3.0f %% of the view, %u shadow views of %ux%u\n", light.light,
                    100 * static_cast<double>(light.screenShare), views.count, sidePx, sidePx);
    }
    std::size_t drawn = 0;
    for (const gnomon::ShadowView& shadowView : plan.views) drawn += shadowView.changed ? 1 : 0;
    std::printf("shadow views: %zu, of which %zu are drawn in the last frame\n", plan.views.size(), drawn);
}

void Host::renderFrame(std::uint64_t number) {
    // 6. Frame `number` - kFramesInFlight has finished when this returns.
    const VkCommandBuffer commands = frames.begin(number);
    timeline->beginFrame(commands, number);

    // 7. Phase 1, on the CPU. All lights are given; the answer is which of them are visible, and how large.
    const std::vector<gnomon::Light> lights = sceneLights(number);
    gnomon::ViewInput input;
    input.camera = sceneCamera(kWidthPx, kHeightPx);
    input.widthPx = kWidthPx;
    input.heightPx = kHeightPx;
    input.lights = lights;
    gnomon::PreparedLights prepared;
    check(view->prepare(input, prepared));

    // 8. With that answer the host plans its shadow views. All of them are its own: the library draws none.
    const ShadowPlan& plan = planner.plan(prepared, lights);
    if (number == kFrames - 1) printPlan(prepared, plan);

    // 9. The library takes views, images and settings, and fills its mapped memory. If this fails, the frame must not
    // be recorded. Spans are read during the call; the images must live until the frame has finished.
    const gnomon::ShadowAtlas atlas = {drawing.atlas().view, kAtlasPx, kAtlasPx};
    gnomon::FrameDesc frame;
    frame.frameNumber = number;
    frame.settings = settings;
    frame.lightViews = plan.lightViews;
    frame.shadowViews = plan.views;
    frame.depth = {drawing.depth().view};
    frame.faceNormals = {drawing.faceNormals().view};  // without, they are derived from depth
    frame.atlases = {&atlas, 1};
    frame.timeline = timeline.get();
    check(view->beginFrame(frame));

    // 10. The G-buffer. Depth and face normals are visible to compute shaders afterwards.
    gnomon::Timeline::Row row = timeline->begin(commands, "gbuffer", gnomon::Phase::Host, gnomon::RowKind::Drawing);
    drawing.recordGBuffer(commands, clipFromWorld(input.camera));
    timeline->end(commands, row);

    // 11. The hierarchical depth, and phases 2 and 3: which lights reach which tile. No shadowmap is needed yet, so an
    // engine may run these on an async compute queue while the next step draws. Phase 3 has something to do with
    // LightLists::Pixel alone, but is recorded always: it makes the lists visible.
    view->recordHierarchicalDepth(commands);
    view->recordFindLightsApproximate(commands);
    view->recordFindLightsAccurate(commands);

    // 12. The shadowmaps that changed. The atlas is visible to compute shaders afterwards.
    row = timeline->begin(commands, "shadowmaps", gnomon::Phase::Host, gnomon::RowKind::Drawing);
    drawing.recordShadowmaps(commands, plan.views);
    timeline->end(commands, row);

    // 13. Phase 4: the visibility of every light from every pixel, into slots.
    if (settings.shadowBounds) view->recordShadowBounds(commands);
    view->recordGenerateShadows(commands);

    // 14. The host's lighting reads lists and slots.
    lighting->record(commands, *view, *timeline);

    // 15. Counters go where the host can read them, after the last shader that reads the lists.
    view->recordEndFrame(commands);

    if (number == kFrames - 1) lighting->recordReadback(commands);  // an engine would present
    frames.submit(number);
}

// 16. Of a frame that has finished. Neither call ever waits.
void printStatistics(const gnomon::View& view, const gnomon::Timeline& timeline, std::uint64_t number) {
    gnomon::FrameStatistics s;
    if (!view.statistics(number, s)) throw std::runtime_error("The last frame has no statistics.");
    std::printf("lights: %u given, %u visible, %u casting; at most %u in a tile\n", s.lights.given, s.lights.visible,
                s.lights.casting, s.maxLightsInTile);
    // Where a pool was too small, nothing is lost: such tiles are evaluated while lighting, and cost more time.
    std::printf("list entries: %u of %u used, %u recommended\n", s.listEntries, s.listCapacity,
                s.recommendedListEntries);
    std::printf("visibility slots: %u of %u used, %u recommended\n", s.visibilitySlots, s.slotCapacity,
                s.recommendedVisibilitySlots);
    std::printf("evaluated: %u tiles\n", s.evaluateTiles);
    std::printf("%-24s %8.3f ms on the CPU\n", "prepare", s.prepareMilliseconds);
    for (const gnomon::TimelineRow& row : timeline.rows(number))
        std::printf("%-24s %8.3f ms%s\n", row.name, row.milliseconds(),
                    row.phase == gnomon::Phase::Host ? ", the host's" : "");
}

// Before any work: whether there will be a place for the picture. What is there stays.
void checkWritable(const std::string& path) {
    const bool isThere = std::filesystem::exists(path);
    std::FILE* file = std::fopen(path.c_str(), "ab");
    if (file == nullptr) throw std::runtime_error("The picture '" + path + "' cannot be written.");
    std::fclose(file);
    if (!isThere) std::filesystem::remove(path);
}

void savePicture(const std::uint8_t* rgba, const std::string& path) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (file == nullptr) throw std::runtime_error("The picture '" + path + "' cannot be written.");
    std::fprintf(file, "P6\n%u %u\n255\n", kWidthPx, kHeightPx);
    std::size_t written = 0;
    for (std::size_t i = 0; i < std::size_t{kWidthPx} * kHeightPx; ++i)
        written += std::fwrite(rgba + 4 * i, 3, 1, file);
    const bool closed = std::fclose(file) == 0;
    if (!closed || written != std::size_t{kWidthPx} * kHeightPx)
        throw std::runtime_error("The picture '" + path + "' could not be written whole.");
}

void run(const Arguments& arguments) {
    checkWritable(arguments.picture);
    Host host(arguments);
    const std::uint32_t pipelines = host.context->pipelineCount();
    for (std::uint64_t number = 0; number < kFrames; ++number) host.renderFrame(number);
    host.frames.waitForAll();
    std::printf("pipelines: %u made ahead of time, %u in a frame\n", pipelines,
                host.context->pipelineCount() - pipelines);
    printStatistics(*host.view, *host.timeline, kFrames - 1);
    savePicture(host.lighting->pixels(), arguments.picture);
}

}  // namespace
}  // namespace host

int main(int argc, char** argv) try {
    for (int i = 1; i < argc; ++i) {
        const std::string_view text = argv[i];
        if (!text.starts_with('-')) continue;
        std::puts(
            "minimal_host [picture.ppm] [index of the Vulkan device] [entries in each pool] "
            "[entries to which they may grow]");
        return text == "--help" || text == "-h" ? 0 : 1;
    }
    const auto number = [&](int i) {
        const std::string_view text = argc > i ? argv[i] : "0";
        std::uint32_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size())
            throw std::runtime_error("The argument '" + std::string(text) + "' is no number.");
        return value;
    };
    host::Arguments arguments;
    if (argc > 1) arguments.picture = argv[1];
    arguments.device = number(2);
    arguments.poolEntries = number(3);
    arguments.mostPoolEntries = number(4);
    host::run(arguments);
} catch (const std::exception& error) {
    std::fprintf(stderr, "minimal_host: %s\n", error.what());
    return 1;
}
