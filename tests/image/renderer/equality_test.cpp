// Deferred shadows equal shadows evaluated while lighting: every stored visibility has 8 bits, and both ways return
// the same ones, so the pictures may differ by the rounding of one sum of lights alone: 1/255.
#include "image/renderer/harness.h"

namespace gnomon::renderer::image_test {
namespace {

GNOMON_IMAGE_TEST_SUITE(DeferredIsInline);

struct FilterCase {
    const char* name;
    Filter filter;
    std::uint32_t radius;
};
constexpr FilterCase kFilters[] = {{"hard", Filter::Hard, 1}, {"pcf1", Filter::Pcf, 1}, {"pcf3", Filter::Pcf, 3}};

RendererDesc withFilter(const FilterCase& filter) {
    RendererDesc desc = smallDesc();
    desc.filter = filter.filter;
    desc.pcfRadius = filter.radius;
    return desc;
}

// Scenes in which one thing stands in another's light, seen by the default camera.
bool castsShadows(const std::string& scene) {
    return scene != "empty-plane" && scene != "single-triangle" && scene != "lights-only";
}

void everyScene(const Device& device, const FilterCase& filter, std::uint32_t scattered, Worst& worst) {
    for (const BuiltinInfo& info : builtinScenes()) {
        // Own lights in every scene by one filter, 64 more by another; the third in one scene.
        const bool chosen = filter.radius == 3 ? scattered != 0 : filter.filter == Filter::Pcf && scattered == 0;
        if (!thorough() && !chosen && (info.name != "boxes" || filter.filter != Filter::Hard)) continue;
        const View3d view = builtin(info.name, scattered);
        expectDeferredIsInline(device, view.name + " " + filter.name, view, withFilter(filter), worst,
                               castsShadows(info.name));
    }
}

TEST_P(DeferredIsInline, EverySceneWithItsOwnLights) {
    Worst worst;
    for (const FilterCase& filter : kFilters) everyScene(device(), filter, 0, worst);
    worst.report(device(), "deferred against inline, own lights");
}

TEST_P(DeferredIsInline, EverySceneWith64LightsMore) {
    Worst worst;
    for (const FilterCase& filter : kFilters)
        if (fullRun() || filter.radius == 3) everyScene(device(), filter, 64, worst);
    worst.report(device(), "deferred against inline, 64 lights more");
}

TEST_P(DeferredIsInline, With256LightsMore) {
    Worst worst;
    if (fullRun()) {
        for (const FilterCase& filter : kFilters) everyScene(device(), filter, 256, worst);
    } else {
        for (const char* scene : {"courtyard", "columns"}) {
            const View3d view = builtin(scene, 256);
            expectDeferredIsInline(device(), view.name, view, smallDesc(), worst, true);
        }
    }
    worst.report(device(), "deferred against inline, 256 lights more");
}

}  // namespace
}  // namespace gnomon::renderer::image_test
