#include "image/renderer/verified.h"

#include <cstdio>

namespace gnomon::renderer::image_test {

Verified verified(const Device& device, const View3d& view, const RendererDesc& desc, const Scene* drawn) {
    Renderer renderer(device, drawn != nullptr ? *drawn : view.scene, desc, pipelinesOf(device));
    Verified out;
    out.picture = draw(renderer, view.camera, ShadowMode::Deferred).linear;
    const Pose pose = poseAt(view.scene, 0.0);
    const SceneCamera camera = posedCamera(view.scene, pose, view.camera);
    const TracedScene traced(
        view.scene, pose, glm::dvec3(camera.worldFromCamera[3]),
        {desc.frame.drawing.subsurfaceFronts, static_cast<double>(desc.frame.subsurfaceBiasMetres)});
    const TruthExtent extent = {desc.frame.widthPx, desc.frame.heightPx};
    const std::vector<TruthReceiver> receivers =
        receiversOf(traced, camera, extent.widthPx, extent.heightPx, renderer.readTriangleIds());
    for (std::uint32_t i = 0; i < pose.lights.size(); ++i) {
        LightTruthDesc light;
        light.light = pose.lights[i];
        light.views = renderer.shadowViews(i);
        light.viewsOrigin = renderer.frameOrigin();
        light.soft = desc.frame.filters.front() == Filter::Pcss;
        light.subsetOf = 4;
        out.visibility = renderer.readVisibility(i);
        out.truth = traceLight(traced, receivers, extent, light);
        completeSoftTruth(out.truth, traced, receivers, light, out.visibility);
        const LightFigures figures = figuresOf(out.truth, out.visibility, light.soft);
        out.figures += figures.opaque;
        out.subsurface += figures.subsurface;
    }
    return out;
}

bool isSwiftShader(const Device& device) {
    return device.info().name.find("SwiftShader") != std::string::npos;
}

RendererDesc hardDesc(std::uint32_t widthPx, std::uint32_t heightPx) {
    RendererDesc desc = smallDesc(widthPx, heightPx);
    desc.frame.filters = {Filter::Hard};
    return desc;
}

Figures figuresIn(const Device& device, const View3d& view, const RendererDesc& desc) {
    const Figures f = verified(device, view, desc).figures;
    std::printf(
        "[ figure   ] %s: %s: of %llu pairs %llu dark, acne %.4f %%, leak %.4f %%, contact leak %.2f %%, error %.5f\n",
        device.info().name.c_str(), view.name.c_str(), static_cast<unsigned long long>(f.pairs),
        static_cast<unsigned long long>(f.dark), 100.0 * f.share(f.acne), 100.0 * f.share(f.leak),
        100.0 * f.contactLeakOfContacts(), f.visibilityError());
    return f;
}

}  // namespace gnomon::renderer::image_test
