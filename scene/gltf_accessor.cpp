#include "scene/gltf_accessor.h"

#include <algorithm>
#include <cstring>

namespace gnomon::renderer::gltf {
namespace {

template <class T>
T load(const std::uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
}

std::size_t componentSize(int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;
    }
}

std::size_t componentCount(int type) {
    switch (type) {
        case TINYGLTF_TYPE_SCALAR:
            return 1;
        case TINYGLTF_TYPE_VEC2:
            return 2;
        case TINYGLTF_TYPE_VEC3:
            return 3;
        case TINYGLTF_TYPE_VEC4:
            return 4;
        case TINYGLTF_TYPE_MAT4:
            return 16;
        default:
            return 0;  // 2x2 and 3x3 matrices are never used by what is drawn
    }
}

// First byte of `count` elements within a view, or a refusal. Written so that nothing overflows.
const std::uint8_t* checkedRange(std::span<const std::uint8_t> bytes, std::size_t offset, std::size_t count,
                                 std::size_t stride, std::size_t elementBytes, std::string_view user) {
    if (offset > bytes.size() || elementBytes > bytes.size() - offset ||
        (count - 1) > (bytes.size() - offset - elementBytes) / stride)
        refuse("{} wants {} elements of {} bytes, {} apart, from byte {} of a bufferView of {} bytes", user, count,
               elementBytes, stride, offset, bytes.size());
    return bytes.data() + offset;
}

// A copy, elements side by side; zeros where there is nothing to copy (glTF 2.0, section 5.1.1).
void makeDense(Elements& elements, std::size_t elementBytes) {
    elements.storage.assign(elements.count * elementBytes, 0);
    for (std::size_t i = 0; elements.data && i < elements.count; ++i)
        std::memcpy(elements.storage.data() + i * elementBytes, elements.data + i * elements.stride, elementBytes);
    elements.data = elements.storage.data();
    elements.stride = elementBytes;
}

void applySparse(Document& document, const tinygltf::Accessor& source, Elements& elements, std::string_view user) {
    const auto& sparse = source.sparse;
    if (sparse.count <= 0 || static_cast<std::size_t>(sparse.count) > elements.count)
        refuse("{} has {} sparse elements", user, sparse.count);
    if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) refuse("{} has a negative sparse offset", user);
    const auto count = static_cast<std::size_t>(sparse.count);
    const std::size_t elementBytes = elements.components * elements.componentBytes;
    Elements indices;
    indices.componentType = sparse.indices.componentType;
    indices.componentBytes = componentSize(indices.componentType);
    if (indices.componentBytes == 0 || indices.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT)
        refuse("{} has sparse indices of type {}", user, indices.componentType);
    indices.components = 1;
    indices.count = count;
    indices.stride = indices.componentBytes;
    indices.data =
        checkedRange(document.view(sparse.indices.bufferView, user).bytes,
                     static_cast<std::size_t>(sparse.indices.byteOffset), count, indices.stride, indices.stride, user);
    const std::uint8_t* values =
        checkedRange(document.view(sparse.values.bufferView, user).bytes,
                     static_cast<std::size_t>(sparse.values.byteOffset), count, elementBytes, elementBytes, user);
    makeDense(elements, elementBytes);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t index = indices.unsignedValue(i, 0);
        if (index >= elements.count) refuse("{} has the sparse index {} for {} elements", user, index, elements.count);
        std::memcpy(elements.storage.data() + index * elementBytes, values + i * elementBytes, elementBytes);
    }
}

}  // namespace

float Elements::value(std::size_t element, std::size_t index) const {
    const std::uint8_t* at = data + element * stride + index * componentBytes;
    switch (componentType) {
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return load<float>(at);
        case TINYGLTF_COMPONENT_TYPE_BYTE: {
            const auto v = static_cast<float>(load<std::int8_t>(at));
            return normalised ? std::max(v / 127.0f, -1.0f) : v;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: {
            const auto v = static_cast<float>(*at);
            return normalised ? v / 255.0f : v;
        }
        case TINYGLTF_COMPONENT_TYPE_SHORT: {
            const auto v = static_cast<float>(load<std::int16_t>(at));
            return normalised ? std::max(v / 32767.0f, -1.0f) : v;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
            const auto v = static_cast<float>(load<std::uint16_t>(at));
            return normalised ? v / 65535.0f : v;
        }
        default: {
            const auto v = static_cast<float>(load<std::uint32_t>(at));
            return normalised ? v / 4294967295.0f : v;
        }
    }
}

std::uint32_t Elements::unsignedValue(std::size_t element, std::size_t index) const {
    const std::uint8_t* at = data + element * stride + index * componentBytes;
    if (componentBytes == 1) return *at;
    if (componentBytes == 2) return load<std::uint16_t>(at);
    return load<std::uint32_t>(at);
}

Elements openAccessor(Document& document, int accessor, std::string_view user) {
    const tinygltf::Accessor& source = at(document.model().accessors, accessor, "accessor", user);
    Elements elements;
    elements.componentType = source.componentType;
    elements.componentBytes = componentSize(source.componentType);
    elements.components = componentCount(source.type);
    if (elements.componentBytes == 0 || elements.components == 0)
        refuse("{} is an accessor of an unknown type ({}, {})", user, source.type, source.componentType);
    elements.normalised = source.normalized;
    elements.count = source.count;
    if (elements.count == 0) refuse("{} is an accessor without elements", user);
    const std::size_t elementBytes = elements.components * elements.componentBytes;
    if (source.bufferView >= 0) {
        const BytesOfView view = document.view(source.bufferView, user);
        elements.stride = view.stride == 0 ? elementBytes : view.stride;
        if (elements.stride < elementBytes)
            refuse("{} has elements of {} bytes, {} apart", user, elementBytes, elements.stride);
        elements.data =
            checkedRange(view.bytes, source.byteOffset, elements.count, elements.stride, elementBytes, user);
    } else {
        document.spendUnbackedElements(elements.count, user);
        if (!source.sparse.isSparse) makeDense(elements, elementBytes);
    }
    if (source.sparse.isSparse) applySparse(document, source, elements, user);
    return elements;
}

std::vector<std::uint32_t> readIndices(Document& document, int accessor, std::string_view user) {
    const Elements elements = openAccessor(document, accessor, user);
    const bool isUnsigned = elements.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                            elements.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                            elements.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (!isUnsigned || elements.components != 1) refuse("{} are not unsigned scalars", user);
    std::vector<std::uint32_t> out(elements.count);
    for (std::size_t i = 0; i < elements.count; ++i) out[i] = elements.unsignedValue(i, 0);
    return out;
}

std::vector<glm::mat4> readMatrices(Document& document, int accessor, std::string_view user) {
    const Elements elements = openAccessor(document, accessor, user);
    if (elements.components != 16 || elements.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
        refuse("{} are not 4x4 float matrices", user);
    std::vector<glm::mat4> out(elements.count);
    for (std::size_t i = 0; i < elements.count; ++i)
        for (int c = 0; c < 16; ++c) {
            const float value = elements.value(i, static_cast<std::size_t>(c));
            if (!std::isfinite(value)) refuse("{} hold a number that is not finite", user);
            out[i][c / 4][c % 4] = value;
        }
    return out;
}

}  // namespace gnomon::renderer::gltf
