// EXR files: what comes back, what is refused, and how far two pictures are apart.
#include "picture/exr.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "unit/picture/picture_files.h"
#include "unit/picture/raw_exr.h"

namespace gnomon::renderer {
namespace {

using ::testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

ExrPicture readBytes(const std::string& bytes) {
    return readExr({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, "a.exr");
}

std::string refusalOf(const std::string& bytes) {
    try {
        readBytes(bytes);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "read";
}

std::string bytesOfFile(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// Bit for bit, so that a NaN equals a NaN and -0 differs from 0.
std::vector<std::uint32_t> bitsOf(const std::vector<float>& values) {
    std::vector<std::uint32_t> bits;
    for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value));
    return bits;
}

ExrPicture oneChannel(std::vector<float> values) {
    ExrPicture picture{static_cast<std::uint32_t>(values.size()), 1, {}};
    picture.channels.push_back({"Z", std::move(values), {}});
    return picture;
}

// More rows than a block has, each value its own, and what is hard to store in the first pixels.
HdrPicture hardPicture(const std::vector<float>& first) {
    HdrPicture picture{19, 37, {}};
    for (std::uint32_t i = 0; i < 4 * picture.width * picture.height; ++i)
        picture.rgba.push_back(static_cast<float>(i % 2048) / 64.0f);
    std::copy(first.begin(), first.end(), picture.rgba.begin());
    return picture;
}

std::vector<float> backAsRgba(const ExrPicture& picture) {
    std::vector<float> rgba;
    for (std::size_t i = 0; i < std::size_t{picture.width} * picture.height; ++i)
        for (const std::size_t c : {3, 2, 1, 0}) rgba.push_back(picture.channels.at(c).values.at(i));
    return rgba;
}

TEST_F(PictureFiles, HalvesComeBackUpToTheirBrightest) {
    const HdrPicture picture = hardPicture({65504.0f, 65519.0f, 1.0e6f, kInf, -kInf, -1.0e6f, -0.0f, 6.0e-8f});
    writeExr(picture, folder_ / "a.exr");
    EXPECT_EQ(filesIn(folder_), 1u) << "a temporary file was left behind";
    const ExrPicture back = readExr(folder_ / "a.exr");
    EXPECT_EQ(back.width, 19u);
    EXPECT_EQ(back.height, 37u);
    ASSERT_EQ(back.channels.size(), 4u);
    for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(back.channels[c].name, std::string(1, "ABGR"[c]));
    std::vector<float> expected = picture.rgba;
    expected[1] = expected[2] = expected[3] = kBrightestHalf;
    expected[4] = expected[5] = -kBrightestHalf;
    expected[7] = std::ldexp(1.0f, -24);  // the least half
    EXPECT_EQ(bitsOf(backAsRgba(back)), bitsOf(expected));
    HdrPicture none = hardPicture({kNan});
    writeExr(none, folder_ / "a.exr", ExrType::Half);
    EXPECT_TRUE(std::isnan(readExr(folder_ / "a.exr").channels.at(3).values.at(0)));
}

TEST_F(PictureFiles, FloatsComeBackAsTheyWere) {
    const HdrPicture picture = hardPicture(
        {65536.0f, 1.0e6f, 3.4028235e38f, kInf, -kInf, kNan, -0.0f, 1.0e-40f, std::nextafter(1.0f, 2.0f), 16777217.0f});
    writeExr(picture, folder_ / "a.exr", ExrType::Float);
    EXPECT_EQ(bitsOf(backAsRgba(readExr(folder_ / "a.exr"))), bitsOf(picture.rgba));
}

TEST_F(PictureFiles, ChannelsHaveAnyNamesAndComeBackInOrder) {
    ExrPicture picture{3, 2, {}};
    for (const char* name : {"light2", "light10", "Z", "a.name.of.parts"})
        picture.channels.push_back({name, {0.5f, kInf, -1.0f, kNan, 1.0f / 3.0f, static_cast<float>(name[0])}, {}});
    writeExr(picture, folder_ / "a.exr");
    const ExrPicture back = readExr(folder_ / "a.exr");
    ASSERT_EQ(back.channels.size(), 4u);
    const std::size_t order[] = {2, 3, 1, 0};
    for (std::size_t c = 0; c < 4; ++c) {
        EXPECT_EQ(back.channels[c].name, picture.channels[order[c]].name);
        EXPECT_EQ(bitsOf(back.channels[c].values), bitsOf(picture.channels[order[c]].values));
    }
    EXPECT_THROW(writeExr(picture, folder_ / "missing" / "a.exr"), std::runtime_error);
}

TEST(Exr, FilesOfOthersAreRead) {
    RawExr raw;
    const std::vector<float> expected = {0, 1, 2, 3, 4, 5};
    EXPECT_EQ(readBytes(raw.bytes()).channels.at(0).values, expected);
    // Stored from the last line to the first: the picture is the same.
    raw.lineOrder = 1;
    raw.storedBackwards = true;
    raw.left = -7;
    raw.right = -6;
    raw.top = 100;
    raw.bottom = 102;
    const ExrPicture back = readBytes(raw.bytes());
    EXPECT_EQ(back.channels.at(0).values, expected);
    EXPECT_EQ(back.left, -7);
    EXPECT_EQ(back.top, 100);
    // Run lengths of differences: a zero, and seven times "no change", in each line.
    raw = {};
    raw.compression = 1;
    raw.blocks.assign(3, std::string("\0\0\x06\x80", 4));
    EXPECT_EQ(readBytes(raw.bytes()).channels.at(0).values, std::vector<float>(6, 0.0f));
    // Halves beside whole numbers that no float holds, and attributes that nobody knows.
    raw = {};
    raw.channels = {{"half", 1}, {"id", 0}};
    raw.bottom = 0;
    raw.blocks = {littleEndian(0x3C00, 2) + littleEndian(0x7C00, 2) + littleEndian(16777217, 4) +
                  littleEndian(0xFFFFFFFF, 4)};
    raw.more = RawExr::attribute("owner", "string", "") + RawExr::attribute("mine", "blob", "xyz") +
               RawExr::attribute("type", "string", "scanlineimage");
    const ExrPicture mixed = readBytes(raw.bytes());
    EXPECT_EQ(mixed.channels.at(0).values, (std::vector<float>{1.0f, kInf}));
    EXPECT_EQ(mixed.channels.at(1).wholeValues, (std::vector<std::uint32_t>{16777217, 0xFFFFFFFF}));
    EXPECT_EQ(mixed.channels.at(1).value(0), 16777217.0);
}

TEST(Exr, OtherKindsAreRefusedByName) {
    const auto refusal = [&](const std::function<void(RawExr&)>& change) {
        RawExr raw;
        change(raw);
        const std::string said = refusalOf(raw.bytes());
        EXPECT_TRUE(said == "read" || (said.ends_with(".") && said.find(". ") == std::string::npos)) << said;
        return said;
    };
    EXPECT_EQ(refusal([](RawExr&) {}), "read");
    EXPECT_THAT(refusal([](RawExr& r) { r.version = 2 | 0x200; }), HasSubstr("tiles"));
    EXPECT_THAT(refusal([](RawExr& r) { r.version = 2 | 0x800; }), HasSubstr("deep"));
    EXPECT_THAT(refusal([](RawExr& r) { r.version = 2 | 0x1000; }), HasSubstr("parts"));
    EXPECT_THAT(refusal([](RawExr& r) { r.version = 3; }), HasSubstr("version"));
    EXPECT_THAT(refusal([](RawExr& r) { r.compression = 4; }), HasSubstr("ZIP"));
    EXPECT_THAT(refusal([](RawExr& r) { r.compression = 200; }), HasSubstr("ZIP"));
    EXPECT_THAT(refusal([](RawExr& r) { r.sampling = 2; }), HasSubstr("fewer pixels"));
    EXPECT_THAT(refusal([](RawExr& r) { r.right = 100'000'000; }), HasSubstr("too large"));
    EXPECT_THAT(refusal([](RawExr& r) { r.right = r.bottom = 1'000'000; }), HasSubstr("too large"));
    EXPECT_THAT(refusal([](RawExr& r) { r.more = RawExr::attribute("type", "string", "deeptile"); }),
                HasSubstr("scan lines"));
}

TEST_F(PictureFiles, DamagedExrIsRefused) {
    const auto isDamaged = [&](const std::function<void(RawExr&)>& change) {
        RawExr raw;
        change(raw);
        EXPECT_THAT(refusalOf(raw.bytes()), HasSubstr("damaged or cut off"));
    };
    isDamaged([](RawExr& r) { r.version = 2 | 0x2000; });
    isDamaged([](RawExr& r) { r.channels.clear(); });
    isDamaged([](RawExr& r) { r.channels.push_back(r.channels[0]); });
    isDamaged([](RawExr& r) { r.channels[0].second = 3; });
    isDamaged([](RawExr& r) { r.channels[0].first = std::string(256, 'x'); });
    isDamaged([](RawExr& r) { r.bottom = -1; });
    isDamaged([](RawExr& r) { r.right = r.bottom = 30'000; });  // four gigabytes in a few hundred bytes
    isDamaged([](RawExr& r) { r.lines = {0, 1, 1}; });          // a line twice, and one nowhere
    isDamaged([](RawExr& r) { r.lines = {0, 2, 1}; });
    isDamaged([](RawExr& r) { r.blocks = {"12345678", "1234567", "12345678"}; });
    isDamaged([](RawExr& r) { r.blocks = {"12345678", "123456789", "12345678"}; });
    isDamaged([](RawExr& r) { r.blocks = {"12345678", "", "12345678"}; });
    isDamaged([](RawExr& r) { r.more = RawExr::attribute("dataWindow", "box2i", std::string(16, '\0')); });
    isDamaged([](RawExr& r) { r.more = RawExr::attribute("nothing", "int", ""); });
    isDamaged([](RawExr& r) {
        for (int i = 0; i < 1100; ++i) r.more += RawExr::attribute("a" + std::to_string(i), "int", "1234");
    });
    // No compression makes a block of so many pixels so short.
    for (const std::uint8_t compression : {1, 2, 3})
        isDamaged([&](RawExr& r) {
            r.compression = compression;
            r.right = 999'999;
            r.blocks = {"12345678", "12345678", "12345678"};
        });
    // Compressed blocks that unpack to nothing sensible.
    for (const std::uint8_t compression : {1, 2, 3})
        isDamaged([&](RawExr& r) {
            r.compression = compression;
            r.blocks = {"1234567", "\xFF\xFF\xFF", "\x7F\x7F"};
            if (compression == 3) r.blocks.resize(1);
        });
    EXPECT_EQ(refusalOf("no picture"), "'a.exr' is no EXR picture that can be read.");
    EXPECT_THROW(readExr(folder_ / "missing.exr"), std::runtime_error);
    EXPECT_THROW(readExr(folder_), std::runtime_error);
}

// Wherever a file ends, it is cut off; whatever byte is wrong, it is read or refused.
TEST_F(PictureFiles, NoDamageToExrIsMoreThanRefused) {
    HdrPicture small = hardPicture({kInf, kNan});
    small.height = 17;  // two blocks
    small.rgba.resize(4 * small.width * small.height);
    writeExr(small, folder_ / "zip.exr");
    std::size_t refused = 0;
    for (const std::string& whole : {RawExr().bytes(), bytesOfFile(folder_ / "zip.exr")}) {
        for (std::size_t length = 0; length < whole.size(); ++length) {
            ASSERT_NE(refusalOf(whole.substr(0, length)), "read") << length;
        }
        for (std::size_t i = 0; i < whole.size(); ++i)
            for (const int flip : {0x01, 0x80, 0xFF}) {
                std::string spoilt = whole;
                spoilt[i] = static_cast<char>(spoilt[i] ^ flip);
                refused += refusalOf(spoilt) != "read" ? 1 : 0;
            }
    }
    EXPECT_GT(refused, 1000u);
}

TEST(CompareExr, TellsHowFarApart) {
    const ExrPicture a = oneChannel({0.0f, 1.0f, 2.0f, -3.0f, 1.0e6f});
    ExrComparison same = compare(a, a);
    EXPECT_EQ(same.all.largest, 0.0);
    EXPECT_EQ(same.all.pixels, 0u);
    EXPECT_EQ(same.all.channel, "");
    ExrPicture b = a;
    b.channels[0].values = {0.0f, 1.5f, 2.0f, 3.0f, 1.0e6f + 0.5f};
    const ExrComparison different = compare(a, b);
    EXPECT_EQ(different.all.largest, 6.0);
    EXPECT_EQ(different.all.channel, "Z");
    EXPECT_EQ(different.all.largestRelative, 2.0);  // of opposite signs
    EXPECT_EQ(different.all.pixels, 3u);
    b.channels[0].values[3] = -3.0f;
    EXPECT_DOUBLE_EQ(compare(a, b).all.largestRelative, 0.5 / 1.5);
    EXPECT_EQ(differencePicture(a, b).channels.at(0).values, (std::vector<float>{0.0f, 0.5f, 0.0f, 0.0f, 0.5f}));
}

TEST(CompareExr, TakesWhatIsNoNumber) {
    const ExrPicture a = oneChannel({kNan, kInf, -kInf, kNan, kInf, kInf, 0.0f});
    EXPECT_EQ(compare(a, a).all.pixels, 0u) << "equal infinities and NaNs are equal";
    ExrPicture b = a;
    b.channels[0].values[3] = 1.0f;
    const ExrComparison nan = compare(a, b);
    EXPECT_EQ(nan.all.notNumbers, 1u);
    EXPECT_EQ(nan.all.pixels, 1u);
    EXPECT_EQ(nan.all.largest, 0.0);
    b = a;
    b.channels[0].values[4] = -kInf;
    EXPECT_EQ(compare(a, b).all.largest, kInf);
    b = a;
    b.channels[0].values[5] = 7.0f;
    EXPECT_EQ(compare(a, b).all.largest, kInf);
    EXPECT_EQ(compare(a, b).all.largestRelative, kInf);
    EXPECT_EQ(compare(a, b).all.notNumbers, 0u);
    b.channels[0].values[3] = 1.0f;
    const std::vector<float> apart = differencePicture(a, b).channels.at(0).values;
    EXPECT_EQ(apart[0], 0.0f);
    EXPECT_EQ(apart[1], 0.0f);
    EXPECT_TRUE(std::isnan(apart[3]));
    EXPECT_EQ(apart[5], kInf);
}

TEST(CompareExr, GoesByChannelsAndCountsPixelsOnce) {
    ExrPicture a{2, 1, {}};
    a.channels.push_back({"G", {1.0f, 2.0f}, {}});
    a.channels.push_back({"id", {}, {16777216, 5}});
    ExrPicture b = a;
    b.channels[0].values[0] = 1.25f;
    b.channels[1].wholeValues[0] = 16777217;  // no float tells these apart
    const ExrComparison comparison = compare(a, b);
    ASSERT_EQ(comparison.channels.size(), 2u);
    EXPECT_EQ(comparison.channels[0].largest, 0.25);
    EXPECT_EQ(comparison.channels[1].largest, 1.0);
    EXPECT_EQ(comparison.all.channel, "id");
    EXPECT_EQ(comparison.all.pixels, 1u);
}

TEST(CompareExr, RefusesWhatIsNotAlike) {
    const ExrPicture a = oneChannel({1.0f, 2.0f});
    const auto refusal = [&](const ExrPicture& b) {
        try {
            compare(a, b);
        } catch (const std::invalid_argument& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_THAT(refusal(oneChannel({1.0f})), HasSubstr("size"));
    ExrPicture b = a;
    b.channels[0].name = "Y";
    EXPECT_THAT(refusal(b), HasSubstr("Z and Y"));
    b = a;
    b.top = 1;
    EXPECT_THAT(refusal(b), HasSubstr("place"));
    EXPECT_THROW(differencePicture(a, b), std::invalid_argument);
}

}  // namespace
}  // namespace gnomon::renderer
