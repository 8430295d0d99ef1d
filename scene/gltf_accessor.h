#pragma once
// Typed reads of accessors. Every read checks type, component type, stride, count and byte range against the buffer
// first, and only then allocates: a count of four thousand million in a file of one kilobyte costs nothing.

#include <cstdint>
#include <glm/glm.hpp>
#include <string_view>
#include <vector>

#include "scene/gltf_document.h"

namespace gnomon::renderer::gltf {

/// A checked accessor: `count` elements of `components` numbers, `stride` bytes apart, all within memory that is held
/// by the document or by `storage`.
struct Elements {
    const std::uint8_t* data = nullptr;
    std::size_t count = 0, stride = 0, components = 0, componentBytes = 0;
    int componentType = 0;
    bool normalised = false;
    std::vector<std::uint8_t> storage;  // of sparse accessors

    /// Component `index` of an element as a float; integers are scaled when normalised.
    float value(std::size_t element, std::size_t index) const;
    std::uint32_t unsignedValue(std::size_t element, std::size_t index) const;
};

Elements openAccessor(Document& document, int accessor, std::string_view user);

/// Reads vectors of `leastComponents` to N numbers; missing ones keep the value in `fill`.
template <int N>
std::vector<glm::vec<N, float>> readVectors(Document& document, int accessor, std::size_t leastComponents,
                                            glm::vec<N, float> fill, std::string_view user) {
    const Elements elements = openAccessor(document, accessor, user);
    if (elements.components < leastComponents || elements.components > static_cast<std::size_t>(N))
        refuse("{} has {} components per element", user, elements.components);
    std::vector<glm::vec<N, float>> out(elements.count, fill);
    for (std::size_t i = 0; i < elements.count; ++i)
        for (std::size_t c = 0; c < elements.components; ++c) out[i][static_cast<int>(c)] = elements.value(i, c);
    return out;
}

/// Unsigned scalars.
std::vector<std::uint32_t> readIndices(Document& document, int accessor, std::string_view user);
/// 4x4 float matrices with finite values.
std::vector<glm::mat4> readMatrices(Document& document, int accessor, std::string_view user);

}  // namespace gnomon::renderer::gltf
