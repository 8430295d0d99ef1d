// What is read back of a frame beside its picture: depths and normals against the triangles themselves, in double, and
// pictures of floats against pictures of halves.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "image/renderer/harness.h"
#include "truth/receivers.h"

namespace gnomon::renderer::image_test {
namespace {

GNOMON_IMAGE_TEST_SUITE(Readback);

constexpr double kRelative = 2e-6;

// Rasterizers place vertices on a grid, and by so much of a pixel a slanted face is elsewhere. Measured: at most 47 %
// of what is allowed (SwiftShader, 1/16 pixel), 36 % (lavapipe, 1/256).
double gridPixels(const Device& device) {
    return std::ldexp(1.0, -static_cast<int>(device.limits().subPixelPrecisionBits));
}

// Images are larger than the frame.
constexpr std::uint32_t kWidth = 90, kHeight = 50;

RendererDesc largeDesc() {
    RendererDesc desc = smallDesc(kWidth + 7, kHeight + 13);
    desc.frame.filters = {Filter::Hard};
    desc.atlasSizePx = 256;
    return desc;
}

struct DrawnGeometry {
    std::vector<TruthReceiver> receivers;
    std::vector<float> depths;
    std::vector<glm::vec3> normals;
    glm::dvec3 eye, forward;
};

DrawnGeometry drawGeometry(Renderer& renderer, const View3d& view, DeviceDepth deviceDepth) {
    FrameSettings settings = renderer.settings();
    settings.widthPx = kWidth;
    settings.heightPx = kHeight;
    settings.deviceDepth = deviceDepth;
    renderer.set(settings);
    renderer.renderFrame(view.camera, ShadowMode::Off);
    DrawnGeometry out;
    const TracedScene traced(view.scene, poseAt(view.scene, 0.0), glm::dvec3(0.0));
    out.receivers = receiversOf(traced, view.camera, kWidth, kHeight, renderer.readTriangleIds());
    out.depths = renderer.readDepth();
    out.normals = renderer.readNormals();
    out.eye = glm::dvec3(view.camera.worldFromCamera[3]);
    out.forward = -glm::normalize(glm::dvec3(view.camera.worldFromCamera[2]));
    return out;
}

// `absolute`: what a step of the depth buffer is worth at distance z.
template <typename Step>
void expectTrueDepths(const Device& device, const std::string& name, const DrawnGeometry& drawn, const Step& absolute) {
    SCOPED_TRACE(name);
    ASSERT_EQ(drawn.depths.size(), std::size_t{kWidth} * kHeight);
    double worst = 0.0, worstShare = 0.0;
    std::size_t background = 0;
    for (std::size_t i = 0; i < drawn.depths.size(); ++i) {
        const TruthReceiver& r = drawn.receivers[i];
        if (r.triangle == kNone) {
            EXPECT_EQ(drawn.depths[i], std::numeric_limits<float>::infinity()) << i;
            ++background;
            continue;
        }
        const double truth = glm::dot(r.position - drawn.eye, drawn.forward);
        const double slanted =
            gridPixels(device) * r.pixelMetres / std::max(std::abs(glm::dot(r.normal, r.toEye)), 1e-3);
        const double allowed = kRelative * truth + slanted + absolute(truth), error = std::abs(drawn.depths[i] - truth);
        EXPECT_LE(error, allowed) << i << " at " << truth;
        worst = std::max(worst, error / truth);
        worstShare = std::max(worstShare, error / allowed);
    }
    EXPECT_GT(background, 100u);
    EXPECT_GT(drawn.depths.size() - background, 1000u);
    std::printf("[ figure   ] %s: %s: depths off by %.2g of themselves at most, %.0f %% of what is allowed\n",
                device.info().name.c_str(), name.c_str(), worst, 100.0 * worstShare);
}

double nothing(double /*z*/) {
    return 0.0;
}

TEST_P(Readback, DepthsAreTrue) {
    View3d view = builtin("sphere-on-plane");
    const View3d flat = orthographic(view, 12.0f);
    Renderer renderer(device(), view.scene, largeDesc(), pipelinesOf(device()));
    constexpr double kStep = 1.2e-7;  // of a float near 1
    expectTrueDepths(device(), "reversed Z", drawGeometry(renderer, view, DeviceDepth::ReversedZ), nothing);
    const double nearest = static_cast<double>(view.camera.nearMetres);
    expectTrueDepths(device(), "standard Z", drawGeometry(renderer, view, DeviceDepth::StandardZ),
                     [&](double z) { return kStep * z * z / nearest; });
    view.camera.farMetres = 30.0f;
    expectTrueDepths(device(), "reversed Z to 30 m", drawGeometry(renderer, view, DeviceDepth::ReversedZ), nothing);
    expectTrueDepths(device(), "standard Z to 30 m", drawGeometry(renderer, view, DeviceDepth::StandardZ),
                     [&](double z) { return kStep * z * z / nearest; });
    // Without a far plane an orthographic camera sees 10,000 of its half heights.
    const double farthest = 1e4 * static_cast<double>(flat.camera.orthographicHalfHeight);
    for (const DeviceDepth depth : {DeviceDepth::ReversedZ, DeviceDepth::StandardZ})
        expectTrueDepths(device(), depth == DeviceDepth::ReversedZ ? "orthographic, reversed Z" : "orthographic",
                         drawGeometry(renderer, flat, depth), [&](double) { return kStep * farthest; });
}

TEST_P(Readback, NormalsAreTheFacesOfFlatThings) {
    for (const char* scene : {"boxes", "single-triangle"}) {
        SCOPED_TRACE(scene);
        const View3d view = builtin(scene);
        Renderer renderer(device(), view.scene, largeDesc(), pipelinesOf(device()));
        const DrawnGeometry drawn = drawGeometry(renderer, view, DeviceDepth::ReversedZ);
        std::size_t counted = 0;
        ASSERT_EQ(drawn.normals.size(), drawn.receivers.size());
        for (std::size_t i = 0; i < drawn.normals.size(); ++i) {
            const glm::dvec3 face = drawn.receivers[i].triangle == kNone ? glm::dvec3(0.0) : drawn.receivers[i].normal;
            EXPECT_LT(glm::length(glm::dvec3(drawn.normals[i]) - face), 1e-4) << i;
            counted += drawn.receivers[i].triangle != kNone ? 1 : 0;
        }
        EXPECT_GT(counted, 200u);
    }
}

// A lamp so close above a grey plane that the middle of the picture is beyond all halves, and its rim is not.
View3d brightPlane(float metres, float candela) {
    View3d view = builtin("empty-plane");
    SceneLight lamp;
    lamp.position = {0.0f, metres, 0.0f};
    lamp.intensity = candela;
    lamp.rangeMetres = 100.0f;
    lamp.sourceRadius = 0.001f * metres;
    view.scene.lights = {lamp};
    view.camera.worldFromCamera = glm::inverse(glm::lookAt(glm::vec3(0, 6, 0), glm::vec3(0), glm::vec3(0, 0, -1)));
    return view;
}

// True for the two halves that the number lies between: devices may round either way.
bool isRounded(float half, float number) {
    const std::uint16_t bits = glm::packHalf1x16(half);
    return half <= number ? glm::unpackHalf1x16(static_cast<std::uint16_t>(bits + 1)) >= number
                          : glm::unpackHalf1x16(static_cast<std::uint16_t>(bits - 1)) <= number;
}

// All but a few: shaders may be compiled to another last bit.
void expectSameButForHalves(const HdrPicture& half, const HdrPicture& whole) {
    ASSERT_EQ(half.rgba.size(), whole.rgba.size());
    std::size_t clipped = 0, rounded = 0;
    for (std::size_t i = 0; i < half.rgba.size(); ++i) {
        if (whole.rgba[i] >= kBrightestHalf) {
            EXPECT_EQ(half.rgba[i], kBrightestHalf) << i;
            ++clipped;
            continue;
        }
        EXPECT_NEAR(half.rgba[i], whole.rgba[i], whole.rgba[i] / 1024.0f + 6e-8f) << i;
        rounded += isRounded(half.rgba[i], whole.rgba[i]) ? 1 : 0;
    }
    EXPECT_GT(clipped, 300u);
    EXPECT_GT(half.rgba.size() - clipped, 3000u);
    EXPECT_GT(static_cast<double>(rounded), 0.99 * static_cast<double>(half.rgba.size() - clipped));
    EXPECT_EQ(clippedPixels(half), clipped / 3);
    EXPECT_EQ(clippedPixels(whole), 0u);
}

TEST_P(Readback, FloatPicturesGoOnWhereHalvesEnd) {
    const View3d view = brightPlane(1.0f, 2.0e6f);
    RendererDesc desc = largeDesc();
    Renderer halves(device(), view.scene, desc, pipelinesOf(device()));
    desc.floatPicture = true;
    Renderer floats(device(), view.scene, desc, pipelinesOf(device()));
    for (const ShadowMode mode : {ShadowMode::Off, ShadowMode::Deferred, ShadowMode::Inline}) {
        // Software devices take seconds for each pipeline. The program's tests draw the deferred ones, too.
        if (!thorough() && mode != ShadowMode::Off) continue;
        SCOPED_TRACE(static_cast<int>(mode));
        floats.prepare(mode);
        const RendererCounts before = floats.counts();
        const HdrPicture whole = draw(floats, view.camera, mode).linear;
        EXPECT_EQ(floats.counts().lightingPipelines, before.lightingPipelines) << "prepare() made others";
        EXPECT_GT(*std::ranges::max_element(whole.rgba), 2.0e5f);
        expectSameButForHalves(draw(halves, view.camera, mode).linear, whole);
    }
}

// A millimetre from a lamp of 1e35 candela no float holds the light.
TEST_P(Readback, InfiniteLightIsTheLargestFloat) {
    const View3d view = brightPlane(0.001f, 1.0e35f);
    RendererDesc desc = largeDesc();
    desc.floatPicture = true;
    const HdrPicture picture = drawOnce(device(), view, desc, ShadowMode::Off).linear;
    EXPECT_EQ(picture.brightest, std::numeric_limits<float>::max());
    EXPECT_EQ(*std::ranges::max_element(picture.rgba), picture.brightest);
    EXPECT_GT(clippedPixels(picture), 0u);
}

}  // namespace
}  // namespace gnomon::renderer::image_test
