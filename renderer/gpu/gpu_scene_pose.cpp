// What moves and deforms: poses, the upload of deformed vertices, and the log of what changed where.
#include <algorithm>
#include <cstring>

#include "renderer/gpu/gpu_scene.h"
#include "renderer/gpu/pack_attributes.h"

namespace gnomon::renderer {

void GpuScene::noteChange(const DrawItem& item) {
    // Whoever looks at the log does so every frame; a few frames' worth are kept.
    const std::size_t most = 1024 + 8 * items_.size();
    if (changes_.size() >= most) {
        const auto kept = changes_.begin() + static_cast<std::ptrdiff_t>(most / 2);
        changesKnownSince_ = (kept - 1)->revision;
        changes_.erase(changes_.begin(), kept);
    }
    if (!item.hidden) changes_.push_back({castersRevision_, {item.centre, item.radius}});
}

bool GpuScene::changedSince(std::uint64_t revision, const CullVolume& volume) const {
    if (revision >= castersRevision_) return false;
    if (revision < changesKnownSince_) return true;
    const auto first =
        std::upper_bound(changes_.begin(), changes_.end(), revision,
                         [](std::uint64_t r, const CasterChange& change) { return r < change.revision; });
    return std::any_of(first, changes_.end(), [&](const CasterChange& change) {
        return volume.mayHold(change.sphere.centre, change.sphere.radius);
    });
}

// False where nothing differs.
bool GpuScene::takeVertices(const PosedPrimitive& posed, Deformed& deformed) {
    if (posed.positions == deformed.positions && posed.normals == deformed.normals &&
        posed.tangents == deformed.tangents)
        return false;
    deformed.positions = posed.positions;
    deformed.normals = posed.normals;
    deformed.tangents = posed.tangents;
    deformed.dirty = true;
    for (std::size_t v = 0; v < posed.normals.size(); ++v) {
        std::uint32_t* words = deformed.attributes.data() + v * kAttributeWords;
        words[0] = packNormal(posed.normals[v]);
        if (!posed.tangents.empty()) words[1] = packTangent(posed.tangents[v]);
    }
    const Geometry& geometry = geometries_[deformed.geometry];
    Cluster& cluster = clusters_[geometry.firstCluster];
    cluster.centre = glm::vec3(glm::dvec3(posed.bounds.centre()) - geometry.offset);
    cluster.halfExtent = 0.5f * (posed.bounds.max - posed.bounds.min);
    cluster.radius = posed.bounds.radius() * (1.0f + 1e-6f) + 1e-6f * glm::length(posed.bounds.centre());
    return true;
}

void GpuScene::setPose(const Pose& pose) {
    ++castersRevision_;
    bool any = false;
    for (DrawItem& item : items_) {
        const glm::dmat4& worldFromObject = pose.worldFromObject[item.instance];
        const bool moves = item.worldFromObject != worldFromObject;
        const bool deforms =
            item.deformed != kNone && takeVertices(pose.deformed[item.deformed], deformed_[item.deformed]);
        if (!moves && !deforms) continue;
        any = true;
        noteChange(item);
        item.worldFromObject = worldFromObject;
        item.moved = true;
        placeItem(item);
        noteChange(item);
        transformsDirty_ = transformsDirty_ || moves;
    }
    if (!any) --castersRevision_;
}

void GpuScene::recordVertices(VkCommandBuffer commands) {
    std::vector<VkBufferCopy> positions, attributes;
    stagingSlot_ = (stagingSlot_ + 1) % kFramesInFlight;
    VkDeviceSize at = staging_.bytes() / kFramesInFlight * stagingSlot_;
    const auto stage = [&](const void* data, std::size_t bytes, VkDeviceSize target) {
        std::memcpy(staging_.mapped<std::byte>() + at, data, bytes);
        const VkBufferCopy copy{at, target, bytes};
        at += bytes;
        return copy;
    };
    std::vector<glm::vec3> stored;
    for (Deformed& deformed : deformed_) {
        if (!deformed.dirty || deformed.positions.empty()) continue;
        deformed.dirty = false;
        const Geometry& geometry = geometries_[deformed.geometry];
        stored.resize(deformed.positions.size());
        std::transform(deformed.positions.begin(), deformed.positions.end(), stored.begin(),
                       [&](const glm::vec3& p) { return glm::vec3(glm::dvec3(p) - geometry.offset); });
        positions.push_back(stage(stored.data(), stored.size() * sizeof(glm::vec3),
                                  VkDeviceSize{deformed.firstVertex} * sizeof(glm::vec3)));
        attributes.push_back(stage(deformed.attributes.data(), deformed.attributes.size() * sizeof(std::uint32_t),
                                   VkDeviceSize{deformed.firstVertex} * kAttributeWords * sizeof(std::uint32_t)));
    }
    if (positions.empty()) return;
    VkBufferMemoryBarrier2 barriers[] = {bufferBarrier(positions_, access::kStorageRead, access::kTransferWrite),
                                         bufferBarrier(attributes_, access::kStorageRead, access::kTransferWrite)};
    recordBarriers(commands, {}, barriers);
    vkCmdCopyBuffer(commands, staging_.handle(), positions_.handle(), static_cast<std::uint32_t>(positions.size()),
                    positions.data());
    vkCmdCopyBuffer(commands, staging_.handle(), attributes_.handle(), static_cast<std::uint32_t>(attributes.size()),
                    attributes.data());
    barriers[0] = bufferBarrier(positions_, access::kTransferWrite, access::kStorageRead);
    barriers[1] = bufferBarrier(attributes_, access::kTransferWrite, access::kStorageRead);
    recordBarriers(commands, {}, barriers);
}

}  // namespace gnomon::renderer
