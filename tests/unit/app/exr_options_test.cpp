// The command line of EXR files: what is refused, and what `compare` says.

#include <cmath>
#include <fstream>

#include "picture/exr.h"
#include "unit/app/program.h"

namespace gnomon::app {
namespace {

namespace fs = std::filesystem;

class ExrOptions : public Program {
protected:
    void write(const char* file, const char* channel, std::vector<float> values) const {
        renderer::ExrPicture picture{static_cast<std::uint32_t>(values.size()), 1, {}};
        picture.channels.push_back({channel, std::move(values), {}});
        renderer::writeExr(picture, folder_ / file);
    }
    // Refused, and these words are said.
    void expectSaid(const std::string& arguments, const std::string& words) const {
        const Outcome result = run(arguments);
        EXPECT_EQ(result.exitCode, 2) << arguments << "\n" << result.err;
        EXPECT_TRUE(isOneSentence(result.err)) << arguments << "\n" << result.err;
        EXPECT_EQ(result.out, "") << arguments;
        EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
    }
};

TEST_F(ExrOptions, WrongUsageIsRefused) {
    expectSaid("render --exr-type float", "--exr");
    expectSaid("render --exr a.exr --exr-type double", "--exr-type");
    expectSaid("render --exr a.hdr", "'a.hdr' is no name for an EXR file: it must end in .exr");
    for (const char* option : {"--depth-exr", "--normals-exr", "--visibility-exr"}) {
        const std::string render = std::string("render boxes ") + option;
        expectSaid(render + " ''", "give a file name");
        expectSaid(render + " a.png", "must end in .exr");
        expectSaid(render + " standard", "must end in .exr");
        expectSaid(render + " missing/a.exr", "folder");
        expectSaid(render + " a.exr --exr ./a.exr", "named for two outputs");
    }
    expectSaid("render boxes --depth-exr a.exr --normals-exr a.exr", "named for two outputs");
    expectSaid("render scene.exr --depth-exr scene.exr", "input");
    for (const char* shadows : {"inline", "off"})
        expectSaid(std::string("render boxes --visibility-exr a.exr --shadows ") + shadows, "--shadows deferred");
    expectSaid("render columns --lights 65 --quiet --size 16x16 --visibility-exr a.exr", "--light.");
    EXPECT_FALSE(fs::exists(folder_ / "a.exr"));
}

TEST_F(ExrOptions, CompareTellsExrsApart) {
    write("a.exr", "Z", {1.0f, 2.0f, 70000.0f});
    write("b.exr", "Z", {1.0f, 2.25f, 70000.0f});
    expectGood("compare a.exr a.exr");
    expectGood("compare a.exr b.exr --tolerance 0.25");
    EXPECT_EQ(run("compare a.exr b.exr --tolerance 0.2499").exitCode, 1);
    const Outcome outcome = run("compare a.exr b.exr --diff d.exr");
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_TRUE(isOneSentence(outcome.err)) << outcome.err;
    EXPECT_NE(outcome.out.find("Largest difference 0.25 in Z; largest of |a - b| / max(|a|, |b|) 0.111111; 1 pixels"),
              std::string::npos)
        << outcome.out;
    EXPECT_EQ(renderer::readExr(folder_ / "d.exr").channels.at(0).values, (std::vector<float>{0.0f, 0.25f, 0.0f}));
}

TEST_F(ExrOptions, CompareTellsWhatIsNoNumber) {
    const float nan = std::nanf(""), inf = INFINITY;
    write("a.exr", "Z", {nan, inf, 0.0f});
    write("nan.exr", "Z", {1.0f, inf, 0.0f});
    write("inf.exr", "Z", {nan, 1.0f, 0.0f});
    expectGood("compare a.exr a.exr");
    const Outcome outcome = run("compare a.exr nan.exr --tolerance 1e30");
    EXPECT_EQ(outcome.exitCode, 1) << outcome.out;
    EXPECT_NE(outcome.err.find("1 pixels are no number in one of them alone"), std::string::npos) << outcome.err;
    EXPECT_NE(run("compare a.exr inf.exr --tolerance 1e30").err.find("differ by inf"), std::string::npos);
}

TEST_F(ExrOptions, CompareRefusesWhatIsNotAlike) {
    write("a.exr", "Z", {1.0f, 2.0f});
    write("short.exr", "Z", {1.0f});
    write("other.exr", "Y", {1.0f, 2.0f});
    renderer::writePng({2, 1, {0, 0, 0, 9, 9, 9}}, folder_ / "a.png");
    std::ofstream(folder_ / "cut.exr", std::ios::binary) << std::string("\x76\x2f\x31\x01\x02\x00\x00\x00", 8);
    expectSaid("compare a.exr a.png", "different kinds");
    expectSaid("compare a.png a.exr", "different kinds");
    expectSaid("compare a.exr short.exr", "size");
    expectSaid("compare a.exr other.exr", "channels: Z and Y");
    expectSaid("compare a.exr cut.exr", "damaged");
    expectSaid("compare a.exr missing.exr", "does not exist");
    expectSaid("compare a.exr a.exr --diff d.png", "must end in .exr");
    expectSaid("compare a.png a.png --diff d.exr", "must end in .png");
    expectSaid("compare a.exr a.exr --diff ./a.exr", "input");
    for (const char* tolerance : {"nan", "inf", "-1", "0.1.2", "''"})
        expectSaid(std::string("compare a.exr a.exr --tolerance ") + tolerance, "--tolerance");
    for (const char* tolerance : {"256", "0.5", "-1"})
        expectSaid(std::string("compare a.png a.png --tolerance ") + tolerance, "from 0 to 255");
    expectGood("compare a.png a.png --tolerance 255");
}

}  // namespace
}  // namespace gnomon::app
