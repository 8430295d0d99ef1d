// Small scenes on which engineers saw the renderer wrong, each with what is right. Where GNOMON_SCENES_DIR has them, in
// its folder field; tests beside this one have scenes of the same kinds that are made here.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "image/renderer/verified.h"
#include "scene/load_gltf.h"
#include "scene/pose.h"

namespace gnomon::renderer::image_test {
namespace {

GNOMON_IMAGE_TEST_SUITE(FieldCases);

constexpr const char* kNoField = "GNOMON_SCENES_DIR has no field scenes";
constexpr double kMostFieldWrong = 0.001, kMostFieldContactsLost = 0.05, kMostEdges = 0.05, kMostError = 0.005;

// Empty where GNOMON_SCENES_DIR names no folder with it.
std::optional<View3d> field(const std::string& file) {
    const char* folder = std::getenv("GNOMON_SCENES_DIR");
    if (folder == nullptr) return std::nullopt;
    View3d view;
    view.name = std::filesystem::path(file).stem().string();
    const std::filesystem::path path = std::filesystem::path(folder) / "field" / file;
    if (!std::filesystem::is_regular_file(path)) return std::nullopt;
    const Result loaded = loadGltf(path, view.scene);
    EXPECT_TRUE(loaded.ok()) << loaded.message();
    completeLights(view.scene);
    view.camera = defaultCamera(view.scene);
    return view;
}

// Green radiance of the pixel in the middle, by the file's lights alone. Empty as field().
std::optional<float> litCentre(const Device& device, const std::string& file) {
    std::optional<View3d> view = field(file);
    if (!view) return std::nullopt;
    view->scene.skyColour = view->scene.groundColour = glm::vec3(0.0f);
    const HdrPicture picture = drawOnce(device, *view, hardDesc(161, 91), ShadowMode::Deferred).linear;
    return picture.rgba[4 * (std::size_t{picture.height / 2} * picture.width + picture.width / 2) + 1];
}

// Shadows stand where rays say, and cover at least so many pixels.
void expectRight(const Device& device, const char* file, std::uint64_t leastDark) {
    SCOPED_TRACE(file);
    const std::optional<View3d> view = field(file);
    if (!view) GTEST_SKIP() << kNoField;
    const Figures f = figuresIn(device, *view, hardDesc(320, 180));
    EXPECT_GE(f.dark, leastDark);
    EXPECT_LE(f.share(f.acne + f.leak), kMostFieldWrong);
    EXPECT_LE(f.share(f.edges), kMostEdges);
    EXPECT_LE(f.visibilityError(), kMostError);
}

TEST_P(FieldCases, SunsThroughLongLenses) {
    expectRight(device(), "01-sun-lost-through-long-lens/prod_m_0.28.gltf", 100);
    expectRight(device(), "01-sun-lost-through-long-lens/prod_mm_0.28.gltf", 100);
    expectRight(device(), "01-sun-lost-through-long-lens/tele300.gltf", 100);
}

TEST_P(FieldCases, SunsInWideWorlds) {
    expectRight(device(), "02-sun-lost-in-a-wide-world/park_sun_0.gltf", 100);
    expectRight(device(), "02-sun-lost-in-a-wide-world/park_sun_-99999.gltf", 100);
    // Whole triangles of so large a ground have another depth in SwiftShader (docs/driver-ledger.md).
    if (isSwiftShader(device())) return;
    expectRight(device(), "02-sun-lost-in-a-wide-world/world30000.gltf", 100);
}

// The second file is the first with a box far out of sight.
TEST_P(FieldCases, AParkedBoxChangesNothing) {
    const std::optional<View3d> alone = field("02-sun-lost-in-a-wide-world/park_sun_0.gltf"),
                                parked = field("02-sun-lost-in-a-wide-world/park_sun_-99999.gltf");
    if (!alone || !parked) GTEST_SKIP() << kNoField;
    const RendererDesc desc = hardDesc(320, 180);
    expectEqual(device(), "parked box", drawOnce(device(), *alone, desc, ShadowMode::Deferred).linear,
                drawOnce(device(), *parked, desc, ShadowMode::Deferred).linear, 1);
}

// The same box before the camera, so far away that it is less than a pixel.
TEST_P(FieldCases, AParkedBoxInViewChangesNothing) {
    const std::optional<View3d> alone = field("02-sun-lost-in-a-wide-world/park_sun_0.gltf");
    if (!alone) GTEST_SKIP() << kNoField;
    View3d parked = *alone;
    for (Instance& instance : parked.scene.instances)
        if (instance.worldFromObject[3].y > 0.0 && instance.worldFromObject[3].y < 1.0) {
            Instance far = instance;
            far.worldFromObject[3] = glm::dvec4(0.0, 0.5, -3e5, 1.0);
            far.node = kNone;
            parked.scene.instances.push_back(far);
            break;
        }
    ASSERT_GT(parked.scene.instances.size(), alone->scene.instances.size());
    const RendererDesc desc = hardDesc(320, 180);
    expectEqual(device(), "parked box in view", drawOnce(device(), *alone, desc, ShadowMode::Deferred).linear,
                drawOnce(device(), parked, desc, ShadowMode::Deferred).linear, 1);
}

// On the axis of a spot, irradiance is intensity over squared distance, whatever the cone.
TEST_P(FieldCases, NarrowSpots) {
    for (const char* file : {"a_spot_o0.05.gltf", "a_spot_o0.0175.gltf"}) {
        const std::optional<float> centre = litCentre(device(), std::string("06-narrow-spot-dims/") + file);
        if (!centre) GTEST_SKIP() << kNoField;
        EXPECT_NEAR(*centre, 6.19f, 0.03f) << file;
    }
}

TEST_P(FieldCases, LampsWithinAMillimetre) {
    for (const char* file : {"a_macro_0.1.gltf", "a_macro_0.001.gltf"}) {
        const std::optional<float> centre = litCentre(device(), std::string("07-lamp-within-a-centimetre/") + file);
        if (!centre) GTEST_SKIP() << kNoField;
        EXPECT_NEAR(*centre, 0.247f, 0.002f) << file;
    }
}

// A light a hundred times as bright makes a picture a hundred times as bright, far beyond what halves hold.
TEST_P(FieldCases, BrightPictures) {
    const std::optional<View3d> bright = field("10-bright-pictures-clip/bright1e+06.gltf"),
                                brighter = field("10-bright-pictures-clip/bright1e+08.gltf");
    if (!bright || !brighter) GTEST_SKIP() << kNoField;
    RendererDesc desc = hardDesc(64, 36);
    desc.floatPicture = true;
    const auto brightest = [&](View3d view) {
        view.scene.skyColour = view.scene.groundColour = glm::vec3(0.0f);
        const HdrPicture picture = drawOnce(device(), view, desc, ShadowMode::Off).linear;
        return *std::ranges::max_element(picture.rgba);
    };
    const float one = brightest(*bright), hundred = brightest(*brighter);
    EXPECT_GT(one, 1000.0f);
    EXPECT_GT(hundred, 65504.0f);
    EXPECT_NEAR(hundred / one, 100.0f, 0.01f);
}

TEST_P(FieldCases, WideSpots) {
    expectRight(device(), "11-wide-spot-is-a-blob/wide1.05.gltf", 100);
    expectRight(device(), "11-wide-spot-is-a-blob/wide1.5707.gltf", 100);
}

// A frame of a sequence is the frame at that time.
TEST_P(FieldCases, SunsWithoutAPast) {
    const std::optional<View3d> view = field("17-history-changes-the-sun/spike1000.gltf");
    if (!view) GTEST_SKIP() << kNoField;
    RendererDesc desc = hardDesc();
    desc.frame.history = false;
    Renderer sequence(device(), view->scene, desc, pipelinesOf(device()));
    for (int frame = 0; frame < 4; ++frame) {
        const double seconds = frame / 30.0;
        sequence.renderFrame(view->camera, ShadowMode::Deferred, seconds);
        const HdrPicture after = sequence.readPicture();
        Renderer fresh(device(), view->scene, desc, pipelinesOf(device()));
        fresh.renderFrame(view->camera, ShadowMode::Deferred, seconds);
        EXPECT_TRUE(after.rgba == fresh.readPicture().rgba) << frame;
    }
}

TEST_P(FieldCases, WithoutARange) {
    const std::optional<View3d> view = field("19-range-that-nobody-gave/norange.glb");
    if (!view) GTEST_SKIP() << kNoField;
    View3d stated = *view;
    for (SceneLight& light : stated.scene.lights) {
        EXPECT_TRUE(light.rangeIsGuessed);
        light.rangeMetres = 1e4f;
        light.rangeIsGuessed = false;
    }
    const auto green = [&](const View3d& v) {
        double sum = 0.0;
        const HdrPicture picture = drawOnce(device(), v, hardDesc(), ShadowMode::Off).linear;
        for (std::size_t i = 1; i < picture.rgba.size(); i += 4) sum += static_cast<double>(picture.rgba[i]);
        return sum;
    };
    const double whole = green(stated), here = green(*view);
    std::printf("[ figure   ] %s: norange: %.3f %% of the green light is lost\n", device().info().name.c_str(),
                100.0 * (1.0 - here / whole));
    EXPECT_NEAR(here, whole, 1e-3 * whole);
}

TEST_P(FieldCases, InTheirHousings) {
    for (const char* file : {"bulb20.gltf", "bulb60.gltf", "bulb.glb"}) {
        const std::optional<View3d> view = field(std::string("16-lamp-housing-near-plane/") + file);
        if (!view) GTEST_SKIP() << kNoField;
        for (const Filter filter : {Filter::Hard, Filter::Pcss}) {
            if (filter == Filter::Pcss && !thorough()) break;
            RendererDesc desc = hardDesc();
            desc.frame.filters = {filter};
            const Figures f = figuresIn(device(), *view, desc);
            EXPECT_GT(f.pairs, 1500u);
            EXPECT_EQ(f.lit, 0u);
            EXPECT_EQ(f.leak + f.contactLeak + f.edgeError, 0u);
            EXPECT_LE(f.visibilityError(), 0.0);
        }
    }
}

TEST_P(FieldCases, InASceneOfFourMillimetres) {
    const std::optional<View3d> view = field("18-metres-in-small-scenes/tiny0.001.gltf");
    if (!view) GTEST_SKIP() << kNoField;
    const Figures f = figuresIn(device(), *view, hardDesc(480, 270));
    EXPECT_GT(f.contacts, 500u);
    EXPECT_LE(f.share(f.acne + f.leak), kMostFieldWrong);
    EXPECT_LE(f.contactLeakOfContacts(), kMostFieldContactsLost);
}

TEST_P(FieldCases, UnderASkyDome) {
    const std::optional<View3d> open = field("03-lamp-size-guessed-from-the-sky/domeQNone.gltf"),
                                under = field("03-lamp-size-guessed-from-the-sky/domeQ500.gltf");
    if (!open || !under) GTEST_SKIP() << kNoField;
    EXPECT_FLOAT_EQ(open->scene.lights[0].sourceRadius, under->scene.lights[0].sourceRadius);
    RendererDesc desc = smallDesc(160, 90);
    const HdrPicture expected = drawOnce(device(), *open, desc, ShadowMode::Deferred).linear;
    HdrPicture actual = drawOnce(device(), *under, desc, ShadowMode::Deferred).linear;
    // The dome stands where the other file has no geometry.
    for (std::size_t i = 0; i < expected.rgba.size(); i += 4)
        if (expected.rgba[i + 3] == 0.0f)
            std::copy_n(expected.rgba.begin() + static_cast<std::ptrdiff_t>(i), 4,
                        actual.rgba.begin() + static_cast<std::ptrdiff_t>(i));
    expectEqual(device(), "sky dome", expected, actual, 1);
}

}  // namespace
}  // namespace gnomon::renderer::image_test
