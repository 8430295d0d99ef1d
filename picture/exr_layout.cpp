#include "picture/exr_layout.h"

#include <fmt/format.h>
#include <tinyexr.h>

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>
#include <string_view>

#include "picture/exr.h"

namespace gnomon::renderer {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic = {0x76, 0x2f, 0x31, 0x01};
constexpr std::uint32_t kVersion = 2;
// Bits of the version field.
constexpr std::uint32_t kTiles = 0x200, kLongNames = 0x400, kDeep = 0x800, kParts = 0x1000;
constexpr std::size_t kMostAttributes = 1000, kMostNameBytes = 255;
constexpr std::int64_t kFarthestPixel = 1 << 20;
// Deflate shortens 1032 bytes to one at best, run lengths 64.
constexpr std::uint64_t kMostShortening = 1032;

[[noreturn]] void refuse(const std::string& why) {
    throw std::runtime_error(why);
}

[[noreturn]] void refuseDamaged() {
    refuse("is damaged or cut off");
}

/// Numbers and texts one after the other, little endian.
class ExrBytes {
public:
    explicit ExrBytes(std::span<const std::uint8_t> bytes, std::size_t at = 0) : bytes_(bytes), at_(at) {
        if (at > bytes.size()) refuseDamaged();
    }
    std::span<const std::uint8_t> take(std::size_t count) {
        if (count > bytes_.size() - at_) refuseDamaged();
        at_ += count;
        return bytes_.subspan(at_ - count, count);
    }
    template <typename T>
    T number() {
        T value = 0;
        const std::span<const std::uint8_t> bytes = take(sizeof(T));
        for (std::size_t i = 0; i < sizeof(T); ++i) value = static_cast<T>(value | T{bytes[i]} << (8 * i));
        return value;
    }
    std::int32_t whole() { return static_cast<std::int32_t>(number<std::uint32_t>()); }
    /// Up to a zero.
    std::string text() {
        const auto rest = bytes_.subspan(at_);
        const auto end = std::ranges::find(rest, std::uint8_t{0});
        if (end == rest.end() || end - rest.begin() > static_cast<std::ptrdiff_t>(kMostNameBytes)) refuseDamaged();
        std::string out(rest.begin(), end);
        at_ += out.size() + 1;
        return out;
    }
    [[nodiscard]] std::size_t position() const { return at_; }

private:
    std::span<const std::uint8_t> bytes_;
    std::size_t at_;
};

void checkVersion(std::uint32_t version) {
    if ((version & 0xFFu) != kVersion) refuse("is of a version of EXR that is not known");
    if ((version & kParts) != 0) refuse("has several parts, and only single pictures of scan lines are read");
    if ((version & kDeep) != 0) refuse("has deep samples, and only single pictures of scan lines are read");
    if ((version & kTiles) != 0) refuse("has tiles, and only single pictures of scan lines are read");
    if ((version & ~(0xFFu | kLongNames)) != 0) refuseDamaged();
}

std::vector<ExrLayout::Channel> channelsIn(std::span<const std::uint8_t> value) {
    std::vector<ExrLayout::Channel> channels;
    std::set<std::string> names;
    ExrBytes bytes(value);
    for (std::string name = bytes.text(); !name.empty(); name = bytes.text()) {
        if (!names.insert(name).second) refuseDamaged();
        const std::int32_t type = bytes.whole();
        if (type < TINYEXR_PIXELTYPE_UINT || type > TINYEXR_PIXELTYPE_FLOAT) refuseDamaged();
        bytes.take(4);  // how to weigh it, and reserved
        const std::int32_t everyX = bytes.whole(), everyY = bytes.whole();
        if (everyX != 1 || everyY != 1) refuse("has channels of fewer pixels than the picture has");
        channels.push_back({std::move(name), type});
    }
    if (channels.empty() || bytes.position() != value.size()) refuseDamaged();
    return channels;
}

void takeWindow(std::span<const std::uint8_t> value, ExrLayout& layout) {
    ExrBytes bytes(value);
    std::array<std::int64_t, 4> window{};  // left, top, right, bottom; the last two included
    for (std::int64_t& side : window) side = bytes.whole();
    if (bytes.position() != value.size() || window[2] < window[0] || window[3] < window[1]) refuseDamaged();
    for (const std::int64_t side : window)
        if (side < -kFarthestPixel || side > kFarthestPixel) refuse("is too large to be read");
    layout.left = static_cast<std::int32_t>(window[0]);
    layout.top = static_cast<std::int32_t>(window[1]);
    layout.width = static_cast<std::uint32_t>(window[2] - window[0] + 1);
    layout.height = static_cast<std::uint32_t>(window[3] - window[1] + 1);
}

std::uint8_t compressionIn(std::span<const std::uint8_t> value) {
    if (value.size() != 1) refuseDamaged();
    if (value[0] > TINYEXR_COMPRESSIONTYPE_ZIP)
        refuse("is compressed in a way that is not read: save it uncompressed, or as RLE, ZIPS or ZIP");
    return value[0];
}

/// All attributes up to the empty name that ends them, those with a meaning here at most once.
ExrLayout headerOf(ExrBytes& bytes) {
    ExrLayout layout;
    std::set<std::string> seen;
    for (std::size_t count = 0;; ++count) {
        const std::string name = bytes.text();
        if (name.empty()) break;
        const std::string type = bytes.text();
        const std::span<const std::uint8_t> value = bytes.take(bytes.number<std::uint32_t>());
        if (count == kMostAttributes || !seen.insert(name).second) refuseDamaged();
        if (value.empty() && type != "string") refuseDamaged();
        if (name == "channels") layout.channels = channelsIn(value);
        if (name == "dataWindow") takeWindow(value, layout);
        if (name == "compression") layout.compression = compressionIn(value);
        if (name == "type" && !std::ranges::equal(value, std::string_view("scanlineimage")))
            refuse("is no single picture of scan lines");
    }
    for (const char* needed : {"channels", "dataWindow", "compression", "displayWindow", "lineOrder",
                               "pixelAspectRatio", "screenWindowCenter", "screenWindowWidth"})
        if (!seen.contains(needed)) refuseDamaged();
    layout.chunkTable = bytes.position();
    return layout;
}

std::uint64_t bytesPerPixel(const ExrLayout& layout) {
    std::uint64_t bytes = 0;
    for (const ExrLayout::Channel& channel : layout.channels) bytes += channel.type == TINYEXR_PIXELTYPE_HALF ? 2 : 4;
    return bytes;
}

void checkChunks(std::span<const std::uint8_t> file, const ExrLayout& layout) {
    const std::uint32_t lines = layout.compression == TINYEXR_COMPRESSIONTYPE_ZIP ? 16 : 1;
    const std::uint64_t lineBytes = bytesPerPixel(layout) * layout.width;
    ExrBytes table(file, layout.chunkTable);
    for (std::uint32_t y = 0; y < layout.height; y += lines) {
        const auto offset = table.number<std::uint64_t>();
        if (offset < layout.chunkTable || offset > file.size()) refuseDamaged();
        ExrBytes chunk(file, offset);
        if (chunk.whole() != layout.top + static_cast<std::int64_t>(y)) refuseDamaged();
        const auto bytes = chunk.number<std::uint32_t>();
        chunk.take(bytes);
        const std::uint64_t whole = lineBytes * std::min(lines, layout.height - y);
        const bool uncompressed = layout.compression == TINYEXR_COMPRESSIONTYPE_NONE;
        if (bytes > whole || bytes < (uncompressed ? whole : whole / kMostShortening) || bytes == 0) refuseDamaged();
    }
}

}  // namespace

ExrLayout checkedExrLayout(std::span<const std::uint8_t> file) {
    if (file.size() < kMagic.size() || !std::equal(kMagic.begin(), kMagic.end(), file.begin()))
        refuse("is no EXR picture that can be read");
    ExrBytes bytes(file, kMagic.size());
    checkVersion(bytes.number<std::uint32_t>());
    const ExrLayout layout = headerOf(bytes);
    const std::uint64_t pixels = std::uint64_t{layout.width} * layout.height;
    if (pixels > kMostExrValues / layout.channels.size()) refuse("is too large to be read");
    checkChunks(file, layout);
    return layout;
}

}  // namespace gnomon::renderer
