// Which light reaches which pixel: closed forms, and planted errors in lists and masks.
#include <gtest/gtest.h>

#include "honest_buffers.h"

namespace gnomon::reference {
namespace {

Pixel pixelAt(Vec3 position, Vec3 normal = {0, 1, 0}) {
    Pixel pixel;
    pixel.background = false;
    pixel.position = position;
    pixel.positionError = 1e-6;
    pixel.hasFaceNormal = true;
    pixel.faceNormal = normal;
    return pixel;
}

TEST(FindLights, RangeMaskAndBackground) {
    LightModel light;
    light.rangeMetres = 2;
    EXPECT_EQ(inInfluence(light, pixelAt({0, 1.9, 0})), Verdict::Must);
    EXPECT_EQ(inInfluence(light, pixelAt({0, 2.1, 0})), Verdict::Never);
    EXPECT_EQ(inInfluence(light, pixelAt({0, 2.0, 0})), Verdict::May);
    Pixel pixel = pixelAt({0, 1, 0});
    pixel.receiverMask = 0x0F;
    light.mask = 0xF0;
    EXPECT_EQ(inInfluence(light, pixel), Verdict::Never);
    light.mask = 0x18;
    EXPECT_EQ(inInfluence(light, pixel), Verdict::Must);
    pixel.background = true;
    EXPECT_EQ(inInfluence(light, pixel), Verdict::Never);
    light.type = LightType::Directional;
    EXPECT_EQ(inInfluence(light, pixel), Verdict::Never);
    EXPECT_EQ(inInfluence(light, pixelAt({1e4, 0, 0})), Verdict::Must);
}

TEST(FindLights, Cone) {
    LightModel light;
    light.type = LightType::Spot;
    light.rangeMetres = 10;
    light.outerAngle = kPi / 6;
    light.direction = {0, -1, 0};
    const double edge = std::tan(kPi / 6);
    EXPECT_EQ(inInfluence(light, pixelAt({edge - 0.001, -1, 0})), Verdict::Must);
    EXPECT_EQ(inInfluence(light, pixelAt({edge + 0.001, -1, 0})), Verdict::Never);
    EXPECT_EQ(inInfluence(light, pixelAt({edge, -1, 0})), Verdict::May);
    EXPECT_EQ(inInfluence(light, pixelAt({0, 1, 0})), Verdict::Never);
}

TEST(FindLights, FacingCountsForCastersOnly) {
    LightModel light;
    light.position = {0, -1, 0};
    light.rangeMetres = 10;
    const Pixel away = pixelAt({0, 0, 0});
    EXPECT_EQ(facesLight(light, away), Verdict::Never);
    EXPECT_EQ(reaches(light, away, true), Verdict::Must);  // does not cast
    light.casts = true;
    EXPECT_EQ(reaches(light, away, true), Verdict::Never);
    EXPECT_EQ(reaches(light, away, false), Verdict::Must);
    Pixel subsurface = away;
    subsurface.subsurface = true;
    EXPECT_EQ(reaches(light, subsurface, true), Verdict::Must);
    Pixel unknown = away;
    unknown.hasFaceNormal = false;
    EXPECT_EQ(reaches(light, unknown, true), Verdict::May);
    light.position = {5, 0, 0};  // in the plane of the face
    EXPECT_EQ(reaches(light, away, true), Verdict::May);
    light.type = LightType::Directional;
    light.direction = {0, -1, 0};
    EXPECT_EQ(facesLight(light, away), Verdict::Must);
}

// A light over a floor lights a disk: the pixels in range are those within sqrt(range^2 - height^2) of its foot.
TEST(FindLights, DiskOnAFloor) {
    CameraSetup setup;
    setup.eye = {0, 10, 0};
    setup.target = {0, 0, 0};
    const Camera camera = makeCamera(setup, 96, 96);
    const CameraModel model = makeCameraModel(camera, 96, 96);
    const PixelGrid grid = makePixelGrid(model, renderReceivers({plane({0, 0, 0}, {0, 1, 0})}, camera, 96, 96));
    LightModel light;
    light.position = {1, 1.5, 0.5};
    light.rangeMetres = 2.5;
    std::size_t lit = 0;
    for (const Pixel& pixel : grid.pixels) {
        ASSERT_FALSE(pixel.background);
        EXPECT_NEAR(pixel.position.y, 0, 1e-4);
        const double radius = std::hypot(pixel.position.x - 1, pixel.position.z - 0.5);
        const Verdict expected = std::abs(radius - 2) < 1e-3 ? inInfluence(light, pixel)
                                 : radius < 2                ? Verdict::Must
                                                             : Verdict::Never;
        EXPECT_EQ(inInfluence(light, pixel), expected);
        lit += inInfluence(light, pixel) == Verdict::Must;
    }
    const double pixelArea = std::pow(2 * 10 * std::tan(0.5) / 96, 2);
    EXPECT_NEAR(lit * pixelArea, kPi * 4, 0.3);
}

TEST(FindLights, TilesAreWhatTheirPixelsAre) {
    const TestFrame frame = makeTestFrame(7, 70, 50, 40);
    const std::vector<TileLights> tiles = findLights(frame.grid, frame.lights, true);
    std::size_t must = 0, may = 0;
    for (std::uint32_t t = 0; t < tiles.size(); ++t) {
        for (std::uint32_t i = 0; i < frame.lights.size(); ++i) {
            Verdict verdict = Verdict::Never;  // without the bounding ball's shortcut
            for (const auto [x, y] : frame.grid.tilePixels(t % frame.grid.tilesX, t / frame.grid.tilesX))
                verdict = either(verdict, reaches(frame.lights[i], frame.grid.at(x, y), true));
            const auto in = [&](const auto& list) { return std::count(list.begin(), list.end(), i) == 1; };
            EXPECT_EQ(in(tiles[t].must), verdict == Verdict::Must);
            EXPECT_EQ(in(tiles[t].may), verdict == Verdict::May);
            must += verdict == Verdict::Must;
            may += verdict == Verdict::May;
        }
    }
    EXPECT_GT(must, 200u);
    EXPECT_LT(may, must / 50 + 3);
}

struct Frame : testing::Test {
    TestFrame frame = makeTestFrame(8, 130, 70, 40);
    std::vector<TileLights> expected = findLights(frame.grid, frame.lights, true);
    HonestBuffers honest = makeHonestBuffers(frame, expected);
    std::size_t fullTile() const {
        for (std::size_t t = 0; t < expected.size(); ++t)
            if (expected[t].must.size() >= 4) return t;
        return 0;
    }
};

TEST_F(Frame, HonestListsPass) {
    const EarlyListReport early = checkEarlyLists(expected, frame.lights, honest.view());
    EXPECT_TRUE(early.findings.ok()) << early.findings.text();
    EXPECT_GT(early.must, 200u);
    const ApproximateReport approximate =
        checkApproximate(frame.grid, expected, frame.lights.size(), honest.groupMasks, honest.view());
    EXPECT_TRUE(approximate.findings.ok()) << approximate.findings.text();
    EXPECT_EQ(approximate.groupBits, approximate.groupBitsNeeded);
}

TEST_F(Frame, EarlyListErrorsAreFound) {
    const std::size_t tile = fullTile();
    ASSERT_GE(expected[tile].must.size(), 4u);
    const auto errors = [&](const HonestBuffers& spoilt) {
        return checkEarlyLists(expected, frame.lights, spoilt.view()).findings.errors;
    };
    HonestBuffers spoilt = honest;
    spoilt.earlyCounts[tile] -= 1;  // the last light lost (and perhaps the casting count)
    EXPECT_GE(errors(spoilt), 1u);
    spoilt = honest;
    spoilt.earlyCounts[tile] += 1u << gpu::kEarlyCastingShift;
    EXPECT_EQ(errors(spoilt), 1u);
    spoilt = honest;
    spoilt.earlyList[spoilt.slotIds[tile] / 3] ^= 0x3FFu;  // another light in the first's place
    EXPECT_GE(errors(spoilt), 2u);
}

TEST_F(Frame, ApproximateErrorsAreFound) {
    const std::size_t tile = fullTile();
    const auto errors = [&](const HonestBuffers& spoilt) {
        return checkApproximate(frame.grid, expected, frame.lights.size(), spoilt.groupMasks, spoilt.view())
            .findings.errors;
    };
    HonestBuffers spoilt = honest;
    spoilt.groupMasks[0] = 0;  // the words stay: they must not be looked at
    EXPECT_GE(errors(spoilt), 1u);
    spoilt = honest;
    setMaskBit(spoilt.groupMasks.data(), 999);
    EXPECT_EQ(errors(spoilt), 1u);
    spoilt = honest;
    spoilt.approximateCounts[tile] = 1;  // too few, and exceeded
    EXPECT_EQ(errors(spoilt), 2u);
}

TEST_F(Frame, StructureErrorsAreFound) {
    const StructureReport right = checkStructure(honest.view(), frame.lights.size());
    EXPECT_TRUE(right.findings.ok()) << right.findings.text();
    EXPECT_EQ(right.usedSlots, honest.slots);
    ASSERT_GT(right.usedSlots, 2u);
    const auto errors = [&](const HonestBuffers& spoilt) {
        return checkStructure(spoilt.view(), frame.lights.size()).findings.errors;
    };
    const std::size_t tile = fullTile();
    HonestBuffers spoilt = honest;
    spoilt.approximateCounts[tile] += 3;  // reaches into the next tile
    EXPECT_EQ(errors(spoilt), 1u);
    spoilt = honest;
    spoilt.slotIds[tile] += 1;
    EXPECT_GE(errors(spoilt), 1u);
    spoilt = honest;
    spoilt.slotIds[tile] = static_cast<std::uint32_t>(spoilt.finalList.size());
    EXPECT_GE(errors(spoilt), 1u);
    spoilt = honest;
    std::uint32_t& word = spoilt.earlyList[spoilt.slotIds[tile] / 3];
    word = (word & ~(0x3FFu << 10)) | ((word & 0x3FFu) << 10);  // the first light twice
    EXPECT_GE(errors(spoilt), 1u);
    spoilt = honest;
    spoilt.finalCounts[tile] |= gpu::kFinalEvaluateBit;
    EXPECT_EQ(errors(spoilt), 1u);
    spoilt = honest;
    std::uint32_t* entry = spoilt.findEntry(true);
    *entry = gpu::packFinalEntry(gpu::finalLightIndex(*entry), gpu::kSlotEvaluate - 1);  // beyond every pool
    EXPECT_EQ(errors(spoilt), 1u);
    *entry = gpu::packFinalEntry(gpu::finalLightIndex(*entry), gpu::kSlotEvaluate);  // without the tile's bit
    EXPECT_EQ(errors(spoilt), 1u);
    *entry = gpu::packFinalEntry(gpu::finalLightIndex(*entry), honest.slots);
    EXPECT_EQ(errors(spoilt), 1u);
    *entry = gpu::packFinalEntry(gpu::finalLightIndex(*entry), honest.slots - 1);  // another entry's slot
    EXPECT_EQ(errors(spoilt), 1u);
    *entry = gpu::packFinalEntry(gpu::finalLightIndex(*entry) ^ 1, gpu::kSlotAllLit);  // another light's place
    EXPECT_EQ(errors(spoilt), 1u);
    spoilt = honest;
    --spoilt.finalCounts[tile];  // a light goes missing: the lists are no longer as long, nor the same
    EXPECT_EQ(errors(spoilt), 2u);
}

TEST_F(Frame, TilesWithoutSpaceMustBeEvaluated) {
    const std::size_t tile = fullTile();
    HonestBuffers spoilt = honest;
    spoilt.slotIds[tile] = gpu::kNoListSpace;
    EXPECT_EQ(checkStructure(spoilt.view(), frame.lights.size()).findings.errors, 2u);  // its bit lacks, its count not
    spoilt.finalCounts[tile] = gpu::kFinalEvaluateBit;
    const StructureReport report = checkStructure(spoilt.view(), frame.lights.size());
    EXPECT_TRUE(report.findings.ok()) << report.findings.text();
    EXPECT_EQ(report.tilesWithoutSpace, 1u);
    const auto coordinates = static_cast<std::uint32_t>(tile / spoilt.tilesX << 16 | tile % spoilt.tilesX);
    EXPECT_TRUE(checkEvaluateTiles(spoilt.view(), std::vector<std::uint32_t>{1, 1, 1, 1, coordinates}).ok());
    EXPECT_FALSE(checkEvaluateTiles(spoilt.view(), std::vector<std::uint32_t>{1, 1, 1, 1, coordinates + 1}).ok());
    EXPECT_FALSE(checkEvaluateTiles(spoilt.view(), std::vector<std::uint32_t>{1, 2, 1, 1, coordinates}).ok());
    EXPECT_FALSE(checkEvaluateTiles(spoilt.view(), std::vector<std::uint32_t>{1024, 1, 1, 1, coordinates}).ok());
    EXPECT_FALSE(checkEvaluateTiles(spoilt.view(), std::vector<std::uint32_t>{1, 1, 1, 0, coordinates}).ok());
}

}  // namespace
}  // namespace gnomon::reference
