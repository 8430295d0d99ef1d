#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "picture/picture.h"

namespace gnomon::renderer {
namespace {

void requireEqualExtents(const Picture& a, const Picture& b) {
    if (a.width != b.width || a.height != b.height)
        throw std::invalid_argument(
            fmt::format("The pictures differ in size: {}x{} and {}x{}.", a.width, a.height, b.width, b.height));
}

std::uint32_t largestOfPixel(const Picture& a, const Picture& b, std::size_t pixel) {
    int largest = 0;
    for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) largest = std::max(largest, std::abs(a.rgb[i] - b.rgb[i]));
    return static_cast<std::uint32_t>(largest);
}

}  // namespace

Difference compare(const Picture& a, const Picture& b) {
    requireEqualExtents(a, b);
    Difference difference;
    std::uint64_t sum = 0;
    const std::size_t pixels = a.rgb.size() / 3;
    for (std::size_t p = 0; p < pixels; ++p) {
        const std::uint32_t largest = largestOfPixel(a, b, p);
        if (largest == 0) continue;
        difference.largest = std::max(difference.largest, largest);
        ++difference.pixels;
        for (std::size_t i = 3 * p; i < 3 * p + 3; ++i)
            sum += static_cast<std::uint64_t>(std::abs(a.rgb[i] - b.rgb[i]));
    }
    if (!a.rgb.empty()) difference.meanAbsolute = static_cast<double>(sum) / static_cast<double>(a.rgb.size());
    return difference;
}

Picture differencePicture(const Picture& a, const Picture& b) {
    requireEqualExtents(a, b);
    Picture out{a.width, a.height, std::vector<std::uint8_t>(a.rgb.size())};
    for (std::size_t p = 0; p < a.rgb.size() / 3; ++p) {
        const std::uint32_t largest = largestOfPixel(a, b, p);
        // A difference of one must be seen beside the grey, so red starts at 95.
        const std::uint32_t grey = (a.rgb[3 * p] + 2u * a.rgb[3 * p + 1] + a.rgb[3 * p + 2]) / 8;
        const bool equal = largest == 0;
        out.rgb[3 * p] = static_cast<std::uint8_t>(equal ? grey : std::min(95 + 4 * largest, 255u));
        out.rgb[3 * p + 1] = out.rgb[3 * p + 2] = static_cast<std::uint8_t>(equal ? grey : 0);
    }
    return out;
}

}  // namespace gnomon::renderer
