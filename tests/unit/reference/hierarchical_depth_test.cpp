// Tile depths of a hand-made picture, and planted errors.
#include <gtest/gtest.h>

#include "reference/hierarchical_depth.h"
#include "reference/test_scene.h"

namespace gnomon::reference {
namespace {

// 12 x 9: two tiles across, two down, the last ones ragged.
struct Picture {
    CameraModel camera;
    Receivers receivers;
    PixelGrid grid;
    Picture() {
        CameraSetup setup;
        setup.nearMetres = 0.5;
        camera = makeCameraModel(makeCamera(setup, 12, 9), 12, 9);
        receivers.widthPx = 12;
        receivers.heightPx = 9;
        receivers.depth.assign(12 * 9, 0.0f);   // background
        receivers.depth[0] = 0.25f;             // 2 m
        receivers.depth[3 * 12 + 7] = 0.0625f;  // 8 m
        receivers.depth[8 * 12 + 11] = 0.5f;    // 1 m, in the last tile
        grid = makePixelGrid(camera, receivers);
    }
};

TEST(HierarchicalDepth, HandMadePicture) {
    const Picture picture;
    const std::vector<TileDepths> tiles = tileDepths(picture.grid);
    ASSERT_EQ(tiles.size(), 4u);
    EXPECT_NEAR(tiles[0].minMetres, 2, 1e-6);
    EXPECT_NEAR(tiles[0].maxMetres, 8, 1e-6);
    EXPECT_TRUE(tiles[1].empty());
    EXPECT_TRUE(tiles[2].empty());
    EXPECT_NEAR(tiles[3].minMetres, 1, 1e-6);
    EXPECT_EQ(tiles[3].minMetres, tiles[3].maxMetres);
}

TEST(HierarchicalDepth, CheckerFindsPlantedErrors) {
    const Picture picture;
    const float inf = std::numeric_limits<float>::infinity();
    const std::vector<float> right = {2, 8, inf, -inf, inf, -inf, 1, 1};
    EXPECT_TRUE(checkTileDepths(picture.grid, right).ok()) << checkTileDepths(picture.grid, right).text();
    std::vector<float> wrong = right;
    wrong[1] = 8.001f;
    EXPECT_EQ(checkTileDepths(picture.grid, wrong).errors, 1u);
    wrong = right;
    wrong[2] = 1;  // an empty tile with a range
    wrong[3] = 2;
    EXPECT_EQ(checkTileDepths(picture.grid, wrong).errors, 1u);
    wrong = right;
    wrong[6] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(checkTileDepths(picture.grid, wrong).errors, 1u);
    wrong.pop_back();
    EXPECT_FALSE(checkTileDepths(picture.grid, wrong).ok());
}

// 2 m and 8 m: the first slice and the last one. A third pixel in between, at 4 m: slice 32 (4 - 2) / 6 = 10.67.
TEST(HierarchicalDepth, SlicesOfAHandMadePicture) {
    Picture picture;
    EXPECT_EQ(tileSlices(picture.grid, 0, 0, 2, 8).must, 0x80000001u);
    EXPECT_EQ(tileSlices(picture.grid, 1, 1, 1, 1).must, 1u);
    picture.receivers.depth[12] = 0.125f;
    picture.grid = makePixelGrid(picture.camera, picture.receivers);
    const TileSlices slices = tileSlices(picture.grid, 0, 0, 2, 8);
    EXPECT_EQ(slices.must, 0x80000001u | 1u << 10);
    EXPECT_EQ(slices.may, slices.must);
    // A range whose slices end at 4 m and at 8 m: rounding says which ones hold these.
    const TileSlices open = tileSlices(picture.grid, 0, 0, 2, 10);
    EXPECT_EQ(open.may & ~open.must, 3u << 7 | 3u << 23);
}

TEST(HierarchicalDepth, SliceCheckerFindsPlantedErrors) {
    const Picture picture;
    const float inf = std::numeric_limits<float>::infinity();
    const std::vector<float> ranges = {2, 8, inf, -inf, inf, -inf, 1, 1};
    const std::vector<std::uint32_t> right = {0x80000001u, 0, 0, 1};
    EXPECT_TRUE(checkTileSlices(picture.grid, ranges, right).ok())
        << checkTileSlices(picture.grid, ranges, right).text();
    for (const auto& [tile, slices] : {std::pair<std::size_t, std::uint32_t>{0, 1u},  // one lacks
                                       {0, 0x80000003u},                              // one too many
                                       {1, 4u},                                       // an empty tile with a slice
                                       {3, 0u}}) {
        std::vector<std::uint32_t> wrong = right;
        wrong[tile] = slices;
        EXPECT_EQ(checkTileSlices(picture.grid, ranges, wrong).errors, 1u) << tile;
    }
    EXPECT_FALSE(checkTileSlices(picture.grid, ranges, std::vector<std::uint32_t>{1}).ok());
}

}  // namespace
}  // namespace gnomon::reference
