// The same input gives the same picture: on one device, bit by bit, however atomics fall; and shadowmaps that were kept
// from an earlier frame show what newly drawn ones would.
#include "image/renderer/harness.h"

#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::renderer::image_test {
namespace {

GNOMON_IMAGE_TEST_SUITE(Repeated);

std::string hashOfLinear(const HdrPicture& picture) {
    return hashOf(toneMap(picture, automaticExposure(picture)));
}

// With a quarter of the slots it is chance which tiles get one; without overflow, which slot a tile gets.
void expectOneHash(const Device& device, const RendererDesc& desc, const char* name) {
    SCOPED_TRACE(name);
    const View3d view = builtin("sundial", 64);
    HdrPicture first;
    for (int run = 0; run < 2; ++run) {
        Renderer renderer(device, view.scene, desc, pipelinesOf(device));
        for (int frame = 0; frame < 3; ++frame) {
            const HdrPicture picture = draw(renderer, view.camera, ShadowMode::Deferred).linear;
            if (first.rgba.empty()) first = picture;
            EXPECT_EQ(hashOfLinear(picture), hashOfLinear(first)) << "run " << run << ", frame " << frame;
            EXPECT_TRUE(picture.rgba == first.rgba) << "run " << run << ", frame " << frame;
        }
        // The same with two frames in flight: none is waited for before the next but one is recorded.
        for (int frame = 0; frame < 4; ++frame) renderer.renderFrame(view.camera, ShadowMode::Deferred);
        EXPECT_TRUE(renderer.readPicture().rgba == first.rgba) << "run " << run << ", in flight";
    }
}

TEST_P(Repeated, SameInputSamePicture) {
    const RendererDesc desc = smallDesc(120, 68);
    expectOneHash(device(), desc, "default pools");
    RendererDesc few = desc;
    few.visibilitySlots = 80;
    few.listEntries = 400;
    expectOneHash(device(), few, "pools that overflow");
}

SceneCamera moved(SceneCamera camera, const glm::vec3& by) {
    camera.worldFromCamera = glm::translate(glm::mat4(1.0f), by) * camera.worldFromCamera;
    return camera;
}

// Frames in two orders: each is what it is, whatever came before. (That history would show is seen where the plan is
// tested, in tests/unit/renderer/shadow_plan_test.cpp.)
TEST_P(Repeated, ThePastDoesNotShow) {
    const View3d view = builtin("sundial", 16);
    const SceneCamera cameras[] = {view.camera, moved(view.camera, {0.0f, 2.0f, 8.0f}),
                                   moved(view.camera, {0.0f, 9.0f, 40.0f})};
    RendererDesc desc = smallDesc();
    desc.frame.history = false;
    Renderer forth(device(), view.scene, desc, pipelinesOf(device()));
    Renderer back(device(), view.scene, desc, pipelinesOf(device()));
    HdrPicture first[3];
    for (std::size_t i = 0; i < 3; ++i) first[i] = draw(forth, cameras[i], ShadowMode::Deferred).linear;
    for (std::size_t i = 3; i-- > 0;)
        EXPECT_TRUE(draw(back, cameras[i], ShadowMode::Deferred).linear.rgba == first[i].rgba) << "camera " << i;
}

void expectAlike(const HdrPicture& expected, const HdrPicture& actual) {
    const float exposure = automaticExposure(expected);
    const Difference apart = compare(toneMap(expected, exposure), toneMap(actual, exposure));
    EXPECT_LE(apart.meanAbsolute, 1.0);
    std::printf("[ figure   ] far away against a new renderer: mean difference %.4f/255\n", apart.meanAbsolute);
}

TEST_P(Repeated, ShadowmapsAreKept) {
    Worst worst;
    for (const char* scene : {"sundial", "columns", "courtyard"}) {
        if (!fullRun() && scene == std::string("courtyard")) continue;
        if (!thorough() && scene != std::string("columns")) continue;
        SCOPED_TRACE(scene);
        const View3d view = builtin(scene);
        const RendererDesc forgetful = smallDesc(120, 68);
        RendererDesc desc = forgetful;
        desc.frame.history = true;
        Renderer kept(device(), view.scene, desc, pipelinesOf(device()));
        const Frame first = draw(kept, view.camera, ShadowMode::Deferred);
        EXPECT_GT(first.report.shadowViewsDrawn, 0u);
        const Frame still = draw(kept, view.camera, ShadowMode::Deferred);
        EXPECT_EQ(still.report.shadowViewsDrawn, 0u);
        EXPECT_EQ(still.report.shadowTrianglesDrawn, 0u);
        worst.add(expectEqual(device(), view.name + " still", first.linear, still.linear, 0), view.name);
        // A small step: lights keep their resolution, so a renderer that starts there has the same shadowmaps.
        View3d there = view;
        there.camera = moved(view.camera, {0.05f, 0.02f, -0.05f});
        const Frame after = draw(kept, there.camera, ShadowMode::Deferred);
        const Frame fresh = drawOnce(device(), there, forgetful, ShadowMode::Deferred);
        worst.add(expectEqual(device(), view.name + " moved", fresh.linear, after.linear, 1), view.name);
        EXPECT_LT(after.report.shadowViewsDrawn, fresh.report.shadowViewsDrawn);
        // A large step and back again: what was thrown out meanwhile is drawn anew.
        const SceneCamera far = moved(view.camera, {6.0f, 2.0f, -5.0f});
        const Frame farDeferred = draw(kept, far, ShadowMode::Deferred);
        const Frame farInline = draw(kept, far, ShadowMode::Inline);
        worst.add(expectEqual(device(), view.name + " far", farInline.linear, farDeferred.linear, 1), view.name);
        // A new renderer may choose other resolutions there, so edges differ; a map of another place would show more.
        there.camera = far;
        expectAlike(drawOnce(device(), there, forgetful, ShadowMode::Deferred).linear, farDeferred.linear);
    }
    worst.report(device(), "kept shadowmaps");
}

}  // namespace
}  // namespace gnomon::renderer::image_test
