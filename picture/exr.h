#pragma once
// EXR files in and out, and their comparison: any channels, of halves, floats or whole numbers.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "picture/picture.h"

namespace gnomon::renderer {

/// Pixels times channels of a file that readExr() takes: the largest picture of the renderer in RGBA.
inline constexpr std::uint64_t kMostExrValues = std::uint64_t{1} << 30;

struct ExrChannel {
    std::string name;
    std::vector<float> values;               ///< rows from the top
    std::vector<std::uint32_t> wholeValues;  ///< in their place, for a channel of 32-bit whole numbers

    [[nodiscard]] double value(std::size_t pixel) const {
        return wholeValues.empty() ? static_cast<double>(values[pixel]) : static_cast<double>(wholeValues[pixel]);
    }
};

struct ExrPicture {
    std::uint32_t width = 0, height = 0;
    std::vector<ExrChannel> channels;  ///< in ascending order of their names
    std::int32_t left = 0, top = 0;    ///< where the pixels lie on the picture's plane (the file's data window)
};

enum class ExrType : std::uint8_t { Half, Float };

/// Both throw std::runtime_error with one sentence where the file cannot be written. An existing file is replaced at
/// once. Half: what is beyond 65504 becomes 65504. Float: all as it is.
void writeExr(const HdrPicture& picture, const std::filesystem::path& file, ExrType type = ExrType::Half);
/// 32-bit floats, the channels in any order. `wholeValues`, `left` and `top` are not written.
void writeExr(const ExrPicture& picture, const std::filesystem::path& file);

/// Single pictures of scan lines, uncompressed or as RLE, ZIPS or ZIP. Throws std::runtime_error with one sentence for
/// whatever else: tiles, several parts, deep samples, damage, more than kMostExrValues. Memory is taken for what the
/// file's length can hold, not for what its header says.
ExrPicture readExr(const std::filesystem::path& file);
/// The same of the bytes of a file, which sentences call `name`.
ExrPicture readExr(std::span<const std::uint8_t> bytes, const std::string& name);

/// Of one channel of two pictures, or of all. Two values that are no numbers (NaN) are equal, and so are two infinities
/// of one sign.
struct ExrDifference {
    std::string channel;
    double largest = 0.0;          ///< |a - b| of numbers; infinity against anything else is infinitely far apart
    double largestRelative = 0.0;  ///< |a - b| / max(|a|, |b|), 0 to 2; infinite likewise
    std::uint64_t pixels = 0;      ///< that differ at all
    std::uint64_t notNumbers = 0;  ///< pixels with a NaN in one picture and a number in the other
};

struct ExrComparison {
    std::vector<ExrDifference> channels;
    ExrDifference all;  ///< a pixel counts once, however many of its channels differ; `channel`: that of `largest`
};

/// Both throw std::invalid_argument with one sentence where sizes, places or names of channels differ.
ExrComparison compare(const ExrPicture& a, const ExrPicture& b);
/// Per channel |a - b|: 0 where equal, NaN where one of two values is.
ExrPicture differencePicture(const ExrPicture& a, const ExrPicture& b);

}  // namespace gnomon::renderer
