#include "picture/picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "unit/picture/picture_files.h"

namespace gnomon::renderer {
namespace {

namespace fs = std::filesystem;

Picture gradient(std::uint32_t width, std::uint32_t height) {
    Picture picture{width, height, {}};
    for (std::uint32_t i = 0; i < 3 * width * height; ++i)
        picture.rgb.push_back(static_cast<std::uint8_t>((i * 2654435761u) >> 24));
    return picture;
}

HdrPicture grey(std::uint32_t width, float value) {
    return {width, 1, std::vector<float>(std::size_t{4} * width, value)};
}

TEST(AutomaticExposure, MakesAGreyPictureMiddleGrey) {
    // Exposed luminance L / (1.2 * 2^EV) is 0.18, whatever L is.
    for (const float level : {0.001f, 0.216f, 1.0f, 5000.0f})
        EXPECT_NEAR(level / (1.2f * std::exp2(automaticExposure(grey(7, level)))), 0.18f, 1e-5f) << level;
    EXPECT_NEAR(automaticExposure(grey(1, 0.216f)), 0.0f, 1e-5f);
}

TEST(AutomaticExposure, IsTheGeometricMean) {
    HdrPicture picture = grey(2, 0.25f);
    picture.rgba[4] = picture.rgba[5] = picture.rgba[6] = 4.0f;
    EXPECT_NEAR(automaticExposure(picture), automaticExposure(grey(1, 1.0f)), 1e-5f);
}

TEST(AutomaticExposure, LeavesOutBlackNonFiniteAndBackgroundPixels) {
    HdrPicture picture = grey(5, 2.0f);
    picture.rgba[16] = 1000.0f;
    picture.rgba[19] = 0.0f;  // no geometry
    picture.rgba[0] = picture.rgba[1] = picture.rgba[2] = 0.0f;
    picture.rgba[4] = std::numeric_limits<float>::quiet_NaN();
    picture.rgba[8] = std::numeric_limits<float>::infinity();
    EXPECT_FLOAT_EQ(automaticExposure(picture), automaticExposure(grey(1, 2.0f)));
    EXPECT_EQ(automaticExposure(grey(3, 0.0f)), 0.0f);
}

TEST(ToneMap, GrowsWithTheInputAndReachesWhite) {
    constexpr int kSteps = 4000;
    int last = 0;
    for (int i = 0; i <= kSteps; ++i) {
        const float level = 1.2f * 5.0f * static_cast<float>(i) / kSteps;
        const int value = toneMap(grey(1, level), 0.0f).rgb[0];
        EXPECT_GE(value, last) << level;
        last = value;
    }
    EXPECT_EQ(toneMap(grey(1, 0.0f), 0.0f).rgb[0], 0);
    EXPECT_EQ(toneMap(grey(1, 1.2f * 4.0f), 0.0f).rgb[0], 255);  // the white point, 4 after exposure
}

TEST(ToneMap, OneStopHalves) {
    EXPECT_EQ(toneMap(grey(1, 0.5f), 3.0f).rgb, toneMap(grey(1, 1.0f), 4.0f).rgb);
}

TEST(ToneMap, TakesWhatIsNoColour) {
    HdrPicture picture = grey(3, std::numeric_limits<float>::quiet_NaN());
    picture.rgba[4] = picture.rgba[5] = picture.rgba[6] = std::numeric_limits<float>::infinity();
    picture.rgba[8] = picture.rgba[9] = picture.rgba[10] = -1.0f;
    const Picture out = toneMap(picture, -20.0f);
    EXPECT_EQ(out.rgb, (std::vector<std::uint8_t>{0, 0, 0, 255, 255, 255, 0, 0, 0}));
}

TEST(ClippedPixels, AreAsBrightAsThePictureHolds) {
    HdrPicture picture = grey(3, 1000.0f);
    picture.rgba[5] = kBrightestHalf;
    picture.rgba[8] = std::nextafter(kBrightestHalf, 0.0f);
    EXPECT_EQ(clippedPixels(picture), 1u);
    picture.brightest = std::numeric_limits<float>::max();
    EXPECT_EQ(clippedPixels(picture), 0u);
    picture.rgba[0] = picture.brightest;
    EXPECT_EQ(clippedPixels(picture), 1u);
}

TEST(Hash, IsStableAndTellsPicturesApart) {
    const Picture picture = gradient(6, 4);
    EXPECT_EQ(hashOf(picture), hashOf(gradient(6, 4)));
    EXPECT_EQ(hashOf(picture).size(), 16u);
    EXPECT_EQ(hashOf(picture).find_first_not_of("0123456789abcdef"), std::string::npos);
    Picture changed = picture;
    changed.rgb[5] ^= 1;
    EXPECT_NE(hashOf(picture), hashOf(changed));
    Picture reshaped = picture;
    std::swap(reshaped.width, reshaped.height);
    EXPECT_NE(hashOf(picture), hashOf(reshaped));
}

TEST(Compare, CountsPixelsAndTheLargestDifference) {
    const Picture a = gradient(5, 3);
    EXPECT_EQ(compare(a, a).largest, 0u);
    EXPECT_EQ(compare(a, a).pixels, 0u);
    Picture b = a;
    b.rgb[0] = static_cast<std::uint8_t>(a.rgb[0] < 128 ? a.rgb[0] + 9 : a.rgb[0] - 9);
    b.rgb[1] = static_cast<std::uint8_t>(a.rgb[1] < 128 ? a.rgb[1] + 1 : a.rgb[1] - 1);
    b.rgb[14] = static_cast<std::uint8_t>(a.rgb[14] < 128 ? a.rgb[14] + 5 : a.rgb[14] - 5);
    const Difference difference = compare(a, b);
    EXPECT_EQ(difference.largest, 9u);
    EXPECT_EQ(difference.pixels, 2u);
    EXPECT_DOUBLE_EQ(difference.meanAbsolute, 15.0 / 45.0);
    const Picture shown = differencePicture(a, b);
    EXPECT_GT(shown.rgb[0], shown.rgb[12]);  // the larger difference is the brighter red
    EXPECT_EQ(shown.rgb[1], 0);
    EXPECT_EQ(shown.rgb[3], shown.rgb[4]);  // equal: grey
}

TEST(Compare, RefusesDifferentSizes) {
    EXPECT_THROW(compare(gradient(4, 4), gradient(4, 5)), std::invalid_argument);
    EXPECT_THROW(differencePicture(gradient(4, 4), gradient(8, 2)), std::invalid_argument);
}

TEST_F(PictureFiles, PngComesBackAsItWas) {
    const Picture picture = gradient(37, 11);
    writePng(picture, folder_ / "a.png");
    const Picture back = readPng(folder_ / "a.png");
    EXPECT_EQ(back.width, 37u);
    EXPECT_EQ(back.height, 11u);
    EXPECT_EQ(back.rgb, picture.rgb);
    writePng(gradient(3, 3), folder_ / "a.png");
    EXPECT_EQ(readPng(folder_ / "a.png").width, 3u);
    EXPECT_EQ(filesIn(folder_), 1u) << "a temporary file was left behind";
}

TEST_F(PictureFiles, UnwritablePlacesAreFoundBeforehand) {
    EXPECT_NO_THROW(checkWritable(folder_ / "new.png"));
    EXPECT_EQ(filesIn(folder_), 0u);
    EXPECT_NO_THROW(checkWritable("a_new_name_without_folder.png"));
    EXPECT_THROW(checkWritable(folder_ / "missing" / "new.png"), std::runtime_error);
    EXPECT_THROW(checkWritable(folder_), std::runtime_error);
    EXPECT_THROW(checkWritable(""), std::runtime_error);
    EXPECT_THROW(writePng(gradient(2, 2), folder_ / "missing" / "new.png"), std::runtime_error);
    std::ofstream(folder_ / "file").put('x');
    EXPECT_THROW(checkWritable(folder_ / "file" / "new.png"), std::runtime_error);
}

TEST_F(PictureFiles, LinksAreFollowedAndOldFilesKept) {
    std::ofstream(folder_ / "old.png") << "old";
    fs::create_symlink(folder_ / "old.png", folder_ / "link.png");
    checkWritable(folder_ / "link.png");
    EXPECT_EQ(fs::file_size(folder_ / "old.png"), 3u);
    writePng(gradient(2, 2), folder_ / "link.png");
    EXPECT_TRUE(fs::is_symlink(folder_ / "link.png"));
    EXPECT_EQ(readPng(folder_ / "old.png").width, 2u);
}

TEST_F(PictureFiles, WhatIsNoPngIsRefused) {
    std::ofstream(folder_ / "text.png") << "no picture";
    EXPECT_THROW(readPng(folder_ / "text.png"), std::runtime_error);
    EXPECT_THROW(readPng(folder_ / "missing.png"), std::runtime_error);
    EXPECT_THROW(readPng(folder_), std::runtime_error);
    writePng(gradient(64, 64), folder_ / "whole.png");
    fs::resize_file(folder_ / "whole.png", fs::file_size(folder_ / "whole.png") / 2);
    EXPECT_THROW(readPng(folder_ / "whole.png"), std::runtime_error);
}

}  // namespace
}  // namespace gnomon::renderer
