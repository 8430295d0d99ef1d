// The whole way of `gnomon verify`: a frame's visibility, light by light, against ray-traced truth. The bounds are the
// limits that the depth bias promises.
#include <algorithm>
#include <cstdio>

#include "image/renderer/verified.h"

namespace gnomon::renderer::image_test {
namespace {

GNOMON_IMAGE_TEST_SUITE(Verify);

constexpr double kMostAcneAndLeak = 0.001, kMostContactLeak = 0.01, kMostPenumbraError = 0.05;

TEST_P(Verify, AcneAndLeakStayWithinTheirLimits) {
    struct {
        const char* scene;
        Filter filter;
        const char* name;
        bool always;
    } const cases[] = {{"boxes", Filter::Pcss, "pcss", true},    {"sphere-on-plane", Filter::Pcf, "pcf", true},
                       {"masked", Filter::Hard, "hard", true},   {"bias-lab", Filter::Pcss, "pcss", true},
                       {"sundial", Filter::Pcss, "pcss", false}, {"cloth", Filter::Pcf, "pcf", false}};
    for (const auto& [scene, filter, name, always] : cases) {
        if (!always && !fullRun()) continue;
        SCOPED_TRACE(std::string(scene) + " " + name);
        RendererDesc desc = smallDesc(160, 90);
        desc.frame.filters = {filter};
        const Figures f = verified(device(), builtin(scene), desc).figures;
        std::printf(
            "[ figure   ] %s: %s %s: of %llu pairs acne %.4f %%, leak %.4f %%, contact leak %.4f %%; rmse %.4f\n",
            device().info().name.c_str(), scene, name, static_cast<unsigned long long>(f.pairs),
            100.0 * f.share(f.acne), 100.0 * f.share(f.leak), 100.0 * f.share(f.contactLeak), f.penumbraRmse());
        EXPECT_GT(f.pairs, 5000u);
        EXPECT_GT(f.dark, 100u);
        EXPECT_LE(f.share(f.acne + f.leak), kMostAcneAndLeak);
        EXPECT_LE(f.share(f.contactLeak), kMostContactLeak);
        // Texels are large in so small an atlas: what touches within one is lost.
        if (f.contacts > 500) {
            EXPECT_LE(f.contactLeakOfContacts(), 0.3);
        }
    }
}

// Where faces are wider than a few pixels, normals from depth do as well, with perspective and without.
TEST_P(Verify, FaceNormalsFromDepthOnWideFaces) {
    const View3d boxes = builtin("boxes");
    const std::pair<View3d, DeviceDepth> cases[] = {{boxes, DeviceDepth::ReversedZ},
                                                    {boxes, DeviceDepth::StandardZ},
                                                    {orthographic(boxes, 1.5f), DeviceDepth::ReversedZ},
                                                    {orthographic(boxes, 1.5f), DeviceDepth::StandardZ}};
    for (const auto& [view, depth] : cases) {
        RendererDesc desc = smallDesc(160, 90);
        desc.frame.filters = {Filter::Hard};
        desc.frame.readFaceNormals = false;
        desc.frame.deviceDepth = depth;
        const Figures f = verified(device(), view, desc).figures;
        std::printf("[ figure   ] %s: %s, normals from depth: acne %.4f %%, leak %.4f %%\n",
                    device().info().name.c_str(), view.name.c_str(), 100.0 * f.share(f.acne), 100.0 * f.share(f.leak));
        EXPECT_GT(f.pairs, 5000u);
        EXPECT_GT(f.dark, 100u);
        EXPECT_LE(f.share(f.acne + f.leak), kMostAcneAndLeak);
        if (!thorough()) break;
    }
}

// Wide spots are as good as narrower ones, up to a hemisphere: neither in the light's own error nor in what is set
// aside as an edge because of large texels.
TEST_P(Verify, SpotsOfAnyWidth) {
    double aside = 0.0, error = 0.0;
    for (const float angle : {1.05f, 1.4f, 1.57079637f}) {
        View3d view = builtin("boxes");
        SceneLight spot;
        spot.kind = LightKind::Spot;
        spot.position = {0.4f, 3.0f, 0.6f};
        spot.direction = {0.0f, -1.0f, 0.0f};
        spot.outerConeAngle = angle;
        spot.intensity = 100.0f;
        spot.rangeMetres = 20.0f;
        view.scene.lights = {spot};
        RendererDesc desc = smallDesc(160, 90);
        desc.frame.filters = {Filter::Hard};
        const Figures f = verified(device(), view, desc).figures;
        std::printf("[ figure   ] %s: spot of %.2f rad: set aside %.2f %%, acne %.4f %%, leak %.4f %%\n",
                    device().info().name.c_str(), static_cast<double>(angle), 100.0 * f.share(f.edges),
                    100.0 * f.share(f.acne), 100.0 * f.share(f.leak));
        EXPECT_GT(f.dark, 100u);
        if (aside == 0.0) {
            aside = f.share(f.edges);
            error = f.share(f.acne + f.leak);
        }
        EXPECT_LE(f.share(f.acne + f.leak), error + kMostAcneAndLeak);
        EXPECT_LE(error, 0.003) << "large texels of a small atlas, on faces that the lamp grazes";
        EXPECT_LE(f.share(f.edges), 1.5 * aside + 0.01);
    }
}

// The same comparison tells a result that is wrong: every shadow lost, and every light.
TEST_P(Verify, LostShadowsAndLightsAreTold) {
    RendererDesc desc = smallDesc(160, 90);
    desc.frame.filters = {Filter::Hard};
    Verified v = verified(device(), builtin("sphere-on-plane"), desc);
    for (float& visibility : v.visibility) visibility = visibility < 0.0f ? visibility : 1.0f;
    EXPECT_GT(figuresOf(v.truth, v.visibility, false).opaque.leak, 50u);
    for (float& visibility : v.visibility) visibility = visibility < 0.0f ? visibility : 0.0f;
    EXPECT_GT(figuresOf(v.truth, v.visibility, false).opaque.acne, 5000u);
}

// Places as a renderer has them that composes in floats, in earth coordinates.
TEST_P(Verify, PlacesRoundedToFloatsAreTold) {
    const glm::dvec3 far(4510731.2537, 4510731.8731, 0.333);
    const View3d view = builtin("boxes");
    Scene rounded = view.scene;
    for (Instance& instance : rounded.instances) {
        const glm::vec3 place(glm::dvec3(instance.worldFromObject[3]) + far);
        instance.worldFromObject[3] = glm::dvec4(glm::dvec3(place) - far, 1.0);
    }
    RendererDesc desc = smallDesc(160, 90);
    desc.frame.filters = {Filter::Hard};
    const Figures good = verified(device(), view, desc).figures;
    const Figures planted = verified(device(), view, desc, &rounded).figures;
    EXPECT_LE(good.share(good.acne + good.leak), kMostAcneAndLeak);
    EXPECT_GT(planted.share(planted.acne + planted.leak), 3.0 * kMostAcneAndLeak);
    std::printf("[ figure   ] %s: acne and leak %.4f %%, with rounded places %.4f %%\n", device().info().name.c_str(),
                100.0 * good.share(good.acne + good.leak), 100.0 * planted.share(planted.acne + planted.leak));
}

// In place of the ball of sphere-on-plane a square plate above the plane that shows its back to the camera: through it
// the plane is seen, which it darkens.
View3d hiddenPlate(float heightMetres, float halfMetres) {
    View3d view = builtin("sphere-on-plane");
    const float y = heightMetres, h = halfMetres;
    Primitive plate;
    plate.positions = {{-h, y, -h}, {h, y, -h}, {h, y, h}, {-h, y, h}};
    plate.indices = {0, 1, 2, 0, 2, 3};
    for (const glm::vec3& p : plate.positions) plate.bounds.add(p);
    for (Instance& instance : view.scene.instances) {
        if (instance.name != "sphere") continue;
        instance.worldFromObject = glm::mat4(1.0f);
        view.scene.meshes[instance.mesh].primitives = {plate};
    }
    return view;
}

// A depth bias that is 1 cm too large.
TEST_P(Verify, ABiasThatIsACentimetreTooLargeIsTold) {
    const View3d view = hiddenPlate(0.006f, 1.0f);
    RendererDesc desc = smallDesc(160, 90);
    desc.frame.filters = {Filter::Hard};
    const Figures good = verified(device(), view, desc).figures;
    EXPECT_GT(good.contacts, 300u);
    EXPECT_LE(good.share(good.acne + good.leak), kMostAcneAndLeak);
    EXPECT_LE(good.share(good.contactLeak), kMostContactLeak);
    desc.frame.biasMetres = kBiasMetres + 0.01f;
    const Figures planted = verified(device(), view, desc).figures;
    EXPECT_GT(planted.contactLeak, good.contactLeak + 100u);
    EXPECT_GT(planted.share(planted.contactLeak), kMostContactLeak);
    std::printf("[ figure   ] %s: contact leak %.3f %%, with 1 cm more bias %.3f %%\n", device().info().name.c_str(),
                100.0 * good.share(good.contactLeak), 100.0 * planted.share(planted.contactLeak));
}

// One plane blocks another: all that PCSS takes for granted. What is left is the noise of its taps.
TEST_P(Verify, PenumbraOfAPlateOverAPlane) {
    if (device().info().name.find("SwiftShader") != std::string::npos)
        GTEST_SKIP() << "two more filters take it 20 s to compile";
    View3d view = hiddenPlate(2.0f, 0.5f);
    ASSERT_TRUE(parseCamera("2,2,4:0,0,0:35", view.scene, view.camera).ok());
    for (const PcssTaps taps : {kPcssMedium, kPcssHigh}) {
        RendererDesc desc = smallDesc(160, 90);
        desc.frame.shadows.pcssPresets[0] = taps;
        desc.atlasSizePx = 2048;  // in larger texels the penumbra is no wider than a few of them
        const Figures f = verified(device(), view, desc).figures;
        std::printf("[ figure   ] %s: %u and %u taps: rmse %.4f of %llu pairs in penumbra\n",
                    device().info().name.c_str(), taps.searchTaps, taps.filterTaps, f.penumbraRmse(),
                    static_cast<unsigned long long>(f.penumbraPairs));
        EXPECT_GT(f.penumbraPairs, 200u);
        EXPECT_LE(f.penumbraRmse(), kMostPenumbraError);
    }
}

// A glowing ball, lit from the side, by both rules: drawn as it is traced.
TEST_P(Verify, SubsurfaceRulesAreDrawnAsTheyAreTraced) {
    View3d view = builtin("sphere-on-plane");
    ASSERT_TRUE(parseCamera("0.6,1.3,3:0,0.6,0:30", view.scene, view.camera).ok());
    for (Material& material : view.scene.materials) material.subsurface = material.name == "red";
    view.scene.lights.at(0).position = {-2.0f, 2.5f, -1.0f};
    RendererDesc desc = smallDesc(120, 68);
    desc.frame.filters = {Filter::Hard};
    for (const bool fronts : {false, true}) {
        SCOPED_TRACE(fronts);
        desc.frame.drawing.subsurfaceFronts = fronts;
        const Verified v = verified(device(), view, desc);
        const Figures &skin = v.subsurface, &floor = v.figures;
        std::printf(
            "[ figure   ] %s: fronts %s: of %llu pairs of skin %llu lit, acne %.3f %%, leak %.3f %%, edge %.2f %%\n",
            device().info().name.c_str(), fronts ? "kept" : "left out", static_cast<unsigned long long>(skin.pairs),
            static_cast<unsigned long long>(skin.lit), 100.0 * skin.share(skin.acne), 100.0 * skin.share(skin.leak),
            100.0 * skin.share(skin.edgeError));
        EXPECT_GT(skin.pairs, 1000u);
        EXPECT_GT(skin.lit, 100u);
        if (fronts)
            EXPECT_GT(skin.dark, 500u);
        else
            EXPECT_EQ(skin.dark, 0u);
        EXPECT_LE(skin.share(skin.acne + skin.leak), kMostAcneAndLeak);
        EXPECT_GT(floor.dark, 100u);
        EXPECT_LE(floor.share(floor.acne + floor.leak), kMostAcneAndLeak);
    }
}

// What is read is what the lighting used: with pools far too small it is evaluated, and the same.
TEST_P(Verify, VisibilityIsTheSameWithOverflow) {
    const View3d view = builtin("boxes");
    RendererDesc desc = smallDesc(160, 90);
    desc.frame.filters = {Filter::Pcf};
    const auto allOf = [&](const RendererDesc& d) {
        Renderer renderer(device(), view.scene, d, pipelinesOf(device()));
        renderer.renderFrame(view.camera, ShadowMode::Deferred);
        std::vector<float> all;
        for (std::uint32_t i = 0; i < view.scene.lights.size(); ++i)
            for (const float visibility : renderer.readVisibility(i)) all.push_back(visibility);
        return all;
    };
    const std::vector<float> roomy = allOf(desc);
    desc.listEntries = 64;
    desc.visibilitySlots = 16;
    EXPECT_EQ(roomy, allOf(desc));
    EXPECT_GT(std::ranges::count(roomy, 1.0f), 1000);
    EXPECT_GT(std::ranges::count(roomy, 0.0f), 1000);
    Renderer renderer(device(), view.scene, desc, pipelinesOf(device()));
    renderer.renderFrame(view.camera, ShadowMode::Deferred);
    const std::vector<float> none = renderer.readVisibility(1000);
    EXPECT_EQ(std::ranges::count(none, -1.0f), std::ssize(none)) << "there is no such light";
}

}  // namespace
}  // namespace gnomon::renderer::image_test
