#pragma once
// A scene on the device.
//
// Geometry is pulled by the vertex shaders from storage buffers: positions as tight floats, packed attributes, u32
// indices that count from the scene's first vertex. A *draw item* is one primitive of one instance. Triangles are drawn
// in clusters, sorted by place; triangle ids count through all draw items, and triangle() leads back to the scene.
//
// Large worlds: object positions far from their own origin are stored relative to the primitive's centre, and the
// matrices are computed in double relative to the frame's origin, so nothing large is ever subtracted in a shader.

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "renderer/gpu/clusters.h"
#include "renderer/gpu/cull_volume.h"
#include "renderer/gpu/pipeline.h"
#include "renderer/gpu/resources.h"
#include "renderer/scene/scene.h"

namespace gnomon::renderer {

struct MemoryRow {
    std::string name;
    std::uint64_t bytes = 0;
};

/// One primitive of one instance.
struct DrawItem {
    std::uint32_t instance = 0, meshPrimitive = 0;  ///< index of the primitive in its mesh
    std::uint32_t geometry = 0;                     ///< index into the unique primitives
    std::uint32_t material = 0;
    std::uint32_t firstTriangleId = 0, triangleCount = 0;
    bool mirrored = false;  ///< the instance's matrix turns the winding around
    std::uint32_t firstWorldCluster = 0, clusterCount = 0;
    glm::dmat4 worldFromObject{1.0};
    glm::dvec3 centre{0.0};  ///< world bounding sphere
    float radius = 0.0f;
};

/// A run of visible triangles of one draw item; triangles count from the scene's first.
struct DrawRange {
    std::uint32_t item = 0, firstTriangle = 0, triangleCount = 0;
};

struct TriangleSource {
    std::uint32_t instance = kNone, meshPrimitive = 0, triangle = 0;
};

struct MaterialTraits {
    bool masked = false;  ///< alpha tested (blended materials are drawn so, too)
    bool doubleSided = false;
};

/// Not thread safe.
class GpuScene {
public:
    /// Uploads and waits. Throws GpuError if the scene is beyond the device's limits. The scene may go afterwards.
    GpuScene(const Device& device, const Scene& scene);

    /// Moves an instance; counts as a change of the casters. Takes effect with the next recordTransforms().
    void setInstance(std::uint32_t instance, const glm::dmat4& worldFromObject);
    /// Writes the matrices relative to `origin` if it or an instance changed. Outside of rendering, before any drawing
    /// of the frame. Frames in flight are safe: the order on the queue keeps old frames' matrices until they are done.
    void recordTransforms(VkCommandBuffer commands, const glm::dvec3& origin);
    [[nodiscard]] const glm::dvec3& origin() const { return origin_; }
    /// Grows whenever a shadow may have changed.
    [[nodiscard]] std::uint64_t castersRevision() const { return castersRevision_; }

    /// Appends what may be visible, in item order (by material), neighbouring clusters merged.
    void cull(const CullVolume& volume, std::vector<DrawRange>& out) const;
    /// The same in two steps, for many views within one sphere: candidates() once, then cull() per view.
    struct Candidate {
        std::uint32_t item, worldCluster;
    };
    void candidates(const glm::dvec3& centre, float radius, std::vector<Candidate>& out) const;
    void cull(const CullVolume& volume, std::span<const Candidate> candidates, std::vector<DrawRange>& out) const;

    [[nodiscard]] const std::vector<DrawItem>& items() const { return items_; }
    [[nodiscard]] const std::vector<MaterialTraits>& materials() const { return traits_; }
    [[nodiscard]] std::uint32_t triangleCount() const { return triangleCount_; }  ///< of all instances
    [[nodiscard]] TriangleSource triangle(std::uint32_t triangleId) const;
    /// Position among all instances' triangles in the scene's own order (instances, their primitives, their triangles),
    /// which the G-buffer's id is not, because clusters are sorted. kNone for an id of the background.
    [[nodiscard]] std::uint32_t trianglePosition(std::uint32_t triangleId) const;
    [[nodiscard]] std::vector<MemoryRow> memoryRows() const;

    /// Set 0: positions, attributes, extras, indices, draw items (storage buffers).
    [[nodiscard]] VkDescriptorSetLayout sceneSetLayout() const { return sceneSetLayout_; }
    [[nodiscard]] VkDescriptorSet sceneSet() const { return sceneSet_; }
    /// Set 1: parameters and four textures of one material.
    [[nodiscard]] VkDescriptorSetLayout materialSetLayout() const { return materialSetLayout_; }
    [[nodiscard]] VkDescriptorSet materialSet(std::uint32_t material) const { return materialSets_.at(material); }
    [[nodiscard]] VkBuffer indexBuffer() const { return indices_.handle(); }  ///< u32, scene-wide
    [[nodiscard]] const Buffer& positions() const { return positions_; }
    [[nodiscard]] const Buffer& itemBuffer() const { return itemBuffer_; }

private:
    struct Geometry {
        std::uint32_t firstTriangle = 0, triangleCount = 0, firstCluster = 0, clusterCount = 0;
        std::uint32_t flags = 0, extraOffset = 0;
        glm::dvec3 offset{0.0};  // stored position = position - offset
    };
    struct Streams;  // what is gathered on the CPU before the upload
    struct WorldSphere {
        glm::dvec3 centre;
        float radius;
    };
    [[nodiscard]] const DrawItem* itemOfTriangle(std::uint32_t triangleId) const;
    void addGeometry(const Primitive& primitive, Streams& streams);
    void addItems(const Scene& scene, const std::vector<std::uint32_t>& firstGeometryOfMesh);
    void uploadStreams(const Streams& streams, Uploader& uploader);
    void createMaterials(const Scene& scene, Uploader& uploader);
    void createImages(const Scene& scene, Uploader& uploader);
    void placeItem(DrawItem& item);
    std::uint32_t imageOf(const TextureUse& use, bool srgb, Uploader& uploader, const Scene& scene);
    VkSampler samplerOf(const TextureUse& use) const;

    const Device& device_;
    std::vector<Geometry> geometries_;
    std::vector<Cluster> clusters_;
    std::vector<std::uint32_t> sourceTriangles_;
    std::vector<DrawItem> items_;
    std::vector<std::uint32_t> itemsById_;  // items in order of firstTriangleId
    std::vector<WorldSphere> worldClusters_;
    std::uint32_t triangleCount_ = 0;
    std::uint64_t castersRevision_ = 1;
    glm::dvec3 origin_{0.0};
    bool transformsDirty_ = true;

    Buffer positions_, attributes_, extras_, indices_, itemBuffer_, materialBuffer_;
    std::vector<MaterialTraits> traits_;
    std::vector<GpuImage> images_;
    std::vector<std::uint32_t> imageIndex_[2];  // per scene image: index into images_, linear and sRGB
    std::vector<Sampler> samplers_;             // by repeatU, repeatV, linear
    SetLayout sceneSetLayout_, materialSetLayout_;
    DescriptorPool scenePool_, materialPool_;
    VkDescriptorSet sceneSet_ = VK_NULL_HANDLE;
    std::vector<VkDescriptorSet> materialSets_;
};

}  // namespace gnomon::renderer
