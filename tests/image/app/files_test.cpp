// What the program writes of a frame beside its picture.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "picture/exr.h"
#include "unit/app/program.h"

namespace gnomon::app {
namespace {

using renderer::ExrPicture;

class FrameFiles : public Program {
protected:
    // Empty for a file that cannot be read, or has other channels.
    ExrPicture readChannels(const char* file, const std::vector<std::string>& names) const {
        const ExrPicture picture = renderer::readExr(folder_ / file);
        std::vector<std::string> found;
        for (const renderer::ExrChannel& channel : picture.channels) found.push_back(channel.name);
        EXPECT_EQ(found, names) << file;
        return found == names ? picture : ExrPicture{};
    }
};

// A square of 2 m in the plane z = 0, as seen from the front, 2 m under a lamp of so many candela.
std::string litSquare(float candela) {
    const float corners[18] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, -1, 0, 1, 1, 0, -1, 1, 0};
    return R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],"scenes":[{"nodes":[0,1]}],)"
           R"("nodes":[{"mesh":0},{"translation":[0,0,2],"extensions":{"KHR_lights_punctual":{"light":0}}}],)"
           R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":)" +
           std::to_string(candela) +
           R"(}]}},"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],)"
           R"("materials":[{"pbrMetallicRoughness":{"metallicFactor":0}}],)"
           R"("accessors":[{"bufferView":0,"componentType":5126,"count":6,"type":"VEC3"}],)"
           R"("bufferViews":[{"buffer":0,"byteLength":72}],"buffers":[{"byteLength":72,"uri":")" +
           dataUri(corners) + R"("}]})";
}

// One light in a closed room without ambient light: what it does not reach is black.
TEST_F(FrameFiles, AgreeWithThePicture) {
    expectGood(
        "render boxes --size 90x50 --filter hard --light 1 --light 1 --ambient off --exr p.exr --depth-exr d.exr "
        "--normals-exr n.exr --visibility-exr v.exr");
    const std::string said = run("compare v.exr v.exr").out;
    EXPECT_NE(said.find("light1"), std::string::npos) << said;
    const ExrPicture picture = readChannels("p.exr", {"A", "B", "G", "R"}), depth = readChannels("d.exr", {"Z"});
    const ExrPicture normals = readChannels("n.exr", {"X", "Y", "Z"}), visibility = readChannels("v.exr", {"light1"});
    std::size_t dark = 0, lit = 0, beyond = 0;
    for (std::size_t i = 0; i < visibility.channels.at(0).values.size(); ++i) {
        const float v = visibility.channels[0].values[i], blue = picture.channels.at(1).values[i];
        EXPECT_TRUE(v == -1.0f || (v >= 0.0f && v <= 1.0f)) << v;
        if (v <= 0.0f) {
            EXPECT_EQ(blue, 0.0f) << i;
        }
        ++(v < 0.0f ? beyond : v == 0.0f ? dark : lit);
        if (v > 0.5f) {
            EXPECT_GT(blue, 0.0f) << i;
        }
        const float z = depth.channels.at(0).values[i];
        EXPECT_GT(z, 0.005f);
        EXPECT_LT(z, 6.0f) << "the room is closed";
        double squared = 0.0;
        for (const renderer::ExrChannel& axis : normals.channels) squared += std::pow(axis.value(i), 2.0);
        EXPECT_NEAR(squared, 1.0, 1e-5) << i;
    }
    EXPECT_GT(dark, 300u);
    EXPECT_GT(lit, 1000u);
}

// In halves and in floats; and what stands beside the picture where there is a surface, and where there is none.
TEST_F(FrameFiles, BrightPicturesAreWholeInFloats) {
    std::ofstream(folder_ / "bright.gltf") << litSquare(1.0e7f);
    const std::string render = "render bright.gltf --size 64x36 --camera 0,0,3:0,0,0 --filter hard --exr ";
    const Outcome halves = run(render +
                               "half.exr --stats half.json -o p.png --depth-exr d.exr --normals-exr n.exr "
                               "--visibility-exr v.exr");
    EXPECT_EQ(halves.exitCode, 0) << halves.err;
    for (const char* file : {"p.png", "half.exr", "d.exr", "n.exr", "v.exr"})
        EXPECT_NE(halves.out.find(std::string("Written: ") + file + "\n"), std::string::npos) << halves.out;
    EXPECT_NE(halves.out.find("are clipped (--exr FILE --exr-type float keeps them)."), std::string::npos)
        << halves.out;
    const Outcome floats = run(render + "float.exr --exr-type float --stats float.json");
    EXPECT_EQ(floats.exitCode, 0) << floats.err;
    EXPECT_EQ(floats.out.find("clipped"), std::string::npos) << floats.out;
    EXPECT_GT(readJson("half.json")["clippedPixels"], 100);
    EXPECT_EQ(readJson("float.json")["clippedPixels"], 0);
    const ExrPicture half = readChannels("half.exr", {"A", "B", "G", "R"});
    const ExrPicture whole = readChannels("float.exr", {"A", "B", "G", "R"});
    const auto brightest = [](const ExrPicture& picture) {
        return *std::ranges::max_element(picture.channels.at(3).values);
    };
    EXPECT_EQ(brightest(half), renderer::kBrightestHalf);
    // 2.5 million lux on a white surface, which also mirrors a little.
    EXPECT_NEAR(brightest(whole), 2.5e6f / 3.14159f, 1e5f);
    EXPECT_EQ(run("compare half.exr float.exr --diff apart.exr").exitCode, 1);
    EXPECT_EQ(brightest(renderer::readExr(folder_ / "apart.exr")), brightest(whole) - brightest(half));

    const ExrPicture depth = readChannels("d.exr", {"Z"}), normals = readChannels("n.exr", {"X", "Y", "Z"});
    const ExrPicture visibility = readChannels("v.exr", {"light0"});
    const std::size_t middle = 18 * 64 + 32;
    EXPECT_NEAR(depth.channels.at(0).values.at(middle), 3.0f, 1e-4f);
    EXPECT_NEAR(normals.channels.at(2).values.at(middle), 1.0f, 1e-4f);
    EXPECT_EQ(visibility.channels.at(0).values.at(middle), 1.0f);
    EXPECT_EQ(depth.channels[0].values[0], std::numeric_limits<float>::infinity());
    for (const renderer::ExrChannel& axis : normals.channels) EXPECT_EQ(axis.values[0], 0.0f);
    EXPECT_EQ(visibility.channels[0].values[0], -1.0f);
}

}  // namespace
}  // namespace gnomon::app
