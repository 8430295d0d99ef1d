// Gathers the scene's geometry into a few large buffers and uploads them.
#include <algorithm>
#include <glm/gtc/packing.hpp>
#include <numeric>

#include "renderer/gpu/gpu_scene.h"
#include "renderer/gpu/pack_attributes.h"
#include "renderer/gpu/scene_data.h"

namespace gnomon::renderer {

namespace {

// Positions further than this from the object's own origin are stored relative to the primitive's centre: at 1 km a
// float step is 0.06 mm, below anything the bias of 2 mm would notice.
constexpr float kFarFromOriginMetres = 1024.0f;

// What the primitive's vertices are stored relative to.
glm::dvec3 storageOriginOf(const Primitive& primitive) {
    Bounds bounds;
    for (const glm::vec3& p : primitive.positions) bounds.add(p);
    const bool far = !bounds.empty() && glm::length(bounds.centre()) > kFarFromOriginMetres;
    return far ? glm::dvec3(bounds.centre()) : glm::dvec3(0.0);
}

std::vector<glm::vec3> positionsFrom(const glm::dvec3& origin, const Primitive& primitive) {
    std::vector<glm::vec3> out(primitive.positions.size());
    std::transform(primitive.positions.begin(), primitive.positions.end(), out.begin(),
                   [&](const glm::vec3& p) { return glm::vec3(glm::dvec3(p) - origin); });
    return out;
}

std::uint32_t itemFlagsOf(const Primitive& primitive) {
    const bool hasNormals = !primitive.normals.empty(), hasTangents = hasNormals && !primitive.tangents.empty();
    const bool hasExtras = !primitive.texcoords[1].empty() || !primitive.colours.empty();
    return (hasNormals ? kItemNormalsBit : 0u) | (hasTangents ? kItemTangentsBit : 0u) |
           (hasExtras ? kItemExtrasBit : 0u);
}

}  // namespace

struct GpuScene::Streams {
    std::vector<float> positions;
    std::vector<std::uint32_t> attributes, extras, indices;

    void addAttributes(const Primitive& primitive, std::uint32_t itemFlags);
};

void GpuScene::Streams::addAttributes(const Primitive& primitive, std::uint32_t itemFlags) {
    const bool hasNormals = (itemFlags & kItemNormalsBit) != 0, hasTangents = (itemFlags & kItemTangentsBit) != 0;
    const bool hasExtras = (itemFlags & kItemExtrasBit) != 0;
    for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
        const glm::vec2 uv = primitive.texcoords[0].empty() ? glm::vec2(0.0f) : primitive.texcoords[0][v];
        attributes.insert(attributes.end(), {hasNormals ? packNormal(primitive.normals[v]) : 0u,
                                             hasTangents ? packTangent(primitive.tangents[v]) : 0u,
                                             glm::floatBitsToUint(uv.x), glm::floatBitsToUint(uv.y)});
        if (!hasExtras) continue;
        const glm::vec2 uv1 = primitive.texcoords[1].empty() ? uv : primitive.texcoords[1][v];
        const glm::vec4 colour = primitive.colours.empty() ? glm::vec4(1.0f) : primitive.colours[v];
        extras.insert(extras.end(), {glm::floatBitsToUint(uv1.x), glm::floatBitsToUint(uv1.y),
                                     glm::packHalf2x16({colour.x, colour.y}), glm::packHalf2x16({colour.z, colour.w})});
    }
}

void GpuScene::addGeometry(const Primitive& primitive, bool deforms, bool skinned, Streams& streams) {
    Geometry geometry;
    const auto firstVertex = static_cast<std::uint32_t>(streams.positions.size() / 3);
    geometry.firstTriangle = static_cast<std::uint32_t>(streams.indices.size() / 3);
    geometry.triangleCount = static_cast<std::uint32_t>(primitive.indices.size() / 3);
    // Skinned vertices count from an anchor of their own.
    if (!skinned) geometry.offset = storageOriginOf(primitive);
    const std::vector<glm::vec3> stored = positionsFrom(geometry.offset, primitive);
    for (const glm::vec3& p : stored) streams.positions.insert(streams.positions.end(), {p.x, p.y, p.z});
    geometry.flags = itemFlagsOf(primitive);
    geometry.extraOffset = static_cast<std::uint32_t>(streams.extras.size() / kExtraWords) - firstVertex;
    streams.addAttributes(primitive, geometry.flags);

    ClusteredTriangles split;
    if (deforms) {
        split.order.resize(geometry.triangleCount);
        std::iota(split.order.begin(), split.order.end(), 0u);
        split.clusters.push_back({0, geometry.triangleCount});
        Deformed deformed;
        deformed.geometry = static_cast<std::uint32_t>(geometries_.size());
        deformed.firstVertex = firstVertex;
        deformed.attributes.assign(
            streams.attributes.end() - static_cast<std::ptrdiff_t>(kAttributeWords * stored.size()),
            streams.attributes.end());
        deformed_.push_back(std::move(deformed));
    } else {
        split = makeClusters(stored, primitive.indices);
    }
    geometry.firstCluster = static_cast<std::uint32_t>(clusters_.size());
    geometry.clusterCount = static_cast<std::uint32_t>(split.clusters.size());
    for (Cluster cluster : split.clusters) {
        cluster.firstTriangle += geometry.firstTriangle;
        clusters_.push_back(cluster);
    }
    for (const std::uint32_t triangle : split.order) {
        sourceTriangles_.push_back(triangle);
        for (std::uint32_t c = 0; c < 3; ++c)
            streams.indices.push_back(firstVertex + primitive.indices[3 * triangle + c]);
    }
    geometries_.push_back(geometry);
}

void GpuScene::uploadStreams(const Streams& streams, Uploader& uploader) {
    const VkDeviceSize limit = device_.limits().maxStorageBufferRange;
    auto make = [&](const char* name, std::size_t bytes, VkBufferUsageFlags more) {
        if (bytes > limit) {
            throw GpuError(std::string("The ") + name + " need " + std::to_string(bytes >> 20) +
                           " MiB in one buffer, but '" + device_.info().name + "' allows " +
                           std::to_string(limit >> 20) + " MiB; use a smaller scene.");
        }
        return Buffer(device_, name, bytes,
                      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                          VK_BUFFER_USAGE_TRANSFER_SRC_BIT | more);
    };
    auto upload = [&](const char* name, const auto& values, VkBufferUsageFlags more) {
        Buffer buffer = make(name, values.size() * sizeof(values[0]), more);
        if (!values.empty()) uploader.buffer(buffer, std::as_bytes(std::span(values)));
        return buffer;
    };
    positions_ = upload("scene positions", streams.positions, 0);
    attributes_ = upload("scene attributes", streams.attributes, 0);
    extras_ = upload("scene extras", streams.extras, 0);
    indices_ = upload("scene indices", streams.indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    itemBuffer_ = make("scene draw items", items_.size() * sizeof(GpuDrawItem), 0);
    VkDeviceSize deformedVertices = 0;
    for (const Deformed& d : deformed_) deformedVertices += d.attributes.size() / kAttributeWords;
    if (deformedVertices != 0)
        staging_ = Buffer(device_, "scene vertex staging", kFramesInFlight * deformedVertices * kDeformedVertexBytes,
                          VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload);

    const std::vector<VkDescriptorType> types(5, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    sceneSetLayout_ = makeSetLayout(
        device_, types, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT);
    scenePool_ = makeDescriptorPool(device_, 1, types);
    sceneSet_ = allocateSet(device_, scenePool_, sceneSetLayout_);
    const Buffer* buffers[] = {&positions_, &attributes_, &extras_, &indices_, &itemBuffer_};
    for (std::uint32_t b = 0; b < 5; ++b) writeBuffer(device_, sceneSet_, b, types[b], buffers[b]->handle());
}

// Each primitive once, and once more for every instance that deforms it.
GpuScene::GeometryOfPrimitives GpuScene::addGeometries(const Scene& scene, Streams& streams) {
    GeometryOfPrimitives geometryOf(scene.meshes.size());
    for (std::size_t m = 0; m < scene.meshes.size(); ++m)
        geometryOf[m].assign(scene.meshes[m].primitives.size(), kNone);
    for (const Instance& instance : scene.instances)
        for (std::size_t p = 0; p < geometryOf[instance.mesh].size(); ++p) {
            const Primitive& primitive = scene.meshes[instance.mesh].primitives[p];
            std::uint32_t& geometry = geometryOf[instance.mesh][p];
            if (geometry != kNone || deforms(instance, primitive)) continue;
            geometry = static_cast<std::uint32_t>(geometries_.size());
            addGeometry(primitive, false, false, streams);
        }
    for (const Instance& instance : scene.instances)
        for (const Primitive& primitive : scene.meshes[instance.mesh].primitives)
            if (deforms(instance, primitive)) addGeometry(primitive, true, instance.skin != kNone, streams);
    return geometryOf;
}

GpuScene::GpuScene(const Device& device, const Scene& scene) : device_(device) {
    Streams streams;
    const GeometryOfPrimitives geometryOf = addGeometries(scene, streams);
    for (const Material& material : scene.materials) {
        traits_.push_back({material.alphaMode != AlphaMode::Opaque, material.doubleSided, material.subsurface});
    }
    addItems(scene, geometryOf);
    Uploader uploader(device);
    uploadStreams(streams, uploader);
    createMaterials(scene, uploader);
    uploader.finish();
    if (!deformed_.empty()) setPose(restPose(scene));
    // Nobody has looked yet.
    for (DrawItem& item : items_) item.moved = false;
    changes_.clear();
    castersRevision_ = 1;
}

}  // namespace gnomon::renderer
