// Draw items, culling and transforms. The upload is in gpu_scene_upload.cpp, poses are in gpu_scene_pose.cpp, materials
// in materials.cpp.
#include "renderer/gpu/gpu_scene.h"

#include <algorithm>
#include <cmath>

#include "renderer/gpu/scene_data.h"

namespace gnomon::renderer {

void GpuScene::placeItem(DrawItem& item) {
    const Geometry& geometry = geometries_[item.geometry];
    item.mirrored = turnsWinding(glm::dmat3(item.worldFromObject));
    item.hidden = !hasArea(glm::dmat3(item.worldFromObject));
    // A bound of the largest stretch: the Frobenius norm; the column maximum would be too small under shear.
    const glm::dmat3 m(item.worldFromObject);
    const double columns[3] = {glm::length(m[0]), glm::length(m[1]), glm::length(m[2])};
    const bool orthogonal =
        std::abs(glm::dot(m[0], m[1])) + std::abs(glm::dot(m[0], m[2])) + std::abs(glm::dot(m[1], m[2])) <
        1e-6 * (columns[0] * columns[0] + columns[1] * columns[1] + columns[2] * columns[2]);
    const double stretch = orthogonal
                               ? std::max({columns[0], columns[1], columns[2]}) * (1.0 + 1e-5)
                               : std::sqrt(columns[0] * columns[0] + columns[1] * columns[1] + columns[2] * columns[2]);
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
    for (std::uint32_t c = 0; c < item.clusterCount; ++c) {
        const Cluster& cluster = clusters_[geometry.firstCluster + c];
        WorldSphere& sphere = worldClusters_[item.firstWorldCluster + c];
        sphere.centre =
            glm::dvec3(item.worldFromObject * glm::dvec4(glm::dvec3(cluster.centre) + geometry.offset, 1.0));
        sphere.radius = static_cast<float>(static_cast<double>(cluster.radius) * stretch);
        low = glm::min(low, sphere.centre - static_cast<double>(sphere.radius));
        high = glm::max(high, sphere.centre + static_cast<double>(sphere.radius));
    }
    item.centre = 0.5 * (low + high);
    item.radius = 0.0f;
    for (std::uint32_t c = 0; c < item.clusterCount; ++c) {
        const WorldSphere& sphere = worldClusters_[item.firstWorldCluster + c];
        item.radius =
            std::max(item.radius, static_cast<float>(glm::length(sphere.centre - item.centre)) + sphere.radius);
    }
}

void GpuScene::addItems(const Scene& scene, const GeometryOfPrimitives& geometryOf) {
    std::uint64_t nextId = 0;
    std::uint32_t deformed = 0;
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const auto& primitives = scene.meshes[instance.mesh].primitives;
        for (std::uint32_t p = 0; p < primitives.size(); ++p) {
            DrawItem item;
            item.instance = i;
            item.meshPrimitive = p;
            if (deforms(instance, primitives[p])) item.deformed = deformed++;
            item.geometry = item.deformed == kNone ? geometryOf[instance.mesh][p] : deformed_[item.deformed].geometry;
            item.material = primitives[p].material;
            item.firstTriangleId = static_cast<std::uint32_t>(nextId);
            item.triangleCount = geometries_[item.geometry].triangleCount;
            item.clusterCount = geometries_[item.geometry].clusterCount;
            item.worldFromObject = instance.worldFromObject;
            nextId += item.triangleCount;
            if (item.triangleCount != 0) items_.push_back(item);
        }
    }
    if (nextId >= 0xFFFFFFFFull) throw GpuError("The scene has more than 4 billion triangles; use fewer instances.");
    triangleCount_ = static_cast<std::uint32_t>(nextId);
    // By material, so that a pass changes pipelines and sets rarely.
    std::stable_sort(items_.begin(), items_.end(), [&](const DrawItem& a, const DrawItem& b) {
        return std::pair(traits_[a.material].masked, a.material) < std::pair(traits_[b.material].masked, b.material);
    });
    for (DrawItem& item : items_) {
        item.firstWorldCluster = static_cast<std::uint32_t>(worldClusters_.size());
        worldClusters_.resize(worldClusters_.size() + item.clusterCount);
        placeItem(item);
        itemsById_.push_back(static_cast<std::uint32_t>(itemsById_.size()));
    }
    std::sort(itemsById_.begin(), itemsById_.end(),
              [&](std::uint32_t a, std::uint32_t b) { return items_[a].firstTriangleId < items_[b].firstTriangleId; });
}

void GpuScene::setInstance(std::uint32_t instance, const glm::dmat4& worldFromObject) {
    ++castersRevision_;
    for (DrawItem& item : items_) {
        if (item.instance != instance) continue;
        noteChange(item);
        item.worldFromObject = worldFromObject;
        placeItem(item);
        noteChange(item);
    }
    transformsDirty_ = true;
}

void GpuScene::recordTransforms(VkCommandBuffer commands, const glm::dvec3& origin) {
    recordVertices(commands);
    if (!transformsDirty_ && origin == origin_) return;
    origin_ = origin;
    transformsDirty_ = false;
    std::vector<GpuDrawItem> records(items_.size());
    for (std::size_t i = 0; i < items_.size(); ++i) {
        const DrawItem& item = items_[i];
        const Geometry& geometry = geometries_[item.geometry];
        glm::dmat4 m = item.worldFromObject;
        m[3] += glm::dvec4(glm::dmat3(m) * geometry.offset - origin, 0.0);
        const glm::mat4 rows(glm::transpose(m));
        records[i] = {rows[0],
                      rows[1],
                      rows[2],
                      item.firstTriangleId - geometry.firstTriangle,
                      geometry.flags | (item.mirrored ? kItemMirroredBit : 0u),
                      geometry.extraOffset,
                      item.material};
    }
    VkBufferMemoryBarrier2 barrier = bufferBarrier(itemBuffer_, access::kStorageRead, access::kTransferWrite);
    recordBarriers(commands, {}, {&barrier, 1});
    constexpr std::size_t kMost = 65536;  // of one vkCmdUpdateBuffer
    const std::size_t bytes = records.size() * sizeof(GpuDrawItem);
    for (std::size_t begin = 0; begin < bytes; begin += kMost) {
        vkCmdUpdateBuffer(commands, itemBuffer_.handle(), begin, std::min(kMost, bytes - begin),
                          reinterpret_cast<const char*>(records.data()) + begin);
    }
    barrier = bufferBarrier(itemBuffer_, access::kTransferWrite, access::kStorageRead);
    recordBarriers(commands, {}, {&barrier, 1});
}

namespace {
void appendRange(std::vector<DrawRange>& out, std::uint32_t item, std::uint32_t first, std::uint32_t count) {
    if (!out.empty() && out.back().item == item && out.back().firstTriangle + out.back().triangleCount == first) {
        out.back().triangleCount += count;
    } else {
        out.push_back({item, first, count});
    }
}
}  // namespace

void GpuScene::cull(const CullVolume& volume, std::vector<DrawRange>& out) const {
    for (std::uint32_t i = 0; i < items_.size(); ++i) {
        const DrawItem& item = items_[i];
        if (item.hidden || !volume.mayHold(item.centre, item.radius)) continue;
        const Geometry& geometry = geometries_[item.geometry];
        for (std::uint32_t c = 0; c < item.clusterCount; ++c) {
            const WorldSphere& sphere = worldClusters_[item.firstWorldCluster + c];
            if (item.clusterCount > 1 && !volume.mayHold(sphere.centre, sphere.radius)) continue;
            const Cluster& cluster = clusters_[geometry.firstCluster + c];
            appendRange(out, i, cluster.firstTriangle, cluster.triangleCount);
        }
    }
}

void GpuScene::candidates(const glm::dvec3& centre, float radius, std::vector<Candidate>& out) const {
    auto touches = [&](const glm::dvec3& c, float r) {
        const glm::dvec3 d = c - centre;
        const double reach = static_cast<double>(radius) + r;
        return glm::dot(d, d) <= reach * reach;
    };
    for (std::uint32_t i = 0; i < items_.size(); ++i) {
        const DrawItem& item = items_[i];
        if (item.hidden || !touches(item.centre, item.radius)) continue;
        for (std::uint32_t c = item.firstWorldCluster; c < item.firstWorldCluster + item.clusterCount; ++c) {
            if (touches(worldClusters_[c].centre, worldClusters_[c].radius)) out.push_back({i, c});
        }
    }
}

void GpuScene::cull(const CullVolume& volume, std::span<const Candidate> candidates,
                    std::vector<DrawRange>& out) const {
    for (const Candidate& candidate : candidates) {
        const WorldSphere& sphere = worldClusters_[candidate.worldCluster];
        if (!volume.mayHold(sphere.centre, sphere.radius)) continue;
        const DrawItem& item = items_[candidate.item];
        const Cluster& cluster =
            clusters_[geometries_[item.geometry].firstCluster + candidate.worldCluster - item.firstWorldCluster];
        appendRange(out, candidate.item, cluster.firstTriangle, cluster.triangleCount);
    }
}

std::vector<ScenePart> GpuScene::parts(const CullVolume& frustum) const {
    std::vector<ScenePart> out;
    for (const DrawItem& item : items_) {
        if (item.hidden) continue;
        const bool itemSeen = frustum.mayHold(item.centre, item.radius);
        const Geometry& geometry = geometries_[item.geometry];
        const glm::dmat3 linear(item.worldFromObject);
        for (std::uint32_t c = 0; c < item.clusterCount; ++c) {
            const WorldSphere& sphere = worldClusters_[item.firstWorldCluster + c];
            const glm::dvec3 half(clusters_[geometry.firstCluster + c].halfExtent);
            const bool seen = itemSeen && frustum.mayHold(sphere.centre, sphere.radius);
            out.push_back({sphere.centre, static_cast<double>(sphere.radius), seen,
                           glm::dmat3(linear[0] * half.x, linear[1] * half.y, linear[2] * half.z)});
        }
    }
    return out;
}

const DrawItem* GpuScene::itemOfTriangle(std::uint32_t triangleId) const {
    const auto after =
        std::upper_bound(itemsById_.begin(), itemsById_.end(), triangleId,
                         [&](std::uint32_t id, std::uint32_t i) { return id < items_[i].firstTriangleId; });
    if (after == itemsById_.begin()) return nullptr;
    const DrawItem& item = items_[*(after - 1)];
    return triangleId - item.firstTriangleId < item.triangleCount ? &item : nullptr;
}

TriangleSource GpuScene::triangle(std::uint32_t triangleId) const {
    const DrawItem* item = itemOfTriangle(triangleId);
    if (item == nullptr) return {};
    const std::uint32_t stored = geometries_[item->geometry].firstTriangle + triangleId - item->firstTriangleId;
    return {item->instance, item->meshPrimitive, sourceTriangles_[stored]};
}

std::uint32_t GpuScene::trianglePosition(std::uint32_t triangleId) const {
    const DrawItem* item = itemOfTriangle(triangleId);
    return item != nullptr ? item->firstTriangleId + triangle(triangleId).triangle : kNone;
}

std::vector<MemoryRow> GpuScene::memoryRows() const {
    std::uint64_t textures = 0;
    for (const GpuImage& image : images_) textures += image.bytes();
    return {{"scene positions", positions_.bytes()},    {"scene attributes", attributes_.bytes()},
            {"scene extras", extras_.bytes()},          {"scene indices", indices_.bytes()},
            {"scene draw items", itemBuffer_.bytes()},  {"scene materials", materialBuffer_.bytes()},
            {"scene vertex staging", staging_.bytes()}, {"scene textures", textures}};
}

}  // namespace gnomon::renderer
