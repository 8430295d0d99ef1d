#pragma once
// A scene on the device.
//
// - Vertex shaders pull geometry from storage buffers: positions as tight floats, packed attributes, u32 indices that
//   count from the scene's first vertex.
// - A *draw item* is one primitive of one instance. Triangles are drawn in clusters, sorted by place.
// - Triangle ids count through all draw items, and triangle() leads back to the scene.
// - What deforms has vertices of its own, which are uploaded whenever a pose changes them, and one bound for all of it.
//
// Large worlds: object positions far from their own origin are stored relative to the primitive's centre. The matrices
// are computed in double, relative to the frame's origin. So nothing large is ever subtracted in a shader.

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "renderer/gpu/clusters.h"
#include "renderer/gpu/cull_volume.h"
#include "renderer/gpu/pipeline.h"
#include "renderer/gpu/resources.h"
#include "scene/pose.h"
#include "scene/scene.h"

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
    bool mirrored = false;           ///< the instance's matrix turns the winding around
    bool hidden = false;             ///< the matrix leaves lines or points: there is nothing to see
    bool moved = false;              ///< since the scene was made
    std::uint32_t deformed = kNone;  ///< index into Pose::deformed
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
    bool subsurface = false;
};

/// Not thread safe.
class GpuScene {
public:
    /// Uploads and waits. Throws GpuError if the scene is beyond the device's limits. The scene may go afterwards.
    GpuScene(const Device& device, const Scene& scene);

    /// Moves an instance; counts as a change of the casters. Takes effect with the next recordTransforms().
    void setInstance(std::uint32_t instance, const glm::dmat4& worldFromObject);
    /// Moves and deforms whatever differs from the last pose (at first: the scene at rest). The pose must be of the
    /// same scene. Takes effect with the next recordTransforms().
    void setPose(const Pose& pose);
    /// Writes the matrices relative to `origin`, and vertices, where they changed. Outside of rendering, before any
    /// drawing of the frame. Frames in flight are safe, up to kFramesInFlight: the order on the queue keeps old frames'
    /// matrices and vertices until they are done.
    void recordTransforms(VkCommandBuffer commands, const glm::dvec3& origin);
    static constexpr std::uint32_t kFramesInFlight = 2;
    [[nodiscard]] const glm::dvec3& origin() const { return origin_; }
    /// Grows whenever a shadow may have changed.
    [[nodiscard]] std::uint64_t castersRevision() const { return castersRevision_; }
    /// True where something moved or deformed within the volume, left it or came into it, after that revision. It is
    /// also true for revisions of so long ago that changes since then are forgotten.
    [[nodiscard]] bool changedSince(std::uint64_t revision, const CullVolume& volume) const;

    /// Appends what may be visible, in item order (by material), neighbouring clusters merged.
    void cull(const CullVolume& volume, std::vector<DrawRange>& out) const;
    /// The same in two steps, for many views within one sphere: candidates() once, then cull() per view.
    struct Candidate {
        std::uint32_t item, worldCluster;
    };
    void candidates(const glm::dvec3& centre, float radius, std::vector<Candidate>& out) const;
    void cull(const CullVolume& volume, std::span<const Candidate> candidates, std::vector<DrawRange>& out) const;

    /// All parts as they stand now; seen are those that `frustum` may hold.
    [[nodiscard]] std::vector<ScenePart> parts(const CullVolume& frustum) const;

    [[nodiscard]] const std::vector<DrawItem>& items() const { return items_; }
    [[nodiscard]] const std::vector<MaterialTraits>& materials() const { return traits_; }
    [[nodiscard]] std::uint32_t triangleCount() const { return triangleCount_; }  ///< of all instances
    [[nodiscard]] TriangleSource triangle(std::uint32_t triangleId) const;
    /// Position among all instances' triangles in the scene's own order: instances, their primitives, their triangles.
    /// The G-buffer's id is another, because clusters are sorted. kNone for an id of the background.
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
    // Vertices of one primitive of one instance.
    struct Deformed {
        std::uint32_t geometry = 0, firstVertex = 0;
        std::vector<glm::vec3> positions, normals;  // as last posed
        std::vector<glm::vec4> tangents;
        std::vector<std::uint32_t> attributes;  // as uploaded
        Bounds bounds;
        bool dirty = false;
    };
    struct CasterChange {
        std::uint64_t revision;
        WorldSphere sphere;
    };
    using GeometryOfPrimitives = std::vector<std::vector<std::uint32_t>>;
    /// Deforming primitives are one cluster, in the order of their triangles.
    void addGeometry(const Primitive& primitive, bool deforms, bool skinned, Streams& streams);
    GeometryOfPrimitives addGeometries(const Scene& scene, Streams& streams);
    void addItems(const Scene& scene, const GeometryOfPrimitives& geometryOf);
    void noteChange(const DrawItem& item);
    bool takeVertices(const PosedPrimitive& posed, Deformed& deformed);
    void recordVertices(VkCommandBuffer commands);
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
    std::vector<Deformed> deformed_;
    std::vector<CasterChange> changes_;  // by revision
    std::uint32_t triangleCount_ = 0;
    std::uint64_t castersRevision_ = 1, changesKnownSince_ = 1;
    std::uint32_t stagingSlot_ = 0;
    glm::dvec3 origin_{0.0};
    bool transformsDirty_ = true;

    Buffer positions_, attributes_, extras_, indices_, itemBuffer_, materialBuffer_, staging_;
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
