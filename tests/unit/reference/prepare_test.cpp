// The convex tests against dense sampling, and the checkers of phase 1 against honest and spoilt buffers.
#include <gtest/gtest.h>

#include "honest_buffers.h"
#include "reference/convex.h"
#include "reference/prepare.h"

namespace gnomon::reference {
namespace {

bool inside(const Polyhedron& polyhedron, Vec3 p) {
    for (const Plane& plane : polyhedron)
        if (dot(plane.normal, p) + plane.offset < 0) return false;
    return true;
}

TEST(Convex, NearestPointOfAFrustum) {
    CameraSetup setup;
    setup.eye = {0, 0, 0};
    setup.target = {0, 0, -1};
    setup.verticalFieldOfView = kPi / 2;
    setup.nearMetres = 1;
    const CameraModel camera = makeCameraModel(makeCamera(setup, 64, 64), 64, 64);
    const Polyhedron frustum = viewFrustum(camera);
    EXPECT_EQ(frustum.size(), 5u);
    EXPECT_TRUE(inside(frustum, {0, 0, -2}));
    EXPECT_FALSE(inside(frustum, {0, 0, -0.5}));
    EXPECT_FALSE(inside(frustum, {3, 0, -2}));
    // Straight before the near plane; beside a side; beside an edge; at a corner of the near plane.
    EXPECT_NEAR(length(nearestPoint(frustum, {0, 0, 1}) - Vec3{0, 0, -1}), 0, 1e-6);
    EXPECT_NEAR(length(nearestPoint(frustum, {6, 0, -2}) - Vec3{4, 0, -4}), 0, 1e-5);
    EXPECT_NEAR(length(nearestPoint(frustum, {3, 3, 0}) - Vec3{2, 2, -2}), 0, 1e-5);
    EXPECT_NEAR(length(nearestPoint(frustum, {1.1, 1.1, 1}) - Vec3{1, 1, -1}), 0, 1e-5);
}

// No sampled point of a light's volume may lie in a piece of the view that it is said never to meet, and where it must
// meet one, a point is found by the proof itself; sampling finds one too where the common part is not tiny.
TEST(Convex, MeetsAgreesWithSampling) {
    Random random(3);
    std::size_t sampled = 0, must = 0, never = 0;
    for (int round = 0; round < 12; ++round) {
        const CameraSetup setup = randomCamera(random);
        const CameraModel camera = makeCameraModel(makeCamera(setup, 128, 96), 128, 96);
        LightSetup lightSetup;
        lightSetup.count = 30;
        lightSetup.directionalShare = 0;
        const std::vector<Light> host = makeLights(random, setup, lightSetup);
        for (const LightModel& light : makeLightModels(host, {}, camera)) {
            const Polyhedron piece = viewPiece(camera, 32, 32, 64, 64, camera.nearMetres + 1, camera.nearMetres + 6);
            const Verdict verdict = meets(light, piece, 1e-6);
            bool found = false;
            for (int i = 0; i < 3000 && !found; ++i) {
                const Vec3 v = random.unitVector() * std::cbrt(random.uniform());
                if (light.type == LightType::Spot && dot(v, light.direction) < std::cos(light.outerAngle) * length(v))
                    continue;
                found = inside(piece, light.position + v * light.rangeMetres);
            }
            sampled += found;
            must += verdict == Verdict::Must;
            never += verdict == Verdict::Never;
            EXPECT_TRUE(!found || verdict == Verdict::Must);
        }
    }
    EXPECT_GT(never, 50u);
    EXPECT_GT(sampled, must / 3);
}

struct Phase1 {
    TestFrame frame = makeTestFrame(4, 128, 96, 40);
    double nearMetres = 0, binsPerMetre = 0;
    std::vector<LightModel> lights;
    std::vector<std::uint32_t> zBins, masks;
    std::uint32_t tilesX = 4, tilesY = 3;

    Phase1() {
        const CameraModel& camera = frame.model;
        for (const LightModel& light : frame.lights)
            if (isVisible(light, camera) != Verdict::Never) lights.push_back(light);
        std::stable_sort(lights.begin(), lights.end(), [&](const LightModel& a, const LightModel& b) {
            const auto key = [&](const LightModel& light) {
                return light.type == LightType::Directional ? -kInfinity
                                                            : viewDepth(camera, light.position) - light.rangeMetres;
            };
            return key(a) < key(b);
        });
        fillZBins();
        fillMasks();
    }
    void fillZBins() {
        nearMetres = frame.model.nearMetres;
        double reach = nearMetres + 1;
        for (const LightModel& light : lights)
            if (light.type != LightType::Directional)
                reach = std::max(reach, viewDepth(frame.model, light.position) + light.rangeMetres);
        binsPerMetre = gpu::kZBinCount / (reach - nearMetres);
        zBins.assign(gpu::kZBinWords, gpu::kZBinEmpty);
        for (std::uint32_t b = 0; b < gpu::kZBinCount; ++b) {
            for (std::uint32_t i = 0; i < lights.size(); ++i) {
                if (lights[i].type == LightType::Directional) continue;
                const double depth = viewDepth(frame.model, lights[i].position), range = lights[i].rangeMetres;
                const double from = nearMetres + b / binsPerMetre, to = nearMetres + (b + 1) / binsPerMetre;
                if (depth + range < from || depth - range > to) continue;
                zBins[b] = gpu::packZBin(std::min(gpu::zBinMin(zBins[b]), i), std::max(gpu::zBinMax(zBins[b]), i));
            }
        }
        std::uint32_t lowest = 0xFFFF, highest = 0;
        for (std::uint32_t b = gpu::kZBinCount; b-- > 0;)
            zBins[gpu::kZBinCount + b] = lowest = std::min(lowest, gpu::zBinMin(zBins[b]));
        for (std::uint32_t b = 0; b < gpu::kZBinCount; ++b)
            zBins[gpu::kZBinCount + b] |= (highest = std::max(highest, gpu::zBinMax(zBins[b]))) << 16;
    }
    void fillMasks() {
        masks.assign(std::size_t(tilesX) * tilesY * gpu::kLightMaskEntryWords, 0);
        for (std::uint32_t t = 0; t < tilesX * tilesY; ++t) {
            const double x = t % tilesX * 32.0, y = t / tilesX * 32.0;
            const Polyhedron piece =
                viewPiece(frame.model, x, y, x + 32, y + 32, frame.model.nearMetres, frame.model.farMetres);
            for (std::uint32_t i = 0; i < lights.size(); ++i)
                if (lights[i].type != LightType::Directional && meets(lights[i], piece, 1e-4) != Verdict::Never)
                    setMaskBit(&masks[t * gpu::kLightMaskEntryWords], i);
        }
    }
};

TEST(Prepare, HonestBuffersPass) {
    const Phase1 phase;
    ASSERT_GT(phase.lights.size(), 15u);
    const VisibleReport visible = checkVisibleLights(phase.frame.lights, phase.lights, phase.frame.model);
    EXPECT_TRUE(visible.findings.ok()) << visible.findings.text();
    const CoverReport bins =
        checkZBins(phase.lights, phase.frame.model, phase.zBins, phase.nearMetres, phase.binsPerMetre);
    EXPECT_TRUE(bins.findings.ok()) << bins.findings.text();
    EXPECT_GT(bins.required, 200u);
    const CoverReport masks =
        checkTileLightMasks(phase.lights, phase.frame.model, phase.masks, phase.tilesX, phase.tilesY);
    EXPECT_TRUE(masks.findings.ok()) << masks.findings.text();
    EXPECT_GT(masks.required, 50u);
    EXPECT_LT(masks.surplusShare(), 0.05);
}

TEST(Prepare, PlantedErrorsAreFound) {
    Phase1 phase;
    const CameraModel& camera = phase.frame.model;
    // A visible light left out.
    std::vector<LightModel> fewer = phase.lights;
    for (std::size_t i = 0; i < fewer.size(); ++i)
        if (isVisible(fewer[i], camera) == Verdict::Must) {
            fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
            break;
        }
    EXPECT_FALSE(checkVisibleLights(phase.frame.lights, fewer, camera).findings.ok());
    // The wrong order.
    std::vector<LightModel> reversed(phase.lights.rbegin(), phase.lights.rend());
    EXPECT_FALSE(checkVisibleLights(phase.frame.lights, reversed, camera).findings.ok());
    // Two lights of one volume: the host's first must be first.
    std::vector<LightModel> twins(2, phase.lights.back());
    twins[0].hostIndex = 0;
    twins[1].hostIndex = 1;
    EXPECT_TRUE(checkVisibleLights(twins, twins, camera).findings.ok());
    EXPECT_FALSE(checkVisibleLights(twins, {twins[1], twins[0]}, camera).findings.ok());
    // A mask bit lost, and a stray one.
    for (std::size_t t = 0; t < phase.masks.size(); t += gpu::kLightMaskEntryWords) {
        if (phase.masks[t] == 0) continue;
        std::vector<std::uint32_t> spoilt = phase.masks;
        spoilt[t] = 0;
        const CoverReport lost = checkTileLightMasks(phase.lights, camera, spoilt, phase.tilesX, phase.tilesY);
        EXPECT_FALSE(lost.findings.ok());
        spoilt = phase.masks;
        setMaskBit(&spoilt[t], 1000);
        EXPECT_FALSE(checkTileLightMasks(phase.lights, camera, spoilt, phase.tilesX, phase.tilesY).findings.ok());
        break;
    }
    // A light lost from a zBin, and a wrong ranged entry.
    std::vector<std::uint32_t> spoilt = phase.zBins;
    for (std::uint32_t b = 0; b < gpu::kZBinCount; ++b) spoilt[b] = gpu::kZBinEmpty;
    EXPECT_FALSE(checkZBins(phase.lights, camera, spoilt, phase.nearMetres, phase.binsPerMetre).findings.ok());
    spoilt = phase.zBins;
    spoilt[gpu::kZBinCount + 500] ^= 1;
    EXPECT_EQ(checkZBins(phase.lights, camera, spoilt, phase.nearMetres, phase.binsPerMetre).findings.errors, 1u);
}

TEST(Prepare, CandidatesUseStandardAndRangedEntries) {
    // The paper's figure 3a: lights 0 and 1 in the first and last bins, light 2 between.
    std::vector<std::uint32_t> words(gpu::kZBinWords, gpu::kZBinEmpty);
    for (std::uint32_t b = 0; b < gpu::kZBinCount; ++b)
        words[b] = b < 4    ? gpu::packZBin(0, 0)
                   : b < 8  ? gpu::packZBin(2, 2)
                   : b < 12 ? gpu::packZBin(1, 1)
                            : gpu::kZBinEmpty;
    for (std::uint32_t b = 0; b < gpu::kZBinCount; ++b)
        words[gpu::kZBinCount + b] = gpu::packZBin(b < 4 ? 0 : b < 12 ? 1 : 0xFFFF, b < 4 ? 0 : 2);
    const auto range = [&](double from, double to) { return candidatesInDepthRange(words, 0, 1, from, to); };
    EXPECT_EQ(range(0.5, 1.5).last, 0u);
    EXPECT_EQ(range(5.2, 5.9).first, 2u);
    EXPECT_EQ(range(7.5, 8.5).first, 1u);
    EXPECT_EQ(range(7.5, 8.5).last, 2u);
    EXPECT_EQ(range(0.5, 11.5).first, 0u);
    EXPECT_EQ(range(0.5, 11.5).last, 2u);
    EXPECT_GT(range(13.5, 13.6).first, range(13.5, 13.6).last);
}

}  // namespace
}  // namespace gnomon::reference
