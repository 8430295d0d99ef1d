#include <fmt/format.h>
#include <tinyexr.h>

#include <algorithm>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "picture/exr.h"
#include "picture/exr_layout.h"
#include "picture/files.h"

namespace gnomon::renderer {
namespace {

// Every value as a float, uncompressed, and room for tables and notes.
constexpr std::uint64_t kMostExrBytes = sizeof(float) * kMostExrValues + (1u << 28);

/// tinyexr's header and image, and what they own.
class DecodedExr {
public:
    DecodedExr(std::span<const std::uint8_t> file, const ExrLayout& layout) {
        InitEXRHeader(&header_);
        InitEXRImage(&image_);
        EXRVersion version{};
        if (ParseEXRVersionFromMemory(&version, file.data(), file.size()) != TINYEXR_SUCCESS) fail();
        if (ParseEXRHeaderFromMemory(&header_, &version, file.data(), file.size(), &error_) != TINYEXR_SUCCESS) fail();
        if (!agreesWith(layout)) fail();
        for (int c = 0; c < header_.num_channels; ++c)
            if (header_.pixel_types[c] == TINYEXR_PIXELTYPE_HALF)
                header_.requested_pixel_types[c] = TINYEXR_PIXELTYPE_FLOAT;
        header_.line_order = 0;   // every block names its lines, and tinyexr would turn the picture over
        header_.chunk_count = 0;  // follows from the height
        // For what tinyexr takes and gives back where it fails on the way.
        image_.num_channels = header_.num_channels;
        if (LoadEXRImageFromMemory(&image_, &header_, file.data(), file.size(), &error_) != TINYEXR_SUCCESS) {
            InitEXRImage(&image_);  // it is given back already
            fail();
        }
    }
    ~DecodedExr() { release(); }
    DecodedExr(const DecodedExr&) = delete;
    DecodedExr& operator=(const DecodedExr&) = delete;

    /// Of this channel of the file, which is gone then.
    template <typename T>
    std::vector<T> take(std::size_t channel) {
        const std::size_t pixels = static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(image_.height);
        const T* values = reinterpret_cast<const T*>(image_.images[channel]);
        std::vector<T> out(values, values + pixels);
        std::free(std::exchange(image_.images[channel], nullptr));
        return out;
    }

private:
    [[nodiscard]] bool agreesWith(const ExrLayout& layout) const {
        const EXRBox2i& window = header_.data_window;
        return header_.num_channels == static_cast<int>(layout.channels.size()) &&
               header_.compression_type == layout.compression && header_.tiled == 0 &&
               header_.header_len + 8u == layout.chunkTable && window.min_x == layout.left &&
               window.min_y == layout.top && window.max_x - window.min_x + 1 == static_cast<int>(layout.width) &&
               window.max_y - window.min_y + 1 == static_cast<int>(layout.height);
    }
    void release() {
        FreeEXRImage(&image_);
        FreeEXRHeader(&header_);
        if (error_ != nullptr) FreeEXRErrorMessage(error_);
    }
    [[noreturn]] void fail() {
        release();
        throw std::runtime_error("is damaged or cut off");
    }

    EXRHeader header_{};
    EXRImage image_{};
    const char* error_ = nullptr;
};

ExrPicture decoded(std::span<const std::uint8_t> file) {
    const ExrLayout layout = checkedExrLayout(file);
    DecodedExr exr(file, layout);
    ExrPicture picture{layout.width, layout.height, {}, layout.left, layout.top};
    for (std::size_t c = 0; c < layout.channels.size(); ++c) {
        ExrChannel channel{layout.channels[c].name, {}, {}};
        if (layout.channels[c].type == TINYEXR_PIXELTYPE_UINT)
            channel.wholeValues = exr.take<std::uint32_t>(c);
        else
            channel.values = exr.take<float>(c);
        picture.channels.push_back(std::move(channel));
    }
    std::ranges::sort(picture.channels, {}, &ExrChannel::name);
    return picture;
}

}  // namespace

ExrPicture readExr(std::span<const std::uint8_t> bytes, const std::string& name) {
    try {
        return decoded(bytes);
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(fmt::format("'{}' {}.", name, error.what()));
    }
}

ExrPicture readExr(const std::filesystem::path& file) {
    return readExr(readWholeFile(file, kMostExrBytes), file.string());
}

}  // namespace gnomon::renderer
