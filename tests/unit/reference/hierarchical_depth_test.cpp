// Tile depths of a hand-made picture, and planted errors.
#include <gtest/gtest.h>

#include "reference/hierarchical_depth.h"
#include "reference/test_scene.h"

namespace gnomon::reference {
namespace {

// 12 x 9: two tiles across, two down, the last ones ragged.
struct Picture {
    CameraModel camera;
    PixelGrid grid;
    Picture() {
        CameraSetup setup;
        setup.nearMetres = 0.5;
        camera = makeCameraModel(makeCamera(setup, 12, 9), 12, 9);
        Receivers receivers;
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

}  // namespace
}  // namespace gnomon::reference
