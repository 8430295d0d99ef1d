#include <fmt/format.h>

#include "picture/picture.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace gnomon::renderer {

std::string hashOf(const Picture& picture) {
    // The extent is the seed: two pictures with the same bytes in rows of different lengths differ.
    const XXH64_hash_t extent = (XXH64_hash_t{picture.width} << 32) | picture.height;
    return fmt::format("{:016x}", XXH3_64bits_withSeed(picture.rgb.data(), picture.rgb.size(), extent));
}

}  // namespace gnomon::renderer
